//! Queries on a world: rays, nearest surfaces, points, overlaps.

use crate::blades::Blades;
use crate::vectors::vector;
use fuwafuwa::{
    Dim, Dim2, Dim3, DimVector, Layers, Material, ObjectRef, PieceId, QueryFilter, QueryHit,
    QueryOverlap, Ray, RigidBody, RigidBodyHandle, Rotation, Shape, SoftBody, SoftBodyHandle, Vec3,
    VoxelGrid, World, WorldConfig,
};
use glam::DVec3;

fn weightless<D: Dim>() -> WorldConfig<D> {
    WorldConfig {
        gravity: D::Vector::ZERO,
        ..WorldConfig::default()
    }
}

/// Returns a ball of two materials centred at the origin. Material 2 fills the inner part, a ball of 0.25 m
/// radius.
fn ball<D: Dim>(n: usize) -> SoftBody<D> {
    let half = Vec3::new(0.5, 0.5, if D::N == 2 { 0.0 } else { 0.5 });
    let apart = |at: Vec3| (at - half).length();
    let size = [n, n, D::depth(n)];
    let grid = VoxelGrid::from_centres(size, 1.0 / n as f32, |at| match apart(at) {
        distance if distance < 0.25 => 2,
        distance if distance < 0.5 => 1,
        _ => 0,
    });
    let body = SoftBody::new(grid.unwrap(), &[Material::default(); 2]).unwrap();
    body.translated(D::Vector::from_vec3(-half))
}

/// Returns a world with a ball, a floor and a capsule. The ball is rotated, so that no element is aligned
/// with an axis.
fn world<D: Dim>() -> World<D> {
    let mut world = World::new(weightless()).unwrap();
    world
        .add_soft_body(ball::<D>(16).rotated_about(Rotation::in_plane(0.4), D::Vector::ZERO))
        .unwrap();
    let floor = Shape::half_space(D::Vector::Y, vector(0.0, -2.0, 0.0));
    world
        .add_rigid_body(RigidBody::fixed(floor).with_friction(0.3))
        .unwrap();
    let bar = Shape::capsule(vector(3.0, -1.0, 0.0), vector(3.0, 1.0, 0.0), 0.25);
    world
        .add_rigid_body(RigidBody::fixed(bar).with_friction(0.3))
        .unwrap();
    world
}

/// Returns unit vectors that point in all directions.
fn around<D: Dim>() -> Vec<D::Vector> {
    let turned = |k: usize| {
        let axis = match D::N {
            2 => Vec3::Z,
            _ => Vec3::new(0.3, 0.8, 1.0),
        };
        Rotation::about(axis, 0.37 * k as f32).apply(D::Vector::X)
    };
    (0..40).map(turned).collect()
}

