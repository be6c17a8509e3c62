//! Topology of a body: voxels, connectivity, and the mesh that follows from them.

use crate::foundation::copy_on_write::CopyOnWrite;
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
/// Grid, connectivity and grading determine the mesh and the pieces, except for the ids of elements, nodes
/// and pieces. The ids depend on the order of past cracks. Snapshots therefore contain the mesh and the
/// pieces, too.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(bound = ""))]
pub struct Topology<D: Dim> {
    pub grid: CopyOnWrite<VoxelGrid<D>>,
    pub connectivity: CopyOnWrite<Connectivity<D>>,
    pub hierarchy: CopyOnWrite<CellHierarchy<D>>,
    pub mesh: CopyOnWrite<Mesh<D>>,
    pub pieces: Pieces,
    /// Materials of the body. Material number n of the grid is at index n − 1.
    pub materials: Vec<Material>,
    /// Factor by which the stiffness was lowered to keep the substep stable; 1 = unchanged.
    pub stiffness_scale: f64,
    /// Factor on the inertia of deformation that keeps the substep stable; 1 = unchanged.
    pub mass_scale: f64,
}

hash_state! {
    [D: Dim] struct Topology<D> {
        grid, connectivity, hierarchy, mesh, pieces, materials, stiffness_scale,
        mass_scale,
    }
}
