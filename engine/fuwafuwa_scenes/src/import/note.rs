//! Notes of imported files: what was left out or may surprise, although the import succeeded.

use fuwafuwa::inspect::points_in;
use fuwafuwa::{Dim, VoxelGrid};
use std::fmt;

/// Voxels imported from a file, and notes for the user.
#[derive(Clone, Debug)]
pub struct Import<D: Dim> {
    /// Solid voxels and their materials.
    pub grid: VoxelGrid<D>,
    /// Notes on what was left out or may surprise. Programs show them where the user looks.
    pub notes: Vec<ImportNote>,
}

/// Note of an import that succeeded. It displays as a text in English.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ImportNote {
    /// Name of the file, as given by the caller.
    pub file: String,
    /// Subject of the note.
    pub kind: NoteKind,
}

/// Subject of a note.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum NoteKind {
    /// Hidden models of a file were left out.
    HiddenModels {
        /// Number of hidden models.
        left_out: usize,
    },
    /// Models that are not placed in MagicaVoxel's world were left out.
    UnplacedModels {
        /// Number of models.
        left_out: usize,
    },
    /// The file is animated, and only its first frame was imported.
    Frames {
        /// Number of frames that were left out.
        left_out: usize,
    },
    /// Models of different colours overlap. One of them decides the material of each voxel in the overlap.
    Overlap {
        /// Number of voxels for which the models have different colours.
        voxels: usize,
    },
    /// Things along the edge of a picture, such as the table below the paper, were left out.
    Surroundings {
        /// Number of things.
        left_out: usize,
    },
    /// Specks of a drawing that are smaller than a quarter of a voxel were left out.
    Specks {
        /// Number of specks.
        left_out: usize,
    },
    /// The solid voxels are not connected: the body falls apart at once.
    Pieces {
        /// Number of pieces. Voxels are connected if they share a face (an edge in 2D).
        pieces: usize,
        /// Whether some pieces touch along edges or at corners, so that the shape looks more connected than
        /// it is.
        touch: bool,
    },
}

impl ImportNote {
    /// Creates a note on a file.
    pub fn new(file: &str, kind: NoteKind) -> Self {
        let file = file.into();
        Self { file, kind }
    }
}

impl NoteKind {
    /// Returns the note on a shape that falls into pieces; `None` if all solid voxels are connected.
    pub fn of_pieces<D: Dim>(grid: &VoxelGrid<D>) -> Option<Self> {
        let pieces = count_pieces(grid, is_across_face);
        (pieces > 1).then(|| Self::Pieces {
            pieces,
            touch: count_pieces(grid, |_| true) < pieces,
        })
    }
}

/// Returns whether two voxels with this offset share a face (an edge in 2D).
fn is_across_face(offset: [i32; 3]) -> bool {
    offset.into_iter().map(i32::abs).sum::<i32>() == 1
}

/// Returns the number of pieces into which the solid voxels fall. Voxels are connected if `joins` accepts the
/// offset from one to the other, whose components are -1 to 1.
fn count_pieces<D: Dim>(grid: &VoxelGrid<D>, joins: impl Fn([i32; 3]) -> bool) -> usize {
    let offsets: Vec<_> = points_in([-1; 3], [1; 3]).filter(|&k| joins(k)).collect();
    let mut is_seen = vec![false; grid.size().into_iter().product::<i32>() as usize];
    let mut to_visit = Vec::new();
    let mut pieces = 0;
    for start in grid.voxels() {
        if !grid.is_solid(start) || is_seen[grid.index(start)] {
            continue;
        }
        pieces += 1;
        is_seen[grid.index(start)] = true;
        to_visit.push(start);
        while let Some(voxel) = to_visit.pop() {
            for offset in &offsets {
                let next = [0, 1, 2].map(|axis| voxel[axis] + offset[axis]);
                if grid.is_solid(next) && !is_seen[grid.index(next)] {
                    is_seen[grid.index(next)] = true;
                    to_visit.push(next);
                }
            }
        }
    }
    pieces
}

impl fmt::Display for ImportNote {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.file, self.kind)
    }
}

impl fmt::Display for NoteKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::HiddenModels { left_out: 1 } => write!(f, "a hidden model is left out"),
            Self::HiddenModels { left_out } => write!(f, "{left_out} hidden models are left out"),
            Self::UnplacedModels { left_out: 1 } => {
                write!(
                    f,
                    "a model that is not placed in MagicaVoxel's world is left out"
                )
            }
            Self::UnplacedModels { left_out } => {
                write!(
                    f,
                    "{left_out} models that are not placed in MagicaVoxel's world are left out"
                )
            }
            Self::Frames { left_out: 1 } => {
                write!(f, "only the first frame is taken; 1 more frame is left out")
            }
            Self::Frames { left_out } => {
                write!(
                    f,
                    "only the first frame is taken; {left_out} more frames are left out"
                )
            }
            Self::Overlap { voxels } => {
                let unit = if voxels == 1 { "voxel" } else { "voxels" };
                write!(f, "models of different colours overlap in {voxels} {unit}")
            }
            Self::Surroundings { left_out: 1 } => {
                write!(f, "what lies along the edge of the picture is left out")
            }
            Self::Surroundings { left_out } => {
                write!(
                    f,
                    "{left_out} things along the edge of the picture are left out"
                )
            }
            Self::Specks { left_out: 1 } => write!(f, "a speck is left out"),
            Self::Specks { left_out } => write!(f, "{left_out} specks are left out"),
            Self::Pieces { pieces, touch } => {
                let how = match touch {
                    true => "some touch only at edges or corners, so they come apart",
                    false => "they do not touch each other",
                };
                write!(f, "the shape falls into {pieces} pieces: {how}")
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fuwafuwa::{Dim2, Dim3};

    fn note<D: Dim>(size: [usize; 3], is_solid: fn([i32; 3]) -> bool) -> Option<String> {
        let grid = VoxelGrid::<D>::from_fn(size, 0.1, |voxel| u8::from(is_solid(voxel))).unwrap();
        NoteKind::of_pieces(&grid).map(|kind| ImportNote::new("a.vox", kind).to_string())
    }

    #[test]
    fn pieces_are_counted_across_faces_only() {
        assert_eq!(note::<Dim3>([4, 4, 4], |_| true), None);
        let edge = note::<Dim3>([4, 4, 2], |[x, y, _]| (x < 2) == (y < 2));
        let touching = "a.vox: the shape falls into 2 pieces: some touch only at edges or corners, so they come apart";
        assert_eq!(edge.as_deref(), Some(touching));
        let corner = note::<Dim3>([2, 2, 2], |voxel| voxel == [0; 3] || voxel == [1; 3]);
        assert_eq!(corner.as_deref(), Some(touching));
        let apart = note::<Dim3>([5, 1, 1], |[x, _, _]| x % 2 == 0);
        let expected = "a.vox: the shape falls into 3 pieces: they do not touch each other";
        assert_eq!(apart.as_deref(), Some(expected));
        let flat = note::<Dim2>([2, 2, 1], |[x, y, _]| x == y);
        assert_eq!(flat.as_deref(), Some(touching));
    }
}
