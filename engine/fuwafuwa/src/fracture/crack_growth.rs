//! Crack growth: selects the shared nodes that are released next.
//!
//! A crack grows at a *tip* if the energy-release vector J of [`near_field`](super::near_field) exceeds what
//! the toughness K withstands in plane strain, and it grows along J:
//!
//! ```text
//! |J| > K² (1 − ν²) / Y
//! ```
//!
//! Each tip stores its deviation from the path along J. Of the possible cuts it takes one that leaves little
//! deviation and has a high nodal tension. A crack *starts* at a smooth surface if the mean tension within a radius
//! of 0.5 (K/σ)² exceeds the strength σ [Taylor 2007]. With this radius, a narrow notch and a crack fail at similar
//! loads, and a notch of any width fails at nearly the same load at every voxel size. A crack that is short
//! compared with this radius grows as if its tip were a smooth surface. In all cases, the nodal tension of
//! [`nodal_tension`](super::nodal_tension) must pull the cut open. Under [`Law::Endo2004`], the nodal tension
//! alone decides, as in the paper.
//!
//! In a material with the criterion of Drucker and Prager, a crack also starts inside, at a node of any element, and the
//! mean equivalent tension takes the place of the mean tension.
//!
//! A node fails if it is overloaded for some milliseconds.

use crate::foundation::dim::{Dim, Point};
use crate::foundation::ids::NodeId;
use crate::foundation::threads::{self, CHUNK_SIZE};
use crate::fracture::breakable_nodes::{BreakableNode, NodeCut};
use crate::fracture::near_field::{NearField, equivalent_tension};
use crate::fracture::nodal_tension::{
    CutTension, NodalForces, crumb_factor, face_area, is_surely_below,
};
use crate::material::Material;
use crate::math::lanes::on_widest_lanes;
use crate::soft_body::SoftBody;
use crate::soft_body::cooldowns::is_near;
use crate::soft_body::element_law::Law;
use glam::Vec3;

/// Node that fails, so that its release advances a crack.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Failure {
    /// Id of the node.
    pub node: NodeId,
    /// Lattice point of the node.
    pub at: Point,
    /// Mask of the octants that the crack separates from the others at the node.
    pub side: u8,
    /// Axis normal to the faces that open.
    axis: usize,
    /// Load divided by the load at which the node begins to take damage.
    pub excess: f32,
    /// Estimate of the released elastic energy [J].
    pub energy: f32,
    /// Greatest speed of the crack [m/s], at which it dissipates the energy that it releases; infinite at a smooth
    /// surface.
    speed: f32,
    /// Advance of a crack tip; `None` at a smooth surface.
    advance: Option<Advance>,
}

/// Advance of a crack tip by one cut.
#[derive(Copy, Clone, Debug, PartialEq)]
struct Advance {
    /// Lattice point of the tip after the cut.
    to: Point,
    /// Unit vector in the direction of growth, along the axes of the undeformed body.
    direction: Vec3,
    /// Deviation from the ideal path after the cut [voxels].
    deviation: Vec3,
}

