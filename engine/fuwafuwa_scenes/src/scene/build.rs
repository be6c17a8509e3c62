//! Construction of a body from its table in a scene.

use super::body::BodyText;
use super::budget::Budget;
use super::error::{FieldError, require, vector_of};
use super::grid;
use super::materials::SceneMaterials;
use super::state;
use fuwafuwa::Grading;
use fuwafuwa::Law;
use fuwafuwa::{
    Blade, Dim, Dim2, Dim3, DimVector, Error, Rotation, SoftBody, Vec2, Vec3, Velocity, VoxelGrid,
    World,
};
use std::any::Any;

impl BodyText {
    /// Builds the body, if the budget suffices for its work.
    pub(super) fn build<D: Dim>(
        &self,
        materials: &SceneMaterials,
        budget: &mut Budget,
    ) -> Result<SoftBody<D>, FieldError> {
        let at = vector_of::<D>("at", self.at)?;
        let velocity = vector_of::<D>("velocity", self.velocity)?;
        if let Some(state) = &self.state {
            let good = self.without_state() == Self::default();
            require(
                good,
                "state",
                "expected no other field: state is the whole body",
            )?;
            let body = state::body::<D>(state)?;
            let grid = body.grid();
            budget.take_voxels(grid.voxels().count(), grid.solid_count())?;
            return Ok(body);
        }
        let grid = materials.without_tints(grid::of::<D>(self, budget)?);
        self.check_diced(&grid, budget)?;
        let law = match self.paper_law {
            true => Law::Endo2004,
            false => Law::CorotationalVem,
        };
        let grading = match self.uniform {
            true => Grading::Uniform,
            false => Grading::Graded,
        };
        let body = SoftBody::with_options(grid, &materials.list, law, grading);
        let mut body = body.map_err(|error| match error {
            Error::MissingMaterial { number, given } => {
                let reason = format!(
                    "voxels have material {number}, but the scene has materials 1 to {given}"
                );
                FieldError::new("material", reason)
            }
            error => FieldError::engine("shape", error),
        })?;
        if self.crumbled {
            body.crumble();
        }
        if let Some(spacing) = self.diced {
            dice(&mut body, spacing);
        }
        if let Some(vector) = self.rotation_vector {
            body = body.rotated_about(rotation_of::<D>(vector)?, D::Vector::ZERO);
        }
        let velocity = Velocity::linear(velocity);
        Ok(body.translated(at).with_velocity(velocity))
    }

    /// Adds the body to a world.
    pub(super) fn add_to<D: Dim>(
        &self,
        world: &mut World<D>,
        materials: &SceneMaterials,
        budget: &mut Budget,
    ) -> Result<(), FieldError> {
        let wrong = |field: &'static str| move |error: Error| FieldError::engine(field, error);
        let body = world.add_soft_body(self.build(materials, budget)?);
        let body = body.map_err(wrong("at"))?;
        if let Some(scale) = self.gravity_scale {
            let set = world.set_gravity_scale(body, scale);
            set.map_err(wrong("gravity_scale"))?;
        }
        if let Some(layers) = self.layers {
            let set = world.set_layers(body, layers.into());
            set.map_err(wrong("layers"))?;
        }
        if let Some(data) = self.user_data {
            let set = world.set_user_data(body, data);
            set.map_err(wrong("user_data"))?;
        }
        Ok(())
    }

    fn without_state(&self) -> Self {
        Self {
            state: None,
            ..self.clone()
        }
    }

    fn check_diced<D: Dim>(
        &self,
        grid: &VoxelGrid<D>,
        budget: &mut Budget,
    ) -> Result<(), FieldError> {
        let Some(spacing) = self.diced else {
            return Ok(());
        };
        let voxel_size = grid.voxel_size();
        let expected = format!("expected a voxel, {voxel_size} m, or more, found {spacing}");
        require(spacing >= voxel_size, "diced", expected)?;
        // Number of cutting planes on an axis. The budget counts one plane test for each plane and voxel.
        let blades = |&extent: &i32| (extent as f32 * voxel_size / spacing) as usize;
        let blades: usize = grid.size()[..D::N].iter().map(blades).sum();
        let voxels = grid.voxels().count();
        let expected = format!("{blades} blades through {voxels} voxels are too many");
        let crossings = blades.saturating_mul(voxels);
        require(crossings <= budget.plane_tests, "diced", expected)?;
        budget.plane_tests -= crossings;
        Ok(())
    }
}

/// Converts axis times angle [rad] to a rotation.
pub(super) fn rotation_of<D: Dim>(vector: [f32; 3]) -> Result<Rotation, FieldError> {
    let good = vector.iter().all(|k| k.is_finite());
    let found = format!("expected axis times angle [rad], found {vector:?}");
    require(good, "rotation_vector", found)?;
    require_turning::<D>("rotation_vector", vector)?;
    let squared = vector.iter().map(|&k| f64::from(k) * f64::from(k));
    let angle = squared.sum::<f64>().sqrt() as f32;
    Ok(match angle > 0.0 {
        true => Rotation::about(Vec3::from(vector), angle),
        false => Rotation::NONE,
    })
}

/// Returns an error in 2D if a rotation or angular velocity is not about the third axis.
pub(super) fn require_turning<D: Dim>(field: &str, vector: [f32; 3]) -> Result<(), FieldError> {
    let flat = D::N == 3 || vector[..2] == [0.0; 2];
    let expected = "expected 0 except on the third axis in a world with dim = 2";
    require(flat, field, expected)
}

/// Cuts the whole body along planes `spacing` [m] apart on every axis.
fn dice<D: Dim>(body: &mut SoftBody<D>, spacing: f32) {
    let size = body
        .grid()
        .size()
        .map(|k| k as f32 * body.grid().voxel_size());
    let low = Vec3::splat(-0.5);
    let long = Vec3::from(size) * 1.2 + 1.0;
    // A blade belongs to one dimension, so the body is cast to the type of that dimension.
    let body: &mut dyn Any = body;
    for axis in 0..D::N {
        let (first, second) = ((axis + 1) % 3, (axis + 2) % 3);
        let mut place = spacing;
        while place < size[axis] {
            let mut corner = low;
            corner[axis] = place;
            let side = |along: usize| {
                let mut side = Vec3::ZERO;
                side[along] = long[along];
                side
            };
            if let Some(body) = body.downcast_mut::<SoftBody<Dim3>>() {
                body.cut(&Blade::parallelogram(corner, side(first), side(second)));
            } else if let Some(body) = body.downcast_mut::<SoftBody<Dim2>>() {
                let (from, to) = (corner, corner + side(1 - axis));
                let ends = [from, to].map(Vec2::from_vec3);
                // The normal of the cut points along the axis, as in 3D.
                match axis {
                    0 => body.cut(&Blade::segment(ends[0], ends[1])),
                    _ => body.cut(&Blade::segment(ends[1], ends[0])),
                };
            }
            place += spacing;
        }
    }
}
