"""Wrong arguments raise exceptions in the words of the engine."""

import numpy as np
import pytest
from conftest import floor_world, torn_world, vector

import fuwafuwa as fw

NAN = float("nan")


def rejected(text):
    return pytest.raises(fw.Error, match=text)


def test_error_is_a_value_error():
    assert issubclass(fw.Error, ValueError)
    assert fw.Error.__module__ == "fuwafuwa"


def test_stale_handles_are_rejected(fwd):
    world, ball, hand = torn_world(fwd)
    view, rigid = world[ball], world[hand]
    removed = world.remove(ball)
    assert isinstance(removed, fwd.SoftBody) and removed.piece_count > 1
    assert isinstance(world.remove(hand), fwd.RigidBody)
    stale = "stale soft body handle: slot 0 was removed or reused, or belongs to another world"
    for call in (lambda: view.positions, lambda: world[ball], lambda: world.remove(ball), lambda: world.wake_up(ball)):
        with rejected(stale):
            call()
    for call in (lambda: rigid.position, lambda: world.set_target_position(hand, vector(fwd.dim, 0, 0))):
        with rejected("stale rigid body handle"):
            call()
    assert ball not in world and hand not in world
    assert "stale" in repr(view)


def test_non_finite_vectors_are_rejected(fwd):
    world, ball, hand = torn_world(fwd)
    before, wrong = world.hash(), vector(fwd.dim, NAN, 0)
    count = fwd.dim
    with rejected(f"position must be {count} finite numbers, given \\[NaN"):
        world.set_target_position(hand, wrong)
    for call in (
        lambda: world.set_velocity(ball, wrong),
        lambda: world.translate(ball, wrong),
        lambda: world.apply_impulse(ball, wrong, vector(fwd.dim, 0, 1)),
        lambda: world.ray_cast(wrong, vector(fwd.dim, 0, 1)),
        lambda: world.closest_point(wrong),
        lambda: world.closest_point(vector(fwd.dim, 0, 0), NAN),
        lambda: world.ray_cast(vector(fwd.dim, 0, 0), vector(fwd.dim, 0, 1), NAN),
        lambda: fwd.World(gravity=wrong),
        lambda: fwd.Shape.ball(0.1, wrong),
        lambda: fwd.RigidBody.fixed(fwd.Shape.ball(0.1), position=wrong),
        lambda: fwd.RigidBody.fixed(fwd.Shape.ball(0.1), rotation=NAN if count == 2 else (0, 0, 0, NAN)),
        lambda: fwd.Shape.ball(NAN),
        lambda: fw.Material(young=NAN),
        lambda: fwd.SoftBody.ball(8, NAN),
        lambda: fwd.SoftBody.from_shape(fwd.Shape.ball(0.5), NAN),
        lambda: world.set_gravity_scale(ball, NAN),
    ):
        with pytest.raises(fw.Error):
            call()
    assert world.hash() == before, "a failed call changes nothing"


def test_vectors_of_wrong_length_are_rejected(fwd):
    world = floor_world(fwd)
    for wrong in ([0.0], [0.0] * 4, "up", None, 3.0, [[0.0, 1.0]]):
        with rejected(f"by must be {fwd.dim} finite numbers, given"):
            world.translate(world.rigid_bodies[0], wrong)


