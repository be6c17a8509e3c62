//! Voxel grids from scans: the largest connected object in a scan.

use crate::placement::Placement;
use crate::region::{fill_holes, keep_largest, solid_box};
use crate::scan::Scan;
use crate::segmentation::Segmentation;
use fuwafuwa::glam::DVec3;
use fuwafuwa::{Dim3, Error, Point, VoxelGrid};
use std::ops::RangeInclusive;

/// Allowed numbers of voxels along an organ's longest side. Fewer voxels show no shape. More would not fit
/// into a MagicaVoxel model.
pub const RESOLUTIONS: RangeInclusive<usize> = 8..=256;

/// Minimum resolution of the search for an organ [voxels], used even if the final resolution is lower. A
/// coarser search would miss small organs.
const MIN_SEARCH_RESOLUTION: usize = 64;

/// Maximum number of samples along each axis of a voxel. A higher number hardly changes the result.
const MAX_SAMPLES: usize = 4;

/// Maximum number of samples along each axis of a voxel during the search.
const MAX_SEARCH_SAMPLES: usize = 2;

/// Options for building an organ.
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// Number of voxels along the longest side, in [`RESOLUTIONS`], including one empty voxel at each end.
    /// Default 64.
    pub resolution: usize,
    /// Whether enclosed holes are filled with the nearest material; default false. A hole without an opening
    /// is invisible and costs many small elements.
    pub fills_holes: bool,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            resolution: 64,
            fills_holes: false,
        }
    }
}

/// Reason why no organ could be made from scans.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum OrganError {
    /// The number of scans does not fit the segmentation.
    #[error("expected {expected}, found {found}")]
    Scans {
        /// Number of scans that the segmentation requires.
        expected: &'static str,
        /// Number of scans given.
        found: usize,
    },
    /// The resolution is not in [`RESOLUTIONS`].
    #[error("expected {RESOLUTIONS:?} voxels along the longest side, found {found}")]
    Resolution {
        /// Requested number of voxels.
        found: usize,
    },
    /// No position in the scan has a material.
    #[error("no voxel has a material: check which intensities or labels the scan contains")]
    Empty,
    /// The engine rejects the grid.
    #[error("{0}")]
    Grid(Error),
}

/// Organ on the engine's axes: x points to the patient's right, y to the head, z to the back.
#[derive(Clone, Debug)]
pub struct Organ {
    /// Voxels with material numbers from 1; lengths in metres.
    pub grid: VoxelGrid<Dim3>,
    lattice: Lattice,
    /// Number of voxels of each material.
    counts: [usize; 256],
    /// Lowest and highest solid voxel on each axis.
    solid: [[usize; 3]; 2],
}

impl Organ {
    /// Builds the largest connected object in the scans. `progress` is called with increasing numbers from 0
    /// to 1.
    ///
    /// A voxel is solid if at least half of its samples have a material. It gets the most frequent material.
    ///
    /// # Errors
    /// [`OrganError`] names the problem with the scans, the materials or the resolution.
    pub fn of(
        scans: &[&Scan],
        segmentation: &Segmentation,
        options: &Options,
        mut progress: impl FnMut(f32),
    ) -> Result<Self, OrganError> {
        check(scans.len(), segmentation)?;
        let resolution = options.resolution;
        if !RESOLUTIONS.contains(&resolution) {
            return Err(OrganError::Resolution { found: resolution });
        }
        let mut region = Region::of(scans);
        // Limits the search to the voxels of the scan along the longest side: a finer search finds nothing
        // more.
        let shown = (region.longest() / finest(scans)).ceil() as usize;
        let searched = resolution
            .max(MIN_SEARCH_RESOLUTION)
            .min(shown.max(*RESOLUTIONS.start()));
        // The first pass finds the organ in the whole scan. The second pass measures the organ, and the third
        // samples only its region at the final resolution.
        let looks = [
            (searched, MAX_SEARCH_SAMPLES),
            (searched, MAX_SEARCH_SAMPLES),
            (resolution, MAX_SAMPLES),
        ];
        let mut found = None;
        for (number, (across, most_asked)) in looks.into_iter().enumerate() {
            let lattice = Lattice::over(&region, across);
            let share = |done: f32| (number as f32 + done) / looks.len() as f32;
            let mut materials = lattice.materials(scans, segmentation, most_asked, |done| {
                progress(share(done))
            });
            keep_largest(lattice.size, &mut materials);
            let solid = solid_box(lattice.size, &materials).ok_or(OrganError::Empty)?;
            region = lattice.around(solid);
            found = Some((lattice, solid, materials));
        }
        let (lattice, solid, mut materials) = found.ok_or(OrganError::Empty)?;
        if options.fills_holes {
            fill_holes(lattice.size, &mut materials);
        }
        progress(1.0);
        let mut counts = [0; 256];
        for &material in &materials {
            counts[usize::from(material)] += 1;
        }
        let voxel_size = (lattice.voxel / 1000.0) as f32;
        let grid = VoxelGrid::from_materials(lattice.size, voxel_size, materials);
        Ok(Self {
            grid: grid.map_err(OrganError::Grid)?,
            lattice,
            counts,
            solid,
        })
    }

