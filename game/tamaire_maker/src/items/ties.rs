//! Ends of ropes, springs and pins: what is at a place, and tying an end to it.

use super::additions::walls;
use super::bounds::{bounds, built_alone, grid_size, rotation_of};
use super::movement::{keep_slack, span};
use super::{Item, flat, holder_of_anchor, rounded};
use fuwafuwa::{Dim, Dim2, Dim3, Rotation, Vec3};
use fuwafuwa_scenes::Scene;
use fuwafuwa_scenes::scene::{BodyText, BoxText, CapsuleText, JointAnchorText, JointKindText};
use std::cell::RefCell;
use std::rc::Rc;

/// Distance from a thing up to which an end is tied to it [m].
const TOUCH: f32 = 0.03;

/// Radius within which an end holds the nodes of a body [m].
const TIE_RADIUS: f32 = 0.06;

/// Distance between two places that are tried along a line of sight [m].
const STEP: f32 = 0.02;

/// Maximum number of steps to the middle of the nodes that an end holds.
const MAX_STEPS: usize = 50;

/// Maximum number of bodies whose nodes are kept.
const MAX_KNOWN: usize = 16;

/// Nodes of a body that was built lately.
struct Known {
    dim: u8,
    materials: usize,
    text: BodyText,
    /// Positions of the nodes for a body at the origin [m]. Empty if the body cannot be built.
    nodes: Rc<[Vec3]>,
}

thread_local! {
    static KNOWN: RefCell<Vec<Known>> = const { RefCell::new(Vec::new()) };
}

/// Nodes of a body, and the position of the body [m].
struct Nodes {
    nodes: Rc<[Vec3]>,
    at: Vec3,
}

impl Nodes {
    /// Returns the nodes of a body at the start. The body is built if it was not built lately.
    fn of(scene: &Scene, index: usize) -> Option<Self> {
        let text = scene.body.get(index)?;
        let at = match text.state {
            Some(_) => Vec3::ZERO,
            None => flat(scene.dim, Vec3::from(text.at)),
        };
        let nodes = KNOWN.with_borrow_mut(|known| {
            known.iter_mut().find_map(|known| {
                known.text.at = text.at;
                let is_same = (known.dim, known.materials) == (scene.dim, scene.material.len());
                (is_same && known.text == *text).then(|| known.nodes.clone())
            })
        });
        let nodes = nodes.unwrap_or_else(|| {
            let nodes: Rc<[Vec3]> = match scene.dim {
                2 => built::<Dim2>(scene, text),
                _ => built::<Dim3>(scene, text),
            }
            .into_iter()
            .map(|node| node - at)
            .collect();
            KNOWN.with_borrow_mut(|known| {
                if known.len() >= MAX_KNOWN {
                    known.remove(0);
                }
                known.push(Known {
                    dim: scene.dim,
                    materials: scene.material.len(),
                    text: text.clone(),
                    nodes: nodes.clone(),
                });
            });
            nodes
        });
        (!nodes.is_empty()).then_some(Self { nodes, at })
    }

    /// Returns the node that is nearest to a position [m].
    fn nearest(&self, to: Vec3) -> Vec3 {
        let to = to - self.at;
        let nodes = self.nodes.iter().copied();
        let nearest = nodes.min_by(|a, b| {
            (*a - to)
                .length_squared()
                .total_cmp(&(*b - to).length_squared())
        });
        nearest.unwrap_or(to) + self.at
    }

    /// Returns the position near another one that is the middle of the nodes that an anchor there holds [m]. So the end is
    /// where the editor shows it, and a rope is as long as it seems.
    fn middle_near(&self, at: Vec3, radius: f32) -> Vec3 {
        let mut place = at;
        for _ in 0..MAX_STEPS {
            let middle = self.held_at(place, radius);
            if middle.distance(place) < 1e-5 {
                break;
            }
            place = middle;
        }
        place
    }

    /// Returns the middle of the nodes that an anchor at a position holds [m].
    fn held_at(&self, at: Vec3, radius: f32) -> Vec3 {
        let place = at - self.at;
        let near = self
            .nodes
            .iter()
            .filter(|node| node.distance(place) <= radius);
        let (sum, count) = near.fold((Vec3::ZERO, 0), |(sum, count), node| {
            (sum + *node, count + 1)
        });
        match count {
            0 => self.nearest(at),
            _ => sum / count as f32 + self.at,
        }
    }
}

