//! Load near a node: the driving force on a crack tip, and the mean tension at a surface.
//!
//! Both are sums over the elements within a few voxels, so that neither the voxels nor the steps of a crack
//! along them matter. The driving force is the energy-release vector, also called configurational force
//! [Eshelby 1951; Rice 1968]:
//!
//! ```text
//! J = (1/L) Σ V [(F − R̄)ᵀ P − W] ∇q        |J| = energy release rate       J / |J| = direction of growth
//! ```
//!
//! Each element has the volume V, the deformation gradient F, the stress P and the energy density W. R̄ is the
//! rotation at the tip. The weight q falls from 1 near the tip to 0 at [`outer_radius`]. In 3D, L is the length of
//! the crack front, weighted by q; in 2D it is 1 m.

use crate::foundation::dim::{Dim, Point, points_in};
use crate::foundation::ids::{ElementId, NodeId};
use crate::material::Material;
use crate::math::row::Row;
use crate::soft_body::SoftBody;
use crate::soft_body::element_law::{Elasticity, Matrix};
use crate::soft_body::hyperelasticity;
use crate::soft_body::plasticity::plastic_stiffness_factor;
use crate::soft_body::viscosity::viscous_stress;
use glam::Vec3;

/// Distance from the tip at which the weight q begins to fall [voxels].
const INNER_RADIUS: f32 = 1.5;
/// Number of elements whose loads are kept for the fields of neighbouring nodes; a power of two.
const CACHED: usize = 512;
/// Place of a load that is not kept.
const NONE: u32 = u32::MAX;
/// Volume ratio below which the stress of an element counts as 0. Such an element is crushed, and dividing by
/// the ratio would make its stress arbitrarily large.
const MIN_RATIO: f32 = 0.1;

/// Distance from the tip at which the weight q reaches 0 [voxels]. In 3D the radius is smaller, because the
/// number of elements grows with its cube.
fn outer_radius<D: Dim>() -> f32 {
    if D::N == 2 { 3.0 } else { 2.0 }
}

/// Matrix by rows.
pub type Rows = [Vec3; 3];

/// Deformation, stress and energy of one element.
#[derive(Copy, Clone, Debug)]
struct Load {
    deformation: Rows,
    /// First Piola–Kirchhoff stress [Pa].
    stress: Rows,
    /// Elastic energy density [J/m³], without the energy of hourglass modes.
    energy: f32,
}

/// Computes the loads near nodes of one body. Keeps the loads of elements, because the fields of
/// neighbouring nodes overlap.
pub struct NearField<'a, D: Dim> {
    body: &'a SoftBody<D>,
    /// Loads computed so far.
    loads: Vec<(ElementId, Load)>,
    /// Cache: entry k is the index in `loads` of the most recent element with an id of k modulo [`CACHED`], or
    /// [`NONE`].
    places: Vec<u32>,
    /// Scratch list of the elements near a node, with the volume of their part within a radius [voxels].
    near: Vec<(ElementId, f32)>,
    /// Scratch list of the offsets of tips [voxels].
    tips: Vec<Vec3>,
}

impl<'a, D: Dim> NearField<'a, D> {
    /// Creates a calculator for a body, whose positions and rotations must not change meanwhile.
    pub fn new(body: &'a SoftBody<D>) -> Self {
        Self {
            body,
            loads: Vec::new(),
            places: Vec::new(),
            near: Vec::new(),
            tips: Vec::new(),
        }
    }