/// Time until a node fails under 1.5 times the load at which it begins to take damage [s]. With a shorter
/// time, impacts shatter the surface; with a longer one, fast rigid bodies push through without cutting.
const DAMAGE_TIME: f32 = 0.004;
/// Time in which a damaged node heals once it is no longer overloaded [s]. It is longer than [`DAMAGE_TIME`],
/// so that oscillating loads can break nodes too.
const HEALING_TIME: f32 = 4.0 * DAMAGE_TIME;
/// Upper limit of the overload, load / threshold − 1, in the growth of damage. Because of this limit, a short
/// impact does less damage than a sustained pull.
const MAX_OVERLOAD: f32 = 3.0;
/// Lower limit of the overload of a crack tip in the growth of damage. Without it, a slowly loaded crack would
/// grow only at 1.1 times its toughness, because damage takes time.
const MIN_TIP_OVERLOAD: f32 = 0.25;
/// Cooldown after a release, as the distance that the fastest pressure wave travels in this time [voxels]. It
/// lasts until the wave of the release has reached nodes two voxels away and returned.
const COOLDOWN_VOXELS: f64 = 4.0;
/// Nodal tension, divided by the threshold, below which the load near a node is not computed. At a tip whose
/// load equals the toughness, the nodal tension is 0.9 to 1.5 times its threshold.
const GATE: f32 = 0.6;
/// Upper limit of the load of a tip, relative to its nodal tension divided by the threshold. It excludes tips that are
/// pressed or sheared: the energy-release vector counts the energy that a crack would release if its faces did not
/// touch.
const MAX_CLOSED_SHARE: f32 = 1.2;
/// Stress intensity estimated from |J| divided by the exact one, in 2D and in 3D. Measured by `fuwafuwa check lefm`.
const TIP_FACTOR: [f32; 2] = [0.97, 0.985];
/// Radius of the mean tension at a surface, relative to (toughness / strength)². The line method of [Taylor 2007]
/// averages along a line of 2/π, his area method over a half disc with a radius of 1.3/π.
const STRENGTH_RADIUS: f32 = 0.5;
/// Least radius of a computed mean tension at a surface [voxels]. A smaller one contains too few elements.
const MIN_RADIUS: f32 = 1.0;
/// Greatest such radius in 2D and in 3D [voxels]. The cost grows with it.
const MAX_RADIUS: [f32; 2] = [8.0, 4.0];
/// Least and greatest radius to which the mean tension is extrapolated [voxels]. An infinite toughness gives an infinite
/// radius.
const EXTRAPOLATED: [f32; 2] = [1.0 / 64.0, 64.0];
/// Exponent of the extrapolation of the mean tension to radii below [`MIN_RADIUS`], relative to the slope
/// between the means within one and two voxels. Measured by `fuwafuwa check grid`, as is [`STRENGTH_RADIUS`].
const STEEPENING: f32 = 0.6;
/// Least advance of a cut in the direction of growth [voxels].
const MIN_ADVANCE: f32 = 0.1;
/// Weight of the pull against the deviation [voxels], in 2D and in 3D: the additional deviation for which a tip takes
/// the cut with the highest nodal tension instead of one with none. With less, cracks in 3D are ragged and leave many
/// crumbs; with more, they follow the voxels.
const PULL_WEIGHT: [f32; 2] = [1.0, 2.0];
/// Least cosine of the angle between the direction of growth and the advance of the worst cut. No crack turns
/// by more than 71° in one step, the angle in pure shear [Erdogan and Sih 1963], but near contacts and in rubble J
/// can point anywhere.
const MIN_COSINE: f32 = 0.3;
/// Least cosine of the angle between two directions of growth that belong to one crack front.
const ALIKE: f32 = 0.8;

