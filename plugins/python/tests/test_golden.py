"""Hashes of the golden scenes are those of the engine in Rust.

The table of hashes is `tools/determinism_checks/src/golden.rs`; there is no copy of it here.
"""

import pathlib
import re

import numpy as np
import pytest
from conftest import classes, floor_world, torn_world, vector

TABLE = pathlib.Path(__file__).parents[3] / "tools/determinism_checks/src/golden.rs"


def torn(dim, n, ticks):
    return torn_world(classes(dim), n, ticks)[0].hash()


def balls():
    fwd = classes(3)
    world = floor_world(fwd, max_substeps=8)
    ball = fwd.SoftBody.ball(20)
    for place in range(8):
        x, y, z = (float(place >> axis & 1) for axis in range(3))
        body = world.add_soft_body(ball.translated(np.float32(1.05) * np.array([x, y, z], np.float32)))
        world.set_velocity(body, (0, -4 * y, 0))
    world.step(8)
    return world.hash()


def heap():
    fwd = classes(3)
    world = floor_world(fwd, max_substeps=8)
    ball = world.add_soft_body(fwd.SoftBody.ball(12))
    for height, slant in ((0.3, 0.2), (0.6, -0.3)):
        height, slant = np.float32(height), np.float32(slant)
        world.cut(ball, (-1, height - slant, -1), (3, np.float32(3) * slant, 0), (0, 0, 3))
    hand = world.add_rigid_body(fwd.RigidBody.coupled(fwd.Shape.ball(0.12), position=(0.4, 1.2, 0.5)))
    for tick in range(50):
        height = np.float32(1.2) - np.float32(tick) * np.float32(0.03)
        world.set_target_position(hand, (0.4, height, 0.5))
        assert world.step().substeps == 8
    return world.hash()


def paper_law(dim, n):
    fwd = classes(dim)
    world = floor_world(fwd)
    body = fwd.SoftBody.ball(n, law="endo_2004")
    world.add_soft_body(body.translated(vector(dim, 0, 0.05)))
    world.step(30)
    return world.hash()


SCENES = {
    "torn disc": lambda: torn(2, 32, 70),
    "torn ball": lambda: torn(3, 16, 70),
    "ball large enough for several threads": lambda: torn(3, 44, 40),
    "balls that are together large enough for several threads": balls,
    "ball in pieces that lie on each other, few substeps": heap,
    "disc, law of the paper": lambda: paper_law(2, 16),
    "ball, law of the paper": lambda: paper_law(3, 8),
}


def goldens():
    text = TABLE.read_text(encoding="utf-8")
    rows = re.findall(r'name: "([^"]+)",\s*run: .*?golden: (0x[0-9a-f_]+)', text, re.DOTALL)
    return {name: int(number.replace("_", ""), 16) for name, number in rows}


needs_table = pytest.mark.skipif(not TABLE.exists(), reason="the table is in the repository only")


@needs_table
def test_every_golden_scene_is_here():
    assert set(goldens()) == set(SCENES)


@needs_table
@pytest.mark.parametrize("name", SCENES)
def test_hash_is_that_of_rust(name):
    assert SCENES[name]() == goldens()[name]
