//! Moving, stretching and turning.

use super::bounds::{GridSize, bounds, grid_size, rotation_about, rotation_of};
use super::motion::{FACTORS, FARTHEST_CENTRE, Motion, Moved, SIZES, set};
use super::{
    Item, MAX_COORDINATE, basket_mut, existing, first_leader, flat, holder_of_anchor,
    holder_of_knife, rounded, with_followers,
};
use fuwafuwa::{Rotation, Vec3};
use fuwafuwa_scenes::Scene;
use fuwafuwa_scenes::scene::{
    BodyText, BoxText, FieldText, HandText, JointKindText, JointText, KnifeText, MAX_RIGID,
    ObstacleText, PartText, RigidBodyText,
};
use std::collections::{BTreeMap, BTreeSet};

/// Number of voxels from the origin within which a body can be placed, with a margin.
const VOXELS_IN_REACH: f32 = 8000.0;

/// Smallest edge length of a voxel to which a body is shrunk [m]. With it, every body fits everywhere in a level.
const MIN_VOXEL: f32 = 0.001;

/// Share of the view that a hand may take on each axis.
const HAND_SHARE: f32 = 0.9;

/// Difference of distances that comes from rounding [m].
const SAME_DISTANCE: f32 = 1e-4;

/// Motion of each item.
type Moves = BTreeMap<Item, Moved>;

/// Moves items, and everything that is fixed to them: anchors of joints, knives, pivots, and hands that follow a moved one.
/// A joint moves only its anchors that are fixed points. A rope whose ends move apart or together keeps its slack. The first
/// point of the hint moves with the first hand.
///
/// The middle of each item stays within [`MAX_COORDINATE`], and all items move by the same vector. A body that is given by
/// its state cannot be moved.
pub fn translate(scene: &mut Scene, items: &[Item], by: Vec3) {
    let chosen = with_followers(scene, existing(scene, items));
    if !by.is_finite() {
        return;
    }
    let by = flat(scene.dim, by);
    let by = chosen
        .iter()
        .fold(by, |by, item| match place_of(scene, *item) {
            Some(place) => held(place, by, reach_of(scene, *item)),
            None => by,
        });
    if by != Vec3::ZERO {
        apply(scene, &chosen, Motion::Shift(by));
    }
}

/// Stretches items about a point: their sizes and their places. Balls, radii and bodies are stretched by the factor that
/// differs from 1, or by the geometric mean of all if several do. A body keeps its number of voxels. A joint is stretched
/// in length if it is among the items, or if everything that it holds to is.
///
/// Sizes stay between 0.01 and 8 m, and hands fit into the view. Factors that are not positive change nothing.
pub fn stretch(scene: &mut Scene, items: &[Item], about: Vec3, factors: Vec3) {
    let chosen = with_followers(scene, existing(scene, items));
    let [low, high] = FACTORS.map(Vec3::splat);
    let mut factors = factors;
    if scene.dim == 2 {
        factors.z = 1.0;
    }
    if !about.is_finite() || !factors.is_finite() || factors.min_element() <= 0.0 {
        return;
    }
    let factors = factors.clamp(low, high);
    let motion = Motion::Stretch {
        about: near_centre(scene.dim, about),
        factors,
        one: single_factor(scene.dim, factors),
    };
    apply(scene, &chosen, motion);
}

/// Limits the centre of a stretch or a rotation, so that coordinates keep their digits [m].
fn near_centre(dim: u8, about: Vec3) -> Vec3 {
    let most = Vec3::splat(FARTHEST_CENTRE);
    flat(dim, about.clamp(-most, most))
}

/// Returns the factor for sizes that have no axis.
fn single_factor(dim: u8, factors: Vec3) -> f32 {
    let factors = &factors.to_array()[..usize::from(dim.clamp(2, 3))];
    let mut changed = factors.iter().filter(|factor| **factor != 1.0);
    match (changed.next(), changed.next()) {
        (None, _) => 1.0,
        (Some(&factor), None) => factor,
        _ => {
            let product: f32 = factors.iter().product();
            match dim {
                2 => product.sqrt(),
                _ => product.cbrt(),
            }
        }
    }
}

