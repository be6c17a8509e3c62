//! Scene queries: ray cast, nearest point, objects at a point, overlap with a shape.

mod bounding_tree;
mod intersection;

use crate::foundation::arena::{RigidBodyHandle, SoftBodyHandle};
use crate::foundation::dim::Dim;
use crate::foundation::ids::{ElementId, PieceId};
use crate::rigid_body::RigidBody;
use crate::rigid_body::shape::{Bounds, Shape, Vector, flat};
use crate::soft_body::SoftBody;
use crate::soft_body::view::Facet;
use crate::world::World;
use bounding_tree::{Tree, around_all, distance_from, entry};
use intersection::{
    is_in_block, nearest_on_segment, nearest_on_triangle, ray_meets_segment, ray_meets_triangle,
};
use std::cell::OnceCell;
use std::collections::BTreeSet;

/// Ternary-search steps for the closest approach of a triangle to a shape, each of which keeps two thirds. 24
/// steps leave 6·10⁻⁵ of the edge, less than the tolerance of the primitives.
const NARROWINGS: usize = 24;

/// Filter of a query: returns whether an object counts.
type Counts<'a> = &'a dyn Fn(Thing) -> bool;

/// Object found by a query.
#[derive(Copy, Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Thing {
    /// Rigid body.
    RigidBody(RigidBodyHandle),
    /// Element of a soft body.
    Soft {
        /// Handle of the body.
        body: SoftBodyHandle,
        /// Piece number.
        piece: PieceId,
        /// Element.
        element: ElementId,
        /// Material number at the element.
        material: u8,
    },
}

/// Hit of a query: a point on the surface of an object.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct QueryHit {
    /// The object.
    pub thing: Thing,
    /// Position [m].
    pub at: Vector,
    /// Outward unit normal.
    pub normal: Vector,
    /// Distance from the origin of the query [m].
    pub distance: f32,
}

/// Scene queries on the present state of a world. Construction costs about one pass over all bare faces; each
/// query is then cheap. Sensors are never found, and layers are ignored. The filter of a query decides which
/// objects count.
///
/// ```
/// use fuwafuwa::{SoftBody, Dim3, Material, Queries, WorldConfig, Thing, VoxelGrid, World};
///
/// let mut world = World::new(WorldConfig::default())?;
/// let grid = VoxelGrid::<Dim3>::ball(16, 1.0)?;
/// let ball = world.add_body(SoftBody::new(grid, &[Material::default()])?);
/// let queries = Queries::new(&world);
/// let from_above = queries.ray([0.5, 3.0, 0.5], [0.0, -1.0, 0.0], 10.0, &|_| true);
/// let found = from_above.expect("the ball is below");
/// assert!((2.0..2.1).contains(&found.distance) && found.normal[1] > 0.99);
/// assert!(matches!(found.thing, Thing::Soft { body, material: 1, .. } if body == ball));
/// assert_eq!(queries.at([0.5; 3]).len(), 1);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Queries<'a, D: Dim> {
    world: &'a World<D>,
    facets: Vec<(SoftBodyHandle, Facet)>,
    surface: Tree,
    /// Filled cells of all elements, built by the first query that requires them.
    filled: OnceCell<Filled>,
}

/// Filled cells of elements: the object of each, its corners, and a tree over them.
struct Filled {
    things: Vec<Thing>,
    corners: Vec<Vector>,
    tree: Tree,
}

impl<'a, D: Dim> Queries<'a, D> {
    /// Builds the queries for a world.
    #[inline(never)]
    pub fn new(world: &'a World<D>) -> Self {
        let mut facets = Vec::new();
        for (id, body) in world.soft_bodies().entries() {
            facets.extend(body.facets().map(|facet| (id, facet)));
        }
        let bounds = |(_, facet): &(SoftBodyHandle, Facet)| around_all(corners::<D>(facet));
        let boxes: Vec<Bounds> = facets.iter().map(bounds).collect();
        Self {
            world,
            facets,
            surface: Tree::new(&boxes),
            filled: OnceCell::new(),
        }
    }

    /// Iterates over the rigid bodies, except sensors.
    fn rigids(&self) -> impl Iterator<Item = (RigidBodyHandle, &RigidBody)> + Clone {
        let all = self.world.rigid_bodies().entries();
        all.filter(|(_, rigid)| !rigid.is_sensor)
    }

    /// Casts a ray. Returns the first hit on any surface, from inside or outside, within the distance `most`
    /// [m], which may be infinite. Returns `None` if the direction has no length, another value is not
    /// finite, or `most` is negative.
    #[inline(never)]
    pub fn ray(
        &self,
        from: Vector,
        direction: Vector,
        most: f32,
        counts: Counts<'_>,
    ) -> Option<QueryHit> {
        let (from, direction) = (flat::<D>(from), flat::<D>(direction));
        let long = direction.as_dvec3();
        let direction = (long * (1.0 / long.length())).as_vec3();
        if !direction.is_finite() || !from.is_finite() {
            return None;
        }
        let mut best = Best::within(most)?;
        for (id, rigid) in self.rigids() {
            let met = rigid.shape().ray(from, direction);
            let met =
                met.map(|(distance, normal)| (distance, along(from, direction, distance), normal));
            best.consider(met, counts, || Thing::RigidBody(id));
        }
        self.surface.search(
            best.least,
            |bounds| entry(bounds, from, direction),
            |index| {
                let (body, facet) = &self.facets[index];
                let distance = distance_to::<D>(facet, from, direction);
                let met = distance.map(|far| (far, along(from, direction, far), facet.normal));
                best.consider(met, counts, || self.thing(*body, facet))
            },
        );
        best.found
    }

