//! Topology of a body: voxels, connectivity, and the mesh that follows from them.

use crate::foundation::dim::Dim;
use crate::foundation::hash::hash_state;
use crate::material::Material;
use crate::topology::cell_hierarchy::CellHierarchy;
use crate::topology::connectivity::Connectivity;
use crate::topology::grid::VoxelGrid;
use crate::topology::mesh::Mesh;
use crate::topology::pieces::Pieces;

/// Topology of a body: voxels, connectivity, and the mesh that follows from them.
///
/// Grid and connectivity determine everything else except the numbers of cells, elements, nodes and pieces,
/// which depend on the history. Snapshots therefore contain the numbered objects, too.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(bound = ""))]
pub struct Topology<D: Dim> {
    pub grid: VoxelGrid<D>,
    pub connectivity: Connectivity<D>,
    pub hierarchy: CellHierarchy<D>,
    pub mesh: Mesh<D>,
    pub pieces: Pieces,
    /// Materials, number 1 first.
    pub materials: Vec<Material>,
    /// Factor by which the stiffness was lowered to keep the substep stable; 1 = unchanged.
    pub stiffness_scale: f64,
}

hash_state! {
    [D: Dim] struct Topology<D> {
        grid, connectivity, hierarchy, mesh, pieces, materials, stiffness_scale,
    }
}
