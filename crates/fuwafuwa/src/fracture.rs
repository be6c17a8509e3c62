//! Where a body is pulled apart: which shared nodes are to be released next.
//!
//! A crack can start or go on at a front node. The voxels that share such a node hang together by
//! closed faces; a *cut* opens some of the faces across one axis so that the voxels fall into two
//! sides A and B. The elements of either side pull at the node with F_A and F_B:
//!
//! ```text
//!       A │ B        T = (F_B − F_A) / 2      n = mean rotation · axis
//!     ────●────      σ = √(Tₙ² + ¼ Tₛ²) / area of the opened faces, both sides pulling apart
//!       A │ B
//! ```
//!
//! The tension σ is held against the strength at a smooth surface and against the toughness at the
//! tip of a crack. A node gives way when it was overstrained for some milliseconds.

use crate::body::Body;
use crate::dim::{Dim, Point, voxel_around};
use crate::material::Material;
use crate::sharing::{Sharing, faces_around};
use crate::solve::Row;
use crate::vector::{dot, length, minus, plus, scaled};

/// A node that gives way.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Failure {
    /// The node.
    pub node: u32,
    /// Its lattice point.
    pub at: Point,
    /// The octants on one side of the crack.
    pub side: u8,
    /// Tension over what the node bears.
    pub excess: f32,
    /// Elastic energy set free [J], by the tension and the volume of the node's cell.
    pub energy: f32,
}

/// Where releases happened a short while ago: their surroundings rest.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Rests {
    /// Lattice points and for how much longer they rest [s].
    points: Vec<(Point, f32)>,
    /// Rounds so far.
    rounds: u32,
}

/// How long a node has to be overstrained by half before it gives way [s]. Shorter: knocks shatter
/// the surface. Longer: fast hands push through without cutting.
const DAMAGE_TIME: f32 = 0.004;
/// The most that chance adds to what a smooth surface bears; scatter keeps a row of equally
/// strained nodes from bursting at once. The tip of a crack is one node: there is none to spare.
const SCATTER: f32 = 0.4;
/// How much more it takes to set a single voxel free: else a crack leaves a trail of crumbs.
const CRUMB_FACTOR: f32 = 1.3;
/// Lattice steps around a release that rest after it.
const REST_REACH: i32 = 2;
/// How many voxels a wave travels before the surroundings of a release are judged again.
const REST_VOXELS: f64 = 4.0;

impl Rests {
    /// Lets a round of some time pass [s].
    pub fn pass(&mut self, duration: f32) {
        self.rounds = self.rounds.wrapping_add(1);
        self.points.retain_mut(|(_, left)| {
            *left -= duration;
            *left > 0.0
        });
    }

    fn covers(&self, at: Point) -> bool {
        self.points.iter().any(|&(point, _)| {
            let apart = |axis: usize| (at[axis] - point[axis]).abs();
            (0..3).all(|axis| apart(axis) <= REST_REACH)
        })
    }
}

/// Looks at all front nodes after a time of `duration` [s]: adds up their damage, and picks those
/// that give way now, the worst first, no two of them near each other.
pub fn failures<D: Dim>(body: &mut Body<D>, rests: &mut Rests, duration: f32) -> Vec<Failure> {
    rests.pass(duration);
    let weakest = body.materials().iter().map(|material| material.strength);
    let weakest = weakest.fold(f32::INFINITY, f32::min);
    if weakest == f32::INFINITY {
        return Vec::new();
    }
    let size = body.grid.voxel_size();
    let toughest = |material: &Material| material.strength.min(material.toughness / size.sqrt());
    let least = body.materials().iter().map(toughest);
    let bearable = least.fold(f32::INFINITY, f32::min) * face_area::<D>(size);
    let mut found: Vec<Failure> = Vec::new();
    let fronts = std::mem::take(&mut body.fronts);
    for &id in &fronts {
        if body.pieces.sleeps(id) {
            continue;
        }
        let node = id as usize;
        // What is not damaged yet is looked at in every other round.
        if body.damage[node] == 0.0 && (id ^ rests.rounds) & 1 == 1 {
            continue;
        }
        // No cut can bear more than half of what all elements pull together.
        let pull: f32 = body.blocks.parts_on(id).map(length).sum();
        let failure = (0.5 * pull > bearable).then(|| worst_cut(body, id));
        let Some(failure) = failure.flatten() else {
            let healed = body.damage[node] - duration / (4.0 * DAMAGE_TIME);
            body.damage[node] = healed.max(0.0);
            continue;
        };
        let over = (failure.excess - 1.0).min(3.0);
        body.damage[node] += duration / DAMAGE_TIME * 2.0 * over;
        if body.damage[node] >= 1.0 && !rests.covers(failure.at) {
            found.push(failure);
        }
    }
    body.fronts = fronts;
    found.sort_by(|a, b| b.excess.total_cmp(&a.excess).then(a.node.cmp(&b.node)));
    let waves = body.materials().iter().map(Material::wave_speed);
    let wave = waves.fold(0.0, f64::max);
    let rest = (REST_VOXELS * f64::from(size) / wave) as f32;
    found.retain(|failure| {
        let free = !rests.covers(failure.at);
        if free {
            rests.points.push((failure.at, rest));
        }
        free
    });
    found
}

