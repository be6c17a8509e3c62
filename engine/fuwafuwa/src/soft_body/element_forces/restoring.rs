//! Snapshots of the batches. Only the state of each element is saved. The batches are rebuilt from the mesh,
//! because the assignment of elements to batches does not change the result.

use super::batch::VACANT;
use super::internal_state::{InternalState, PlasticInverse};
use super::saved_states::SavedElementStates;
use super::{ElementBatches, parts};
use crate::foundation::dim::Dim;
use crate::foundation::ids::ElementId;
use crate::material::Material;
use crate::topology::grid::VoxelGrid;
use crate::topology::mesh::{Element, Mesh};
use glam::Vec3;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

impl<D: Dim> ElementBatches<D> {
    /// Returns whether the state read from a file has the right number of entries for the elements of a mesh,
    /// and valid internal states. Rotations and forces may have any value, because pieces that become
    /// non-finite are quarantined after the tick.
    pub fn is_sound(&self, mesh: &Mesh<D>) -> bool {
        let numbers = |(_, element): (_, &Element)| parts::<D>() + element.nodes.len() * D::N;
        let numbers: usize = mesh.elements().map(numbers).sum();
        let fits = |saved: &SavedElementStates| {
            let states = &saved.internal_states;
            let is_one = |(id, state): &(ElementId, InternalState)| {
                let dashpots = state.dashpots.as_flattened().iter();
                mesh.element(*id).is_some()
                    && is_sound::<D>(&state.plastic_inverse)
                    && dashpots.fold(0.0f32, |most, k| most.max(k.abs())) < 100.0
                    && !state.dashpots.as_flattened().iter().any(|k| k.is_nan())
            };
            saved.inverted.len() == mesh.element_count()
                && saved.numbers.len() == numbers
                && states.is_sorted_by(|a, b| a.0 < b.0)
                && states.iter().all(is_one)
        };
        self.saved.as_ref().is_some_and(fits)
    }

    /// Puts the elements of a mesh into batches, and restores their state from the snapshot. `asleep` returns
    /// whether an element sleeps.
    pub fn restore(
        &mut self,
        mesh: &Mesh<D>,
        grid: &VoxelGrid<D>,
        materials: &[Material],
        stiffness_scale: f64,
        asleep: impl Fn(ElementId) -> bool,
    ) {
        let Some(SavedElementStates {
            law,
            numbers,
            internal_states,
            inverted,
        }) = self.saved.take()
        else {
            return;
        };
        *self = Self::new(law, materials, grid.voxel_size());
        self.set_materials(materials, stiffness_scale);
        let all: Vec<ElementId> = mesh.elements().map(|(id, _)| id).collect();
        self.update(mesh, grid, &[], &all, asleep);
        for (id, state) in internal_states {
            self.set_internal_state(id, state);
        }
        let mut numbers = numbers.into_iter();
        for (&id, inverted) in all.iter().zip(inverted) {
            let (index, lane) = self.assigned[id];
            let batch = &mut self.batches[index as usize];
            batch.inverted |= u8::from(inverted) << lane;
            let rotation = batch.rotation[..parts::<D>()].iter_mut();
            for (part, number) in rotation.zip(numbers.by_ref()) {
                part[lane as usize] = number;
            }
            for node in 0..batch.node_count as usize {
                let place = self.force_range(index, lane, node);
                let forces = self.forces[place].iter_mut();
                for (force, number) in forces.zip(numbers.by_ref()) {
                    *force = number;
                }
            }
        }
    }

    fn to_be_saved(&self) -> SavedElementStates {
        let known = self.assigned.ids();
        let states = known.filter_map(|id| Some((id, self.internal_state(id)?)));
        let mut saved = SavedElementStates {
            law: self.law,
            numbers: Vec::new(),
            internal_states: states
                .filter(|(_, state)| *state != InternalState::NONE)
                .collect(),
            inverted: Vec::new(),
        };
        let assigned = self.assigned.iter();
        for &(index, lane) in assigned.filter(|&&(index, _)| index != VACANT) {
            let batch = &self.batches[index as usize];
            let rotation = batch.rotation[..parts::<D>()].iter();
            let rotation = rotation.map(|part| part[lane as usize]);
            saved.numbers.extend(rotation);
            for node in 0..batch.node_count as usize {
                let place = self.force_range(index, lane, node);
                saved.numbers.extend_from_slice(&self.forces[place]);
            }
            saved.inverted.push(batch.inverted >> lane & 1 == 1);
        }
        saved
    }
}

/// Returns whether a plastic inverse is valid: it preserves volume within 10 %, has no entry of 100 or more,
/// and leaves the third axis unchanged in 2D.
fn is_sound<D: Dim>(plastic_inverse: &PlasticInverse) -> bool {
    let [x, y, z] = *plastic_inverse;
    let volume = x.dot(y.cross(z));
    let is_flat = (D::N..3).all(|axis| {
        let column = Vec3::new(x[axis], y[axis], z[axis]);
        plastic_inverse[axis] == Vec3::AXES[axis] && column == Vec3::AXES[axis]
    });
    let most = plastic_inverse
        .iter()
        .flat_map(|row| row.to_array())
        .fold(0.0f32, |most, k| most.max(k.abs()));
    is_flat && most < 100.0 && (volume - 1.0).abs() < 0.1
}

impl<D: Dim> Serialize for ElementBatches<D> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.to_be_saved().serialize(serializer)
    }
}

impl<'a, D: Dim> Deserialize<'a> for ElementBatches<D> {
    fn deserialize<S: Deserializer<'a>>(deserializer: S) -> Result<Self, S::Error> {
        let saved = SavedElementStates::deserialize(deserializer)?;
        let mut batches = Self::new(saved.law, &[], 0.0);
        batches.saved = Some(saved);
        Ok(batches)
    }
}
