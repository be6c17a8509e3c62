//! Cook's membrane: a tapered panel, clamped at its left edge, bends and shears under a load on its right edge.
//!
//! ```text
//!              __..-▒ (48, 60)   ↑
//!   (0, 44) ▓‾▒▒▒▒▒▒▒            ↑ vertical dead load, spread evenly
//!           ▓▒▒▒▒▒▒▒▒ (48, 44)   ↑
//!           ▓▒▒▒▒▒▒/                      plane strain, lengths in mm
//!           ▓▒▒▒▒/
//!   (0, 0)  ▓▒/
//! ```
//!
//! - Compressible rubber: G = 422.5 kPa, ν = 0.3, 1 N on 16 mm × 1 mm; displacement of (48, 52). J.-P. V. Pelteret and
//!   A. McBride, *Quasi-static finite-strain compressible elasticity*, code gallery of deal.II.
//! - Nearly incompressible rubber: E = 240.565 MPa, ν = 0.499, 6.25 MPa; displacement of (48, 60). Benchmark of
//!   OpenGeoSys with F-bar elements, `Tests/Data/LargeDeformation/CooksMembrane`. The engine has ν ≤ 0.49.
//! - Linear: 6.25 Pa on a panel with E = 70 Pa; displacement of (48, 60). CoFEA has 32.0 mm for ν = 1/3 and 27.35 mm to
//!   27.56 mm for ν = 0.4999.
//!
//! The rows `finite elements` have the law and the Poisson's ratio of the engine on both sides. Their values come from a
//! program in double precision that is not part of this project, with 32 × 32 quadrilaterals of nine nodes, 3 × 3 points of integration each,
//! and Newton's method; the second case has 48 × 48. With the laws and ratios of the sources, that program finds 14.74 mm,
//! 6.87 mm (32 × 32; rising) and 27.38 mm.
//!
//! The slanted edges are staircases of voxels, whose steps carry little load. The panel is therefore too soft, by a
//! share in proportion to the size of the voxels: with 8, 16 and 32 voxels in 16 mm, the nearly incompressible panel
//! has 7.24, 7.11 and 7.04 mm. It is softer than the exact one at every resolution: it does not lock.

use super::patch::rubber;
use super::{Bound, Record, Role, Row, Setup};
use crate::check::bar::{fix_where, place, still};
use crate::check::parallel;
use crate::check::statics::Statics;
use crate::plot::{Curve, Plot, Points};
use crate::report::Progress;
use anyhow::Result;
use fuwafuwa::inspect::{CellHierarchy, Connectivity, Elasticity, Mesh};
use fuwafuwa::{Damping, Dim2, Grading, Grip, Shape, SoftBody, Vec2, VoxelGrid, World};
use std::time::Instant;

/// Width of the panel, and height of its upper left corner and of its right edge [mm].
const WIDTH: f64 = 48.0;
const LEFT: f64 = 44.0;
const RIGHT: f64 = 16.0;
/// Voxels in 16 mm.
const N: usize = 32;
/// Voxels in 16 mm of the plot.
const SHOWN: [usize; 3] = [8, 16, 32];
/// Displacements [mm] of the benchmark of OpenGeoSys over the number of elements along a side: F-bar elements, and
/// elements with four nodes, which lock.
const F_BAR: [(f64, f64); 5] = [
    (10.0, 6.75),
    (15.0, 6.82),
    (20.0, 6.86),
    (25.0, 6.87),
    (30.0, 6.89),
];
const LOCKING: [(f64, f64); 2] = [(10.0, 2.84), (30.0, 4.70)];
/// Lowest frequency of the panel [Hz], about: the vibrations are damped critically.
const FREQUENCY: f32 = 0.8;
/// Time after which the panel is at rest [s].
const SETTLING: f64 = 3.0;
/// Largest relative deviation.
const TOLERANCE: f64 = 0.03;

