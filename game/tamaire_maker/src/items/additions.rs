//! New items of a usual size.

use super::bounds::grid_size;
use super::clip::add_basket;
use super::layers::{Stops, set_stops};
use super::movement::{room_of, span, translate};
use super::ties::{anchor_on, fixed, holder_at};
use super::{Item, MAX_COORDINATE, bounds, first_leader, flat, player_count, rounded, union};
use crate::palette::{crayon, number_in};
use fuwafuwa::Vec3;
use fuwafuwa_scenes::Scene;
use fuwafuwa_scenes::scene::{
    AxisText, BallText, BasketText, BodyText, BoxText, CapsuleText, FieldText, Form, HandText,
    JointAnchorText, JointKindText, JointText, KnifeText, MAX_BODIES, MAX_RIGID, MotionTypeText,
    ObstacleText, RepeatText, RigidBodyText, SwitchText,
};
use tamaire_play::PLAYERS;
use tamaire_play::playground::Stuff;

/// Width of a new body [m].
const BODY_WIDTH: f32 = 0.5;

/// Number of voxels across a new body, in 2D and 3D.
const BODY_VOXELS: [usize; 2] = [32, 10];

/// Radius of a new hand if the level has none to copy [m].
const HAND_RADIUS: f32 = 0.09;

/// Distance of the fixed end of a new rope or spring from the thing to which it is tied [m].
const TIE_LENGTH: f32 = 0.35;

/// Minimum length of a new rope or spring [m].
const LEAST_TIE: f32 = 0.1;

/// Something that can be added to a level.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Soft body of a shape and a crayon. An empty shape becomes a box.
    Body(Form, Stuff),
    /// Fixed box.
    Wall,
    /// Fixed ball.
    Ball,
    /// Fixed bar with round ends.
    Bar,
    /// Box that stops hands only.
    Glass,
    /// Box that stops bodies only.
    Curtain,
    /// Region to fill, with its three bars.
    Basket,
    /// Free board.
    Plank,
    /// Free board that turns about its middle.
    SeeSaw,
    /// Rope from a fixed point to a body.
    Rope,
    /// Spring from a fixed point to a body.
    Spring,
    /// Pin that holds a body to a fixed point in it.
    Pin,
    /// Obstacle that rises while something lies on its switch, and the switch.
    Door,
    /// Obstacle that moves up and down.
    Lift,
    /// Turning obstacle.
    Paddle,
    /// Field that blows upwards in a box.
    Wind,
    /// Field that pulls to a point.
    Planet,
    /// Switch.
    Button,
    /// Blade that moves up and down, with a knife at its lower edge.
    Knife,
    /// Turning ball with knives around it.
    Saw,
    /// Hand of the second player.
    SecondHand,
    /// Two tines that follow the first hand.
    Fork,
    /// Second half of tongs: it follows the first hand and moves opposite to it on the second axis.
    Tongs,
}

impl Kind {
    /// All kinds, the most usual ones first, with a ball of jelly for the bodies.
    pub const ALL: [Self; 23] = [
        Self::Body(Form::Ball, Stuff::Jelly),
        Self::Basket,
        Self::Wall,
        Self::Bar,
        Self::Ball,
        Self::SeeSaw,
        Self::Plank,
        Self::Rope,
        Self::Spring,
        Self::Pin,
        Self::Button,
        Self::Door,
        Self::Lift,
        Self::Paddle,
        Self::Glass,
        Self::Curtain,
        Self::Wind,
        Self::Planet,
        Self::Knife,
        Self::Saw,
        Self::SecondHand,
        Self::Fork,
        Self::Tongs,
    ];
}

/// Adds something of a usual size at a position [m], which is brought into the room. Returns the new items. Returns no items
/// and changes nothing if the level cannot have it: a hand of a third player, a ninth basket, a basket in a scene that is no
/// level, a joint without a body or hand to hold, or a body whose material has no space.
///
/// A rope, spring or pin is tied to the body that is nearest to the position.
pub fn add(scene: &mut Scene, kind: Kind, at: Vec3) -> Vec<Item> {
    add_to(scene, kind, at, None)
}

/// Adds something as [`add`] does. A rope, spring or pin is tied to `holder` if that is a body, a rigid body or a hand.
pub fn add_to(scene: &mut Scene, kind: Kind, at: Vec3, holder: Option<Item>) -> Vec<Item> {
    if !at.is_finite() || !has_space(scene) {
        return Vec::new();
    }
    let at = in_view(scene, at);
    let items = match kind {
        Kind::Rope => add_tie(scene, at, JointKindText::Rope, holder),
        Kind::Spring => add_tie(scene, at, JointKindText::Spring, holder),
        Kind::Pin => add_pin(scene, at, holder),
        _ => made(scene, kind, at),
    };
    bring_inside(scene, &items);
    items
}