    /// Returns the energy-release vector [J/m²] at a crack tip, along the axes of the undeformed body, and the
    /// front through the tip.
    pub fn energy_release(&mut self, tip: NodeId, rotation: &Rows) -> (Vec3, Front) {
        let body = self.body;
        let (mesh, at) = (body.mesh(), body.mesh().node(tip).at);
        let radius = outer_radius::<D>();
        let most = (radius * radius) as i32;
        let weights = weights::<D>();
        self.gather(tip, radius.ceil() as i32, |_| 1.0);
        let half_voxel = 0.5 * body.grid().voxel_size();
        let mut force = Vec3::ZERO;
        self.tips.clear();
        for place in 0..self.near.len() {
            let (id, _) = self.near[place];
            let element = mesh
                .element(id)
                .expect("elements that own voxels are alive");
            let class = mesh.element_class(element);
            let half = half_voxel * element.cell.width() as f32;
            // V ∇q, in voxel faces times half the width of the element.
            let mut slope = Vec3::ZERO;
            for (&node, gradient) in element.nodes.iter().zip(&class.gradients) {
                let point = mesh.node(node).at;
                let (x, y, z) = (point[0] - at[0], point[1] - at[1], point[2] - at[2]);
                let square = x * x + y * y + z * z;
                if D::N == 3 && square <= most && body.breakable_nodes().is_tip(node) {
                    self.tips.push(Vec3::new(x as f32, y as f32, z as f32));
                }
                let weight = weights.get(square as usize).copied();
                slope += gradient.as_vec3() * weight.unwrap_or(0.0);
            }
            if slope == Vec3::ZERO {
                continue;
            }
            let slope = slope * (1..D::N).fold(1.0, |area, _| area * half);
            let load = self.load(id);
            // Σᵢ (F − R̄)ᵢ (P ∇q)ᵢ − W ∇q
            force -= slope * load.energy;
            for row in 0..D::N {
                let traction = load.stress[row].dot(slope);
                force += (load.deformation[row] - rotation[row]) * traction;
            }
        }
        (D::N..3).for_each(|axis| force[axis] = 0.0);
        let front = Front::through::<D>(body.grid().voxel_size(), &self.tips);
        (force / front.length, front)
    }

    /// Returns the mean Cauchy stress [Pa] within `radius` [voxels] of a node; `None` if no element there carries
    /// stress.
    pub fn mean_stress(&mut self, node: NodeId, radius: f32) -> Option<Rows> {
        let at = self.body.mesh().node(node).at;
        let share = |voxel: Point| {
            let apart = distance::<D>([0, 1, 2].map(|axis: usize| {
                (voxel[axis] - at[axis]) as f32 + if axis < D::N { 0.5 } else { 0.0 }
            }));
            (radius + 0.5 - apart).clamp(0.0, 1.0)
        };
        self.gather(node, (radius + 0.5).ceil() as i32, share);
        let mut sum = [Vec3::ZERO; 3];
        let mut volume = 0.0;
        for place in 0..self.near.len() {
            let (id, share) = self.near[place];
            // Elements in a grip move as a whole and carry no stress, although their surroundings do.
            if self.is_fixed(id) {
                continue;
            }
            let load = self.load(id);
            volume += share;
            let ratio = determinant(&load.deformation);
            if ratio < MIN_RATIO {
                continue;
            }
            let share = share / ratio;
            for row in 0..D::N {
                for column in 0..D::N {
                    sum[row][column] += share * load.stress[row].dot(load.deformation[column]);
                }
            }
            (D::N..3).for_each(|axis| sum[axis][axis] += share * load.stress[axis][axis]);
        }
        (volume > 0.0).then(|| sum.map(|row| row / volume))
    }

    /// Returns the equivalent tension [Pa] of the Cauchy stress in one element.
    pub fn tension_in(&mut self, id: ElementId, pressure_factor: Option<f32>) -> f32 {
        let load = self.load(id);
        let ratio = determinant(&load.deformation);
        if ratio < MIN_RATIO || self.is_fixed(id) {
            return 0.0;
        }
        let stress = load.stress.map(|row| {
            Vec3::from([0, 1, 2].map(|column: usize| row.dot(load.deformation[column]) / ratio))
        });
        equivalent_tension::<D>(&stress, pressure_factor)
    }

