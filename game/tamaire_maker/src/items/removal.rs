//! Removing items.

use super::{
    Item, existing, first_leader, holder_of_anchor, holder_of_knife, is_possible, with_followers,
};
use fuwafuwa_scenes::Scene;
use fuwafuwa_scenes::scene::{GameText, ObstacleText, RouteText, WishText};
use std::collections::BTreeSet;

/// Result of a removal.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Removed {
    /// Items that were removed, by their former indices: the chosen ones, and those that depend on them.
    pub(super) removed: Vec<Item>,
    /// Items that were kept, because a level requires them: the last body and the last hand that a player can move.
    pub refused: Vec<Item>,
    /// Rules of the level that cannot hold any more, and were removed or replaced.
    pub dropped: Vec<Dropped>,
}

/// Rule of a level that can no longer hold, because of a removal.
#[derive(Clone, Debug, PartialEq)]
pub enum Dropped {
    /// A goal.
    Goal(WishText),
    /// The condition without which the level is not won.
    Requirement(WishText),
    /// The stated routes of a level that has no basket any more.
    Routes(Vec<RouteText>),
    /// The list of the bodies that count for the level (`None`), for a basket or for a switch, by its former index. All
    /// bodies of the list were removed, so that all bodies of the level count from then on.
    Counted(Option<Item>),
}

/// Removes items and everything that depends on them: joints and knives on them, and hands that follow them. Numbers that
/// name later items follow. An obstacle whose switch is removed stays at rest, except if it has knives: then it moves
/// without a switch.
pub fn remove(scene: &mut Scene, items: &[Item]) -> Removed {
    let mut gone = existing(scene, items);
    let refused = refuse(scene, &mut gone);
    let mut gone = with_followers(scene, gone);
    add_dependents(scene, &mut gone);
    let emptied = emptied_lists(scene, &gone);
    let numbers = Numbers::without(scene, &gone);
    numbers.apply(scene);
    remove_entries(scene, &gone);
    let mut dropped = drop_rules(scene);
    dropped.extend(emptied);
    Removed {
        removed: gone.into_iter().collect(),
        refused,
        dropped,
    }
}

/// Takes the items that a level requires from those that are to be removed.
fn refuse(scene: &Scene, gone: &mut BTreeSet<Item>) -> Vec<Item> {
    let mut refused = Vec::new();
    let bodies = (0..scene.body.len()).map(Item::Body);
    if !scene.body.is_empty() && bodies.into_iter().all(|body| gone.contains(&body)) {
        refused.push(Item::Body(0));
    }
    let hands = scene.hand.iter().enumerate();
    let mut leaders = hands.filter(|(_, hand)| hand.follows.is_none());
    if leaders.all(|(index, _)| gone.contains(&Item::Hand(index))) {
        refused.extend(first_leader(scene).map(Item::Hand));
    }
    for item in &refused {
        gone.remove(item);
    }
    refused
}

/// Adds the joints and knives that hold to the items.
fn add_dependents(scene: &Scene, gone: &mut BTreeSet<Item>) {
    for (index, joint) in scene.joint.iter().enumerate() {
        let mut holders = joint.anchors.iter().filter_map(holder_of_anchor);
        if holders.any(|holder| gone.contains(&holder)) {
            gone.insert(Item::Joint(index));
        }
    }
    for (index, knife) in scene.knife.iter().enumerate() {
        if holder_of_knife(knife).is_some_and(|holder| gone.contains(&holder)) {
            gone.insert(Item::Knife(index));
        }
    }
}

/// Returns the lists of bodies that count, of which a removal leaves none. An empty list stands for all bodies.
fn emptied_lists(scene: &Scene, gone: &BTreeSet<Item>) -> Vec<Dropped> {
    let is_gone = |number: &usize| {
        let index = number.checked_sub(1);
        index.is_some_and(|index| gone.contains(&Item::Body(index)))
    };
    let is_emptied = |list: &[usize]| !list.is_empty() && list.iter().all(is_gone);
    let game = scene.game.as_ref();
    let level = game.map(|game| (None, &game.bodies));
    let baskets = game.into_iter().flat_map(|game| &game.baskets).enumerate();
    let baskets = baskets.map(|(index, basket)| (Some(Item::Basket(index)), &basket.bodies));
    let switches = scene.switch.iter().enumerate();
    let switches = switches.map(|(index, switch)| (Some(Item::Switch(index)), &switch.bodies));
    let lists = level.into_iter().chain(baskets).chain(switches);
    lists
        .filter(|(item, list)| item.is_none_or(|item| !gone.contains(&item)) && is_emptied(list))
        .map(|(item, _)| Dropped::Counted(item))
        .collect()
}

/// Numbers after a removal, by the index before it. `None` for what was removed.
struct Numbers {
    bodies: Vec<Option<usize>>,
    obstacles: Vec<Option<usize>>,
    hands: Vec<Option<usize>>,
    rigid_bodies: Vec<Option<usize>>,
    switches: Vec<Option<usize>>,
    gone: BTreeSet<Item>,
}

impl Numbers {
    fn without(scene: &Scene, gone: &BTreeSet<Item>) -> Self {
        let numbers = |count: usize, item: fn(usize) -> Item| {
            let mut number = 0;
            let numbers = (0..count).map(|index| {
                let stays = !gone.contains(&item(index));
                number += usize::from(stays);
                stays.then_some(number)
            });
            numbers.collect()
        };
        Self {
            bodies: numbers(scene.body.len(), Item::Body),
            obstacles: numbers(scene.obstacle.len(), Item::Obstacle),
            hands: numbers(scene.hand.len(), Item::Hand),
            rigid_bodies: numbers(scene.rigid_body.len(), Item::RigidBody),
            switches: numbers(scene.switch.len(), Item::Switch),
            gone: gone.clone(),
        }
    }