/// Returns the positions of the nodes of a body [m].
fn built<D: Dim>(scene: &Scene, text: &BodyText) -> Vec<Vec3> {
    let Some(world) = built_alone::<D>(scene, text) else {
        return Vec::new();
    };
    let nodes = world.soft_bodies().flat_map(|(_, body)| {
        let nodes = body.mesh().nodes();
        nodes.map(|(id, _)| body.positions()[id].xyz())
    });
    nodes.collect()
}

/// Returns the body, obstacle, hand or rigid body at a position [m], or within 3 cm of it. Walls without an end, which are
/// half-spaces, are left out.
pub fn holder_at(scene: &Scene, at: Vec3) -> Option<Item> {
    let at = flat(scene.dim, at);
    let all = (0..scene.body.len()).map(Item::Body);
    let all = all.chain((0..scene.obstacle.len()).map(Item::Obstacle));
    let all = all.chain((0..scene.hand.len()).map(Item::Hand));
    let all = all.chain((0..scene.rigid_body.len()).map(Item::RigidBody));
    let near = all.filter_map(|item| {
        let [low, high] = bounds(scene, item)?;
        if at.distance(at.clamp(low.min(high), high.max(low))) > TOUCH {
            return None;
        }
        let distance = distance_to(scene, item, at)?;
        (distance <= TOUCH).then_some((item, distance, (high - low).length()))
    });
    // Of two things at the same place, the smaller one is above.
    let nearest = near.min_by(|a, b| a.1.total_cmp(&b.1).then(a.2.total_cmp(&b.2)));
    nearest.map(|(item, ..)| item)
}

/// Returns the first place on a ray at which [`holder_at`] finds something [m], up to a distance `most` [m].
pub fn first_hit(scene: &Scene, (from, way): (Vec3, Vec3), most: f32) -> Option<Vec3> {
    let boxes: Vec<[Vec3; 2]> = super::items(scene)
        .into_iter()
        .filter_map(|item| bounds(scene, item))
        .collect();
    let is_near = |at: Vec3| {
        let mut boxes = boxes.iter();
        boxes.any(|[low, high]| at.distance(at.clamp(*low, *high)) <= TOUCH)
    };
    let steps = (most / STEP).clamp(0.0, 2000.0) as usize;
    let mut places = (0..steps).map(|step| from + way * (step as f32 * STEP));
    places.find(|&at| is_near(at) && holder_at(scene, at).is_some())
}

/// Returns the distance of a position from the shape of an item [m], 0 inside of it.
fn distance_to(scene: &Scene, item: Item, at: Vec3) -> Option<f32> {
    let of = |boxed: Option<&BoxText>, capsule: Option<&CapsuleText>, ball: Option<_>, at: Vec3| {
        let at = flat(scene.dim, at);
        let boxed = boxed.map(|shape| {
            let beyond = (at - Vec3::from(shape.centre)).abs() - Vec3::from(shape.half);
            flat(scene.dim, beyond).max(Vec3::ZERO).length()
        });
        let capsule = capsule.map(|shape| {
            let (from, to) = (Vec3::from(shape.from), Vec3::from(shape.to));
            let along = to - from;
            let share = (at - from).dot(along) / along.length_squared().max(1e-12);
            let nearest = from + along * share.clamp(0.0, 1.0);
            (at.distance(nearest) - shape.radius).max(0.0)
        });
        let ball =
            ball.map(|(centre, radius): (Vec3, f32)| (at.distance(centre) - radius).max(0.0));
        boxed.or(capsule).or(ball)
    };
    match item {
        Item::Body(index) => {
            let nodes = Nodes::of(scene, index)?;
            let voxel = grid_size(scene, &scene.body[index]).voxel;
            Some((nodes.nearest(at).distance(at) - voxel).max(0.0))
        }
        Item::Obstacle(index) => {
            let text = scene.obstacle.get(index)?;
            let ball = text.ball.as_ref();
            let ball = ball.map(|shape| (Vec3::from(shape.centre), shape.radius));
            of(text.boxed.as_ref(), text.capsule.as_ref(), ball, at)
        }
        Item::Hand(index) => {
            let text = scene.hand.get(index)?;
            let ball = text.radius.map(|radius| (Vec3::ZERO, radius));
            let at = at - Vec3::from(text.target(0.0));
            of(text.boxed.as_ref(), text.capsule.as_ref(), ball, at)
        }
        Item::RigidBody(index) => {
            let text = scene.rigid_body.get(index)?;
            let ball = text.ball.as_ref();
            let ball = ball.map(|shape| (Vec3::from(shape.centre), shape.radius));
            let back: Rotation = rotation_of(text).inverse();
            let at = back.apply(at - Vec3::from(text.at));
            of(text.boxed.as_ref(), text.capsule.as_ref(), ball, at)
        }
        _ => None,
    }
}

