//! A round: one attempt at a level.

use crate::playground::{Change, MOST_CHANGES, TimedChange, Tool, ToolState};
use crate::rules::Basket;
use crate::{InputFrame, Level, PLAYERS, Progress};
use fuwafuwa::inspect::is_hand;
use fuwafuwa::{
    DEFAULT_TICK, Dim, Dim3, DimAngular, DimVector, JointAnchor, JointHandle, Knife, KnifeHandle,
    Layers, Reaction, RigidBody, RigidBodyHandle, RigidBodyRef, Shape, SoftBody, StepReport, Vec3,
    World,
};
use fuwafuwa_scenes::Scene;
use fuwafuwa_scenes::scene::Machinery;
use std::mem::discriminant;
use std::sync::Arc;

/// Maximum speed of a hand's target [m/s]. A hand much faster than a wave in the body would throw the body
/// aside before the body can deform.
pub const TOP_SPEED: f32 = 6.0;
/// Maximum distance between a hand and its target [m]. The coupling between hand and target reaches its
/// maximum force within this distance. A larger one would only make a hand shoot far when it suddenly comes
/// free.
pub const LEASH: f32 = 0.4;

/// Maximum number of ticks that are recorded: one hour. A round may last longer.
pub const MAX_TICKS: usize = 60 * 60 * 60;

/// Hand of a player. Its vectors have three coordinates, also in 2D.
#[derive(Clone, Debug, PartialEq)]
pub struct Hand {
    /// Position [m].
    pub position: Vec3,
    /// Target position [m].
    pub target: Vec3,
    /// Velocity [m/s].
    pub velocity: Vec3,
    /// Radius of the largest ball inside the hand [m].
    pub radius: f32,
    /// Forces on the hand in each substep of the last tick.
    pub reactions: Vec<Reaction<Dim3>>,
}

impl<D: Dim> From<RigidBodyRef<'_, D>> for Hand {
    fn from(hand: RigidBodyRef<'_, D>) -> Self {
        let in_3d = |reaction: Reaction<D>| Reaction {
            contact: reaction.contact.to_vec3(),
            torque: reaction.torque.to_vec3(),
            coupling: reaction.coupling.to_vec3(),
        };
        Self {
            position: hand.position().to_vec3(),
            target: hand.target_position().to_vec3(),
            velocity: hand.velocity().linear.to_vec3(),
            radius: hand.local_shape().inradius(),
            reactions: hand.reactions().map(in_3d).collect(),
        }
    }
}

/// A round: one attempt at a level.
#[derive(Clone, Debug)]
pub struct Round<D: Dim> {
    level: Arc<Level>,
    world: World<D>,
    baskets: Vec<Basket<D>>,
    machinery: Machinery<D>,
    progress: Progress,
    /// Hands of all players at the start, whether or not the players have joined.
    starts: Vec<StartHand<D>>,
    /// Hands of the players that have joined.
    players: Vec<PlayerHand>,
    frames: Vec<InputFrame>,
    hashes: Vec<u64>,
    /// Targets of all hands at the start [m].
    targets: Vec<Vec3>,
    /// Number of ticks before the clock started.
    idle_ticks: u64,
    has_begun: bool,
    /// Number of times that time ran back.
    rewinds: u32,
    /// Tool of the first player in a playground.
    tool: ToolState,
    /// Changes of a playground, in the order of their ticks.
    changes: Vec<TimedChange>,
    /// Changes to be made at the beginning of the next tick.
    waiting: Vec<Change>,
}

/// State of a round at a tick, without its recording.
#[derive(Clone, Debug)]
pub(crate) struct RoundState<D: Dim> {
    world: World<D>,
    machinery: Machinery<D>,
    progress: Progress,
    players: Vec<PlayerHand>,
    idle_ticks: u64,
    has_begun: bool,
    tool: ToolState,
}