/// Bent panel.
#[derive(Copy, Clone, Debug)]
struct Case {
    name: &'static str,
    poisson: f64,
    /// Load per area, divided by Young's modulus.
    load: f64,
    /// Height of the measured point on the right edge [mm].
    height: f64,
    /// Displacement [mm] of the source.
    published: f64,
    /// Whether the engine has the Poisson's ratio of the source.
    is_exact: bool,
    /// Displacement [mm] of finite elements with the law and the Poisson's ratio of the engine.
    elements: f64,
}

/// Large displacements of a neo-Hookean panel.
const LARGE: [Case; 2] = [
    Case {
        name: "cook, compressible neo-Hookean",
        poisson: 0.3,
        // 1 N / 16 mm² and E = 2 G (1 + ν).
        load: 0.0625 / (2.0 * 0.4225 * 1.3),
        height: 52.0,
        published: 14.74,
        is_exact: true,
        elements: 14.51,
    },
    Case {
        name: "cook, nearly incompressible neo-Hookean",
        poisson: 0.49,
        load: 6.25 / 240.565,
        height: 60.0,
        published: 6.89,
        is_exact: false,
        elements: 6.96,
    },
];
/// Small displacements, scaled to the load.
const SMALL: [Case; 2] = [
    Case {
        name: "cook, linear, ν = 1/3",
        poisson: 1.0 / 3.0,
        load: 6.25 / 70.0,
        height: 60.0,
        published: 32.0,
        is_exact: true,
        elements: 32.22,
    },
    Case {
        name: "cook, linear, ν = 0.49",
        poisson: 0.49,
        load: 6.25 / 70.0,
        height: 60.0,
        published: 27.46,
        is_exact: false,
        elements: 27.88,
    },
];

/// Bends panels.
pub fn run(progress: &Progress) -> Result<Record> {
    let mut record = Record::default();
    let cases: Vec<(Case, usize, bool)> = {
        LARGE
            .iter()
            .flat_map(|&case| SHOWN.map(|n| (case, n, true)))
    }
    .chain(
        SMALL
            .iter()
            .flat_map(|&case| SHOWN.map(|n| (case, n, false))),
    )
    .collect();
    let found = parallel::each(&cases, progress, |&(case, n, is_large)| match is_large {
        true => large(case, n),
        false => small(case, n, progress),
    })?;
    for (&(case, n, _), &(computed, setup)) in cases.iter().zip(&found) {
        if n != N {
            continue;
        }
        let mut push = |what: &str, reference: f64, bound: Bound| {
            record.rows.push(Row {
                case: format!("{}, displacement [mm], {what}", case.name),
                role: Role::Verification,
                reference: Some(reference),
                spread: None,
                computed,
                bound,
                setup,
            });
        };
        let bound = match case.is_exact {
            true => Bound::Relative(TOLERANCE),
            false => Bound::None,
        };
        push("published", case.published, bound);
        push("finite elements", case.elements, Bound::Relative(TOLERANCE));
    }
    let locking = { cases.iter().zip(&found) }
        .filter(|((case, ..), _)| case.name == LARGE[1].name)
        .map(|(&(_, n, _), &(computed, _))| (n as f64, computed));
    let flat = [SHOWN[0], N].map(|n| (n as f64, LARGE[1].elements));
    record.plots.push(Plot {
        x: "voxels in 16 mm, or finite elements along a side".into(),
        y: "displacement, nearly incompressible [mm]".into(),
        curves: vec![
            Curve::new(flat).named("finite elements, nine nodes, ν = 0.49"),
            Curve::new(F_BAR).named("published, F-bar, ν = 0.499"),
            Curve::new(LOCKING).named("published, four nodes, ν = 0.499"),
        ],
        points: vec![Points::new("computed, ν = 0.49", locking)],
        ..Plot::default()
    });
    Ok(record)
}