/// Adds something other than a rope, spring or pin at a position in the view. Parts of it may be outside.
fn made(scene: &mut Scene, kind: Kind, at: Vec3) -> Vec<Item> {
    match kind {
        Kind::Body(form, stuff) => add_body(scene, form, stuff, at),
        Kind::Wall => add_obstacle(scene, boxed(scene.dim, at, [0.25, 0.05, 0.25])),
        Kind::Ball => add_obstacle(scene, ball(at, 0.1)),
        Kind::Bar => {
            let way = Vec3::X * 0.3;
            add_obstacle(scene, capsule(at - way, at + way, 0.05))
        }
        Kind::Glass => add_layered(scene, at, Stops::Hands),
        Kind::Curtain => add_layered(scene, at, Stops::Bodies),
        Kind::Basket => add_basket_with_bars(scene, at),
        Kind::Plank => add_plank(scene, at, [0.3, 0.03, 0.12]),
        Kind::SeeSaw => add_see_saw(scene, at),
        Kind::Rope | Kind::Spring | Kind::Pin => Vec::new(),
        Kind::Door => add_door(scene, at),
        Kind::Lift => add_lift(scene, at),
        Kind::Paddle => add_paddle(scene, at),
        Kind::Wind => add_wind(scene, at),
        Kind::Planet => add_planet(scene, at),
        Kind::Button => add_switch(scene, at),
        Kind::Knife => add_blade(scene, at),
        Kind::Saw => add_saw(scene, at),
        Kind::SecondHand => add_second_hand(scene, at),
        Kind::Fork => add_fork(scene, at),
        Kind::Tongs => add_tongs(scene, at),
    }
}

/// Returns whether every list has space for all that one kind adds.
fn has_space(scene: &Scene) -> bool {
    let counts = [
        scene.obstacle.len(),
        scene.hand.len(),
        scene.rigid_body.len(),
        scene.joint.len(),
        scene.knife.len(),
        scene.switch.len(),
        scene.field.len(),
    ];
    counts.into_iter().all(|count| count + 8 <= MAX_RIGID) && scene.body.len() < MAX_BODIES
}

/// Moves new items so that they are inside the walls of the room, with all places to which they move by themselves. Ropes,
/// springs and pins stay where they are tied.
fn bring_inside(scene: &mut Scene, items: &[Item]) {
    let is_tie = |item: &&Item| matches!(item, Item::Joint(_));
    let boxes = items.iter().filter(|item| !is_tie(item));
    let boxes = boxes.filter_map(|&item| swept(scene, item));
    let Some([from, to]) = boxes.reduce(union) else {
        return;
    };
    let [low, high] = walls(scene);
    let mut by = Vec3::ZERO;
    for axis in 0..usize::from(scene.dim.clamp(2, 3)) {
        let (least, most) = (low[axis] - from[axis], high[axis] - to[axis]);
        by[axis] = match least <= most {
            true => 0.0_f32.clamp(least, most),
            false => 0.5 * (least + most),
        };
    }
    translate(scene, items, Vec3::from(numbers(by)));
}

/// Returns the box around all places that an item takes while it moves by itself [m].
fn swept(scene: &Scene, item: Item) -> Option<[Vec3; 2]> {
    let [low, high] = bounds(scene, item)?;
    let Item::Obstacle(index) = item else {
        return Some([low, high]);
    };
    let text = scene.obstacle.get(index)?;
    let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
    let radius = half.x.hypot(half.y);
    let half = match text.angular_velocity {
        Some(_) => Vec3::new(radius, radius, half.z),
        None => half,
    };
    let turned = [middle - half, middle + half];
    let ends = text.path.iter().map(|&[_, x, y, z]| Vec3::new(x, y, z));
    let ends = ends.map(|by| turned.map(|corner| corner + by));
    Some(ends.fold(turned, union))
}