impl<D: Dim> RoundState<D> {
    /// Returns whether all bodies share their topology with those of another state.
    pub fn shares_topology_with(&self, other: &Self) -> bool {
        let [own, others] = [self, other].map(|state| state.world.soft_bodies());
        let count = |state: &Self| state.world.soft_bodies().count();
        let mut pairs = own.zip(others);
        count(self) == count(other)
            && pairs.all(|((_, own), (_, other))| own.shares_topology_with(other))
    }

    /// Returns the number of ticks since the start of the round.
    pub fn tick(&self) -> u64 {
        self.world.ticks()
    }
}

impl<D: Dim> Round<D> {
    /// Starts a round of a level, which must have the dimension `D`.
    ///
    /// # Panics
    /// If the level has another dimension.
    pub fn new(level: Arc<Level>) -> Self {
        let (mut world, baskets) = level.build::<D>();
        let machinery = Machinery::new(level.scene(), &world);
        let (mut players, starts) = hands_of(level.scene(), &world);
        // Removes the hands of all players except the first, with their joints and knives. The hands return with their
        // knives when their players join, the joints do not.
        for player in players.drain(1.min(players.len())..) {
            for hand in player.parts() {
                for joint in joints_of(&world, hand) {
                    world.remove(joint).expect("the world has this joint");
                }
                for (knife, _) in knives_of(&world, hand) {
                    world.remove(knife).expect("the world has this knife");
                }
                world.remove(hand).expect("the world has this hand");
            }
        }
        Self {
            players,
            progress: Progress::of(&level, &baskets, &world),
            baskets,
            machinery,
            world,
            starts,
            frames: Vec::new(),
            hashes: Vec::new(),
            targets: start_targets(level.scene()),
            idle_ticks: 0,
            has_begun: false,
            rewinds: 0,
            tool: ToolState::default(),
            changes: Vec::new(),
            waiting: Vec::new(),
            level,
        }
    }

    /// Simulates a tick with the input `frame`.
    pub fn step(&mut self, frame: InputFrame) -> StepReport {
        for change in std::mem::take(&mut self.waiting) {
            // A change from a file that cannot be made changes nothing, so the playback differs from the recording.
            let _made = self.make(change);
        }
        self.let_players_in(&frame);
        self.has_begun |= frame.moves_a_hand(&self.targets);
        for player in 0..self.players.len() {
            let hand = self.players[player].hand;
            let goal = self.reachable(hand, frame.goal(player));
            self.send(hand, goal);
            let moved = goal - self.starts[player].hand.position.to_vec3();
            for follower in 0..self.players[player].followers.len() {
                let hand = self.players[player].followers[follower];
                let number = self.starts[player].followers[follower].0;
                let goal = self.level.scene().hand[number].following(moved.to_array());
                let goal = self.reachable(hand, Some(Vec3::from(goal)));
                self.send(hand, goal);
            }
        }
        let report = self.machinery.step(&mut self.world);
        self.use_tool();
        if self.progress.outcome.is_some() {
            return report;
        }
        self.idle_ticks += u64::from(!self.has_begun);
        let clock = self.clock_ticks();
        let hands: Vec<_> = self.players.iter().flat_map(PlayerHand::parts).collect();
        let (level, world) = (&self.level, &self.world);
        self.progress
            .watch(level, &self.baskets, world, &hands, clock);
        if self.frames.len() < MAX_TICKS {
            self.frames.push(frame);
            if self.frames.len().is_multiple_of(60) || self.progress.outcome.is_some() {
                self.hashes.push(self.world.hash());
            }
        }
        report
    }

    /// Returns a copy of the state of the round, without its recording.
    pub(crate) fn state(&self) -> RoundState<D> {
        RoundState {
            world: self.world.clone(),
            machinery: self.machinery.clone(),
            progress: self.progress.clone(),
            players: self.players.clone(),
            idle_ticks: self.idle_ticks,
            has_begun: self.has_begun,
            tool: self.tool.clone(),
        }
    }

