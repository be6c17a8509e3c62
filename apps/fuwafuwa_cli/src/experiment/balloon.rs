//! Inflated rubber: a tube in plane strain and a balloon, against the equation of radial equilibrium.
//!
//! ```text
//!    ░░░░░          A, B inner and outer radius at rest      tube     p = µ (ln (λa / λb) + (1/λb² − 1/λa²) / 2)
//!  ░░┌───┐░░        a, b inflated                            balloon  p = µ (2/λb + 1/2λb⁴ − 2/λa − 1/2λa⁴)
//!  ░░│ p │░░        λa = a / A, λb = b / B
//!  ░░└───┘░░        V = area or volume added to the inside
//!    ░░░░░
//! ```
//!
//! The nodes of the inner surface are held where the exact solution has them, and all others move freely. The pressure is
//! the work of the holding forces, −Σ f · dx / dV. Rubber that keeps its volume moves from R to r with r² = R² + V/π, or
//! r³ = R³ + 3V/4π. The pressure of a balloon falls beyond a maximum, which a thin one reaches at the stretch
//! 7^(1/6) = 1.3831; a held volume passes the maximum, whereas a held pressure would burst the balloon.
//!
//! Poisson's ratio is 0.49. The reference has this ratio and the law of the engine: it is the ordinary differential equation
//! of radial equilibrium, solved here. The plots also show the exact pressure of rubber that keeps its volume [Green and
//! Zerna 1954, *Theoretical Elasticity*, §3.10; Adkins and Rivlin 1952, doi 10.1098/rsta.1952.0013], to which the reference
//! tends for ν = 0.5.
//!
//! The elements are graded. The steps of the outer surface carry little load, so that a coarser balloon is too soft.

use super::patch::rubber;
use super::{Bound, Record, Role, Row, Setup};
use crate::check::bar::still;
use crate::check::parallel;
use crate::check::shooting::{integrate, root};
use crate::plot::{Curve, Plot, Points};
use crate::report::Progress;
use anyhow::{Result, ensure};
use fuwafuwa::glam::DVec3;
use fuwafuwa::inspect::{ElasticLaw, forces};
use fuwafuwa::{
    Damping, Dim, Dim2, Dim3, DimVector, Grading, Law, NodeId, SoftBody, Vec3, VoxelGrid, World,
};
use std::f64::consts::PI;
use std::time::Instant;

/// Inner radius A of the tube and of the balloon, if the outer radius B is 1 m.
const INNER: [f64; 2] = [0.5, 0.6];
/// Voxels from the centre to the outer surface of the tube and of the balloon.
const VOXELS: [usize; 2] = [48, 25];
/// Stretches λa of the inner surface.
const STRETCHES: [f64; 5] = [1.1, 1.25, 1.4, 1.6, 1.9];
/// Poisson's ratio.
const POISSON: f64 = 0.49;
/// Mass damping [1/s] and time of relaxation [s]: some periods of the slowest breathing vibration. Twice the time
/// changes the pressures by at most 0.5 %.
const DAMPING: f32 = 20.0;
const SETTLING: f64 = 1.0;
/// Largest relative deviation of the pressure.
const TOLERANCE: f64 = 0.03;

/// Inflated body.
#[derive(Copy, Clone, Debug, PartialEq)]
struct Case {
    /// Number of dimensions: 2 for the tube, 3 for the balloon.
    dimensions: usize,
    /// Stretch λa of the inner surface.
    stretch: f64,
}

impl Case {
    fn index(self) -> usize {
        self.dimensions - 2
    }