    /// Lists the elements of the node's piece in the voxels up to `reach` away, each once, with the sum of
    /// `share` over these voxels.
    fn gather(&mut self, node: NodeId, reach: i32, share: impl Fn(Point) -> f32) {
        let body = self.body;
        let (mesh, pieces) = (body.mesh(), body.pieces());
        let (at, piece) = (mesh.node(node).at, pieces.of_node(node));
        let (mut low, mut high) = (at, at);
        low[..D::N].iter_mut().for_each(|k| *k -= reach);
        high[..D::N].iter_mut().for_each(|k| *k += reach - 1);
        self.near.clear();
        for voxel in points_in(low, high) {
            let Some(owner) = mesh.owner(voxel) else {
                continue;
            };
            let share = share(voxel);
            if share > 0.0 {
                self.near.push((owner, share));
            }
        }
        // The order of the sums must not depend on the ids of elements, so the list keeps the order of the
        // voxels.
        let mut count = 0;
        for place in 0..self.near.len() {
            let (owner, share) = self.near[place];
            let is_larger = mesh
                .element(owner)
                .is_some_and(|element| element.cell.width() > 1);
            let known = match is_larger {
                true => self.near[..count].iter().rposition(|&(id, _)| id == owner),
                false => None,
            };
            match known {
                Some(known) => self.near[known].1 += share,
                None if pieces.of_element(owner) == piece => {
                    self.near[count] = (owner, share);
                    count += 1;
                }
                None => {}
            }
        }
        self.near.truncate(count);
    }

    /// Returns whether all nodes of an element are fixed.
    fn is_fixed(&self, id: ElementId) -> bool {
        let element = self.body.mesh().element(id);
        element.is_some_and(|element| element.nodes.iter().all(|&node| self.body.is_fixed(node)))
    }

    /// Returns the load of an element.
    fn load(&mut self, id: ElementId) -> Load {
        if self.places.is_empty() {
            self.places.resize(CACHED, NONE);
        }
        let place = &mut self.places[id.index() % CACHED];
        if let Some(&(known, load)) = self.loads.get(*place as usize)
            && known == id
        {
            return load;
        }
        let load = load_of(self.body, id);
        *place = self.loads.len() as u32;
        self.loads.push((id, load));
        load
    }
}

/// Returns the uniaxial tension [Pa] that is as critical as a Cauchy stress: its greatest principal value, or by the
/// criterion of Drucker and Prager with the factor γ.
pub fn equivalent_tension<D: Dim>(stress: &Rows, pressure_factor: Option<f32>) -> f32 {
    let Some(factor) = pressure_factor else {
        return greatest_eigenvalue::<D>(stress);
    };
    let trace = stress[0].x + stress[1].y + stress[2].z;
    let half = |i: usize, j: usize| 0.5 * (stress[i][j] + stress[j][i]);
    let mut squares = 0.0;
    for i in 0..3 {
        let normal = stress[i][i] - trace / 3.0;
        let shear = half(i, (i + 1) % 3);
        squares += 0.5 * normal * normal + shear * shear;
    }
    (squares.sqrt() + factor * trace) / (1.0 / 3f32.sqrt() + factor)
}

/// Returns the weight q at each squared distance from the tip [voxels²]; at larger distances, it is 0.
fn weights<D: Dim>() -> [f32; 9] {
    let radius = outer_radius::<D>();
    let weight = |square: usize| (radius - (square as f32).sqrt()) / (radius - INNER_RADIUS);
    std::array::from_fn(|square| weight(square).clamp(0.0, 1.0))
}

/// Returns the integral of the weight q over the first `length` of a line through the tip [voxels].
fn weight_along<D: Dim>(length: f32) -> f32 {
    let radius = outer_radius::<D>();
    let inner = length.min(INNER_RADIUS);
    let outer = length.clamp(INNER_RADIUS, radius) - radius;
    let width = radius - INNER_RADIUS;
    inner + 0.5 * (width - outer * outer / width)
}

/// Crack front near a tip.
#[derive(Copy, Clone, Debug)]
pub struct Front {
    /// Unit vector along the front, along the axes of the undeformed body; zero in 2D and at a lone tip.
    pub direction: Vec3,
    /// Length of the front, weighted by q [m]; 1 in 2D.
    pub length: f32,
}