    /// Puts the round back into an earlier state. The recording then ends at its tick.
    ///
    /// # Panics
    /// If the state is later than the recording.
    pub(crate) fn restore(&mut self, state: RoundState<D>) {
        let ticks = state.world.ticks() as usize;
        assert!(
            ticks <= self.frames.len(),
            "the recording holds the earlier ticks"
        );
        self.frames.truncate(ticks);
        self.changes.retain(|change| (change.tick as usize) < ticks);
        self.hashes.truncate(ticks / 60);
        self.world = state.world;
        self.machinery = state.machinery;
        self.progress = state.progress;
        self.players = state.players;
        self.idle_ticks = state.idle_ticks;
        self.has_begun = state.has_begun;
        self.tool = state.tool;
        self.waiting.clear();
    }

    /// Returns a round of the same level that goes on from an earlier state. It has no recording.
    pub(crate) fn continued(&self, state: RoundState<D>) -> Self {
        Self {
            level: self.level.clone(),
            world: state.world,
            baskets: self.baskets.clone(),
            machinery: state.machinery,
            progress: state.progress,
            starts: self.starts.clone(),
            players: state.players,
            frames: Vec::new(),
            hashes: Vec::new(),
            targets: self.targets.clone(),
            idle_ticks: state.idle_ticks,
            has_begun: state.has_begun,
            rewinds: 0,
            tool: state.tool,
            changes: Vec::new(),
            waiting: Vec::new(),
        }
    }

    /// Returns the changes of a playground, in the order of their ticks.
    pub fn changes(&self) -> &[TimedChange] {
        &self.changes
    }

    /// Returns the changes of a playground that have been made.
    pub(crate) fn played_changes(&self) -> &[TimedChange] {
        let ticks = self.frames.len();
        let played = { &self.changes }.partition_point(|change| (change.tick as usize) < ticks);
        &self.changes[..played]
    }

    /// Makes those of `changes` again that were made before the next tick.
    pub(crate) fn change_again(&mut self, changes: &[TimedChange]) {
        let tick = self.world.ticks();
        let due = changes
            .iter()
            .filter(|change| u64::from(change.tick) == tick);
        due.for_each(|change| self.note_change(change.change));
    }

    /// Notes a change of a playground, to be made at the beginning of the next tick, and records it.
    pub(crate) fn note_change(&mut self, change: Change) {
        let tick = self.world.ticks();
        // While a slider is dragged in a pause, only its last value counts.
        let is_setting = matches!(
            change,
            Change::Gravity(_) | Change::Air(_) | Change::HandSize(_)
        );
        let is_alike = |last: &Change| discriminant(last) == discriminant(&change);
        if is_setting && self.waiting.last().is_some_and(is_alike) {
            self.waiting.pop();
            self.changes.pop_if(|last| u64::from(last.tick) == tick);
        }
        self.waiting.push(change);
        if tick == self.frames.len() as u64 && self.changes.len() < MOST_CHANGES {
            let tick = tick as u32;
            self.changes.push(TimedChange { tick, change });
        }
    }

    /// Returns the changes that will be made at the beginning of the next tick.
    pub(crate) fn waiting(&self) -> &[Change] {
        &self.waiting
    }

    /// Returns the first player's tool in a playground, and whether it is pressed.
    pub fn tool(&self) -> (Tool, bool) {
        (self.tool.tool, self.tool.is_pressed)
    }

    pub(crate) fn world_mut(&mut self) -> &mut World<D> {
        &mut self.world
    }

    pub(crate) fn tool_mut(&mut self) -> &mut ToolState {
        &mut self.tool
    }

    /// Returns the first player's hand.
    pub(crate) fn first_hand(&self) -> RigidBodyHandle {
        self.players[0].hand
    }

    pub(crate) fn position_of_hand(&self) -> D::Vector {
        self.hand(self.players[0].hand).position()
    }

