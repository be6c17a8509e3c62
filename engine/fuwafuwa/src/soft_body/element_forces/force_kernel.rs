//! Arithmetic of a batch, all lanes at once.
//!
//! The data of an element class at unit size are the gradient b, rest offset r and volume weight w of each
//! node, and the volume V. Let x be the position of a node relative to the first node of its element, h half
//! the width of the element, d the number of dimensions, P the stress, and k the stiffness of the hourglass
//! modes. The formulas of [`crate::soft_body::element_law`] then become
//!
//! ```text
//! F = Σ x bᵀ / (V h)     G = Σ x (w r)ᵀ     c = Σ w x / V     W = Σ w r rᵀ
//! A = (k / V) (G − h F W) − h^(d−1) P       B = k h F
//! f = A b + B (w r) − k w (x − c)
//! ```
//!
//! Small groups of batches pass through three short loops: gradient, stress and forces. A single long loop
//! would need far more registers than the processor has, and would wait for its chain of square roots and
//! divisions.
//!
//! A plain element is a whole cell with nodes only in its corners. For a plain element, w = 1, and the
//! entries of b and r are ±1, so the sums need only additions and subtractions. Four of five elements are
//! plain.

use super::material_constants::HyperelasticConstants;
use super::rotation_extraction::{Matrix, turn};
use super::tension_kernel::tension_terms;
use crate::foundation::dim::Dim;
use crate::math::lanes::{Eight, LANES, Lanes, at_least, gather, load, positive, scatter, splat};
use crate::math::row::Row;
use crate::soft_body::element_law::{Elasticity, Law, MIN_VOLUME_RATIO};
use fearless_simd::prelude::*;

/// Data of one batch for the kernel.
pub struct BatchView<'a> {
    /// Node ids of the batch. The id of node k of the element in lane l is at k · LANES + l.
    pub nodes: &'a [u32],
    pub half_size: &'a Eight,
    /// Rotation of the element in each lane: a quaternion in 3D, cosine and sine in 2D.
    pub rotation: &'a mut [Eight; 4],
    /// Forces [N] on the nodes in `nodes`, in the same order, with D::N components each.
    pub forces: &'a mut [f32],
    /// Mask of the lanes whose element has negative volume.
    pub inverted: &'a mut u8,
}

/// Elastic moduli of a material [Pa], in single precision.
#[derive(Copy, Clone, Debug)]
pub struct Moduli {
    pub twice_shear: f32,
    pub lame: f32,
    pub young: f32,
    hourglass: f32,
}

impl Moduli {
    pub fn of<D: Dim>(elasticity: Elasticity) -> Self {
        Self {
            twice_shear: (2.0 * elasticity.shear_modulus()) as f32,
            lame: elasticity.lame() as f32,
            young: elasticity.young as f32,
            hourglass: (elasticity.young * D::HOURGLASS) as f32,
        }
    }
}

/// Data of an element class at unit size, as a list of values. The list begins with the gradient b, the
/// product w r of volume weight and rest offset, and w for each node. Then follow the upper triangle of W = Σ
/// w r rᵀ, the inverse volume 1/V, and a stiffness: of the hourglass modes, or of the springs of
/// [`Law::Endo2004`]. `get` returns the value at an index, for all lanes.
pub trait ClassData {
    fn get<S: Simd>(&self, simd: S, index: usize) -> Lanes<S>;
}

/// Class data of a batch in which all lanes have the same class.
pub struct Uniform<'a>(pub &'a [f32]);

/// Class data of a batch in which each lane may have a different class.
pub struct PerLane<'a>(pub &'a [Eight]);

impl ClassData for Uniform<'_> {
    #[inline(always)]
    fn get<S: Simd>(&self, simd: S, index: usize) -> Lanes<S> {
        splat(simd, self.0[index])
    }
}

impl ClassData for PerLane<'_> {
    #[inline(always)]
    fn get<S: Simd>(&self, simd: S, index: usize) -> Lanes<S> {
        load(simd, &self.0[index])
    }
}

/// Number of values per node in the data of an element class.
pub const fn class_data_per_node<D: Dim>() -> usize {
    2 * D::N + 1
}

/// Number of values in the data of an element class with `nodes` nodes.
pub const fn class_data_len<D: Dim>(nodes: usize) -> usize {
    class_data_per_node::<D>() * nodes + D::N * (D::N + 1) / 2 + 2
}

/// Intermediate results of one batch, which one loop of the kernel passes to the next.
#[derive(Copy, Clone, Debug)]
pub struct Scratch {
    /// Positions of the nodes [m] relative to the first node of the element.
    pub x: [[Eight; 3]; 27],
    pub f: [[Eight; 3]; 3],
    pub moment: [[Eight; 3]; 3],
    pub centre: [Eight; 3],
    /// max(J − 1, 0), if the material is hyperelastic.
    pub swelling: Eight,
    /// First Piola–Kirchhoff stress [Pa]; under [`Law::Endo2004`], which has no stress, the rotation matrix
    /// of the element.
    pub stress: [[Eight; 3]; 3],
}

