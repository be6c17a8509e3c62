//! Bots: programs that play. A bot sees the same world as a human player and answers with the same
//! [`InputFrame`].

mod map;
mod sight;
mod straight;

pub use straight::StraightPush;

use crate::{AnyRound, InputFrame, Outcome, Round};
use fuwafuwa::{DEFAULT_TICK, Dim, Vec3};
use sight::{Sight, split};

/// Speed of a bot's hand on a free path [m/s].
const BRISK: f32 = 3.0;
/// Speed of a bot's hand when it pushes [m/s].
const GENTLE: f32 = 0.7;
/// Initial speed of a bot's hand when it withdraws from the body [m/s].
const CAREFUL: f32 = 0.2;
/// Number of ticks without progress after which a bot chooses another piece to push.
const PATIENCE: u32 = 210;
/// Distance of the first shaving strokes from the centre of a piece, in 2D and in 3D, as a share of the
/// piece's `reach`. In 2D a stroke cuts off everything outside its path, so it may be far out. In 3D such a
/// stroke would only plough a furrow.
const FIRST_OFFSET: [f32; 2] = [0.78, 0.55];
/// Factor on the distance of strokes from the centre after a stroke that took nothing off.
const CLOSER: f32 = 0.85;
/// Minimum distance of strokes from the centre of a piece, in 2D and in 3D, as a factor on [`FIRST_OFFSET`].
/// If closer strokes would be needed, the bot stops shaving for a while and pushes, because the piece may fit
/// as it is. In 2D the minimum is 0: the last strokes go through the centre.
const CLOSEST: [f32; 2] = [0.0, 0.4];
/// Decrease of the pushed piece's distance from the mouth that counts as progress in 3D [m]. Heavy pieces on
/// a floor move slowly, so a bot must wait longer for them.
const NEARER: f32 = 0.05;
/// Reduction of the waiting time without progress each time the piece has come `NEARER` [ticks].
const ON_ITS_WAY: u32 = 20;
/// Depth added to a push when a bot has long made no progress, in 2D and in 3D [m]. The hand's target lies
/// this much deeper in the piece, so the hand pushes harder.
const FIRMER: [f32; 2] = [0.12, 0.3];
/// Value of [`Progress::kept`](crate::Progress::kept) below which a bot stops shaving and pushes the pieces
/// in.
const SMALL_ENOUGH: f32 = 0.92;
/// Share of the total mass in the basket above which strokes are limited to the speed `BRISK`. Faster strokes
/// would break a piece in the mouth up.
const IN_THE_MOUTH: f32 = 0.1;
/// Number of ticks for which a bot keeps pushing after enough mass is in the basket.
const LONG_ENOUGH: u32 = 30;

/// Strategy of a bot.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum BotKind {
    /// Pushes the whole body into the basket.
    Squeeze,
    /// Tears bits off the body until it fits into the basket.
    Shave,
    /// Moves to random positions, slowly or fast.
    Random,
    /// Does nothing.
    Idle,
}

impl BotKind {
    /// All kinds with their names on the command line.
    pub const NAMED: [(&'static str, Self); 4] = [
        ("squeeze", Self::Squeeze),
        ("shave", Self::Shave),
        ("random", Self::Random),
        ("idle", Self::Idle),
    ];
}

/// Program that plays as a player.
#[derive(Clone, Debug)]
pub struct Bot {
    kind: BotKind,
    random: fastrand::Rng,
    /// Random variations of the bot's behaviour, which follow from the seed; each from −1 to 1.
    temper: [f32; 3],
    /// Target of a randomly moving bot and number of ticks until the next target, by player.
    random_targets: [(Vec3, u32); crate::PLAYERS],
    stroke: Stroke,
    strokes: u32,
    /// Factor on [`FIRST_OFFSET`] for the next stroke.
    off: f32,
    /// Number of pieces before the last stroke.
    pieces: usize,
    /// Whether a shaving bot now pushes pieces in instead of shaving.
    gathers: bool,
    /// Value of [`Progress::kept`](crate::Progress::kept) below which the bot stops shaving and pushes the
    /// pieces in.
    aim: f32,
    /// Share of the mass in the basket when the bot last made progress.
    best: f32,
    /// Number of ticks since the bot last made progress.
    waited: u32,
    /// Number of more important pieces to skip.
    skips: usize,
    /// Minimum distance of the pushed piece from the mouth since the bot last made progress [m].
    near: f32,
    /// Number of ticks for which enough mass has been in the basket.
    pressed: u32,
}

/// State of a shaving stroke.
#[derive(Copy, Clone, Debug, PartialEq)]
enum Stroke {
    Rest,
    /// The hand moves to the start of the next stroke: position relative to the piece [m], and remaining
    /// ticks.
    Reach(Vec3, u32),
    /// The hand moves to the end of the stroke: position [m], and remaining ticks.
    Cut(Vec3, u32),
}

impl AnyRound {
    /// Returns the bot's input for the next tick.
    pub fn ask(&self, bot: &mut Bot) -> InputFrame {
        match self {
            Self::Plane(round) => bot.frame(round),
            Self::Space(round) => bot.frame(round),
        }
    }

