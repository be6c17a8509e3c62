//! What must hold for every mesh: the checks behind [`Mesh::validate`].

use super::{Defect, Mesh};
use crate::dim::{Dim, Point, neighbourhood};
use crate::grid::VoxelGrid;
use crate::sharing::Sharing;

impl<D: Dim> Mesh<D> {
    /// Checks that every solid voxel is owned once, that neighbours differ by at most one level,
    /// that no coarse element meets a split point, that every node has the carriers it counts,
    /// and that gradients balance at inner nodes.
    ///
    /// # Errors
    /// The first [`Defect`] found.
    #[inline(never)]
    pub fn validate(&self, grid: &VoxelGrid<D>, sharing: &Sharing<D>) -> Result<(), Defect> {
        let levels = self.check_ownership(grid)?;
        check_grading(grid, &levels)?;
        self.check_split_points(sharing)?;
        self.check_carriers()?;
        self.check_gradients(sharing)
    }

    /// The level that owns each voxel; `u8::MAX` where there is none.
    fn check_ownership(&self, grid: &VoxelGrid<D>) -> Result<Vec<u8>, Defect> {
        let mut owners = vec![u8::MAX; grid.voxels().count()];
        for (id, element) in self.elements() {
            for voxel in self.voxels(element) {
                if self.owner(voxel) != Some(id) {
                    let other = self.owner(voxel);
                    return Err(Defect(format!(
                        "{id} fills {voxel:?}, listed for {other:?}"
                    )));
                }
                if !grid.is_solid(voxel) {
                    let cell = element.cell;
                    return Err(Defect(format!("{cell:?} fills the empty voxel {voxel:?}")));
                }
                let owner = &mut owners[grid.index(voxel)];
                if *owner != u8::MAX {
                    return Err(Defect(format!("two elements own the voxel {voxel:?}")));
                }
                *owner = element.cell.level;
            }
        }
        let is_orphan =
            |&voxel: &Point| grid.is_solid(voxel) && owners[grid.index(voxel)] == u8::MAX;
        match grid.voxels().find(is_orphan) {
            Some(voxel) => Err(Defect(format!("no element owns the voxel {voxel:?}"))),
            None => Ok(owners),
        }
    }

    fn check_split_points(&self, sharing: &Sharing<D>) -> Result<(), Defect> {
        for (_, element) in self
            .elements()
            .filter(|(_, element)| element.cell.level > 0)
        {
            for &node in &element.nodes {
                let at = self.node(node).at;
                if sharing.groups(at).iter().count() > 1 {
                    let cell = element.cell;
                    return Err(Defect(format!("{cell:?} meets the split point {at:?}")));
                }
            }
        }
        Ok(())
    }

    fn check_carriers(&self) -> Result<(), Defect> {
        let mut counts = vec![0u8; self.nodes.len()];
        for (_, element) in self.elements() {
            element
                .nodes
                .iter()
                .for_each(|&node| counts[node as usize] += 1);
        }
        match (0..counts.len()).find(|&node| counts[node] != self.carriers[node]) {
            Some(node) => Err(Defect(format!(
                "{:?} has {} carriers and counts {}",
                self.nodes[node], counts[node], self.carriers[node]
            ))),
            None => Ok(()),
        }
    }

    fn check_gradients(&self, sharing: &Sharing<D>) -> Result<(), Defect> {
        let mut sums = vec![[0.0; 3]; self.nodes.len()];
        for (_, element) in self.elements() {
            let half = element.cell.width() as f64 * 0.5;
            let scale = (1..D::N).fold(1.0, |scale, _| scale * half);
            for (&node, gradient) in element.nodes.iter().zip(&self.stencil(element).gradients) {
                for axis in 0..3 {
                    sums[node as usize][axis] += gradient[axis] * scale;
                }
            }
        }
        for (id, node) in self.nodes() {
            let inner = node.group == D::ALL_CORNERS && !sharing.is_open(node.at);
            let sum = sums[id as usize];
            if inner && sum.iter().any(|&component: &f64| component.abs() > 1e-9) {
                let at = node.at;
                return Err(Defect(format!(
                    "gradients do not balance at {at:?}: {sum:?}"
                )));
            }
        }
        Ok(())
    }
}

fn check_grading<D: Dim>(grid: &VoxelGrid<D>, levels: &[u8]) -> Result<(), Defect> {
    for voxel in grid.voxels().filter(|&voxel| grid.is_solid(voxel)) {
        let level = levels[grid.index(voxel)];
        for near in neighbourhood::<D>(voxel, 1).filter(|&near| grid.is_solid(near)) {
            if level.abs_diff(levels[grid.index(near)]) > 1 {
                return Err(Defect(format!(
                    "levels jump between {voxel:?} and {near:?}"
                )));
            }
        }
    }
    Ok(())
}