/// Turns items about an axis through a point by an angle [rad]; in 2D about the third axis. Returns the items in their new
/// lists, in the same order: a fixed box of an obstacle that is not turned by quarter turns becomes a fixed rigid body.
///
/// Boxes of moving obstacles, hands, switches, fields and baskets change their places, and exchange their widths if they
/// are turned by nearly a quarter turn.
pub fn rotate(scene: &mut Scene, items: &[Item], about: Vec3, axis: Vec3, angle: f32) -> Vec<Item> {
    let chosen = with_followers(scene, existing(scene, items));
    let unit = axis.normalize_or_zero();
    let (axis, angle) = match scene.dim {
        2 => (Vec3::Z, if axis.z < 0.0 { -angle } else { angle }),
        _ => (unit, angle),
    };
    if !about.is_finite() || !angle.is_finite() || axis == Vec3::ZERO {
        return items.to_vec();
    }
    let motion = Motion::Turn {
        about: near_centre(scene.dim, about),
        rotation: Rotation::about(axis, angle),
        angle,
    };
    let moves = apply(scene, &chosen, motion);
    let renamed = lean(scene, &moves);
    let new_name = |item: &Item| renamed.get(item).copied().unwrap_or(*item);
    items.iter().map(new_name).collect()
}

/// Applies a motion to items and everything that is fixed to them. Returns the motion of each item.
fn apply(scene: &mut Scene, chosen: &BTreeSet<Item>, motion: Motion) -> Moves {
    let moves = chosen.iter().map(|&item| {
        let back = match motion {
            // A translation was limited before.
            Motion::Shift(_) => Vec3::ZERO,
            _ => back_into_reach(scene, item, motion),
        };
        let dim = scene.dim;
        (item, Moved { motion, back, dim })
    });
    let moves: Moves = moves.collect();
    move_hint(scene, &moves);
    move_joints(scene, &moves);
    move_knives(scene, &moves);
    for (&item, moved) in &moves {
        move_item(scene, item, moved);
    }
    moves
}

/// Returns the translation that brings an item back within reach after a motion.
fn back_into_reach(scene: &Scene, item: Item, motion: Motion) -> Vec3 {
    let Some(place) = place_of(scene, item) else {
        return Vec3::ZERO;
    };
    let by = flat(scene.dim, motion.mapped(place)) - place;
    match by.is_finite() {
        true => held(place, by, reach_of(scene, item)) - by,
        false => Vec3::ZERO,
    }
}

/// Returns the middle of an item, or another point that moves with it; `None` if it has no place of its own.
fn place_of(scene: &Scene, item: Item) -> Option<Vec3> {
    let place = match item {
        Item::Obstacle(index) => {
            let plane = scene.obstacle.get(index)?.half_space.as_ref();
            plane.map(|plane| Vec3::from(plane.point))
        }
        Item::RigidBody(index) => {
            let text = scene.rigid_body.get(index)?;
            text.half_space.as_ref().map(|_| Vec3::from(text.at))
        }
        Item::Joint(index) => {
            let free = scene.joint.get(index)?.anchors.iter();
            let mut free = free.filter(|anchor| holder_of_anchor(anchor).is_none());
            return free.next().map(|anchor| Vec3::from(anchor.point));
        }
        _ => None,
    };
    let middle = || bounds(scene, item).map(|[low, high]| (low + high) * 0.5);
    place.or_else(middle).filter(|place| place.is_finite())
}

/// Returns the limit of the coordinates of the middle of an item [m].
fn reach_of(scene: &Scene, item: Item) -> f32 {
    let Item::Body(index) = item else {
        return MAX_COORDINATE;
    };
    let Some(text) = scene.body.get(index).filter(|text| text.state.is_none()) else {
        return MAX_COORDINATE;
    };
    let GridSize { widths, voxel } = grid_size(scene, text);
    let reach = VOXELS_IN_REACH * voxel - widths.length();
    if reach.is_finite() {
        reach.clamp(0.0, MAX_COORDINATE)
    } else {
        MAX_COORDINATE
    }
}

/// Limits a translation so that the coordinates do not leave the reach. They may stay where they are beyond it.
fn held(from: Vec3, by: Vec3, reach: f32) -> Vec3 {
    let mut held = by;
    for axis in 0..3 {
        let to = from[axis] + by[axis];
        let within = to.clamp(from[axis].min(-reach), from[axis].max(reach));
        if within != to {
            held[axis] = within - from[axis];
        }
    }
    held
}