impl Front {
    /// Returns the front through a tip. `tips` are the offsets of the tips of its piece within the outer radius
    /// [voxels], `size` is the voxel size [m]. The front is taken as a straight line through the tip to the
    /// farthest of the others, and on the other side as far as tips reach there.
    fn through<D: Dim>(size: f32, tips: &[Vec3]) -> Self {
        if D::N == 2 {
            return Self {
                direction: Vec3::ZERO,
                length: 1.0,
            };
        }
        let mut far = Vec3::ZERO;
        for &offset in tips {
            if offset.length_squared() > far.length_squared() {
                far = offset;
            }
        }
        let direction = far.normalize_or_zero();
        let back = tips.iter().map(|offset| -offset.dot(direction));
        let back = back.fold(0.0, f32::max);
        let side = |reach: f32| weight_along::<D>(reach.max(0.5));
        Self {
            direction,
            length: size * (side(far.length()) + side(back)),
        }
    }
}

/// Returns the deformation, the stress and the energy density of an element, from the positions of its nodes
/// and its rotation in the last substep.
fn load_of<D: Dim>(body: &SoftBody<D>, id: ElementId) -> Load {
    let mesh = body.mesh();
    let element = mesh
        .element(id)
        .expect("elements that own voxels are alive");
    let class = mesh.element_class(element);
    let half = 0.5 * body.grid().voxel_size() * element.cell.width() as f32;
    let scale = 1.0 / (class.volume as f32 * half);
    let positions = body.positions();
    let origin = positions[element.nodes[0]].xyz();
    let mut deformation = [Vec3::ZERO; 3];
    for (&node, gradient) in element.nodes.iter().zip(&class.gradients) {
        let offset: Row = positions[node];
        let offset = (offset.xyz() - origin) * scale;
        let gradient = gradient.as_vec3();
        (0..D::N).for_each(|row| deformation[row] += gradient * offset[row]);
    }
    (D::N..3).for_each(|row| deformation[row] = Vec3::AXES[row]);
    let batches = body.element_forces();
    let rotation = batches.rotation(id);
    let mut material = *body.material(element);
    material.elasticity.young *= body.stiffness_scale();
    let dashpots = batches.internal_state(id).map(|state| state.dashpots);
    let Some(plastic) = batches.plastic_inverse(id) else {
        let (stress, energy) = stress_of::<D>(&material, &deformation, &rotation, dashpots);
        return Load {
            deformation,
            stress,
            energy,
        };
    };
    let elastic = product(&deformation, &plastic);
    let soft = plastic_stiffness_factor::<D>(&plastic.map(|row| row.as_dvec3())) as f32;
    let (stress, energy) = stress_of::<D>(&material, &elastic, &rotation, dashpots);
    let transposed =
        [0, 1, 2].map(|k: usize| Vec3::new(plastic[0][k], plastic[1][k], plastic[2][k]));
    Load {
        deformation,
        stress: product(&stress, &transposed).map(|row| row * soft),
        energy: soft * energy,
    }
}

/// Returns the first Piola–Kirchhoff stress [Pa] and the energy density [J/m³] of an elastic deformation with a known
/// rotation, with the strains of the dashpots if the material has an internal state.
fn stress_of<D: Dim>(
    material: &Material,
    deformation: &Rows,
    rotation: &Rows,
    dashpots: Option<[[f32; 6]; 2]>,
) -> (Rows, f32) {
    let elasticity = material.elasticity;
    let wide = deformation.map(|row| row.as_dvec3());
    let narrow = |stress: Matrix| stress.map(|row| row.as_vec3());
    let (mut stress, mut energy) = match material.stress_law.factors() {
        None => elastic_stress::<D>(elasticity, deformation, rotation),
        Some(factors) => (
            narrow(hyperelasticity::stress(elasticity, factors, &wide)),
            hyperelasticity::energy(elasticity, factors, &wide) as f32,
        ),
    };
    if let Some(dashpots) = dashpots
        && material.is_viscous()
    {
        let dashpots = dashpots.map(|term| term.map(f64::from));
        let (own, stored) = viscous_stress(elasticity, &material.prony, &wide, &dashpots);
        for (row, own) in stress.iter_mut().zip(narrow(own)) {
            *row += own;
        }
        energy += stored as f32;
    }
    (stress, energy)
}

