"""Snapshots, pickle and copies."""

import copy
import pickle

import numpy as np
import pytest
from conftest import torn_world, vector

import fuwafuwa as fw


def advance(world, hand, dim, ticks=20):
    for tick in range(ticks):
        world.set_target_position(hand, vector(dim, 0.2 + 0.03 * tick, 0.6, 0.5))
        world.step()
    return world.hash()


@pytest.mark.parametrize(
    "again",
    [
        lambda world: pickle.loads(pickle.dumps(world)),
        lambda world: type(world).restore(world.snapshot()),
        copy.copy,
        copy.deepcopy,
        lambda world: world.copy(),
    ],
    ids=["pickle", "snapshot", "copy", "deepcopy", "method"],
)
def test_world_steps_to_the_same_bits_after_round_trip(fwd, again):
    world, ball, hand = torn_world(fwd)
    other = again(world)
    assert other.hash() == world.hash()
    before = world.hash()
    expected = advance(other, hand, fwd.dim)
    assert world.hash() == before, "the original stays as it was"
    assert advance(world, hand, fwd.dim) == expected
    np.testing.assert_array_equal(world[ball].positions, other[ball].positions)


def test_handles_are_valid_after_pickle(fwd):
    world, ball, hand = torn_world(fwd)
    same_ball, same_hand = pickle.loads(pickle.dumps((ball, hand)))
    assert (same_ball, same_hand) == (ball, hand)
    assert {ball: 1}[same_ball] == 1
    assert same_ball in world and same_hand in world
    assert repr(ball) == "SoftBodyHandle(slot=0, generation=0)"


def test_soft_body_survives_pickle(fwd):
    world, ball, _ = torn_world(fwd)
    body = world[ball].copy()
    same = pickle.loads(pickle.dumps(body))
    for name in ("positions", "velocities", "elements", "damage", "strain", "node_pieces"):
        np.testing.assert_array_equal(getattr(same, name), getattr(body, name), err_msg=name)


def test_definitions_survive_pickle(fwd):
    point = vector(fwd.dim, 0.1, 0.2, 0.3)
    values = [
        fw.Material(young=9e3, stress_law=("yeoh", 0.01, 1e-4), prony=[(0.5, 0.1)], rate_toughening=(0.1, 0.2)),
        fwd.Shape.capsule(point, -point, 0.1),
        fwd.Shape.box(np.abs(point), point, 0.3 if fwd.dim == 2 else (0.1, 0.2, 0.3)),
        fwd.RigidBody.dynamic(fwd.Shape.ball(0.1), 2.0, velocity=point, user_data=2**63),
        fwd.RigidBody.coupled(fwd.Shape.ball(0.1), max_force=float("inf"), layers=(2, 6)),
        fwd.Joint.spring(point, 2 * point, 10.0, 0.1, 0.5),
        fwd.VoxelGrid.ball(9),
    ]
    for value in values:
        assert pickle.loads(pickle.dumps(value)) == value


def test_events_are_those_of_all_ticks_of_a_step(fwd):
    together, ball, hand = torn_world(fwd, ticks=45)
    alone = together.copy()
    for world in (together, alone):
        world.set_target_position(hand, vector(fwd.dim, 1.2, 0.5, 0.5))
    together.step(10)
    single = []
    for _ in range(10):
        alone.step()
        single.extend(event["type"] for event in alone.events())
    assert [event["type"] for event in together.events()] == single
    assert "node_split" in single and "contact_force" in single
    split = next(event for event in together.events() if event["type"] == "node_split")
    assert split["body"] == ball and split["point"].shape == (fwd.dim,) and split["energy"] > 0
    contact = next(event for event in together.events() if event["type"] == "contact_force")
    assert any(part[0] == ball for part in contact["pair"] if isinstance(part, tuple))


def test_snapshot_of_other_dimension_is_rejected():
    with pytest.raises(fw.Error, match="the snapshot is of a world with 2 dimensions, expected 3"):
        fw.World3.restore(fw.World2().snapshot())
    with pytest.raises(fw.Error, match="not a snapshot"):
        fw.World2.restore(b"nothing")
    damaged = bytearray(fw.World2().snapshot())
    damaged[-1] ^= 1
    with pytest.raises(fw.Error, match="snapshot"):
        fw.World2.restore(bytes(damaged))
