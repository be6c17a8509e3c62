//! A body, from what a scene says about it.

use super::body::BodyText;
use super::budget::Budget;
use super::error::{Wrong, require, require_vector};
use super::grid;
use fuwafuwa::law::Law;
use fuwafuwa::pyramid::Grading;
use fuwafuwa::{Blade, Body, BodyError, Dim, Material, VoxelGrid};

impl BodyText {
    /// The body, where it and those before it take no more work than the budget has.
    pub(super) fn build<D: Dim>(
        &self,
        materials: &[Material],
        budget: &mut Budget,
    ) -> Result<Body<D>, Wrong> {
        require_vector(D::N, "at", self.at)?;
        require_vector(D::N, "velocity", self.velocity)?;
        let grid = grid::of::<D>(self, budget)?;
        self.check_diced(&grid, budget)?;
        let law = match self.paper_law {
            true => Law::Endo2004,
            false => Law::PatchExact,
        };
        let grading = match self.uniform {
            true => Grading::Uniform,
            false => Grading::Graded,
        };
        let broken = |reason: String| Wrong::new("shape", reason);
        let body = Body::with(grid, materials, law, grading);
        let mut body = body.map_err(|error| match error {
            BodyError::MissingMaterial { number } => {
                let count = materials.len();
                let reason = format!("voxels are of material {number}, the scene has 1 to {count}");
                Wrong::new("material", reason)
            }
            error => broken(error.to_string()),
        })?;
        if self.crumbled {
            body.crumble().map_err(|error| broken(error.to_string()))?;
        }
        if let Some(spacing) = self.diced {
            for blade in grid_of_blades(&body, spacing) {
                let cut = body.cut(&blade);
                cut.map_err(|error| broken(error.to_string()))?;
            }
        }
        Ok(body.moved(self.at).thrown(self.velocity))
    }

    fn check_diced<D: Dim>(&self, grid: &VoxelGrid<D>, budget: &mut Budget) -> Result<(), Wrong> {
        let Some(spacing) = self.diced else {
            return Ok(());
        };
        let voxel_size = grid.voxel_size();
        let expected = format!("expected a voxel, {voxel_size} m, or more, found {spacing}");
        require(spacing >= voxel_size, "diced", expected)?;
        // Each blade looks at every voxel.
        let blades = |&extent: &i32| (extent as f32 * voxel_size / spacing) as usize;
        let blades: usize = grid.size()[..D::N].iter().map(blades).sum();
        let voxels = grid.voxels().count();
        let expected = format!("{blades} blades through {voxels} voxels are too many");
        let crossings = blades.saturating_mul(voxels);
        require(crossings <= budget.crossings, "diced", expected)?;
        budget.crossings -= crossings;
        Ok(())
    }
}

/// Planes a distance apart on every axis, through the whole body.
fn grid_of_blades<D: Dim>(body: &Body<D>, spacing: f32) -> Vec<Blade> {
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
