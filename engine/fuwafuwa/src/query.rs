//! Scene queries: ray cast, closest point, objects at a point, overlap with a shape.

mod bounding_tree;
mod intersection;
pub mod query_cache;
pub mod query_filter;

use crate::error::Error;
use crate::foundation::arena::SoftBodyHandle;
use crate::foundation::dim::{Dim, DimVector};
use crate::foundation::ids::ElementId;
use crate::object_ref::ObjectRef;
use crate::rigid_body::RigidState;
use crate::rigid_body::shape::Shape;
use crate::rigid_body::solid::{Bounds, Solid};
use crate::soft_body::view::Facet;
use crate::world::World;
use bounding_tree::{distance_from, entry, overlap};
use glam::Vec3;
use intersection::{
    is_in_cell, nearest_on_segment, nearest_on_triangle, ray_meets_segment, ray_meets_triangle,
};
use query_cache::{BodyTrees, FilledCell, QueryTrees, TreeObject};
use query_filter::QueryFilter;
use std::sync::Arc;

/// Number of ternary-search steps that find the point of a triangle closest to a shape. Each step shrinks the
/// search interval to two thirds of its length. After 24 steps, 6·10⁻⁵ of a triangle edge remains, less than
/// the relative tolerance 10⁻⁴ of the intersection tests.
const TERNARY_STEPS: usize = 24;

/// Ray for [`World::ray_cast`].
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Ray<D: Dim> {
    /// World-space origin [m].
    pub origin: D::Vector,
    /// Direction, of any length except 0.
    pub direction: D::Vector,
}

impl<D: Dim> Ray<D> {
    /// Returns a ray from an origin [m] along a direction of any length except 0.
    pub fn new(origin: D::Vector, direction: D::Vector) -> Self {
        Self { origin, direction }
    }
}

/// Point on the surface of an object, found by a query.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct QueryHit<D: Dim> {
    /// Object on whose surface the point lies.
    pub object: ObjectRef,
    /// Element at `point`; `None` for a rigid body.
    pub element: Option<HitElement>,
    /// Position on the surface [m].
    pub point: D::Vector,
    /// Outward unit normal of the surface at `point`, also for queries that start inside the object.
    pub normal: D::Vector,
    /// Distance from the origin of the ray, or from the point given to the query, to `point` [m]. Never
    /// negative.
    pub distance: f32,
}

/// Object that contains a point or overlaps a shape.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub struct QueryOverlap {
    /// Piece or rigid body that contains the point or overlaps the shape.
    pub object: ObjectRef,
    /// Element that contains the point. For a shape, the element with the lowest id among the elements found
    /// to overlap it. `None` for a rigid body.
    pub element: Option<HitElement>,
}

/// Element of a soft body, found by a query.
#[derive(Copy, Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct HitElement {
    /// Id of the element.
    pub id: ElementId,
    /// Material number, counted from 1, of the first voxel in the element.
    pub material: u8,
}