fn check_rays<D: Dim>() {
    let world = world::<D>();
    let body = world.nth_soft_body(0).unwrap();
    let voxel = 1.0 / 16.0;
    let soft_hit = |origin, direction, max_distance| {
        let filter = QueryFilter::default().only_soft();
        world.ray_cast(Ray::new(origin, direction), max_distance, filter)
    };
    let hit = |origin, direction| {
        world.ray_cast(Ray::new(origin, direction), 20.0, QueryFilter::default())
    };
    for direction in around::<D>() {
        let from = direction * 5.0;
        let inwards = -direction;
        let found = soft_hit(from, inwards, 10.0).unwrap();
        // The surface consists of the faces of voxels, which deviate from the sphere of 0.5 m radius by up to
        // two voxel widths.
        assert!(
            (found.distance - 4.5).abs() < 2.0 * voxel,
            "{direction:?} {found:?}"
        );
        let piece = PieceId(0);
        assert_eq!(found.object, ObjectRef::Piece { body, piece });
        assert_eq!(found.element.map(|element| element.material), Some(1));
        assert!(found.normal.dot(direction) > 0.0, "{found:?}");
        // A ray that starts inside the ball hits the surface from inside.
        let out = soft_hit(D::Vector::ZERO, direction, 10.0).unwrap();
        assert!((out.distance - 0.5).abs() < 2.0 * voxel, "{out:?}");
        assert!((out.distance + found.distance - 5.0).abs() < 1e-4);
        assert!(soft_hit(from, direction, 10.0).is_none());
        assert!(soft_hit(from, inwards, found.distance - 0.01).is_none());
        assert!(soft_hit(from, inwards, found.distance).is_some());
        assert_eq!(
            soft_hit(from, inwards * 7.0, 10.0).map(|hit| hit.object),
            Some(found.object)
        );
    }
    // Without a filter, a ray hits the first object on its way, soft or rigid.
    let first = |from| hit(from, vector(-1.0, 0.0, 0.0)).unwrap();
    let bar = first(vector(9.0, 0.0, 0.0));
    assert!(bar.object.rigid_body().is_some() && bar.element.is_none());
    assert!(
        (bar.distance - 5.75).abs() < 1e-3 && (bar.normal[0] - 1.0).abs() < 1e-3,
        "{bar:?}"
    );
    assert!(first(vector(2.0, 0.0, 0.0)).object.soft_body().is_some());
    let floor = hit(vector(9.0, 0.0, 0.0), vector(0.1, -1.0, 0.0)).unwrap();
    assert!((floor.point[1] + 2.0).abs() < 1e-3, "{floor:?}");
    let ray = Ray::new(vector(9.0, 0.0, 0.0), vector(-1.0, 0.0, 0.0));
    for max_distance in [-1.0, f32::NAN] {
        assert_eq!(
            world.ray_cast(ray, max_distance, QueryFilter::default()),
            None
        );
    }
    for (from, direction) in [
        (D::Vector::splat(f32::NAN), D::Vector::X),
        (D::Vector::ZERO, D::Vector::ZERO),
    ] {
        assert!(hit(from, direction).is_none());
    }
}

#[test]
fn ray_hits_first_surface() {
    check_rays::<Dim2>();
    check_rays::<Dim3>();
}

fn check_nearest<D: Dim>() {
    let world = world::<D>();
    let closest =
        |point, max_distance| world.closest_point(point, max_distance, QueryFilter::default());
    for direction in around::<D>() {
        for far in [0.2, 0.8, 1.4] {
            let at = direction * far;
            let filter = QueryFilter::default().only_soft();
            let found = world.closest_point(at, 9.0, filter).unwrap();
            // No corner of an exposed face may be nearer than the closest point found.
            let (_, body) = world.soft_bodies().next().unwrap();
            let corners = body
                .skin_facets()
                .flat_map(|facet| facet.corners.into_iter().take(D::CORNERS / 2));
            let apart = |corner: Vec3| (corner - at.to_vec3()).length();
            let corner = corners.map(apart).fold(f32::INFINITY, f32::min);
            assert!(found.distance <= corner + 1e-5, "{found:?} {corner}");
            assert!(corner - found.distance < 1.0 / 16.0, "{found:?} {corner}");
            assert!((apart(found.point.to_vec3()) - found.distance).abs() < 1e-5);
        }
    }
    let floor = closest(vector(0.0, -1.9, 0.0), 9.0).unwrap();
    assert!(floor.object.rigid_body().is_some());
    assert!(
        (floor.point[1] + 2.0).abs() < 1e-5 && (floor.distance - 0.1).abs() < 1e-5,
        "{floor:?}"
    );
    assert!(closest(vector(0.0, 9.0, 0.0), 1.0).is_none());
    assert!(closest(D::Vector::splat(f32::NAN), 1.0).is_none());
}

#[test]
fn closest_point_is_on_the_nearest_surface() {
    check_nearest::<Dim2>();
    check_nearest::<Dim3>();
}

