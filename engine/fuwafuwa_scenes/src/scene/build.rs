//! Construction of a body from its table in a scene.

use super::body::BodyText;
use super::budget::Budget;
use super::error::{FieldError, require, require_vector};
use super::grid;
use super::state;
use fuwafuwa::Grading;
use fuwafuwa::Law;
use fuwafuwa::{Blade, Dim, Error, Material, Rotation, SoftBody, VoxelGrid, World};

impl BodyText {
    /// Builds the body, if the budget suffices for its work.
    pub(super) fn build<D: Dim>(
        &self,
        materials: &[Material],
        budget: &mut Budget,
    ) -> Result<SoftBody<D>, FieldError> {
        require_vector(D::N, "at", self.at)?;
        require_vector(D::N, "velocity", self.velocity)?;
        if let Some(state) = &self.state {
            let good = self.without_state() == Self::default();
            require(
                good,
                "state",
                "expected no other field: state is the whole body",
            )?;
            let body = state::body::<D>(state)?;
            budget.take_voxels(body.grid().voxels().count())?;
            return Ok(body);
        }
        let grid = grid::of::<D>(self, budget)?;
        self.check_diced(&grid, budget)?;
        let law = match self.paper_law {
            true => Law::Endo2004,
            false => Law::CorotationalVem,
        };
        let grading = match self.uniform {
            true => Grading::Uniform,
            false => Grading::Graded,
        };
        let body = SoftBody::with_options(grid, materials, law, grading);
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
            for blade in grid_of_blades(&body, spacing) {
                body.cut(&blade);
            }
        }
        if let Some(turned) = self.turned {
            body = body.rotated_about(rotation_of::<D>(turned)?, [0.0; 3]);
        }
        Ok(body.translated(self.at).with_velocity(self.velocity))
    }

    /// Adds the body to a world.
    pub(super) fn add_to<D: Dim>(
        &self,
        world: &mut World<D>,
        materials: &[Material],
        budget: &mut Budget,
    ) -> Result<(), FieldError> {
        let body = world.add_soft_body(self.build(materials, budget)?);
        let wrong = |field: &'static str| move |error: Error| FieldError::engine(field, error);
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
        // Each cutting plane is tested against every voxel.
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
pub(super) fn rotation_of<D: Dim>(turned: [f32; 3]) -> Result<Rotation, FieldError> {
    let good = turned.iter().all(|k| k.is_finite());
    let found = format!("expected axis times angle [rad], found {turned:?}");
    require(good, "turned", found)?;
    let flat = D::N == 3 || turned[..2] == [0.0; 2];
    let expected = "expected 0 except on the third axis in a world with dim = 2";
    require(flat, "turned", expected)?;
    let squared = turned.iter().map(|&k| f64::from(k) * f64::from(k));
    let angle = squared.sum::<f64>().sqrt() as f32;
    Ok(match angle > 0.0 {
        true => Rotation::about(turned, angle),
        false => Rotation::NONE,
    })
}

/// Returns cutting planes through the whole body, `spacing` [m] apart on every axis.
fn grid_of_blades<D: Dim>(body: &SoftBody<D>, spacing: f32) -> Vec<Blade> {
    let size = body
        .grid()
        .size()
        .map(|k| k as f32 * body.grid().voxel_size());
    let long = size.map(|k| 1.2 * k + 1.0);
    let mut blades = Vec::new();
    for axis in 0..D::N {
        let (first, second) = ((axis + 1) % 3, (axis + 2) % 3);
        let mut place = spacing;
        while place < size[axis] {
            let mut blade = Blade {
                from: [0.0; 3],
                across: [0.0; 3],
                along: [0.0; 3],
            };
            blade.from[axis] = place;
            blade.from[first] = -0.5;
            blade.from[second] = -0.5;
            blade.across[first] = long[first];
            blade.along[second] = long[second];
            blades.push(blade);
            place += spacing;
        }
    }
    blades
}
