//! One round of a learning program: opening, steps, end.

use super::observation::{mean_distance, names, observe};
use super::reward::{Reward, Standing};
use fuwafuwa::{DEFAULT_TICK, Dim, DimVector, MotionType, Shape, Vec3};
use std::sync::Arc;
use tamaire_play::{AnyRound, InputFrame, Level, Round};

/// Speed of the hands in the opening [m/s].
const OPENING_SPEED: f32 = 3.0;
/// Maximum duration of the opening [ticks].
const OPENING_TICKS: u32 = 90;
/// Distance from its place at which a hand ends the opening [m].
const ARRIVED: f32 = 0.03;
/// Minimum distance between the way of a hand in the opening, and bodies and obstacles, beyond its radius [m].
const CLEARANCE: f32 = 0.03;
/// Number of places that are tried for a hand.
const TRIES: usize = 64;
/// Number of points of a way that are checked.
const POINTS: usize = 24;

/// Settings of all episodes.
pub struct Settings {
    pub level: Arc<Level>,
    pub reward: Reward,
    /// Number of ticks in a step.
    pub ticks: u32,
    /// Speed of a hand's target for an action of 1 [m/s].
    pub max_speed: f32,
    /// Number of steps after which an episode is truncated; 0 for no limit.
    pub max_steps: u32,
    /// Number of pieces beyond which an episode is lost; 0 for no limit.
    pub max_pieces: usize,
    /// Number of hands.
    pub players: usize,
    /// Whether the hands move to random places before the first step.
    pub random_start: bool,
}

/// Evaluates an expression for the round of either dimension.
macro_rules! both {
    ($any:expr, $one:ident => $act:expr) => {
        match $any {
            AnyRound::Plane($one) => $act,
            AnyRound::Space($one) => $act,
        }
    };
}

impl Settings {
    /// Returns the number of dimensions.
    pub fn dim(&self) -> usize {
        usize::from(self.level.scene().dim)
    }

    /// Returns the number of numbers in an action.
    pub fn action_size(&self) -> usize {
        self.players * self.dim()
    }

    /// Returns the state of a round that rewards depend on.
    fn standing_of(&self, round: &AnyRound) -> Standing {
        let distance = both!(round, round => mean_distance(round));
        self.reward.standing(round, distance)
    }

    /// Returns the names of the numbers of an observation.
    pub fn observation_names(&self) -> Vec<String> {
        names(self.dim(), self.players)
    }
}

/// Result of a step.
#[derive(Default)]
pub struct Step {
    pub reward: f64,
    /// Whether the round was won or lost.
    pub terminated: bool,
    /// Whether the time is up.
    pub truncated: bool,
}

/// An episode: a round, its random numbers and its number of steps.
#[derive(Clone)]
pub struct Episode {
    settings: Arc<Settings>,
    round: AnyRound,
    random: fastrand::Rng,
    steps: u32,
    standing: Standing,
}

impl Episode {
    /// Creates an episode whose round has not begun; see [`Self::reset`].
    pub fn new(settings: Arc<Settings>) -> Self {
        let round = AnyRound::new(settings.level.clone());
        let random = fastrand::Rng::with_seed(0);
        Self {
            standing: settings.standing_of(&round),
            settings,
            round,
            random,
            steps: 0,
        }
    }

    /// Returns a copy whose random numbers differ from those of all others, until a seed is set.
    pub fn with_own_random_numbers(&self) -> Self {
        let random = fastrand::Rng::new();
        Self {
            random,
            ..self.clone()
        }
    }

    /// Returns whether a round was started, which plays the ticks of its opening.
    pub fn has_begun(&self) -> bool {
        self.round.ticks() > 0
    }

    /// Returns the round.
    pub fn round(&self) -> &AnyRound {
        &self.round
    }

    /// Starts a new round. Without a seed, the random numbers go on.
    pub fn reset(&mut self, seed: Option<u64>) {
        if let Some(seed) = seed {
            self.random = fastrand::Rng::with_seed(seed);
        }
        self.round = AnyRound::new(self.settings.level.clone());
        self.steps = 0;
        self.open();
        self.standing = self.settings.standing_of(&self.round);
    }

    /// Lets the hands join, and moves them to random places on free ways. The recording holds these ticks too, so the
    /// replay of the episode is a round of the unchanged level.
    fn open(&mut self) {
        let players = self.settings.players;
        let starts = (0..players).map(|player| self.round.start(player));
        // A tick lets the second player in.
        let frame = frame_towards(starts);
        self.round.step(frame);
        if !self.settings.random_start {
            return;
        }
        let random = &mut self.random;
        let places = both!(&self.round, round => free_places(round, random, players));
        for _ in 0..OPENING_TICKS {
            let hands = self.round.hands();
            let is_there = |(hand, place): (&tamaire_play::round::Hand, &Vec3)| {
                (hand.position - *place).length() < ARRIVED
            };
            if hands.iter().zip(&places).all(is_there) {
                break;
            }
            let next = hands.iter().zip(&places).map(|(hand, place)| {
                let way = *place - hand.target;
                let most = OPENING_SPEED * DEFAULT_TICK;
                hand.target + way * (most / way.length().max(1e-6)).min(1.0)
            });
            self.round.step(frame_towards(next));
        }
    }

