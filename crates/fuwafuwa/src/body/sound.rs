//! Whether a body that was read from a file is one: a checksum says only that nobody changed it since
//! it was written, not who wrote it.

use super::Body;
use crate::dim::Dim;
use crate::mesh::{Defect, Mesh};
use crate::piece::Pieces;
use crate::pyramid::Pyramid;

impl<D: Dim> Body<D> {
    /// Checks that cells, elements, nodes and pieces are those that follow from the voxels and from what
    /// is connected, and that there is a state for each node.
    ///
    /// # Errors
    /// The first [`Defect`] found.
    pub(crate) fn check(&self) -> Result<(), Defect> {
        let ensure = |good: bool, what: &str| match good {
            true => Ok(()),
            false => Err(Defect::of(format!("{what} do not fit"))),
        };
        ensure(self.grid.is_sound(), "voxels")?;
        let numbers = self.grid.voxels().map(|voxel| self.grid.material(voxel));
        let number = usize::from(numbers.max().unwrap_or(0));
        let are_good = { self.materials.iter() }.all(|material| material.check(0).is_ok());
        ensure(number <= self.materials.len() && are_good, "materials")?;
        ensure(self.sharing.is_sound(&self.grid), "groups")?;
        let grading = self.pyramid.grading();
        let cells = Pyramid::new(&self.grid, &self.sharing, grading);
        ensure(self.pyramid == cells, "cells")?;
        let fresh = Mesh::grade(&self.grid, &self.sharing, &cells)?;
        self.mesh.check_against(&fresh, &self.sharing)?;
        self.mesh.validate(&self.grid, &self.sharing)?;
        ensure(self.pieces.is_sound(&self.mesh), "pieces")?;
        let nodes = self.mesh.node_capacity();
        let rows = [&self.position, &self.velocity, &self.ahead].map(Vec::len);
        let numbers = [&self.mass, &self.inverse_mass, &self.damage].map(Vec::len);
        let mut lengths = rows.into_iter().chain(numbers).chain([self.held.len()]);
        let are_long = lengths.all(|length| length == nodes);
        ensure(are_long, "states")
    }
}

impl Pieces {
    /// Whether they are the pieces of a mesh, whatever their numbers.
    fn is_sound<D: Dim>(&self, mesh: &Mesh<D>) -> bool {
        let fresh = Self::new(mesh);
        let mut numbers = vec![None; fresh.list.len()];
        let mut taken = vec![false; self.list.len()];
        self.has_room(mesh)
            && mesh.elements().all(|(id, element)| {
                let own = self.of_element(id);
                let number = &mut numbers[fresh.of_element(id) as usize];
                let mut is_new = || {
                    let taken = taken.get_mut(own as usize);
                    taken.is_some_and(|taken| !std::mem::replace(taken, true))
                };
                (*number == Some(own) || number.is_none() && is_new()) && {
                    *number = Some(own);
                    element.nodes.iter().all(|&node| self.of_node(node) == own)
                }
            })
    }
}
