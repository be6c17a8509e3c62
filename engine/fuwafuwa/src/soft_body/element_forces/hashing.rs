//! Hash of the state of the element batches, for the hash of a world: the values that a snapshot stores, in the
//! same order.

use super::batch::{Batch, VACANT};
use super::internal_state::InternalState;
use super::{ElementBatches, parts};
use crate::foundation::dim::Dim;
use crate::foundation::hash::{Hash, HashState};

impl<D: Dim> HashState for ElementBatches<D> {
    fn hash_state(&self, hash: &mut Hash) {
        // Fields bound to `_` are not hashed. They follow from the mesh, the materials and the order of past
        // changes, and do not affect later states of the simulation.
        let Self {
            law,
            batches,
            assigned,
            forces,
            materials: _,
            voxel_size: _,
            open: _,
            empty: _,
            class_data_starts: _,
            class_data: _,
            pooled_class_data: _,
            slots: _,
            nodes: _,
            #[cfg(feature = "serde")]
                saved: _,
            dim: _,
        } = self;
        law.hash_state(hash);
        for (id, &(index, lane)) in assigned.entries() {
            if index == VACANT {
                continue;
            }
            let Batch {
                inverted,
                rotation,
                internal: _,
                node_count,
                key: _,
                elements: _,
                vacant: _,
                half_size: _,
                first_node: _,
                class_data_start: _,
                class_data_len: _,
            } = &batches[index as usize];
            for part in &rotation[..parts::<D>()] {
                part[lane as usize].hash_state(hash);
            }
            for node in 0..*node_count as usize {
                let own = &forces[self.force_range(index, lane, node)];
                own.iter().for_each(|force| force.hash_state(hash));
            }
            (inverted >> lane & 1 == 1).hash_state(hash);
            InternalState::hash_of(self.internal_state(id), hash);
        }
    }
}
