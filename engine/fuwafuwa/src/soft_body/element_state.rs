//! Measurements on a body: strain and stress of elements, damage of nodes, and the energy of pieces.

use crate::foundation::dim::{Dim, DimVector};
use crate::foundation::ids::{ElementId, NodeId};
use crate::material::Material;
use crate::soft_body::SoftBody;
use crate::soft_body::element_law::{
    ElasticLaw, IDENTITY, Law, MIN_VOLUME_RATIO, Matrix, cofactor, deformation_of, hourglass,
    hourglass_energy, hourglass_growth, rotation_of, shape_matching_offsets, volume_of,
};
use crate::soft_body::hyperelasticity;
use crate::soft_body::plasticity::{elastic_part, plastic_stiffness_factor, stress_after};
use crate::soft_body::viscosity::viscous_stress;
use crate::topology::element_class::ElementClass;
use glam::DVec3;

/// State of an element: deformation, strain, stress and stored energy.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub struct ElementState {
    /// Deformation gradient F by rows, elastic and plastic part together.
    pub deformation: Matrix,
    /// Elastic Biot strain along the axes of the undeformed body: the symmetric part of RᵀF minus the
    /// identity, where F is only the elastic part of the deformation gradient and R its rotation. 0.1 is a
    /// stretch by a tenth.
    pub strain: Matrix,
    /// Cauchy stress [Pa] along the axes of the world; 0 under [`Law::Endo2004`], which defines no stress.
    pub stress: Matrix,
    /// Elastic energy [J]; in 2D for 1 m of depth.
    pub energy: f64,
}

/// Returns the state of an elastic element that is `size` [m] wide and has its nodes at `positions` [m]. The
/// forces that [`crate::soft_body::element_law::forces`] returns are the negative gradient of the energy in
/// this state.
///
/// # Panics
/// If the number of positions is not the number of nodes of the element class.
#[inline(never)]
pub fn element_state<D: Dim>(
    law: Law,
    elastic: ElasticLaw,
    element_class: &ElementClass<D>,
    size: f64,
    positions: &[DVec3],
) -> ElementState {
    element_state_plastic(law, elastic, &IDENTITY, element_class, size, positions)
}

/// Returns the state of an element that is `size` [m] wide and has its nodes at `positions` [m].
/// `plastic_inverse` is the plastic inverse G of [`crate::soft_body::plasticity`].
///
/// # Panics
/// If the number of positions is not the number of nodes of the element class.
#[inline(never)]
pub fn element_state_plastic<D: Dim>(
    law: Law,
    elastic: ElasticLaw,
    plastic_inverse: &Matrix,
    element_class: &ElementClass<D>,
    size: f64,
    positions: &[DVec3],
) -> ElementState {
    assert_eq!(
        positions.len(),
        element_class.slots.len(),
        "the number of positions must match the nodes of the element class"
    );
    let elasticity = elastic.elasticity;
    let (whole, centre) = deformation_of(element_class, size, positions);
    let deformation = elastic_part(&whole, plastic_inverse);
    let rotation = rotation_of(&deformation);
    let column = |m: &Matrix, k: usize| DVec3::new(m[0][k], m[1][k], m[2][k]);
    let mut stretch = [DVec3::ZERO; 3];
    for i in 0..3 {
        for j in 0..3 {
            stretch[i][j] = column(&rotation, i).dot(column(&deformation, j));
        }
    }
    let mut strain = IDENTITY;
    for i in 0..3 {
        for j in 0..3 {
            strain[i][j] = 0.5 * (stretch[i][j] + stretch[j][i]) - IDENTITY[i][j];
        }
    }
    if law == Law::Endo2004 {
        let (stiffness, apart) = shape_matching_offsets(elasticity, element_class, size, positions);
        let energy = apart.iter().map(|&d| 0.5 * stiffness * d.dot(d)).sum();
        return ElementState {
            deformation: whole,
            strain,
            energy,
            ..ElementState::default()
        };
    }
    let squash = deformation[0].dot(cofactor(&deformation)[0]);
    let nominal = stress_after::<D>(elastic, &whole, plastic_inverse);
    let mut cauchy = [DVec3::ZERO; 3];
    for i in 0..3 {
        for j in 0..3 {
            cauchy[i][j] = nominal[i].dot(whole[j]) / squash;
        }
    }
    let squared: f64 = strain.iter().map(|&row| row.dot(row)).sum();
    let spread = strain[0][0] + strain[1][1] + strain[2][2];
    let below = (MIN_VOLUME_RATIO - squash).max(0.0);
    let density = match elastic.stress_law.factors() {
        Some(factors) => hyperelasticity::energy(elasticity, factors, &deformation),
        None => {
            elasticity.shear_modulus() * squared
                + 0.5 * elasticity.lame() * spread * spread
                + 0.5 * elasticity.young * below * below
        }
    };
    let half = 0.5 * size;
    let (stiffness, hourglass) =
        hourglass(elasticity, element_class, size, positions, &whole, centre);
    let [growth, _] = hourglass_growth(elastic, element_class, &whole);
    let density = plastic_stiffness_factor::<D>(plastic_inverse) * density;
    let energy = density * volume_of(element_class, half)
        + growth * hourglass_energy(element_class, stiffness, &hourglass);
    ElementState {
        deformation: whole,
        strain,
        stress: cauchy,
        energy,
    }
}