impl Scratch {
    pub const EMPTY: Self = Self {
        x: [[[0.0; LANES]; 3]; 27],
        f: [[[0.0; LANES]; 3]; 3],
        moment: [[[0.0; LANES]; 3]; 3],
        centre: [[0.0; LANES]; 3],
        swelling: [0.0; LANES],
        stress: [[[0.0; LANES]; 3]; 3],
    };
}

/// First loop, for plain elements: computes the deformation gradient and the centroid from sums and
/// differences of node positions.
#[inline(always)]
pub fn plain_gradient<D: Dim, S: Simd>(
    simd: S,
    position: &[Row],
    view: &BatchView,
    scratch: &mut Scratch,
) {
    let zero = splat(simd, 0.0);
    let share = splat(simd, 1.0 / D::CORNERS as f32);
    let scale = share / load(simd, view.half_size);
    let origin = gather(simd, position, places(view.nodes, 0));
    let mut x = [[zero; 3]; 8];
    for node in 1..D::CORNERS {
        let at = gather(simd, position, places(view.nodes, node));
        for i in 0..D::N {
            x[node][i] = at[i] - origin[i];
            x[node][i].store_array(&mut scratch.x[node][i]);
        }
    }
    for i in 0..D::N {
        let (d0, s0) = (x[1][i], x[1][i]);
        let (d1, s1) = (x[3][i] - x[2][i], x[3][i] + x[2][i]);
        let f = &mut scratch.f[i];
        // Columns of the deformation gradient are differences of the corners, and the centroid is their sum,
        // with constant factors. Corners are combined in pairs along the first axis, then in pairs of pairs
        // along the next axes.
        if D::N == 2 {
            (scale * (d0 + d1)).store_array(&mut f[0]);
            (scale * (s1 - s0)).store_array(&mut f[1]);
            (share * (s0 + s1)).store_array(&mut scratch.centre[i]);
        } else {
            let (d2, s2) = (x[5][i] - x[4][i], x[5][i] + x[4][i]);
            let (d3, s3) = (x[7][i] - x[6][i], x[7][i] + x[6][i]);
            let (low, high) = (s0 + s1, s2 + s3);
            (scale * (d0 + d1 + (d2 + d3))).store_array(&mut f[0]);
            (scale * (s1 - s0 + (s3 - s2))).store_array(&mut f[1]);
            (scale * (high - low)).store_array(&mut f[2]);
            (share * (low + high)).store_array(&mut scratch.centre[i]);
        }
    }
}

/// First loop, for any element class: computes the deformation gradient, the centroid, and the moment Σ x (w
/// r)ᵀ of the hourglass term.
#[inline(always)]
pub fn gradient<D: Dim, S: Simd>(
    simd: S,
    class_data: &impl ClassData,
    position: &[Row],
    view: &BatchView,
    scratch: &mut Scratch,
) {
    let zero = splat(simd, 0.0);
    let count = view.nodes.len() / LANES;
    let a_node = class_data_per_node::<D>();
    let origin = gather(simd, position, places(view.nodes, 0));
    for i in 0..D::N {
        zero.store_array(&mut scratch.x[0][i]);
    }
    let mut f = [[zero; 3]; 3];
    let mut moment = [[zero; 3]; 3];
    let mut centre = [zero; 3];
    for node in 1..count {
        let at = gather(simd, position, places(view.nodes, node));
        let w = class_data.get(simd, a_node * node + 2 * D::N);
        let mut x = [zero; 3];
        for i in 0..D::N {
            x[i] = at[i] - origin[i];
            x[i].store_array(&mut scratch.x[node][i]);
            centre[i] += x[i] * w;
        }
        for j in 0..D::N {
            let b = class_data.get(simd, a_node * node + j);
            let wr = class_data.get(simd, a_node * node + D::N + j);
            for i in 0..D::N {
                f[i][j] += x[i] * b;
                moment[i][j] += x[i] * wr;
            }
        }
    }
    let inverse_volume = class_data.get(simd, class_data_len::<D>(count) - 2);
    let scale = inverse_volume / load(simd, view.half_size);
    for i in 0..D::N {
        for j in 0..D::N {
            (f[i][j] * scale).store_array(&mut scratch.f[i][j]);
            moment[i][j].store_array(&mut scratch.moment[i][j]);
        }
        (centre[i] * inverse_volume).store_array(&mut scratch.centre[i]);
    }
}

