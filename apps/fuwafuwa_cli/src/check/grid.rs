//! Bars without a crack: the load at the first split must not depend on the size of the voxels or on the depth of the
//! grips.
//!
//! - Whole bars under uniform stress fail at strength × area. Poisson's ratio is 0, since grips that hold the sides of
//!   other materials raise the stress in their corners without limit.
//! - Bars with a blunt slot fail when the mean stress over a distance of 2/π (toughness / strength)² before the root of
//!   the slot reaches the strength, by the line method of the theory of critical distances [Taylor 1999]. That
//!   distance makes the line method agree with the toughness for a crack and with the strength for a whole bar. The
//!   stress before the slot comes from displacement discontinuities, see [`crack_path`], in proportion to the stress
//!   intensity of a crack as deep as the slot. It is compared with published formulas: the peak at the root by Baratta
//!   and Neal (1970), as quoted by Pilkey (Peterson's Stress Concentration Factors), and the decline before the root by
//!   Creager and Paris (1967). A mesh of voxels is no reference here: the flat of its staircase at the root shrinks
//!   only with the root of the size of its voxels.
//!
//! ```text
//!   ▀▀▀▀▀▀▀▀▀▀▀      ▀▀▀▀▀▀▀▀▀▀▀  grip
//!   ░░░░░░░░░░░      ░░░░░░░░░░░
//!   ░░░░░░░░░░░          ╮░░░░░░  slot, 0.31 m deep, ends in a half circle
//!   ░░░░░░░░░░░      ░░░░░░░░░░░
//!   ▓▓▓▓▓▓▓▓▓▓▓      ▓▓▓▓▓▓▓▓▓▓▓
//! ```

use super::Extent;
use super::bar::still;
use super::crack_path;
use super::parallel;
use super::plate::{Intensity, Plate, PlateDim, Pull, Setting, Specimen, TOUGHNESS, around_one};
use super::statics::Statics;
use crate::plot::{Plot, Points};
use crate::report::{Findings, Outcome, Progress};
use anyhow::{Context, Result, bail};
use fuwafuwa::inspect::Node;
use fuwafuwa::{
    Damping, Dim, Dim2, Dim3, DimVector, Elasticity, Material, SoftBody, VoxelGrid, World,
};
use std::f64::consts::PI;

/// Maximum relative deviation of the load of whole bars and of bars with a slot.
const TOLERANCES: [f64; 2] = [0.03, 0.07];
/// Maximum relative difference between the reference of slots and the published formulas.
const REFERENCE: f64 = 0.05;
/// Strengths of whole bars [Pa]. Their strain at failure is 2 % and 20 %; the latter is that of the default material.
const STRENGTHS: [f32; 2] = [100.0, 1000.0];
/// Length of whole bars [m].
const LENGTH: f64 = 1.5;
/// Initial load of whole bars, relative to the expected one.
const START: f64 = 0.88;
/// Load at which a whole bar counts as unbreakable, relative to the expected one.
const MOST: f64 = 1.4;
/// Growth of the load of whole bars [1/s], relative to the expected one.
const RATE: f64 = 0.05;
/// Depths of the grips of whole bars [m].
const DEPTHS: [f64; 2] = [0.0, 0.125];
/// Depth of grips that end inside of large elements [m], for comparison. These elements have no nodes where the grip
/// ends, so the stress beside such a grip is not uniform.
const UNEVEN: f64 = 0.1;
/// Bar with a slot.
const SLOT: Specimen = Specimen::Slot {
    depth: 0.3125,
    radius: RADIUS,
};
/// Radius of the end of the slot [m].
const RADIUS: f64 = 0.0625;
/// Strength of bars with a slot [Pa].
const SLOT_STRENGTH: f64 = 5.0 * TOUGHNESS;
/// Thickness of bars with a slot in 3D [m].
const THICKNESS: f64 = 0.25;

/// Compares the loads of bars.
pub fn check(progress: &Progress, extent: Extent) -> Result<Findings> {
    let (flat, solid): (&[usize], &[usize]) = match extent {
        Extent::Usual => (&[16, 32, 64, 128, 256], &[16]),
        Extent::Full => (&[16, 32, 64, 128, 256], &[16, 32]),
    };
    let of = |dim: usize, numbers: &[usize]| -> Vec<(usize, usize)> {
        numbers.iter().map(|&voxels| (dim, voxels)).collect()
    };
    let sizes = [of(2, flat), of(3, solid)].concat();
    let mut series: Vec<Points> = Vec::new();
    let mut outcomes = whole_bars(&sizes, &mut series, progress)?;
    outcomes.extend(slots(&sizes, &mut series, progress)?);
    let plot = Plot {
        x: "voxels across the bar".into(),
        y: "load at the first split / reference".into(),
        points: series,
        band: Some(around_one(TOLERANCES[0])),
        is_log: [true, false],
        ..Plot::default()
    };
    Ok(Findings {
        outcomes,
        plots: vec![plot],
    })
}