/// Returns the part of the view that is inside the planes along the axes, which are the walls of a room [m].
pub(super) fn walls(scene: &Scene) -> [Vec3; 2] {
    let [mut low, mut high] = scene.view.map(Vec3::from);
    let planes = scene.obstacle.iter();
    for plane in planes.filter_map(|text| text.half_space.as_ref()) {
        let normal = Vec3::from(plane.normal).normalize_or_zero();
        for axis in 0..3 {
            let at = plane.point[axis];
            if normal[axis] > 0.999 && at < high[axis] {
                low[axis] = low[axis].max(at);
            } else if normal[axis] < -0.999 && at > low[axis] {
                high[axis] = high[axis].min(at);
            }
        }
    }
    [low, high]
}

/// Returns the position in the view nearest to another one [m].
fn in_view(scene: &Scene, at: Vec3) -> Vec3 {
    box_in_view(scene, at, Vec3::ZERO)
}

/// Returns the middle of a box with half widths `half` that is in the view, nearest to a position [m]. If the view is not
/// as wide as the box, its middle is in that of the view.
fn box_in_view(scene: &Scene, at: Vec3, half: Vec3) -> Vec3 {
    let mut place = flat(scene.dim, at);
    for axis in 0..usize::from(scene.dim.clamp(2, 3)) {
        let [low, high] = scene.view.map(|corner| corner[axis]);
        let low = low.max(-MAX_COORDINATE);
        let high = high.min(MAX_COORDINATE);
        let margin = half[axis].min(0.5 * (high - low));
        place[axis] = match low <= high {
            true => place[axis].clamp(low + margin, (high - margin).max(low + margin)),
            false => place[axis].clamp(-MAX_COORDINATE, MAX_COORDINATE),
        };
    }
    place
}

/// Returns the numbers of a vector, rounded.
fn numbers(vector: Vec3) -> [f32; 3] {
    vector.to_array().map(rounded)
}

fn box_text(dim: u8, centre: Vec3, half: [f32; 3]) -> BoxText {
    BoxText {
        centre: numbers(centre),
        half: flat(dim, Vec3::from(half)).to_array(),
    }
}

fn obstacle() -> ObstacleText {
    ObstacleText {
        friction: 0.2,
        ..ObstacleText::default()
    }
}

fn boxed(dim: u8, centre: Vec3, half: [f32; 3]) -> ObstacleText {
    ObstacleText {
        boxed: Some(box_text(dim, centre, half)),
        ..obstacle()
    }
}

fn ball(centre: Vec3, radius: f32) -> ObstacleText {
    let centre = numbers(centre);
    ObstacleText {
        ball: Some(BallText { centre, radius }),
        ..obstacle()
    }
}

fn capsule(from: Vec3, to: Vec3, radius: f32) -> ObstacleText {
    let [from, to] = [from, to].map(numbers);
    ObstacleText {
        capsule: Some(CapsuleText { from, to, radius }),
        ..obstacle()
    }
}

fn add_obstacle(scene: &mut Scene, text: ObstacleText) -> Vec<Item> {
    scene.obstacle.push(text);
    vec![Item::Obstacle(scene.obstacle.len() - 1)]
}

fn add_body(scene: &mut Scene, form: Form, stuff: Stuff, at: Vec3) -> Vec<Item> {
    let form = if form == Form::Empty { Form::Box } else { form };
    let Some(number) = number_in(&mut scene.material, &crayon(stuff)) else {
        return Vec::new();
    };
    let mut text = BodyText {
        shape: Some(form),
        n: Some(BODY_VOXELS[usize::from(scene.dim == 3)]),
        width: BODY_WIDTH,
        material: Some(number).filter(|number| *number != 1),
        ..BodyText::default()
    };
    let half = flat(scene.dim, grid_size(scene, &text).widths) * 0.5;
    text.at = numbers(box_in_view(scene, at, half) - half);
    scene.body.push(text);
    vec![Item::Body(scene.body.len() - 1)]
}

/// Adds a box that stops only hands or only bodies.
fn add_layered(scene: &mut Scene, at: Vec3, stops: Stops) -> Vec<Item> {
    let text = boxed(scene.dim, at, [0.05, 0.3, 0.3]);
    let items = add_obstacle(scene, text);
    set_stops(scene, scene.obstacle.len() - 1, stops);
    items
}

