//! What keeps a dent: how an element flows beyond what it bears, in double precision, as the reference of `solve`.
//!
//! The deformation is of two parts, F = Fₑ Fₚ: what was kneaded into the element for good, and what springs back from there
//! [Bargteil 2007]. Kept is G = Fₚ⁻¹, of determinant 1: clay is pressed aside, not together. With R the rotation of Fₑ,
//! S = sym RᵀFₑ, d its deviator and y the yield strain,
//!
//! ```text
//! Fₑ = F G       P = s Pₑ(Fₑ) Gᵀ        s = 1 / λ_max(GᵀG)
//! |d| > y:       G ← G Q / (det G Q)^(1/d),   Q = 1 − min(|d| − y, f) d/|d|
//! ```
//!
//! Q turns with S, so that what is left is exactly as much less strained, and R stays: no decomposition is needed [the
//! return of von Mises' law, to first order]. P Fᵀ is symmetric as Pₑ Fₑᵀ is, so spin is kept; the additive strain of
//! [Mueller 2004] loses that when an element is dented one way and strained another. s keeps what was pressed flat from
//! being too stiff for its substep: in terms of what it was built as, a sheet half as thick is four times as stiff across.
//! Where the flow ends, at a stretch that the material says, it springs as if it had never flowed.

use crate::dim::Dim;
use crate::law::{
    Elasticity, IDENTITY, Matrix, SQUASH_LIMIT, deformation_of, forces_of_stress, rotation_of,
    stress,
};
use crate::stencil::{Stencil, Vector64};
use crate::vector::{cross, dot};

/// An element flows by so much strain in an evaluation at the most: what is torn about does not jump.
/// To first order, as Q is, it errs by half its square, 2 %; with half, with twice and without it the same tests pass.
pub(crate) const MOST_FLOW: f64 = 0.2;
/// What is squashed below this share of its volume is not itself, and flows no further.
/// A choice, a quarter of [`SQUASH_LIMIT`]: from 0 to twice as much the same tests pass.
pub(crate) const LEAST_VOLUME: f64 = 0.1;

/// When a material keeps its dents, and how deep they can be.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Plasticity {
    /// The strain that it bears: so far it is drawn out, or pressed, and still springs back. 0.05 is clay.
    pub yield_strain: f64,
    /// How far it can be kneaded: to how many times less than its width it can be pressed for good.
    pub limit: f64,
}

impl Plasticity {
    /// |d| at which it yields: in d dimensions, of a stretch by ε that keeps the volume, ε √(d / (d − 1)).
    pub(crate) fn most_deviator<D: Dim>(self) -> f64 {
        let axes = D::N as f64;
        self.yield_strain * (axes / (axes - 1.0)).sqrt()
    }

    /// |G|² of what was pressed to the limit along one axis, and gave way evenly along the others.
    pub(crate) fn most_flown<D: Dim>(self) -> f64 {
        let squared = self.limit * self.limit;
        // In the plane there is one other axis, in space two.
        match D::N {
            2 => squared + 1.0 / squared,
            _ => squared + 2.0 / self.limit,
        }
    }
}

/// What is elastic of a deformation F, after G: Fₑ = F G.
pub fn elastic_part(deformation: &Matrix, undone: &Matrix) -> Matrix {
    product(deformation, undone)
}

/// First Piola–Kirchhoff stress [Pa] of a deformation, after G.
pub fn stress_after<D: Dim>(
    elasticity: Elasticity,
    deformation: &Matrix,
    undone: &Matrix,
) -> Matrix {
    let own = stress(elasticity, &elastic_part(deformation, undone));
    let soft = kneaded_stiffness::<D>(undone);
    let mut total = [[0.0; 3]; 3];
    for i in 0..3 {
        for j in 0..3 {
            total[i][j] = soft * dot(own[i], undone[j]);
        }
    }
    total
}

