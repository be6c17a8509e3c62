//! Queries on a world: rays, nearest surfaces, points, overlaps.

use fuwafuwa::{
    Blade, Dim, Dim2, Dim3, Material, Queries, RigidBody, Rotation, Shape, SoftBody, Thing, Vector,
    VoxelGrid, World, WorldConfig,
};

const WEIGHTLESS: WorldConfig = WorldConfig {
    gravity: Vector::ZERO,
    drag: 0.0,
    most_substeps: 64,
    tick: fuwafuwa::TICK,
};

/// A ball of two materials centred at the origin; material 2 fills a radius of 0.25 m.
fn ball<D: Dim>(n: usize) -> SoftBody<D> {
    let half = Vector::new(0.5, 0.5, if D::N == 2 { 0.0 } else { 0.5 });
    let apart = |at: Vector| (at - half).length();
    let size = [n, n, D::depth(n)];
    let grid = VoxelGrid::from_centres(size, 1.0 / n as f32, |at| match apart(at) {
        distance if distance < 0.25 => 2,
        distance if distance < 0.5 => 1,
        _ => 0,
    });
    let body = SoftBody::new(grid.unwrap(), &[Material::default(); 2]).unwrap();
    body.translated(half.map(|k| -k).into())
}

/// The ball is rotated, so that no element is aligned with an axis.
fn world<D: Dim>() -> World<D> {
    let mut world = World::new(WEIGHTLESS).unwrap();
    world.add_soft_body(ball::<D>(16).rotated(Rotation::in_plane(0.4), Vector::ZERO));
    world
        .add_rigid_body(RigidBody::fixed(
            Shape::half_space(Vector::Y, Vector::new(0.0, -2.0, 0.0)),
            0.3,
        ))
        .unwrap();
    let bar = Shape::Capsule {
        from: Vector::new(3.0, -1.0, 0.0),
        to: Vector::new(3.0, 1.0, 0.0),
        radius: 0.25,
    };
    world.add_rigid_body(RigidBody::fixed(bar, 0.3)).unwrap();
    world
}

/// Directions all around.
fn around<D: Dim>() -> Vec<Vector> {
    let turned = |k: usize| {
        let axis = match D::N {
            2 => Vector::Z,
            _ => Vector::new(0.3, 0.8, 1.0),
        };
        Rotation::about(axis, 0.37 * k as f32).apply(Vector::X)
    };
    (0..40).map(turned).collect()
}

fn check_rays<D: Dim>() {
    let world = world::<D>();
    let queries = Queries::new(&world);
    let body = world.nth_soft_body(0).unwrap();
    let voxel = 1.0 / 16.0;
    let is_soft = |thing: Thing| matches!(thing, Thing::Soft { .. });
    for direction in around::<D>() {
        let from = direction.map(|k| 5.0 * k);
        let inwards = direction.map(|k| -k);
        let found = queries
            .ray(from.into(), inwards.into(), 10.0, &is_soft)
            .unwrap();
        // The surface consists of voxels, with corners up to two voxel widths from the sphere.
        assert!(
            (found.distance - 4.5).abs() < 2.0 * voxel,
            "{direction:?} {found:?}"
        );
        assert!(matches!(found.thing, Thing::Soft { body: it, material: 1, .. } if it == body));
        let facing: f32 = (0..3).map(|k| found.normal[k] * direction[k]).sum();
        assert!(facing > 0.0, "{found:?}");
        // A ray from inside hits the surface on its way out.
        let out = queries
            .ray(Vector::ZERO, direction.into(), 10.0, &is_soft)
            .unwrap();
        assert!((out.distance - 0.5).abs() < 2.0 * voxel, "{out:?}");
        assert!((out.distance + found.distance - 5.0).abs() < 1e-4);
        assert!(
            queries
                .ray(from.into(), direction.into(), 10.0, &is_soft)
                .is_none()
        );
        assert!(
            queries
                .ray(from.into(), inwards.into(), found.distance - 0.01, &is_soft)
                .is_none()
        );
        assert!(
            queries
                .ray(from.into(), inwards.into(), found.distance + 0.01, &is_soft)
                .is_some()
        );
    }
    // Without a filter, the ray hits the first object.
    let first = |from| queries.ray(from, Vector::NEG_X, 20.0, &|_| true).unwrap();
    let bar = first(Vector::new(9.0, 0.0, 0.0));
    assert!(matches!(bar.thing, Thing::RigidBody(_)));
    assert!(
        (bar.distance - 5.75).abs() < 1e-3 && (bar.normal[0] - 1.0).abs() < 1e-3,
        "{bar:?}"
    );
    assert!(is_soft(first(Vector::new(2.0, 0.0, 0.0)).thing));
    let floor = queries
        .ray(
            Vector::new(9.0, 0.0, 0.0),
            Vector::new(0.1, -1.0, 0.0),
            20.0,
            &|_| true,
        )
        .unwrap();
    assert!((floor.at[1] + 2.0).abs() < 1e-3, "{floor:?}");
    for (from, direction) in [([f32::NAN; 3], [1.0, 0.0, 0.0]), ([0.0; 3], [0.0; 3])] {
        assert!(
            queries
                .ray(from.into(), direction.into(), 9.0, &|_| true)
                .is_none()
        );
    }
}