fn check_places<D: Dim>() {
    let world = world::<D>();
    let objects_at = |point| world.objects_at(point, QueryFilter::default());
    let material = |at: D::Vector| match objects_at(at)[..] {
        [] => 0,
        [QueryOverlap { element, .. }] => element.unwrap().material,
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
            // Elements at the boundary between both materials are single voxels (level 0), so each has a
            // single material.
            assert_eq!(material(at), expect, "{at:?}");
        }
    }
    for point in [vector(3.0, 0.0, 0.0), vector(7.0, -3.0, 0.0)] {
        let found = objects_at(point);
        assert!(found.len() == 1 && found[0].object.rigid_body().is_some());
    }
    assert!(objects_at(D::Vector::splat(f32::NAN)).is_empty());
}

#[test]
fn objects_at_returns_objects_and_materials() {
    check_places::<Dim2>();
    check_places::<Dim3>();
}

fn check_overlaps<D: Blades>() {
    let mut world = world::<D>();
    let body = world.nth_soft_body(0).unwrap();
    let count = |world: &World<D>, shape: Shape<D>| {
        let found = world.overlaps(&shape, QueryFilter::default()).unwrap();
        let soft = found.iter().filter(|found| found.element.is_some()).count();
        [found.len() - soft, soft]
    };
    let probe = |x: f32, radius: f32| Shape::ball(radius).translated(vector(x, 0.0, 0.0));
    assert_eq!(count(&world, probe(0.0, 0.05)), [0, 1], "inside");
    assert_eq!(count(&world, probe(0.9, 0.45)), [0, 1], "over its edge");
    assert_eq!(count(&world, probe(1.1, 0.3)), [0, 0], "beside it");
    assert_eq!(count(&world, probe(0.0, 2.5)), [1, 1], "around it");
    assert_eq!(count(&world, probe(0.0, 2.9)), [2, 1], "as far as the bar");
    let needle = Shape::capsule(vector(-3.0, 0.013, 0.0), vector(2.0, 0.013, 0.0), 0.001);
    assert_eq!(count(&world, needle), [0, 1], "through it");
    // After a cut in two, the overlap query must list two pieces of the body.
    let blade = D::blade(Vec3::new(0.0, -1.0, -1.0), Vec3::Y * 2.0, Vec3::Z * 2.0);
    world.cut(body, &blade).unwrap();
    assert_eq!(count(&world, probe(0.0, 0.3)), [0, 2], "across the cut");
}

#[test]
fn overlaps_returns_pieces_and_rigid_bodies() {
    check_overlaps::<Dim2>();
    check_overlaps::<Dim3>();
}

/// Returns a world with objects in a row along the first axis: a sensor, two equal boxes and a soft cube. The
/// second box is in a different collision layer.
fn row<D: Dim>() -> (World<D>, [RigidBodyHandle; 3], SoftBodyHandle) {
    let mut world = World::new(weightless()).unwrap();
    let cuboid = |x| Shape::cuboid(D::Vector::splat(0.5)).translated(vector(x, 0.0, 0.0));
    let wall = |x| RigidBody::fixed(cuboid(x)).with_friction(0.3);
    let gate = wall(-2.0).with_sensor(true);
    let first = wall(0.0);
    let second = wall(2.0).with_layers(Layers {
        memberships: 0b10,
        filters: 0b01,
    });
    let rigids = [gate, first, second].map(|rigid| world.add_rigid_body(rigid).unwrap());
    let half = Vec3::new(0.5, 0.5, if D::N == 2 { 0.0 } else { 0.5 });
    let cube = SoftBody::new(VoxelGrid::cube(4, 1.0).unwrap(), &[Material::default()]).unwrap();
    let cube = cube.translated(vector(4.0 - half.x, -half.y, -half.z));
    let cube = world.add_soft_body(cube).unwrap();
    (world, rigids, cube)
}

