"""Worlds: actions, queries, joints, knives and grips."""

import numpy as np
import pytest
from conftest import floor_world, torn_world, vector

import fuwafuwa as fw


def test_settings_are_those_of_the_constructor(fwd):
    world = fwd.World(
        gravity=vector(fwd.dim, 0, -1), drag=0.5, max_substeps=32, stiff_bodies="exact", tick=1 / 120, sleep=False
    )
    assert world.gravity[1] == -1 and world.drag == 0.5 and world.max_substeps == 32
    assert world.stiff_bodies == "exact" and world.tick == np.float32(1 / 120) and world.sleep is False
    world.gravity = vector(fwd.dim, 1, 0)
    world.set_config(drag=0.25)
    assert world.gravity[0] == 1 and world.drag == 0.25 and world.max_substeps == 32


def test_defaults_are_those_of_the_engine(fwd):
    world = fwd.World()
    assert world.gravity[1] == np.float32(-9.81) and world.drag == 0 and world.max_substeps == 64
    assert world.stiff_bodies == "mass_scaled" and world.tick == np.float32(1 / 60) and world.sleep is True
    material = fw.Material()
    assert (material.young, material.poisson, material.density) == (5000, 0.3, 100)
    assert material.mass_damping == 4 and material.stiffness_damping == np.float32(2e-4)
    assert fwd.RigidBody.fixed(fwd.Shape.ball(1)).friction == np.float32(0.2)
    assert fwd.RigidBody.dynamic(fwd.Shape.ball(1), 1).friction == 0.5


def test_step_counts_ticks_and_time(fwd):
    world = floor_world(fwd)
    report = world.step(30)
    assert report.ticks == 30 and report.substeps == 30 * 16 and report.largest_scale == 1
    assert world.ticks == 30 and world.time == pytest.approx(0.5)
    assert world.step(0).ticks == 0 and world.ticks == 30
    with pytest.raises(OverflowError):
        world.step(-1)


def test_free_fall_is_that_of_theory(fwd):
    world = fwd.World()
    ball = world.add_soft_body(fwd.SoftBody.ball(8))
    rigid = world.add_rigid_body(fwd.RigidBody.dynamic(fwd.Shape.ball(0.1), 1.0, position=vector(fwd.dim, 5, 0)))
    start = world[ball].centre_of_mass[1]
    world.step(60)
    assert world[ball].centre_of_mass[1] - start == pytest.approx(-4.905, rel=0.01)
    assert world[rigid].position[1] == pytest.approx(-4.905, rel=0.01)
    assert world.velocity(rigid)[0][1] == pytest.approx(-9.81, rel=0.01)


def test_coupled_body_follows_its_target_and_feels_the_ball(fwd):
    world, ball, hand = torn_world(fwd, ticks=50)
    reactions = world[hand].reactions()
    assert reactions["contact"].shape == reactions["coupling"].shape == (16, fwd.dim)
    assert reactions["torque"].shape == ((16,) if fwd.dim == 2 else (16, 3))
    assert reactions["coupling"].any()
    assert world[hand].motion == {
        "type": "coupled",
        "mass": 2,
        "stiffness": 3000,
        "damping": pytest.approx(0.9),
        "max_force": 1000,
    }
    assert world[hand].target_position[0] == pytest.approx(-0.3 + 49 * 0.03)


def test_kinematic_body_reaches_its_pose(fwd):
    world = fwd.World()
    body = world.add_rigid_body(fwd.RigidBody.kinematic(fwd.Shape.box(np.full(fwd.dim, 0.1))))
    turn = 0.5 if fwd.dim == 2 else (0, 0, 0.5)
    world.set_target_position(body, vector(fwd.dim, 0.1, 0.2))
    world.set_target_rotation(body, turn)
    world.step()
    np.testing.assert_allclose(world[body].position, vector(fwd.dim, 0.1, 0.2))
    expected = 0.5 if fwd.dim == 2 else [0, 0, np.sin(0.25), np.cos(0.25)]
    np.testing.assert_allclose(world[body].rotation, expected, rtol=1e-6)
    world.set_pose(body, vector(fwd.dim, 1, 1))
    np.testing.assert_allclose(world[body].rotation, expected, rtol=1e-6)