/// Moves the first point of the hint with the first hand. It stays in the view.
fn move_hint(scene: &mut Scene, moves: &Moves) {
    let leader = first_leader(scene).map(Item::Hand);
    let moved = leader.and_then(|leader| moves.get(&leader));
    let hint = scene.game.as_mut().and_then(|game| game.hint.first_mut());
    let (Some(moved), Some([_, x, y, z])) = (moved, hint) else {
        return;
    };
    let mut point = [*x, *y, *z];
    moved.point(&mut point);
    for (axis, number) in [x, y, z].into_iter().enumerate() {
        let [low, high] = scene.view.map(|corner| corner[axis]);
        if low <= high && axis < usize::from(scene.dim) {
            *number = point[axis].clamp(low.min(*number), high.max(*number));
        }
    }
}

fn move_joints(scene: &mut Scene, moves: &Moves) {
    for (index, joint) in scene.joint.iter_mut().enumerate() {
        let own = moves.get(&Item::Joint(index));
        let before = (span(joint), joint.length);
        let mut all_held = true;
        for anchor in &mut joint.anchors {
            let holder = holder_of_anchor(anchor);
            let moved = holder.map_or(own, |holder| moves.get(&holder));
            all_held &= holder.is_some() && moved.is_some();
            if let Some(moved) = moved {
                moved.point(&mut anchor.point);
                if let Some(radius) = &mut anchor.radius {
                    moved.length(radius, 0.0, SIZES[1]);
                }
            }
        }
        let any = moves.values().next().filter(|_| all_held);
        if let (Some(moved), Some(length)) = (own.or(any), &mut joint.length) {
            moved.length(length, SIZES[0], 2.0 * SIZES[1]);
        }
        if joint.kind == JointKindText::Rope {
            keep_slack(joint, before);
        }
    }
}

/// Returns the distance between the anchors of a joint [m].
pub(super) fn span(joint: &JointText) -> f32 {
    match &joint.anchors[..] {
        [from, to] => Vec3::from(from.point).distance(Vec3::from(to.point)),
        _ => 0.0,
    }
}

/// Changes the length of a joint by as much as the distance between its anchors has changed. `before` are this distance and
/// the length before [m]. A rope that is shorter than the distance would tear at the start, so it has at least no slack. A
/// length that was stretched stays, if it is long enough.
pub(super) fn keep_slack(joint: &mut JointText, (distance, length): (f32, Option<f32>)) {
    let (now, is_rope) = (span(joint), joint.kind == JointKindText::Rope);
    let (Some(before), Some(after)) = (length, &mut joint.length) else {
        return;
    };
    let has_moved = (now - distance).abs() > SAME_DISTANCE;
    if has_moved && *after == before {
        let least = if is_rope { 0.0 } else { f32::NEG_INFINITY };
        let slack = (before - distance).max(least);
        *after = rounded(now + slack).max(SIZES[0]);
    } else if is_rope && has_moved && *after < now {
        *after = rounded(now);
    }
}

fn move_knives(scene: &mut Scene, moves: &Moves) {
    for (index, knife) in scene.knife.iter_mut().enumerate() {
        let holder = holder_of_knife(knife).and_then(|holder| moves.get(&holder));
        let Some(moved) = holder.or(moves.get(&Item::Knife(index))) else {
            continue;
        };
        let before = knife.clone();
        knife.edge.iter_mut().for_each(|end| moved.point(end));
        moved.direction(&mut knife.toward);
        if let Some(height) = &mut knife.height {
            moved.length(height, 0.001, 1.0);
        }
        if scene.dim == 3 && !straighten(knife) {
            *knife = before;
        }
    }
}

/// Turns the cutting direction of a knife to a right angle with its edge if a stretch has made it lean too far. Returns
/// whether the knife is valid then.
fn straighten(knife: &mut KnifeText) -> bool {
    let [from, to] = knife.edge.map(Vec3::from);
    let along = (to - from).normalize_or_zero();
    let toward = Vec3::from(knife.toward);
    if along.dot(toward).abs() > 0.49 * toward.length() {
        set(&mut knife.toward, toward - along * along.dot(toward));
    }
    let toward = Vec3::from(knife.toward);
    let is_across = along.dot(toward).abs() <= 0.499 * toward.length();
    along != Vec3::ZERO && is_across && (0.02..=99.0).contains(&toward.length())
}