    fn name(self) -> &'static str {
        ["tube", "balloon"][self.index()]
    }

    /// Radius at rest of the inner surface [m].
    fn inner(self) -> f64 {
        INNER[self.index()]
    }

    /// Returns the radius of a material point at a radius at rest, if the volume is kept.
    fn inflated(self, rest: f64) -> f64 {
        let power = self.dimensions as f64;
        let grown = self.inner().powf(power) * (self.stretch.powf(power) - 1.0);
        (rest.powf(power) + grown).powf(1.0 / power)
    }

    /// Returns the pressure, in units of the shear modulus, if the volume is kept.
    fn incompressible(self) -> f64 {
        let (a, b) = (self.stretch, self.inflated(1.0));
        match self.dimensions {
            2 => (a / b).ln() + 0.5 * (1.0 / (b * b) - 1.0 / (a * a)),
            _ => 2.0 / b + 0.5 / b.powi(4) - 2.0 / a - 0.5 / a.powi(4),
        }
    }

    /// Returns the pressure, in units of the shear modulus, with the law and the Poisson's ratio of the engine.
    ///
    /// With the stretches l = dr/dR and t = r/R, and k = λ/µ + 1, the law gives the radial stress
    /// P = l − c + k (J − 1) c. Tube: c = t, J = l t. Balloon: c = t², J = l t².
    fn exact(self, poisson: f64) -> f64 {
        let stiff = 2.0 * poisson / (1.0 - 2.0 * poisson) + 1.0;
        let (inner, power) = (self.inner(), self.dimensions as i32 - 1);
        let rate = |rest: f64, [radius, stress]: [f64; 2]| {
            let t = radius / (inner + rest);
            let c = t.powi(power);
            let l = (stress + c + stiff * c) / (1.0 + stiff * c * c);
            let swelling = stiff * (l * c - 1.0) - 1.0;
            let around = t + swelling * l * t.powi(power - 1);
            [l, -f64::from(power) * (stress - around) / (inner + rest)]
        };
        let start = |pressure: f64| [inner * self.stretch, -pressure * self.stretch.powi(power)];
        let at_outside = |pressure: f64| integrate(start(pressure), 1.0 - inner, rate)[1];
        root(0.0, 3.0, at_outside)
    }
}

/// Inflates the tube and the balloon.
pub fn run(progress: &Progress) -> Result<Record> {
    let cases: Vec<Case> = { [2, 3].into_iter() }
        .flat_map(|dimensions| {
            STRETCHES.map(|stretch| Case {
                dimensions,
                stretch,
            })
        })
        .collect();
    let found = parallel::each(&cases, progress, |&case| match case.dimensions {
        2 => inflate::<Dim2>(case),
        _ => inflate::<Dim3>(case),
    })?;
    let mut record = Record::default();
    for dimensions in [2, 3] {
        let all = cases.iter().zip(&found);
        let some: Vec<_> = all
            .filter(|(case, _)| case.dimensions == dimensions)
            .collect();
        for &(case, &(computed, setup)) in &some {
            record.rows.push(Row {
                case: format!("{}, λa = {}, pressure / µ", case.name(), case.stretch),
                role: Role::Verification,
                reference: Some(case.exact(POISSON)),
                spread: None,
                computed,
                bound: Bound::Relative(TOLERANCE),
                setup,
            });
        }
        let at = |stretch: f64| Case {
            dimensions,
            stretch,
        };
        let points = some.iter().map(|(case, found)| (case.stretch, found.0));
        record.plots.push(Plot {
            x: "stretch of the inner surface".into(),
            y: format!("pressure / µ of the {}", at(1.0).name()),
            curves: vec![
                Curve::sampled(1.01..=2.0, |stretch| at(stretch).exact(POISSON))
                    .named("radial equilibrium, ν = 0.49"),
                Curve::sampled(1.01..=2.0, |stretch| at(stretch).incompressible())
                    .named("exact, ν = 0.5"),
            ],
            points: vec![Points::new("computed", points)],
            ..Plot::default()
        });
    }
    Ok(record)
}