    pub(crate) fn layers_of_hand(&self) -> Layers {
        self.starts[0].hand.layers
    }

    pub(crate) fn radius_of_hand(&self) -> f32 {
        self.hand(self.players[0].hand).local_shape().inradius()
    }

    /// Replaces the first player's hand by a ball with a radius [m]. It has the same layers, position and target.
    pub(crate) fn resize_hand(&mut self, radius: f32) -> Result<(), fuwafuwa::Error> {
        let old = self.players[0].hand;
        let definition = RigidBody {
            shape: Shape::ball(radius),
            ..self.hand(old).definition()
        };
        // The new hand takes the place of the old one, so the players keep their order.
        self.world.remove(old)?;
        self.players[0].hand = self.world.add_rigid_body(definition)?;
        Ok(())
    }

    /// Counts a rewind of this round.
    pub fn count_rewind(&mut self) {
        self.rewinds += 1;
    }

    /// Returns how often time ran back in this round.
    pub fn rewinds(&self) -> u32 {
        self.rewinds
    }

    /// Returns the level that is played.
    pub fn level(&self) -> &Arc<Level> {
        &self.level
    }

    /// Returns the world in its current state.
    pub fn world(&self) -> &World<D> {
        &self.world
    }

    /// Returns whether nothing falls: the level has no gravity, and no field pulls to a centre.
    pub fn is_weightless(&self) -> bool {
        let mut fields = self.level.scene().field.iter();
        fields.all(|field| field.centre.is_none()) && self.world.config().gravity == D::Vector::ZERO
    }