/// Returns the first Piola–Kirchhoff stress [Pa] and the energy density [J/m³] of an elastic deformation with
/// a known rotation, as in [`Law::CorotationalVem`](crate::Law::CorotationalVem) without the resistance to
/// crushing.
fn elastic_stress<D: Dim>(
    elasticity: Elasticity,
    deformation: &Rows,
    rotation: &Rows,
) -> (Rows, f32) {
    let (shear, lame) = (elasticity.shear_modulus() as f32, elasticity.lame() as f32);
    let mut stress = [Vec3::ZERO; 3];
    let (mut spread, mut squared) = (-(D::N as f32), 0.0);
    for row in 0..D::N {
        let strain = deformation[row] - rotation[row];
        spread += rotation[row].dot(deformation[row]);
        squared += strain.length_squared();
        stress[row] = strain * (2.0 * shear);
    }
    for row in 0..D::N {
        stress[row] += rotation[row] * (lame * spread);
    }
    (D::N..3).for_each(|axis| stress[axis][axis] = lame * spread);
    (stress, shear * squared + 0.5 * lame * spread * spread)
}

fn product(a: &Rows, b: &Rows) -> Rows {
    a.map(|row| b[0] * row.x + b[1] * row.y + b[2] * row.z)
}

fn determinant(rows: &Rows) -> f32 {
    rows[0].dot(rows[1].cross(rows[2]))
}

/// Returns the greatest eigenvalue of the symmetric part of a matrix; in 2D, of its first two rows and columns.
fn greatest_eigenvalue<D: Dim>(matrix: &Rows) -> f32 {
    let [a, b, c] = [0, 1, 2].map(|k: usize| matrix[k][k]);
    let half = |i: usize, j: usize| 0.5 * (matrix[i][j] + matrix[j][i]);
    let (xy, yz, zx) = (half(0, 1), half(1, 2), half(2, 0));
    if D::N == 2 {
        let (mean, apart) = (0.5 * (a + b), 0.5 * (a - b));
        return mean + (apart * apart + xy * xy).sqrt();
    }
    // Newton's method on the characteristic polynomial of the deviator, t³ − p t − r. From above the greatest
    // root the steps descend to it.
    let mean = (a + b + c) / 3.0;
    let (a, b, c) = (a - mean, b - mean, c - mean);
    let squares = xy * xy + yz * yz + zx * zx;
    let p = 0.5 * (a * a + b * b + c * c) + squares;
    let r = a * (b * c - yz * yz) - xy * (xy * c - yz * zx) + zx * (xy * yz - b * zx);
    // |root| ≤ 2 √(p / 3).
    let mut root = 2.0 * (p / 3.0).sqrt();
    for _ in 0..20 {
        let slope = 3.0 * root * root - p;
        let step = (root * (root * root - p) - r) / slope.max(f32::MIN_POSITIVE);
        if step <= 1e-6 * root {
            break;
        }
        root -= step;
    }
    mean + root
}