#[test]
fn ray_hits_first_surface() {
    check_rays::<Dim2>();
    check_rays::<Dim3>();
}

fn check_nearest<D: Dim>() {
    let world = world::<D>();
    let queries = Queries::new(&world);
    for direction in around::<D>() {
        for far in [0.2, 0.8, 1.4] {
            let at = direction * far;
            let found = queries
                .nearest(at, 9.0, &|thing| matches!(thing, Thing::Soft { .. }))
                .unwrap();
            // No bare face may be nearer.
            let body = world.soft_bodies().first().unwrap();
            let corners = body
                .facets()
                .flat_map(|facet| facet.corners.into_iter().take(D::CORNERS / 2));
            let apart = |corner: Vector| (corner - at).length();
            let corner = corners.map(apart).fold(f32::INFINITY, f32::min);
            assert!(found.distance <= corner + 1e-5, "{found:?} {corner}");
            assert!(corner - found.distance < 1.0 / 16.0, "{found:?} {corner}");
            assert!((apart(found.at) - found.distance).abs() < 1e-5);
        }
    }
    let floor = queries
        .nearest(Vector::new(0.0, -1.9, 0.0), 9.0, &|_| true)
        .unwrap();
    assert!(matches!(floor.thing, Thing::RigidBody(_)));
    assert!(
        (floor.at[1] + 2.0).abs() < 1e-5 && (floor.distance - 0.1).abs() < 1e-5,
        "{floor:?}"
    );
    assert!(
        queries
            .nearest(Vector::new(0.0, 9.0, 0.0), 1.0, &|_| true)
            .is_none()
    );
    assert!(
        queries
            .nearest(Vector::splat(f32::NAN), 1.0, &|_| true)
            .is_none()
    );
}

#[test]
fn nearest_finds_closest_surface() {
    check_nearest::<Dim2>();
    check_nearest::<Dim3>();
}

fn check_places<D: Dim>() {
    let world = world::<D>();
    let queries = Queries::new(&world);
    let material = |at: Vector| match queries.at(at.into())[..] {
        [] => 0,
        [Thing::Soft { material, .. }] => material,
        ref other => panic!("{other:?}"),
    };
    for direction in around::<D>() {
        for far in [0.0, 0.1, 0.17, 0.35, 0.42, 0.58, 1.0] {
            let expect = match far {
                far if far < 0.25 => 2,
                far if far < 0.5 => 1,
                _ => 0,
            };
            let at = direction * far;
            // At the boundary of materials, elements are of level 0, so each has a single material.
            assert_eq!(material(at), expect, "{at:?}");
        }
    }
    assert!(matches!(
        queries.at(Vector::new(3.0, 0.0, 0.0))[..],
        [Thing::RigidBody(_)]
    ));
    assert!(matches!(
        queries.at(Vector::new(7.0, -3.0, 0.0))[..],
        [Thing::RigidBody(_)]
    ));
    assert!(queries.at(Vector::splat(f32::NAN)).is_empty());
}

#[test]
fn at_finds_objects_and_materials_at_point() {
    check_places::<Dim2>();
    check_places::<Dim3>();
}

fn check_overlaps<D: Dim>() {
    let mut world = world::<D>();
    let body = world.nth_soft_body(0).unwrap();
    let count = |world: &World<D>, shape: Shape| {
        let things = Queries::new(world).overlapping(&shape);
        let soft = things
            .iter()
            .filter(|thing| matches!(thing, Thing::Soft { .. }))
            .count();
        [things.len() - soft, soft]
    };
    let probe = |x: f32, radius: f32| Shape::Ball {
        centre: Vector::new(x, 0.0, 0.0),
        radius,
    };
    assert_eq!(count(&world, probe(0.0, 0.05)), [0, 1], "inside");
    assert_eq!(count(&world, probe(0.9, 0.45)), [0, 1], "over its edge");
    assert_eq!(count(&world, probe(1.1, 0.3)), [0, 0], "beside it");
    assert_eq!(count(&world, probe(0.0, 2.5)), [1, 1], "around it");
    assert_eq!(count(&world, probe(0.0, 2.9)), [2, 1], "as far as the bar");
    let needle = Shape::Capsule {
        from: Vector::new(-3.0, 0.013, 0.0),
        to: Vector::new(2.0, 0.013, 0.0),
        radius: 0.001,
    };
    assert_eq!(count(&world, needle), [0, 1], "through it");
    // Cut in two, the body counts as two pieces.
    let blade = Blade {
        from: Vector::new(0.0, -1.0, -1.0),
        across: Vector::new(0.0, 2.0, 0.0),
        along: Vector::new(0.0, 0.0, 2.0),
    };
    world.cut(body, &blade).unwrap();
    assert_eq!(count(&world, probe(0.0, 0.3)), [0, 2], "across the cut");
}

#[test]
fn overlapping_finds_pieces_and_rigid_bodies() {
    check_overlaps::<Dim2>();
    check_overlaps::<Dim3>();
}
