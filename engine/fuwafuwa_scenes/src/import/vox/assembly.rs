//! Assembly of models into one box of voxels.

use super::MAX_MODEL_VOXELS;
use super::graph::Placement;
use crate::import::error::{FilePosition, PositionedProblem, unexpected};
use fuwafuwa::MAX_EXTENT;

/// Maximum number of solid voxels of all placed models together, each counted as often as it is placed.
const MAX_PLACED: usize = 1 << 24;

/// Model as stored in a file.
pub(super) struct StoredModel {
    /// Number of voxels on each axis of the file.
    pub size: [u32; 3],
    /// Position on each axis of the file, and palette index, of each solid voxel.
    pub voxels: Vec<[u8; 4]>,
}

/// Box of voxels on the engine's axes, with the first axis fastest. Each face of the box touches a solid
/// voxel.
#[derive(Clone, Debug, Default)]
pub(super) struct Solid {
    pub size: [usize; 3],
    /// Palette index of each voxel, 0 where empty.
    pub voxels: Vec<u8>,
}

/// Box of voxels with its low and high corner, which is inside.
#[derive(Clone, Copy)]
struct Bounds {
    low: [i64; 3],
    high: [i64; 3],
}

impl Bounds {
    fn of(mut voxels: impl Iterator<Item = [i64; 3]>) -> Option<Self> {
        let first = voxels.next()?;
        let first = Self {
            low: first,
            high: first,
        };
        Some(voxels.fold(first, |bounds, voxel| Self {
            low: [0, 1, 2].map(|axis| bounds.low[axis].min(voxel[axis])),
            high: [0, 1, 2].map(|axis| bounds.high[axis].max(voxel[axis])),
        }))
    }

    fn size(&self) -> [u64; 3] {
        [0, 1, 2].map(|axis| self.high[axis].abs_diff(self.low[axis]) + 1)
    }
}

impl StoredModel {
    /// Returns the position of a voxel from the pivot of the model, which is half the size of the model,
    /// rounded down to whole voxels.
    fn relative_to_pivot(&self, voxel: [u8; 3]) -> [i64; 3] {
        [0, 1, 2].map(|axis| i64::from(voxel[axis]) - i64::from(self.size[axis] / 2))
    }

    fn bounds(&self) -> Option<Bounds> {
        let voxels = self.voxels.iter();
        Bounds::of(voxels.map(|&[x, y, z, _]| self.relative_to_pivot([x, y, z])))
    }
}

/// Assembles models; where models overlap, a later one counts. Returns the voxels, empty if no model has any,
/// and the number of voxels for which the overlapping models have different colours.
pub(super) fn assemble(
    models: &[StoredModel],
    placements: &[Placement],
) -> Result<(Solid, usize), PositionedProblem> {
    let placed = placements
        .iter()
        .map(|placement| models[placement.model].voxels.len());
    let placed = placed.fold(0, usize::saturating_add);
    if placed > MAX_PLACED {
        let expected = format!("at most {MAX_PLACED} voxels in all visible models together");
        let found = format!("{placed} (choose a part of the scene with model = \"name\")");
        return Err(unexpected(FilePosition::File, expected, found));
    }
    let Some(bounds) = bounds_of_all(models, placements) else {
        return Ok((Solid::default(), 0));
    };
    check_size(bounds.size())?;
    let [width, depth, height] = bounds.size().map(|extent| extent as usize);
    let mut voxels = vec![0; width * depth * height];
    let mut is_disputed = vec![
        false;
        if placements.len() > 1 {
            voxels.len()
        } else {
            0
        }
    ];
    for Placement { model, motion } in placements {
        let model = &models[*model];
        for &[x, y, z, index] in &model.voxels {
            let at = motion.moved_voxel(model.relative_to_pivot([x, y, z]));
            let [x, y, z] = [0, 1, 2].map(|axis| (at[axis] - bounds.low[axis]) as usize);
            // Converts the position to the axes of the engine, on which y points up.
            let at = ((depth - 1 - y) * height + z) * width + x;
            if voxels[at] != 0 && voxels[at] != index {
                is_disputed[at] = true;
            }
            voxels[at] = index;
        }
    }
    let size = [width, height, depth];
    let disputed = is_disputed.iter().filter(|disputed| **disputed).count();
    Ok((Solid { size, voxels }, disputed))
}

fn bounds_of_all(models: &[StoredModel], placements: &[Placement]) -> Option<Bounds> {
    let bounds: Vec<_> = models.iter().map(StoredModel::bounds).collect();
    Bounds::of(placements.iter().flat_map(|Placement { model, motion }| {
        let corners = bounds[*model].map(|bounds| [bounds.low, bounds.high]);
        let corners = corners.into_iter().flatten();
        corners.map(|corner| motion.moved_voxel(corner))
    }))
}

/// Checks the size of the box around all solid voxels, given on the axes of the file.
pub(super) fn check_size(size: [u64; 3]) -> Result<(), PositionedProblem> {
    let longest = size.into_iter().max().unwrap_or(0);
    let count = size.into_iter().fold(1, u64::saturating_mul);
    let excess =
        (longest as f64 / MAX_EXTENT as f64).max((count as f64 / MAX_MODEL_VOXELS as f64).cbrt());
    if excess <= 1.0 {
        return Ok(());
    }
    let expected = format!(
        "at most {MAX_EXTENT} voxels on an axis and {MAX_MODEL_VOXELS} in all in the box around the solid voxels"
    );
    let [x, y, z] = size;
    let found = format!(
        "{x} x {y} x {z} = {count} ({excess:.1} times too wide: scale the model down or choose a part of it with model = \"name\")"
    );
    Err(unexpected(FilePosition::File, expected, found))
}

impl Solid {
    /// Returns the smallest box that contains all solid voxels; `None` if there is none.
    pub fn trimmed(&self) -> Option<Self> {
        let [width, height, _] = self.size;
        let place = |at: usize| [at % width, at / width % height, at / width / height];
        let solid = (0..self.voxels.len()).filter(|&at| self.voxels[at] != 0);
        let bounds = Bounds::of(solid.map(|at| place(at).map(|k| k as i64)))?;
        let (low, size) = (
            bounds.low.map(|k| k as usize),
            bounds.size().map(|k| k as usize),
        );
        if size == self.size {
            return Some(self.clone());
        }
        let mut voxels = Vec::with_capacity(size.into_iter().product());
        for z in low[2]..low[2] + size[2] {
            for y in low[1]..low[1] + size[1] {
                let row = (z * height + y) * width + low[0];
                voxels.extend(&self.voxels[row..row + size[0]]);
            }
        }
        Some(Self { size, voxels })
    }
}
