//! Players that are programs. They see the world that a person sees and answer with the same
//! [`InputFrame`].

use crate::{InputFrame, Round};
use fuwafuwa::world::TICK;
use fuwafuwa::{Dim, PieceView, Shape, Vector};

/// How fast a bot's hand goes where nothing is in the way, and when it pushes [m/s].
const BRISK: f32 = 3.0;
const GENTLE: f32 = 0.7;
/// A bot that gets nowhere for so many ticks looks at another piece.
const PATIENCE: u32 = 300;
/// The shaving bot pushes when the largest piece has this share of the mass.
const SMALL_ENOUGH: f32 = 0.95;

/// What a bot is after.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum BotKind {
    /// To push the body in whole.
    Squeeze,
    /// To tear bits off until it fits.
    Shave,
    /// Nothing: it goes here and there, now slowly, now fast.
    Random,
    /// Nothing at all.
    Idle,
}

impl BotKind {
    /// All, with the names by which they are called up.
    pub const NAMED: [(&'static str, Self); 4] = [
        ("squeeze", Self::Squeeze),
        ("shave", Self::Shave),
        ("random", Self::Random),
        ("idle", Self::Idle),
    ];
}

/// A player that is a program.
#[derive(Clone, Debug)]
pub struct Bot {
    kind: BotKind,
    random: fastrand::Rng,
    /// How it differs from one with another seed, each -1 to 1.
    temper: [f32; 3],
    /// Where a random bot wants to go, and for how many ticks more, by player.
    whims: [(Vector, u32); crate::PLAYERS],
    stroke: Stroke,
    strokes: u32,
    gathers: bool,
    /// The most that was in the basket, for how many ticks nothing got better, and how many pieces
    /// were given up for it.
    best: f32,
    waited: u32,
    skips: usize,
}

/// What the shaving hand is at.
#[derive(Copy, Clone, Debug, PartialEq)]
enum Stroke {
    Rest,
    /// On its way to where the next stroke begins, as seen from the piece [m], for so many ticks more.
    Reach(Vector, u32),
    /// On its way to where the stroke ends [m], for so many ticks more.
    Cut(Vector, u32),
}

impl Bot {
    /// A bot of a kind; those with different seeds play differently.
    pub fn new(kind: BotKind, seed: u64) -> Self {
        let mut random = fastrand::Rng::with_seed(seed);
        let temper = [0; 3].map(|_: i32| 2.0 * random.f32() - 1.0);
        Self {
            kind,
            random,
            temper,
            whims: Default::default(),
            stroke: Stroke::Rest,
            strokes: 0,
            gathers: false,
            best: 0.0,
            waited: 0,
            skips: 0,
        }
    }

    /// What it does in the next tick.
    pub fn frame<D: Dim>(&mut self, round: &Round<D>) -> InputFrame {
        match self.kind {
            BotKind::Idle => InputFrame::default(),
            BotKind::Random => self.wander(round),
            BotKind::Squeeze => match self.look(round) {
                Some(sight) => InputFrame::towards(self.push(&sight)),
                None => InputFrame::default(),
            },
            BotKind::Shave => match self.look(round) {
                Some(sight) => InputFrame::towards(self.shave(&sight)),
                None => InputFrame::default(),
            },
        }
    }

    /// Looks at the piece that matters; at the next smaller one when nothing got better for long.
    fn look<D: Dim>(&mut self, round: &Round<D>) -> Option<Sight> {
        let inside = round.progress().inside;
        self.waited += 1;
        if inside > self.best + 0.005 {
            (self.best, self.waited) = (inside, 0);
        } else if self.waited > PATIENCE {
            (self.best, self.waited) = (inside, 0);
            self.skips = (self.skips + 1) % 4;
        }
        Sight::of(round, self.skips)
    }

    fn wander<D: Dim>(&mut self, round: &Round<D>) -> InputFrame {
        let [low, high] = round.level().arena();
        let mut frame = InputFrame::default();
        for player in 0..crate::PLAYERS {
            if self.whims[player].1 == 0 {
                let place = [0, 1, 2]
                    .map(|axis: usize| low[axis] + self.random.f32() * (high[axis] - low[axis]));
                self.whims[player] = (place, 1 + self.random.u32(..90));
            }
            self.whims[player].1 -= 1;
            frame = frame.with(player, self.whims[player].0);
        }
        frame
    }