    /// Returns the hands of the players that have joined, in the order of the players.
    pub fn hands(&self) -> impl ExactSizeIterator<Item = RigidBodyRef<'_, D>> {
        self.players.iter().map(|player| self.hand(player.hand))
    }

    /// See [`AnyRound::hands`](crate::AnyRound::hands).
    pub(crate) fn felt_hands(&self) -> Vec<Hand> {
        let hands = self.players.iter().zip(&self.starts);
        let felt = hands.map(|(player, start)| {
            let mut felt = Hand::from(self.hand(player.hand));
            for (&part, &(number, _)) in player.followers.iter().zip(&start.followers) {
                let text = &self.level.scene().hand[number];
                let [ahead, at_rest] =
                    [[1.0; 3], [0.0; 3]].map(|by| Vec3::from(text.following(by)));
                let way = ahead - at_rest;
                let forces = Hand::from(self.hand(part)).reactions;
                for (sum, force) in felt.reactions.iter_mut().zip(forces) {
                    sum.contact += way * force.contact;
                    sum.coupling += way * force.coupling;
                }
            }
            felt
        });
        felt.collect()
    }

    /// Returns the moving parts of the room.
    pub fn machinery(&self) -> &Machinery<D> {
        &self.machinery
    }

    fn hand(&self, hand: RigidBodyHandle) -> RigidBodyRef<'_, D> {
        let hand = self.world.rigid_body(hand);
        hand.expect("hands of players stay in the world")
    }

    /// Returns the number of nodes of all bodies.
    pub fn nodes(&self) -> usize {
        let bodies = self.world.soft_bodies();
        bodies.map(|(_, body)| body.mesh().node_count()).sum()
    }

    /// Returns the regions to be filled.
    pub fn baskets(&self) -> &[Basket<D>] {
        &self.baskets
    }

    /// Returns the bodies that count; see [`GameText::bodies`](fuwafuwa_scenes::scene::GameText::bodies).
    pub fn counted_bodies(&self) -> impl Iterator<Item = &SoftBody<D>> {
        let bodies = self.world.soft_bodies().map(|(_, body)| body);
        let counts = bodies.zip(&self.progress.counts);
        counts.filter_map(|(body, counts)| counts.then_some(body))
    }

    /// Returns the distance from a position to the nearest node of a soft body [m]. `f32::INFINITY` without
    /// soft bodies.
    pub fn distance_to_bodies(&self, position: D::Vector) -> f32 {
        let position = position.to_vec3();
        let nodes = self.world.soft_bodies().flat_map(|(_, body)| {
            let nodes = body.mesh().nodes();
            nodes.map(|(id, _)| body.positions()[id].xyz())
        });
        let squares = nodes.map(|node| (node - position).length_squared());
        squares.fold(f32::INFINITY, f32::min).sqrt()
    }

    /// Returns the start position of a player's hand [m].
    ///
    /// # Panics
    /// If the level has no such hand.
    pub fn start(&self, player: usize) -> D::Vector {
        self.starts[player].hand.position
    }

    /// Returns the current progress.
    pub fn progress(&self) -> &Progress {
        &self.progress
    }

    /// Returns the time for which enough mass has rested in the basket, as a share of the required time.
    /// After the win it is 1.
    pub fn share_held(&self) -> f32 {
        match self.progress.outcome {
            Some(_) => 1.0,
            None => (self.progress.held / self.level.game().hold.max(0.1)).clamp(0.0, 1.0),
        }
    }

    /// Returns the input of each tick up to the win, of at most [`MAX_TICKS`] ticks.
    pub fn frames(&self) -> &[InputFrame] {
        &self.frames
    }

    /// Returns the number of ticks on the clock. The clock starts with the first input that moves a hand away
    /// from its start, and it goes on after a win.
    pub fn clock_ticks(&self) -> u64 {
        self.world.ticks() - self.idle_ticks
    }

    /// Returns the number of ticks before the clock started.
    pub(crate) fn idle_ticks(&self) -> u64 {
        self.idle_ticks
    }

    /// Returns the world's hash after every sixtieth recorded tick, and after the tick that won.
    pub fn hashes(&self) -> &[u64] {
        &self.hashes
    }

    fn let_players_in(&mut self, frame: &InputFrame) {
        for player in self.players.len()..self.starts.len().min(PLAYERS) {
            if frame.goals[player].is_none() {
                break;
            }
            let mut add = |hand: RigidBody<D>| {
                let added = self.world.add_rigid_body(hand);
                added.expect("the world accepted this hand when the level was checked")
            };
            let start = &self.starts[player];
            let hand = add(start.hand);
            let followers = start.followers.iter();
            let followers = followers.map(|&(_, hand)| add(hand)).collect();
            let player = PlayerHand { hand, followers };
            for (holder, knives) in player.parts().zip(&start.knives) {
                for knife in knives {
                    let added = self.world.add_knife(Knife { holder, ..*knife });
                    added.expect("the world accepted this knife when the level was checked");
                }
            }
            self.players.push(player);
        }
    }

    /// Sets the target of a hand [m].
    fn send(&mut self, hand: RigidBodyHandle, goal: Vec3) {
        let sent = { &mut self.world }.set_target_position(hand, D::Vector::from_vec3(goal));
        sent.expect("the hand is in the world, and its target in the arena");
    }

    /// Returns the position nearest to `wish` that the target of a hand can reach in a tick. Without a `wish`, the
    /// target keeps its position.
    fn reachable(&self, hand: RigidBodyHandle, wish: Option<Vec3>) -> Vec3 {
        let hand = self.hand(hand);
        let target = hand.target_position().to_vec3();
        let [low, high] = self.level.arena();
        let [first, last] = hand.local_shape().bounds();
        let mut goal = wish.unwrap_or(target);
        for axis in 0..D::N {
            let half = 0.5 * (high[axis] - low[axis]);
            let [below, above] = [-first[axis], last[axis]].map(|k| k.min(half));
            goal[axis] = goal[axis].clamp(low[axis] + below, high[axis] - above);
        }
        let goal = near(target, goal, TOP_SPEED * DEFAULT_TICK);
        near(hand.position().to_vec3(), goal, LEASH)
    }
}

