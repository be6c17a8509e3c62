//! Error messages: each names the invalid object or parameter, what was expected, and what was given.

use fuwafuwa::{
    Blade, Dim, Dim2, Dim3, DimVector, Error, Grading, Joint, JointAnchor, Law, Material,
    MotionType, RigidBody, Shape, SoftBody, Vec2, Vec3, Velocity, VoxelGrid, World, WorldConfig,
};

fn ball<D: Dim>() -> RigidBody<D> {
    RigidBody::dynamic(Shape::ball(0.1), 1.0)
}

fn check_stale_handles<D: Dim>(blade: Blade<D>) {
    let mut world = World::<D>::new(WorldConfig::default()).unwrap();
    let grid = VoxelGrid::<D>::cube(2, 1.0).unwrap();
    let body = world
        .add_soft_body(SoftBody::new(grid, &[Material::default()]).unwrap())
        .unwrap();
    let rigid = world.add_rigid_body(ball()).unwrap();
    let anchor = JointAnchor::on(rigid, D::Vector::ZERO);
    let joint = Joint::pin(anchor, JointAnchor::Point(D::Vector::ZERO));
    let joint = world.add_joint(joint).unwrap();
    world.remove(joint).unwrap();
    world.remove(rigid).unwrap();
    world.remove(body).unwrap();
    let slot = 0;
    let stale = |kind| Err(Error::InvalidHandle { kind, slot });
    assert_eq!(world.remove(joint).map(|_| ()), stale("joint"));
    assert_eq!(world.wake_up(rigid), stale("rigid body"));
    assert_eq!(world.wake_up(body), stale("soft body"));
    assert_eq!(world.cut(body, &blade).map(|_| ()), stale("soft body"));
    assert_eq!(
        world.remove(rigid).unwrap_err().to_string(),
        "stale rigid body handle: slot 0 was removed or reused, or belongs to another world"
    );
}

#[test]
fn stale_handle_error_names_kind_and_slot() {
    check_stale_handles::<Dim2>(Blade::segment(Vec2::ZERO, Vec2::ONE));
    check_stale_handles::<Dim3>(Blade::parallelogram(Vec3::ZERO, Vec3::X, Vec3::Y));
}

#[test]
fn parameter_error_names_field_expected_and_given() {
    let mut world = World::<Dim3>::new(WorldConfig::default()).unwrap();
    let floor = Shape::half_space(Vec3::Y, Vec3::ZERO);
    let floor = world
        .add_rigid_body(RigidBody::fixed(floor).with_friction(0.5))
        .unwrap();
    let free = world.add_rigid_body(ball()).unwrap();
    let text = |result: Result<(), Error>| result.unwrap_err().to_string();
    assert_eq!(
        text(world.set_velocity(floor, Velocity::default())),
        "motion_type must be dynamic, given Fixed"
    );
    assert_eq!(
        text(world.set_target_position(free, Vec3::ZERO)),
        "motion_type must be kinematic or coupled, given Dynamic { mass: 1.0 }"
    );
    assert_eq!(
        text(world.set_velocity(free, Velocity::linear(Vec3::new(f32::NAN, 0.0, 0.0)))),
        "linear must be at most 1e6 m/s on each axis, given Vec3(NaN, 0.0, 0.0)"
    );
    assert_eq!(
        text(world.set_motion_type(free, MotionType::Dynamic { mass: 0.0 })),
        "mass must be 1e-6 to 1e6 kg, given 0.0"
    );
    assert_eq!(
        text(world.set_friction(free, -0.5)),
        "friction must be 0 or more, and finite, given -0.5"
    );
    assert_eq!(
        text(world.set_restitution(free, 1.5)),
        "restitution must be 0 to 1, given 1.5"
    );
    assert_eq!(world.rigid_body(free).unwrap().friction(), 0.5);
}

#[test]
fn body_error_names_material_and_field() {
    let grid = || VoxelGrid::<Dim2>::from_materials([2, 1, 1], 1.0, vec![1, 2]).unwrap();
    let soft = Material::default();
    let number = 2;
    let missing = SoftBody::new(grid(), &[soft]).map(|_| ());
    assert_eq!(missing, Err(Error::MissingMaterial { number, given: 1 }));
    let mut heavy = soft;
    heavy.density = f32::INFINITY;
    let error = SoftBody::with_options(grid(), &[soft, heavy], Law::default(), Grading::Graded);
    assert_eq!(
        error.map(|_| ()).unwrap_err().to_string(),
        "material 2: density must be positive and finite, given inf"
    );
    let mut squashy = soft;
    squashy.elasticity.poisson = 0.5;
    let error = SoftBody::new(grid(), &[squashy, soft]);
    assert_eq!(
        error.map(|_| ()).unwrap_err().to_string(),
        "material 1: poisson must be 0 to 0.49, given 0.5"
    );
}

#[test]
fn grid_error_reports_empty_grid() {
    let empty = VoxelGrid::<Dim3>::from_fn([2, 2, 2], 1.0, |_| 0);
    assert_eq!(empty, Err(Error::EmptyGrid));
    assert_eq!(
        empty.unwrap_err().to_string(),
        "the grid is empty: at least one voxel must be solid"
    );
}
