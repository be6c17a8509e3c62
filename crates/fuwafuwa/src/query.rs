//! What is where in a world: what a ray meets, what is nearest to a place, what is there, what overlaps a shape.

mod figure;
mod tree;

use crate::body::Body;
use crate::dim::Dim;
use crate::handle::{BodyId, RigidId};
use crate::ids::{ElementId, PieceId};
use crate::rigid::Rigid;
use crate::shape::{Bounds, Shape, Vector, flat};
use crate::vector::{dot, is_finite, length, minus, plus, scaled};
use crate::view::Facet;
use crate::world::World;
use figure::{
    is_in_block, nearest_on_segment, nearest_on_triangle, ray_meets_segment, ray_meets_triangle,
};
use std::cell::OnceCell;
use std::collections::BTreeSet;
use tree::{Tree, around_all, distance_from, entry};

/// The place on an edge where it is closest to a shape is narrowed down so many times, by a third of what is left: to
/// 6·10⁻⁵ of the edge, less than a figure may reach beyond its ends.
const NARROWINGS: usize = 24;

/// Whether a thing counts.
type Counts<'a> = &'a dyn Fn(Thing) -> bool;

/// Something in a world that can be found.
#[derive(Copy, Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Thing {
    /// Something rigid.
    Rigid(RigidId),
    /// A soft body.
    Soft {
        /// The body.
        body: BodyId,
        /// Its piece.
        piece: PieceId,
        /// Its element.
        element: ElementId,
        /// The number of the material there.
        material: u8,
    },
}

/// A place on the surface of something.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Found {
    /// What it is.
    pub thing: Thing,
    /// Where [m].
    pub at: Vector,
    /// Out of it, of length 1.
    pub normal: Vector,
    /// How far it is from where it was looked for [m].
    pub distance: f32,
}

/// Answers about a world as it is now. To make them costs about as much as to look at all bare faces once; each answer
/// costs little then. Sensors are never found, and layers do not count. A condition says of each thing whether it counts.
///
/// ```
/// use fuwafuwa::{Body, Dim3, Material, Queries, Settings, Thing, VoxelGrid, World};
///
/// let mut world = World::new(Settings::default())?;
/// let grid = VoxelGrid::<Dim3>::ball(16, 1.0)?;
/// let ball = world.add_body(Body::new(grid, &[Material::default()])?);
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
    facets: Vec<(BodyId, Facet)>,
    surface: Tree,
    /// The blocks of all elements, once they are asked for.
    filled: OnceCell<Filled>,
}

/// What elements fill: blocks, with who they are of, and the corners of each in a row.
struct Filled {
    things: Vec<Thing>,
    corners: Vec<Vector>,
    tree: Tree,
}

impl<'a, D: Dim> Queries<'a, D> {
    /// About a world.
    #[inline(never)]
    pub fn new(world: &'a World<D>) -> Self {
        let mut facets = Vec::new();
        for (id, body) in world.bodies().entries() {
            facets.extend(body.facets().map(|facet| (id, facet)));
        }
        let bounds = |(_, facet): &(BodyId, Facet)| around_all(corners::<D>(facet));
        let boxes: Vec<Bounds> = facets.iter().map(bounds).collect();
        Self {
            world,
            facets,
            surface: Tree::new(&boxes),
            filled: OnceCell::new(),
        }
    }

    /// What is rigid and not a sensor: that touches nobody.
    fn rigids(&self) -> impl Iterator<Item = (RigidId, &Rigid)> + Clone {
        let all = self.world.rigids().entries();
        all.filter(|(_, rigid)| !rigid.is_sensor)
    }