/// The force [N] of an element of width `size` [m] on each of its nodes, at `positions` [m], after G.
///
/// # Panics
/// When the number of positions is not the number of nodes of the stencil.
#[inline(never)]
pub fn forces_after<D: Dim>(
    elasticity: Elasticity,
    undone: &Matrix,
    stencil: &Stencil<D>,
    size: f64,
    positions: &[Vector64],
) -> Vec<Vector64> {
    assert_eq!(positions.len(), stencil.slots.len(), "one position a node");
    let (deformation, _) = deformation_of(stencil, size, positions);
    let stress = stress_after::<D>(elasticity, &deformation, undone);
    forces_of_stress(elasticity, &stress, stencil, size, positions)
}

/// What G becomes when a deformation is more than a material bears.
pub fn flow<D: Dim>(
    plasticity: Plasticity,
    elasticity: Elasticity,
    deformation: &Matrix,
    undone: &Matrix,
) -> Matrix {
    let elastic = elastic_part(deformation, undone);
    if determinant(&elastic) <= LEAST_VOLUME {
        return *undone;
    }
    let rotation = rotation_of(&elastic);
    let column = |m: &Matrix, k: usize| [m[0][k], m[1][k], m[2][k]];
    let whole = determinant(&elastic);
    let mut stretch = IDENTITY;
    for i in 0..D::N {
        for j in 0..D::N {
            let one = dot(column(&rotation, i), column(&elastic, j));
            let other = dot(column(&rotation, j), column(&elastic, i));
            stretch[i][j] = 0.5 * (one + other);
        }
    }
    let mut deviator = stretch;
    (D::N..3).for_each(|k| deviator[k][k] = 0.0);
    let mean = (0..D::N).map(|k| deviator[k][k]).sum::<f64>() / D::N as f64;
    (0..D::N).for_each(|k| deviator[k][k] -= mean);
    let size = squared(&deviator).sqrt();
    let excess = size - plasticity.most_deviator::<D>();
    if excess <= 0.0 {
        return *undone;
    }
    let share = excess.min(MOST_FLOW) / size;
    let mut step = [[0.0; 3]; 3];
    for i in 0..3 {
        for j in 0..3 {
            step[i][j] = f64::from(u8::from(i == j)) - share * deviator[i][j];
        }
    }
    let next = product(undone, &step);
    let volume = determinant(&next);
    // The third axis of the plane is not scaled.
    let scale = 1.0
        / if D::N == 2 {
            volume.sqrt()
        } else {
            libm::cbrt(volume)
        };
    let mut next = next;
    for i in 0..D::N {
        for j in 0..D::N {
            next[i][j] *= scale;
        }
    }
    let inner = |m: &Matrix| squared(m) - (3 - D::N) as f64;
    // What was kneaded back is stiffer: it must not store more than before.
    let eased = product(&stretch, &step);
    let eased = [0, 1, 2].map(|i: usize| {
        [0, 1, 2].map(|j: usize| {
            if i < D::N && j < D::N {
                scale * eased[i][j]
            } else {
                IDENTITY[i][j]
            }
        })
    });
    let before = kneaded_stiffness::<D>(undone) * density(elasticity, &stretch, whole);
    let after = kneaded_stiffness::<D>(&next) * density(elasticity, &eased, whole);
    if after >= before {
        return *undone;
    }
    let may_be = inner(&next) < plasticity.most_flown::<D>() || inner(&next) < inner(undone);
    if may_be { next } else { *undone }
}

/// Elastic energy in a unit of volume [J/m³], of a stretch S in an element of a volume, in terms of what it was.
fn density(elasticity: Elasticity, stretch: &Matrix, volume: f64) -> f64 {
    let mut strain = *stretch;
    (0..3).for_each(|k| strain[k][k] -= 1.0);
    let spread = strain[0][0] + strain[1][1] + strain[2][2];
    let below = (SQUASH_LIMIT - volume).max(0.0);
    elasticity.shear_modulus() * squared(&strain)
        + 0.5 * elasticity.lame() * spread * spread
        + 0.5 * elasticity.young * below * below
}

/// By how much less what was kneaded resists in terms of what it was built as: 1 / λ_max(GᵀG), bounded from the trace and the
/// norm; exact in the plane and for what was pressed flat.
pub fn kneaded_stiffness<D: Dim>(undone: &Matrix) -> f64 {
    let axes = D::N as f64;
    let mut squares = [[0.0; 3]; 3];
    for i in 0..D::N {
        for j in 0..D::N {
            squares[i][j] = (0..D::N).map(|k| undone[k][i] * undone[k][j]).sum();
        }
    }
    let trace = (0..D::N).map(|k| squares[k][k]).sum::<f64>();
    let spread = (squared(&squares) - trace * trace / axes).max(0.0);
    1.0 / (trace / axes + ((axes - 1.0) / axes * spread).sqrt())
}