    /// Returns the number of voxels of a material.
    pub fn voxels(&self, material: u8) -> usize {
        self.counts[usize::from(material)]
    }

    /// Returns the volume of the voxels of a material [ml].
    pub fn millilitres(&self, material: u8) -> f64 {
        let edge = 0.1 * self.lattice.voxel;
        self.voxels(material) as f64 * edge * edge * edge
    }

    /// Returns the side lengths of the organ's bounding box along the engine's axes [mm].
    pub fn sides(&self) -> [f64; 3] {
        let [low, high] = self.solid;
        [0, 1, 2].map(|axis: usize| (high[axis] - low[axis] + 1) as f64 * self.lattice.voxel)
    }

    /// Converts a position in the organ's grid, relative to the grid's low corner [m], to patient
    /// coordinates, RAS+ [mm].
    pub fn patient_at(&self, place: [f64; 3]) -> [f64; 3] {
        self.lattice.patient_at(place.map(|k| 1000.0 * k))
    }

    /// Returns the voxel of the organ's grid at a position in the patient, RAS+ [mm]. It may lie outside the
    /// grid.
    pub fn voxel_at(&self, patient: [f64; 3]) -> Point {
        self.lattice.voxel_at(patient)
    }
}

fn check(found: usize, segmentation: &Segmentation) -> Result<(), OrganError> {
    let (range, expected) = match segmentation {
        Segmentation::Maps => (1..=255, "1 to 255 scans, a map for each material"),
        _ => (1..=1, "one scan with intensities or labels"),
    };
    let wrong = OrganError::Scans { expected, found };
    range.contains(&found).then_some(()).ok_or(wrong)
}

/// Box in patient coordinates, RAS+ [mm].
struct Region {
    low: DVec3,
    high: DVec3,
}

impl Region {
    /// Returns the bounding box of scans.
    fn of(scans: &[&Scan]) -> Self {
        let mut region = Self {
            low: DVec3::INFINITY,
            high: DVec3::NEG_INFINITY,
        };
        for scan in scans {
            for corner in corners(scan.size(), scan.placement()) {
                region.low = region.low.min(corner);
                region.high = region.high.max(corner);
            }
        }
        region
    }

    fn extent(&self) -> DVec3 {
        self.high - self.low
    }

    fn longest(&self) -> f64 {
        self.extent().max_element()
    }
}

/// Returns the smallest voxel spacing of scans [mm].
fn finest(scans: &[&Scan]) -> f64 {
    let spacings = scans.iter().flat_map(|scan| scan.placement().spacing());
    spacings.fold(f64::INFINITY, f64::min)
}

/// Returns the corners of a scan, RAS+ [mm], half a voxel outside the centres of its corner voxels.
fn corners(size: [usize; 3], placement: &Placement) -> [DVec3; 8] {
    [0, 1, 2, 3, 4, 5, 6, 7].map(|corner: usize| {
        let voxel = [0, 1, 2].map(|axis: usize| match corner >> axis & 1 {
            0 => -0.5,
            _ => size[axis] as f64 - 0.5,
        });
        placement.patient_at(voxel).into()
    })
}

