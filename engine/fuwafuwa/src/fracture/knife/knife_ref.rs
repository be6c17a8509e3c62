//! Read access to the knives of a world.

use super::{Knife, KnifeState};
use crate::foundation::dim::{Dim, DimAngular, DimVector};
use std::marker::PhantomData;

/// Knife of a world, for reading; see [`World::knife`](crate::World::knife).
#[derive(Copy, Clone, Debug)]
pub struct KnifeRef<'a, D: Dim> {
    state: &'a KnifeState,
    dim: PhantomData<D>,
}

impl<'a, D: Dim> KnifeRef<'a, D> {
    pub(crate) fn new(state: &'a KnifeState) -> Self {
        let dim = PhantomData;
        Self { state, dim }
    }

    /// Returns the knife as it was added.
    pub fn definition(&self) -> Knife<D> {
        self.state.definition()
    }

    /// Returns the force of the tissue on the knife in the last substep [N].
    pub fn force(&self) -> D::Vector {
        D::Vector::from_vec3(self.state.force())
    }

    /// Returns the torque of the tissue on the knife about the position of its holder in the last substep [N m].
    pub fn torque(&self) -> D::Angular {
        D::Angular::from_vec3(self.state.torque())
    }
}