/// Adds a basket that is open to the left; in 3D its bars lie at two thirds of its height, as in the level of 2004.
fn add_basket_with_bars(scene: &mut Scene, at: Vec3) -> Vec<Item> {
    let half = match scene.dim {
        2 => [0.35, 0.35, 0.0],
        _ => [0.35, 0.3, 0.35],
    };
    let basket = BasketText {
        centre: numbers(at),
        half,
        ..BasketText::default()
    };
    let Some(basket) = add_basket(scene, basket) else {
        return Vec::new();
    };
    let mut items = vec![basket];
    let (side, radius, up) = match scene.dim {
        2 => (Vec3::Y, 0.05, 0.0),
        _ => (Vec3::Z, 0.09, 0.2),
    };
    let far = half[0] + radius;
    let corner = |x: f32, across: f32| at + Vec3::X * x + Vec3::Y * up + side * across * far;
    let bars = [
        (corner(-half[0], 1.0), corner(far, 1.0)),
        (corner(-half[0], -1.0), corner(far, -1.0)),
        (corner(far, -1.0), corner(far, 1.0)),
    ];
    for (from, to) in bars {
        items.extend(add_obstacle(scene, capsule(from, to, radius)));
    }
    items
}

fn add_plank(scene: &mut Scene, at: Vec3, half: [f32; 3]) -> Vec<Item> {
    scene.rigid_body.push(RigidBodyText {
        boxed: Some(box_text(scene.dim, Vec3::ZERO, half)),
        motion_type: MotionTypeText::Dynamic,
        mass: Some(3.0),
        at: numbers(at),
        ..RigidBodyText::default()
    });
    vec![Item::RigidBody(scene.rigid_body.len() - 1)]
}

/// Adds a board on a pin; in 3D on two pins, so that it turns about one axis.
fn add_see_saw(scene: &mut Scene, at: Vec3) -> Vec<Item> {
    let mut items = add_plank(scene, at, [0.5, 0.04, 0.15]);
    let number = Some(scene.rigid_body.len());
    let pins: &[f32] = if scene.dim == 2 { &[0.0] } else { &[-0.1, 0.1] };
    for &across in pins {
        let point = numbers(at + Vec3::Z * across);
        let board = JointAnchorText {
            rigid_body: number,
            point,
            ..JointAnchorText::default()
        };
        items.extend(add_joint(
            scene,
            JointKindText::Pin,
            [fixed(Vec3::from(point)), board],
        ));
    }
    items
}

/// Adds a joint. A rope or spring is as long as the distance between its anchors.
fn add_joint(
    scene: &mut Scene,
    kind: JointKindText,
    anchors: [JointAnchorText; 2],
) -> Option<Item> {
    let is_spring = kind == JointKindText::Spring;
    let is_pin = kind == JointKindText::Pin;
    let mut joint = JointText {
        kind,
        anchors: anchors.into(),
        stiffness: is_spring.then_some(200.0),
        damping: is_spring.then_some(20.0),
        length: None,
        breaking_force: (!is_pin).then_some(600.0),
        switch: None,
    };
    joint.length = (!is_pin).then(|| rounded(span(&joint)).max(0.05));
    scene.joint.push(joint);
    Some(Item::Joint(scene.joint.len() - 1))
}

/// Returns the body that is nearest to a position.
fn nearest_body(scene: &Scene, at: Vec3) -> Option<Item> {
    let found = (0..scene.body.len()).map(Item::Body).filter_map(|item| {
        let [low, high] = bounds(scene, item)?;
        Some((item, at.clamp(low, high).distance(at)))
    });
    let nearest = found.min_by(|a, b| a.1.total_cmp(&b.1));
    nearest.map(|(item, _)| item)
}

/// Returns the thing to which a new joint is tied: `holder` if it can be moved, or the nearest body, or the first hand.
fn holder_for(scene: &Scene, at: Vec3, holder: Option<Item>) -> Option<Item> {
    let can_hold = |item: &Item| {
        matches!(item, Item::Body(_) | Item::RigidBody(_) | Item::Hand(_)) && item.is_in(scene)
    };
    holder
        .filter(can_hold)
        .or_else(|| nearest_body(scene, at))
        .or_else(|| first_leader(scene).map(Item::Hand))
}