/// Updates the damage of all breakable nodes after a fracture round of `duration` [s], and returns the nodes
/// that fail now, the most overloaded first. No two of these nodes are near each other, except along the
/// front of one crack.
pub fn failures<D: Dim>(body: &mut SoftBody<D>, duration: f32) -> Vec<Failure> {
    body.cooldowns_mut().pass(duration);
    if !body.can_tear() {
        return Vec::new();
    }
    let size = body.grid().voxel_size();
    let mut damage = std::mem::take(body.damage_mut());
    let shares = threads::chunks(&mut damage, CHUNK_SIZE);
    let found = threads::map(shares, |(first, damage)| {
        let mut found: Vec<Failure> = Vec::new();
        let mut near = NearField::new(body);
        let nodes = body.breakable_nodes().among(first..first + damage.len());
        on_widest_lanes!(simd => for (id, node) in nodes {
            let damage = &mut damage[id.index() - first];
            // Tests undamaged nodes only in every second round, to save time.
            if body.pieces().sleeps(id)
                || *damage == 0.0 && (id.0 ^ body.cooldowns().rounds) & 1 == 1
            {
                continue;
            }
            // A node that would fail waits until the cooldown is over.
            if *damage >= 1.0 && body.cooldowns().covers(body.mesh().node(id).at) {
                continue;
            }
            // A fast test excludes most nodes: those far from failure.
            let least = least_tension(body, node);
            let failure = match node.is_inside {
                true if body.law() == Law::Endo2004 => None,
                true => inside_failure(body, &mut near, id, node),
                false if is_surely_below(simd, body, id, node, least) => None,
                false => failure(body, &mut near, id, node, least),
            };
            let Some(failure) = failure else {
                let healed = *damage - duration / HEALING_TIME;
                *damage = healed.max(0.0);
                continue;
            };
            let mut over = (failure.excess - 1.0).min(MAX_OVERLOAD);
            if failure.advance.is_some() {
                over = over.max(MIN_TIP_OVERLOAD);
            }
            let growth = duration / DAMAGE_TIME * 2.0 * over;
            *damage += growth.min(duration * failure.speed / size);
            if *damage >= 1.0 && !body.cooldowns().covers(failure.at) {
                found.push(failure);
            }
        });
        found
    });
    *body.damage_mut() = damage;
    let mut found = found.concat();
    // Tips come first: an advancing crack unloads the surfaces beside it.
    let is_surface = |failure: &Failure| failure.advance.is_none();
    found.sort_by(|a, b| {
        let tips_first = match body.law() {
            Law::Endo2004 => std::cmp::Ordering::Equal,
            Law::CorotationalVem => is_surface(a).cmp(&is_surface(b)),
        };
        tips_first
            .then(b.excess.total_cmp(&a.excess))
            .then(a.node.cmp(&b.node))
    });
    let cooldown = (COOLDOWN_VOXELS * f64::from(size) / body.fastest_wave()) as f32;
    let chosen = without_worse_neighbour(found);
    let tips = chosen.iter().rev();
    let advances = tips.filter_map(|failure| Some((failure.at, failure.advance?)));
    let advances = advances.map(|(from, advance)| (from, advance.to, advance.deviation));
    body.tip_deviations_mut()
        .advance(&advances.collect::<Vec<_>>());
    let cooling = chosen.iter().map(|failure| failure.at);
    body.cooldowns_mut().start(cooling, cooldown);
    chosen
}

/// Returns those failures that have no worse failure nearby; `found` is sorted, the worst first. Failures in
/// one plane, and tips that grow in the same direction, do not exclude each other: they form the front of one
/// crack, in 3D a line, which advances as a whole. If only the worst of them were released, cracks would
/// advance too slowly, and the load would start new ones.
fn without_worse_neighbour(found: Vec<Failure>) -> Vec<Failure> {
    let mut chosen: Vec<Failure> = Vec::new();
    for failure in found {
        let forestalls = |worse: &Failure| {
            let plane = |failure: &Failure| (failure.axis, failure.at[failure.axis]);
            let is_alike = match (failure.advance, worse.advance) {
                (Some(own), Some(worse)) => own.direction.dot(worse.direction) > ALIKE,
                _ => false,
            };
            is_near(failure.at, worse.at) && plane(&failure) != plane(worse) && !is_alike
        };
        if !chosen.iter().any(forestalls) {
            chosen.push(failure);
        }
    }
    chosen
}

/// Returns the nodal tension [Pa] below which a node does not fail, apart from the factor for crumbs.
#[inline(always)]
fn least_tension<D: Dim>(body: &SoftBody<D>, node: &BreakableNode) -> f32 {
    match body.law() {
        Law::Endo2004 => node.threshold,
        Law::CorotationalVem => GATE * opening_threshold(body, node),
    }
}

