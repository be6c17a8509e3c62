//! Everything that has a place in a level: what can be selected, moved, copied, removed and added.
//!
//! The operations keep a level playable: numbers that name other things follow, things that hold to moved ones move along,
//! and sizes and coordinates stay in their ranges. Through these operations, only three things can make a level unplayable:
//! bodies outside the view, more voxels than a level may have, and a name that is missing or too long.

mod additions;
mod arrangement;
mod bounds;
mod clip;
mod goals;
mod groups;
mod layers;
mod motion;
mod movement;
mod removal;
#[cfg(test)]
pub(crate) mod tests;
mod ties;

pub use additions::{Kind, add, add_to};
pub use arrangement::{Guide, aligned, free_place, snapped};
pub use bounds::{bounds, union};
pub use clip::{Clip, copy, paste};
pub use groups::group_of;
use groups::is_pinned;
pub use layers::{Stops, set_stops, stops_of};
pub use movement::{rotate, stretch, translate};
pub use removal::{Dropped, Removed, remove};
pub use ties::{ends_of, first_hit, holder_at, tie_again, tie_end};

use fuwafuwa::Vec3;
use fuwafuwa_scenes::Scene;
use fuwafuwa_scenes::scene::{
    Form, HandText, JointAnchorText, JointKindText, KnifeText, MotionTypeText,
};
use goals::is_possible;
use std::collections::{BTreeMap, BTreeSet};
use tamaire_play::playground::Stuff;

/// Maximum absolute coordinate of the middle of an item [m]. It is the limit of the view of a level.
pub const MAX_COORDINATE: f32 = 3.9;

/// Something that has a place in a level, by its index in its list, counted from 0.
#[derive(Copy, Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Item {
    /// Soft body.
    Body(usize),
    /// Obstacle.
    Obstacle(usize),
    /// Hand of a player, or a part of it.
    Hand(usize),
    /// Rigid body.
    RigidBody(usize),
    /// Rope, spring or pin.
    Joint(usize),
    /// Knife.
    Knife(usize),
    /// Switch.
    Switch(usize),
    /// Field of acceleration.
    Field(usize),
    /// Basket. Index 0 is `game.basket` if it is set; otherwise the indices are those of `game.baskets`.
    Basket(usize),
}

/// Returns all items of a scene, in the order of [`Item`].
pub fn items(scene: &Scene) -> Vec<Item> {
    let all = (0..scene.body.len()).map(Item::Body);
    let all = all.chain((0..scene.obstacle.len()).map(Item::Obstacle));
    let all = all.chain((0..scene.hand.len()).map(Item::Hand));
    let all = all.chain((0..scene.rigid_body.len()).map(Item::RigidBody));
    let all = all.chain((0..scene.joint.len()).map(Item::Joint));
    let all = all.chain((0..scene.knife.len()).map(Item::Knife));
    let all = all.chain((0..scene.switch.len()).map(Item::Switch));
    let all = all.chain((0..scene.field.len()).map(Item::Field));
    all.chain((0..basket_count(scene)).map(Item::Basket))
        .collect()
}

impl Item {
    /// Returns the number of the item in its list, counted from 1.
    pub fn number(self) -> usize {
        let (Self::Body(index)
        | Self::Obstacle(index)
        | Self::Hand(index)
        | Self::RigidBody(index)
        | Self::Joint(index)
        | Self::Knife(index)
        | Self::Switch(index)
        | Self::Field(index)
        | Self::Basket(index)) = self;
        index + 1
    }

    /// Returns whether a scene has the item.
    fn is_in(self, scene: &Scene) -> bool {
        match self {
            Self::Body(index) => index < scene.body.len(),
            Self::Obstacle(index) => index < scene.obstacle.len(),
            Self::Hand(index) => index < scene.hand.len(),
            Self::RigidBody(index) => index < scene.rigid_body.len(),
            Self::Joint(index) => index < scene.joint.len(),
            Self::Knife(index) => index < scene.knife.len(),
            Self::Switch(index) => index < scene.switch.len(),
            Self::Field(index) => index < scene.field.len(),
            Self::Basket(index) => index < basket_count(scene),
        }
    }
}

/// Returns the kind of an item by what it is now; `None` for a hand, and for an item that the scene does not have.
pub fn kind_of(scene: &Scene, item: Item) -> Option<Kind> {
    match item {
        Item::Body(index) => scene.body.get(index).map(|body| {
            let form = body.shape.unwrap_or(Form::Ball);
            Kind::Body(form, Stuff::Jelly)
        }),
        Item::Obstacle(index) => kind_of_obstacle(scene, index),
        Item::Hand(_) => None,
        Item::RigidBody(index) => scene
            .rigid_body
            .get(index)
            .map(|text| match text.motion_type {
                // A box of an obstacle that was turned.
                MotionTypeText::Fixed => Kind::Wall,
                _ if is_pinned(scene, item) => Kind::SeeSaw,
                _ => Kind::Plank,
            }),
        Item::Joint(index) => scene.joint.get(index).map(|joint| match joint.kind {
            JointKindText::Rope => Kind::Rope,
            JointKindText::Spring => Kind::Spring,
            JointKindText::Pin => Kind::Pin,
        }),
        Item::Knife(index) => scene.knife.get(index).map(|_| Kind::Knife),
        Item::Switch(index) => scene.switch.get(index).map(|_| Kind::Button),
        Item::Field(index) => scene
            .field
            .get(index)
            .map(|field| match field.acceleration {
                Some(_) => Kind::Wind,
                None => Kind::Planet,
            }),
        Item::Basket(_) => item.is_in(scene).then_some(Kind::Basket),
    }
}