/// The cut through a front node that is overstrained most, if one is.
fn worst_cut<D: Dim>(body: &Body<D>, id: u32) -> Option<Failure> {
    let node = body.mesh.node(id);
    let size = body.grid.voxel_size();
    let mut forces = [[0.0; 4]; 8];
    let octants = (0..D::CORNERS).filter(|octant| node.group >> octant & 1 == 1);
    for (octant, force) in octants.clone().zip(body.blocks.parts_on(id)) {
        forces[octant] = force;
    }
    let mut turned = [[0.0f32; 3]; 3];
    let mut weakest: Option<(&Material, f32)> = None;
    for octant in octants {
        let owner = body.mesh.owner(voxel_around::<D>(node.at, octant))?;
        let element = body.mesh.element(owner)?;
        let rotation = body.blocks.rotation(owner);
        for row in 0..3 {
            turned[row] = plus(turned[row], rotation[row]);
        }
        let material = body.material(element);
        if weakest.is_none_or(|(_, strength)| material.strength < strength) {
            weakest = Some((material, material.strength));
        }
    }
    let (material, _) = weakest?;
    let borne = if is_tip(&body.sharing, node.at, node.group) {
        material.toughness / size.sqrt()
    } else {
        material.strength * (1.0 + SCATTER * chance(node.at))
    };
    let mut worst: Option<Failure> = None;
    for cut in cuts(&body.sharing, node.at, node.group) {
        let direction = [
            turned[0][cut.axis],
            turned[1][cut.axis],
            turned[2][cut.axis],
            0.0,
        ];
        let normal = scaled(direction, 1.0 / length(direction).max(1e-12));
        let tension = tension(&forces, node.group, cut.side, normal);
        let area = cut.faces as f32 * face_area::<D>(size);
        let lone = [cut.side, node.group & !cut.side]
            .iter()
            .any(|side| side.count_ones() == 1 && would_crumble::<D>(body, node.at, *side));
        let stress = tension / area;
        let excess = stress / if lone { CRUMB_FACTOR * borne } else { borne };
        if excess > worst.map_or(1.0, |worst: Failure| worst.excess) {
            let volume = (0..D::N).fold(1.0, |volume, _| volume * size);
            let energy = stress * stress / (2.0 * material.elasticity.young as f32) * volume;
            worst = Some(Failure {
                node: id,
                at: node.at,
                side: cut.side,
                excess,
                energy,
            });
        }
    }
    worst
}

/// Whether a crack ends at a point: some voxels still share a node there, but no longer a face.
fn is_tip<D: Dim>(sharing: &Sharing<D>, at: Point, group: u8) -> bool {
    faces_around::<D>().any(|(octant, axis)| {
        let both = 1 << octant | 1 << (octant ^ 1 << axis);
        group & both == both && !sharing.is_closed(at, octant, axis)
    })
}

/// The part of a face that belongs to one of its corners: half an edge, a quarter of a square.
fn face_area<D: Dim>(size: f32) -> f32 {
    (1..D::N).fold(1.0, |area, _| area * 0.5 * size)
}