    /// The first surface that a ray meets, from inside or from outside, no further than `most` [m] from where it begins,
    /// which may be infinite. Nothing when the direction has no length, another number is not finite, or `most` is
    /// negative.
    #[inline(never)]
    pub fn ray(
        &self,
        from: Vector,
        direction: Vector,
        most: f32,
        counts: Counts<'_>,
    ) -> Option<Found> {
        let (from, direction) = (flat::<D>(from), flat::<D>(direction));
        let long = direction.map(f64::from);
        let direction = scaled(long, 1.0 / dot(long, long).sqrt()).map(|k| k as f32);
        if !is_finite(direction) || !is_finite(from) {
            return None;
        }
        let mut best = Best::within(most)?;
        for (id, rigid) in self.rigids() {
            let met = rigid.shape().ray(from, direction);
            let met =
                met.map(|(distance, normal)| (distance, along(from, direction, distance), normal));
            best.consider(met, counts, || Thing::Rigid(id));
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

    /// The place on any surface that is nearest to `at` [m], from inside or from outside, no further than `most` [m], which
    /// may be infinite. Nothing when another number is not finite, or `most` is negative.
    #[inline(never)]
    pub fn nearest(&self, at: Vector, most: f32, counts: Counts<'_>) -> Option<Found> {
        let at = flat::<D>(at);
        if !is_finite(at) {
            return None;
        }
        let mut best = Best::within(most)?;
        for (id, rigid) in self.rigids() {
            let (gap, normal) = rigid.shape().distance(at);
            let met = (gap.abs(), along(at, normal, -gap), normal);
            best.consider(Some(met), counts, || Thing::Rigid(id));
        }
        self.surface.search(
            best.least,
            |bounds| distance_from(bounds, at),
            |index| {
                let (body, facet) = &self.facets[index];
                let nearest = nearest_on::<D>(facet, at);
                let met = (length(minus(nearest, at)), nearest, facet.normal);
                best.consider(Some(met), counts, || self.thing(*body, facet))
            },
        );
        best.found
    }

    /// All that is at a place [m]: things that are forced into each other may be more than one. Nothing where a number is
    /// not finite.
    #[inline(never)]
    pub fn at(&self, at: Vector) -> Vec<Thing> {
        let at = flat::<D>(at);
        if !is_finite(at) {
            return Vec::new();
        }
        let rigids = self.rigids();
        let rigids = rigids.filter(|(_, rigid)| rigid.shape().distance(at).0 <= 0.0);
        let mut things: Vec<Thing> = rigids.map(|(id, _)| Thing::Rigid(id)).collect();
        let filled = self.filled.get_or_init(|| Filled::new(self.world));
        filled.tree.search(
            f32::INFINITY,
            // All whose box the place is in, and none else.
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
        // Neighbours share the place between them.
        things.sort();
        things.dedup_by_key(|thing| thing.owner());
        things
    }

    /// All that overlaps a shape: what is rigid, and each piece whose surface reaches into it or that has it all inside,
    /// with one of its elements.
    #[inline(never)]
    pub fn overlapping(&self, shape: &Shape) -> Vec<Thing> {
        let shape = shape.seen_in::<D>();
        let rigids = self.rigids();
        let overlaps = |(_, rigid): &(RigidId, &Rigid)| overlap(rigid.shape(), &shape);
        let rigids = rigids.filter(overlaps);
        let mut things: BTreeSet<Thing> = rigids.map(|(id, _)| Thing::Rigid(id)).collect();
        self.surface.search(
            f32::INFINITY,
            |&[low, high]| {
                let half = scaled(minus(high, low), 0.5);
                let distance = shape.distance(plus(low, half)).0 - length(half);
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
        // One that is all inside a piece is near no face of it.
        let [low, high] = shape.bounds();
        things.extend(self.at(scaled(plus(low, high), 0.5)));
        let mut things: Vec<Thing> = things.into_iter().collect();
        things.dedup_by_key(|thing| thing.owner());
        things
    }

    fn thing(&self, body: BodyId, facet: &Facet) -> Thing {
        soft(body, &self.world.bodies()[body], facet.element)
    }
}

impl Thing {
    /// What it is of: something rigid, or a piece of a body.
    pub fn owner(self) -> (Option<RigidId>, Option<(BodyId, PieceId)>) {
        match self {
            Self::Rigid(rigid) => (Some(rigid), None),
            Self::Soft { body, piece, .. } => (None, Some((body, piece))),
        }
    }
}

impl Filled {
    fn new<D: Dim>(world: &World<D>) -> Self {
        let (mut things, mut corners) = (Vec::new(), Vec::new());
        for (id, body) in world.bodies().entries() {
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

fn soft<D: Dim>(id: BodyId, body: &Body<D>, element: ElementId) -> Thing {
    let mesh = body.mesh();
    let alive = mesh.element(element).expect("the element is alive");
    Thing::Soft {
        body: id,
        piece: body.pieces().of_element(element),
        element,
        material: body.grid().material(mesh.first_voxel(alive)),
    }
}

/// The nearest that was found so far.
struct Best {
    found: Option<Found>,
    /// What is nearer than this counts.
    least: f32,
}

impl Best {
    /// Nothing yet; nothing can be found within what is negative or not a number.
    fn within(most: f32) -> Option<Self> {
        let found = None;
        // Up to there, and not only before.
        let least = most.next_up();
        (most >= 0.0).then_some(Self { found, least })
    }

    /// Takes up what is nearer and counts: its distance, place and normal. Returns the distance if it is taken.
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
                self.found = Some(Found {
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
    plus(from, scaled(direction, far))
}

/// The corners of a bare face.
fn corners<D: Dim>(facet: &Facet) -> impl Iterator<Item = Vector> {
    facet.corners.into_iter().take(D::CORNERS / 2)
}

/// A quad as two triangles.
fn triangles([a, b, c, d]: [Vector; 4]) -> [[Vector; 3]; 2] {
    [[a, b, c], [a, c, d]]
}

/// How far along a ray, whose direction is of length 1, a bare face is [m]. In the plane a face is a segment, in space two triangles.
fn distance_to<D: Dim>(facet: &Facet, from: Vector, direction: Vector) -> Option<f32> {
    let [a, b, ..] = facet.corners;
    if D::N == 2 {
        return ray_meets_segment(from, direction, [a, b]);
    }
    let met = triangles(facet.corners).map(|three| ray_meets_triangle(from, direction, three));
    met.into_iter().flatten().reduce(f32::min)
}

/// The place on a bare face that is nearest.
fn nearest_on<D: Dim>(facet: &Facet, at: Vector) -> Vector {
    let [a, b, ..] = facet.corners;
    if D::N == 2 {
        return nearest_on_segment(at, [a, b]);
    }
    let [one, other] = triangles(facet.corners).map(|three| nearest_on_triangle(at, three));
    let squared = |place: Vector| dot(minus(place, at), minus(place, at));
    if squared(other) < squared(one) {
        other
    } else {
        one
    }
}

/// Whether a bare face reaches into a shape: the least distance of its points is narrowed down, which is exact, as
/// distances from something convex have one valley.
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
            let end = |to: Vector| plus(a, scaled(minus(to, a), share));
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

/// Whether two shapes overlap; half-spaces do unless they face each other with something in between.
fn overlap(a: &Shape, b: &Shape) -> bool {
    match (*a, *b) {
        (
            Shape::HalfSpace { normal, offset },
            Shape::HalfSpace {
                normal: other,
                offset: beyond,
            },
        ) => dot(normal, other) > -1.0 + 1e-6 || offset + beyond >= 0.0,
        _ => a.gap(b).0 <= 0.0,
    }
}