/// Second loop: updates the rotation and computes the stress of each element.
#[inline(always)]
pub fn stress<D: Dim, S: Simd>(
    simd: S,
    law: Law,
    moduli: &Moduli,
    view: &mut BatchView,
    scratch: &mut Scratch,
) {
    let mut f = [[splat(simd, 0.0); 3]; 3];
    for i in 0..D::N {
        for j in 0..D::N {
            f[i][j] = load(simd, &scratch.f[i][j]);
        }
    }
    let rotation = turn::<D, S>(simd, &f, view.rotation);
    let stress = match law {
        Law::CorotationalVem => stress_of::<D, S>(simd, moduli, &f, &rotation, view.inverted),
        Law::Endo2004 => rotation,
    };
    for i in 0..D::N {
        for j in 0..D::N {
            stress[i][j].store_array(&mut scratch.stress[i][j]);
        }
    }
}

/// Third loop, for plain elements: computes the nodal forces.
#[inline(always)]
pub fn plain_forces<D: Dim, S: Simd>(
    simd: S,
    moduli: &Moduli,
    view: &mut BatchView,
    scratch: &Scratch,
) {
    let half = load(simd, view.half_size);
    let (stiffness, area) = scales::<D, S>(simd, moduli, half);
    let bend = stiffness * half;
    let mut force = [[splat(simd, 0.0); 3]; 8];
    for i in 0..D::N {
        let centre = load(simd, &scratch.centre[i]);
        force[0][i] = stiffness * centre;
        for node in 1..D::CORNERS {
            force[node][i] = stiffness * (centre - load(simd, &scratch.x[node][i]));
        }
    }
    for i in 0..D::N {
        let mut m = [splat(simd, 0.0); 3];
        for j in 0..D::N {
            m[j] = bend * load(simd, &scratch.f[i][j]) - area * load(simd, &scratch.stress[i][j]);
        }
        // The force at a corner is ± m[0] ± m[1] ± m[2], with plus on the high side of an axis and minus on
        // the low side. Opposite corners have opposite forces, so one sum serves both.
        if D::N == 2 {
            let (sum, difference) = (m[0] + m[1], m[0] - m[1]);
            force[0][i] -= sum;
            force[1][i] += difference;
            force[2][i] -= difference;
            force[3][i] += sum;
        } else {
            let (sum, difference) = (m[1] + m[2], m[1] - m[2]);
            let turns = [sum + m[0], sum - m[0], difference + m[0], difference - m[0]];
            force[0][i] -= turns[0];
            force[1][i] -= turns[1];
            force[2][i] += turns[3];
            force[3][i] += turns[2];
            force[4][i] -= turns[2];
            force[5][i] -= turns[3];
            force[6][i] += turns[1];
            force[7][i] += turns[0];
        }
    }
    for node in 0..D::CORNERS {
        scatter(simd, force[node], D::N, target::<D>(view.forces, node));
    }
}

/// Third loop, for any element class: computes the nodal forces. `hyperelastic` are the constants of a hyperelastic
/// material.
#[inline(always)]
pub fn forces<D: Dim, S: Simd>(
    simd: S,
    law: Law,
    (moduli, hyperelastic): (&Moduli, Option<&HyperelasticConstants>),
    class_data: &impl ClassData,
    view: &mut BatchView,
    scratch: &Scratch,
) {
    let zero = splat(simd, 0.0);
    let count = view.nodes.len() / LANES;
    let a_node = class_data_per_node::<D>();
    let half = load(simd, view.half_size);
    let (mut pull, mut shear) = ([[zero; 3]; 3], [[zero; 3]; 3]);
    let stiffness;
    let own_stiffness = class_data.get(simd, class_data_len::<D>(count) - 1);
    if law == Law::CorotationalVem {
        let (plain_spring, area) = scales::<D, S>(simd, moduli, half);
        let mut spring = plain_spring * own_stiffness;
        let tension = hyperelastic.map(|constants| {
            let sizes = (count, half, spring);
            tension_terms::<D, S>(simd, constants.tension_rate, class_data, sizes, scratch)
        });
        if let Some((growth, _)) = tension {
            spring *= growth;
        }
        let inverse_volume = class_data.get(simd, class_data_len::<D>(count) - 2);
        let (bend, skew) = (spring * half, spring * inverse_volume);
        stiffness = spring;
        for i in 0..D::N {
            for j in 0..D::N {
                let mut bent = zero;
                for k in 0..D::N {
                    let spread = class_data.get(simd, a_node * count + symmetric::<D>(k, j));
                    bent += load(simd, &scratch.f[i][k]) * spread;
                }
                let moment = load(simd, &scratch.moment[i][j]);
                let stress = load(simd, &scratch.stress[i][j]);
                pull[i][j] = skew * (moment - half * bent) - area * stress;
                shear[i][j] = bend * load(simd, &scratch.f[i][j]);
                if let Some((_, tension)) = tension {
                    pull[i][j] -= tension[i][j];
                }
            }
        }
    } else {
        // Factor h^(d−2) from Young's modulus to a stiffness per node, with half width h in d dimensions: 1
        // in 2D, h in 3D.
        let length = if D::N == 2 { splat(simd, 1.0) } else { half };
        stiffness = splat(simd, moduli.young) * own_stiffness * length;
        for i in 0..D::N {
            for j in 0..D::N {
                pull[i][j] = stiffness * half * load(simd, &scratch.stress[i][j]);
            }
        }
    }
    for node in 0..count {
        let spring = stiffness * class_data.get(simd, a_node * node + 2 * D::N);
        let mut force = [zero; 3];
        for i in 0..D::N {
            let centre = load(simd, &scratch.centre[i]);
            let x = load(simd, &scratch.x[node][i]);
            force[i] = spring * (centre - x);
        }
        for j in 0..D::N {
            let b = class_data.get(simd, a_node * node + j);
            let wr = class_data.get(simd, a_node * node + D::N + j);
            for i in 0..D::N {
                force[i] += pull[i][j] * b + shear[i][j] * wr;
            }
        }
        scatter(simd, force, D::N, target::<D>(view.forces, node));
    }
}