/// Returns the pressure in an inflated body of the engine, in units of the shear modulus.
fn inflate<D: Dim>(case: Case) -> Result<(f64, Setup)> {
    let start = Instant::now();
    let n = VOXELS[case.index()];
    let voxel = 1.0 / n as f64;
    let damping = Damping {
        mass: DAMPING,
        stiffness: 0.0,
    };
    let material = rubber(POISSON, damping)?;
    // Distance from the centre [m] of a place [voxels] in the grid.
    let offset = |at: [f64; 3]| {
        let mut offset = DVec3::ZERO;
        (0..D::N).for_each(|axis| offset[axis] = (at[axis] - n as f64) * voxel);
        offset
    };
    let is_inside = |centre: [f64; 3]| offset(centre).length() < case.inner();
    let across = [2 * n, 2 * n, if D::N == 2 { 1 } else { 2 * n }];
    let grid = VoxelGrid::<D>::from_fn(across, voxel as f32, |at| {
        let centre = at.map(|k| f64::from(k) + 0.5);
        u8::from(!is_inside(centre) && offset(centre).length() <= 1.0)
    })?;
    let mut body =
        SoftBody::with_options(grid, &[material], Law::CorotationalVem, Grading::Graded)?;
    let nodes: Vec<_> = body
        .mesh()
        .nodes()
        .map(|(id, node)| (id, node.at))
        .collect();
    let mut held: Vec<NodeId> = Vec::new();
    for (id, at) in nodes {
        let rest = offset(at.map(f64::from));
        let place = rest * (case.inflated(rest.length()) / rest.length());
        body.set_node_state(
            id,
            D::Vector::from_vec3(place.as_vec3()),
            D::Vector::from_vec3(Vec3::ZERO),
        )?;
        let around = (0..1 << D::N).map(|corner| {
            let side = |axis: usize| if corner >> axis & 1 == 1 { 0.5 } else { -0.5 };
            [0, 1, 2].map(|axis| f64::from(at[axis]) + side(axis))
        });
        if around.into_iter().any(is_inside) {
            body.fix_node(id);
            held.push(id);
        }
    }
    let mut world = World::new(still(D::Vector::from_vec3(Vec3::ZERO)))?;
    let body = world.add_soft_body(body)?;
    for _ in 0..(60.0 * SETTLING) as u32 {
        world.step();
    }
    let pressure = pressure(&world[body], &held) / material.elasticity.shear_modulus();
    let setup = Setup {
        n: ((1.0 - case.inner()) * n as f64).round() as usize,
        substeps: Some(world.substeps()),
        seconds: start.elapsed().as_secs_f64(),
    };
    ensure!(world[body].piece_views().len() == 1, "the body has torn");
    Ok((pressure, setup))
}

/// Returns the pressure that the nodes `held` exert [Pa], for a body around the origin: the elastic forces on them are
/// computed again, in double precision.
fn pressure<D: Dim>(body: &SoftBody<D>, held: &[NodeId]) -> f64 {
    let mut total = vec![DVec3::ZERO; body.mesh().node_capacity()];
    for (_, element) in body.mesh().elements() {
        let place = |&node: &NodeId| body.node_state(node).0.to_vec3().as_dvec3();
        let positions: Vec<DVec3> = element.nodes.iter().map(place).collect();
        let size = f64::from(element.cell.width()) * f64::from(body.grid().voxel_size());
        let law = ElasticLaw::from(body.material(element));
        let class = body.mesh().element_class(element);
        let found = forces(Law::CorotationalVem, law, class, size, &positions);
        for (node, force) in element.nodes.iter().zip(found) {
            total[node.index()] += force;
        }
    }
    // dr/dV = 1 / 2πr or 1 / 4πr².
    let work = held.iter().map(|&id| {
        let at = body.node_state(id).0.to_vec3().as_dvec3();
        let radius = at.length();
        let growth = match D::N {
            2 => 0.5 / (PI * radius),
            _ => 0.25 / (PI * radius * radius),
        };
        -total[id.index()].dot(at / radius) * growth
    });
    work.sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pressure_approaches_that_of_rubber_that_keeps_its_volume() {
        for dimensions in [2, 3] {
            for stretch in STRETCHES {
                let case = Case {
                    dimensions,
                    stretch,
                };
                let ratio = case.exact(0.4999) / case.incompressible();
                assert!((ratio - 1.0).abs() < 0.002, "{case:?} {ratio}");
            }
        }
    }

    #[test]
    fn thin_balloon_has_its_maximum_at_the_known_stretch() {
        // p R / µ t = 2 (1/λ − 1/λ⁷), with the maximum 1.2395 at 7^(1/6).
        let thin = |stretch: f64| 2.0 * (1.0 / stretch - stretch.powi(-7));
        let most = 7f64.powf(1.0 / 6.0);
        assert!((thin(most) - 1.2395).abs() < 1e-4 && (most - 1.3831).abs() < 1e-4);
        assert!(thin(most) > thin(most - 0.01) && thin(most) > thin(most + 0.01));
    }
}