    /// Lets a straight bot play until it wins, for at most `ticks` ticks. Returns the outcome if it won.
    pub fn push_straight(&mut self, bot: &mut StraightPush, ticks: usize) -> Option<Outcome> {
        let ask = |round: &Self| match round {
            Self::Plane(round) => bot.frame(round),
            Self::Space(round) => bot.frame(round),
        };
        self.play_with(ticks, ask)
    }

    /// Lets a bot play until it wins, for at most `ticks` ticks. Returns the outcome if it won.
    pub fn play(&mut self, bot: &mut Bot, ticks: usize) -> Option<Outcome> {
        self.play_with(ticks, |round| round.ask(bot))
    }

    /// Plays with the input from `ask` until the round is won, for at most `ticks` ticks.
    fn play_with(
        &mut self,
        ticks: usize,
        mut ask: impl FnMut(&Self) -> InputFrame,
    ) -> Option<Outcome> {
        for _ in 0..ticks {
            let frame = ask(self);
            self.step(frame);
            if self.progress().outcome.is_some() {
                break;
            }
        }
        self.progress().outcome
    }
}

impl Bot {
    /// Creates a bot. Bots with different seeds behave differently.
    pub fn new(kind: BotKind, seed: u64) -> Self {
        let mut random = fastrand::Rng::with_seed(seed);
        let temper = [0; 3].map(|_: i32| 2.0 * random.f32() - 1.0);
        Self {
            kind,
            random,
            temper,
            random_targets: Default::default(),
            stroke: Stroke::Rest,
            // Makes about half of the bots, by seed, start their strokes on the other side.
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

    /// Returns the input for the next tick.
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

    /// Looks at the round. Chooses the most important piece to push, or another one after a long time without
    /// progress.
    fn look<D: Dim>(&mut self, round: &Round<D>) -> Option<Sight> {
        let inside = round.progress().inside;
        self.waited += 1;
        if inside > self.best + 0.02 {
            self.wait_from(inside);
            // Waits one tick longer than `shave`, so that `shave` can first decide to go on shaving.
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

    /// Restarts the waiting time for progress, with the share `inside` of the mass in the basket.
    fn wait_from(&mut self, inside: f32) {
        (self.best, self.waited, self.near) = (inside, 0, f32::INFINITY);
    }

    fn wander<D: Dim>(&mut self, round: &Round<D>) -> InputFrame {
        let [low, high] = round.level().arena();
        let mut frame = InputFrame::default();
        for player in 0..crate::PLAYERS {
            if self.random_targets[player].1 == 0 {
                let shares = Vec3::from([0; 3].map(|_: i32| self.random.f32()));
                let place = low + shares * (high - low);
                self.random_targets[player] = (place, 1 + self.random.u32(..90));
            }
            self.random_targets[player].1 -= 1;
            frame = frame.with(player, self.random_targets[player].0);
        }
        frame
    }

    /// Pushes the piece from behind towards the basket. Moves the hand away once enough mass is in the
    /// basket.
    fn push<D: Dim>(&mut self, sight: &Sight) -> Vec3 {
        let lets_go = self.pressed > LONG_ENOUGH;
        self.pressed = match sight.surplus > if lets_go { 0.0 } else { 0.05 } {
            true => self.pressed + 1,
            false => 0,
        };
        if self.pressed > LONG_ENOUGH {
            // The hand withdraws slowly at first, because a compressed piece expands and follows it.
            let pace = CAREFUL + 0.004 * (self.pressed - LONG_ENOUGH) as f32;
            return self.go(sight, sight.away, pace.min(BRISK));
        }
        let piece = sight.piece;
        let (along, aside) = split(sight.hand - piece.centre, piece.direction);
        let is_behind = along < -0.2 * piece.reach && aside.length() < 0.5 * piece.reach;
        if !is_behind && (sight.hand - piece.behind).length() > 0.05 {
            return self.go(sight, piece.behind, BRISK);
        }
        // A bot that has torn the body pushes gently, and harder only after a time without progress.
        let firm = (2.0 * self.waited as f32 / PATIENCE as f32 - 1.0).max(0.0);
        let depth = match self.gathers {
            true => 0.15 + FIRMER[D::N - 2] * firm,
            false => 0.25,
        } + 0.02 * self.temper[1];
        let goal = piece.centre + piece.direction * (depth - piece.reach);
        // If a piece is wedged in the mouth, the hand pushes its two corners in turn.
        let side = match (firm > 0.0 && !piece.fits, self.waited / 30 % 2) {
            (false, _) => 0.0,
            (true, 0) => -0.35,
            (true, _) => 0.35,
        };
        let goal = goal + sight.across * (side * piece.reach);
        straight(sight, goal, GENTLE * (1.0 + 0.1 * self.temper[2]))
    }

    /// Moves the hand past the centre of the largest piece, on alternate sides, until this piece is small
    /// enough. Then pushes in pieces until the basket holds the required mass.
    fn shave<D: Dim>(&mut self, sight: &Sight) -> Vec3 {
        self.gathers |= sight.kept < self.aim;
        // A piece is stuck if it is too wide for the mouth. Excluded are a piece chosen after others failed,
        // and the case that so little mass is missing that the next piece may suffice.
        let is_stuck = self.skips == 0 && !sight.piece.fits && sight.surplus < -0.05;
        if self.gathers && self.waited > PATIENCE && is_stuck {
            (self.gathers, self.aim) = (false, SMALL_ENOUGH * sight.kept);
            self.off = if D::N == 3 { 1.0 } else { self.off };
        }
        if self.gathers {
            return self.push::<D>(sight);
        }
        // Keeps the waiting time at zero while shaving. It counts only while the bot pushes pieces in, which
        // always starts with the largest one.
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
                let off = (FIRST_OFFSET[D::N - 2] + 0.04 * self.temper[1]) * self.off * reach;
                let from = *axis * (-1.15 * reach) + *across * (side * off);
                self.stroke = Stroke::Reach(from, 90);
                sight.hand
            }
            Stroke::Reach(from, patience) => {
                let place = piece.centre + from;
                let there = (sight.hand - place).length() < 0.1;
                self.stroke = match there || patience == 0 {
                    true => Stroke::Cut(place + *axis * (2.6 * reach), 40),
                    false => Stroke::Reach(from, patience - 1),
                };
                self.go(sight, place, BRISK)
            }
            Stroke::Cut(to, patience) => {
                let is_over = (sight.hand - to).length() < 0.1 || patience == 0;
                if is_over && sight.pieces <= self.pieces {
                    self.off *= CLOSER;
                    self.gathers = self.off < CLOSEST[D::N - 2];
                }
                self.stroke = match is_over {
                    true => Stroke::Rest,
                    false => Stroke::Cut(to, patience - 1),
                };
                // Inside the mouth a piece cannot yield, and a hand at full force would break it up.
                match sight.within > IN_THE_MOUTH {
                    true => straight(sight, to, BRISK),
                    false => to,
                }
            }
        }
    }

    /// Returns the next target on the way to a position around obstacles, at the speed `pace` [m/s].
    fn go(&self, sight: &Sight, place: Vec3, pace: f32) -> Vec3 {
        straight(sight, sight.map.next(sight.hand, place), pace)
    }
}

/// Returns the next target on the straight line to a position, at the speed `pace` [m/s].
fn straight(sight: &Sight, place: Vec3, pace: f32) -> Vec3 {
    step(sight.goal, place, pace)
}

/// Returns the next position on the straight line from one position to another, at the speed `pace` [m/s].
fn step(from: Vec3, to: Vec3, pace: f32) -> Vec3 {
    let way = to - from;
    from + way * (pace * DEFAULT_TICK / way.length().max(1e-6)).min(1.0)
}