/// Returns the scale of the nodal tension [Pa] at failure: the threshold, but at a tip at most the strength, because a
/// short crack in a tough material fails at the strength.
#[inline(always)]
fn opening_threshold<D: Dim>(body: &SoftBody<D>, node: &BreakableNode) -> f32 {
    match node.is_tip {
        true => node.threshold.min(material(body, node).strength),
        false => node.threshold,
    }
}

/// Returns the failure of a node, if it is overloaded. Cuts with a nodal tension below `least` [Pa] are ignored.
#[inline(never)]
fn failure<D: Dim>(
    body: &SoftBody<D>,
    near: &mut NearField<D>,
    id: NodeId,
    node: &BreakableNode,
    least: f32,
) -> Option<Failure> {
    let forces = NodalForces::on(body, id, node, least)?;
    let worst = forces.worst_cut(body, node, least / node.threshold)?;
    if body.law() == Law::Endo2004 {
        let CutTension {
            tension,
            excess,
            cut,
        } = worst;
        return Some(start(body, id, node, tension, excess, cut));
    }
    match node.is_tip {
        true => tip_failure(body, near, id, node, &forces, worst),
        false => surface_failure(body, near, id, node, worst),
    }
}

/// Returns the failure of a node at a smooth surface, if it is overloaded. `worst` is the cut with the highest
/// nodal tension.
fn surface_failure<D: Dim>(
    body: &SoftBody<D>,
    near: &mut NearField<D>,
    id: NodeId,
    node: &BreakableNode,
    worst: CutTension,
) -> Option<Failure> {
    let tension = tension_at(body, near, id, node);
    let excess = tension / (node.threshold * crumb_factor(node, &worst.cut));
    (excess > 1.0).then(|| start(body, id, node, tension, excess, worst.cut))
}

/// Returns the failure of a node inside a body, if it is overloaded. The cut lies square to the greatest tension, as
/// far as the voxels allow.
fn inside_failure<D: Dim>(
    body: &SoftBody<D>,
    near: &mut NearField<D>,
    id: NodeId,
    node: &BreakableNode,
) -> Option<Failure> {
    let factor = pressure_factor(body, node);
    let least = GATE * node.threshold;
    let mut around = body.mesh().carrier_ids(id);
    if !around.any(|element| near.tension_in(element, factor) > least) {
        return None;
    }
    let tension = tension_at(body, near, id, node);
    let excess = tension / node.threshold;
    if excess <= 1.0 {
        return None;
    }
    let stress = near.mean_stress(id, MIN_RADIUS)?;
    let mut rotation = [Vec3::ZERO; 3];
    for element in body.mesh().carrier_ids(id) {
        let own = body.element_forces().rotation(element);
        (0..3).for_each(|row| rotation[row] += own[row]);
    }
    let pull = |axis: u8| {
        let [x, y, z] = rotation.map(|row| row[axis as usize]);
        let normal = Vec3::new(x, y, z).normalize_or_zero();
        normal.dot(stress.map(|row| row.dot(normal)).into())
    };
    let cuts = body.breakable_nodes().cuts(node).iter();
    let whole = cuts.filter(|cut| usize::from(cut.faces) == D::CORNERS / 2);
    let cut = whole.max_by(|a, b| pull(a.axis).total_cmp(&pull(b.axis)))?;
    Some(start(body, id, node, tension, excess, *cut))
}

/// Returns the constant γ of the weakest material around a node, see [`StrengthCriterion::DruckerPrager`].
fn pressure_factor<D: Dim>(body: &SoftBody<D>, node: &BreakableNode) -> Option<f32> {
    let material = material(body, node);
    material
        .strength_criterion
        .pressure_factor(material.strength)
}

/// Returns the mean tension [Pa] within the strength radius of a node.
fn tension_at<D: Dim>(
    body: &SoftBody<D>,
    near: &mut NearField<D>,
    id: NodeId,
    node: &BreakableNode,
) -> f32 {
    let radius = strength_radius(material(body, node)) / body.grid().voxel_size();
    tension_within(near, id, radius, pressure_factor(body, node))
}