    /// Returns the point on any surface that is nearest to `at` [m], from inside or outside, within the
    /// distance `most` [m], which may be infinite. Returns `None` if another value is not finite, or `most`
    /// is negative.
    #[inline(never)]
    pub fn nearest(&self, at: Vector, most: f32, counts: Counts<'_>) -> Option<QueryHit> {
        let at = flat::<D>(at);
        if !at.is_finite() {
            return None;
        }
        let mut best = Best::within(most)?;
        for (id, rigid) in self.rigids() {
            let (gap, normal) = rigid.shape().distance(at);
            let met = (gap.abs(), along(at, normal, -gap), normal);
            best.consider(Some(met), counts, || Thing::RigidBody(id));
        }
        self.surface.search(
            best.least,
            |bounds| distance_from(bounds, at),
            |index| {
                let (body, facet) = &self.facets[index];
                let nearest = nearest_on::<D>(facet, at);
                let met = ((nearest - at).length(), nearest, facet.normal);
                best.consider(Some(met), counts, || self.thing(*body, facet))
            },
        );
        best.found
    }

    /// Returns the objects at a point [m]; more than one if objects overlap. Each rigid body and each piece
    /// is listed once. Returns nothing if a coordinate is not finite.
    #[inline(never)]
    pub fn at(&self, at: Vector) -> Vec<Thing> {
        let at = flat::<D>(at);
        if !at.is_finite() {
            return Vec::new();
        }
        let rigids = self.rigids();
        let rigids = rigids.filter(|(_, rigid)| rigid.shape().distance(at).0 <= 0.0);
        let mut things: Vec<Thing> = rigids.map(|(id, _)| Thing::RigidBody(id)).collect();
        let filled = self.filled.get_or_init(|| Filled::new(self.world));
        filled.tree.search(
            f32::INFINITY,
            // Visits exactly the cells with a bounding box around the point.
            |bounds| match distance_from(bounds, at) {
                0.0 => 0.0,
                _ => f32::INFINITY,
            },
            |block| {
                let corners = &filled.corners[block * D::CORNERS..][..D::CORNERS];
                if is_in_block::<D>(at, corners) {
                    things.push(filled.things[block]);
                }
                f32::INFINITY
            },
        );
        // Neighbouring elements share the point between them.
        things.sort();
        things.dedup_by_key(|thing| thing.owner());
        things
    }

    /// Returns the objects that overlap a shape: rigid bodies, and for each overlapping piece one of its
    /// elements. A piece overlaps if its surface intersects the shape, or if it contains the shape.
    #[inline(never)]
    pub fn overlapping(&self, shape: &Shape) -> Vec<Thing> {
        let shape = shape.seen_in::<D>();
        let rigids = self.rigids();
        let overlaps = |(_, rigid): &(RigidBodyHandle, &RigidBody)| overlap(rigid.shape(), &shape);
        let rigids = rigids.filter(overlaps);
        let mut things: BTreeSet<Thing> = rigids.map(|(id, _)| Thing::RigidBody(id)).collect();
        self.surface.search(
            f32::INFINITY,
            |&[low, high]| {
                let half = (high - low) * 0.5;
                let distance = shape.distance(low + half).0 - half.length();
                if distance <= 0.0 { 0.0 } else { f32::INFINITY }
            },
            |place| {
                let (body, facet) = &self.facets[place];
                if is_near::<D>(facet, &shape) {
                    things.insert(self.thing(*body, facet));
                }
                f32::INFINITY
            },
        );
        // A shape that lies completely inside a piece is near no face of it.
        let [low, high] = shape.bounds();
        things.extend(self.at((low + high) * 0.5));
        let mut things: Vec<Thing> = things.into_iter().collect();
        things.dedup_by_key(|thing| thing.owner());
        things
    }

    fn thing(&self, body: SoftBodyHandle, facet: &Facet) -> Thing {
        soft(body, &self.world.soft_bodies()[body], facet.element)
    }
}

impl Thing {
    /// Returns the owner of the object: a rigid body, or a piece of a body.
    pub fn owner(self) -> (Option<RigidBodyHandle>, Option<(SoftBodyHandle, PieceId)>) {
        match self {
            Self::RigidBody(rigid) => (Some(rigid), None),
            Self::Soft { body, piece, .. } => (None, Some((body, piece))),
        }
    }
}