/// Returns two factors for elements of half width h: the stiffness k of the hourglass modes of a plain
/// element, and h^(d−1), by which a stress is multiplied to get a nodal force.
#[inline(always)]
fn scales<D: Dim, S: Simd>(simd: S, moduli: &Moduli, half: Lanes<S>) -> (Lanes<S>, Lanes<S>) {
    let hourglass = splat(simd, moduli.hourglass);
    if D::N == 2 {
        (hourglass, half)
    } else {
        (hourglass * (half + half), half * half)
    }
}

/// Returns the first Piola–Kirchhoff stress [Pa] of the deformation gradient `f` with rotation `r`. Sets in
/// `inverted` the mask of the lanes with negative volume.
#[inline(always)]
pub(super) fn stress_of<D: Dim, S: Simd>(
    simd: S,
    moduli: &Moduli,
    f: &Matrix<S>,
    r: &Matrix<S>,
    inverted: &mut u8,
) -> Matrix<S> {
    let zero = splat(simd, 0.0);
    let mut stretch = splat(simd, -(D::N as f32));
    for i in 0..D::N {
        for j in 0..D::N {
            stretch += f[i][j] * r[i][j];
        }
    }
    let twice_shear = splat(simd, moduli.twice_shear);
    let pressure = splat(simd, moduli.lame) * stretch - twice_shear;
    let cofactor = cofactor::<D, S>(zero, f);
    let mut squash = splat(simd, MIN_VOLUME_RATIO as f32);
    for j in 0..D::N {
        squash -= f[0][j] * cofactor[0][j];
    }
    *inverted = positive(squash - splat(simd, MIN_VOLUME_RATIO as f32));
    let barrier = splat(simd, moduli.young) * at_least(squash, zero);
    let mut p = [[zero; 3]; 3];
    for i in 0..D::N {
        for j in 0..D::N {
            p[i][j] = twice_shear * f[i][j] + pressure * r[i][j] - barrier * cofactor[i][j];
        }
    }
    p
}

/// Returns the cofactor matrix; in 2D of the first two rows and columns.
#[inline(always)]
pub(super) fn cofactor<D: Dim, S: Simd>(zero: Lanes<S>, f: &Matrix<S>) -> Matrix<S> {
    let mut cofactor = [[zero; 3]; 3];
    // In 2D, the cofactors are the entries of `f` themselves, swapped and with changed signs.
    if D::N == 2 {
        cofactor[0] = [f[1][1], zero - f[1][0], zero];
        cofactor[1] = [zero - f[0][1], f[0][0], zero];
        return cofactor;
    }
    for i in 0..3 {
        let (a, b) = (f[(i + 1) % 3], f[(i + 2) % 3]);
        for j in 0..3 {
            let (k, l) = ((j + 1) % 3, (j + 2) % 3);
            cofactor[i][j] = a[k] * b[l] - a[l] * b[k];
        }
    }
    cofactor
}

/// Returns the index of the entry in row i and column j of a symmetric matrix of which only the upper
/// triangle is stored, row by row.
#[inline(always)]
pub fn symmetric<D: Dim>(i: usize, j: usize) -> usize {
    let (low, high) = if i < j { (i, j) } else { (j, i) };
    low * D::N - low * (low + 1) / 2 + high
}

#[inline(always)]
fn places(nodes: &[u32], node: usize) -> &[u32; LANES] {
    nodes[node * LANES..][..LANES]
        .try_into()
        .expect("every node has one index per lane")
}

#[inline(always)]
fn target<D: Dim>(forces: &mut [f32], node: usize) -> &mut [f32] {
    &mut forces[node * D::N * LANES..][..D::N * LANES]
}