/// Adds the stress and the energy of the Prony series to the state of an element with the volume `volume` [m³].
fn add_viscous_part<D: Dim>(
    state: &mut ElementState,
    material: &Material,
    plastic_inverse: &Matrix,
    dashpots: &[[f32; 6]; 2],
    volume: f64,
) {
    let whole = state.deformation;
    let elastic = elastic_part(&whole, plastic_inverse);
    let dashpots = dashpots.map(|term| term.map(f64::from));
    let (own, energy) = viscous_stress(material.elasticity, &material.prony, &elastic, &dashpots);
    let soft = plastic_stiffness_factor::<D>(plastic_inverse);
    state.energy += soft * energy * volume;
    let squash = whole[0].dot(cofactor(&whole)[0]);
    for i in 0..3 {
        for j in 0..3 {
            // Row j of F G = Fₑ, so that P Fᵀ = s Pₑ Gᵀ Fᵀ = s Pₑ Fₑᵀ.
            state.stress[i][j] += soft * own[i].dot(elastic[j]) / squash;
        }
    }
}

/// Energy of a piece [J]; in 2D for 1 m of depth. Energy lost to damping, friction and cracks is not
/// included.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub struct Energy {
    /// Kinetic energy [J].
    pub kinetic: f64,
    /// Elastic energy [J].
    pub elastic: f64,
    /// Potential energy [J] in the gravity passed to [`SoftBody::energies`]; 0 for mass at the origin.
    pub gravitational: f64,
}

impl Energy {
    /// Sum of kinetic, elastic and gravitational energy [J].
    pub fn total(self) -> f64 {
        self.kinetic + self.elastic + self.gravitational
    }
}

impl<D: Dim> SoftBody<D> {
    /// Returns the strain, stress and energy of an element, or `None` if the element was removed. Computed in
    /// double precision from the positions of the nodes. Young's modulus is multiplied by
    /// [`SoftBody::stiffness_scale`].
    #[inline(never)]
    pub fn element_state(&self, id: ElementId) -> Option<ElementState> {
        let element = self.topology.mesh.element(id)?;
        let at = |&node: &NodeId| self.state.position[node].xyz().as_dvec3();
        let positions: Vec<DVec3> = element.nodes.iter().map(at).collect();
        let mut material = *self.material(element);
        material.elasticity.young *= self.topology.stiffness_scale;
        let size = f64::from(self.topology.grid.voxel_size()) * f64::from(element.cell.width());
        let element_class = self.topology.mesh.element_class(element);
        let law = self.state.batches.law();
        let plastic_inverse = self.plastic_inverse(id);
        let mut state = element_state_plastic(
            law,
            ElasticLaw::from(&material),
            &plastic_inverse,
            element_class,
            size,
            &positions,
        );
        if law == Law::CorotationalVem && material.is_viscous() {
            let dashpots = self.state.batches.internal_state(id)?.dashpots;
            let volume = volume_of(element_class, 0.5 * size);
            add_viscous_part::<D>(&mut state, &material, &plastic_inverse, &dashpots, volume);
        }
        Some(state)
    }

    /// Plastic inverse G of an element, by rows; the identity if the material is elastic.
    fn plastic_inverse(&self, id: ElementId) -> Matrix {
        let plastic_inverse = self.state.batches.plastic_inverse(id);
        plastic_inverse.map_or(IDENTITY, |plastic_inverse| {
            plastic_inverse.map(|row| row.as_dvec3())
        })
    }

