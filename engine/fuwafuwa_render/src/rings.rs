//! Smooth closed outlines of all pieces.
//!
//! A ring of exposed voxel sides becomes a smooth curve in three steps:
//!
//! 1. Every point moves onto the smooth surface that contacts see ([`SoftBody::skin_position`]). Points of a torn
//!    side get a roughness instead, because cracks run along the sides of voxels.
//! 2. Corners are smoothed, torn ones only a little. The result is the control polygon of a quadratic
//!    B-spline.
//! 3. The spline is sampled, more densely around corners.
//!
//! Both faces of a crack are smoothed alike, so that a closed crack stays closed.

use fuwafuwa::IndexVec;
use fuwafuwa::{Dim2, NodeId, SoftBody};
use glam::Vec2;

/// Closed curves around the pieces of a body. Keep the value between frames to reuse its buffers.
#[derive(Clone, Debug, Default)]
pub struct Outlines {
    sides: Vec<Side>,
    /// Index of the side that starts at a node, or `NONE`.
    side_from_node: IndexVec<NodeId, u32>,
    ring: Vec<Control>,
    planed: Vec<Vec2>,
    /// Points of all curves, one curve after another.
    pub points: Vec<OutlinePoint>,
    /// Range of each curve in `points`.
    pub spans: Vec<Span>,
}

/// Closed curve with its piece to the left.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Span {
    /// Index of the first point.
    pub start: usize,
    /// Index after the last point.
    pub end: usize,
    /// Enclosed area [m²]. Negative for a hole.
    pub area: f32,
}

/// Point of a curve.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct OutlinePoint {
    /// Position [m].
    pub at: Vec2,
    /// Outward unit normal.
    pub normal: Vec2,
    /// 1 on surfaces created by tearing, 0 on the original surface.
    pub fresh: f32,
    /// Strain ‖F − R‖ of the adjacent voxels.
    pub strain: f32,
    /// Pseudo-random value that stays the same for the point, 0 to 1. Varies the depth of torn bands.
    pub grain: f32,
}

/// Exposed side of a voxel.
#[derive(Copy, Clone, Debug)]
struct Side {
    to: NodeId,
    /// Index of the following side; `NONE` once the side was drawn.
    next: u32,
    start: Vec2,
    /// Smoothing offsets of the start and of the end of the side [m].
    moved: [Vec2; 2],
    is_fresh: bool,
    strain: f32,
    grain: f32,
}

/// Corner of the control polygon.
#[derive(Copy, Clone, Debug)]
struct Control {
    at: Vec2,
    /// Freshness of the sides before and after the corner: 1 on torn surfaces, 0 on the original surface.
    fresh: [f32; 2],
    strain: f32,
    grain: f32,
}

const NONE: u32 = u32::MAX;
/// Number of sides below which an outline is not smoothed: it has no staircase, only corners.
const SMALL: usize = 12;
/// Number of smoothing rounds for points of the original surface; `TORN_ROUNDS` is the number for torn
/// points.
const SURFACE_ROUNDS: usize = 4;
const TORN_ROUNDS: usize = 1;

impl Outlines {
    /// Computes the curves of a body.
    pub fn trace(&mut self, body: &SoftBody<Dim2>) {
        self.points.clear();
        self.spans.clear();
        self.gather_sides(body);
        for first in 0..self.sides.len() {
            self.gather_ring(first);
            if !self.ring.is_empty() {
                self.smooth_corners();
                self.draw_curve();
            }
        }
    }

