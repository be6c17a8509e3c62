//! Knives of a scene file.

use super::error::{FieldError, require, vector_of};
use super::joint::SceneHandles;
use fuwafuwa::{Dim, DimVector, Knife, KnifeRef, World};
use serde::{Deserialize, Serialize};

/// A `[[knife]]` table: a cutting edge on a hand, a moving obstacle or a rigid body that follows a target, given by its
/// number in its list, counted from 1. Positions and directions are those at the start.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct KnifeText {
    /// Number of an `[[obstacle]]`.
    pub obstacle: Option<usize>,
    /// Number of a `[[hand]]`.
    pub hand: Option<usize>,
    /// Number of a `[[rigid_body]]`.
    pub rigid_body: Option<usize>,
    /// Ends of the edge in the world [m]. In 2D only their midpoint cuts.
    pub edge: [[f32; 3]; 2],
    /// Cutting direction, within 30° of a right angle to the edge. Its length, 0.01 to 100, has no effect.
    pub toward: [f32; 3],
    /// Radius of the edge [m], 0 (default, sharp) to 1. A dull edge requires more force.
    pub radius: Option<f32>,
    /// Height of the blade from the edge to its back [m], 0 to 10, default 0.02. The flat of the blade resists sideways
    /// motion.
    pub height: Option<f32>,
}

impl KnifeText {
    pub(super) fn add_to<D: Dim>(
        &self,
        world: &mut World<D>,
        known: &SceneHandles,
    ) -> Result<(), FieldError> {
        let numbers = [self.obstacle, self.hand, self.rigid_body];
        let count = numbers.iter().flatten().count();
        let expected = "expected one of obstacle, hand and rigid_body";
        require(count <= 1, "hand", expected)?;
        let holder = known.numbered_rigid_body(numbers)?;
        let (named, holder) = holder.ok_or_else(|| FieldError::new("hand", expected))?;
        let [from, to] = self.edge;
        let edge = [vector_of::<D>("edge", from)?, vector_of::<D>("edge", to)?];
        let toward = vector_of::<D>("toward", self.toward)?;
        let body = world.rigid_body(holder);
        let body = body.map_err(|error| FieldError::engine(named, error))?;
        let (place, back) = (body.position(), body.rotation().inverse());
        let edge = edge.map(|end| back.apply(end - place));
        let mut knife = Knife::new(holder, edge, back.apply(toward));
        knife.radius = self.radius.unwrap_or(knife.radius);
        knife.height = self.height.unwrap_or(knife.height);
        let refused = |error: fuwafuwa::Error| match error {
            // The engine names the handle; the file has a number.
            fuwafuwa::Error::InvalidParameter { field, .. } if field == "holder" => {
                let expected = "expected a hand, an obstacle with a path or an angular_velocity, or a kinematic or coupled \
                                rigid body";
                FieldError::new(named, expected)
            }
            error => FieldError::engine("edge", error),
        };
        world.add_knife(knife).map(drop).map_err(refused)
    }

    /// Returns the text of a knife in its present place. Returns `None` if its holder was removed.
    pub(super) fn of<D: Dim>(world: &World<D>, knife: KnifeRef<'_, D>) -> Option<Self> {
        let knife = knife.definition();
        let mut bodies = world.rigid_bodies().enumerate();
        let (number, (_, holder)) = bodies.find(|(_, (id, _))| *id == knife.holder)?;
        let (place, turn) = (holder.position(), holder.rotation());
        Some(Self {
            obstacle: None,
            hand: None,
            rigid_body: Some(number + 1),
            edge: { knife.edge }.map(|end| (place + turn.apply(end)).to_vec3().to_array()),
            toward: turn.apply(knife.toward).to_vec3().to_array(),
            radius: Some(knife.radius),
            height: Some(knife.height),
        })
    }
}