/// Adds a rope or a spring from a fixed point near a thing to the thing. The fixed point is above the thing where there is room.
fn add_tie(scene: &mut Scene, at: Vec3, kind: JointKindText, holder: Option<Item>) -> Vec<Item> {
    let Some(holder) = holder_for(scene, at, holder) else {
        return Vec::new();
    };
    let Some([low, high]) = bounds(scene, holder) else {
        return Vec::new();
    };
    let middle = 0.5 * (low + high);
    let [least, most] = walls(scene);
    let ways = [Vec3::Y, Vec3::X, Vec3::NEG_X, Vec3::NEG_Y];
    let mut places: Vec<(Vec3, Vec3)> = Vec::new();
    for way in ways {
        let end = middle + way * (0.5 * (high - low) + Vec3::splat(TIE_LENGTH));
        let end = flat(scene.dim, end.max(least).min(most.max(least)));
        places.push((end, middle + way * 0.3 * (high - low)));
    }
    let away = |end: Vec3| end.distance(end.clamp(low, high));
    let has_room = |end: Vec3| away(end) >= LEAST_TIE && holder_at(scene, end).is_none();
    let free = places.iter().find(|(end, _)| has_room(*end));
    let farthest = || places.iter().max_by(|a, b| away(a.0).total_cmp(&away(b.0)));
    let found = free.or_else(farthest).and_then(|&(end, from)| {
        let anchor = anchor_on(scene, holder, from)?;
        Some([fixed(end), anchor])
    });
    let joint = found.and_then(|anchors| add_joint(scene, kind, anchors));
    joint.into_iter().collect()
}

fn add_pin(scene: &mut Scene, at: Vec3, holder: Option<Item>) -> Vec<Item> {
    let Some(holder) = holder_for(scene, at, holder) else {
        return Vec::new();
    };
    let Some([low, high]) = bounds(scene, holder) else {
        return Vec::new();
    };
    // Stays inside the outline of round bodies.
    let margin = (high - low) * 0.25;
    let place = at.clamp(low + margin, high - margin);
    let Some(anchor) = anchor_on(scene, holder, place) else {
        return Vec::new();
    };
    let ends = [fixed(Vec3::from(anchor.point)), anchor];
    let joint = add_joint(scene, JointKindText::Pin, ends);
    joint.into_iter().collect()
}

fn add_switch(scene: &mut Scene, at: Vec3) -> Vec<Item> {
    scene.switch.push(SwitchText {
        boxed: Some(box_text(scene.dim, at, [0.2, 0.1, 0.2])),
        ..SwitchText::default()
    });
    vec![Item::Switch(scene.switch.len() - 1)]
}

fn add_door(scene: &mut Scene, at: Vec3) -> Vec<Item> {
    let beside = in_view(scene, at + Vec3::new(-0.6, -0.3, 0.0));
    let mut items = add_switch(scene, beside);
    let door = ObstacleText {
        path: vec![[0.0; 4], [0.5, 0.0, 0.8, 0.0]],
        max_force: Some(300.0),
        switch: Some(scene.switch.len()),
        ..boxed(scene.dim, at, [0.06, 0.4, 0.3])
    };
    items.extend(add_obstacle(scene, door));
    items
}

fn add_lift(scene: &mut Scene, at: Vec3) -> Vec<Item> {
    let lift = ObstacleText {
        path: vec![[0.0; 4], [2.0, 0.0, 0.8, 0.0], [3.0, 0.0, 0.8, 0.0]],
        repeat: Some(RepeatText::BackAndForth),
        max_force: Some(300.0),
        ..boxed(scene.dim, at, [0.3, 0.05, 0.3])
    };
    add_obstacle(scene, lift)
}

fn add_paddle(scene: &mut Scene, at: Vec3) -> Vec<Item> {
    let paddle = ObstacleText {
        angular_velocity: Some([0.0, 0.0, 0.8]),
        max_torque: Some(200.0),
        ..boxed(scene.dim, at, [0.4, 0.05, 0.3])
    };
    add_obstacle(scene, paddle)
}

fn add_wind(scene: &mut Scene, at: Vec3) -> Vec<Item> {
    scene.field.push(FieldText {
        boxed: Some(box_text(scene.dim, at, [0.3, 0.4, 0.3])),
        acceleration: Some([0.0, 6.0, 0.0]),
        ..FieldText::default()
    });
    vec![Item::Field(scene.field.len() - 1)]
}

fn add_planet(scene: &mut Scene, at: Vec3) -> Vec<Item> {
    scene.field.push(FieldText {
        centre: Some(numbers(at)),
        strength: Some(4.0),
        reach: Some(0.4),
        ..FieldText::default()
    });
    vec![Item::Field(scene.field.len() - 1)]
}

/// Adds a knife to the last obstacle. Its edge runs along the third axis; in 2D it is a point.
fn add_knife(scene: &mut Scene, middle: Vec3, width: f32, toward: Vec3) -> Item {
    let along = flat(scene.dim, Vec3::Z) * (0.5 * width);
    scene.knife.push(KnifeText {
        obstacle: Some(scene.obstacle.len()),
        hand: None,
        rigid_body: None,
        edge: [middle - along, middle + along].map(numbers),
        toward: numbers(toward),
        radius: None,
        height: Some(0.05),
    });
    Item::Knife(scene.knife.len() - 1)
}

