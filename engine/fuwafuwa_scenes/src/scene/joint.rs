//! Joints of a scene file.

use super::error::{FieldError, expected_number, require, vector_of};
use fuwafuwa::{Dim, Joint, JointAnchor, JointKind, RigidBodyHandle, SoftBodyHandle, World};
use serde::{Deserialize, Serialize};

/// A `[[joint]]` table: two anchors and a joint kind.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct JointText {
    /// Joint kind.
    #[serde(alias = "tie")]
    pub kind: JointKindText,
    /// The two anchors.
    #[serde(alias = "ends")]
    pub anchors: Vec<JointAnchorText>,
    /// Spring stiffness [N/m]; required for a spring.
    pub stiffness: Option<f32>,
    /// Spring damping [N s/m]; default 0.
    pub damping: Option<f32>,
    /// Rest length of a spring or maximum length of a rope [m]; required for both.
    pub length: Option<f32>,
    /// Force at which the joint breaks [N]; unbreakable if missing.
    pub breaking_force: Option<f32>,
    /// Number of a `[[switch]]` that removes the joint when it is on.
    pub switch: Option<usize>,
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

/// A joint anchor on a body, an obstacle, a hand or a rigid body, given by its number in its list, counted
/// from 1. Without any of these numbers, the anchor is a fixed point of the world.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct JointAnchorText {
    /// Number of a `[[body]]`.
    pub body: Option<usize>,
    /// Number of an `[[obstacle]]`.
    pub obstacle: Option<usize>,
    /// Number of a `[[hand]]`.
    pub hand: Option<usize>,
    /// Number of a `[[rigid_body]]`.
    #[serde(alias = "rigid")]
    pub rigid_body: Option<usize>,
    /// Position in the world [m].
    #[serde(alias = "at")]
    pub point: [f32; 3],
    /// Radius around `point` in which the nodes of a body are attached [m]. If no node is within the radius,
    /// the nearest node is attached.
    pub radius: Option<f32>,
}

/// Handles of possible targets of joints and holders of knives, in the order of their lists.
pub(super) struct SceneHandles {
    pub(super) bodies: Vec<SoftBodyHandle>,
    pub(super) obstacles: Vec<RigidBodyHandle>,
    pub(super) hands: Vec<RigidBodyHandle>,
    pub(super) rigid_bodies: Vec<RigidBodyHandle>,
}

impl SceneHandles {
    /// Returns the rigid body with the number of an obstacle, of a hand or of a rigid body, in this order, and the field
    /// of that number. `None` without a number.
    pub(super) fn numbered_rigid_body(
        &self,
        numbers: [Option<usize>; 3],
    ) -> Result<Option<(&'static str, RigidBodyHandle)>, FieldError> {
        let lists = [
            ("obstacle", &self.obstacles),
            ("hand", &self.hands),
            ("rigid_body", &self.rigid_bodies),
        ];
        let mut named = lists.into_iter().zip(numbers);
        let named = named.find_map(|((field, list), number)| Some((field, list, number?)));
        let body = named.map(|(field, list, number)| Ok((field, nth(field, number, list)?)));
        body.transpose()
    }
}

impl JointText {
    pub(super) fn add_to<D: Dim>(
        &self,
        world: &mut World<D>,
        known: &SceneHandles,
    ) -> Result<(), FieldError> {
        let [first, second] = &self.anchors[..] else {
            let found = self.anchors.len();
            return Err(FieldError::new(
                "anchors",
                format!("expected two anchors, found {found}"),
            ));
        };
        let anchor = |index: usize, text: &JointAnchorText| {
            let anchor = text.anchor::<D>(known);
            anchor.map_err(|wrong| wrong.inside("anchors", index))
        };
        let anchors = [anchor(0, first)?, anchor(1, second)?];
        let mut joint = Joint::new(anchors, self.kind()?);
        if let Some(force) = self.breaking_force {
            joint = joint.with_breaking_force(force);
        }
        let added = world.add_joint(joint);
        added
            .map(drop)
            .map_err(|refused| FieldError::engine("kind", refused))
    }

    fn kind(&self) -> Result<JointKind, FieldError> {
        let missing = |field: &'static str| move || FieldError::new(field, "expected a number");
        let is = |kind| self.kind == kind;
        let good = is(JointKindText::Spring) || self.stiffness.is_none() && self.damping.is_none();
        require(good, "stiffness", "allowed only with kind = \"spring\"")?;
        let good = !is(JointKindText::Pin) || self.length.is_none();
        require(
            good,
            "length",
            "allowed only with kind = \"spring\" or \"rope\"",
        )?;
        Ok(match self.kind {
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
    pub(super) fn of<D: Dim>(joint: &Joint<D>, anchors: [JointAnchorText; 2]) -> Self {
        let (kind, stiffness, damping, length) = match joint.kind {
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
            kind,
            anchors: anchors.into(),
            stiffness,
            damping,
            length,
            breaking_force: (force < f32::INFINITY).then_some(force),
            switch: None,
        }
    }
}

impl JointAnchorText {
    fn anchor<D: Dim>(&self, known: &SceneHandles) -> Result<JointAnchor<D>, FieldError> {
        let point = vector_of::<D>("point", self.point)?;
        let good = self.body.is_some() || self.radius.is_none();
        require(good, "radius", "allowed only with a body")?;
        let rigid = [self.obstacle, self.hand, self.rigid_body];
        let count = rigid.iter().flatten().count() + usize::from(self.body.is_some());
        let expected = "expected at most one of body, obstacle, hand and rigid_body; none for a fixed point of the world";
        require(count <= 1, "body", expected)?;
        if let Some(number) = self.body {
            let body = nth("body", number, &known.bodies)?;
            let radius = self.radius.unwrap_or(0.0);
            return Ok(JointAnchor::on(body, point).within(radius));
        }
        if let Some((_, body)) = known.numbered_rigid_body(rigid)? {
            return Ok(JointAnchor::on(body, point));
        }
        Ok(JointAnchor::Point(point))
    }
}

fn nth<T: Copy>(field: &str, number: usize, list: &[T]) -> Result<T, FieldError> {
    let found = number.checked_sub(1).and_then(|index| list.get(index));
    let reason = || expected_number(list.len(), number);
    found
        .copied()
        .ok_or_else(|| FieldError::new(field, reason()))
}
