//! Copying and pasting.

use super::removal::bring_to_rest;
use super::{
    Item, existing, first_leader, holder_of_anchor, holder_of_knife, player_count, translate,
    with_followers,
};
use crate::palette::renumbered_runs;
use fuwafuwa::Vec3;
use fuwafuwa_scenes::Scene;
use fuwafuwa_scenes::scene::{
    BasketText, BodyText, BoxText, FieldText, Form, HandText, JointText, KnifeText, MAX_BODIES,
    MAX_MATERIALS, MAX_RIGID, MaterialText, ObstacleText, RigidBodyText, SwitchText,
};
use std::collections::{BTreeMap, BTreeSet};
use tamaire_play::PLAYERS;

/// Maximum number of baskets in a level. The private constant `MAX_BASKETS` in `scene/game.rs` of `fuwafuwa_scenes` has the
/// same value.
pub(super) const MAX_BASKETS: usize = 8;

/// Copied items. Their numbers are those of the scene from which they were copied.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Clip {
    dim: u8,
    materials: Vec<MaterialText>,
    bodies: Vec<(usize, CopiedBody)>,
    obstacles: Vec<(usize, ObstacleText)>,
    hands: Vec<(usize, HandText)>,
    rigid_bodies: Vec<(usize, RigidBodyText)>,
    joints: Vec<JointText>,
    knives: Vec<KnifeText>,
    switches: Vec<(usize, SwitchText)>,
    fields: Vec<FieldText>,
    baskets: Vec<BasketText>,
}

#[derive(Clone, Debug, PartialEq)]
struct CopiedBody {
    text: BodyText,
    /// Whether the body counts for the baskets of its level.
    counts: bool,
}

impl Clip {
    /// Returns the number of dimensions of the scene from which the items were copied.
    pub fn dim(&self) -> u8 {
        self.dim
    }
}

/// Copies items. Joints and knives come along if everything that they hold to does, and hands that follow a copied one. A
/// body that is given by its state is not copied, because it cannot be moved.
pub fn copy(scene: &Scene, items: &[Item]) -> Clip {
    let chosen = with_followers(scene, existing(scene, items));
    let indices = |item: fn(usize) -> Item, count: usize| {
        let chosen = &chosen;
        (0..count).filter(move |index| chosen.contains(&item(*index)))
    };
    let bodies = indices(Item::Body, scene.body.len());
    let bodies = bodies.filter(|index| scene.body[*index].state.is_none());
    let bodies = bodies.map(|index| (index, copied_body(scene, index)));
    let joints = scene
        .joint
        .iter()
        .filter(|joint| comes_along(joint, &chosen));
    let knives = scene
        .knife
        .iter()
        .filter(|knife| holder_of_knife(knife).is_some_and(|holder| chosen.contains(&holder)));
    Clip {
        dim: scene.dim,
        materials: scene.material.clone(),
        bodies: bodies.collect(),
        obstacles: indices(Item::Obstacle, scene.obstacle.len())
            .map(|index| (index, scene.obstacle[index].clone()))
            .collect(),
        hands: indices(Item::Hand, scene.hand.len())
            .map(|index| (index, scene.hand[index].clone()))
            .collect(),
        rigid_bodies: indices(Item::RigidBody, scene.rigid_body.len())
            .map(|index| (index, scene.rigid_body[index].clone()))
            .collect(),
        joints: joints.cloned().collect(),
        knives: knives.cloned().collect(),
        switches: indices(Item::Switch, scene.switch.len())
            .map(|index| (index, scene.switch[index].clone()))
            .collect(),
        fields: indices(Item::Field, scene.field.len())
            .map(|index| scene.field[index].clone())
            .collect(),
        baskets: copied_baskets(scene, &chosen),
    }
}

fn copied_body(scene: &Scene, index: usize) -> CopiedBody {
    let counting = scene.game.as_ref().map_or(&[][..], |game| &game.bodies);
    CopiedBody {
        text: scene.body[index].clone(),
        counts: counting.is_empty() || counting.contains(&(index + 1)),
    }
}

/// Returns whether a joint holds only to copied items and fixed points.
fn comes_along(joint: &JointText, chosen: &BTreeSet<Item>) -> bool {
    let mut holders = joint.anchors.iter().filter_map(holder_of_anchor);
    holders.clone().count() > 0 && holders.all(|holder| chosen.contains(&holder))
}