def test_queries_find_the_ball_and_the_floor(fwd):
    world = floor_world(fwd)
    ball = world.add_soft_body(fwd.SoftBody.ball(16).translated(vector(fwd.dim, -0.5, 1, -0.5)))
    down, above = vector(fwd.dim, 0, -1), vector(fwd.dim, 0, 5)
    hit = world.ray_cast(above, down)
    assert hit["object"] == (ball, 0) and hit["distance"] == pytest.approx(3, abs=0.05)
    assert hit["material"] == 1 and hit["element"] in world[ball].element_ids
    np.testing.assert_allclose(hit["normal"], -down, atol=0.1)
    floor = world.rigid_bodies[0]
    for exclude in (ball, (ball, 0), [ball], [(ball, 0)]):
        assert world.ray_cast(above, down, exclude=exclude)["object"] == floor
    assert world.ray_cast(above, down, only="rigid")["distance"] == pytest.approx(5)
    assert world.ray_cast(above, down, 1.0) is None
    assert world.ray_cast(above, down, layers=(2, 2)) is None
    near = world.closest_point(above, only="soft")
    assert near["object"] == (ball, 0) and near["distance"] == pytest.approx(3, abs=0.05)
    inside = world.objects_at(vector(fwd.dim, 0, 1.5))
    assert [one["object"] for one in inside] == [(ball, 0)]
    found = world.overlaps(fwd.Shape.ball(2.0, vector(fwd.dim, 0, 1.5)))
    assert {str(one["object"]) for one in found} == {str((ball, 0)), str(floor)}


def test_joint_holds_a_body_and_breaks(fwd):
    world = fwd.World()
    point = vector(fwd.dim, 0, 1)
    weight = world.add_rigid_body(fwd.RigidBody.dynamic(fwd.Shape.ball(0.1), 1.0))
    joint = world.add_joint(fwd.Joint.rope(point, (weight, vector(fwd.dim, 0, 0)), 1.0, breaking_force=50))
    world.step(60)
    assert world[weight].position[1] == pytest.approx(0, abs=0.01)
    first, second = world.joint_anchors(joint)
    np.testing.assert_allclose(first - second, point, atol=0.01)
    world.set_velocity(weight, vector(fwd.dim, 0, -20))
    world.step(5)
    assert {"type": "joint_broke", "joint": joint} in world.events()
    assert joint not in world


def test_spring_between_soft_bodies_pulls(fwd):
    world = fwd.World(gravity=np.zeros(fwd.dim))
    bodies = [world.add_soft_body(fwd.SoftBody.ball(8).translated(vector(fwd.dim, 2 * x, 0))) for x in (0, 1)]
    ends = [(body, world[body].centre_of_mass, 0.3) for body in bodies]
    joint = world.add_joint(fwd.Joint.spring(*ends, 100.0, 1.0, 0.5))
    world.step(30)
    first, second = world.joint_anchors(joint)
    assert np.linalg.norm(second - first) < 1.9
    definition = world.remove(joint)
    assert definition.kind == "spring" and definition in [definition]
    with pytest.raises(fw.Error, match="first must be a pair of RigidBodyHandle and point"):
        rigid = world.add_rigid_body(fwd.RigidBody.dynamic(fwd.Shape.ball(0.1), 1.0))
        fwd.Joint.pin((rigid, vector(fwd.dim, 0, 0), 0.1), vector(fwd.dim, 0, 0))


def test_grip_with_a_force_accelerates_a_body(fwd):
    world = fwd.World(gravity=np.zeros(fwd.dim))
    body = world.add_soft_body(fwd.SoftBody.cube(8))
    everything = fwd.Shape.box(np.full(fwd.dim, 2.0))
    grip = world.add_grip(body, everything, force=vector(fwd.dim, 10, 0))
    assert world.grip_node_count(grip) == world[body].node_count
    world.step(60)
    expected = 10 / world[body].mass
    assert world.velocity(body)[0][0] == pytest.approx(expected, rel=0.02)
    world.set_grip_force(grip, vector(fwd.dim, -10, 0))
    world.step(60)
    assert world.velocity(body)[0][0] == pytest.approx(0, abs=0.02 * expected)
    assert world.remove(grip) is None and grip not in world


def test_carried_grip_moves_the_body_and_feels_its_weight(fwd):
    world = fwd.World()
    material = fw.Material(young=1e5, mass_damping=30.0, strength=float("inf"))
    body = world.add_soft_body(fwd.SoftBody.cube(8, 1.0, material))
    carrier = world.add_rigid_body(fwd.RigidBody.kinematic(fwd.Shape.ball(0.1), is_sensor=True))
    top = fwd.Shape.box(np.array([2, 0.01, 2][: fwd.dim]), vector(fwd.dim, 0.5, 1, 0.5))
    grip = world.add_grip(body, top, carrier=carrier)
    for tick in range(1, 121):
        world.set_target_position(carrier, vector(fwd.dim, 0, min(tick, 60) / 60))
        world.step()
    world.step(60)
    assert world[body].positions[:, 1].max() == pytest.approx(2, abs=0.01)
    assert abs(world.grip_reaction(grip)["force"][1]) == pytest.approx(9.81 * world[body].mass, rel=0.1)
    with pytest.raises(TypeError):
        world.add_grip(body, top, carrier=carrier, force=vector(fwd.dim, 0, 0))


