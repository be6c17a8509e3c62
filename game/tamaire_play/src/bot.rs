//! Players that are programs. They see the world that a person sees and answer with the same
//! [`InputFrame`].

mod map;
mod sight;

use crate::{AnyRound, InputFrame, Outcome, Round};
use fuwafuwa::vector::{length, minus, plus, scaled};
use fuwafuwa::world::TICK;
use fuwafuwa::{Dim, Vector};
use sight::{Sight, split};

/// How fast a bot's hand goes where nothing is in the way, and when it pushes [m/s].
const BRISK: f32 = 3.0;
const GENTLE: f32 = 0.7;
/// How fast it begins to let go [m/s].
const CAREFUL: f32 = 0.2;
/// A bot that gets nowhere for so many ticks looks at another piece.
const PATIENCE: u32 = 210;
/// How far off the middle of a piece its first strokes pass, in terms of its reach: in the plane, where a
/// hand cuts off all that it passes, and in space, where it would only plough a furrow so far out.
const GRAZING: [f32; 2] = [0.78, 0.55];
/// After a stroke that took nothing off they pass so much closer to the middle.
const CLOSER: f32 = 0.85;
/// In space strokes that are to pass so close and took nothing off are given up for a while: what is left may
/// go in as it is. In the plane they end up going through the middle.
const CLOSEST: [f32; 2] = [0.0, 0.4];
/// In space heavy pieces lie on a floor. Who gathers there has waited for so many ticks less whenever one came
/// so much nearer to the mouth [m], and pushes ever harder until it does: so much deeper than gently [m].
const NEARER: f32 = 0.05;
const ON_ITS_WAY: u32 = 20;
const FIRMER: [f32; 2] = [0.12, 0.3];
/// The shaving bot gathers when the largest pieces have this share of what they had.
const SMALL_ENOUGH: f32 = 0.92;
/// With so much of all mass in the basket, strokes are no faster than brisk.
const IN_THE_MOUTH: f32 = 0.1;
/// It presses for so many ticks when enough is in the basket, and lets go.
const LONG_ENOUGH: u32 = 30;

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
    /// How far off the middle they pass, in terms of what the first did; and how many pieces there were
    /// before the last.
    off: f32,
    pieces: usize,
    gathers: bool,
    /// Share of the mass in the largest pieces, as it was at the start, at which it gathers.
    aim: f32,
    /// The most that was in the basket, for how many ticks nothing got better, and how many pieces
    /// were given up for it.
    best: f32,
    waited: u32,
    skips: usize,
    /// How near to the mouth the piece that matters has come since then [m].
    near: f32,
    /// For how many ticks enough has been in the basket.
    pressed: u32,
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

impl AnyRound {
    /// What a bot does in its next tick.
    pub fn ask(&self, bot: &mut Bot) -> InputFrame {
        match self {
            Self::Plane(round) => bot.frame(round),
            Self::Space(round) => bot.frame(round),
        }
    }

