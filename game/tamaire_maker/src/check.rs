//! Checks of a level before it is kept: whether bots win it, and whether it runs in real time.
//!
//! The checks are computed in small portions, so that a screen can show their progress. They forbid nothing.

use fuwafuwa::{DEFAULT_TICK, Dim, DimVector, JointKind, World};
use fuwafuwa_scenes::scene::{JointKindText, JointText};
use std::sync::Arc;
use tamaire_play::bot::StraightPush;
use tamaire_play::{AnyRound, Bot, BotKind, InputFrame, Level, Route};

/// Maximum length of a round of a bot [s].
pub const SECONDS: f32 = 45.0;
/// Maximum length of the round in which no hand moves [s].
const IDLE: f32 = 15.0;
/// Seeds with which each bot plays.
const SEEDS: [u64; 2] = [1, 2];
/// Speed at which the bot pushes that only pushes straight [m/s].
const STRAIGHT: f32 = 0.7;
/// Speed of a small machine, as a share of this one.
const SMALL: f64 = 0.5;
/// Length by which a rope must be too short to be told [m]. An end on a body is in the middle of the nodes that it holds, which
/// may be some centimetres from the stated point.
const SHORT_ROPE: f32 = 0.05;
/// Share of the ticks that must be computed in time.
const IN_TIME: f64 = 0.99;

/// A player of the checks.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
enum Player {
    Bot(BotKind),
    Straight,
    /// Moves no hand.
    Idle,
}

/// Result of a check.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub enum Finding {
    /// The check is not finished.
    #[default]
    Open,
    /// Confirmed; for a win, with the shortest time [s].
    Yes(Option<f32>),
    /// Not confirmed: no bot won in this way, or the level is too slow.
    NotFound,
    /// Not checked, because the level does not have this way to win.
    NotAsked,
}

/// Results of the checks.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub struct Findings {
    /// Whether the body can be squeezed in.
    pub squeezed: Finding,
    /// Whether the body can be shaved to fit.
    pub shaved: Finding,
    /// Whether a bot that only pushes straight wins. If so, the level may be too easy.
    pub straight: Finding,
    /// Whether the level is won although no hand moves.
    pub by_itself: Finding,
    /// Whether a machine half as fast as this one computes the level in real time.
    pub real_time: Finding,
    /// Whether a rope is shorter than the distance of its ends at the start, so that it pulls hard or tears.
    pub has_short_rope: bool,
}

/// Checks of a level in progress.
pub struct Check {
    level: Arc<Level>,
    /// Rounds that are left, the next one last.
    left: Vec<(Player, u64)>,
    all: usize,
    running: Option<(AnyRound, Running)>,
    findings: Findings,
    /// Number of ticks of all rounds.
    ticks: usize,
    /// Times of the ticks in which hands move [s].
    times: Vec<f32>,
}

enum Running {
    Bot(Box<Bot>),
    Straight(StraightPush),
    Idle,
}

impl Running {
    /// Returns the length of its rounds [s].
    fn most(&self) -> f32 {
        match self {
            Self::Idle => IDLE,
            _ => SECONDS,
        }
    }
}

impl Check {
    /// Begins to check a level. Without a basket only its speed is checked.
    pub fn new(level: Arc<Level>) -> Self {
        let (squeeze, shave) = (Player::Bot(BotKind::Squeeze), Player::Bot(BotKind::Shave));
        let mut left = Vec::new();
        let mut findings = Findings {
            has_short_rope: has_short_rope(&level),
            ..Findings::default()
        };
        if level.has_basket() {
            for &seed in SEEDS.iter().rev() {
                left.push((Player::Straight, seed));
                if level.routes().contains(&Route::Shave) {
                    left.push((shave, seed));
                }
                left.push((squeeze, seed));
            }
            left.push((Player::Idle, SEEDS[0]));
        } else {
            left.push((Player::Bot(BotKind::Random), SEEDS[0]));
            findings.squeezed = Finding::NotAsked;
            findings.straight = Finding::NotAsked;
            findings.by_itself = Finding::NotAsked;
        }
        if !left.iter().any(|(player, _)| *player == shave) {
            findings.shaved = Finding::NotAsked;
        }
        Self {
            level,
            all: left.len(),
            left,
            running: None,
            findings,
            ticks: 0,
            times: Vec::new(),
        }
    }

