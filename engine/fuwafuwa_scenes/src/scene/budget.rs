//! How much work the bodies of a scene may take, all together: who wrote it may be a stranger.

use super::error::{Wrong, require};

/// What is left for the bodies that are still to be built. Each part is asked before the work is begun.
pub(super) struct Budget {
    most_voxels: usize,
    /// In the grids of the bodies so far, solid or not.
    voxels: usize,
    /// One for each part of a body and voxel.
    pub(super) distances: usize,
    /// One for each blade through a diced body and voxel.
    pub(super) crossings: usize,
    /// Pixels of pictures, each as often as colours are named for it.
    pub(super) judgements: usize,
}

impl Budget {
    /// A budget for a scene with at most so many voxels.
    pub(super) fn of_scene(most_voxels: usize) -> Self {
        Self {
            most_voxels,
            voxels: 0,
            distances: 1 << 27,
            crossings: 1 << 26,
            // Four of the largest pictures with 16 colours each.
            judgements: 1 << 30,
        }
    }

    /// Takes so many voxels.
    pub(super) fn take_voxels(&mut self, count: usize) -> Result<(), Wrong> {
        self.check_voxels(count)?;
        self.voxels += count;
        Ok(())
    }

    /// Whether there are so many voxels left.
    pub(super) fn check_voxels(&self, count: usize) -> Result<(), Wrong> {
        let (most, found) = (self.most_voxels, self.voxels.saturating_add(count));
        let expected = format!(
            "expected {most} voxels at most in the grids of all bodies together, found {found}"
        );
        require(found <= most, "n", expected)
    }

    /// Takes a distance for each of so many parts and voxels.
    pub(super) fn take_distances(&mut self, parts: usize, voxels: usize) -> Result<(), Wrong> {
        let most = self.distances / voxels.max(1);
        let expected =
            format!("expected {most} at most in a body of {voxels} voxels, found {parts}");
        require(parts <= most, "part", expected)?;
        self.distances -= parts * voxels;
        Ok(())
    }

    /// Takes the pixels of a picture, for each of so many colours.
    pub(super) fn take_pixels(&mut self, pixels: usize, colours: usize) -> Result<(), Wrong> {
        let (most, colours) = (self.judgements / pixels.max(1), colours.max(1));
        let expected = format!("expected {most} at most for {pixels} pixels, found {colours}");
        require(colours <= most, "colours", expected)?;
        self.judgements -= pixels * colours;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A thousand bodies asked for a thousand times what one may.
    #[test]
    fn what_bodies_ask_for_is_limited_in_its_sum() {
        let mut budget = Budget::of_scene(1000);
        budget.take_voxels(600).unwrap();
        assert!(budget.take_voxels(401).is_err() && budget.take_voxels(400).is_ok());
        budget.take_distances(400, 1 << 18).unwrap();
        assert!(budget.take_distances(113, 1 << 18).is_err());
        assert!(budget.take_distances(112, 1 << 18).is_ok());
        for _ in 0..4 {
            budget.take_pixels(1 << 24, 16).unwrap();
        }
        assert!(budget.take_pixels(1 << 24, 0).is_err());
        assert!(budget.take_distances(0, usize::MAX).is_ok());
        assert!(budget.take_voxels(usize::MAX).is_err());
    }
}