/// Returns the mean equivalent tension [Pa] within `radius` [voxels] of a node. Below [`MIN_RADIUS`] and above
/// [`MAX_RADIUS`], it is extrapolated.
fn tension_within<D: Dim>(
    near: &mut NearField<D>,
    node: NodeId,
    radius: f32,
    pressure_factor: Option<f32>,
) -> f32 {
    let most = MAX_RADIUS[D::N - 2];
    let known = radius.clamp(MIN_RADIUS, most);
    let mut mean_within = |radius: f32| {
        let mean = near.mean_stress(node, radius);
        mean.map_or(0.0, |mean| equivalent_tension::<D>(&mean, pressure_factor))
    };
    let tension = mean_within(known);
    if tension <= 0.0 || radius == known {
        return tension;
    }
    let [least, greatest] = EXTRAPOLATED;
    let radius = radius.clamp(least, greatest);
    if radius < known {
        let slope = STEEPENING * slope(tension, mean_within(2.0 * known));
        return tension * libm::powf(known / radius, slope);
    }
    let slope = slope(mean_within(0.5 * known), tension);
    tension * libm::powf(known / radius, slope)
}

/// Returns the exponent with which a mean tension [Pa] falls from a radius to its double. Near a crack, it falls with
/// the square root of the radius; no notch is steeper. A wider mean that is compressive counts as steepest.
fn slope(inner: f32, outer: f32) -> f32 {
    if outer <= 0.0 {
        return 0.5;
    }
    libm::log2f((inner / outer).max(1.0)).min(0.5)
}

/// Returns the radius within which the mean tension decides at a smooth surface [m].
fn strength_radius(material: &Material) -> f32 {
    let ratio = material.toughness / material.strength;
    STRENGTH_RADIUS * ratio * ratio
}

/// Returns the failure of a node by a cut with the given tension [Pa] and excess.
fn start<D: Dim>(
    body: &SoftBody<D>,
    id: NodeId,
    node: &BreakableNode,
    tension: f32,
    excess: f32,
    cut: NodeCut,
) -> Failure {
    let young = (material(body, node).elasticity.young * body.stiffness_scale()) as f32;
    let size = body.grid().voxel_size();
    let volume = (0..D::N).fold(1.0, |volume, _| volume * size);
    Failure {
        node: id,
        at: body.mesh().node(id).at,
        side: cut.side,
        axis: cut.axis.into(),
        excess,
        energy: tension * tension / (2.0 * young) * volume,
        speed: f32::INFINITY,
        advance: None,
    }
}

/// Returns the failure of a crack tip, if it is overloaded. `worst` is the cut with the highest nodal tension.
fn tip_failure<D: Dim>(
    body: &SoftBody<D>,
    near: &mut NearField<D>,
    id: NodeId,
    node: &BreakableNode,
    forces: &NodalForces,
    worst: CutTension,
) -> Option<Failure> {
    let at = body.mesh().node(id).at;
    let size = body.grid().voxel_size();
    let material = material(body, node);
    let open_excess = MAX_CLOSED_SHARE * worst.tension / opening_threshold(body, node);
    let (release, front) = near.energy_release(id, &forces.mean_rotation());
    let rate = release.length();
    // The stiffness scale lowers the stiffness, so that the same stress releases more energy.
    let resistance = material.fracture_energy() / body.stiffness_scale() as f32;
    let tip_factor = TIP_FACTOR[D::N - 2];
    let mut excess = (rate / resistance).sqrt() / tip_factor;
    if !excess.is_finite() {
        return None;
    }
    // A crack that is short compared with the strength radius does not weaken the body.
    let radius = strength_radius(material) / size;
    if excess < 1.0 && radius > MIN_RADIUS && radius.is_finite() {
        excess = excess.max(tension_at(body, near, id, node) / material.strength);
    }
    let excess = excess.min(open_excess);
    if excess <= 1.0 {
        return None;
    }
    let direction = release.normalize_or_zero();
    let (cut, deviation) = next_cut(body, node, forces, at, direction, front.direction, worst)?;
    let excess = excess / crumb_factor(node, &cut);
    if excess <= 1.0 {
        return None;
    }
    let to =
        [0, 1, 2].map(|axis: usize| at[axis] + cut.advance[axis].clamp(-1.0, 1.0).round() as i32);
    // `face_area` is the part of a face nearest to the node. The tip opens twice as much; in 3D, its neighbours along the
    // front open the rest.
    let area = 2.0 * f32::from(cut.faces) * face_area::<D>(size);
    Some(Failure {
        node: id,
        at,
        side: cut.side,
        axis: cut.axis.into(),
        excess,
        energy: rate * area,
        speed: material
            .rate_toughening
            .speed_at(rate / (tip_factor * tip_factor * resistance)),
        advance: Some(Advance {
            to,
            direction,
            deviation,
        }),
    })
}