def test_knife_cuts_a_block_in_two(fwd):
    world = floor_world(fwd)
    block = world.add_soft_body(fwd.SoftBody.cube(12))
    holder = fwd.RigidBody.kinematic(fwd.Shape.ball(0.01), position=vector(fwd.dim, 0.5, 1.2, 0.5), is_sensor=True)
    holder = world.add_rigid_body(holder)
    edge = (vector(fwd.dim, 0, 0, -1), vector(fwd.dim, 0, 0, 1))
    knife = world.add_knife(holder, edge, vector(fwd.dim, 0, -1))
    events = []
    for tick in range(90):
        world.set_target_position(holder, vector(fwd.dim, 0.5, 1.2 - tick / 60, 0.5))
        world.step()
        events += [event for event in world.events() if event["type"] == "cut"]
    assert world[block].piece_count >= 2
    assert sum(event["area"] for event in events) == pytest.approx(1, rel=0.3)
    assert all(event["knife"] == knife and event["body"] == block for event in events)
    world.remove(knife)
    assert knife not in world and world.knives == []


def test_cut_splits_a_ball(fwd):
    world = fwd.World()
    ball = world.add_soft_body(fwd.SoftBody.ball(16))
    blade = ((0.5, -1), (0.5, 2)) if fwd.dim == 2 else ((0.5, -1, -1), (0, 3, 0), (0, 0, 3))
    assert world.cut(ball, *blade) > 10
    assert world[ball].piece_count == 2
    assert any(event["type"] == "piece_detached" for event in world.events())
    masses = world[ball].pieces()["mass"]
    removed = world.remove_piece(ball, 1)
    assert removed["mass"] == pytest.approx(masses[1]) and removed["pieces"] == [(ball, 1)]
    assert world[ball].piece_count == 1 and not world[ball].grid.present.all()
    removed = world.remove_outside(fwd.Shape.ball(0.1, vector(fwd.dim, 50, 0)))
    assert removed["soft_bodies"] == [ball] and ball not in world


def test_small_pieces_are_removed(fwd):
    world, ball, _ = torn_world(fwd)
    before = world[ball].piece_count
    removed = world.remove_small_pieces(voxels=30)
    assert len(removed["pieces"]) > 0 and world[ball].piece_count == before - len(removed["pieces"])
    with pytest.raises(TypeError):
        world.remove_small_pieces()


def test_sensor_reports_what_enters(fwd):
    world = fwd.World()
    position = vector(fwd.dim, 0.5, -1, 0.5)
    sensor = world.add_rigid_body(fwd.RigidBody.fixed(fwd.Shape.ball(0.3), position=position, is_sensor=True))
    ball = world.add_soft_body(fwd.SoftBody.ball(8))
    world.step(60)
    entered = [event for event in world.events() if event["type"] == "sensor_entered"]
    assert entered == [{"type": "sensor_entered", "sensor": sensor, "object": (ball, 0)}]


def test_resting_body_sleeps_and_presses_with_its_weight(fwd):
    world = floor_world(fwd)
    ball = world.add_soft_body(fwd.SoftBody.cube(8))
    world.step(600)
    assert world[ball].pieces()["asleep"].all()
    weight = 9.81 * world[ball].mass
    assert world.reaction(ball)["force"][1] == pytest.approx(weight, rel=0.02)
    (contact,) = world.contacts_of(ball)
    assert contact["pair"] == ((ball, 0), world.rigid_bodies[0])
    world.apply_impulse(ball, world[ball].centre_of_mass, vector(fwd.dim, 0, world[ball].mass), 5.0)
    world.step()
    assert not world[ball].pieces()["asleep"].any()


def test_motion_type_can_change(fwd):
    world = floor_world(fwd)
    body = world.add_rigid_body(fwd.RigidBody.fixed(fwd.Shape.ball(0.1), position=vector(fwd.dim, 0, 5)))
    world.set_motion(body, "dynamic", mass=2.0)
    world.step(10)
    assert world[body].position[1] < 5 and world[body].motion == {"type": "dynamic", "mass": 2}
    for name, arguments in (("dynamic", {}), ("fixed", {"mass": 1.0})):
        with pytest.raises(TypeError):
            world.set_motion(body, name, **arguments)
    with pytest.raises(fw.Error, match="motion must be one of"):
        world.set_motion(body, "loose")