    /// From behind, towards the basket, or first to a place in front of it; away once enough is in.
    fn push(&mut self, sight: &Sight) -> Vector {
        let Sight {
            piece,
            hand,
            reach,
            start,
            ..
        } = sight;
        if sight.is_done {
            return self.go(sight, around(sight, *start), GENTLE);
        }
        let way = unit(sub(sight.target(0.2 + 0.05 * self.temper[0]), *piece));
        let behind = sight.in_arena(sub(*piece, scale(way, 1.1 * reach)));
        let (along, aside) = split(sub(*hand, *piece), way);
        let is_behind = along < -0.2 * reach && length(aside) < 0.5 * reach;
        if !is_behind && length(sub(*hand, behind)) > 0.05 {
            return self.go(sight, around(sight, behind), BRISK);
        }
        // What is in pieces is pushed gently, and harder only when nothing moves.
        let firm = (2.0 * self.waited as f32 / PATIENCE as f32 - 1.0).max(0.0);
        let depth = match self.gathers {
            true => 0.15 + 0.12 * firm,
            false => 0.25,
        } + 0.02 * self.temper[1];
        let goal = add(*piece, scale(way, depth - reach));
        self.go(sight, goal, GENTLE * (1.0 + 0.1 * self.temper[2]))
    }

    /// Strokes past the middle of the largest piece, now on one side of it, now on the other, until
    /// it is small enough; then gathers what is needed.
    fn shave(&mut self, sight: &Sight) -> Vector {
        let Sight {
            axis,
            piece,
            reach,
            hand,
            ..
        } = sight;
        self.gathers |= sight.share < SMALL_ENOUGH + 0.01 * self.temper[2];
        if self.gathers {
            return self.push(sight);
        }
        match self.stroke {
            Stroke::Rest => {
                self.strokes += 1;
                let side = if self.strokes.is_multiple_of(2) {
                    1.0
                } else {
                    -1.0
                };
                let aside = [-axis[1] * side, axis[0] * side, 0.0];
                let from = add(scale(*axis, -1.15 * reach), scale(aside, 0.75 * reach));
                self.stroke = Stroke::Reach(from, 90);
                *hand
            }
            Stroke::Reach(from, patience) => {
                let place = sight.in_arena(add(*piece, from));
                let there = length(sub(*hand, place)) < 0.1;
                self.stroke = match there || patience == 0 {
                    true => Stroke::Cut(add(place, scale(*axis, 2.6 * reach)), 40),
                    false => Stroke::Reach(from, patience - 1),
                };
                self.go(sight, around(sight, place), BRISK)
            }
            Stroke::Cut(to, patience) => {
                let there = length(sub(*hand, to)) < 0.1;
                self.stroke = match there || patience == 0 {
                    true => Stroke::Rest,
                    false => Stroke::Cut(to, patience - 1),
                };
                to
            }
        }
    }