fn kind_of_obstacle(scene: &Scene, index: usize) -> Option<Kind> {
    let text = scene.obstacle.get(index)?;
    let mut knives = scene.knife.iter();
    let has_knife = knives.any(|knife| knife.obstacle == Some(index + 1));
    Some(match stops_of(scene, index) {
        _ if text.angular_velocity.is_some() && has_knife => Kind::Saw,
        _ if !text.path.is_empty() && has_knife => Kind::Knife,
        _ if text.angular_velocity.is_some() => Kind::Paddle,
        _ if !text.path.is_empty() && text.switch.is_some() => Kind::Door,
        _ if !text.path.is_empty() => Kind::Lift,
        Some(Stops::Hands) => Kind::Glass,
        Some(Stops::Bodies) => Kind::Curtain,
        _ if text.ball.is_some() => Kind::Ball,
        _ if text.capsule.is_some() => Kind::Bar,
        _ => Kind::Wall,
    })
}

/// Returns the number of each item among the items of its kind, counted from 1. Walls without an end, which cannot be seen
/// in the editor, are counted apart.
pub fn numbers(scene: &Scene) -> BTreeMap<Item, usize> {
    let mut counts = BTreeMap::new();
    let mut numbers = BTreeMap::new();
    for item in items(scene) {
        let kind = match kind_of(scene, item) {
            Some(Kind::Body(..)) => Some(Kind::Body(Form::Ball, Stuff::Jelly)),
            kind => kind,
        };
        let is_plane = match item {
            Item::Obstacle(index) => scene.obstacle[index].half_space.is_some(),
            Item::RigidBody(index) => scene.rigid_body[index].half_space.is_some(),
            _ => false,
        };
        let kind = kind.and_then(|kind| Kind::ALL.iter().position(|known| *known == kind));
        let count = counts.entry((kind, is_plane)).or_insert(0);
        *count += 1;
        numbers.insert(item, *count);
    }
    numbers
}

/// Returns those of the items that the scene has, without repetitions.
fn existing(scene: &Scene, items: &[Item]) -> BTreeSet<Item> {
    let items = items.iter().copied();
    items.filter(|item| item.is_in(scene)).collect()
}

/// Returns the items, with the hands that follow the hands among them.
fn with_followers(scene: &Scene, mut items: BTreeSet<Item>) -> BTreeSet<Item> {
    for (index, hand) in scene.hand.iter().enumerate() {
        if leader_of(hand).is_some_and(|leader| items.contains(&Item::Hand(leader))) {
            items.insert(Item::Hand(index));
        }
    }
    items
}

/// Returns the index of the hand that a hand follows.
fn leader_of(hand: &HandText) -> Option<usize> {
    hand.follows?.checked_sub(1)
}

/// Returns the index of the first hand that follows no other one.
fn first_leader(scene: &Scene) -> Option<usize> {
    scene.hand.iter().position(|hand| hand.follows.is_none())
}

/// Returns the item to which an anchor holds; `None` for a fixed point.
fn holder_of_anchor(anchor: &JointAnchorText) -> Option<Item> {
    numbered(anchor.body, Item::Body)
        .or_else(|| numbered(anchor.obstacle, Item::Obstacle))
        .or_else(|| numbered(anchor.hand, Item::Hand))
        .or_else(|| numbered(anchor.rigid_body, Item::RigidBody))
}

/// Returns the item to which a knife is fixed.
fn holder_of_knife(knife: &KnifeText) -> Option<Item> {
    numbered(knife.obstacle, Item::Obstacle)
        .or_else(|| numbered(knife.hand, Item::Hand))
        .or_else(|| numbered(knife.rigid_body, Item::RigidBody))
}

/// Returns the item with a number in its list, counted from 1.
fn numbered(number: Option<usize>, item: fn(usize) -> Item) -> Option<Item> {
    number?.checked_sub(1).map(item)
}

/// Returns the number of hands that follow no other one.
fn player_count(scene: &Scene) -> usize {
    let leaders = scene.hand.iter().filter(|hand| hand.follows.is_none());
    leaders.count()
}

fn basket_count(scene: &Scene) -> usize {
    match &scene.game {
        Some(game) if game.basket.is_some() => 1,
        Some(game) => game.baskets.len(),
        None => 0,
    }
}

/// Returns the centre and the half widths of a basket.
fn basket(scene: &Scene, index: usize) -> Option<([f32; 3], [f32; 3])> {
    let game = scene.game.as_ref()?;
    match &game.basket {
        Some(only) => (index == 0).then_some((only.centre, only.half)),
        None => game
            .baskets
            .get(index)
            .map(|basket| (basket.centre, basket.half)),
    }
}

fn basket_mut(scene: &mut Scene, index: usize) -> Option<(&mut [f32; 3], &mut [f32; 3])> {
    let game = scene.game.as_mut()?;
    match &mut game.basket {
        Some(only) => (index == 0).then_some((&mut only.centre, &mut only.half)),
        None => {
            let basket = game.baskets.get_mut(index);
            basket.map(|basket| (&mut basket.centre, &mut basket.half))
        }
    }
}

/// Returns the vector with a third coordinate of 0 in 2D.
fn flat(dim: u8, vector: Vec3) -> Vec3 {
    match dim {
        2 => vector.with_z(0.0),
        _ => vector,
    }
}

/// Rounds a coordinate to 0.01 mm, so that it has few digits in the text of the level.
fn rounded(number: f32) -> f32 {
    // The sum turns −0 into 0.
    ((f64::from(number) * 1e5).round() / 1e5) as f32 + 0.0
}