fn add_blade(scene: &mut Scene, at: Vec3) -> Vec<Item> {
    let blade = ObstacleText {
        path: vec![[0.0; 4], [1.0, 0.0, -0.5, 0.0]],
        repeat: Some(RepeatText::BackAndForth),
        max_force: Some(600.0),
        ..boxed(scene.dim, at, [0.03, 0.2, 0.3])
    };
    let mut items = add_obstacle(scene, blade);
    items.push(add_knife(scene, at - Vec3::Y * 0.22, 0.6, Vec3::NEG_Y));
    items
}

fn add_saw(scene: &mut Scene, at: Vec3) -> Vec<Item> {
    // Cosines and sines of multiples of 60°.
    const H: f32 = 0.866;
    const TEETH: [[f32; 2]; 6] = [
        [1.0, 0.0],
        [0.5, H],
        [-0.5, H],
        [-1.0, 0.0],
        [-0.5, -H],
        [0.5, -H],
    ];
    let saw = ObstacleText {
        angular_velocity: Some([0.0, 0.0, 3.0]),
        max_torque: Some(200.0),
        ..ball(at, 0.15)
    };
    let mut items = add_obstacle(scene, saw);
    for [x, y] in TEETH {
        let outward = Vec3::new(x, y, 0.0);
        let toward = Vec3::new(-y, x, 0.0);
        items.push(add_knife(scene, at + outward * 0.16, 0.1, toward));
    }
    items
}

/// Returns the radius of a new hand that fits into the view [m].
fn hand_radius(scene: &Scene) -> f32 {
    let room = 0.4 * room_of(scene);
    if room > 0.0 {
        HAND_RADIUS.min(room)
    } else {
        HAND_RADIUS
    }
}

fn add_hand(scene: &mut Scene, text: HandText) -> Item {
    scene.hand.push(text);
    Item::Hand(scene.hand.len() - 1)
}

/// Returns a hand with the shape of the first one at a position.
fn like_first(scene: &Scene, at: Vec3) -> HandText {
    let path = vec![point_of_path(at)];
    match first_leader(scene).map(|index| &scene.hand[index]) {
        Some(first) => HandText {
            path,
            ..first.clone()
        },
        None => HandText {
            radius: Some(hand_radius(scene)),
            boxed: None,
            capsule: None,
            kinematic: false,
            max_force: None,
            friction: None,
            layers: None,
            sensor: false,
            follows: None,
            mirror: None,
            path,
        },
    }
}

fn point_of_path(at: Vec3) -> [f32; 4] {
    let [x, y, z] = numbers(at);
    [0.0, x, y, z]
}

fn add_second_hand(scene: &mut Scene, at: Vec3) -> Vec<Item> {
    if player_count(scene) >= PLAYERS {
        return Vec::new();
    }
    let hand = like_first(scene, at);
    vec![add_hand(scene, hand)]
}

fn add_fork(scene: &mut Scene, at: Vec3) -> Vec<Item> {
    let Some(leader) = first_leader(scene) else {
        return Vec::new();
    };
    let length = 0.3_f32.min(0.4 * room_of(scene)).max(0.01);
    let tine = |across: f32| HandText {
        radius: None,
        boxed: None,
        capsule: Some(CapsuleText {
            from: [0.0; 3],
            to: [length, 0.0, 0.0],
            radius: 0.025_f32.min(0.1 * length),
        }),
        follows: Some(leader + 1),
        ..like_first(scene, at + Vec3::Y * across)
    };
    let tines = [tine(0.07), tine(-0.07)];
    tines
        .into_iter()
        .map(|tine| add_hand(scene, tine))
        .collect()
}

/// Adds the mirror image of the first hand on the other side of a position.
fn add_tongs(scene: &mut Scene, at: Vec3) -> Vec<Item> {
    let Some(leader) = first_leader(scene) else {
        return Vec::new();
    };
    let first = Vec3::from(scene.hand[leader].target(0.0));
    let apart = match (at.y - first.y).abs() < 0.15 {
        true => 0.15_f32.copysign(at.y - first.y),
        false => at.y - first.y,
    };
    let place = in_view(scene, first + Vec3::Y * (2.0 * apart));
    let half = HandText {
        follows: Some(leader + 1),
        mirror: Some(AxisText::Y),
        ..like_first(scene, place)
    };
    vec![add_hand(scene, half)]
}