fn move_item(scene: &mut Scene, item: Item, moved: &Moved) {
    match item {
        Item::Body(index) => {
            let size = grid_size(scene, &scene.body[index]);
            move_body(&mut scene.body[index], size, moved);
        }
        Item::Obstacle(index) => move_obstacle(&mut scene.obstacle[index], moved),
        Item::Hand(index) => {
            let room = room_of(scene);
            move_hand(&mut scene.hand[index], room, moved);
        }
        Item::RigidBody(index) => move_rigid_body(&mut scene.rigid_body[index], moved),
        // Joints and knives were moved with what holds them.
        Item::Joint(_) | Item::Knife(_) => {}
        Item::Switch(index) => {
            let text = &mut scene.switch[index];
            text.boxed.iter_mut().for_each(|shape| moved.boxed(shape));
            text.ball.iter_mut().for_each(|shape| moved.ball(shape));
        }
        Item::Field(index) => move_field(&mut scene.field[index], moved),
        Item::Basket(index) => {
            if let Some((centre, half)) = basket_mut(scene, index) {
                moved.point(centre);
                moved.half(half);
            }
        }
    }
}

fn move_body(text: &mut BodyText, size: GridSize, moved: &Moved) {
    if text.state.is_some() {
        return;
    }
    match moved.motion {
        Motion::Shift(_) => moved.point(&mut text.at),
        Motion::Turn { .. } => {
            moved.point(&mut text.at);
            text.rotation_vector = moved.rotation_vector(text.rotation_vector);
            moved.direction(&mut text.velocity);
        }
        Motion::Stretch { one, .. } => stretch_body(text, size, one, moved),
    }
}

fn stretch_body(text: &mut BodyText, size: GridSize, factor: f32, moved: &Moved) {
    let rotation = text.rotation_vector.map_or(Rotation::NONE, rotation_about);
    let half = rotation.apply(flat(moved.dim, size.widths) * 0.5);
    let middle = moved.mapped(Vec3::from(text.at) + half);
    // A body from voxels has the edge length of a voxel in place of a width.
    let width = match &mut text.voxels {
        Some(voxels) => &mut voxels.voxel_size,
        None => &mut text.width,
    };
    let before = *width;
    let longest = size.widths.max_element();
    let [low, high] = SIZES.map(|most| before * (most / longest));
    let finest = before * (MIN_VOXEL / size.voxel);
    let after = before * factor;
    if ![low, high, finest, after].into_iter().all(f32::is_finite) {
        return;
    }
    *width = after.clamp(before.min(low.max(finest)), before.max(high));
    if text.voxels.is_none() && factor != 1.0 {
        text.width = rounded(text.width);
    }
    let after = text
        .voxels
        .as_ref()
        .map_or(text.width, |voxels| voxels.voxel_size);
    let factor = after / before;
    set(&mut text.at, flat(moved.dim, middle - half * factor));
    if factor != 1.0 {
        text.part
            .iter_mut()
            .for_each(|part| stretch_part(part, factor));
        // The distance between cuts must not fall below a voxel by rounding.
        text.diced = text.diced.map(|distance| distance * factor * (1.0 + 1e-6));
    }
}

/// Stretches a part of a body about the low corner of the body.
fn stretch_part(part: &mut PartText, factor: f32) {
    let stretched = |vector: &mut [f32; 3]| *vector = vector.map(|k| k * factor);
    if let Some(shape) = &mut part.half_space {
        stretched(&mut shape.point);
    }
    if let Some(shape) = &mut part.boxed {
        stretched(&mut shape.centre);
        stretched(&mut shape.half);
    }
    if let Some(shape) = &mut part.capsule {
        stretched(&mut shape.from);
        stretched(&mut shape.to);
        shape.radius *= factor;
    }
    if let Some(shape) = &mut part.ball {
        stretched(&mut shape.centre);
        shape.radius *= factor;
    }
}

/// Returns whether a motion would tilt the fixed box of an obstacle, which then becomes a rigid body.
fn leans(text: &ObstacleText, moved: &Moved) -> bool {
    text.boxed.is_some() && !text.moves() && !moved.keeps_axes()
}

