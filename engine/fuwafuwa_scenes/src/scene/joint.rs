//! Joints of a scene file.

use super::error::{FieldError, require, require_vector};
use fuwafuwa::{Dim, Joint, JointAnchor, JointKind, RigidBodyHandle, SoftBodyHandle, World};
use serde::{Deserialize, Serialize};

/// A `[[joint]]` table: two anchors and a joint kind.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct JointText {
    /// Joint kind.
    pub tie: JointKindText,
    /// The two anchors.
    pub ends: Vec<JointAnchorText>,
    /// Spring stiffness [N/m]; required for a spring.
    pub stiffness: Option<f32>,
    /// Spring damping [N s/m]; default 0.
    pub damping: Option<f32>,
    /// Rest length of a spring or maximum length of a rope [m]; required for both.
    pub length: Option<f32>,
    /// Force at which the joint breaks [N]; unbreakable if missing.
    pub breaking_force: Option<f32>,
}

/// Joint kind; see [`fuwafuwa::JointKind`].
#[derive(Copy, Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum JointKindText {
    /// The anchors coincide.
    Pin,
    /// A spring pulls or pushes the anchors towards a distance of `length`.
    Spring,
    /// The anchors are at most `length` apart.
    Rope,
}

/// A joint anchor on a body, an obstacle, a hand or a rigid body, named by its number from 1 in its list;
/// without any of them, a fixed point of the world.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct JointAnchorText {
    /// Number of a `[[body]]`.
    pub body: Option<usize>,
    /// Number of an `[[obstacle]]`.
    pub obstacle: Option<usize>,
    /// Number of a `[[hand]]`.
    pub hand: Option<usize>,
    /// Number of a `[[rigid]]`.
    pub rigid: Option<usize>,
    /// Position in the world [m].
    pub at: [f32; 3],
    /// Radius around `at` in which the nodes of a body are attached [m]; without nodes in it, the nearest
    /// node is attached.
    pub radius: Option<f32>,
}

/// Handles of possible joint targets, in the order of their lists.
pub(super) struct JointTargets {
    pub(super) bodies: Vec<SoftBodyHandle>,
    pub(super) obstacles: Vec<RigidBodyHandle>,
    pub(super) hands: Vec<RigidBodyHandle>,
    pub(super) rigids: Vec<RigidBodyHandle>,
}

impl JointText {
    pub(super) fn add_to<D: Dim>(
        &self,
        world: &mut World<D>,
        known: &JointTargets,
    ) -> Result<(), FieldError> {
        let [first, second] = &self.ends[..] else {
            let found = self.ends.len();
            return Err(FieldError::new(
                "ends",
                format!("expected two anchors, found {found}"),
            ));
        };
        let end = |index: usize, text: &JointAnchorText| {
            let end = text.end::<D>(known);
            end.map_err(|wrong| wrong.inside("ends", index))
        };
        let ends = [end(0, first)?, end(1, second)?];
        let mut joint = Joint::new(ends, self.tie()?);
        if let Some(force) = self.breaking_force {
            joint = joint.with_breaking_force(force);
        }
        let added = world.add_joint(joint);
        added
            .map(drop)
            .map_err(|refused| FieldError::new("tie", refused))
    }

    fn tie(&self) -> Result<JointKind, FieldError> {
        let missing = |field: &'static str| move || FieldError::new(field, "expected a number");
        let is = |tie| self.tie == tie;
        let good = is(JointKindText::Spring) || self.stiffness.is_none() && self.damping.is_none();
        require(good, "stiffness", "allowed only with tie = \"spring\"")?;
        let good = !is(JointKindText::Pin) || self.length.is_none();
        require(
            good,
            "length",
            "allowed only with tie = \"spring\" or \"rope\"",
        )?;
        Ok(match self.tie {
            JointKindText::Pin => JointKind::Pin,
            JointKindText::Rope => JointKind::Rope {
                length: self.length.ok_or_else(missing("length"))?,
            },
            JointKindText::Spring => JointKind::Spring {
                stiffness: self.stiffness.ok_or_else(missing("stiffness"))?,
                damping: self.damping.unwrap_or(0.0),
                length: self.length.ok_or_else(missing("length"))?,
            },
        })
    }

    /// Returns the text of a joint with the given anchors.
    pub(super) fn of(joint: &Joint, ends: [JointAnchorText; 2]) -> Self {
        let (tie, stiffness, damping, length) = match joint.tie {
            JointKind::Pin => (JointKindText::Pin, None, None, None),
            JointKind::Rope { length } => (JointKindText::Rope, None, None, Some(length)),
            JointKind::Spring {
                stiffness,
                damping,
                length,
            } => (
                JointKindText::Spring,
                Some(stiffness),
                Some(damping),
                Some(length),
            ),
        };
        let force = joint.breaking_force;
        Self {
            tie,
            ends: ends.into(),
            stiffness,
            damping,
            length,
            breaking_force: (force < f32::INFINITY).then_some(force),
        }
    }
}

impl JointAnchorText {
    fn end<D: Dim>(&self, known: &JointTargets) -> Result<JointAnchor, FieldError> {
        require_vector(D::N, "at", self.at)?;
        let at = self.at;
        let good = self.body.is_some() || self.radius.is_none();
        require(good, "radius", "allowed only with a body")?;
        let is_rigid = [
            ("obstacle", self.obstacle, &known.obstacles),
            ("hand", self.hand, &known.hands),
            ("rigid", self.rigid, &known.rigids),
        ];
        let named = is_rigid.iter().filter(|(_, number, _)| number.is_some());
        let count = named.clone().count() + usize::from(self.body.is_some());
        let expected = "expected at most one of body, obstacle, hand and rigid; none for a fixed point of the world";
        require(count <= 1, "body", expected)?;
        if let Some(number) = self.body {
            let body = nth("body", number, &known.bodies)?;
            let radius = self.radius.unwrap_or(0.0);
            return Ok(JointAnchor::SoftBody { body, at, radius });
        }
        for &(field, number, list) in &is_rigid {
            if let Some(number) = number {
                let rigid = nth(field, number, list)?;
                return Ok(JointAnchor::RigidBody { rigid, at });
            }
        }
        Ok(JointAnchor::Point(at))
    }
}

fn nth<T: Copy>(field: &str, number: usize, list: &[T]) -> Result<T, FieldError> {
    let count = list.len();
    let found = number.checked_sub(1).and_then(|index| list.get(index));
    let reason = || format!("expected 1 to {count}, found {number}");
    found
        .copied()
        .ok_or_else(|| FieldError::new(field, reason()))
}