/// Returns a cut with a high nodal tension that keeps a tip close to its ideal path, and the deviation after it.
/// `direction` is that of growth, `along` that of the front, both as unit vectors or zero. `worst` is the cut with
/// the highest nodal tension; it is taken if the direction is implausible.
fn next_cut<D: Dim>(
    body: &SoftBody<D>,
    node: &BreakableNode,
    forces: &NodalForces,
    at: Point,
    direction: Vec3,
    along: Vec3,
    worst: CutTension,
) -> Option<(NodeCut, Vec3)> {
    let along = (along - direction * along.dot(direction)).normalize_or_zero();
    let project = |deviation: Vec3| {
        let across = deviation - direction * deviation.dot(direction);
        across - along * across.dot(along)
    };
    let ahead = Vec3::from(worst.cut.advance)
        .normalize_or_zero()
        .dot(direction);
    let before = body.tip_deviations().of_tip::<D>(at, project);
    if ahead < MIN_COSINE {
        return Some((worst.cut, project(before + Vec3::from(worst.cut.advance))));
    }
    let mut best: Option<(f32, NodeCut, Vec3)> = None;
    for cut in body.breakable_nodes().cuts(node) {
        let step = Vec3::from(cut.advance);
        let Some(tension) = forces.tension(body, node, cut) else {
            continue;
        };
        if step.dot(direction) < MIN_ADVANCE {
            continue;
        }
        let deviation = project(before + step);
        let cost = deviation.length() - PULL_WEIGHT[D::N - 2] * tension.excess / worst.excess;
        if best.is_none_or(|(least, ..)| cost < least - 1e-6) {
            best = Some((cost, *cut, deviation));
        }
    }
    best.map(|(_, cut, deviation)| (cut, deviation))
}

