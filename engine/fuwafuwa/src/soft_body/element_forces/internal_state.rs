//! Internal state of the elements of a batch: plastic inverse and strains of the dashpots.

use crate::foundation::hash::{Hash, HashState};
use crate::math::lanes::{Eight, LANES};
use glam::Vec3;

/// Rows of the plastic inverse G = Fₚ⁻¹ of one element; Fₚ is the plastic part of the deformation gradient.
pub type PlasticInverse = [Vec3; 3];

/// Internal state of one element, which the history of its deformation determines.
#[derive(Copy, Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct InternalState {
    /// Plastic inverse; the identity without plastic deformation.
    pub plastic_inverse: PlasticInverse,
    /// Strains of the dashpots of the two terms of the Prony series: the components xx, yy, zz, xy, yz and zx.
    pub dashpots: [[f32; 6]; 2],
}

impl InternalState {
    /// State of an element that was never deformed.
    pub const NONE: Self = Self {
        plastic_inverse: Vec3::AXES,
        dashpots: [[0.0; 6]; 2],
    };

    /// Adds the state of an element to a hash. A part that is that of [`InternalState::NONE`] counts as missing.
    pub fn hash_of(state: Option<Self>, hash: &mut Hash) {
        let state = state.unwrap_or(Self::NONE);
        let plastic_inverse = Some(state.plastic_inverse);
        plastic_inverse
            .filter(|plastic_inverse| *plastic_inverse != Self::NONE.plastic_inverse)
            .hash_state(hash);
        if state.dashpots != Self::NONE.dashpots {
            let numbers = state.dashpots.as_flattened();
            numbers.iter().for_each(|number| number.hash_state(hash));
        }
    }
}

/// Internal state of the element in each lane of a batch.
#[derive(Clone, Debug, PartialEq)]
pub struct InternalLanes {
    /// Plastic inverses, by rows.
    pub plastic_inverse: [[Eight; 3]; 3],
    /// Strains of the dashpots.
    pub dashpots: [[Eight; 6]; 2],
}

impl InternalLanes {
    /// Returns the state of elements that were never deformed.
    pub fn none() -> Box<Self> {
        let rows = InternalState::NONE.plastic_inverse;
        Box::new(Self {
            plastic_inverse: rows.map(|row| row.to_array().map(|entry| [entry; LANES])),
            dashpots: [[[0.0; LANES]; 6]; 2],
        })
    }

    /// Returns the state of the element in a lane.
    pub fn get(&self, lane: usize) -> InternalState {
        let entries = |row: [Eight; 3]| Vec3::from(row.map(|entry| entry[lane]));
        InternalState {
            plastic_inverse: self.plastic_inverse.map(entries),
            dashpots: self.dashpots.map(|term| term.map(|entry| entry[lane])),
        }
    }

    /// Sets the state of the element in a lane.
    pub fn set(&mut self, lane: usize, state: InternalState) {
        let rows = state.plastic_inverse.map(|row| row.to_array());
        let numbers = rows.as_flattened().iter();
        let numbers = numbers.chain(state.dashpots.as_flattened());
        let entries = self.plastic_inverse.as_flattened_mut().iter_mut();
        let entries = entries.chain(self.dashpots.as_flattened_mut());
        for (entry, number) in entries.zip(numbers) {
            entry[lane] = *number;
        }
    }
}