fn copied_baskets(scene: &Scene, chosen: &BTreeSet<Item>) -> Vec<BasketText> {
    let Some(game) = &scene.game else {
        return Vec::new();
    };
    let all = match &game.basket {
        Some(only) => vec![plain_basket(only)],
        None => game.baskets.clone(),
    };
    let all = all.into_iter().enumerate();
    let chosen = all.filter(|(index, _)| chosen.contains(&Item::Basket(*index)));
    chosen.map(|(_, basket)| basket).collect()
}

fn plain_basket(region: &BoxText) -> BasketText {
    BasketText {
        centre: region.centre,
        half: region.half,
        ..BasketText::default()
    }
}

/// Adds copied items to a scene, moved by a vector [m]. Returns the new items; none if the scene has another dimension.
///
/// The materials of bodies are added, except those that the scene has already. An item is not pasted if a level cannot have
/// it: a hand of a third player, an entry of a list that is full, and a joint or a knife on an item that was not pasted. A
/// switch, a body or a hand that was not copied is replaced by the one with the same number, if there is one.
pub fn paste(scene: &mut Scene, clip: &Clip, by: Vec3) -> Vec<Item> {
    if clip.dim != scene.dim || !by.is_finite() {
        return Vec::new();
    }
    let mut pasting = Pasting {
        counts: [scene.body.len(), scene.switch.len()],
        ..Pasting::default()
    };
    pasting.bodies(scene, clip);
    pasting.switches(scene, clip);
    pasting.obstacles(scene, clip);
    pasting.rigid_bodies(scene, clip);
    pasting.hands(scene, clip);
    pasting.joints(scene, clip);
    pasting.knives(scene, clip);
    pasting.others(scene, clip);
    translate(scene, &pasting.made, by);
    pasting.made
}

/// State of a paste.
#[derive(Default)]
struct Pasting {
    made: Vec<Item>,
    /// Items in the scene by the items of which they are copies.
    copies: BTreeMap<Item, Item>,
    /// Numbers of bodies and switches in the scene before the paste.
    counts: [usize; 2],
}

impl Pasting {
    fn add(&mut self, original: Item, copy: Item) {
        self.copies.insert(original, copy);
        self.made.push(copy);
    }

    /// Returns the number of a copy by the number of its original.
    fn copy_of(&self, number: usize, item: fn(usize) -> Item) -> Option<usize> {
        let original = item(number.checked_sub(1)?);
        self.copies.get(&original).map(|copy| copy.number())
    }

    /// Returns the number of a copy, or the same number if there were as many in the scene before.
    fn copy_or_same(&self, number: usize, item: fn(usize) -> Item, count: usize) -> Option<usize> {
        let same = Some(number).filter(|number| (1..=count).contains(number));
        self.copy_of(number, item).or(same)
    }

    fn switch(&self, number: Option<usize>) -> Option<usize> {
        self.copy_or_same(number?, Item::Switch, self.counts[1])
    }

    fn bodies_in(&self, numbers: &[usize]) -> Vec<usize> {
        let new = numbers.iter();
        let new = new.filter_map(|number| self.copy_or_same(*number, Item::Body, self.counts[0]));
        let new: BTreeSet<usize> = new.collect();
        new.into_iter().collect()
    }

    fn bodies(&mut self, scene: &mut Scene, clip: &Clip) {
        for (index, body) in &clip.bodies {
            if scene.body.len() >= MAX_BODIES {
                return;
            }
            let Some(text) = with_materials_of(scene, &body.text, &clip.materials) else {
                continue;
            };
            scene.body.push(text);
            let number = scene.body.len();
            self.add(Item::Body(*index), Item::Body(number - 1));
            let game = scene.game.as_mut().filter(|game| !game.bodies.is_empty());
            if let Some(game) = game.filter(|_| body.counts) {
                game.bodies.push(number);
            }
        }
    }

    fn switches(&mut self, scene: &mut Scene, clip: &Clip) {
        for (index, text) in &clip.switches {
            if scene.switch.len() < MAX_RIGID {
                let mut text = text.clone();
                text.bodies = self.bodies_in(&text.bodies);
                scene.switch.push(text);
                self.add(Item::Switch(*index), Item::Switch(scene.switch.len() - 1));
            }
        }
    }

