//! What a browser has to get right and be fast enough at, without the game around it: the golden scenes, and rounds
//! that bots play, recorded here and verified there.
//!
//! `cargo xtask wasm` and `web --test` build it as a WebAssembly module with the profile of the game. `xtask/golden.mjs` runs it
//! under Node, `xtask/web/test/bits.mjs` and `xtask/web/test/speed.mjs` load it into browsers through the [`exports`];
//! natively the example `replays` does the same.
use std::sync::Arc;
use tamaire_play::level::{NAMED, NAMED_3D};
use tamaire_play::{AnyRound, Bot, BotKind, InputFrame, Level, Playback, Replay};

/// Rounds in a series.
pub const ROUNDS: usize = 20;
/// Ticks of the longest round of a series: ten seconds, in which a body tears where it is going to.
pub const MOST_TICKS: usize = 600;

/// What to play in a series, as [`Game::begin`] reads it: every level, in the plane and in space, by other bots than in
/// the series before and after it, and by seeds of its own.
pub fn series(number: usize) -> Vec<String> {
    let levels: Vec<&str> = NAMED.iter().chain(&NAMED_3D).map(|(id, _)| *id).collect();
    let game = |round: usize| {
        let (level, lap) = (levels[round % levels.len()], round / levels.len());
        let routes = Level::open(level).map_or(0, |level| level.routes().len());
        let bot = match (routes, (round + lap + number) % 2) {
            // Without a basket the others have nothing to do.
            (0, _) => "random",
            (_, 0) => "squeeze",
            _ => "shave",
        };
        format!("{level} {bot} {}", 1 + number * ROUNDS + round)
    };
    (0..ROUNDS).map(game).collect()
}

/// A round that a bot plays.
pub struct Game {
    round: AnyRound,
    bot: Bot,
    /// What the bot wants in the next tick.
    frame: InputFrame,
}

impl Game {
    /// The start of a round, from `LEVEL BOT SEED`, such as `classic shave 1`.
    ///
    /// # Errors
    /// What was expected, where the text says something else.
    pub fn begin(text: &str) -> Result<Self, String> {
        let words: Vec<&str> = text.split(' ').collect();
        let [level, bot, seed] = words[..] else {
            return Err(format!("expected LEVEL BOT SEED, found {text:?}"));
        };
        let level = Level::open(level).map_err(|error| error.to_string())?;
        let kind = BotKind::NAMED.iter().find(|(name, _)| *name == bot);
        let (_, kind) = kind.ok_or_else(|| format!("there is no bot {bot:?}"))?;
        let seed = seed.parse();
        let seed = seed.map_err(|error| format!("the seed of {text:?}: {error}"))?;
        Ok(Self {
            round: AnyRound::new(Arc::new(level)),
            bot: Bot::new(*kind, seed),
            frame: InputFrame::default(),
        })
    }

    /// Lets the bot decide on the next tick.
    pub fn ask(&mut self) {
        self.frame = self.round.ask(&mut self.bot);
    }

    /// Lets a tick pass. Returns whether the round goes on.
    pub fn step(&mut self) -> bool {
        self.round.step(self.frame);
        self.round.progress().outcome.is_none()
    }

    /// What was played so far, as a text.
    ///
    /// # Errors
    /// Why nobody could watch it again.
    pub fn replay(&self) -> Result<String, String> {
        let replay = self.round.replay();
        replay.text_to_keep().map_err(|error| error.to_string())
    }
}

/// Plays a round of a series; its replay as a text.
///
/// # Errors
/// As [`Game::begin`] and [`Game::replay`].
pub fn record(text: &str) -> Result<String, String> {
    let mut game = Game::begin(text)?;
    for _ in 0..MOST_TICKS {
        game.ask();
        if !game.step() {
            break;
        }
    }
    game.replay()
}

/// Plays a replay to its end. Returns the world's last hash.
///
/// # Errors
/// Why it is none, or where it goes another way than it says.
pub fn verify(bytes: &[u8]) -> Result<u64, String> {
    let wrong = |error: tamaire_play::ReplayError| error.to_string();
    let replay = Replay::of_bytes(bytes).map_err(wrong)?;
    let mut playback = Playback::new(Arc::new(replay)).map_err(wrong)?;
    while !playback.is_over() {
        playback.step().map_err(wrong)?;
    }
    Ok(playback.round().hash())
}