impl Filled {
    fn new<D: Dim>(world: &World<D>) -> Self {
        let (mut things, mut corners) = (Vec::new(), Vec::new());
        for (id, body) in world.soft_bodies().entries() {
            for view in body.element_views() {
                let whole = if view.level == 0 { 1 } else { D::CORNERS };
                let children = (0..whole).filter(|child| view.children >> child & 1 == 1);
                for child in children {
                    things.push(soft(id, body, view.id));
                    corners.extend(view.child_corners::<D>(child));
                }
            }
        }
        let boxes = corners.chunks(D::CORNERS);
        let boxes = boxes.map(|corners| around_all(corners.iter().copied()));
        Self {
            tree: Tree::new(&boxes.collect::<Vec<Bounds>>()),
            things,
            corners,
        }
    }
}

fn soft<D: Dim>(id: SoftBodyHandle, body: &SoftBody<D>, element: ElementId) -> Thing {
    let mesh = body.mesh();
    let alive = mesh.element(element).expect("the element is alive");
    Thing::Soft {
        body: id,
        piece: body.pieces().of_element(element),
        element,
        material: body.grid().material(mesh.first_voxel(alive)),
    }
}

/// Nearest hit of a running query.
struct Best {
    found: Option<QueryHit>,
    /// Upper limit: only smaller distances count.
    least: f32,
}

impl Best {
    /// Returns the initial state; `None` if the distance is negative or NaN.
    fn within(most: f32) -> Option<Self> {
        let found = None;
        // A hit at exactly `most` counts, too.
        let least = most.next_up();
        (most >= 0.0).then_some(Self { found, least })
    }

    /// Takes a hit, given by distance, position and normal, if it is nearer and counts. Returns its distance,
    /// or infinity if it is not taken.
    fn consider(
        &mut self,
        met: Option<(f32, Vector, Vector)>,
        counts: Counts<'_>,
        thing: impl FnOnce() -> Thing,
    ) -> f32 {
        if let Some((distance, at, normal)) = met
            && distance < self.least
        {
            let thing = thing();
            if counts(thing) {
                self.least = distance;
                self.found = Some(QueryHit {
                    thing,
                    at,
                    normal,
                    distance,
                });
                return distance;
            }
        }
        f32::INFINITY
    }
}

fn along(from: Vector, direction: Vector, far: f32) -> Vector {
    from + direction * far
}

/// Returns the corners of a bare face.
fn corners<D: Dim>(facet: &Facet) -> impl Iterator<Item = Vector> {
    facet.corners.into_iter().take(D::CORNERS / 2)
}

/// Returns the two triangles of a quad.
fn triangles([a, b, c, d]: [Vector; 4]) -> [[Vector; 3]; 2] {
    [[a, b, c], [a, c, d]]
}

/// Returns the distance [m] along a ray with a unit direction to a bare face: a segment in 2D, two triangles
/// in 3D.
fn distance_to<D: Dim>(facet: &Facet, from: Vector, direction: Vector) -> Option<f32> {
    let [a, b, ..] = facet.corners;
    if D::N == 2 {
        return ray_meets_segment(from, direction, [a, b]);
    }
    let met = triangles(facet.corners).map(|three| ray_meets_triangle(from, direction, three));
    met.into_iter().flatten().reduce(f32::min)
}

/// Returns the point on a bare face that is nearest to `at`.
fn nearest_on<D: Dim>(facet: &Facet, at: Vector) -> Vector {
    let [a, b, ..] = facet.corners;
    if D::N == 2 {
        return nearest_on_segment(at, [a, b]);
    }
    let [one, other] = triangles(facet.corners).map(|three| nearest_on_triangle(at, three));
    let squared = |place: Vector| (place - at).dot(place - at);
    if squared(other) < squared(one) {
        other
    } else {
        one
    }
}

/// Returns whether a bare face intersects a shape. The ternary search for the closest approach is exact,
/// because the distance from a convex shape has a single minimum.
fn is_near<D: Dim>(facet: &Facet, shape: &Shape) -> bool {
    let gap = |from: Vector, to: Vector| {
        let radius = 0.0;
        Shape::Capsule { from, to, radius }.gap(shape).0
    };
    let [a, b, ..] = facet.corners;
    if D::N == 2 {
        return gap(a, b) <= 0.0;
    }
    triangles(facet.corners).into_iter().any(|[a, b, c]| {
        let across = |share: f32| {
            let end = |to: Vector| a + (to - a) * share;
            gap(end(b), end(c))
        };
        let (mut low, mut high) = (0.0f32, 1.0f32);
        if across(low) <= 0.0 || across(high) <= 0.0 {
            return true;
        }
        for _ in 0..NARROWINGS {
            let third = (high - low) / 3.0;
            let [left, right] = [low + third, high - third];
            let gaps = [across(left), across(right)];
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

/// Returns whether two shapes overlap. Two half-spaces do, unless they face each other with a gap in between.
fn overlap(a: &Shape, b: &Shape) -> bool {
    match (*a, *b) {
        (
            Shape::HalfSpace { normal, offset },
            Shape::HalfSpace {
                normal: other,
                offset: beyond,
            },
        ) => normal.dot(other) > -1.0 + 1e-6 || offset + beyond >= 0.0,
        _ => a.gap(b).0 <= 0.0,
    }
}
