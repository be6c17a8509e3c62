//! One go at a level.

use crate::{InputFrame, Level, PLAYERS, Progress};
use fuwafuwa::world::TICK;
use fuwafuwa::{Dim, RigidBody, RigidBodyHandle, Shape, StepReport, Vector, World};
use std::sync::Arc;

/// A hand's goal moves no faster than this [m/s]: what is much faster than a wave in the body
/// throws it aside before it can give way.
pub const TOP_SPEED: f32 = 6.0;
/// A goal is never further from its hand than this [m]: there the coupling pulls as strongly as it
/// can, and a hand that comes free has no long way to shoot.
pub const LEASH: f32 = 0.4;

/// Most ticks that are recorded: an hour. A round may go on for longer.
pub const MAX_TICKS: usize = 60 * 60 * 60;

/// One go at a level, from the first tick on.
#[derive(Clone, Debug)]
pub struct Round<D: Dim> {
    level: Arc<Level>,
    world: World<D>,
    basket: Option<Shape>,
    progress: Progress,
    starts: Vec<RigidBody>,
    /// The hand of each player who has joined.
    players: Vec<RigidBodyHandle>,
    frames: Vec<InputFrame>,
    hashes: Vec<u64>,
}

impl<D: Dim> Round<D> {
    /// The start of a round. `level` must be of this dimension.
    ///
    /// # Panics
    /// When the level is of another dimension.
    pub fn new(level: Arc<Level>) -> Self {
        let (mut world, basket) = level.build::<D>();
        let hands: Vec<RigidBodyHandle> = world.target_followers().map(|(id, _)| id).collect();
        let starts = hands.iter().map(|&id| world.rigid_bodies()[id].clone());
        let starts: Vec<RigidBody> = starts.collect();
        // The others come in when their players join.
        for &hand in hands.iter().skip(1) {
            world.remove_rigid_body(hand).expect("it is in the world");
        }
        Self {
            players: hands.into_iter().take(1).collect(),
            progress: Progress::of(&world),
            basket,
            world,
            starts,
            frames: Vec::new(),
            hashes: Vec::new(),
            level,
        }
    }

    /// Lets a tick pass in which the players want what `frame` says.
    pub fn step(&mut self, frame: InputFrame) -> StepReport {
        self.let_players_in(&frame);
        for player in 0..self.players.len() {
            let goal = self.reachable(player, frame.goal(player));
            let sent = self.world.set_target_position(self.players[player], goal);
            sent.expect("a hand is in the world, and its goal in the arena");
        }
        let report = self.world.step();
        if self.progress.outcome.is_some() {
            return report;
        }
        let basket = self.basket.as_ref();
        self.progress.watch(&self.level, basket, &self.world);
        if self.frames.len() < MAX_TICKS {
            self.frames.push(frame);
            if self.frames.len().is_multiple_of(60) || self.progress.outcome.is_some() {
                self.hashes.push(self.world.hash());
            }
        }
        report
    }

    /// The level.
    pub fn level(&self) -> &Arc<Level> {
        &self.level
    }

    /// The world as it is now.
    pub fn world(&self) -> &World<D> {
        &self.world
    }

    /// The hands of the players who have joined, in their order.
    pub fn hands(&self) -> impl ExactSizeIterator<Item = &RigidBody> {
        self.players
            .iter()
            .map(|&hand| &self.world.rigid_bodies()[hand])
    }

    /// The region that has to be filled, where the level has one.
    pub fn basket(&self) -> Option<&Shape> {
        self.basket.as_ref()
    }

    /// Where a player's hand comes in [m].
    ///
    /// # Panics
    /// When the level has no such hand.
    pub fn start(&self, player: usize) -> Vector {
        self.starts[player].position()
    }

    /// How far it has come.
    pub fn progress(&self) -> &Progress {
        &self.progress
    }

    /// For which share of the time that it has to rest in the basket enough has rested there; 1 once
    /// it is won.
    pub fn share_held(&self) -> f32 {
        match self.progress.outcome {
            Some(_) => 1.0,
            None => (self.progress.held / self.level.game().hold.max(0.1)).clamp(0.0, 1.0),
        }
    }

    /// What was played until it was won, tick by tick; [`MAX_TICKS`] at most.
    pub fn frames(&self) -> &[InputFrame] {
        &self.frames
    }

    /// The world's hash after every sixtieth of those ticks, and after the last when it was won.
    pub fn hashes(&self) -> &[u64] {
        &self.hashes
    }

    fn let_players_in(&mut self, frame: &InputFrame) {
        for player in self.players.len()..self.starts.len().min(PLAYERS) {
            if frame.goals[player].is_none() {
                break;
            }
            let hand = self.starts[player].clone();
            let added = self.world.add_rigid_body(hand);
            let added = added.expect("it was in this world when the level was checked");
            self.players.push(added);
        }
    }

    /// The place nearest to a wish to which a goal can move in a tick.
    fn reachable(&self, player: usize, wish: Option<Vector>) -> Vector {
        let hand = &self.world.rigid_bodies()[self.players[player]];
        let [low, high] = self.level.arena();
        let [first, last] = hand.form().bounds();
        let mut goal = wish.unwrap_or(hand.target_position());
        for axis in 0..D::N {
            let half = 0.5 * (high[axis] - low[axis]);
            let [below, above] = [-first[axis], last[axis]].map(|k| k.min(half));
            goal[axis] = goal[axis].clamp(low[axis] + below, high[axis] - above);
        }
        let goal = near(hand.target_position(), goal, TOP_SPEED * TICK);
        near(hand.position(), goal, LEASH)
    }
}

/// The place nearest to `wish` that is no further than `most` from `from`.
fn near(from: Vector, wish: Vector, most: f32) -> Vector {
    let way = [0, 1, 2].map(|axis| wish[axis] - from[axis]);
    let distance = way.iter().map(|k| k * k).sum::<f32>().sqrt();
    let share = if distance > most {
        most / distance
    } else {
        1.0
    };
    [0, 1, 2].map(|axis| from[axis] + share * way[axis])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Replay, Route};
    use fuwafuwa::Dim2;

    #[test]
    fn what_goes_on_for_ever_is_recorded_for_an_hour() {
        let mut round = Round::<Dim2>::new(Arc::new(Level::open("sandbox").unwrap()));
        round.frames = vec![InputFrame::default(); MAX_TICKS - 1];
        for _ in 0..3 {
            round.step(InputFrame::default());
        }
        assert_eq!((round.frames.len(), round.hashes.len()), (MAX_TICKS, 1));

        // Won after that, which the record does not show.
        round.progress.outcome = Some(crate::Outcome {
            ticks: MAX_TICKS as u64 + 1,
            route: Route::Squeeze,
            kept: 1.0,
            inside: 1.0,
            pieces: 1,
            lost: 0,
        });
        assert_eq!(Replay::of(&round).outcome, None);
    }
}