    /// The next goal on the way to a place, at a pace [m/s].
    fn go(&self, sight: &Sight, place: Vector, pace: f32) -> Vector {
        let way = sub(place, sight.goal);
        let step = (pace * TICK / length(way).max(1e-6)).min(1.0);
        add(sight.goal, scale(way, step))
    }
}

/// Where to go now to come to a place without touching the piece on the way.
fn around(sight: &Sight, place: Vector) -> Vector {
    let Sight {
        piece, hand, reach, ..
    } = sight;
    let (from, to) = (unit(sub(*hand, *piece)), unit(sub(place, *piece)));
    if dot(from, to) > 0.8 {
        return place;
    }
    let turn = sub(to, scale(from, dot(from, to)));
    let turn = match length(turn) > 1e-3 {
        true => unit(turn),
        false => [-from[1], from[0], 0.0],
    };
    // An eighth of a turn onwards, at arm's length.
    let onwards = scale(add(from, turn), 0.707);
    add(*piece, scale(onwards, 1.25 * reach))
}

/// What a bot looks at.
struct Sight {
    /// Into the basket, of length 1.
    axis: Vector,
    /// Middle of the basket, and of its mouth [m].
    basket: Vector,
    mouth: Vector,
    /// Middle of the piece that matters: the largest of those that are not in the basket [m].
    piece: Vector,
    /// From its middle to that of a hand that touches it [m].
    reach: f32,
    /// Share of all mass in the largest piece of all.
    share: f32,
    /// Whether enough is in the basket.
    is_done: bool,
    hand: Vector,
    goal: Vector,
    start: Vector,
    arena: [Vector; 2],
    margin: f32,
}

impl Sight {
    fn of<D: Dim>(round: &Round<D>, skips: usize) -> Option<Self> {
        let basket = *round.basket()?;
        let Shape::Box { centre, half } = basket else {
            return None;
        };
        let axis = towards_basket(centre);
        let bodies = round.world().bodies().iter();
        let pieces: Vec<PieceView> = bodies.flat_map(|body| body.piece_views()).collect();
        let by_mass = |a: &&PieceView, b: &&PieceView| a.mass.total_cmp(&b.mass);
        let largest = pieces.iter().max_by(by_mass)?;
        let depth = dot(half, axis).abs();
        let mouth = sub(centre, scale(axis, depth));
        // What went past the bars cannot be had.
        let is_beyond = |piece: &&PieceView| dot(sub(piece.centre, mouth), axis) > 0.0;
        let mut outside: Vec<&PieceView> =
            pieces.iter().filter(|piece| !is_beyond(piece)).collect();
        outside.sort_by(|a, b| by_mass(b, a));
        let skips = skips.min(outside.len().saturating_sub(1));
        let piece = outside.get(skips).copied().unwrap_or(largest);
        let is_in = |piece: &PieceView| basket.distance(piece.centre).0 < 0.0;
        let needed = round.level().game().share;
        let is_done = round.progress().inside > needed + 0.05;
        // One that is enough on its own is pushed until it is all in.
        let is_enough = largest.mass > needed * round.progress().mass;
        let piece = if is_in(largest) && is_enough {
            largest
        } else {
            piece
        };
        let hand = round.world().manipulators().first()?;
        let width = sub(piece.high, piece.low);
        let radius = 0.5 * (0..D::N).map(|k| width[k]).sum::<f32>() / D::N as f32;
        Some(Self {
            axis,
            basket: centre,
            mouth,
            piece: piece.centre,
            reach: radius + hand.radius,
            share: largest.mass / round.progress().mass,
            is_done,
            hand: hand.position(),
            goal: hand.goal(),
            start: round.start(0),
            arena: round.level().arena(),
            margin: hand.radius,
        })
    }

    /// Where the piece is to go: into the basket, and before that, if it is off the way by more than
    /// `off` [m], to a place in front of the mouth.
    fn target(&self, off: f32) -> Vector {
        let (_, aside) = split(sub(self.piece, self.mouth), self.axis);
        match length(aside) > off {
            true => sub(self.mouth, scale(self.axis, self.reach)),
            false => self.basket,
        }
    }

    /// The place nearest to one where a hand can be.
    fn in_arena(&self, mut place: Vector) -> Vector {
        let [low, high] = self.arena;
        for axis in 0..3 {
            let margin = self.margin.min(0.5 * (high[axis] - low[axis]));
            place[axis] = place[axis].clamp(low[axis] + margin, high[axis] - margin);
        }
        place
    }
}

/// The axis of the room along which the basket lies.
fn towards_basket(basket: Vector) -> Vector {
    let longest = (0..3)
        .max_by(|&a, &b| basket[a].abs().total_cmp(&basket[b].abs()))
        .unwrap_or(0);
    let mut axis = [0.0; 3];
    axis[longest] = basket[longest].signum();
    axis
}

/// The share of a vector along an axis of length 1, and the rest.
fn split(v: Vector, axis: Vector) -> (f32, Vector) {
    let along = dot(v, axis);
    (along, sub(v, scale(axis, along)))
}

fn add(a: Vector, b: Vector) -> Vector {
    [0, 1, 2].map(|k| a[k] + b[k])
}

fn sub(a: Vector, b: Vector) -> Vector {
    [0, 1, 2].map(|k| a[k] - b[k])
}

fn scale(v: Vector, by: f32) -> Vector {
    v.map(|k| k * by)
}

fn dot(a: Vector, b: Vector) -> f32 {
    (0..3).map(|k| a[k] * b[k]).sum()
}

fn length(v: Vector) -> f32 {
    dot(v, v).sqrt()
}

fn unit(v: Vector) -> Vector {
    scale(v, 1.0 / length(v).max(1e-6))
}