def test_arrays_of_wrong_shape_or_type_are_rejected(fwd):
    shape = (4,) * fwd.dim
    axes = f"array must be an array of uint8 or bool with {fwd.dim} axes, given "
    with rejected(axes + "float64 of shape"):
        fwd.VoxelGrid(np.ones(shape), 0.1)
    with rejected(axes + "uint8 of shape \\[4\\]"):
        fwd.VoxelGrid(np.ones(4, np.uint8), 0.1)
    with rejected(axes + "list"):
        fwd.VoxelGrid([[1, 1], [1, 1]], 0.1)
    with rejected("the grid is empty: at least one voxel must be solid"):
        fwd.VoxelGrid(np.zeros(shape, np.uint8), 0.1)
    with rejected("voxel_size must be .* m, given 0.0"):
        fwd.VoxelGrid(np.ones(shape, np.uint8), 0.0)
    with rejected("the grid uses material 3, but the number of materials given is 1"):
        fwd.SoftBody.from_array(np.full(shape, 3, np.uint8), 0.1)
    body = fwd.SoftBody.ball(8)
    n = body.node_count
    kept = body.positions
    with rejected(f"positions must be an array of float32 or float64 of shape \\[{n}, {fwd.dim}\\]"):
        body.set_node_states(positions=kept[:-1])
    with rejected("velocities must be an array of float32 or float64"):
        body.set_node_states(velocities=kept.astype(int))
    with rejected("velocities must be finite, given NaN at node 0"):
        body.set_node_states(velocities=np.full_like(kept, NAN))
    wrong = kept.copy()
    wrong[5, 1] = np.inf
    with rejected("positions must be within 1024 m of the origin on each axis, given inf at node 5"):
        body.set_node_states(positions=wrong)
    with rejected("nodes must be a bool array"):
        body.fix_nodes(np.ones(n + 1, bool))
    with rejected(f"nodes must be .*, given {n}$"):
        body.fix_nodes([0, n])
    with rejected("nodes must be"):
        body.fix_nodes([-1])
    misaligned = np.frombuffer(b"\0" + kept.tobytes(), np.uint8)[1:].view(np.float32).reshape(kept.shape)
    if not misaligned.flags.aligned:
        with rejected("misaligned in memory"):
            body.set_node_states(positions=misaligned)
    with rejected("positions must be within 1024 m of the origin on each axis, given 1e30 at node 0"):
        body.set_node_states(positions=np.full_like(kept, 1e30))
    assert not body.fixed.any()
    np.testing.assert_array_equal(body.positions, kept)


def test_lists_of_bools_are_masks(fwd):
    body = fwd.SoftBody.ball(4)
    mask = [False] * body.node_count
    mask[3] = True
    body.fix_nodes(mask)
    assert np.flatnonzero(body.fixed).tolist() == [3]
    with rejected("nodes must be"):
        body.fix_nodes([True, False])
    body.free_nodes(np.array(mask))
    body.fix_nodes([])
    assert not body.fixed.any()


def test_huge_sizes_are_rejected_without_memory(fwd):
    most = "size must be at most 1024 voxels on an axis and 67108864 in all, given"
    for extent in (1025, 2**20):
        for value in (np.uint8(1), np.bool_(True)):
            with rejected(most):
                fwd.VoxelGrid(np.broadcast_to(value, (extent,) * fwd.dim), 0.1)
    with rejected(most):
        fw.VoxelGrid3(np.broadcast_to(np.uint8(1), (1024, 1024, 1024)), 0.1)
    with rejected(most):
        fwd.SoftBody.ball(10**9)
    with rejected(most):
        fwd.SoftBody.from_shape(fwd.Shape.ball(1.0), 1e-6)
    with rejected(most):
        fwd.VoxelGrid.from_distance((2**63,) * fwd.dim, 0.1, lambda point: -1.0)
    for size in (0.0, -1.0, float("inf"), NAN):
        with rejected("voxel_size must be 0.000001 to 1000 m, given"):
            fwd.SoftBody.from_shape(fwd.Shape.ball(1.0), size)


def test_pairs_name_the_argument(fwd):
    world, _, hand = torn_world(fwd)
    point = vector(fwd.dim, 0, 0)
    for layers in ((1, 2, 3), (1,), 7, (-1, 0), (2**32, 0), "ab"):
        with rejected("layers must be a pair of bit masks of 32 bits: memberships and filters, given"):
            world.objects_at(point, layers=layers)
        with rejected("layers must be a pair"):
            fwd.RigidBody.fixed(fwd.Shape.ball(1.0), layers=layers)
    for view in ((), (point,), (point, point, point), 1):
        with rejected("view must be a low and a high corner, given"):
            world.rgb(view=view)
    for edge in ((), (point, point, point), None):
        with rejected("edge must be a pair of points, given"):
            world.add_knife(hand, edge, point)