/// Queries on the present state. Rays, closest points and overlap tests see the smooth surface of soft bodies, see
/// [`SoftBody::skin_facets`](crate::SoftBody::skin_facets); a point is inside a soft body if it is inside a voxel.
///
/// The world keeps search trees between queries. The first query after a change updates the trees, at a cost proportional to the number of exposed faces of the moved bodies. Further
/// queries reuse the trees and may run on several threads. Of equally distant objects, a query returns the
/// first one in the order of [`ObjectRef`].
impl<D: Dim> World<D> {
    /// Casts a ray. Returns the first hit on the surface of an object, from outside or inside, within
    /// `max_distance` [m], which may be infinite. Returns `None` if the direction has length 0, a coordinate
    /// is not finite, or `max_distance` is negative or NaN.
    ///
    /// ```
    /// use fuwafuwa::{Dim3, Material, QueryFilter, Ray, SoftBody, Vec3, VoxelGrid, World, WorldConfig};
    ///
    /// let mut world = World::new(WorldConfig::default())?;
    /// let grid = VoxelGrid::<Dim3>::ball(16, 1.0)?;
    /// let ball = world.add_soft_body(SoftBody::new(grid, &[Material::default()])?)?;
    /// let down = Ray::new(Vec3::new(0.5, 3.0, 0.5), Vec3::NEG_Y);
    /// let hit = world.ray_cast(down, 10.0, QueryFilter::default());
    /// let hit = hit.expect("the ball is below");
    /// assert!((2.0..2.1).contains(&hit.distance) && hit.normal.y > 0.99);
    /// assert_eq!(hit.object.soft_body(), Some(ball));
    /// assert_eq!(hit.element.map(|element| element.material), Some(1));
    /// assert_eq!(world.objects_at(Vec3::splat(0.5), QueryFilter::default()).len(), 1);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[inline(never)]
    pub fn ray_cast(
        &self,
        ray: Ray<D>,
        max_distance: f32,
        filter: QueryFilter<'_>,
    ) -> Option<QueryHit<D>> {
        let (origin, direction) = (ray.origin.to_vec3(), ray.direction.to_vec3());
        let long = direction.as_dvec3();
        let direction = (long * (1.0 / long.dot(long).sqrt())).as_vec3();
        if !direction.is_finite() || !origin.is_finite() {
            return None;
        }
        let along = |distance: f32| origin + (direction * distance);
        let cost = |bounds: &Bounds| entry(bounds, origin, direction);
        let query = Query::new(self, &filter);
        let mut closest = Closest::within(max_distance)?;
        query.search(max_distance, cost, |rank, at_least| {
            match query.object(rank) {
                VisitedObject::Rigid(rigid) => {
                    if let Some((distance, normal)) = rigid.shape().ray(origin, direction) {
                        let distance = distance.max(at_least);
                        closest.consider(distance, [rank, 0], || {
                            query.rigid_hit(rank, along(distance), normal, distance)
                        });
                    }
                }
                VisitedObject::Soft(trees) => {
                    let surface = &trees.surface;
                    surface.tree.search(closest.limit, cost, |index, at_least| {
                        let facet = &surface.items[index];
                        if let Some(distance) = distance_to::<D>(facet, origin, direction) {
                            let distance = distance.max(at_least);
                            closest.consider(distance, [rank, index], || {
                                query.facet_hit(trees.body, facet, along(distance), distance)
                            });
                        }
                        closest.limit
                    });
                }
                VisitedObject::Filtered => {}
            }
            closest.limit
        });
        closest.hit
    }

    /// Returns the closest point on the surface of any object, from outside or inside, within `max_distance`
    /// [m], which may be infinite. Returns `None` if a coordinate is not finite, or `max_distance` is
    /// negative or NaN.
    #[inline(never)]
    pub fn closest_point(
        &self,
        point: D::Vector,
        max_distance: f32,
        filter: QueryFilter<'_>,
    ) -> Option<QueryHit<D>> {
        let point = point.to_vec3();
        if !point.is_finite() {
            return None;
        }
        let cost = |bounds: &Bounds| distance_from(bounds, point);
        let query = Query::new(self, &filter);
        let mut closest = Closest::within(max_distance)?;
        query.search(max_distance, cost, |rank, at_least| {
            match query.object(rank) {
                VisitedObject::Rigid(rigid) => {
                    let (gap, normal) = rigid.shape().distance(point);
                    let distance = gap.abs().max(at_least);
                    closest.consider(distance, [rank, 0], || {
                        let on_surface = point + (normal * -gap);
                        query.rigid_hit(rank, on_surface, normal, distance)
                    });
                }
                VisitedObject::Soft(trees) => {
                    let surface = &trees.surface;
                    surface.tree.search(closest.limit, cost, |index, at_least| {
                        let facet = &surface.items[index];
                        let nearest = nearest_on::<D>(facet, point);
                        let distance = (nearest - point).length().max(at_least);
                        closest.consider(distance, [rank, index], || {
                            query.facet_hit(trees.body, facet, nearest, distance)
                        });
                        closest.limit
                    });
                }
                VisitedObject::Filtered => {}
            }
            closest.limit
        });
        closest.hit
    }

    /// Returns the objects that contain a point [m], each once, in the order of [`ObjectRef`]; more than one
    /// if objects overlap. Returns nothing if a coordinate is not finite.
    #[inline(never)]
    pub fn objects_at(&self, point: D::Vector, filter: QueryFilter<'_>) -> Vec<QueryOverlap> {
        let point = point.to_vec3();
        if !point.is_finite() {
            return Vec::new();
        }
        let query = Query::new(self, &filter);
        let mut found = query.pieces_at(point);
        query.search(
            0.0,
            |bounds| zero_if(contains(bounds, point)),
            |rank, _| {
                if let VisitedObject::Rigid(rigid) = query.object(rank)
                    && rigid.shape().distance(point).0 <= 0.0
                {
                    found.extend(query.rigid_overlap(rank));
                }
                0.0
            },
        );
        each_once(found)
    }

