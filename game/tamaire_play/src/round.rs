//! Rounds of a level.

use crate::{InputFrame, Level, PLAYERS, Progress};
use fuwafuwa::DEFAULT_TICK;
use fuwafuwa::{Dim, RigidBody, RigidBodyHandle, Shape, StepReport, Vector, World};
use std::sync::Arc;

/// Maximum speed of a hand's target [m/s]. A hand much faster than a wave in the body would throw the body
/// aside before it can deform.
pub const TOP_SPEED: f32 = 6.0;
/// Maximum distance between a hand and its target [m]. The coupling between them already has its maximum
/// force there, so more distance would add nothing. A hand that suddenly comes free does not shoot far.
pub const LEASH: f32 = 0.4;

/// Maximum number of recorded ticks: an hour. A round may last longer.
pub const MAX_TICKS: usize = 60 * 60 * 60;

/// A round of a level.
#[derive(Clone, Debug)]
pub struct Round<D: Dim> {
    level: Arc<Level>,
    world: World<D>,
    basket: Option<Shape>,
    progress: Progress,
    starts: Vec<RigidBody>,
    /// Hands of the players that have joined.
    players: Vec<RigidBodyHandle>,
    frames: Vec<InputFrame>,
    hashes: Vec<u64>,
}

impl<D: Dim> Round<D> {
    /// Starts a round of a level, which must have the dimension `D`.
    ///
    /// # Panics
    /// If the level has another dimension.
    pub fn new(level: Arc<Level>) -> Self {
        let (mut world, basket) = level.build::<D>();
        let hands: Vec<RigidBodyHandle> = world.target_followers().map(|(id, _)| id).collect();
        let starts = hands
            .iter()
            .map(|&id| world.rigid_body(id).unwrap().clone());
        let starts: Vec<RigidBody> = starts.collect();
        // The other hands are added when their players join.
        for &hand in hands.iter().skip(1) {
            world.remove(hand).expect("the world has this hand");
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

    /// Simulates a tick with the input `frame`.
    pub fn step(&mut self, frame: InputFrame) -> StepReport {
        self.let_players_in(&frame);
        for player in 0..self.players.len() {
            let goal = self.reachable(player, frame.goal(player));
            let sent = self.world.set_target_position(self.players[player], goal);
            sent.expect("the hand is in the world, and its target in the arena");
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

    /// Returns the level.
    pub fn level(&self) -> &Arc<Level> {
        &self.level
    }

    /// Returns the world in its current state.
    pub fn world(&self) -> &World<D> {
        &self.world
    }

    /// Returns the hands of the players that have joined, in the order of the players.
    pub fn hands(&self) -> impl ExactSizeIterator<Item = &RigidBody> {
        self.players
            .iter()
            .map(|&hand| self.world.rigid_body(hand).unwrap())
    }

    /// Returns the region to be filled, if the level has one.
    pub fn basket(&self) -> Option<&Shape> {
        self.basket.as_ref()
    }

    /// Returns the start position of a player's hand [m].
    ///
    /// # Panics
    /// If the level has no such hand.
    pub fn start(&self, player: usize) -> Vector {
        self.starts[player].position()
    }

    /// Returns the current progress.
    pub fn progress(&self) -> &Progress {
        &self.progress
    }

    /// Returns the time for which enough mass has rested in the basket, as a share of the required time; 1
    /// after the win.
    pub fn share_held(&self) -> f32 {
        match self.progress.outcome {
            Some(_) => 1.0,
            None => (self.progress.held / self.level.game().hold.max(0.1)).clamp(0.0, 1.0),
        }
    }

    /// Returns the input of each tick until the win, at most [`MAX_TICKS`].
    pub fn frames(&self) -> &[InputFrame] {
        &self.frames
    }

    /// Returns the world's hash after every sixtieth recorded tick, and after the winning one.
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
            let added = added.expect("the world accepted this hand when the level was checked");
            self.players.push(added);
        }
    }

    /// Returns the position nearest to `wish` that the target of a player's hand can reach in a tick. Without
    /// a wish the target stays.
    fn reachable(&self, player: usize, wish: Option<Vector>) -> Vector {
        let hand = self.world.rigid_body(self.players[player]).unwrap();
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

/// Returns the position nearest to `wish` within the distance `most` of `from`.
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
    fn recording_stops_after_an_hour() {
        let mut round = Round::<Dim2>::new(Arc::new(Level::open("sandbox").unwrap()));
        round.frames = vec![InputFrame::default(); MAX_TICKS - 1];
        for _ in 0..3 {
            round.step(InputFrame::default());
        }
        assert_eq!((round.frames.len(), round.hashes.len()), (MAX_TICKS, 1));

        // A win after the end of the recording is not recorded.
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
