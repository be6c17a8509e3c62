//! Things that belong together: a basket and its bars, a board and its pins, a saw and its teeth.

use super::{
    Item, Kind, basket_count, bounds, existing, holder_of_anchor, holder_of_knife, kind_of,
};
use fuwafuwa::Vec3;
use fuwafuwa_scenes::Scene;
use fuwafuwa_scenes::scene::{JointKindText, JointText};

/// Distance up to which a bar touches the basket that it encloses [m].
const TOUCHES: f32 = 0.06;
/// Length by which a bar may be longer than its basket [m].
const LONGER: f32 = 0.4;

/// Returns the things that belong together with an item, the main one first: a basket and the bars that enclose it; a body
/// or a board, the pins that hold it to a place, and what they are fixed to; or whatever carries knives, and its knives. Any
/// other item is alone.
pub fn group_of(scene: &Scene, item: Item) -> Vec<Item> {
    if existing(scene, &[item]).is_empty() {
        return Vec::new();
    }
    let main = main_of(scene, item);
    let mut all = vec![main];
    all.extend(bars_of(scene, main));
    all.extend(knives_of(scene, main));
    all.extend(pins_of(scene, main));
    all.extend(supports_of(scene, main));
    all
}

/// Returns the main item of the group to which an item belongs.
fn main_of(scene: &Scene, item: Item) -> Item {
    let found = match item {
        Item::Obstacle(_) => {
            let baskets = (0..basket_count(scene)).map(Item::Basket);
            let boards = (0..scene.rigid_body.len()).map(Item::RigidBody);
            let mut found = baskets.filter(|&basket| bars_of(scene, basket).contains(&item));
            let mut board = boards.filter(|&board| supports_of(scene, board).contains(&item));
            found.next().or_else(|| board.next())
        }
        Item::Knife(index) => scene.knife.get(index).and_then(holder_of_knife),
        Item::Joint(index) => scene
            .joint
            .get(index)
            .and_then(|joint| pinned(scene, joint)),
        _ => None,
    };
    found.unwrap_or(item)
}

/// Returns the walls and bars that enclose a basket.
fn bars_of(scene: &Scene, item: Item) -> Vec<Item> {
    let (Item::Basket(_), Some([low, high])) = (item, bounds(scene, item)) else {
        return Vec::new();
    };
    let reach = Vec3::splat(TOUCHES);
    let encloses = |&bar: &Item| {
        let Some([from, to]) = bounds(scene, bar) else {
            return false;
        };
        let is_still = matches!(kind_of(scene, bar), Some(Kind::Bar | Kind::Wall));
        let touches = from.cmple(high + reach).all() && to.cmpge(low - reach).all();
        is_still && touches && (to - from).cmple(high - low + LONGER).all()
    };
    let all = (0..scene.obstacle.len()).map(Item::Obstacle);
    all.filter(encloses).collect()
}

/// Returns whether an item encloses a basket.
fn is_bar(scene: &Scene, item: Item) -> bool {
    let mut baskets = (0..basket_count(scene)).map(Item::Basket);
    baskets.any(|basket| bars_of(scene, basket).contains(&item))
}

/// Returns the knives that an item carries.
fn knives_of(scene: &Scene, item: Item) -> impl Iterator<Item = Item> {
    let knives = scene.knife.iter().enumerate();
    let held = knives.filter(move |(_, knife)| holder_of_knife(knife) == Some(item));
    held.map(|(index, _)| Item::Knife(index))
}

/// Returns the pins that hold an item to a place.
fn pins_of(scene: &Scene, item: Item) -> impl Iterator<Item = Item> {
    let joints = scene.joint.iter().enumerate();
    let held = joints.filter(move |(_, joint)| pinned(scene, joint) == Some(item));
    held.map(|(index, _)| Item::Joint(index))
}

/// Returns whether pins hold an item to a place.
pub(super) fn is_pinned(scene: &Scene, item: Item) -> bool {
    pins_of(scene, item).next().is_some()
}

/// Returns the small obstacles to which the pins of an item are fixed. The bars of a basket belong to the basket.
fn supports_of(scene: &Scene, item: Item) -> Vec<Item> {
    let pins = scene.joint.iter();
    let pins = pins.filter(|joint| pinned(scene, joint) == Some(item));
    let ends = pins.flat_map(|joint| &joint.anchors);
    let mut found: Vec<Item> = ends
        .filter_map(holder_of_anchor)
        .filter(|&end| end != item && !is_bar(scene, end))
        .collect();
    found.sort_unstable();
    found.dedup();
    found
}

/// Returns the body or board that a pin holds to a place: to a fixed point, or to an obstacle that is no larger.
fn pinned(scene: &Scene, joint: &JointText) -> Option<Item> {
    if joint.kind != JointKindText::Pin {
        return None;
    }
    let ends = joint.anchors.iter().map(holder_of_anchor);
    let is_held = |item: &Item| matches!(item, Item::Body(_) | Item::RigidBody(_));
    let held = ends.clone().flatten().find(is_held)?;
    let mut others = ends.flatten().filter(|&end| end != held);
    others
        .all(|end| is_support(scene, end, held))
        .then_some(held)
}

/// Returns whether an item is a fixed obstacle that is no larger than another item.
fn is_support(scene: &Scene, item: Item, held: Item) -> bool {
    let Item::Obstacle(_) = item else {
        return false;
    };
    let is_still = matches!(
        kind_of(scene, item),
        Some(Kind::Bar | Kind::Wall | Kind::Ball)
    );
    let length = |item| bounds(scene, item).map(|[low, high]| (high - low).max_element());
    let sizes = length(item).zip(length(held));
    is_still && sizes.is_some_and(|(support, board)| support <= board)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::draft::Draft;
    use crate::items::{Kind, add};
    use fuwafuwa_scenes::scene::JointAnchorText;

    #[test]
    fn bar_of_a_basket_is_no_support_of_a_board_that_is_pinned_to_it() {
        for is_in_basket in [false, true] {
            let mut scene = Draft::blank(2).scene().clone();
            let board = add(&mut scene, Kind::SeeSaw, Vec3::ZERO);
            let kind = if is_in_basket {
                Kind::Basket
            } else {
                Kind::Bar
            };
            let enclosed = add(&mut scene, kind, Vec3::ZERO);
            let &bar = enclosed.last().unwrap();
            let Item::Obstacle(index) = bar else {
                panic!("{bar:?}");
            };
            assert_eq!(group_of(&scene, board[0]), board);
            scene.joint[0].anchors[0] = JointAnchorText {
                obstacle: Some(index + 1),
                ..scene.joint[0].anchors[0].clone()
            };
            let with_bar: Vec<Item> = board.iter().copied().chain([bar]).collect();
            let expected = match is_in_basket {
                true => [board.clone(), enclosed],
                false => [with_bar.clone(), with_bar],
            };
            assert_eq!([board[0], bar].map(|item| group_of(&scene, item)), expected);
        }
    }
}