    /// Lets a bot play until it is won, for so many ticks at most; how it was won, if it was.
    pub fn play(&mut self, bot: &mut Bot, ticks: usize) -> Option<Outcome> {
        for _ in 0..ticks {
            let frame = self.ask(bot);
            self.step(frame);
            if self.progress().outcome.is_some() {
                break;
            }
        }
        self.progress().outcome
    }
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
            // The first goes along one side or the other.
            strokes: u32::from(temper[0] > 0.0),
            off: 1.0,
            pieces: 0,
            gathers: false,
            aim: SMALL_ENOUGH + 0.01 * temper[2],
            best: 0.0,
            waited: 0,
            skips: 0,
            near: f32::INFINITY,
            pressed: 0,
        }
    }

    /// What it does in the next tick.
    pub fn frame<D: Dim>(&mut self, round: &Round<D>) -> InputFrame {
        match self.kind {
            BotKind::Idle => InputFrame::default(),
            BotKind::Random => self.wander(round),
            BotKind::Squeeze => match self.look(round) {
                Some(sight) => InputFrame::towards(self.push::<D>(&sight)),
                None => InputFrame::default(),
            },
            BotKind::Shave => match self.look(round) {
                Some(sight) => InputFrame::towards(self.shave::<D>(&sight)),
                None => InputFrame::default(),
            },
        }
    }

    /// Looks at the piece that matters; at the next smaller one when nothing got better for long.
    fn look<D: Dim>(&mut self, round: &Round<D>) -> Option<Sight> {
        let inside = round.progress().inside;
        self.waited += 1;
        if inside > self.best + 0.02 {
            self.wait_from(inside);
            // In the tick before, who shaves may decide to go on shaving instead.
        } else if self.waited > PATIENCE + 1 {
            self.wait_from(inside);
            self.skips = (self.skips + 1) % 4;
        }
        let sight = Sight::of(round, self.skips, 0.2 + 0.05 * self.temper[0])?;
        if D::N == 3 && self.gathers && sight.piece.far < self.near - NEARER {
            self.near = sight.piece.far;
            self.waited = self.waited.saturating_sub(ON_ITS_WAY);
        }
        Some(sight)
    }

    /// Begins to wait for more in the basket than there is.
    fn wait_from(&mut self, inside: f32) {
        (self.best, self.waited, self.near) = (inside, 0, f32::INFINITY);
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

    /// From behind, towards the basket; away once enough is in.
    fn push<D: Dim>(&mut self, sight: &Sight) -> Vector {
        let lets_go = self.pressed > LONG_ENOUGH;
        self.pressed = match sight.surplus > if lets_go { 0.0 } else { 0.05 } {
            true => self.pressed + 1,
            false => 0,
        };
        if self.pressed > LONG_ENOUGH {
            // First slowly: what was pressed together follows the hand without a spring.
            let pace = CAREFUL + 0.004 * (self.pressed - LONG_ENOUGH) as f32;
            return self.go(sight, sight.away, pace.min(BRISK));
        }
        let piece = sight.piece;
        let (along, aside) = split(minus(sight.hand, piece.centre), piece.way);
        let is_behind = along < -0.2 * piece.reach && length(aside) < 0.5 * piece.reach;
        if !is_behind && length(minus(sight.hand, piece.behind)) > 0.05 {
            return self.go(sight, piece.behind, BRISK);
        }
        // What is in pieces is pushed gently, and harder only when nothing moves.
        let firm = (2.0 * self.waited as f32 / PATIENCE as f32 - 1.0).max(0.0);
        let depth = match self.gathers {
            true => 0.15 + FIRMER[D::N - 2] * firm,
            false => 0.25,
        } + 0.02 * self.temper[1];
        let goal = plus(piece.centre, scaled(piece.way, depth - piece.reach));
        // What is wedged in the mouth goes in corner by corner.
        let side = match (firm > 0.0 && !piece.fits, self.waited / 30 % 2) {
            (false, _) => 0.0,
            (true, 0) => -0.35,
            (true, _) => 0.35,
        };
        let goal = plus(goal, scaled(sight.across, side * piece.reach));
        straight(sight, goal, GENTLE * (1.0 + 0.1 * self.temper[2]))
    }

    /// Strokes past the middle of the largest piece, now on one side of it, now on the other, until
    /// it is small enough; then gathers what is needed.
    fn shave<D: Dim>(&mut self, sight: &Sight) -> Vector {
        self.gathers |= sight.kept < self.aim;
        // What is stuck in front of the mouth has to be smaller still; not what is looked at for want of
        // something better, nor when so little is missing that the next piece may do.
        let is_stuck = self.skips == 0 && !sight.piece.fits && sight.surplus < -0.05;
        if self.gathers && self.waited > PATIENCE && is_stuck {
            (self.gathers, self.aim) = (false, SMALL_ENOUGH * sight.kept);
            self.off = if D::N == 3 { 1.0 } else { self.off };
        }
        if self.gathers {
            return self.push::<D>(sight);
        }
        // Patience is for gathering, which begins with the largest piece every time.
        self.wait_from(0.0);
        self.skips = 0;
        let Sight {
            axis,
            across,
            piece,
            ..
        } = sight;
        let reach = piece.reach;
        match self.stroke {
            Stroke::Rest => {
                self.strokes += 1;
                let is_even = self.strokes.is_multiple_of(2);
                let side = if is_even { 1.0 } else { -1.0 };
                self.pieces = sight.pieces;
                let off = (GRAZING[D::N - 2] + 0.04 * self.temper[1]) * self.off * reach;
                let from = plus(scaled(*axis, -1.15 * reach), scaled(*across, side * off));
                self.stroke = Stroke::Reach(from, 90);
                sight.hand
            }
            Stroke::Reach(from, patience) => {
                let place = plus(piece.centre, from);
                let there = length(minus(sight.hand, place)) < 0.1;
                self.stroke = match there || patience == 0 {
                    true => Stroke::Cut(plus(place, scaled(*axis, 2.6 * reach)), 40),
                    false => Stroke::Reach(from, patience - 1),
                };
                self.go(sight, place, BRISK)
            }
            Stroke::Cut(to, patience) => {
                let is_over = length(minus(sight.hand, to)) < 0.1 || patience == 0;
                if is_over && sight.pieces <= self.pieces {
                    self.off *= CLOSER;
                    self.gathers = self.off < CLOSEST[D::N - 2];
                }
                self.stroke = match is_over {
                    true => Stroke::Rest,
                    false => Stroke::Cut(to, patience - 1),
                };
                // In the mouth nothing gives way: a hand at full force would break the piece up.
                match sight.within > IN_THE_MOUTH {
                    true => straight(sight, to, BRISK),
                    false => to,
                }
            }
        }
    }

    /// The next goal on the way to a place around what is in the way, at a pace [m/s].
    fn go(&self, sight: &Sight, place: Vector, pace: f32) -> Vector {
        straight(sight, sight.map.next(sight.hand, place), pace)
    }
}

/// The next goal on the straight way to a place, at a pace [m/s].
fn straight(sight: &Sight, place: Vector, pace: f32) -> Vector {
    let way = minus(place, sight.goal);
    let step = (pace * TICK / length(way).max(1e-6)).min(1.0);
    plus(sight.goal, scaled(way, step))
}