/// Compares the loads of whole bars with strength × area.
fn whole_bars(
    sizes: &[(usize, usize)],
    series: &mut Vec<Points>,
    progress: &Progress,
) -> Result<Vec<Outcome>> {
    let mut cases = Vec::new();
    let pairs = STRENGTHS.map(|strength| DEPTHS.map(|depth| (strength, depth)));
    for (strength, depth) in pairs.into_iter().flatten().chain([(STRENGTHS[0], UNEVEN)]) {
        cases.extend(
            sizes
                .iter()
                .map(|&(dim, voxels)| (strength, depth, dim, voxels)),
        );
    }
    let loads = parallel::each(
        &cases,
        progress,
        |&(strength, depth, dim, voxels)| match dim {
            2 => whole_load::<Dim2>(voxels, depth, strength, progress),
            _ => whole_load::<Dim3>(voxels, depth, strength, progress),
        },
    )?;
    let mut outcomes = Vec::new();
    for (&(strength, depth, dim, voxels), (load, peak)) in cases.iter().zip(loads) {
        let name = format!("{dim}D, whole, {strength} Pa, grips of {depth} m");
        let name = format!("grid {name}, n = {voxels}");
        let row = format!("{name}, load / (strength × area)");
        outcomes.push(match depth == UNEVEN {
            true => Outcome::shown(row, load),
            false => Outcome::within(row, load, around_one(TOLERANCES[0])),
        });
        if depth > 0.0 && strength == STRENGTHS[0] {
            let row = format!("{name}, static stress, largest / mean");
            outcomes.push(Outcome::shown(row, peak));
        }
        let name = format!("{dim}D, whole, grips of {depth} m");
        Points::add(series, name, (voxels as f64, load));
    }
    Ok(outcomes)
}

/// Pulls at a bar 1 m wide until the first node splits. Returns the load before that, relative to strength × area.
/// NaN if no node splits. Returns also the largest stress along the bar in the static solution, relative to the mean.
fn whole_load<D: Dim>(
    voxels: usize,
    depth: f64,
    strength: f32,
    progress: &Progress,
) -> Result<(f64, f64)> {
    let length = (LENGTH * voxels as f64).round() as usize;
    let size = [length, voxels, D::depth(voxels)];
    let grid = VoxelGrid::<D>::from_fn(size, 1.0 / voxels as f32, |_| 1)?;
    let material = Material {
        elasticity: Elasticity {
            poisson: 0.0,
            ..Material::default().elasticity
        },
        strength,
        strength_scatter: 0.0,
        toughness: 0.2 * strength,
        damping: Damping {
            mass: 0.0,
            ..Damping::default()
        },
        ..Material::default()
    };
    let mut body = SoftBody::new(grid, &[material])?;
    let inner = (depth * voxels as f64 + 1e-6).floor();
    let free = length as f64 - 2.0 * inner;
    // Displacement of a node at the expected load [m].
    let strain = f64::from(strength) / material.elasticity.young;
    let stretch = |place: f64| {
        let share = (place - inner).clamp(0.0, free) - 0.5 * free;
        share / voxels as f64 * strain
    };
    let is_held = |node: Node| {
        let place = f64::from(node.at[0]);
        place <= inner || place >= length as f64 - inner
    };
    let mesh = body.mesh();
    let statics = Statics::new(mesh, material.elasticity, |node, _| is_held(node));
    let mut given = vec![0.0; mesh.node_capacity() * D::N];
    let nodes: Vec<_> = mesh.nodes().collect();
    for &(id, node) in &nodes {
        given[id.index() * D::N] = stretch(f64::from(node.at[0]));
    }
    let moved = statics.solve_displaced(&given, progress)?;
    let mut left = Vec::new();
    for &(id, node) in &nodes {
        let (mut at, ..) = body.node_state(id);
        let mut by = D::Vector::ZERO;
        for axis in 0..D::N {
            by[axis] = moved[id.index() * D::N + axis] as f32;
        }
        at += by * START as f32;
        body.set_node_state(id, at, by * RATE as f32)?;
        if is_held(node) {
            body.fix_node(id);
        }
        if f64::from(node.at[0]) <= inner {
            left.push(id);
        }
    }
    let stresses = body
        .mesh()
        .elements()
        .filter_map(|(id, _)| body.element_state(id));
    let stresses = stresses.map(|state| state.stress[0].x);
    let peak = stresses.fold(0.0, f64::max) / (START * f64::from(strength));
    let mut world = World::<D>::new(still(D::Vector::ZERO))?;
    let tick = f64::from(world.config().tick);
    let bar = world.add_soft_body(body)?;
    let mut last = f64::NAN;
    for _ in 0..((MOST - START) / RATE / tick) as usize {
        let split = world.step().nodes_split;
        let forces = left.iter().map(|&id| f64::from(world[bar].force_on(id)[0]));
        let load = forces.sum::<f64>() / f64::from(strength);
        if split > 0 {
            return Ok((if last.is_nan() { load } else { last }, peak));
        }
        last = load;
    }
    Ok((f64::NAN, peak))
}

