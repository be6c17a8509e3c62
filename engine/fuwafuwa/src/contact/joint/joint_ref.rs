//! Read access to the joints of a world.

use super::{Joint, JointState};
use crate::foundation::dim::{Dim, DimVector};
use std::marker::PhantomData;

/// Joint of a world, for reading; see [`World::joint`](crate::World::joint).
#[derive(Copy, Clone, Debug)]
pub struct JointRef<'a, D: Dim> {
    state: &'a JointState,
    dim: PhantomData<D>,
}

impl<'a, D: Dim> JointRef<'a, D> {
    pub(crate) fn new(state: &'a JointState) -> Self {
        let dim = PhantomData;
        Self { state, dim }
    }

    /// Returns the joint as it was added. For the present positions of its anchors see
    /// [`World::joint_anchor_positions`](crate::World::joint_anchor_positions).
    pub fn definition(&self) -> Joint<D> {
        self.state.definition()
    }

    /// Returns the force on the first anchor in the last substep [N]. The force on the second anchor is opposite.
    /// While both bodies sleep, the last force is kept. If a soft body still vibrated when it fell asleep, the force
    /// differs from its weight by up to 15 %.
    pub fn reaction(&self) -> D::Vector {
        D::Vector::from_vec3(self.state.reaction())
    }

    /// Returns the magnitude of the joint force in the last substep [N].
    pub fn force(&self) -> f32 {
        self.state.force()
    }
}
