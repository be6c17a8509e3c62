//! Elastic energy of a deformed body. Its negative gradient is the force of the default law:
//!
//! ```text
//! E = V (μ ‖F − R‖² + λ/2 (tr RᵀF − d)²) + k/2 Σ w_i |h_i|²
//! ```
//!
//! F is the deformation gradient, R its rotation, d the number of dimensions (a plane body counts as 3D) and
//! V the volume. μ and λ are Lamé's parameters. h_i is the deviation of node i from the affine motion, with
//! weight w_i and hourglass stiffness k. The formula omits the extra resistance of an element that is
//! squashed flat, because no check deforms a body that far.

use fuwafuwa::glam::DVec3;
use fuwafuwa::inspect::{Elasticity, ElementClass, Matrix};
use fuwafuwa::{Dim, DimVector, NodeId, SoftBody};

/// Returns the elastic energy of a body [J].
pub fn of_body<D: Dim>(body: &SoftBody<D>) -> f64 {
    let elements = body.mesh().elements().map(|(_, element)| {
        let place = |&node: &NodeId| body.node_state(node).0.to_vec3().as_dvec3();
        let positions: Vec<DVec3> = element.nodes.iter().map(place).collect();
        let size = f64::from(element.cell.width()) * f64::from(body.grid().voxel_size());
        let elasticity = body.material(element).elasticity;
        of_element(
            elasticity,
            body.mesh().element_class(element),
            size,
            &positions,
        )
    });
    elements.sum()
}

/// Returns the elastic energy of an element of width `size` [m] with its nodes at `positions` [m].
fn of_element<D: Dim>(
    elasticity: Elasticity,
    stencil: &ElementClass<D>,
    size: f64,
    positions: &[DVec3],
) -> f64 {
    let half = 0.5 * size;
    let mut deformation = [DVec3::ZERO; 3];
    let mut centre = DVec3::ZERO;
    for (k, &at) in positions.iter().enumerate() {
        centre += at * (stencil.volumes[k] / stencil.volume);
        for i in 0..3 {
            let share = at[i] / (stencil.volume * half);
            deformation[i] += stencil.gradients[k] * share;
        }
    }
    if D::N == 2 {
        deformation[2] = DVec3::Z;
    }
    let rotation = rotation_of(&deformation);
    let (mut apart, mut growth) = (0.0, -3.0);
    for (f, r) in deformation.into_iter().zip(rotation) {
        apart += (f - r).length_squared();
        growth += f.dot(r);
    }
    let (shear, lame) = (elasticity.shear_modulus(), elasticity.lame());
    let density = shear * apart + 0.5 * lame * growth * growth;
    let volume = (0..D::N).fold(stencil.volume, |volume, _| volume * half);

    let swerve = |(k, &at): (usize, &DVec3)| {
        let rest = stencil.offsets[k] * half;
        let affine = centre + DVec3::from(deformation.map(|row| row.dot(rest)));
        stencil.volumes[k] * (at - affine).length_squared()
    };
    let hourglass_modulus = D::HOURGLASS * stencil.hourglass * elasticity.young;
    let stiffness = (2..D::N).fold(hourglass_modulus, |stiffness, _| stiffness * size);
    let hourglass: f64 = positions.iter().enumerate().map(swerve).sum();
    volume * density + 0.5 * stiffness * hourglass
}

/// Returns the rotation part of a matrix with positive determinant, by Newton's iteration for the polar
/// factor.
fn rotation_of(matrix: &Matrix) -> Matrix {
    let mut rotation = *matrix;
    for _ in 0..30 {
        let [a, b, c] = rotation;
        let cofactors = [b.cross(c), c.cross(a), a.cross(b)];
        let determinant = a.dot(cofactors[0]);
        for (row, cofactor) in rotation.iter_mut().zip(cofactors) {
            *row = (*row + cofactor * (1.0 / determinant)) * 0.5;
        }
    }
    rotation
}

#[cfg(test)]
mod tests {
    use super::*;
    use fuwafuwa::inspect::{cell_corners, closure, forces};
    use fuwafuwa::{Dim2, Dim3, Law};

    /// Checks that the elastic force is the negative gradient of the elastic energy. `slots` selects the mid
    /// nodes of the element.
    fn check_slope<D: Dim>(children: u8, slots: u32) {
        let elasticity = Elasticity::new(1000.0, 0.3).unwrap();
        let stencil = ElementClass::<D>::new(children, slots).unwrap();
        let size = 0.5;
        let bent = |r: &DVec3| {
            let [x, y, z] = (*r * (0.5 * size)).to_array();
            let third = if D::N == 3 { z + 0.3 * x } else { 0.0 };
            DVec3::new(
                1.1 * x - 0.3 * y + x * y,
                0.9 * y + 0.2 * x + 0.7 * x * x,
                third,
            )
        };
        let positions: Vec<DVec3> = stencil.offsets.iter().map(bent).collect();
        let found = forces(
            Law::CorotationalVem,
            elasticity.into(),
            &stencil,
            size,
            &positions,
        );
        for (node, axis) in (0..positions.len()).flat_map(|k| (0..D::N).map(move |i| (k, i))) {
            let at = |by: f64| {
                let mut moved = positions.clone();
                moved[node][axis] += by;
                of_element(elasticity, &stencil, size, &moved)
            };
            let slope = (at(-1e-6) - at(1e-6)) / 2e-6;
            let error = (found[node][axis] - slope).abs();
            assert!(error < 1e-5, "{:?} is not {slope}", found[node]);
        }
    }

    #[test]
    fn force_is_the_negative_gradient_of_the_energy() {
        check_slope::<Dim2>(15, cell_corners::<Dim2>() | 1 << 1);
        check_slope::<Dim2>(0b0111, closure::<Dim2>(0b0111));
        check_slope::<Dim3>(255, cell_corners::<Dim3>() | 1 << 4);
        check_slope::<Dim3>(0b0111_1111, closure::<Dim3>(0b0111_1111));
    }
}