    /// Returns the level.
    pub fn level(&self) -> &Arc<Level> {
        &self.level
    }

    /// Returns what is known so far.
    pub fn findings(&self) -> &Findings {
        &self.findings
    }

    /// Whether all checks are finished.
    pub fn is_done(&self) -> bool {
        self.left.is_empty() && self.running.is_none()
    }

    /// Returns the share of the checks that is finished, 0 to 1.
    pub fn progress(&self) -> f32 {
        if self.is_done() {
            return 1.0;
        }
        let share = self.running.as_ref().map_or(0.0, |(round, running)| {
            (round.ticks() as f32 * DEFAULT_TICK / running.most()).min(1.0)
        });
        let waiting = self.left.len() + usize::from(self.running.is_some());
        ((self.all - waiting) as f32 + share) / self.all as f32
    }

    /// Returns the time that the rounds have taken so far [s].
    pub fn played_seconds(&self) -> f32 {
        self.ticks as f32 * DEFAULT_TICK
    }

    /// Continues the checks for about `budget` [s]. `now` returns the time since a fixed moment [s].
    pub fn go_on(&mut self, budget: f64, now: impl Fn() -> f64) {
        let began = now();
        while !self.is_done() && now() - began < budget {
            self.tick(&now);
        }
    }

    fn tick(&mut self, now: &impl Fn() -> f64) {
        let Some((round, running)) = &mut self.running else {
            self.begin_next();
            return;
        };
        let is_idle = matches!(running, Running::Idle);
        let frame = match running {
            Running::Idle => InputFrame::default(),
            Running::Bot(bot) => round.ask(bot),
            Running::Straight(bot) => match round {
                AnyRound::Plane(round) => bot.frame(round),
                AnyRound::Space(round) => bot.frame(round),
            },
        };
        let began = now();
        round.step(frame);
        let seconds = (now() - began) as f32;
        self.ticks += 1;
        if !is_idle {
            self.times.push(seconds);
        }
        let is_over = round.ticks() as f32 * DEFAULT_TICK >= running.most();
        let outcome = round.progress().outcome;
        if outcome.is_none() && !is_over {
            return;
        }
        if let Some(outcome) = outcome {
            let found = match (&*running, outcome.route) {
                (Running::Straight(_), _) => &mut self.findings.straight,
                (Running::Idle, _) => &mut self.findings.by_itself,
                (_, Route::Squeeze) => &mut self.findings.squeezed,
                (_, Route::Shave | Route::Mix) => &mut self.findings.shaved,
            };
            let before = match *found {
                Finding::Yes(Some(seconds)) => seconds,
                _ => f32::INFINITY,
            };
            *found = Finding::Yes(Some(outcome.seconds().min(before)));
        }
        self.running = None;
        if self.left.is_empty() {
            self.conclude();
        }
    }

    fn begin_next(&mut self) {
        // Skips a bot whose result is known.
        let is_known = |player: Player| match player {
            Player::Bot(BotKind::Squeeze) => self.findings.squeezed != Finding::Open,
            Player::Bot(BotKind::Shave) => self.findings.shaved != Finding::Open,
            Player::Bot(_) => false,
            Player::Straight => self.findings.straight != Finding::Open,
            Player::Idle => self.findings.by_itself != Finding::Open,
        };
        match self.left.pop() {
            Some((player, _)) if is_known(player) => {}
            Some((player, seed)) => {
                let running = match player {
                    Player::Bot(kind) => Running::Bot(Box::new(Bot::new(kind, seed))),
                    Player::Straight => Running::Straight(StraightPush::new(false, STRAIGHT, seed)),
                    Player::Idle => Running::Idle,
                };
                self.running = Some((AnyRound::new(self.level.clone()), running));
            }
            None => {}
        }
        if self.is_done() {
            self.conclude();
        }
    }

    /// Decides what is still open after the last round.
    fn conclude(&mut self) {
        let Findings {
            squeezed,
            shaved,
            straight,
            by_itself,
            real_time,
            ..
        } = &mut self.findings;
        for open in [squeezed, shaved, straight, by_itself] {
            if *open == Finding::Open {
                *open = Finding::NotFound;
            }
        }
        self.times.sort_by(f32::total_cmp);
        let at = (IN_TIME * self.times.len() as f64) as usize;
        let slow = self.times.get(at).copied().unwrap_or(0.0);
        let is_in_time = f64::from(slow) <= SMALL * f64::from(DEFAULT_TICK);
        *real_time = match is_in_time {
            true => Finding::Yes(None),
            false => Finding::NotFound,
        };
    }
}