/// Hand of a player at the start of a round.
#[derive(Clone, Debug)]
struct StartHand<D: Dim> {
    hand: RigidBody<D>,
    /// Hands that follow it, and their indices in the scene.
    followers: Vec<(usize, RigidBody<D>)>,
    /// Knives of the hand and of each hand that follows it.
    knives: Vec<Vec<Knife<D>>>,
}

/// Hand of a player in the world.
#[derive(Clone, Debug)]
struct PlayerHand {
    hand: RigidBodyHandle,
    /// Hands that follow it, in the order of [`StartHand::followers`].
    followers: Vec<RigidBodyHandle>,
}

impl PlayerHand {
    /// Returns all rigid bodies of the hand.
    fn parts(&self) -> impl Iterator<Item = RigidBodyHandle> {
        std::iter::once(self.hand).chain(self.followers.iter().copied())
    }
}

/// Returns the hands of all players of a world at the start.
fn hands_of<D: Dim>(scene: &Scene, world: &World<D>) -> (Vec<PlayerHand>, Vec<StartHand<D>>) {
    let bodies = world.rigid_bodies();
    let all: Vec<_> = bodies.filter(|&(_, body)| is_hand(body)).collect();
    let leader = |index: usize| scene.hand.get(index).and_then(|text| text.follows);
    let leaders = (0..all.len()).filter(|&index| leader(index).is_none());
    let hands = leaders.map(|index| {
        let followers = (0..all.len()).filter(|&other| leader(other) == Some(index + 1));
        let (handles, starts) = followers
            .map(|other| (all[other].0, (other, all[other].1.definition())))
            .unzip();
        let player = PlayerHand {
            hand: all[index].0,
            followers: handles,
        };
        let knives = player.parts().map(|hand| {
            let knives = knives_of(world, hand).into_iter();
            knives.map(|(_, knife)| knife).collect()
        });
        let start = StartHand {
            hand: all[index].1.definition(),
            followers: starts,
            knives: knives.collect(),
        };
        (player, start)
    });
    hands.unzip()
}

/// Returns the joints of a rigid body.
fn joints_of<D: Dim>(world: &World<D>, rigid: RigidBodyHandle) -> Vec<JointHandle> {
    let is_on = |anchor: JointAnchor<D>| match anchor {
        JointAnchor::RigidBody { body, .. } => body == rigid,
        _ => false,
    };
    let joints = world.joints();
    let joints = joints.filter(|(_, joint)| joint.definition().anchors.into_iter().any(is_on));
    joints.map(|(joint, _)| joint).collect()
}

/// Returns the knives of a rigid body.
fn knives_of<D: Dim>(world: &World<D>, rigid: RigidBodyHandle) -> Vec<(KnifeHandle, Knife<D>)> {
    let knives = world.knives();
    let knives = knives.map(|(handle, knife)| (handle, knife.definition()));
    knives.filter(|(_, knife)| knife.holder == rigid).collect()
}

/// Returns the targets of all hands of a level at the start [m]. In 2D the third coordinate is zero.
pub(crate) fn start_targets(scene: &Scene) -> Vec<Vec3> {
    // `hand_targets(0)` would be the targets at the end of the first tick.
    let hands = scene.hand.iter().filter(|hand| hand.follows.is_none());
    let targets = hands.map(|hand| Vec3::from(hand.target(0.0)));
    match scene.dim {
        2 => targets.map(|target| target.with_z(0.0)).collect(),
        _ => targets.collect(),
    }
}