/// Grid of cubes over a box in the patient, on the engine's axes.
#[derive(Clone, Debug)]
struct Lattice {
    size: [usize; 3],
    /// Edge length of a cube [mm].
    voxel: f64,
    /// Patient coordinates, RAS+ [mm], of the corner that is lowest on the engine's axes.
    corner: [f64; 3],
}

impl Lattice {
    /// Creates the grid over a box, with `across` cubes along the longest side.
    fn over(region: &Region, across: usize) -> Self {
        let voxel = region.longest() / across as f64;
        // Subtracts a little before rounding up: the longest side is a whole number of voxels, except for
        // rounding errors.
        let count = |length: f64| ((length / voxel - 1e-6).ceil().max(1.0) as usize).min(across);
        let [right, front, up] = region.extent().to_array();
        let size = [right, up, front].map(count);
        let half = size.map(|extent| 0.5 * extent as f64 * voxel);
        let middle = 0.5 * (region.low + region.high);
        let corner = [middle.x - half[0], middle.y + half[2], middle.z - half[1]];
        Self {
            size,
            voxel,
            corner,
        }
    }

    /// Returns the region of a range of cubes, extended by one cube on each side.
    fn around(&self, [low, high]: [[usize; 3]; 2]) -> Region {
        let low = low.map(|k| (k as f64 - 1.0) * self.voxel);
        let high = high.map(|k| (k as f64 + 2.0) * self.voxel);
        let [a, b] = [low, high].map(|corner| DVec3::from(self.patient_at(corner)));
        Region {
            low: a.min(b),
            high: a.max(b),
        }
    }

    /// Converts a position in the grid, on the engine's axes [mm], to patient coordinates. The engine's z
    /// axis points to the patient's back.
    fn patient_at(&self, [x, y, z]: [f64; 3]) -> [f64; 3] {
        let [right, front, up] = self.corner;
        [right + x, front - z, up + y]
    }

    fn voxel_at(&self, patient: [f64; 3]) -> Point {
        let [right, front, up] = [0, 1, 2].map(|axis: usize| patient[axis] - self.corner[axis]);
        [right, up, -front].map(|k| (k / self.voxel).floor() as i32)
    }

    /// Returns the material of each cube: the most frequent material of its samples, or 0 if more than half
    /// of them are empty.
    fn materials(
        &self,
        scans: &[&Scan],
        segmentation: &Segmentation,
        most_asked: usize,
        mut progress: impl FnMut(f32),
    ) -> Vec<u8> {
        let asked = ((self.voxel / finest(scans)).ceil() as usize).clamp(1, most_asked);
        let [width, height, depth] = self.size;
        let mut materials = Vec::with_capacity(width * height * depth);
        for z in 0..depth {
            progress(z as f32 / depth as f32);
            for y in 0..height {
                for x in 0..width {
                    let voxel = [x, y, z].map(|k| k as f64);
                    materials.push(self.material(scans, segmentation, asked, voxel));
                }
            }
        }
        materials
    }

    fn material(
        &self,
        scans: &[&Scan],
        segmentation: &Segmentation,
        asked: usize,
        voxel: [f64; 3],
    ) -> u8 {
        let mut votes = [0_u16; 256];
        let count = asked * asked * asked;
        for number in 0..count {
            let part = [
                number % asked,
                number / asked % asked,
                number / asked / asked,
            ];
            let part = part.map(|k| (k as f64 + 0.5) / asked as f64);
            let place = [0, 1, 2].map(|axis: usize| (voxel[axis] + part[axis]) * self.voxel);
            let material = segmentation.material(scans, self.patient_at(place));
            votes[usize::from(material)] += 1;
        }
        if 2 * usize::from(votes[0]) > count {
            return 0;
        }
        let best =
            (1..=255).max_by_key(|&material: &u8| (votes[usize::from(material)], 255 - material));
        best.unwrap_or(0)
    }
}