/// Returns the length of a vector of the dimension.
fn distance<D: Dim>(offset: [f32; 3]) -> f32 {
    let squares = offset.into_iter().take(D::N).map(|k| k * k);
    squares.sum::<f32>().sqrt()
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::foundation::dim::{Dim2, Dim3, DimVector};
    use crate::fracture::blade::Blade;
    use crate::math::rotation::Rotation;
    use crate::topology::grid::VoxelGrid;
    use glam::Vec2;

    /// Dimension in which a crack can be cut.
    pub trait Cracked: Dim {
        /// Returns a blade from the first side of a cube 1 m wide to its middle.
        fn crack() -> Blade<Self>;
    }

    impl Cracked for Dim2 {
        fn crack() -> Blade<Self> {
            Blade::segment(Vec2::new(-0.1, 0.501), Vec2::new(0.49, 0.501))
        }
    }

    impl Cracked for Dim3 {
        fn crack() -> Blade<Self> {
            Blade::parallelogram(Vec3::new(-0.1, 0.501, -0.1), Vec3::X * 0.59, Vec3::Z * 1.2)
        }
    }

    /// Mode I and mode II stress intensities [Pa √m].
    pub type Intensities = [f32; 2];

    /// Displacement [m] near a crack tip in plane strain, from the offset to the tip [m] [Williams 1957]. The
    /// crack runs along the first axis, towards positive values.
    fn williams(material: &Material, [first, second]: Intensities, offset: Vec3) -> Vec3 {
        let shear = material.elasticity.shear_modulus() as f32;
        let kappa = 3.0 - 4.0 * material.elasticity.poisson as f32;
        let radius = libm::hypotf(offset.x, offset.y);
        let angle = 0.5 * libm::atan2f(offset.y, offset.x);
        let (sine, cosine) = libm::sincosf(angle);
        let open = Vec3::new(
            cosine * (kappa - 1.0 + 2.0 * sine * sine),
            sine * (kappa + 1.0 - 2.0 * cosine * cosine),
            0.0,
        );
        let slide = Vec3::new(
            sine * (kappa + 1.0 + 2.0 * cosine * cosine),
            -cosine * (kappa - 1.0 - 2.0 * sine * sine),
            0.0,
        );
        let scale = (radius / std::f32::consts::TAU).sqrt() / (2.0 * shear);
        (open * first + slide * second) * scale
    }

    /// Returns a body with a crack in the field of [`williams`], turned by `turn`, and a tip of the crack.
    pub fn cracked<D: Cracked>(
        material: &Material,
        intensities: Intensities,
        turn: Rotation,
    ) -> (SoftBody<D>, NodeId) {
        let (n, size) = (16, 1.0 / 16.0);
        let grid = VoxelGrid::<D>::cube(n, 1.0).unwrap();
        let mut body = SoftBody::new(grid, &[*material]).unwrap();
        body.cut(&D::crack());
        let depth = if D::N == 2 { 0 } else { 8 };
        let tip_at = [8, 8, depth];
        let mesh = body.mesh();
        let is_tip = |id: &NodeId| body.breakable_nodes().is_tip(*id);
        let tip = mesh
            .nodes_at(tip_at, body.connectivity())
            .find(is_tip)
            .unwrap();
        let nodes: Vec<NodeId> = mesh.nodes().map(|(id, _)| id).collect();
        for id in nodes {
            let at = Vec3::from(body.mesh().node(id).at.map(|k| k as f32 * size));
            let mut offset = at - Vec3::new(0.5, 0.5, depth as f32 * size);
            if offset.y == 0.0 && offset.x < 0.0 {
                // Nodes of the two crack faces, which the voxels of the node tell apart.
                let is_upper = body.mesh().node(id).group & 0b0011_0011 == 0;
                offset.y = if is_upper { 1e-7 } else { -1e-7 };
            }
            let moved = turn.apply(at + williams(material, intensities, offset));
            body.set_node_state(id, D::Vector::from_vec3(moved), D::Vector::ZERO)
                .unwrap();
        }
        body.apply_forces(1e-9, Vec3::ZERO);
        (body, tip)
    }

    /// Returns J at the tip of a crack divided by its exact value, and the error of its direction [degrees].
    fn check_release<D: Cracked>(intensities: Intensities) -> (f32, f32) {
        let (material, turn) = (Material::default(), Rotation::in_plane(0.7));
        let (body, tip) = cracked::<D>(&material, intensities, turn);
        let rotation = [Vec3::X, Vec3::Y, Vec3::Z].map(|axis| turn.inverse().apply(axis));
        let (release, _) = NearField::new(&body).energy_release(tip, &rotation);
        let [first, second] = intensities;
        let poisson = material.elasticity.poisson as f32;
        let stiffness = material.elasticity.young as f32 / (1.0 - poisson * poisson);
        let exact =
            Vec3::new(first * first + second * second, -2.0 * first * second, 0.0) / stiffness;
        let angle = libm::atan2f(release.y, release.x) - libm::atan2f(exact.y, exact.x);
        (release.length() / exact.length(), angle.to_degrees())
    }

    #[test]
    fn energy_release_matches_field_of_williams() {
        for intensities in [[5.0, 0.0], [5.0, 1.0], [5.0, -2.5]] {
            let (ratio, angle) = check_release::<Dim2>(intensities);
            assert!(
                (ratio - 1.0).abs() < 0.08 && angle.abs() < 3.0,
                "{ratio} {angle}"
            );
            let (ratio, angle) = check_release::<Dim3>(intensities);
            assert!(
                (ratio - 1.0).abs() < 0.15 && angle.abs() < 5.0,
                "{ratio} {angle}"
            );
        }
    }

    /// Returns a body that is stretched along its first axis, a node at its surface, and the uniform stress [Pa].
    pub fn stretched<D: Dim>(material: &Material) -> (SoftBody<D>, NodeId, f32) {
        let grid = VoxelGrid::<D>::cube(8, 1.0).unwrap();
        let mut body = SoftBody::new(grid, &[*material]).unwrap();
        let strain = 1e-3;
        let nodes: Vec<NodeId> = body.mesh().nodes().map(|(id, _)| id).collect();
        for id in nodes {
            let mut at = Vec3::from(body.mesh().node(id).at.map(|k| k as f32 / 8.0));
            at.x *= 1.0 + strain;
            body.set_node_state(id, D::Vector::from_vec3(at), D::Vector::ZERO)
                .unwrap();
        }
        body.apply_forces(1e-9, Vec3::ZERO);
        let at = [4, 8, if D::N == 2 { 0 } else { 4 }];
        let mesh = body.mesh();
        let node = mesh.nodes_at(at, body.connectivity()).next().unwrap();
        let elasticity = material.elasticity;
        // Uniaxial strain, because the sides do not contract.
        let stress = (elasticity.lame() + 2.0 * elasticity.shear_modulus()) as f32 * strain;
        (body, node, stress)
    }

    /// Returns the mean tensions around a node of a stretched body within one and two voxels, divided by the
    /// uniform stress.
    fn check_tension<D: Dim>() -> [f32; 2] {
        let (body, node, stress) = stretched::<D>(&Material::default());
        let mut near = NearField::new(&body);
        [1.0, 2.0].map(|radius| {
            let mean = near.mean_stress(node, radius).unwrap();
            equivalent_tension::<D>(&mean, None) / stress
        })
    }

    #[test]
    fn mean_tension_of_uniform_stress_is_that_stress() {
        for ratio in [check_tension::<Dim2>(), check_tension::<Dim3>()].concat() {
            assert!((ratio - 1.0).abs() < 5e-3, "{ratio}");
        }
    }

    #[test]
    fn greatest_eigenvalue_matches_known_matrices() {
        let rows = |rows: [[f32; 3]; 3]| rows.map(Vec3::from);
        let diagonal = rows([[1.0, 0.0, 0.0], [0.0, -4.0, 0.0], [0.0, 0.0, 3.0]]);
        assert!((greatest_eigenvalue::<Dim3>(&diagonal) - 3.0).abs() < 1e-5);
        assert!((greatest_eigenvalue::<Dim2>(&diagonal) - 1.0).abs() < 1e-5);
        let shear = rows([[0.0, 2.0, 0.0], [2.0, 0.0, 0.0], [0.0, 0.0, 0.0]]);
        assert!((greatest_eigenvalue::<Dim3>(&shear) - 2.0).abs() < 1e-5);
        assert!((greatest_eigenvalue::<Dim2>(&shear) - 2.0).abs() < 1e-5);
        let all = rows([[2.0, 1.0, 1.0], [1.0, 2.0, 1.0], [1.0, 1.0, 2.0]]);
        assert!((greatest_eigenvalue::<Dim3>(&all) - 4.0).abs() < 1e-5);
        let equal = rows([[2.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 2.0]]);
        assert_eq!(greatest_eigenvalue::<Dim3>(&equal), 2.0);
    }

    #[test]
    fn weight_along_a_line_is_its_integral() {
        let steps = 2000;
        for reach in [0.5f32, 1.5, 1.8, 2.0, 5.0] {
            let step = reach / steps as f32;
            let sum: f32 = (0..steps)
                .map(|k| {
                    let apart = (k as f32 + 0.5) * step;
                    let radius = outer_radius::<Dim3>();
                    ((radius - apart) / (radius - INNER_RADIUS)).clamp(0.0, 1.0) * step
                })
                .sum();
            assert!((weight_along::<Dim3>(reach) - sum).abs() < 1e-3, "{reach}");
        }
    }
}