def test_rotated_and_moving_bodies(fwd):
    body = fwd.SoftBody.cube(8)
    turned = body.rotated(np.pi / 2 if fwd.dim == 2 else (0, 0, np.pi / 2), about=np.zeros(fwd.dim))
    assert turned.positions[:, 0].min() == pytest.approx(-1, abs=1e-5)
    spinning = body.with_velocity(vector(fwd.dim, 1, 0), 2.0 if fwd.dim == 2 else (0, 0, 2.0))
    world = fwd.World(gravity=np.zeros(fwd.dim))
    linear, angular = world.velocity(world.add_soft_body(spinning))
    np.testing.assert_allclose(linear, vector(fwd.dim, 1, 0), atol=1e-5)
    np.testing.assert_allclose(angular, 2.0 if fwd.dim == 2 else [0, 0, 2], atol=1e-5)


def test_library_has_sources():
    assert "ecoflex-00-30" in fw.library()
    values = fw.library_values("ecoflex-00-30")
    assert all(value["source"] for value in values) and "shear_modulus" in {value["quantity"] for value in values}
    material = fw.Material.library("ecoflex-00-30", density=900.0)
    assert material.density == 900 and material.replace(density=1.0).young == material.young
    assert fw.Material(**material.fields()) == material
    assert eval(repr(fw.Material(young=9e3)), {"Material": fw.Material}) == fw.Material(young=9e3)


def test_predicate_selects_objects(fwd):
    world = floor_world(fwd)
    ball = world.add_soft_body(fwd.SoftBody.ball(16).translated(vector(fwd.dim, -0.5, 1, -0.5)))
    floor = world.rigid_bodies[0]
    down, above = vector(fwd.dim, 0, -1), vector(fwd.dim, 0, 5)
    asked = []

    def is_rigid(found):
        asked.append(found)
        return found == floor

    assert world.ray_cast(above, down, predicate=is_rigid)["object"] == floor
    assert set(asked) == {floor, (ball, 0)}
    assert world.closest_point(above, predicate=is_rigid)["object"] == floor
    inside = vector(fwd.dim, 0, 1.5)
    assert world.objects_at(inside, predicate=is_rigid) == []
    assert [one["object"] for one in world.objects_at(inside, predicate=lambda found: "yes")] == [(ball, 0)]
    everything = fwd.Shape.ball(9.0)
    assert [one["object"] for one in world.overlaps(everything, predicate=is_rigid)] == [floor]
    # The predicate may read the world.
    heavy = world.ray_cast(above, down, predicate=lambda found: isinstance(found, tuple) and world[found[0]].mass > 1)
    assert heavy["object"] == (ball, 0)
    with pytest.raises(ZeroDivisionError):
        world.ray_cast(above, down, predicate=lambda found: 1 / 0)
    with pytest.raises(RuntimeError):
        world.ray_cast(above, down, predicate=lambda found: world.step())
    assert world.ticks == 0


def test_sums_inside_a_region_are_those_of_the_arrays(fwd):
    world, ball, _ = torn_world(fwd)
    body = world[ball]
    left = fwd.Shape.half_space(vector(fwd.dim, 1, 0), vector(fwd.dim, 0.5, 0))
    rows = body.nodes_in(left)
    masses = body.node_masses[rows].astype(float)
    sums = body.sums_inside(left)
    assert sums["nodes"] == len(rows) and sums["mass"] == pytest.approx(masses.sum())
    np.testing.assert_allclose(sums["centre"], masses @ body.positions[rows] / masses.sum(), rtol=1e-5)
    np.testing.assert_allclose(sums["momentum"], masses @ body.velocities[rows], rtol=1e-4, atol=1e-5)
    force = body.forces[rows].astype(float).sum(axis=0)
    np.testing.assert_allclose(sums["elastic_force"], force, rtol=1e-3, atol=1e-2)
    centres = body.cells()[0].mean(axis=1)[np.unique(body.cells()[1], return_index=True)[1]]
    chosen = (centres[:, 0] <= 0.5) & (body.levels == 0)
    assert sums["elastic_energy"] >= body.elastic_energy[chosen].sum() * 0.99 > 0
    assert body.sums_inside(fwd.Shape.ball(0.1, vector(fwd.dim, 50, 0)))["mass"] == 0