/// Weakest material around a node.
fn material<'a, D: Dim>(body: &'a SoftBody<D>, node: &BreakableNode) -> &'a Material {
    &body.materials()[node.material as usize - 1]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::foundation::dim::{Dim2, Dim3};
    use crate::fracture::near_field::tests::{Cracked, Intensities, cracked, stretched};
    use crate::math::rotation::Rotation;
    use std::f32::consts::PI;

    /// Returns the failure of the tip of a crack along the first axis, under intensities relative to the toughness.
    fn growth<D: Cracked>(intensities: Intensities, turn: f32) -> Option<Failure> {
        let material = Material {
            toughness: 5.0,
            ..Material::default()
        };
        let intensities = intensities.map(|intensity| intensity * material.toughness);
        let (body, tip) = cracked::<D>(&material, intensities, Rotation::in_plane(turn));
        failure_at(&body, tip)
    }

    fn failure_at<D: Dim>(body: &SoftBody<D>, id: NodeId) -> Option<Failure> {
        let place = id.index();
        let mut nodes = body.breakable_nodes().among(place..place + 1);
        let (_, node) = nodes.next().unwrap();
        let least = least_tension(body, node);
        failure(body, &mut NearField::new(body), id, node, least)
    }

    /// Returns the load of a smooth surface relative to its strength, if it fails under a uniform stress of `share`
    /// times the strength.
    fn surface_excess<D: Dim>(toughness: f32, share: f32) -> Option<f32> {
        let (.., stress) = stretched::<D>(&Material::default());
        let material = Material {
            strength: stress / share,
            strength_scatter: 0.0,
            toughness,
            ..Material::default()
        };
        let (body, node, _) = stretched::<D>(&material);
        failure_at(&body, node).map(|failure| failure.excess)
    }

    fn check_surface<D: Dim>(toughness: f32) {
        assert_eq!(surface_excess::<D>(toughness, 0.5), None, "{toughness}");
        let excess = surface_excess::<D>(toughness, 2.0).unwrap();
        assert!((excess - 2.0).abs() < 0.02, "{toughness}: {excess}");
    }

    #[test]
    fn slope_is_finite_and_at_most_that_of_crack() {
        let root = 2f32.sqrt();
        assert!((slope(1.0, 1.0 / root) - 0.5).abs() < 1e-6);
        assert!((slope(1.0, 1.0 / root.sqrt()) - 0.25).abs() < 1e-6);
        for compressive in [0.0, -1.0] {
            assert_eq!(slope(1.0, compressive), 0.5);
        }
        for (inner, outer) in [(1.0, 2.0), (1.0, f32::NAN), (f32::NAN, 1.0)] {
            assert_eq!(slope(inner, outer), 0.0);
        }
    }

    #[test]
    fn uniform_stress_tears_at_strength_at_any_toughness() {
        for toughness in [1e-3, 1.0, 1e4, f32::INFINITY] {
            check_surface::<Dim2>(toughness);
            check_surface::<Dim3>(toughness);
        }
    }

    /// Checks growth under 1.2 and 0.8 of the toughness, with a turned body.
    fn check_growth<D: Cracked>() {
        for turn in [0.0, 0.7, PI] {
            assert_eq!(growth::<D>([0.8, 0.0], turn), None);
            assert_eq!(growth::<D>([-1.2, 0.0], turn), None);
            let failure = growth::<D>([1.2, 0.0], turn).unwrap();
            let advance = failure.advance.unwrap();
            assert!((failure.excess - 1.2).abs() < 0.1, "{failure:?}");
            assert!(advance.direction.x > 0.99, "{failure:?}");
            assert_eq!(advance.to[0], failure.at[0] + 1, "{failure:?}");
            // A shear turns the crack to the side where it opens.
            for (shear, side) in [(0.8, -1.0), (-0.8, 1.0)] {
                let advance = growth::<D>([1.2, shear], turn).unwrap().advance.unwrap();
                assert!(side * advance.direction.y > 0.5, "{advance:?}");
            }
        }
    }

    #[test]
    fn crack_grows_along_its_load_above_its_toughness() {
        check_growth::<Dim2>();
        check_growth::<Dim3>();
    }

    #[test]
    fn without_worse_neighbour_keeps_front_of_crack_together() {
        let failure = |at: Point, axis| Failure {
            node: NodeId(0),
            at,
            side: 1,
            axis,
            excess: 2.0,
            energy: 0.0,
            speed: f32::INFINITY,
            advance: None,
        };
        let worst = failure([8, 8, 8], 0);
        let along = failure([8, 9, 8], 0);
        let found = [
            worst,
            failure([9, 8, 8], 0),
            failure([8, 8, 9], 1),
            along,
            failure([11, 8, 8], 1),
        ];
        let far = found[4];
        assert_eq!(without_worse_neighbour(found.to_vec()), [worst, along, far]);
    }
}