def test_long_values_are_shortened_in_errors(fwd):
    with pytest.raises(fw.Error) as caught:
        fwd.Shape.ball(1.0, ["x" * 10**6])
    assert len(str(caught.value)) < 400 and "…" in str(caught.value)


def test_damaged_pickles_are_rejected(fwd):
    import pickle

    values = [
        fw.Material(),
        fwd.Shape.ball(1.0),
        fwd.RigidBody.fixed(fwd.Shape.ball(1.0)),
        fwd.Joint.pin((0,) * fwd.dim, (1,) * fwd.dim),
    ]
    values += [fwd.SoftBody.ball(4), fwd.World()]
    values.append(values[-1].add_soft_body(values[-2]))
    for value in values:
        decode, (state,) = value.__reduce__()
        for damaged in (b"", state[: len(state) // 2], b"\xff" * len(state)):
            with pytest.raises(fw.Error):
                decode(damaged)
        assert type(pickle.loads(pickle.dumps(value))) is type(value)


def test_parameters_out_of_range_name_the_field(fwd):
    world = floor_world(fwd)
    with rejected("drag must be 0 to 10, given -1.0"):
        fwd.World(drag=-1)
    with rejected('stiff_bodies must be one of "exact", "mass_scaled", "softened", given "hard"'):
        fwd.World(stiff_bodies="hard")
    with rejected("friction must be 0 or more, and finite, given -3.0"):
        world.set_friction(world.rigid_bodies[0], -3)
    with rejected("restitution must be 0 to 1, given 3.0"):
        world.set_restitution(world.rigid_bodies[0], 3)
    with rejected("radius"):
        fwd.Shape.ball(-1)
    with rejected("law must be one of"):
        fwd.SoftBody.ball(8, law="linear")
    with rejected("shape must be bounded"):
        fwd.SoftBody.from_shape(fwd.Shape.half_space(vector(fwd.dim, 0, 1)), 0.1)
    half_space = fwd.RigidBody.dynamic(fwd.Shape.half_space(vector(fwd.dim, 0, 1)), 1.0)
    with pytest.raises(fw.Error):
        world.add_rigid_body(half_space)


def test_material_rejects_unknown_and_wrong_fields():
    with pytest.raises(TypeError, match=r"Material\(\) got an unexpected keyword argument 'youngs'"):
        fw.Material(youngs=1)
    with rejected("poisson"):
        fw.Material(poisson=0.6)
    with rejected("friction must be 0 to 2, given 3.0"):
        fw.Material(friction=3)
    with rejected("stress_law must be"):
        fw.Material(stress_law="ogden")
    with rejected("prony must be at most 2 pairs"):
        fw.Material(prony=[(0.1, 0.1)] * 3)
    with rejected('the library has no material "ecoflex"; similar names are .*ecoflex-00-30'):
        fw.Material.library("ecoflex")


def test_bodies_of_another_dimension_are_rejected():
    with pytest.raises(TypeError):
        fw.World2().add_soft_body(fw.SoftBody3.ball(8))
    with pytest.raises(TypeError):
        fw.World2().add_rigid_body(None)
    with pytest.raises(KeyError):
        fw.World2()["ball"]


def test_missing_files_raise_file_not_found(tmp_path):
    for call in (fw.VoxelGrid2.picture, fw.VoxelGrid3.vox):
        with pytest.raises(FileNotFoundError) as caught:
            call(tmp_path / "missing")
        assert caught.value.filename == str(tmp_path / "missing")
    with rejected("there is no scene or file"):
        fw.Scene.read(tmp_path / "missing.toml")
    with pytest.raises(TypeError):
        fw.VoxelGrid2.picture(7)
    with rejected("bytes"):
        fw.VoxelGrid2.picture(b"no picture")