    fn obstacles(&mut self, scene: &mut Scene, clip: &Clip) {
        for (index, text) in &clip.obstacles {
            if scene.obstacle.len() >= MAX_RIGID {
                return;
            }
            let mut text = text.clone();
            let had_switch = text.switch.is_some();
            text.switch = self.switch(text.switch);
            let is_armed = clip
                .knives
                .iter()
                .any(|knife| knife.obstacle == Some(index + 1));
            if had_switch && text.switch.is_none() && !is_armed {
                bring_to_rest(&mut text);
            }
            scene.obstacle.push(text);
            self.add(
                Item::Obstacle(*index),
                Item::Obstacle(scene.obstacle.len() - 1),
            );
        }
    }

    fn rigid_bodies(&mut self, scene: &mut Scene, clip: &Clip) {
        for (index, text) in &clip.rigid_bodies {
            if scene.rigid_body.len() < MAX_RIGID && text.state.is_none() {
                scene.rigid_body.push(text.clone());
                self.add(
                    Item::RigidBody(*index),
                    Item::RigidBody(scene.rigid_body.len() - 1),
                );
            }
        }
    }

    /// Adds hands of players first, because the others follow them.
    fn hands(&mut self, scene: &mut Scene, clip: &Clip) {
        let (leaders, followers): (Vec<_>, Vec<_>) = clip
            .hands
            .iter()
            .partition(|(_, text)| text.follows.is_none());
        for (index, text) in leaders {
            if player_count(scene) < PLAYERS && scene.hand.len() < MAX_RIGID {
                scene.hand.push(text.clone());
                self.add(Item::Hand(*index), Item::Hand(scene.hand.len() - 1));
            }
        }
        for (index, text) in followers {
            let Some(leader) = self.leader(scene, clip, text) else {
                continue;
            };
            if scene.hand.len() < MAX_RIGID {
                let follows = Some(leader);
                scene.hand.push(HandText {
                    follows,
                    ..text.clone()
                });
                self.add(Item::Hand(*index), Item::Hand(scene.hand.len() - 1));
            }
        }
    }

    /// Returns the number of the hand that a copied hand follows. `None` if that hand was copied and had no place.
    fn leader(&self, scene: &Scene, clip: &Clip, text: &HandText) -> Option<usize> {
        let number = text.follows?;
        let was_copied = clip.hands.iter().any(|(index, _)| index + 1 == number);
        if was_copied {
            return self.copy_of(number, Item::Hand);
        }
        let same = number
            .checked_sub(1)
            .and_then(|index| scene.hand.get(index));
        let same = same.filter(|hand| hand.follows.is_none()).map(|_| number);
        same.or_else(|| first_leader(scene).map(|index| index + 1))
    }

    fn joints(&mut self, scene: &mut Scene, clip: &Clip) {
        for text in &clip.joints {
            let mut text = text.clone();
            let mut anchors = text.anchors.iter_mut();
            let all_held = anchors.all(|anchor| {
                self.holds(&mut anchor.body, Item::Body)
                    && self.holds(&mut anchor.obstacle, Item::Obstacle)
                    && self.holds(&mut anchor.hand, Item::Hand)
                    && self.holds(&mut anchor.rigid_body, Item::RigidBody)
            });
            if all_held && scene.joint.len() < MAX_RIGID {
                text.switch = self.switch(text.switch);
                scene.joint.push(text);
                self.made.push(Item::Joint(scene.joint.len() - 1));
            }
        }
    }

    fn knives(&mut self, scene: &mut Scene, clip: &Clip) {
        for text in &clip.knives {
            let mut text = text.clone();
            let is_held = self.holds(&mut text.obstacle, Item::Obstacle)
                && self.holds(&mut text.hand, Item::Hand)
                && self.holds(&mut text.rigid_body, Item::RigidBody);
            if is_held && scene.knife.len() < MAX_RIGID {
                scene.knife.push(text);
                self.made.push(Item::Knife(scene.knife.len() - 1));
            }
        }
    }

    /// Replaces the number of an original by that of its copy. Returns whether there is a copy, or no number.
    fn holds(&self, number: &mut Option<usize>, item: fn(usize) -> Item) -> bool {
        let Some(original) = *number else {
            return true;
        };
        *number = self.copy_of(original, item);
        number.is_some()
    }

    fn others(&mut self, scene: &mut Scene, clip: &Clip) {
        for text in &clip.fields {
            if scene.field.len() < MAX_RIGID {
                scene.field.push(text.clone());
                self.made.push(Item::Field(scene.field.len() - 1));
            }
        }
        for text in &clip.baskets {
            let basket = BasketText {
                bodies: self.bodies_in(&text.bodies),
                refuses: self.bodies_in(&text.refuses),
                ..text.clone()
            };
            self.made.extend(add_basket(scene, basket));
        }
    }
}

