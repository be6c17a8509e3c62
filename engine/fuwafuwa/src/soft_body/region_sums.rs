//! Sums over the part of a body inside a region.

use super::SoftBody;
use crate::error::Error;
use crate::foundation::dim::{Dim, DimVector};
use crate::rigid_body::shape::Shape;
use glam::DVec3;

/// Sums over the part of a body inside a region; all 0 if nothing is inside.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub struct RegionSums<D: Dim> {
    /// Number of nodes inside.
    pub nodes: usize,
    /// Mass of these nodes [kg].
    pub mass: f64,
    /// Their centre of mass [m].
    pub centre: D::Vector,
    /// Their linear momentum [kg m/s].
    pub momentum: D::Vector,
    /// Sum of the elastic forces on these nodes in the last substep [N]: the force that the rest of the body
    /// exerts on this part. Also while the body sleeps.
    pub elastic_force: D::Vector,
    /// Elastic energy of the elements with their centre inside [J]; in 2D for 1 m of depth.
    pub elastic_energy: f64,
}

impl<D: Dim> SoftBody<D> {
    /// Returns sums over the part of the body inside `region` or on its surface.
    ///
    /// ```
    /// use fuwafuwa::{Dim2, Material, Shape, SoftBody, Vec2, VoxelGrid};
    ///
    /// let body = SoftBody::new(VoxelGrid::<Dim2>::cube(8, 1.0)?, &[Material::default()])?;
    /// let mass = body.total_mass();
    /// let left = Shape::half_space(Vec2::X, 0.5 * Vec2::X);
    /// let sums = body.with_velocity(2.0 * Vec2::Y).sums_inside(&left)?;
    /// assert!((f64::from(sums.momentum.y) - 2.0 * sums.mass).abs() < 1e-3);
    /// assert!(sums.mass > 0.5 * mass && sums.mass < 0.7 * mass);
    /// # Ok::<(), fuwafuwa::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] if the region is not [valid](Shape::check).
    #[inline(never)]
    pub fn sums_inside(&self, region: &Shape<D>) -> Result<RegionSums<D>, Error> {
        region.check().map_err(|error| error.of("region"))?;
        let mut sums = RegionSums::default();
        let (mut moment, mut momentum, mut force) = (DVec3::ZERO, DVec3::ZERO, DVec3::ZERO);
        for id in self.nodes_in(region) {
            let mass = f64::from(self.state.mass[id]);
            sums.nodes += 1;
            sums.mass += mass;
            moment += self.state.position[id].xyz().as_dvec3() * mass;
            momentum += self.state.velocity[id].xyz().as_dvec3() * mass;
            force += self.force_on(id).to_vec3().as_dvec3();
        }
        if sums.mass > 0.0 {
            moment /= sums.mass;
        }
        [sums.centre, sums.momentum, sums.elastic_force] =
            [moment, momentum, force].map(|sum| D::Vector::from_vec3(sum.as_vec3()));
        let solid = region.solid();
        for (id, element) in self.topology.mesh.elements() {
            let centre = self.deformation(element).0;
            if solid.distance(centre).0 <= 0.0 {
                let state = self.element_state(id);
                sums.elastic_energy += state.map_or(0.0, |state| state.energy);
            }
        }
        Ok(sums)
    }
}