/// Returns the panel with `n` voxels in 16 mm, 1 m wide.
fn grid(n: usize) -> Result<VoxelGrid<Dim2>> {
    let size = RIGHT / n as f64;
    let voxels = [WIDTH, LEFT + RIGHT].map(|length| (length / size).round() as usize);
    Ok(VoxelGrid::from_fn(
        [voxels[0], voxels[1], 1],
        (size / WIDTH) as f32,
        |at| {
            let [x, y] = [at[0], at[1]].map(|k| (f64::from(k) + 0.5) * size);
            let share = x / WIDTH;
            u8::from(y > LEFT * share && y < LEFT + RIGHT * share)
        },
    )?)
}

/// Returns the displacement [mm] of a neo-Hookean panel.
fn large(case: Case, n: usize) -> Result<(f64, Setup)> {
    let start = Instant::now();
    let material = rubber(case.poisson, Damping::at(1.0, FREQUENCY))?;
    let mut body = SoftBody::new(grid(n)?, &[material])?;
    fix_where(&mut body, |at| at[0] == 0);
    let point = [3 * n, (case.height / RIGHT * n as f64).round() as usize];
    // Around the origin, single precision is finest.
    let origin = place(&body, point)?;
    let body = body.translated(-origin);
    let mut world = World::new(still(Vec2::ZERO))?;
    let body = world.add_soft_body(body)?;
    let edge = Shape::half_space(Vec2::NEG_X, Vec2::NEG_X * 1e-4);
    let force = case.load * material.elasticity.young * RIGHT / WIDTH;
    world.add_grip(Grip::force(body, edge, Vec2::Y * force as f32))?;
    for _ in 0..(60.0 * SETTLING) as u32 {
        world.step();
    }
    let moved = f64::from(place(&world[body], point)?.y);
    let setup = Setup {
        n,
        substeps: Some(world.substeps()),
        seconds: start.elapsed().as_secs_f64(),
    };
    Ok((moved * WIDTH, setup))
}

/// Returns the displacement [mm] of a linear elastic panel.
fn small(case: Case, n: usize, progress: &Progress) -> Result<(f64, Setup)> {
    let start = Instant::now();
    let grid = grid(n)?;
    let sharing = Connectivity::new(&grid);
    let hierarchy = CellHierarchy::new(&grid, &sharing, Grading::Graded);
    let mesh = Mesh::grade(&grid, &sharing, &hierarchy)?;
    let elasticity = Elasticity::new(1.0, case.poisson)?;
    let statics = Statics::new(&mesh, elasticity, |node, _| node.at[0] == 0);
    let low = (LEFT / RIGHT * n as f64).round() as i32;
    let (right, high) = (3 * n as i32, low + n as i32);
    let mut load = vec![0.0; mesh.node_capacity() * 2];
    for (id, node) in mesh.nodes().filter(|(_, node)| node.at[0] == right) {
        let is_end = node.at[1] == low || node.at[1] == high;
        load[id.index() * 2 + 1] = case.load * if is_end { 0.5 } else { 1.0 };
    }
    let moved = statics.solve(&load, vec![0.0; load.len()], progress)?;
    let mut nodes = mesh.nodes();
    let corner = nodes.find(|(_, node)| node.at[..2] == [right, high]);
    let moved = corner.map_or(f64::NAN, |(id, _)| moved[id.index() * 2 + 1]);
    let setup = Setup {
        n,
        substeps: None,
        seconds: start.elapsed().as_secs_f64(),
    };
    Ok((moved * RIGHT / n as f64, setup))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn panel_has_the_area_of_the_quadrilateral() {
        let grid = grid(16).unwrap();
        let area = grid.solid_count() as f64 / 256.0 * RIGHT * RIGHT;
        let exact = 0.5 * (LEFT + RIGHT) * WIDTH;
        assert!((area / exact - 1.0).abs() < 0.01, "{area} {exact}");
    }

    #[test]
    fn nearly_incompressible_panel_does_not_lock() {
        let (moved, _) = small(SMALL[1], 16, &Progress::new()).unwrap();
        assert!(
            moved > SMALL[1].elements && moved < 1.06 * SMALL[1].elements,
            "{moved}"
        );
    }
}