    /// Returns the objects that overlap a shape, each once, in the order of [`ObjectRef`]. A piece overlaps
    /// if its surface intersects the shape, or if it contains the shape.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] if the shape is not [valid](Shape::check).
    #[inline(never)]
    pub fn overlaps(
        &self,
        shape: &Shape<D>,
        filter: QueryFilter<'_>,
    ) -> Result<Vec<QueryOverlap>, Error> {
        shape.check().map_err(|error| error.of("shape"))?;
        let shape = shape.solid();
        let [low, high] = shape.bounds();
        let may_overlap = |bounds: &Bounds| match shape {
            Solid::HalfSpace { normal, offset } => {
                let [low, high] = *bounds;
                let deepest = Vec3::select(normal.cmplt(Vec3::ZERO), high, low);
                normal.dot(deepest) <= offset
            }
            _ => overlap(bounds, &[low, high]),
        };
        let query = Query::new(self, &filter);
        let mut found = Vec::new();
        let cost = |bounds: &Bounds| zero_if(may_overlap(bounds));
        query.search(0.0, cost, |rank, _| {
            match query.object(rank) {
                VisitedObject::Rigid(rigid) if shapes_overlap(rigid.shape(), &shape) => {
                    found.extend(query.rigid_overlap(rank));
                }
                VisitedObject::Soft(trees) => {
                    let surface = &trees.surface;
                    surface.tree.search(0.0, cost, |index, _| {
                        let facet = &surface.items[index];
                        if facet_intersects::<D>(facet, &shape) {
                            found.extend(query.facet_overlap(trees.body, facet));
                        }
                        0.0
                    });
                }
                _ => {}
            }
            0.0
        });
        // A piece that contains the whole shape may have no face near the shape. The pieces that contain the
        // centre of the shape's bounding box are therefore added.
        let centre = (low + high) * 0.5;
        if centre.is_finite() {
            found.extend(query.pieces_at(centre));
        }
        Ok(each_once(found))
    }
}

/// Running query: the world, its search trees, and the filter.
struct Query<'a, D: Dim> {
    world: &'a World<D>,
    trees: Arc<QueryTrees>,
    filter: &'a QueryFilter<'a>,
}

