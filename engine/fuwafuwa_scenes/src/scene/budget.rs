//! Limits on the total work for all bodies of a scene, which may come from an untrusted author.

use super::MAX_VOXELS;
use super::error::{FieldError, require};

/// Maximum number of voxels, solid or empty, per allowed solid voxel. An empty voxel takes memory, but no time of
/// the simulation.
const VOXELS_PER_SOLID: usize = 8;

/// Remaining work for the bodies still to be built. Each step of the construction takes its work from the
/// budget before it begins.
pub(super) struct Budget {
    most_solid: usize,
    /// Solid voxels in the grids built so far.
    solid: usize,
    /// Voxels, solid or empty, in the grids built so far.
    voxels: usize,
    /// Remaining distance evaluations: one for each part and voxel of a body.
    pub(super) distances: usize,
    /// Remaining plane tests: one for each cutting plane and voxel of a diced body.
    pub(super) plane_tests: usize,
    /// Remaining colour comparisons: one for each pixel of a picture, and one for each pixel and named colour.
    pub(super) colour_comparisons: usize,
    /// Remaining steps of decoding models.
    model_steps: usize,
}

impl Budget {
    /// Creates the budget of a scene with at most `most_solid` solid voxels.
    pub(super) fn of_scene(most_solid: usize) -> Self {
        Self {
            most_solid,
            solid: 0,
            voxels: 0,
            distances: 1 << 27,
            plane_tests: 1 << 26,
            // Budget for four pictures of 4096 × 4096 pixels with 16 named colours each.
            colour_comparisons: 1 << 30,
            // Budget for 16 models of the maximum size.
            model_steps: 1 << 29,
        }
    }

    /// Takes the work of decoding a model.
    pub(super) fn take_model(&mut self, steps: usize) -> Result<(), FieldError> {
        let expected =
            "expected fewer or smaller models in the scene: decoding them takes too long";
        require(steps <= self.model_steps, "file", expected)?;
        self.model_steps -= steps;
        Ok(())
    }

    /// Checks that the solid voxels of a model are within the limit of the scene.
    pub(super) fn check_model(&self, solid: usize) -> Result<(), FieldError> {
        let share = self.most_solid.saturating_sub(self.solid) as f64 / solid as f64;
        let advice = match (100.0 * share.cbrt()) as usize {
            0 => "remove another body".into(),
            percent => format!(
                "make the model smaller, to {percent} % of its width, or use a part of it with model = \"name\""
            ),
        };
        let more = format!(", of which {solid} in this model; {advice}");
        self.check_solid(solid, "file", &more)
    }

    /// Checks that `solid` more solid voxels are within the limit of the scene. `more` is appended to
    /// the error, which names `field`.
    fn check_solid(&self, solid: usize, field: &str, more: &str) -> Result<(), FieldError> {
        let (most, found) = (self.most_solid, self.solid.saturating_add(solid));
        let expected = format!(
            "expected {most} solid voxels at most in all bodies together, found {found}{more}"
        );
        require(found <= most, field, expected)
    }

    /// Counts the voxels of one more grid. Returns an error if the scene would then have too many.
    pub(super) fn take_voxels(&mut self, count: usize, solid: usize) -> Result<(), FieldError> {
        self.check_voxels(count)?;
        self.check_solid(solid, "n", "")?;
        self.voxels += count;
        self.solid += solid;
        Ok(())
    }

    /// Checks that `count` more voxels, solid or empty, are within the limit of the scene.
    pub(super) fn check_voxels(&self, count: usize) -> Result<(), FieldError> {
        let most = MAX_VOXELS.min(VOXELS_PER_SOLID.saturating_mul(self.most_solid));
        let found = self.voxels.saturating_add(count);
        let expected = format!(
            "expected {most} voxels at most, solid or empty, in the grids of all bodies together, found {found}"
        );
        require(found <= most, "n", expected)
    }

    /// Subtracts one distance evaluation for each part and voxel from the budget.
    pub(super) fn take_distances(&mut self, parts: usize, voxels: usize) -> Result<(), FieldError> {
        let most = self.distances / voxels.max(1);
        let expected =
            format!("expected {most} at most in a body of {voxels} voxels, found {parts}");
        require(parts <= most, "part", expected)?;
        self.distances -= parts * voxels;
        Ok(())
    }

    /// Takes the work of decoding a picture, before its pixels are allocated.
    pub(super) fn take_picture(&mut self, pixels: usize) -> Result<(), FieldError> {
        let expected =
            "expected fewer or smaller pictures in the scene: decoding them takes too long";
        require(pixels <= self.colour_comparisons, "file", expected)?;
        self.colour_comparisons -= pixels;
        Ok(())
    }

    /// Subtracts one colour comparison for each pixel and colour from the budget.
    pub(super) fn take_pixels(&mut self, pixels: usize, colours: usize) -> Result<(), FieldError> {
        let (most, colours) = (self.colour_comparisons / pixels.max(1), colours.max(1));
        let expected = format!("expected {most} at most for {pixels} pixels, found {colours}");
        require(colours <= most, "colours", expected)?;
        self.colour_comparisons -= pixels * colours;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Regression: the limits applied to each body separately, so a scene of a thousand bodies could require
    /// a thousand times the allowed work.
    #[test]
    fn budget_limits_sum_over_all_bodies() {
        let mut budget = Budget::of_scene(1000);
        budget.take_voxels(7000, 600).unwrap();
        assert!(budget.take_voxels(401, 401).is_err() && budget.take_voxels(1001, 400).is_err());
        budget.take_voxels(1000, 400).unwrap();
        budget.take_distances(400, 1 << 18).unwrap();
        assert!(budget.take_distances(113, 1 << 18).is_err());
        assert!(budget.take_distances(112, 1 << 18).is_ok());
        for _ in 0..4 {
            budget.take_pixels(1 << 24, 16).unwrap();
        }
        assert!(budget.take_pixels(1 << 24, 0).is_err());
        assert!(budget.take_distances(0, usize::MAX).is_ok());
        assert!(budget.take_voxels(usize::MAX, usize::MAX).is_err());
    }

    #[test]
    fn model_that_other_bodies_leave_no_room_for_asks_to_remove_one() {
        let mut budget = Budget::of_scene(1000);
        budget.take_voxels(1000, 1000).unwrap();
        let error = format!("{:?}", budget.check_model(24).unwrap_err());
        assert!(
            error.contains("found 1024, of which 24 in this model; remove another body"),
            "{error}"
        );
    }
}