    /// Gives every number in a scene its new value. The lists are still those before the removal.
    fn apply(&self, scene: &mut Scene) {
        for anchor in scene.joint.iter_mut().flat_map(|joint| &mut joint.anchors) {
            follow(&mut anchor.body, &self.bodies);
            follow(&mut anchor.obstacle, &self.obstacles);
            follow(&mut anchor.hand, &self.hands);
            follow(&mut anchor.rigid_body, &self.rigid_bodies);
        }
        let mut armed = BTreeSet::new();
        for (index, knife) in scene.knife.iter_mut().enumerate() {
            if !self.gone.contains(&Item::Knife(index)) {
                armed.extend(knife.obstacle);
            }
            follow(&mut knife.obstacle, &self.obstacles);
            follow(&mut knife.hand, &self.hands);
            follow(&mut knife.rigid_body, &self.rigid_bodies);
        }
        for hand in &mut scene.hand {
            follow(&mut hand.follows, &self.hands);
        }
        for joint in &mut scene.joint {
            follow(&mut joint.switch, &self.switches);
        }
        for (index, obstacle) in scene.obstacle.iter_mut().enumerate() {
            let had_switch = obstacle.switch.is_some();
            follow(&mut obstacle.switch, &self.switches);
            if had_switch && obstacle.switch.is_none() && !armed.contains(&(index + 1)) {
                bring_to_rest(obstacle);
            }
        }
        for switch in &mut scene.switch {
            follow_all(&mut switch.bodies, &self.bodies);
        }
        if let Some(game) = &mut scene.game {
            self.apply_to_rules(game);
        }
    }

    fn apply_to_rules(&self, game: &mut GameText) {
        follow_all(&mut game.bodies, &self.bodies);
        for basket in &mut game.baskets {
            follow_all(&mut basket.bodies, &self.bodies);
            follow_all(&mut basket.refuses, &self.bodies);
        }
        for wish in game.wish.iter_mut().chain(&mut game.require) {
            follow_all(&mut wish.whole, &self.bodies);
        }
    }
}

/// Gives a number its new value.
fn follow(number: &mut Option<usize>, numbers: &[Option<usize>]) {
    let index = number.and_then(|number| number.checked_sub(1));
    if let Some(new) = index.and_then(|index| numbers.get(index)) {
        *number = *new;
    }
}

fn follow_all(list: &mut Vec<usize>, numbers: &[Option<usize>]) {
    list.retain_mut(|number| {
        let mut new = Some(*number);
        follow(&mut new, numbers);
        *number = new.unwrap_or(*number);
        new.is_some()
    });
}

/// Removes everything that moves an obstacle.
pub(super) fn bring_to_rest(obstacle: &mut ObstacleText) {
    obstacle.path.clear();
    obstacle.repeat = None;
    obstacle.angular_velocity = None;
    obstacle.pivot = None;
    (obstacle.max_force, obstacle.max_torque) = (None, None);
    obstacle.switch = None;
}

fn remove_entries(scene: &mut Scene, gone: &BTreeSet<Item>) {
    retain(&mut scene.body, |index| !gone.contains(&Item::Body(index)));
    retain(&mut scene.obstacle, |index| {
        !gone.contains(&Item::Obstacle(index))
    });
    retain(&mut scene.hand, |index| !gone.contains(&Item::Hand(index)));
    retain(&mut scene.rigid_body, |index| {
        !gone.contains(&Item::RigidBody(index))
    });
    retain(&mut scene.joint, |index| {
        !gone.contains(&Item::Joint(index))
    });
    retain(&mut scene.knife, |index| {
        !gone.contains(&Item::Knife(index))
    });
    retain(&mut scene.switch, |index| {
        !gone.contains(&Item::Switch(index))
    });
    retain(&mut scene.field, |index| {
        !gone.contains(&Item::Field(index))
    });
    let Some(game) = &mut scene.game else {
        return;
    };
    match game.basket {
        Some(_) if gone.contains(&Item::Basket(0)) => game.basket = None,
        Some(_) => {}
        None => retain(&mut game.baskets, |index| {
            !gone.contains(&Item::Basket(index))
        }),
    }
}

fn retain<T>(list: &mut Vec<T>, stays: impl Fn(usize) -> bool) {
    let mut index = 0;
    list.retain(|_| {
        index += 1;
        stays(index - 1)
    });
}

/// Removes the rules that cannot hold in a scene, and returns them.
fn drop_rules(scene: &mut Scene) -> Vec<Dropped> {
    let Some(mut game) = scene.game.take() else {
        return Vec::new();
    };
    let mut dropped = Vec::new();
    let (held, lost): (Vec<_>, Vec<_>) = game
        .wish
        .into_iter()
        .partition(|wish| is_possible(scene, wish));
    game.wish = held;
    dropped.extend(lost.into_iter().map(Dropped::Goal));
    if game
        .require
        .as_ref()
        .is_some_and(|wish| !is_possible(scene, wish))
    {
        dropped.extend(game.require.take().map(Dropped::Requirement));
    }
    let has_basket = game.basket.is_some() || !game.baskets.is_empty();
    if !has_basket && !game.routes.is_empty() {
        dropped.push(Dropped::Routes(std::mem::take(&mut game.routes)));
    }
    scene.game = Some(game);
    dropped
}