/// Returns an anchor at the place on an item that is nearest to a position [m]; `None` if nothing can be tied to the item. A
/// body is held by its nodes, a rigid thing at the position itself.
pub(super) fn anchor_on(scene: &Scene, item: Item, at: Vec3) -> Option<JointAnchorText> {
    let at = flat(scene.dim, at);
    let mut anchor = fixed(at);
    match item {
        Item::Body(index) => {
            let nodes = Nodes::of(scene, index)?;
            let place = nodes.middle_near(at, TIE_RADIUS);
            anchor = fixed(place);
            (anchor.body, anchor.radius) = (Some(index + 1), Some(TIE_RADIUS));
        }
        Item::Obstacle(index) => anchor.obstacle = Some(index + 1),
        Item::Hand(index) => anchor.hand = Some(index + 1),
        Item::RigidBody(index) => anchor.rigid_body = Some(index + 1),
        _ => return None,
    }
    Some(anchor)
}

/// Returns an anchor at a fixed place of the room [m].
pub(super) fn fixed(at: Vec3) -> JointAnchorText {
    JointAnchorText {
        point: at.to_array().map(rounded),
        ..JointAnchorText::default()
    }
}

/// Moves the end of a rope or spring to a position, which is brought into the room [m]. It is tied to what is there, see
/// [`holder_at`], otherwise it is fixed in the room. Returns whether that is possible: a rope needs something at one end at
/// least, and not the same rigid thing at both.
///
/// A rope or spring keeps its slack, see [`translate`](super::translate).
pub fn tie_end(scene: &mut Scene, joint: usize, end: usize, to: Vec3) -> bool {
    let is_tie = ends_of(scene, Item::Joint(joint)).is_some() && end < 2;
    if !is_tie || !to.is_finite() {
        return false;
    }
    let other = holder_of_anchor(&scene.joint[joint].anchors[1 - end]);
    let [low, high] = walls(scene);
    let to = flat(scene.dim, to.max(low).min(high.max(low)));
    let holder = holder_at(scene, to);
    let is_same_rigid = holder == other && !matches!(holder, Some(Item::Body(_)));
    if is_same_rigid {
        return false;
    }
    let anchor = holder.and_then(|item| anchor_on(scene, item, to));
    let anchor = match (anchor, other) {
        (Some(anchor), _) => anchor,
        (None, Some(_)) => fixed(to),
        (None, None) => return false,
    };
    let text = &mut scene.joint[joint];
    let before = (span(text), text.length);
    text.anchors[end] = anchor;
    keep_slack(text, before);
    true
}

/// Moves the ends of ropes and springs that are tied to a body to the nearest places in it, after the body was drawn anew. They
/// keep their slack.
pub fn tie_again(scene: &mut Scene, body: usize) {
    for joint in 0..scene.joint.len() {
        if ends_of(scene, Item::Joint(joint)).is_none() {
            continue;
        }
        let before = (span(&scene.joint[joint]), scene.joint[joint].length);
        for end in 0..2 {
            let anchor = &scene.joint[joint].anchors[end];
            if holder_of_anchor(anchor) != Some(Item::Body(body)) {
                continue;
            }
            let (at, radius) = (Vec3::from(anchor.point), anchor.radius);
            if let Some(anchor) = anchor_on(scene, Item::Body(body), at) {
                let radius = radius.or(anchor.radius);
                scene.joint[joint].anchors[end] = JointAnchorText { radius, ..anchor };
            }
        }
        keep_slack(&mut scene.joint[joint], before);
    }
}

/// Returns the positions of the ends of a rope or spring [m]; `None` for other items.
pub fn ends_of(scene: &Scene, item: Item) -> Option<[Vec3; 2]> {
    let Item::Joint(index) = item else {
        return None;
    };
    let text = scene.joint.get(index)?;
    match &text.anchors[..] {
        [from, to] if text.kind != JointKindText::Pin => {
            Some([from, to].map(|anchor| Vec3::from(anchor.point)))
        }
        _ => None,
    }
}
