//! What a body is made of, how that hangs together, and what follows from it.

use crate::dim::Dim;
use crate::grid::VoxelGrid;
use crate::material::Material;
use crate::mesh::Mesh;
use crate::piece::Pieces;
use crate::pyramid::Pyramid;
use crate::sharing::Sharing;

/// What a body is made of, how that hangs together, and what follows from it.
///
/// Grid and sharing say all that is true. Cells, elements, nodes and pieces could be worked out from them but
/// for their numbers, which are of what happened: so they are kept, and saved.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(bound = ""))]
pub struct Truth<D: Dim> {
    pub grid: VoxelGrid<D>,
    pub sharing: Sharing<D>,
    pub pyramid: Pyramid<D>,
    pub mesh: Mesh<D>,
    pub pieces: Pieces,
    /// Number 1 first.
    pub materials: Vec<Material>,
    /// By what their stiffness was lowered so that the substep bears it; 1 = not at all.
    pub stiffness_scale: f64,
}