    fn gather_sides(&mut self, body: &SoftBody<Dim2>) {
        let (mesh, size) = (body.mesh(), body.grid().voxel_size());
        self.sides.clear();
        self.side_from_node.clear();
        self.side_from_node.resize(mesh.node_capacity(), NONE);
        for facet in body.facets() {
            let Some(element) = mesh.element(facet.element) else {
                continue;
            };
            let corner = |index: usize| body.node_state(element.nodes[index]).0;
            let (right, up) = sides([0, 1, 2, 3].map(corner));
            let [from, to] = [0, 1].map(|end| mesh.node(facet.nodes[end]).at);
            let carried = |by: Vec2| by.x * right + by.y * up;
            let moved = match facet.is_torn {
                true => [from, to].map(|at| carried(roughness(at))),
                false => [0, 1].map(|end| {
                    let surface = body.skin_position(facet.nodes[end]);
                    (surface - facet.corners[end]).truncate()
                }),
            };
            self.side_from_node[facet.nodes[0]] = self.sides.len() as u32;
            self.sides.push(Side {
                to: facet.nodes[1],
                next: NONE,
                start: facet.corners[0].truncate(),
                moved,
                is_fresh: facet.is_torn,
                strain: strain(right, up, size),
                grain: grain(from),
            });
        }
        for side in &mut self.sides {
            side.next = self.side_from_node[side.to];
        }
    }

    /// Collects the control polygon of the closed outline that contains a side. The polygon is empty if that
    /// outline was drawn before.
    fn gather_ring(&mut self, first: usize) {
        self.ring.clear();
        let mut at = first;
        loop {
            let next = std::mem::replace(&mut self.sides[at].next, NONE);
            if next == NONE {
                return;
            }
            let next = next as usize;
            let control = Control::between(&self.sides[at], &self.sides[next]);
            self.ring.push(control);
            at = next;
        }
    }

    /// Moves points half-way to the midpoint of their neighbours. Torn points move in one round only, because
    /// torn surfaces should look rough. Points of the original surface move in several rounds, because
    /// contacts dent the voxels below, which are not smoothed.
    fn smooth_corners(&mut self) {
        let count = self.ring.len();
        if count < SMALL {
            return;
        }
        for round in 0..SURFACE_ROUNDS {
            self.planed.clear();
            let ring = &self.ring;
            self.planed.extend((0..count).map(|k| {
                let is_torn = ring[k].fresh != [0.0; 2];
                let [before, after] =
                    [(k + count - 1) % count, (k + 1) % count].map(|k| ring[k].at);
                let share = if is_torn && round >= TORN_ROUNDS {
                    0.0
                } else {
                    0.5
                };
                ring[k].at.lerp(before.midpoint(after), share)
            }));
            for (control, &at) in self.ring.iter_mut().zip(&self.planed) {
                control.at = at;
            }
        }
    }

    /// Appends the B-spline of the control polygon to the curves.
    fn draw_curve(&mut self) {
        let start = self.points.len();
        let count = self.ring.len();
        for k in 0..count {
            let control = self.ring[k];
            let [before, after] = [(k + count - 1) % count, (k + 1) % count].map(|k| &self.ring[k]);
            let [from, to] = [before, after].map(|other| control.at.midpoint(other.at));
            let (into, out) = [control.at - from, to - control.at]
                .map(Vec2::normalize_or_zero)
                .into();
            let places: &[f32] = match into.dot(out) {
                straight if straight > 0.95 => &[0.5],
                _ if count < 8 => &[0.125, 0.375, 0.625, 0.875],
                _ => &[0.2, 0.5, 0.8],
            };
            for &share in places {
                let (before, after) = (from.lerp(control.at, share), control.at.lerp(to, share));
                let along = into.lerp(out, share).normalize_or_zero();
                self.points.push(OutlinePoint {
                    at: before.lerp(after, share),
                    normal: -along.perp(),
                    fresh: control.fresh[0] + (control.fresh[1] - control.fresh[0]) * share,
                    strain: control.strain,
                    grain: control.grain,
                });
            }
        }
        let curve = &self.points[start..];
        let next = curve.iter().cycle().skip(1);
        let pivot = curve[0].at;
        let doubled = |a: &OutlinePoint, b: &OutlinePoint| (a.at - pivot).perp_dot(b.at - pivot);
        let area = curve
            .iter()
            .zip(next)
            .fold(0.0, |sum, (a, b)| sum + 0.5 * doubled(a, b));
        let end = self.points.len();
        self.spans.push(Span { start, end, area });
    }
}

