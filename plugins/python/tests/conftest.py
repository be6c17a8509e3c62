"""Helpers of the tests."""

import types

import matplotlib
import numpy as np
import pytest

import fuwafuwa as fw

matplotlib.use("Agg")


def classes(dim: int) -> types.SimpleNamespace:
    """Return the classes of a dimension by their names without the number."""
    names = ["World", "SoftBody", "RigidBody", "Shape", "VoxelGrid", "Joint"]
    return types.SimpleNamespace(dim=dim, **{name: getattr(fw, f"{name}{dim}") for name in names})


def vector(dim: int, x: float, y: float, z: float = 0.0) -> np.ndarray:
    """Return a vector of a dimension; in 2D without its third number."""
    return np.array([x, y, z][:dim], np.float32)


@pytest.fixture(params=[2, 3], ids=["2D", "3D"])
def fwd(request: pytest.FixtureRequest) -> types.SimpleNamespace:
    """Classes of 2D, then of 3D."""
    return classes(request.param)


def floor_world(fwd: types.SimpleNamespace, **settings: object):
    """Return a world with only a floor."""
    world = fwd.World(**settings)
    floor = fwd.Shape.half_space(vector(fwd.dim, 0, 1))
    world.add_rigid_body(fwd.RigidBody.fixed(floor, friction=0.4))
    return world


def torn_world(fwd: types.SimpleNamespace, n: int = 16, ticks: int = 50):
    """Return a world in which a hand has torn a ball, the ball and the hand."""
    world = floor_world(fwd)
    wall = fwd.Shape.half_space(vector(fwd.dim, -1, 0), vector(fwd.dim, 1.1, 0))
    world.add_rigid_body(fwd.RigidBody.fixed(wall, friction=0.2))
    ball = world.add_soft_body(fwd.SoftBody.ball(n).translated(vector(fwd.dim, 0, 0.05)))
    position = vector(fwd.dim, -0.3, 0.5, 0.5)
    hand = world.add_rigid_body(fwd.RigidBody.coupled(fwd.Shape.ball(0.08), position=position))
    split = 0
    for tick in range(ticks):
        x = np.float32(-0.3) + np.float32(tick) * np.float32(0.03)
        world.set_target_position(hand, vector(fwd.dim, x, 0.5, 0.5))
        split += world.step().nodes_split
    assert split > 10, "the body must tear"
    return world, ball, hand