fn product(a: &Matrix, b: &Matrix) -> Matrix {
    let mut product = [[0.0; 3]; 3];
    for i in 0..3 {
        for j in 0..3 {
            product[i][j] = (0..3).map(|k| a[i][k] * b[k][j]).sum();
        }
    }
    product
}

fn determinant(m: &Matrix) -> f64 {
    dot(m[0], cross(m[1], m[2]))
}

fn squared(m: &Matrix) -> f64 {
    m.iter().map(|&row| dot(row, row)).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dim::{Dim2, Dim3};

    const CLAY: Plasticity = Plasticity {
        yield_strain: 0.05,
        limit: 2.0,
    };

    fn soft() -> Elasticity {
        Elasticity::new(5000.0, 0.3).unwrap()
    }

    fn check_flow<D: Dim>() {
        // Drawn out along the first axis, its volume kept.
        let drawn = |by: f64| {
            let mut f = IDENTITY;
            f[0][0] = by;
            let across = if D::N == 2 { 1.0 / by } else { 1.0 / by.sqrt() };
            (1..D::N).for_each(|k| f[k][k] = across);
            f
        };
        assert_eq!(flow::<D>(CLAY, soft(), &drawn(1.04), &IDENTITY), IDENTITY);
        let mut undone = IDENTITY;
        for _ in 0..40 {
            undone = flow::<D>(CLAY, soft(), &drawn(1.3), &undone);
            assert!((determinant(&undone) - 1.0).abs() < 1e-12);
        }
        // What is left is what it bears, and it has flowed by the rest.
        let left = elastic_part(&drawn(1.3), &undone)[0][0];
        assert!((left - 1.05).abs() < 2e-3, "{left}");
        assert!(kneaded_stiffness::<D>(&undone) <= 1.0);
        // It can be pressed to half its width and no further; there and back is as it was.
        let mut flat = IDENTITY;
        for step in 0..400 {
            let by = 1.0 - 0.7 * f64::from(step.min(300)) / 300.0;
            flat = flow::<D>(CLAY, soft(), &drawn(by), &flat);
        }
        let pressed = 1.0 / flat[0][0];
        assert!((pressed - 0.5).abs() < 0.02, "{pressed}");
        assert!((kneaded_stiffness::<D>(&flat) - 0.25).abs() < 0.03);
        // All at once it would give way by more than it has to: a step is right to first order.
        for step in 0..400 {
            let by = 0.3 + 0.7 * f64::from(step.min(300)) / 300.0;
            flat = flow::<D>(CLAY, soft(), &drawn(by), &flat);
        }
        assert!((1.0 / flat[0][0] - 0.95).abs() < 0.01, "{flat:?}");
    }

    #[test]
    fn it_flows_to_what_it_bears_and_keeps_its_volume() {
        check_flow::<Dim2>();
        check_flow::<Dim3>();
    }

    /// With the additive strain a dent across turned what was strained along.
    #[test]
    fn what_was_dented_one_way_and_is_strained_another_does_not_turn() {
        let mut undone = IDENTITY;
        let sheared = [[1.0, 0.5, 0.0], [0.1, 1.0, 0.2], [0.0, 0.0, 1.0]];
        (0..20).for_each(|_| undone = flow::<Dim3>(CLAY, soft(), &sheared, &undone));
        let elasticity = Elasticity::new(5000.0, 0.3).unwrap();
        let other = [[0.9, -0.2, 0.3], [0.1, 1.2, 0.0], [-0.2, 0.1, 1.1]];
        let stress = stress_after::<Dim3>(elasticity, &other, &undone);
        for (i, j) in [(0, 1), (1, 2), (2, 0)] {
            let spin = dot(stress[i], other[j]) - dot(stress[j], other[i]);
            assert!(spin.abs() < 1e-7 * elasticity.young, "{spin}");
        }
    }
}