fn move_obstacle(text: &mut ObstacleText, moved: &Moved) {
    let is_leaning = leans(text, moved);
    if let Some(shape) = &mut text.half_space {
        moved.point(&mut shape.point);
        moved.direction(&mut shape.normal);
    }
    if let Some(shape) = &mut text.boxed {
        moved.point(&mut shape.centre);
        if !is_leaning {
            moved.half(&mut shape.half);
        }
    }
    text.capsule
        .iter_mut()
        .for_each(|shape| moved.capsule(shape));
    text.ball.iter_mut().for_each(|shape| moved.ball(shape));
    for [_, x, y, z] in &mut text.path {
        let mut way = [*x, *y, *z];
        moved.displacement(&mut way);
        [*x, *y, *z] = way;
    }
    text.pivot.iter_mut().for_each(|pivot| moved.point(pivot));
    let turning = text.angular_velocity.iter_mut();
    turning.for_each(|velocity| moved.angular_velocity(velocity));
}

/// Returns the least width of the view on any axis [m].
pub(super) fn room_of(scene: &Scene) -> f32 {
    let [low, high] = scene.view;
    let widths = (0..usize::from(scene.dim.clamp(2, 3))).map(|axis| high[axis] - low[axis]);
    widths.fold(f32::INFINITY, f32::min)
}

fn move_hand(text: &mut HandText, room: f32, moved: &Moved) {
    for [_, x, y, z] in &mut text.path {
        let mut place = [*x, *y, *z];
        moved.point(&mut place);
        [*x, *y, *z] = place;
    }
    let before = text.clone();
    if let Some(radius) = &mut text.radius {
        let [low, high] = SIZES.map(|width| 0.5 * width);
        moved.length(radius, low, high.min(0.49 * HAND_SHARE * room).max(low));
    }
    if let Some(shape) = &mut text.boxed {
        moved.displacement(&mut shape.centre);
        moved.half(&mut shape.half);
    }
    text.capsule
        .iter_mut()
        .for_each(|shape| moved.local_capsule(shape));
    let dim = usize::from(moved.dim);
    if hand_width(text, dim) > 0.99 * HAND_SHARE * room
        && hand_width(text, dim) > hand_width(&before, dim)
    {
        (text.boxed, text.capsule) = (before.boxed, before.capsule);
    }
}

/// Returns the largest width of a hand on any axis [m].
fn hand_width(text: &HandText, dim: usize) -> f32 {
    let of_box = text.boxed.as_ref().map(|shape| {
        let widths = shape.half[..dim].iter().map(|half| 2.0 * half);
        widths.fold(0.0, f32::max)
    });
    let of_capsule = text.capsule.as_ref().map(|shape| {
        let widths = (0..dim).map(|axis| (shape.to[axis] - shape.from[axis]).abs());
        widths.fold(0.0, f32::max) + 2.0 * shape.radius
    });
    let of_ball = text.radius.map(|radius| 2.0 * radius);
    of_box.or(of_capsule).or(of_ball).unwrap_or(0.0)
}

fn move_rigid_body(text: &mut RigidBodyText, moved: &Moved) {
    if text.state.is_some() {
        return;
    }
    if let Motion::Stretch { .. } = moved.motion {
        stretch_rigid_body(text, moved);
        return;
    }
    moved.point(&mut text.at);
    text.target_position
        .iter_mut()
        .for_each(|target| moved.point(target));
    let Motion::Turn { rotation, .. } = moved.motion else {
        return;
    };
    match &mut text.rotation {
        Some(before) => *before = before.then(rotation),
        None => text.rotation_vector = moved.rotation_vector(text.rotation_vector),
    }
    text.target_rotation = text.target_rotation.map(|target| target.then(rotation));
    text.velocity
        .iter_mut()
        .for_each(|velocity| moved.direction(velocity));
    let turning = text.angular_velocity.iter_mut();
    turning.for_each(|velocity| moved.angular_velocity(velocity));
}

/// Stretches the shape of a rigid body about its own origin. A rotated one is stretched alike on all axes.
fn stretch_rigid_body(text: &mut RigidBodyText, moved: &Moved) {
    let rotation = rotation_of(text);
    let Motion::Stretch { factors, one, .. } = moved.motion else {
        return;
    };
    let is_upright = rotation == Rotation::NONE;
    let local = Moved {
        motion: Motion::Stretch {
            about: Vec3::ZERO,
            factors: if is_upright {
                factors
            } else {
                flat_ones(moved.dim, one)
            },
            one,
        },
        back: Vec3::ZERO,
        dim: moved.dim,
    };
    let middle = rotation.apply(middle_of(text));
    let place = moved.mapped(Vec3::from(text.at) + middle);
    if let Some(shape) = &mut text.boxed {
        local.displacement(&mut shape.centre);
        local.half(&mut shape.half);
    }
    text.capsule
        .iter_mut()
        .for_each(|shape| local.local_capsule(shape));
    if let Some(shape) = &mut text.ball {
        local.displacement(&mut shape.centre);
        local.radius(&mut shape.radius);
    }
    let middle = rotation.apply(middle_of(text));
    set(&mut text.at, flat(moved.dim, place - middle));
    text.target_position
        .iter_mut()
        .for_each(|target| moved.point(target));
}