fn check_filters<D: Blades>() {
    let (mut world, [gate, first, second], cube) = row::<D>();
    let ray = Ray::new(vector(-5.0, 0.1, 0.0), D::Vector::X);
    let hit = |world: &World<D>, filter: QueryFilter<'_>| {
        let hit = world.ray_cast(ray, 100.0, filter.clone());
        // If the ray hits an object, all other queries with this filter must find the same object.
        if let Some(hit) = hit {
            let behind = vector(hit.point[0] + 0.1, 0.1, 0.0);
            let probe = Shape::ball(0.05).translated(behind);
            let inside = world.objects_at(behind, filter.clone());
            assert_eq!(inside[0].object, hit.object);
            let near = world.overlaps(&probe, filter.clone()).unwrap();
            assert_eq!(near[0].object, hit.object);
            let closest = world.closest_point(hit.point, 1.0, filter).unwrap();
            assert_eq!(closest.object, hit.object);
        }
        hit.map(|hit| hit.object)
    };
    let all = QueryFilter::default();
    let rigid = |handle| Some(ObjectRef::RigidBody(handle));
    let piece = |piece| ObjectRef::Piece { body: cube, piece };
    assert_eq!(hit(&world, all.clone()), rigid(first));
    assert_eq!(hit(&world, all.clone().including_sensors()), rigid(gate));
    assert_eq!(hit(&world, all.clone().only_rigid()), rigid(first));
    assert_eq!(
        hit(&world, all.clone().only_soft()),
        Some(piece(PieceId(0)))
    );
    assert_eq!(hit(&world, all.clone().excluding(first)), rigid(second));
    let both = all.clone().excluding(first).excluding(second);
    assert_eq!(hit(&world, both.clone()), Some(piece(PieceId(0))));
    assert_eq!(hit(&world, both.excluding(cube)), None);
    // A query finds an object only if each of them collides with a layer of the other.
    let only_second = Layers {
        memberships: 0b01,
        filters: 0b10,
    };
    assert_eq!(hit(&world, all.clone().layers(only_second)), rigid(second));
    assert_eq!(
        hit(&world, all.clone().layers(Layers::default())),
        rigid(first)
    );
    let hidden = Layers {
        memberships: 0b100,
        filters: 0b100,
    };
    assert_eq!(hit(&world, all.clone().layers(hidden)), None);
    world.set_layers(cube, hidden).unwrap();
    let found = hit(&world, all.clone().layers(hidden));
    assert_eq!(found, Some(piece(PieceId(0))));
    let is_other = |object: ObjectRef| object != ObjectRef::RigidBody(first);
    assert_eq!(
        hit(&world, all.clone().with_predicate(&is_other)),
        rigid(second)
    );
    // The predicate itself queries the world.
    let is_isolated = |object: ObjectRef| {
        let centre = match object.rigid_body() {
            Some(rigid) => world.rigid_body(rigid).unwrap().position(),
            None => return false,
        };
        let region = Shape::ball(1.8).translated(centre);
        let near = world.overlaps(&region, QueryFilter::default());
        near.unwrap().len() == 2
    };
    assert_eq!(
        hit(&world, all.clone().with_predicate(&is_isolated)),
        rigid(first)
    );
    // Excluding one piece of a cut body leaves the other piece for the ray to hit.
    let blade = D::blade(Vec3::new(4.0, -1.0, -1.0), Vec3::Y * 2.0, Vec3::Z * 2.0);
    world.cut(cube, &blade).unwrap();
    let near = hit(&world, all.clone().only_soft()).unwrap();
    let far = hit(&world, all.only_soft().excluding(near)).unwrap();
    assert_eq!(
        (near.soft_body(), far.soft_body()),
        (Some(cube), Some(cube))
    );
    assert_ne!(near, far);
}

#[test]
fn filter_selects_objects_of_all_queries() {
    check_filters::<Dim2>();
    check_filters::<Dim3>();
}

#[test]
fn ray_prefers_the_lowest_object_among_equally_distant_ones() {
    let (mut world, [_, first, _], _) = row::<Dim3>();
    let ray = Ray::new(Vec3::new(-5.0, 0.1, 0.0), Vec3::X);
    let cuboid = world.rigid_body(first).unwrap().definition();
    let copy = world.add_rigid_body(cuboid).unwrap();
    let hit = |world: &World<Dim3>, filter| world.ray_cast(ray, 100.0, filter).unwrap().object;
    assert_eq!(
        hit(&world, QueryFilter::default()),
        ObjectRef::RigidBody(first)
    );
    let filter = QueryFilter::default().excluding(first);
    assert_eq!(hit(&world, filter), ObjectRef::RigidBody(copy));
    world.remove(first).unwrap();
    assert_eq!(
        hit(&world, QueryFilter::default()),
        ObjectRef::RigidBody(copy)
    );
}