/// Object that the search of a query has reached.
enum VisitedObject<'a> {
    Rigid(&'a RigidState),
    Soft(&'a BodyTrees),
    /// Rejected by the filter.
    Filtered,
}

impl<'a, D: Dim> Query<'a, D> {
    fn new(world: &'a World<D>, filter: &'a QueryFilter<'a>) -> Self {
        Self {
            world,
            trees: world.query_cache.trees(world),
            filter,
        }
    }

    /// Visits first all unbounded objects with a cost of 0, then the bounded objects by
    /// [`Tree::search`](bounding_tree::Tree::search). `cost` returns the cost of a bounding box, for example
    /// its distance. Boxes with a cost above `limit` are skipped. `visit` receives the rank of an object in
    /// the order of [`ObjectRef`] and the cost of its box. The limit falls to the smallest value that `visit`
    /// has returned.
    fn search(
        &self,
        limit: f32,
        cost: impl Fn(&Bounds) -> f32,
        mut visit: impl FnMut(usize, f32) -> f32,
    ) {
        let trees = &self.trees;
        let mut limit = limit;
        for &rank in &trees.unbounded {
            limit = limit.min(visit(rank as usize, 0.0));
        }
        trees.tree.search(limit, cost, |index, at_least| {
            visit(trees.bounded[index] as usize, at_least)
        });
    }

    /// Returns the object with index `rank` in the order of [`ObjectRef`]. Returns
    /// [`VisitedObject::Filtered`] if the filter rejects the rigid body or the whole soft body.
    fn object(&self, rank: usize) -> VisitedObject<'_> {
        match self.trees.objects[rank] {
            TreeObject::Rigid(id) => {
                let rigid = &self.world.rigids[id];
                match self.filter.admits_rigid(rigid) {
                    true => VisitedObject::Rigid(rigid),
                    false => VisitedObject::Filtered,
                }
            }
            TreeObject::Soft(index) => {
                let trees = &self.trees.bodies[index as usize];
                let body = &self.world.bodies[trees.body];
                match self.filter.admits_body(trees.body, body) {
                    true => VisitedObject::Soft(trees),
                    false => VisitedObject::Filtered,
                }
            }
        }
    }

    fn rigid_overlap(&self, rank: usize) -> Option<QueryOverlap> {
        let TreeObject::Rigid(id) = self.trees.objects[rank] else {
            return None;
        };
        let object = ObjectRef::RigidBody(id);
        let element = None;
        { self.filter.admits(object) }.then_some(QueryOverlap { object, element })
    }

    fn rigid_hit(
        &self,
        rank: usize,
        point: Vec3,
        normal: Vec3,
        distance: f32,
    ) -> Option<QueryHit<D>> {
        let QueryOverlap { object, element } = self.rigid_overlap(rank)?;
        Some(QueryHit {
            object,
            element,
            point: D::Vector::from_vec3(point),
            normal: D::Vector::from_vec3(normal),
            distance,
        })
    }

    fn facet_overlap(&self, body: SoftBodyHandle, facet: &Facet) -> Option<QueryOverlap> {
        let object = ObjectRef::Piece {
            body,
            piece: facet.piece,
        };
        if !self.filter.admits(object) {
            return None;
        }
        let body = &self.world.bodies[body];
        let element = body.mesh().element(facet.element)?;
        let element = Some(HitElement {
            id: facet.element,
            material: body.grid().material(body.mesh().first_voxel(element)),
        });
        Some(QueryOverlap { object, element })
    }

    fn facet_hit(
        &self,
        body: SoftBodyHandle,
        facet: &Facet,
        point: Vec3,
        distance: f32,
    ) -> Option<QueryHit<D>> {
        let QueryOverlap { object, element } = self.facet_overlap(body, facet)?;
        Some(QueryHit {
            object,
            element,
            point: D::Vector::from_vec3(point),
            normal: D::Vector::from_vec3(facet.normal),
            distance,
        })
    }

    /// Returns the accepted pieces that contain a point, one entry for each filled cell that contains the
    /// point.
    fn pieces_at(&self, point: Vec3) -> Vec<QueryOverlap> {
        let cost = |bounds: &Bounds| zero_if(contains(bounds, point));
        let mut found = Vec::new();
        let trees = &self.trees;
        trees.tree.search(0.0, cost, |index, _| {
            let VisitedObject::Soft(trees) = self.object(trees.bounded[index] as usize) else {
                return 0.0;
            };
            let cells = trees.cells(&self.world.bodies[trees.body]);
            cells.tree.search(0.0, cost, |index, _| {
                let cell = &cells.items[index];
                if is_in_cell::<D>(point, &cell.corners[..D::CORNERS]) {
                    found.extend(self.cell_overlap(trees.body, cell));
                }
                0.0
            });
            0.0
        });
        found
    }

    fn cell_overlap(&self, body: SoftBodyHandle, cell: &FilledCell) -> Option<QueryOverlap> {
        let object = ObjectRef::Piece {
            body,
            piece: cell.piece,
        };
        let element = Some(HitElement {
            id: cell.element,
            material: cell.material,
        });
        { self.filter.admits(object) }.then_some(QueryOverlap { object, element })
    }
}

/// Closest hit that a query has found so far.
struct Closest<D: Dim> {
    hit: Option<QueryHit<D>>,
    /// Distance of the closest hit so far [m]; before the first hit, the maximum distance of the query.
    limit: f32,
    /// Rank of the hit object in the order of [`ObjectRef`], and index of the hit face. Of equally distant
    /// hits, the one with the lowest value is kept.
    rank: [usize; 2],
}

impl<D: Dim> Closest<D> {
    /// Returns a search without hits yet, or `None` if `max_distance` is negative or NaN.
    fn within(max_distance: f32) -> Option<Self> {
        (max_distance >= 0.0).then_some(Self {
            hit: None,
            limit: max_distance,
            rank: [usize::MAX; 2],
        })
    }