def test_biot_strain_agrees_with_the_deformation(fwd):
    world, ball, _ = torn_world(fwd)
    body = world[ball]
    stretch = np.array([np.linalg.svd(f)[1] for f in body.deformation])
    eigenvalues = np.linalg.eigvalsh(body.biot_strain)
    upright = np.linalg.det(body.deformation) > 0.1
    np.testing.assert_allclose(eigenvalues[upright], np.sort(stretch[upright] - 1), atol=2e-3)


def test_joint_carries_the_weight_of_a_body(fwd):
    world = fwd.World()
    weight = world.add_rigid_body(fwd.RigidBody.dynamic(fwd.Shape.ball(0.1), 2.0))
    top = vector(fwd.dim, 0, 1)
    joint = world.add_joint(fwd.Joint.spring(top, (weight, vector(fwd.dim, 0, 0)), 500.0, 20.0, 1.0))
    world.step(300)
    np.testing.assert_allclose(world.joint_reaction(joint), vector(fwd.dim, 0, -2 * 9.81), atol=0.2)
    assert world[weight].position[1] == pytest.approx(-2 * 9.81 / 500, rel=0.01)
    definition = world.joint(joint)
    assert definition.parameters == {"kind": "spring", "stiffness": 500, "damping": 20, "length": 1}
    first, (body, _) = definition.anchors
    np.testing.assert_array_equal(first, top)
    assert body == weight
    again = fwd.Joint.spring(*definition.anchors, 500.0, 20.0, 1.0)
    assert again == definition
    with pytest.raises(fw.Error, match="stale joint handle"):
        world.remove(joint)
        world.joint(joint)


def test_knife_feels_the_work_of_its_cut(fwd):
    world = floor_world(fwd)
    material = fw.Material(young=2e4, strength=float("inf"))
    block = world.add_soft_body(fwd.SoftBody.cube(12, 1.0, material))
    holder = fwd.RigidBody.kinematic(fwd.Shape.ball(0.01), position=vector(fwd.dim, 0.5, 1.1, 0.5), is_sensor=True)
    holder = world.add_rigid_body(holder)
    edge = (vector(fwd.dim, 0, 0, -1), vector(fwd.dim, 0, 0, 1))
    knife = world.add_knife(holder, edge, vector(fwd.dim, 0, -1))
    assert world.knife_reaction(knife)["force"][1] == 0
    largest, area = 0.0, 0.0
    for tick in range(60):
        world.set_target_position(holder, vector(fwd.dim, 0.5, 1.1 - tick / 100, 0.5))
        world.step()
        reaction = world.knife_reaction(knife)
        np.testing.assert_allclose(reaction["point"], world[holder].position)
        largest = max(largest, reaction["force"][1])
        area += sum(event["area"] for event in world.events() if event["type"] == "cut")
    assert area > 0.1 and largest > 0, "the block resists the knife from below"
    assert block in world


def test_damping_has_the_chosen_ratio(fwd):
    material = fw.Material(young=4e4).with_damping_ratio(0.05, 5.0, 20.0)
    assert [material.damping_ratio(f) for f in (5, 20)] == pytest.approx([0.05, 0.05])
    assert material.damping_ratio(10) < 0.05 and material.young == 4e4
    only_mass = material.with_damping_ratio(0.1, 2.0)
    assert only_mass.stiffness_damping == 0 and only_mass.mass_damping == pytest.approx(4 * np.pi * 0.1 * 2)
    with pytest.raises(fw.Error):
        material.with_damping_ratio(float("nan"), 1.0)
    world = fwd.World()
    body = world.add_soft_body(fwd.SoftBody.ball(8, 1.0, [fw.Material(), fw.Material(stiffness_damping=10.0)]))
    (first, limited) = world.acting_damping(body)
    assert first == pytest.approx((4, 2e-4)) and limited[0] == 4 and limited[1] < 0.1
    assert material.shear_modulus == pytest.approx(4e4 / 2.6)


def test_scales_of_a_stiff_body(fwd):
    stiff = fwd.SoftBody.ball(16, 0.1, fw.Material(young=1e7, strength=float("inf")))
    for setting, scaled in (("mass_scaled", "mass_scale"), ("softened", "stiffness_scale")):
        world = fwd.World(stiff_bodies=setting)
        body = world[world.add_soft_body(stiff)]
        factor = body.mass_scale if scaled == "mass_scale" else 1 / body.stiffness_scale
        assert factor > 1 and body.mass_scale / body.stiffness_scale == pytest.approx(factor)
        assert world.step().largest_scale == pytest.approx(factor)
    assert body.gravity_scale == 1 and body.inverted_count == 0
    world.set_gravity_scale(body.handle, 0.5)
    assert body.gravity_scale == 0.5
    assert body.range == pytest.approx(8192 * body.grid.voxel_size)