    /// Returns the plastic strain of an element, or `None` if the element was removed. The plastic strain is
    /// 0 without permanent deformation. A strain of 0.5 means that the most compressed axis has shrunk
    /// permanently to 1/1.5 of its length. Plastic flow preserves volume, so in 2D the other axis is then
    /// stretched to 1.5 times its length.
    pub fn plastic_strain(&self, id: ElementId) -> Option<f32> {
        self.topology.mesh.element(id)?;
        let most = 1.0 / plastic_stiffness_factor::<D>(&self.plastic_inverse(id));
        Some((most.sqrt() - 1.0).max(0.0) as f32)
    }

    /// Damage of a node: 0 = intact. The node is split as soon as its damage reaches 1, unless a split nearby makes it
    /// wait. The damage grows in fracture rounds, usually 240 per second, by up to 6.25 in each. It is therefore above 1,
    /// seldom above 20, at nodes that wait. A damage of 1 or more is constant during the cooldown after the split.
    /// Otherwise the damage falls by 1 in 16 ms while the node is not overloaded.
    ///
    /// # Panics
    /// If the id was never used.
    pub fn damage(&self, node: NodeId) -> f32 {
        self.state.damage[node]
    }

    /// Returns the energy of each piece, by number. Gravity is `gravity` [m/s²] times the gravity scale of
    /// the body. 0 for removed pieces.
    ///
    /// ```
    /// use fuwafuwa::{Dim2, Material, SoftBody, Vec2, VoxelGrid};
    ///
    /// let body = SoftBody::new(VoxelGrid::<Dim2>::ball(8, 1.0)?, &[Material::default()])?;
    /// let mass = body.total_mass();
    /// let energy = body.with_velocity(2.0 * Vec2::X).energies(-9.81 * Vec2::Y)[0];
    /// assert!((energy.kinetic - 2.0 * mass).abs() < 1e-3 && energy.elastic < 1e-6);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[inline(never)]
    pub fn energies(&self, gravity: D::Vector) -> Vec<Energy> {
        let Self {
            topology, state, ..
        } = self;
        let mut energies = vec![Energy::default(); topology.pieces.list.len()];
        let pull = f64::from(state.gravity_scale);
        for (id, _) in topology.mesh.nodes() {
            let (at, velocity, mass) = self.node_state(id);
            let [at, velocity, gravity] =
                [at, velocity, gravity].map(|vector| vector.to_vec3().as_dvec3());
            let mass = f64::from(mass);
            let energy = &mut energies[topology.pieces.of_node(id).index()];
            energy.kinetic += 0.5 * mass * velocity.dot(velocity);
            energy.gravitational -= mass * pull * gravity.dot(at);
        }
        for (id, _) in topology.mesh.elements() {
            let strained = self
                .element_state(id)
                .expect("`elements` returns live elements");
            energies[topology.pieces.of_element(id).index()].elastic += strained.energy;
        }
        energies
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::foundation::dim::{Dim2, Dim3};
    use crate::math::rotation::Rotation;
    use crate::soft_body::element_law::forces;
    use crate::soft_body::hyperelasticity::StressLaw;
    use crate::soft_body::rayleigh::Damping;
    use crate::topology::grid::VoxelGrid;
    use glam::{Vec2, Vec3};

    /// Returns a ball, shrunk by the fraction `amount`, or grown if `amount` is negative, with nodes displaced by a
    /// bending field in proportion to `amount`.
    fn crooked<D: Dim>(amount: f32) -> SoftBody<D> {
        let grid = VoxelGrid::<D>::ball(12, 1.0).unwrap();
        let mut body = SoftBody::new(grid, &[Material::default()]).unwrap();
        let nodes: Vec<NodeId> = body.mesh().nodes().map(|(id, _)| id).collect();
        for id in nodes {
            let (at, velocity, _) = body.node_state(id);
            let [x, y, z] = at.to_vec3().to_array();
            let sway = Vec3::new(4.0 * y * y - y, 3.0 * z * x + y, 5.0 * x * y - 2.0 * z);
            let at = at * (1.0 - amount) + D::Vector::from_vec3(sway) * (amount * 0.1);
            body.set_node_state(id, at, velocity).unwrap();
        }
        body
    }

    fn check_slope<D: Dim>(law: Law, stress_law: StressLaw, amount: f32) {
        let body = crooked::<D>(amount);
        let elasticity = Material::default().elasticity;
        let elastic = ElasticLaw {
            elasticity,
            stress_law,
        };
        let size = f64::from(body.grid().voxel_size());
        for (_, element) in body.mesh().elements().step_by(7) {
            let element_class = body.mesh().element_class(element);
            let size = size * f64::from(element.cell.width());
            let at = |&node: &NodeId| body.node_state(node).0.to_vec3().as_dvec3();
            let positions: Vec<DVec3> = element.nodes.iter().map(at).collect();
            let energy = |positions: &[DVec3]| {
                element_state(law, elastic, element_class, size, positions).energy
            };
            let forces = forces(law, elastic, element_class, size, &positions);
            let most = forces
                .iter()
                .flat_map(|force| force.to_array())
                .fold(0.0f64, |most, k| most.max(k.abs()));
            for node in 0..positions.len() {
                for axis in 0..D::N {
                    let step = 1e-5 * size;
                    let moved = |by: f64| {
                        let mut moved = positions.clone();
                        moved[node][axis] += by;
                        energy(&moved)
                    };
                    let slope = (moved(step) - moved(-step)) / (2.0 * step);
                    let force = forces[node][axis];
                    assert!(
                        (slope + force).abs() < 1e-4 * most,
                        "{law:?}: {slope} {force}"
                    );
                }
            }
        }
    }

    #[test]
    fn forces_match_energy_gradient() {
        let yeoh = StressLaw::Yeoh {
            second: 0.1,
            third: 0.01,
        };
        for (law, stress_law) in [
            (Law::CorotationalVem, StressLaw::Corotational),
            (Law::Endo2004, StressLaw::Corotational),
            (Law::CorotationalVem, StressLaw::NeoHookean),
            (Law::CorotationalVem, yeoh),
        ] {
            for amount in [0.1, -0.1] {
                check_slope::<Dim2>(law, stress_law, amount);
                check_slope::<Dim3>(law, stress_law, amount);
            }
        }
    }

    /// Checks the state of the elements of a body that is stretched by a twentieth along the first axis, then
    /// rotated by one radian.
    fn check_stretch<D: Dim>() {
        let grid = VoxelGrid::<D>::cube(8, 1.0).unwrap();
        let mut body = SoftBody::new(grid, &[Material::default()]).unwrap();
        let nodes: Vec<NodeId> = body.mesh().nodes().map(|(id, _)| id).collect();
        for id in nodes {
            let (mut at, ..) = body.node_state(id);
            at[0] *= 1.05;
            body.set_node_state(id, at, D::Vector::ZERO).unwrap();
        }
        let body = body.rotated_about(Rotation::in_plane(1.0), D::Vector::ZERO);
        let elasticity = Material::default().elasticity;
        let along = (2.0 * elasticity.shear_modulus() + elasticity.lame()) * 0.05;
        let size = f64::from(body.grid().voxel_size());
        let voxel = (0..D::N).fold(1.0, |volume, _| volume * size);
        let volume = voxel * body.grid().solid_count() as f64;
        let energy = body.energies(D::Vector::ZERO)[0].elastic;
        assert!(
            (energy / (0.5 * along * 0.05 * volume) - 1.0).abs() < 1e-3,
            "{energy}"
        );
        for (id, _) in body.mesh().elements() {
            let ElementState { strain, stress, .. } = body.element_state(id).unwrap();
            assert!((strain[0][0] - 0.05).abs() < 1e-4 && strain[1][1].abs() < 1e-4);
            // Direction of the stretched axis after its rotation by one radian. The other axes keep their
            // length, so areas perpendicular to it are unchanged.
            let direction = DVec3::new(libm::cos(1.0), libm::sin(1.0), 0.0);
            let pulled = DVec3::from(stress.map(|row| row.dot(direction)));
            assert!(
                (pulled.dot(direction) / along - 1.0).abs() < 1e-3,
                "{stress:?}"
            );
        }
    }

    #[test]
    fn element_state_measures_uniform_stretch() {
        check_stretch::<Dim2>();
        check_stretch::<Dim3>();
    }

    #[test]
    fn energy_is_conserved_without_damping() {
        let calm = Material {
            damping: Damping::NONE,
            strength: f32::INFINITY,
            ..Material::default()
        };
        let grid = VoxelGrid::<Dim2>::ball(12, 1.0).unwrap();
        let mut body = SoftBody::new(grid, &[calm])
            .unwrap()
            .with_velocity(Vec2::new(1.0, 2.0));
        let gravity = Vec2::new(0.0, -9.81);
        let before = body.energies(gravity)[0];
        let duration = 1.0 / 960.0;
        (0..480).for_each(|_| body.advance(duration, gravity));
        let after = body.energies(gravity)[0];
        assert!((after.kinetic - before.kinetic).abs() > 1.0);
        assert!(
            (after.total() / before.total() - 1.0).abs() < 0.01,
            "{before:?} {after:?}"
        );
    }
}