/// Adds a basket to a level. A second one turns `game.basket` into `game.baskets`. Returns `None` if the scene is no level
/// or has as many baskets as a level may have.
pub(super) fn add_basket(scene: &mut Scene, basket: BasketText) -> Option<Item> {
    let game = scene.game.as_mut()?;
    if game.baskets.len() >= MAX_BASKETS {
        return None;
    }
    let (centre, half) = (basket.centre, basket.half);
    let is_plain = basket == plain_basket(&BoxText { centre, half });
    if game.basket.is_none() && game.baskets.is_empty() && is_plain {
        game.basket = Some(BoxText { centre, half });
        return Some(Item::Basket(0));
    }
    game.baskets
        .extend(game.basket.take().as_ref().map(plain_basket));
    game.baskets.push(basket);
    Some(Item::Basket(game.baskets.len() - 1))
}

/// Returns the body with the numbers that its materials have in a scene. Adds the materials that the scene lacks. `None` if
/// the scene would have too many.
fn with_materials_of(
    scene: &mut Scene,
    text: &BodyText,
    materials: &[MaterialText],
) -> Option<BodyText> {
    let mut numbers: [u8; 256] = std::array::from_fn(|number| number as u8);
    let mut all = scene.material.clone();
    for number in used_materials(scene.dim, text, materials.len()) {
        let Some(material) = materials.get(usize::from(number) - 1) else {
            continue;
        };
        let known = all.iter().position(|known| known == material);
        let index = known.unwrap_or(all.len());
        if known.is_none() {
            all.push(material.clone());
        }
        if all.len() > MAX_MATERIALS {
            return None;
        }
        numbers[usize::from(number)] = u8::try_from(index + 1).ok()?;
    }
    scene.material = all;
    Some(renumbered(scene.dim, text, materials.len(), &numbers))
}

/// Returns whether a body has the material in its field `material`, and not others.
fn has_own_material(dim: u8, text: &BodyText) -> bool {
    match (text.shape, &text.file) {
        (Some(form), _) => form != Form::Empty,
        (None, Some(_)) => dim == 2 && text.colours.is_empty(),
        _ => false,
    }
}

/// Returns whether the palette indices of a body from a model are its materials.
fn has_palette_materials(dim: u8, text: &BodyText) -> bool {
    dim == 3 && text.file.is_some() && text.colours.is_empty()
}

/// Returns the numbers of all materials of a body, in a scene with `count` materials.
fn used_materials(dim: u8, text: &BodyText, count: usize) -> BTreeSet<u8> {
    let own = has_own_material(dim, text).then(|| text.material.unwrap_or(1));
    let palette = has_palette_materials(dim, text).then(|| 1..=count.min(MAX_MATERIALS) as u8);
    let parts = text.part.iter();
    let parts = parts.flat_map(|part| [part.fill, part.paint]).flatten();
    let runs = text
        .voxels
        .iter()
        .flat_map(|voxels| voxels.runs.split_ascii_whitespace());
    let runs = runs.filter_map(|run| run.split_once('x')?.1.parse().ok());
    let named = own.into_iter().chain(text.colours.values().copied());
    let all = named
        .chain(palette.into_iter().flatten())
        .chain(parts)
        .chain(runs);
    all.filter(|number| *number != 0).collect()
}

fn renumbered(dim: u8, text: &BodyText, count: usize, numbers: &[u8; 256]) -> BodyText {
    let new = |number: u8| numbers[usize::from(number)];
    let mut text = text.clone();
    if has_own_material(dim, &text) {
        let number = new(text.material.unwrap_or(1));
        text.material = Some(number).filter(|number| text.material.is_some() || *number != 1);
    }
    if has_palette_materials(dim, &text) {
        let palette = 1..=count.min(MAX_MATERIALS) as u8;
        if palette.clone().any(|number| new(number) != number) {
            text.colours = palette
                .map(|number| (number.to_string(), new(number)))
                .collect();
        }
    } else {
        text.colours
            .values_mut()
            .for_each(|number| *number = new(*number));
    }
    for part in &mut text.part {
        part.fill = part.fill.map(new);
        part.paint = part.paint.map(new);
    }
    if let Some(voxels) = &mut text.voxels {
        voxels.runs = renumbered_runs(&voxels.runs, new);
    }
    text
}