impl Control {
    fn between(before: &Side, after: &Side) -> Self {
        let by = match (before.is_fresh, after.is_fresh) {
            (false, false) => before.moved[1].midpoint(after.moved[0]),
            (false, true) => before.moved[1],
            _ => after.moved[0],
        };
        Self {
            at: after.start + by,
            fresh: [before, after].map(|side| f32::from(u8::from(side.is_fresh))),
            strain: 0.5 * (before.strain + after.strain),
            grain: after.grain,
        }
    }
}

/// Returns the mean edges to the right and upwards [m] of a cell with corners in the order of
/// [`fuwafuwa::inspect::corner`].
pub fn sides([a, b, c, d]: [Vec2; 4]) -> (Vec2, Vec2) {
    (0.5 * (b - a + d - c), 0.5 * (c - a + d - b))
}

/// Returns the strain ‖F − R‖ of a cell with the given edges and rest size [m]. F is the deformation
/// gradient, R its rotation.
pub fn strain(right: Vec2, up: Vec2, size: f32) -> f32 {
    let turn = right - up.perp();
    let squared = right.length_squared() + up.length_squared();
    let squared = squared / (size * size) + 2.0 - 2.0 * turn.length() / size;
    squared.max(0.0).sqrt()
}

/// Amplitudes [voxels] and wavelengths [voxels] of the two waves that make torn surfaces rough.
const ROUGH: [(f32, f32); 2] = [(0.55, 5.0), (0.4, 1.7)];

/// Returns the offset of a torn surface at a lattice point [voxels]. The offset depends only on the position at
/// rest, so it is the same on both faces of a crack and never changes.
fn roughness([x, y, _]: [i32; 3]) -> Vec2 {
    let waves = ROUGH.into_iter().map(|(amplitude, length)| {
        let at = Vec2::new(x as f32, y as f32) / length;
        let wave = |seed: i32| 2.0 * noise(at, seed) - 1.0;
        amplitude * Vec2::new(wave(0), wave(7919))
    });
    waves.sum()
}

/// Returns smooth noise, 0 to 1, that takes pseudo-random values at points with whole coordinates.
fn noise(at: Vec2, seed: i32) -> f32 {
    let cell = at.floor();
    let share = at - cell;
    let share = share * share * (3.0 - 2.0 * share);
    let value = |x: i32, y: i32| grain([cell.x as i32 + x + seed, cell.y as i32 + y, 0]);
    let along = |y: i32| value(0, y) + share.x * (value(1, y) - value(0, y));
    along(0) + share.y * (along(1) - along(0))
}

