//! Materials of a scene, and tints: materials that differ only in their colour.

use super::body::MaterialText;
use fuwafuwa::{Dim, Material, VoxelGrid};

/// Materials of a scene.
pub(super) struct SceneMaterials {
    /// Materials, number 1 first.
    pub list: Vec<Material>,
    /// Number of each material in the world. A material with a colour has the number of the first material
    /// with equal properties, so that elements of any size can cover several tints.
    numbers: Vec<u8>,
}

impl SceneMaterials {
    pub fn of(texts: &[MaterialText]) -> Self {
        let list: Vec<Material> = texts.iter().map(MaterialText::material).collect();
        let numbers = texts.iter().enumerate().map(|(index, text)| {
            let equal = list.iter().position(|known| *known == list[index]);
            let first = equal.filter(|_| text.colour.is_some()).unwrap_or(index);
            u8::try_from(first + 1).unwrap_or(u8::MAX)
        });
        Self {
            numbers: numbers.collect(),
            list,
        }
    }

    /// Returns whether any material is a tint of another one.
    pub fn has_tints(&self) -> bool {
        (1..)
            .zip(&self.numbers)
            .any(|(number, &own)| number != usize::from(own))
    }

    /// Returns whether any voxel has a tint.
    pub fn are_tints_in<D: Dim>(&self, grid: &VoxelGrid<D>) -> bool {
        let mut numbers = grid.voxels().map(|voxel| grid.material(voxel));
        self.has_tints() && numbers.any(|number| self.number(number) != number)
    }

    /// Returns the grid with the material numbers of the world.
    pub fn without_tints<D: Dim>(&self, grid: VoxelGrid<D>) -> VoxelGrid<D> {
        if !self.are_tints_in(&grid) {
            return grid;
        }
        let known = grid.clone();
        let merged = grid.with_materials(|_, number| self.number(number));
        merged.unwrap_or(known)
    }

    /// Returns the number of a material in the world. Empty voxels and missing materials keep their numbers.
    fn number(&self, number: u8) -> u8 {
        let index = usize::from(number).wrapping_sub(1);
        self.numbers.get(index).copied().unwrap_or(number)
    }
}