/// Returns the distance along a ray with a unit direction to an exposed face. The formula is in double
/// precision and shares no code with the engine.
fn distance_to<D: Dim>(corners: [Vec3; 4], origin: Vec3, direction: Vec3) -> Option<f64> {
    let (origin, direction) = (origin.as_dvec3(), direction.as_dvec3());
    let volume = |a: DVec3, b: DVec3, c: DVec3| a.dot(b.cross(c));
    // Solves origin + t · direction = a + u · (b − a) + v · (c − a) by Cramer's rule.
    let triangle = |a: DVec3, b: DVec3, c: DVec3| {
        let (along, beside, reach) = (b - a, c - a, origin - a);
        let back = -direction;
        let all = volume(along, beside, back);
        let u = volume(reach, beside, back) / all;
        let v = volume(along, reach, back) / all;
        let t = volume(along, beside, reach) / all;
        (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t >= 0.0).then_some(t)
    };
    let [a, b, c, d] = corners.map(Vec3::as_dvec3);
    if D::N == 2 {
        // In 2D, the face is a segment. It is extended along the third axis to a strip, so that the formula
        // for triangles applies.
        let (up, down) = (|at: DVec3| at.with_z(9.0), |at: DVec3| at.with_z(-9.0));
        let halves = [
            triangle(down(a), down(b), up(b)),
            triangle(down(a), up(b), up(a)),
        ];
        return halves.into_iter().flatten().reduce(f64::min);
    }
    let halves = [triangle(a, b, c), triangle(a, c, d)];
    halves.into_iter().flatten().reduce(f64::min)
}

/// Results of all queries for a set of points and rays.
type Answers<D> = (Vec<Option<QueryHit<D>>>, Vec<Vec<QueryOverlap>>);

fn answers<D: Dim>(world: &World<D>) -> Answers<D> {
    let (mut hits, mut overlaps) = (Vec::new(), Vec::new());
    for (k, direction) in around::<D>().into_iter().enumerate() {
        let origin = direction * 4.0;
        let target: D::Vector = vector(0.03 * k as f32 - 0.6, 0.6 - 0.03 * k as f32, 0.0);
        let inwards = target - origin;
        for filter in [QueryFilter::default(), QueryFilter::default().only_soft()] {
            hits.push(world.ray_cast(Ray::new(origin, inwards), 20.0, filter.clone()));
            hits.push(world.closest_point(target, 20.0, filter.clone()));
            overlaps.push(world.objects_at(target, filter.clone()));
            let probe = Shape::ball(0.02 * k as f32 + 0.01).translated(direction * 0.6);
            overlaps.push(world.overlaps(&probe, filter).unwrap());
        }
    }
    (hits, overlaps)
}

/// Checks queries in two ways. All results must equal those of a cloned world, which has no search trees yet,
/// and ray casts must equal brute force over all exposed faces.
fn check_cache<D: Dim>(world: &World<D>, step: &str) {
    let known = answers(world);
    assert_eq!(known, answers(&world.clone()), "{step}");
    #[cfg(feature = "serde")]
    {
        let bytes = fuwafuwa::snapshot::save(world);
        let loaded = fuwafuwa::snapshot::load::<D>(&bytes).unwrap();
        assert_eq!(known, answers(&loaded), "{step}");
    }
    let facets = || world.soft_bodies().flat_map(|(_, body)| body.skin_facets());
    let mut hits = 0;
    for direction in around::<D>() {
        let origin = direction * 4.0;
        let inwards = -direction;
        let distance = |corners| distance_to::<D>(corners, origin.to_vec3(), inwards.to_vec3());
        let expected = facets().filter_map(|facet| distance(facet.corners));
        let expected = expected.reduce(f64::min);
        let filter = QueryFilter::default().only_soft();
        let found = world.ray_cast(Ray::new(origin, inwards), 20.0, filter);
        match (expected, found) {
            (Some(expected), Some(found)) => {
                let gap = (f64::from(found.distance) - expected).abs();
                assert!(gap < 1e-3, "{step}: {expected} {found:?}");
                hits += 1;
            }
            (None, None) => {}
            other => panic!("{step}: {other:?}"),
        }
    }
    assert!(hits > 5, "{step}: {hits} rays hit");
}