    /// Replaces the closest hit if the new hit is closer, or equally close with a lower rank. `hit` builds
    /// the new hit and is called only in these cases. It returns `None` if the filter rejects the object.
    fn consider(
        &mut self,
        distance: f32,
        rank: [usize; 2],
        hit: impl FnOnce() -> Option<QueryHit<D>>,
    ) {
        let is_closer = distance < self.limit
            || (distance == self.limit && distance < f32::INFINITY && rank < self.rank);
        if is_closer && let Some(hit) = hit() {
            (self.limit, self.rank) = (distance, rank);
            self.hit = Some(hit);
        }
    }
}

/// Sorts overlaps by object, and keeps one overlap for each object: the one with the lowest element id.
fn each_once(mut found: Vec<QueryOverlap>) -> Vec<QueryOverlap> {
    found.sort_by_key(|found| (found.object, found.element));
    found.dedup_by_key(|found| found.object);
    found
}

/// Returns 0 if the condition holds, otherwise infinity. As the cost of a box in `Query::search`, 0 visits
/// the box and infinity skips it.
fn zero_if(condition: bool) -> f32 {
    if condition { 0.0 } else { f32::INFINITY }
}

fn contains(bounds: &Bounds, point: Vec3) -> bool {
    overlap(bounds, &[point, point])
}

/// Splits a quad into two triangles along the diagonal from `a` to `c`.
fn triangles([a, b, c, d]: [Vec3; 4]) -> [[Vec3; 3]; 2] {
    [[a, b, c], [a, c, d]]
}

/// Returns the distance [m] at which a ray with a unit direction hits an exposed face, or `None` if it misses
/// the face. The face is a segment in 2D and two triangles in 3D.
fn distance_to<D: Dim>(facet: &Facet, from: Vec3, direction: Vec3) -> Option<f32> {
    let [a, b, ..] = facet.corners;
    if D::N == 2 {
        return ray_meets_segment(from, direction, [a, b]);
    }
    let met = triangles(facet.corners).map(|three| ray_meets_triangle(from, direction, three));
    met.into_iter().flatten().reduce(f32::min)
}

/// Returns the point on an exposed face that is nearest to `at`.
fn nearest_on<D: Dim>(facet: &Facet, at: Vec3) -> Vec3 {
    let [a, b, ..] = facet.corners;
    if D::N == 2 {
        return nearest_on_segment(at, [a, b]);
    }
    let [one, other] = triangles(facet.corners).map(|three| nearest_on_triangle(at, three));
    let squared = |place: Vec3| (place - at).dot(place - at);
    if squared(other) < squared(one) {
        other
    } else {
        one
    }
}

/// Returns whether an exposed face intersects a shape. In 3D, a ternary search finds the segment across each
/// triangle with the smallest gap to the shape. The gap has a single minimum, because the shape is convex.
fn facet_intersects<D: Dim>(facet: &Facet, shape: &Solid) -> bool {
    let gap = |from: Vec3, to: Vec3| {
        let radius = 0.0;
        Solid::Capsule { from, to, radius }.gap(shape).0
    };
    let [a, b, ..] = facet.corners;
    if D::N == 2 {
        return gap(a, b) <= 0.0;
    }
    triangles(facet.corners).into_iter().any(|[a, b, c]| {
        let gap_at = |share: f32| {
            let end = |to: Vec3| a + (to - a) * share;
            gap(end(b), end(c))
        };
        let (mut low, mut high) = (0.0f32, 1.0f32);
        if gap_at(low) <= 0.0 || gap_at(high) <= 0.0 {
            return true;
        }
        for _ in 0..TERNARY_STEPS {
            let third = (high - low) / 3.0;
            let [left, right] = [low + third, high - third];
            let gaps = [gap_at(left), gap_at(right)];
            if gaps[0] <= 0.0 || gaps[1] <= 0.0 {
                return true;
            }
            match gaps[0] > gaps[1] {
                true => low = left,
                false => high = right,
            }
        }
        false
    })
}

/// Returns whether two shapes overlap. Two half-spaces overlap, unless their surfaces are parallel and face
/// each other across a gap.
fn shapes_overlap(a: &Solid, b: &Solid) -> bool {
    match (*a, *b) {
        (
            Solid::HalfSpace { normal, offset },
            Solid::HalfSpace {
                normal: other,
                offset: beyond,
            },
        ) => normal.dot(other) > -1.0 + 1e-6 || offset + beyond >= 0.0,
        _ => a.gap(b).0 <= 0.0,
    }
}