fn flat_ones(dim: u8, factor: f32) -> Vec3 {
    match dim {
        2 => Vec3::new(factor, factor, 1.0),
        _ => Vec3::splat(factor),
    }
}

/// Returns the middle of the shape of a rigid body before its rotation [m].
fn middle_of(text: &RigidBodyText) -> Vec3 {
    let boxed = text.boxed.as_ref().map(|shape| Vec3::from(shape.centre));
    let ball = text.ball.as_ref().map(|shape| Vec3::from(shape.centre));
    let capsule = text.capsule.as_ref();
    let capsule = capsule.map(|shape| (Vec3::from(shape.from) + Vec3::from(shape.to)) * 0.5);
    boxed.or(ball).or(capsule).unwrap_or(Vec3::ZERO)
}

fn move_field(text: &mut FieldText, moved: &Moved) {
    text.boxed.iter_mut().for_each(|shape| moved.boxed(shape));
    text.ball.iter_mut().for_each(|shape| moved.ball(shape));
    text.centre
        .iter_mut()
        .for_each(|centre| moved.point(centre));
    text.reach.iter_mut().for_each(|reach| moved.radius(reach));
    text.acceleration
        .iter_mut()
        .for_each(|acceleration| moved.direction(acceleration));
}

/// Replaces obstacles whose boxes lean after a rotation with rigid bodies. Returns the new item of each item whose number
/// changed.
fn lean(scene: &mut Scene, moves: &Moves) -> BTreeMap<Item, Item> {
    let mut renamed = BTreeMap::new();
    let mut left = Vec::with_capacity(scene.obstacle.len());
    for (index, text) in std::mem::take(&mut scene.obstacle).into_iter().enumerate() {
        let moved = moves.get(&Item::Obstacle(index));
        let leaning = moved.filter(|moved| leans(&text, moved));
        let leaning = leaning.filter(|_| scene.rigid_body.len() < MAX_RIGID);
        let made = leaning.and_then(|moved| leaning_box(&text, moved));
        let item = match made {
            Some(made) => {
                scene.rigid_body.push(made);
                Item::RigidBody(scene.rigid_body.len() - 1)
            }
            None => {
                left.push(text);
                Item::Obstacle(left.len() - 1)
            }
        };
        if item != Item::Obstacle(index) {
            renamed.insert(Item::Obstacle(index), item);
        }
    }
    scene.obstacle = left;
    let new_name = |number: usize| {
        renamed
            .get(&Item::Obstacle(number.checked_sub(1)?))
            .copied()
    };
    let anchors = scene.joint.iter_mut().flat_map(|joint| &mut joint.anchors);
    for anchor in anchors {
        let item = anchor.obstacle.and_then(new_name);
        rename(&mut anchor.obstacle, &mut anchor.rigid_body, item);
    }
    for knife in &mut scene.knife {
        let item = knife.obstacle.and_then(new_name);
        rename(&mut knife.obstacle, &mut knife.rigid_body, item);
    }
    renamed
}

/// Sets the numbers that name an obstacle or a rigid body.
fn rename(obstacle: &mut Option<usize>, rigid_body: &mut Option<usize>, item: Option<Item>) {
    match item {
        Some(Item::Obstacle(index)) => *obstacle = Some(index + 1),
        Some(Item::RigidBody(index)) => (*obstacle, *rigid_body) = (None, Some(index + 1)),
        _ => {}
    }
}

/// Returns the rigid body in place of an obstacle whose box was moved but not turned.
fn leaning_box(text: &ObstacleText, moved: &Moved) -> Option<RigidBodyText> {
    let shape = text.boxed.as_ref()?;
    Some(RigidBodyText {
        boxed: Some(BoxText {
            centre: [0.0; 3],
            half: shape.half,
        }),
        at: shape.centre,
        rotation_vector: moved.rotation_vector(None),
        friction: (text.friction != 0.2).then_some(text.friction),
        layers: text.layers,
        ..RigidBodyText::default()
    })
}