/// Returns the position nearest to `wish` that is at most `most` [m] from `from`.
fn near(from: Vec3, wish: Vec3, most: f32) -> Vec3 {
    let way = wish - from;
    let distance = way.length();
    let share = if distance > most {
        most / distance
    } else {
        1.0
    };
    from + way * share
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Replay, Route};
    use fuwafuwa::{Dim2, KnifeRef};

    #[test]
    fn recording_stops_after_an_hour() {
        let mut round = Round::<Dim2>::new(Arc::new(Level::open("sandbox").unwrap()));
        round.frames = vec![InputFrame::default(); MAX_TICKS - 1];
        for _ in 0..3 {
            round.step(InputFrame::default());
        }
        assert_eq!((round.frames.len(), round.hashes.len()), (MAX_TICKS, 1));

        // A win in a tick that was not recorded must not be recorded either.
        round.progress.outcome = Some(crate::Outcome {
            ticks: MAX_TICKS as u64 + 1,
            route: Route::Squeeze,
            kept: 1.0,
            inside: 1.0,
            pieces: 1,
            lost: 0,
            broken: 0,
            torn: 0,
        });
        assert_eq!(Replay::of(&round).outcome, None);
    }

    #[test]
    fn forces_on_a_mirrored_part_count_opposite() {
        let level = Arc::new(Level::open("mirror-hands").unwrap());
        let path = crate::level::PATH.iter().find(|known| known.id == level.id);
        let way = path.unwrap().ways().way.remove(0);
        let mut round = Round::<Dim2>::new(level);
        // Both hands press the body from its sides.
        for tick in 0..210 {
            round.step(way.frame(tick));
        }
        let [leader, follower] = {
            let player = &round.players[0];
            [player.hand, player.followers[0]].map(|hand| Hand::from(round.hand(hand)))
        };
        let felt = &round.felt_hands()[0];
        let pushes = |hand: &Hand| {
            hand.reactions
                .iter()
                .map(|reaction| reaction.contact.x)
                .sum::<f32>()
        };
        assert!(
            pushes(&leader) < -1.0 && pushes(&follower) > 1.0,
            "they press"
        );
        let expected = pushes(&leader) - pushes(&follower);
        assert!((pushes(felt) - expected).abs() < 1e-3 * expected.abs());
        let lifts = |hand: &Hand| {
            hand.reactions
                .iter()
                .map(|reaction| reaction.contact.y)
                .sum::<f32>()
        };
        assert!((lifts(felt) - lifts(&leader) - lifts(&follower)).abs() < 1e-2);
    }

    #[test]
    fn start_targets_of_a_moving_hand_are_at_the_beginning_of_its_path() {
        let mut scene = Level::open("classic").unwrap().scene().clone();
        scene.hand[0].path = vec![[0.0, 1.0, 2.0, 0.0], [1.0, 7.0, 2.0, 0.0]];
        assert_eq!(start_targets(&scene)[0], Vec3::new(1.0, 2.0, 0.0));
    }

    #[test]
    fn second_hand_returns_with_its_knife() {
        let text = include_str!("../levels/classic.toml");
        let edge = "edge = [[-1.4, 0.0, 0.0], [-1.4, 0.0, 0.0]]\ntoward = [1.0, 0.0, 0.0]\n";
        let knives = [1, 2]
            .map(|hand| format!("[[knife]]\nhand = {hand}\n{edge}"))
            .concat();
        let text = format!("{text}\n{knives}");
        let none = |_: &str| Err(std::io::ErrorKind::NotFound.into());
        let level = Level::read("knives", text.as_bytes(), &none).unwrap();
        let mut round = Round::<Dim2>::new(Arc::new(level));
        assert_eq!(round.world().knives().count(), 1);
        round.step(InputFrame::default().with(1, round.start(1).to_vec3()));
        let knives = round.world().knives();
        let holder =
            |knife: KnifeRef<'_, Dim2>| round.world().rigid_body(knife.definition().holder);
        let holders: Vec<_> = knives.map(|(_, knife)| holder(knife).unwrap()).collect();
        assert_eq!(holders.len(), 2);
        assert_ne!(holders[0].position(), holders[1].position());
        assert!(holders.iter().all(|holder| is_hand(*holder)) && round.hands().len() == 2);
    }
}