    /// Moves the hands for the ticks of a step, with an action from −1 to 1 for each axis of each hand.
    pub fn step(&mut self, action: &[f32]) -> Step {
        let dim = self.settings.dim();
        let mut velocities = [Vec3::ZERO; tamaire_play::PLAYERS];
        for (velocity, numbers) in velocities.iter_mut().zip(action.chunks_exact(dim)) {
            for (axis, number) in numbers.iter().enumerate() {
                velocity[axis] = number.clamp(-1.0, 1.0) * self.settings.max_speed;
            }
        }
        for _ in 0..self.settings.ticks {
            if self.round.progress().outcome.is_some() {
                break;
            }
            let frame = both!(&self.round, round => {
                let hands = round.hands().zip(velocities);
                frame_towards(hands.map(|(hand, velocity)| {
                    hand.target_position().to_vec3() + velocity * DEFAULT_TICK
                }))
            });
            self.round.step(frame);
        }
        self.steps += 1;
        let before = self.standing;
        self.standing = self.settings.standing_of(&self.round);
        let progress = self.round.progress();
        let settings = &self.settings;
        let is_lost = settings.max_pieces > 0 && progress.pieces > settings.max_pieces;
        let terminated = progress.outcome.is_some() || is_lost;
        Step {
            reward: f64::from(settings.reward.of(before, self.standing, progress)),
            terminated,
            truncated: !terminated && settings.max_steps > 0 && self.steps >= settings.max_steps,
        }
    }

    /// Returns the observation.
    pub fn observe(&self) -> Vec<f32> {
        let time_left = match self.settings.max_steps {
            0 => 1.0,
            most => 1.0 - (self.steps as f32 / most as f32).min(1.0),
        };
        let players = self.settings.players;
        let distance = self.standing.distance;
        both!(&self.round, round => observe(round, players, distance, time_left))
    }
}

/// Returns a frame with a target for each hand [m].
fn frame_towards(targets: impl Iterator<Item = Vec3>) -> InputFrame {
    let targets = targets.enumerate();
    targets.fold(InputFrame::default(), |frame, (player, target)| {
        frame.with(player, target)
    })
}

/// Returns a random place for each hand [m] to which a straight way leads that is free of obstacles, bodies and the
/// other hands. If none is found, it is the hand's own place.
fn free_places<D: Dim>(round: &Round<D>, random: &mut fastrand::Rng, players: usize) -> Vec<Vec3> {
    let [low, high] = round.level().arena();
    let hands = round.hands().take(players);
    let hands: Vec<(Vec3, f32)> = hands
        .map(|hand| (hand.position().to_vec3(), hand.shape().inradius()))
        .collect();
    let solid = round.world().rigid_bodies().map(|(_, body)| body);
    let solid =
        solid.filter(|body| body.motion_type() != MotionType::Kinematic && !body.is_sensor());
    let is_hand = |position: Vec3| hands.iter().any(|hand| hand.0 == position);
    let obstacles: Vec<Shape<D>> = solid
        .filter(|body| !is_hand(body.position().to_vec3()))
        .map(|body| body.shape())
        .collect();
    let points = |from: Vec3, to: Vec3| {
        let shares = (0..=POINTS).map(|point| point as f32 / POINTS as f32);
        shares.rev().map(move |share| from + (to - from) * share)
    };
    // Ways of the hands; those of later hands are still points.
    let mut ways: Vec<[Vec3; 2]> = hands.iter().map(|(from, _)| [*from; 2]).collect();
    for (index, &(from, radius)) in hands.iter().enumerate() {
        let is_free = |at: Vec3| {
            let margin = radius + CLEARANCE;
            let others = hands.iter().zip(&ways).enumerate();
            let mut others = others.filter(|(other, _)| *other != index);
            let place = D::Vector::from_vec3(at);
            obstacles
                .iter()
                .all(|shape| shape.distance(place).0 > margin)
                && others.all(|(_, (hand, way))| {
                    points(way[0], way[1]).all(|point| (point - at).length() > margin + hand.1)
                })
                && round.distance_to_bodies(place) > margin
        };
        let mut place = || {
            let shares = Vec3::from([0; 3].map(|_: i32| random.f32()));
            let mut place = low + shares * (high - low);
            if D::N == 2 {
                place.z = 0.0;
            }
            place
        };
        // The point at which the hand is now does not count.
        let leads_free = |to: &Vec3| points(from, *to).take(POINTS).all(is_free);
        let found = (0..TRIES).map(|_| place()).find(leads_free);
        ways[index] = [from, found.unwrap_or(from)];
    }
    ways.into_iter().map(|way| way[1]).collect()
}
