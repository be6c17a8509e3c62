//! Bots that only push straight. A level is too simple if one of them wins it.

use super::map::Map;
use super::sight::{clamped, obstacles_of, room_for, unit};
use super::{BRISK, step};
use crate::{InputFrame, Round};
use fuwafuwa::{Dim, DimVector, PieceView, Shape, Vec3};

/// Distance from the start of a push at which the push begins, and from its end at which it ends [m].
const NEAR: f32 = 0.08;
/// Maximum time of one way to the start of a push [ticks]. Then the push begins wherever the hand is.
const PATIENCE: u32 = 240;
/// Time for which the hand presses at the end of a push [ticks].
const PRESS: u32 = 90;
/// Time for which the hand is drawn back after a push [ticks].
const REST: u32 = 90;

/// Bot that goes behind the body, pushes it straight towards the basket, draws back, and pushes again.
#[derive(Clone, Debug)]
pub struct StraightPush {
    /// Whether the bot aims again in each tick, at the largest piece outside the basket. Otherwise all pushes are on
    /// the line of the first one.
    chases: bool,
    /// Start [m] and direction of the first push.
    line: Option<[Vec3; 2]>,
    /// Speed of the pushing hand [m/s].
    speed: f32,
    /// Offset of the line of the push across the body, from −1 to 1, as a share of half the body's width.
    offset: f32,
    stage: Stage,
}

/// Stage of a push, with the number of ticks in it.
#[derive(Copy, Clone, Debug)]
enum Stage {
    /// On the way to the start of the push.
    Reach(u32),
    /// Pushing along the line through a point, in a direction.
    Push([Vec3; 2], u32),
    /// Drawing back against the direction of the push.
    Rest(Vec3, u32),
}

impl StraightPush {
    /// Creates a bot that pushes at `speed` [m/s]. Seeds differ in where the push meets the body: at most a third
    /// of the body's half width beside its middle.
    pub fn new(chases: bool, speed: f32, seed: u64) -> Self {
        let mut random = fastrand::Rng::with_seed(seed);
        Self {
            chases,
            line: None,
            speed,
            offset: (2.0 * random.f32() - 1.0) / 3.0,
            stage: Stage::Reach(0),
        }
    }

    /// Returns the input for the next tick. Without a basket the hand rests.
    pub fn frame<D: Dim>(&mut self, round: &Round<D>) -> InputFrame {
        match self.target(round) {
            Some(target) => InputFrame::towards(target),
            None => InputFrame::default(),
        }
    }

    fn target<D: Dim>(&mut self, round: &Round<D>) -> Option<Vec3> {
        let basket = &round.baskets().first()?.region;
        let hand = round.hands().next()?;
        let radius = hand.shape().inradius();
        let (hand, goal) = (hand.position().to_vec3(), hand.target_position().to_vec3());
        let [low, high] = basket.bounds().map(DimVector::to_vec3);
        let nest = 0.5 * (low + high);
        let aim = aim(round, basket)?;
        let half = 0.5 * (aim.high - aim.low);
        let towards = unit(nest - aim.centre);
        let across = match D::N {
            2 => Vec3::new(-towards.y, towards.x, 0.0),
            _ => unit(towards.cross(Vec3::Y) + Vec3::splat(1e-6)),
        };
        let width = (across * half).length();
        let start = |way: Vec3| {
            let reach = (way * half).length() + 1.1 * radius;
            aim.centre + across * (self.offset * width) - way * reach
        };
        let arena = round.level().arena();
        let deep = nest + towards * (0.5 * (high - low).length());
        let (stage, target) = match self.stage {
            Stage::Reach(ticks) => {
                let aimed = [start(towards), towards];
                let line = match self.chases {
                    true => aimed,
                    false => *self.line.get_or_insert(aimed),
                };
                let place = line[0];
                let is_there = (hand - place).length() < NEAR || ticks > PATIENCE;
                let stage = match is_there {
                    true => Stage::Push(line, 0),
                    false => Stage::Reach(ticks + 1),
                };
                let next = map_of(round, radius).next(hand, place);
                (stage, step(goal, next, BRISK))
            }
            Stage::Push(line, ticks) => {
                let [from, way] = match self.chases {
                    true => [start(towards), towards],
                    false => line,
                };
                // As deep as the far end of the basket, or as the room allows.
                let end = clamped(from + way * (deep - from).dot(way), arena, radius);
                let is_done = (goal - end).length() < NEAR && ticks > PRESS;
                let stage = match is_done || ticks > 4 * PATIENCE {
                    true => Stage::Rest(way, 0),
                    false => Stage::Push([from, way], ticks + 1),
                };
                (stage, step(goal, end, self.speed))
            }
            Stage::Rest(way, ticks) => {
                let stage = match ticks > REST {
                    true => Stage::Reach(0),
                    false => Stage::Rest(way, ticks + 1),
                };
                (stage, step(goal, goal - way, 0.5 * BRISK))
            }
        };
        self.stage = stage;
        Some(target)
    }
}

/// Returns the largest piece with its centre outside the basket; the largest one if all are inside.
fn aim<D: Dim>(round: &Round<D>, basket: &Shape<D>) -> Option<PieceView> {
    let bodies = round.counted_bodies();
    let mut views: Vec<PieceView> = bodies.flat_map(|body| body.piece_views()).collect();
    views.sort_by(|a, b| b.mass.total_cmp(&a.mass));
    let is_out = |view: &&PieceView| basket.distance(D::Vector::from_vec3(view.centre)).0 > 0.0;
    views.iter().find(is_out).or(views.first()).cloned()
}

/// Returns a map of the room for a hand of a radius [m], with its fixed obstacles and all bodies.
fn map_of<D: Dim>(round: &Round<D>, radius: f32) -> Map {
    let mut map = room_for(round.level().arena(), &obstacles_of(round), radius);
    for (_, body) in round.world().soft_bodies() {
        for (id, _) in body.mesh().nodes() {
            map.add(body.node_state(id).0.to_vec3(), 1.0);
        }
    }
    map
}