/// Returns a constant pseudo-random value of a lattice point, 0 to 1.
fn grain([x, y, _]: [i32; 3]) -> f32 {
    let mixed = (x as u32).wrapping_mul(0x9e37_79b1) ^ (y as u32).wrapping_mul(0x85eb_ca77);
    let mixed = (mixed ^ mixed >> 15).wrapping_mul(0xc2b2_ae3d);
    (mixed >> 24) as f32 / 255.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use fuwafuwa::{Blade, Material, VoxelGrid, World, WorldConfig};

    fn rings(world: &World<Dim2>) -> Outlines {
        let (_, body) = world.soft_bodies().next().unwrap();
        let mut rings = Outlines::default();
        rings.trace(body);
        rings
    }

    fn disc(n: usize) -> World<Dim2> {
        let mut world = World::new(WorldConfig::default()).unwrap();
        let grid = VoxelGrid::ball(n, 1.0).unwrap();
        world
            .add_soft_body(SoftBody::new(grid, &[Material::default()]).unwrap())
            .unwrap();
        world
    }

    /// Returns the radius of the disc with the area of the world's first body [m].
    fn round(world: &World<Dim2>) -> f32 {
        let grid = world.soft_bodies().next().unwrap().1.grid();
        grid.voxel_size() * (grid.solid_count() as f32 / std::f32::consts::PI).sqrt()
    }

    fn total_area(rings: &Outlines) -> f32 {
        rings.spans.iter().fold(0.0, |sum, span| sum + span.area)
    }

    #[test]
    fn outline_of_a_disc_is_a_circle() {
        let world = disc(64);
        let (rings, round) = (rings(&world), round(&world));
        assert_eq!(rings.spans.len(), 1);
        let voxel = 1.0 / 64.0;
        for point in &rings.points {
            let away = point.at - Vec2::splat(0.5);
            let radius = away.length();
            assert!((radius - round).abs() < 0.25 * voxel, "{radius}");
            assert!(point.normal.dot(away) > 0.995 * radius);
            assert_eq!((point.fresh, point.strain < 1e-3), (0.0, true));
        }
    }

    #[test]
    fn outline_of_a_stretched_disc_is_an_ellipse() {
        let mut world = disc(64);
        let round = round(&world);
        let soft = world.nth_soft_body(0).unwrap();
        let body = world.soft_body_mut(soft).unwrap();
        let ids: Vec<_> = body.mesh().nodes().map(|(id, _)| id).collect();
        for id in ids {
            let at = body.node_state(id).0 * Vec2::new(2.0, 0.5);
            body.set_node_state(id, at, Vec2::ZERO).unwrap();
        }
        for point in rings(&world).points {
            let [x, y] = (point.at - Vec2::new(1.0, 0.25)).to_array();
            let radius = ((x / 2.0).powi(2) + (y * 2.0).powi(2)).sqrt();
            assert!((radius - round).abs() < 0.25 / 64.0, "{radius}");
            assert!(point.strain > 0.5);
        }
    }

    #[test]
    fn torn_surface_is_rough_but_stays_near_the_cut() {
        let mut world = disc(64);
        let blade = Blade::segment(Vec2::new(0.5, -1.0), Vec2::new(0.5, 2.0));
        world.cut(world.nth_soft_body(0).unwrap(), &blade).unwrap();
        let rings = rings(&world);
        let torn = rings.points.iter().filter(|point| point.fresh == 1.0);
        let away: Vec<f32> = torn.map(|point| 64.0 * (point.at.x - 0.5)).collect();
        let mean = away.iter().sum::<f32>() / away.len() as f32;
        let squares = away.iter().map(|x| (x - mean).powi(2));
        let deviation = (squares.sum::<f32>() / away.len() as f32).sqrt();
        assert!(deviation > 0.1, "{deviation} voxels");
        assert!(away.iter().all(|x| x.abs() < 1.0), "{away:?}");
    }

    #[test]
    fn crack_faces_coincide_in_a_closed_cut() {
        let mut world = disc(32);
        let whole = total_area(&rings(&world));
        let blade = Blade::segment(Vec2::new(0.5, -1.0), Vec2::new(0.5, 2.0));
        world.cut(world.nth_soft_body(0).unwrap(), &blade).unwrap();
        let halves = rings(&world);
        assert_eq!(halves.spans.len(), 2);
        let gap = (total_area(&halves) - whole).abs() / whole;
        assert!(gap < 5e-3, "{gap}");
        let torn: Vec<&OutlinePoint> = halves.points.iter().filter(|p| p.fresh == 1.0).collect();
        assert!(torn.len() > 40);
        for point in torn {
            assert!((point.at.x - 0.5).abs() < 0.5 / 32.0);
        }
    }

    #[test]
    fn hole_has_negative_area_and_crumb_is_round() {
        let mut world = World::<Dim2>::new(WorldConfig::default()).unwrap();
        let grid = VoxelGrid::from_fn([20, 20, 1], 0.05, |[x, y, _]| {
            u8::from(!(8..12).contains(&x) || !(8..12).contains(&y))
        });
        world
            .add_soft_body(SoftBody::new(grid.unwrap(), &[Material::default()]).unwrap())
            .unwrap();
        let ring = rings(&world);
        assert_eq!(ring.spans.len(), 2);
        assert!(ring.spans.iter().any(|span| span.area < -0.02));

        let mut world = World::<Dim2>::new(WorldConfig::default()).unwrap();
        let grid = VoxelGrid::from_fn([1, 1, 1], 1.0, |_| 1).unwrap();
        world
            .add_soft_body(SoftBody::new(grid, &[Material::default()]).unwrap())
            .unwrap();
        let crumb = rings(&world);
        assert!(crumb.points.len() >= 12);
        for point in &crumb.points {
            let radius = point.at.distance(Vec2::splat(0.5));
            assert!((0.35..0.55).contains(&radius), "{radius}");
        }
    }
}