/// Compares the loads of bars with a slot with the line method and with that of the finest bar.
fn slots(
    sizes: &[(usize, usize)],
    series: &mut Vec<Points>,
    progress: &Progress,
) -> Result<Vec<Outcome>> {
    // Poisson's ratio is 0, so that plates in 3D are in plane strain, too.
    let [reference, published] = line_method(progress)?;
    let row = "grid reference, slot, load by published formulas / by displacement discontinuities";
    let mut outcomes = vec![Outcome::within(
        row.into(),
        published / reference,
        around_one(REFERENCE),
    )];
    let loads = parallel::each(sizes, progress, |&(dim, voxels)| match dim {
        2 => slot_load::<Dim2>(voxels, reference, progress),
        _ => slot_load::<Dim3>(voxels, reference, progress),
    })?;
    for (&(dim, voxels), load) in sizes.iter().zip(&loads) {
        let name = format!("{dim}D, slot");
        let row = format!("grid {name}, n = {voxels}, load / line method");
        outcomes.push(Outcome::within(
            row,
            load / reference,
            around_one(TOLERANCES[1]),
        ));
        let finest = { sizes.iter().zip(&loads) }
            .filter(|((other, _), _)| *other == dim)
            .max_by_key(|((_, voxels), _)| *voxels);
        let (&(_, most), finest) = finest.context("there is a finest bar")?;
        if most > voxels {
            let row = format!("grid {name}, n = {voxels}, load / that at n = {most}");
            outcomes.push(Outcome::within(
                row,
                load / finest,
                around_one(TOLERANCES[1]),
            ));
        }
        Points::add(series, name, (voxels as f64, load / reference));
    }
    Ok(outcomes)
}

/// Returns the distance over which the line method averages the stress [m].
fn distance() -> f64 {
    2.0 / PI * (TOUGHNESS / SLOT_STRENGTH).powi(2)
}

/// Returns the load per thickness at which a bar with a slot fails by the line method [N/m], and that by published
/// formulas.
///
/// The stress before the slot is taken in proportion to the stress intensity of a crack as deep as the slot, in the same
/// bar. By Creager and Paris, σ(r) = K / √(2πr) (1 + ρ / 2r), where r is measured from half of the radius ρ behind the root.
/// This underestimates the peak of a slot that is not deep, so it is multiplied by the ratio of the peaks.
fn line_method(progress: &Progress) -> Result<[f64; 2]> {
    let Specimen::Slot { depth, .. } = SLOT else {
        bail!("the specimen has a slot");
    };
    let crack = Specimen::WideEdge { length: depth };
    let intensity = Intensity::of(crack, 0.0, progress)?.at(depth);
    let mean = crack_path::slot_tension(depth, RADIUS, SLOT.size()[0], distance())?;
    // The integral of the stress over r is K / √(2π) (2 √r − ρ / √r), which is 0 at the root.
    let end = 0.5 * RADIUS + distance();
    let integral = (2.0 * end.sqrt() - RADIUS / end.sqrt()) / (2.0 * PI).sqrt();
    // Peak of a slot over that of a slot with the same radius and infinite depth in the same field.
    let slender = 2.243 * (depth / RADIUS).sqrt();
    let peak = 0.993 * (0.780 + slender) / slender;
    let published = peak * integral / distance();
    Ok([mean, published].map(|mean| SLOT_STRENGTH / (intensity * mean)))
}

/// Returns the load per thickness at which the first node of a bar with a slot splits [N/m].
fn slot_load<D: PlateDim>(voxels: usize, expected: f64, progress: &Progress) -> Result<f64> {
    let setting = Setting {
        strength: SLOT_STRENGTH,
        thickness: THICKNESS,
        ..Setting::new(voxels / 2, 0.0)
    };
    let pull = Pull::slow(expected);
    Ok(Plate::<D>::new(SLOT, setting)?.pull(&pull, progress)?.first)
}