/// The force that pulls the two sides of a cut apart [N]; 0 when one of them pushes.
fn tension(forces: &[Row; 8], group: u8, side: u8, normal: Row) -> f32 {
    let (mut near, mut far) = ([0.0; 4], [0.0; 4]);
    for octant in (0..8).filter(|octant| group >> octant & 1 == 1) {
        let total = if side >> octant & 1 == 1 {
            &mut far
        } else {
            &mut near
        };
        *total = plus(*total, forces[octant]);
    }
    if dot(far, normal) <= 0.0 || dot(near, normal) >= 0.0 {
        return 0.0;
    }
    let pull = scaled(minus(far, near), 0.5);
    let opening = dot(pull, normal);
    let shear = (dot(pull, pull) - opening * opening).max(0.0);
    (opening * opening + 0.25 * shear).sqrt()
}

/// A way to part the voxels at a point: faces across `axis` are opened.
#[derive(Copy, Clone)]
struct Cut {
    axis: usize,
    /// The octants on the far side of the axis that come off.
    side: u8,
    /// How many faces it opens.
    faces: u32,
}

/// All ways to open the closed faces across one axis, all of them, half or a quarter, that part
/// the group.
fn cuts<D: Dim>(sharing: &Sharing<D>, at: Point, group: u8) -> impl Iterator<Item = Cut> {
    // For each octant on the near side of an axis: whether its face across is closed.
    let mut closed = [0u8; 3];
    for axis in 0..D::N {
        for octant in (0..D::CORNERS).filter(|octant| octant >> axis & 1 == 0) {
            let inside = group >> octant & 1 == 1 && group >> (octant ^ 1 << axis) & 1 == 1;
            closed[axis] |= u8::from(inside && sharing.is_closed(at, octant, axis)) << octant;
        }
    }
    (0..D::N).flat_map(move |axis| {
        let others = 3usize.pow(D::N as u32 - 1);
        let mut known = [0u8; 9];
        (0..others).filter_map(move |choice| {
            let opened = closed[axis] & part_of::<D>(axis, choice);
            if opened == 0 || known[..choice].contains(&opened) {
                return None;
            }
            known[choice] = opened;
            let side = side_of::<D>(closed, axis, opened)?;
            let faces = opened.count_ones();
            Some(Cut { axis, side, faces })
        })
    })
}

/// The octants with given places on the axes other than `axis`: digit 0 = all, 1 = near, 2 = far.
fn part_of<D: Dim>(axis: usize, mut choice: usize) -> u8 {
    let mut part = D::ALL_CORNERS;
    for other in (0..D::N).filter(|&other| other != axis) {
        part &= match choice % 3 {
            0 => u8::MAX,
            1 => !FAR[other],
            _ => FAR[other],
        };
        choice /= 3;
    }
    part
}

/// The octants on the far side of each axis.
const FAR: [u8; 3] = [0b1010_1010, 0b1100_1100, 0b1111_0000];

/// What hangs together with the far sides of the opened faces, when it reaches no near side.
fn side_of<D: Dim>(mut closed: [u8; 3], axis: usize, opened: u8) -> Option<u8> {
    closed[axis] &= !opened;
    let near = opened;
    let mut side = opened << (1 << axis);
    loop {
        let mut grown = side;
        for (across, &faces) in closed.iter().enumerate().take(D::N) {
            let step = 1 << across;
            grown |= (side & faces) << step | (side >> step) & faces;
        }
        if grown & near != 0 {
            return None;
        }
        if grown == side {
            return Some(side);
        }
        side = grown;
    }
}

/// Whether the single voxel on a side would be set free, or hang by one face: of the faces away
/// from the point at most one is closed.
fn would_crumble<D: Dim>(body: &Body<D>, at: Point, side: u8) -> bool {
    let octant = side.trailing_zeros() as usize;
    // The faces away from the point are seen from the voxel's opposite corner.
    let mut corner = at;
    for axis in 0..D::N {
        corner[axis] += (octant >> axis & 1) as i32 * 2 - 1;
    }
    let seen = D::CORNERS - 1 - octant;
    let is_held = |axis: &usize| body.sharing.is_closed(corner, seen, *axis);
    (0..D::N).filter(is_held).count() <= 1
}

/// A fixed number between 0 and 1 for each lattice point.
fn chance(at: Point) -> f32 {
    let mix = |hash: u64, k: i32| {
        let hash = (hash ^ u64::from(k as u32)).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        hash ^ hash >> 29
    };
    let hash = at.iter().fold(0x5eed, |hash, &k| mix(hash, k));
    let hash = hash.wrapping_mul(0xbf58_476d_1ce4_e5b9) >> 40;
    hash as f32 / (1u32 << 24) as f32
}