/// Returns whether the ends of a rope are farther apart than its length at the start.
fn has_short_rope(level: &Arc<Level>) -> bool {
    fn of<D: Dim>(world: &World<D>) -> bool {
        let mut joints = world.joints();
        joints.any(|(id, joint)| {
            let JointKind::Rope { length } = joint.definition().kind else {
                return false;
            };
            let ends = world.joint_anchor_positions(id).ok().flatten();
            ends.is_some_and(|[from, to]| {
                from.to_vec3().distance(to.to_vec3()) > length + SHORT_ROPE
            })
        })
    }
    let is_rope = |joint: &JointText| joint.kind == JointKindText::Rope;
    if !level.scene().joint.iter().any(is_rope) {
        return false;
    }
    match AnyRound::new(level.clone()) {
        AnyRound::Plane(round) => of(round.world()),
        AnyRound::Space(round) => of(round.world()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::draft::Draft;
    use crate::items::{Kind, add};
    use fuwafuwa::Vec3;
    use std::cell::Cell;
    use tamaire_play::level::built_in;

    /// Checks a level to the end, with ticks that seem to take `seconds`.
    fn checked(id: &str, seconds: f64) -> Check {
        let mut check = Check::new(Arc::new(Level::open(id).unwrap()));
        let time = Cell::new(0.0);
        // Each tick asks for the time before and after it, and once before that.
        let now = || {
            time.set(time.get() + seconds);
            time.get()
        };
        let mut before = 0.0;
        while !check.is_done() {
            check.go_on(100.0 * seconds, now);
            assert!(check.progress() >= before);
            before = check.progress();
        }
        check
    }

    #[test]
    fn classic_can_be_squeezed_and_shaved() {
        let check = checked("classic", 0.001);
        let Findings {
            squeezed,
            shaved,
            real_time,
            ..
        } = *check.findings();
        for found in [squeezed, shaved] {
            let Finding::Yes(Some(seconds)) = found else {
                panic!("{found:?}");
            };
            assert!(seconds > 0.5 && seconds <= SECONDS);
        }
        assert_eq!(real_time, Finding::Yes(None));
        assert_eq!(check.findings().by_itself, Finding::NotFound);
        assert!(check.played_seconds() > IDLE);
    }

    #[test]
    fn level_with_its_body_in_the_basket_wins_by_itself() {
        let mut scene = Level::open("classic").unwrap().scene().clone();
        let game = scene.game.as_mut().unwrap();
        game.basket.as_mut().unwrap().half = [3.0; 3];
        let mut check = Check::new(Arc::new(Level::from_scene("won", scene).unwrap()));
        assert_eq!(check.played_seconds(), 0.0);
        let now = || 0.0;
        while check.findings().by_itself == Finding::Open {
            check.tick(&now);
        }
        let Finding::Yes(Some(seconds)) = check.findings().by_itself else {
            panic!("{:?}", check.findings());
        };
        assert_eq!(seconds, 0.0, "no hand moved");
        assert!((0.1..IDLE).contains(&check.played_seconds()));
    }

    #[test]
    fn slow_playground_is_told_to_be_slow_and_has_no_ways() {
        let check = checked("sandbox", 0.012);
        let findings = check.findings();
        assert_eq!(findings.real_time, Finding::NotFound);
        for finding in [
            findings.squeezed,
            findings.shaved,
            findings.straight,
            findings.by_itself,
        ] {
            assert_eq!(finding, Finding::NotAsked);
        }
        assert_eq!(check.progress(), 1.0);
    }

    #[test]
    fn rope_that_is_too_short_is_told() {
        for (short, expected) in [(0.0, false), (0.2, true)] {
            let mut scene = Draft::blank(2).scene().clone();
            add(&mut scene, Kind::Rope, Vec3::ZERO);
            let length = scene.joint[0].length.as_mut().unwrap();
            *length -= short;
            let level = Arc::new(Level::from_scene("roped", scene).unwrap());
            assert_eq!(Check::new(level).findings().has_short_rope, expected);
        }
        for (id, _) in built_in() {
            let level = Arc::new(Level::open(id).unwrap());
            assert!(!has_short_rope(&level), "{id}");
        }
    }
}
