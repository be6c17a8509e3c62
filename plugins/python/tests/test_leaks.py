"""Memory of worlds that are made and dropped.

Each measurement runs in a new process: memory that earlier tests freed would hide a leak.
"""

import os
import pathlib
import subprocess
import sys

import pytest

pytestmark = pytest.mark.skipif(not pathlib.Path("/proc/self/statm").exists(), reason="needs /proc of Linux")

PAGE = os.sysconf("SC_PAGE_SIZE") if hasattr(os, "sysconf") else 4096

PROGRAM = """
import pathlib, pickle, sys
import numpy as np
import fuwafuwa as fw

def resident():
    return int(pathlib.Path("/proc/self/statm").read_text().split()[1])

def classes(dim):
    return [getattr(fw, f"{name}{dim}") for name in ("World", "SoftBody", "RigidBody", "Shape", "VoxelGrid")]

def small_world(dim):
    World, SoftBody, RigidBody, Shape, VoxelGrid = classes(dim)
    world = World()
    up = np.eye(dim, dtype=np.float32)[1]
    floor = world.add_rigid_body(RigidBody.fixed(Shape.half_space(up)))
    body = world.add_soft_body(SoftBody(VoxelGrid(np.ones((2,) * dim, np.uint8), 0.5)))
    return world, body, floor

def made_and_dropped(dim, count):
    for _ in range(count):
        small_world(dim)[0].step()

def everything(dim, count):
    for _ in range(count):
        world, body, floor = small_world(dim)
        world.step(2)
        view = world[body]
        assert len(view.positions) == len(view.damage) == view.node_count
        view.pieces(), view.strain, view.elements, view.outlines(), world.events(), world.contacts_of(body)
        world.ray_cast(np.full(dim, 0.4), np.eye(dim)[0]), world.reaction(floor), world.closest_point(np.zeros(dim))
        assert pickle.loads(pickle.dumps(world)).hash() == world.copy().hash() == world.hash()
        world.remove(body)
        for error in (lambda: world[body], lambda: view.positions, lambda: world.set_velocity(floor, np.zeros(5))):
            try:
                error()
            except (KeyError, ValueError, TypeError):
                pass
            else:
                raise AssertionError("no error")

def kept(dim, count):
    KEPT.extend(small_world(dim) for _ in range(count))

KEPT = []
work, dim, first, count = globals()[sys.argv[1]], *map(int, sys.argv[2:])
work(dim, first)
before = resident()
work(dim, count)
print(resident() - before)
"""


def growth(work: str, dim: int, first: int, count: int) -> float:
    """Return the growth of the resident memory of a new process [MiB] by `count` rounds after the `first` ones."""
    command = [sys.executable, "-c", PROGRAM, work, str(dim), str(first), str(count)]
    found = subprocess.run(command, capture_output=True, text=True)
    assert found.returncode == 0, found.stderr
    return int(found.stdout) * PAGE / 2**20


@pytest.mark.parametrize("dim", [2, 3])
def test_memory_is_flat_over_hundred_thousand_worlds(dim):
    # The limit is 44 bytes a world.
    assert growth("made_and_dropped", dim, 2_000, 48_000) < 2


@pytest.mark.parametrize("dim", [2, 3])
def test_memory_is_flat_over_arrays_queries_copies_and_errors(dim):
    assert growth("everything", dim, 500, 4_000) < 2


def test_memory_grows_by_worlds_that_are_kept():
    assert growth("kept", 2, 500, 2_000) > 4