fn check_queries_after_changes<D: Blades>() {
    let mut world = World::<D>::new(WorldConfig::default()).unwrap();
    let floor = Shape::half_space(D::Vector::Y, vector(0.0, -1.0, 0.0));
    world
        .add_rigid_body(RigidBody::fixed(floor).with_friction(0.3))
        .unwrap();
    let free = Shape::ball(0.2).translated(vector(1.5, 0.0, 0.0));
    let free = world.add_rigid_body(RigidBody::dynamic(free, 1.0)).unwrap();
    let body = world.add_soft_body(ball::<D>(12)).unwrap();
    let other = world
        .add_soft_body(ball::<D>(8).translated(vector(0.0, 1.2, 0.0)))
        .unwrap();
    check_cache(&world, "start");
    for _ in 0..20 {
        world.step();
        assert_eq!(answers(&world), answers(&world.clone()));
    }
    check_cache(&world, "ticks");
    let blade = D::blade(Vec3::new(0.02, -2.0, -2.0), Vec3::Y * 4.0, Vec3::Z * 4.0);
    world.cut(body, &blade).unwrap();
    check_cache(&world, "cut");
    for _ in 0..10 {
        world.step();
    }
    check_cache(&world, "ticks after the cut");
    world.remove_piece(body, PieceId(1)).unwrap();
    check_cache(&world, "removed piece");
    world.translate(body, vector(0.1, 0.2, 0.0)).unwrap();
    world
        .rotate_about(other, Rotation::in_plane(0.7), D::Vector::ZERO)
        .unwrap();
    check_cache(&world, "moves");
    world
        .set_pose(free, vector(0.3, 1.1, 0.0), Rotation::NONE)
        .unwrap();
    check_cache(&world, "moved rigid body");
    let nodes = world[other].mesh().nodes();
    let nodes: Vec<_> = nodes.map(|(node, _)| node).collect();
    let changed = world.soft_body_mut(other).unwrap();
    for node in nodes {
        let (at, velocity, _) = changed.node_state(node);
        let at = at.to_vec3() * Vec3::new(1.2, 0.9, 1.0);
        let at = D::Vector::from_vec3(at);
        changed.set_node_state(node, at, velocity).unwrap();
    }
    check_cache(&world, "moved nodes");
    *world.soft_body_mut(other).unwrap() = ball::<D>(9);
    check_cache(&world, "replaced body");
    world.remove(body).unwrap();
    world.remove(free).unwrap();
    check_cache(&world, "removed bodies");
    let again = world
        .add_soft_body(ball::<D>(10).translated(vector(0.3, 0.0, 0.0)))
        .unwrap();
    check_cache(&world, "added body in the slot of another");
    world.soft_body_mut(again).unwrap().crumble();
    for _ in 0..20 {
        world.step();
    }
    check_cache(&world, "crumbs");
}

#[test]
fn queries_equal_those_of_a_fresh_world_after_any_change() {
    check_queries_after_changes::<Dim2>();
    check_queries_after_changes::<Dim3>();
}

#[test]
fn queries_from_several_threads_give_the_same_answers() {
    let mut world = world::<Dim3>();
    world.step();
    let expected = answers(&world.clone());
    std::thread::scope(|scope| {
        let threads: Vec<_> = (0..4).map(|_| scope.spawn(|| answers(&world))).collect();
        for thread in threads {
            assert_eq!(thread.join().unwrap(), expected);
        }
    });
}

#[test]
fn world_is_send_and_sync() {
    fn check<T: Send + Sync + Clone>() {}
    check::<World<Dim2>>();
    check::<World<Dim3>>();
}
