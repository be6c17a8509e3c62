//! Rounds played by bots, without the window of the game. Rounds recorded natively are verified in browsers,
//! and rounds recorded in browsers are verified natively. The rounds also show whether a browser computes a
//! tick fast enough.
//!
//! `cargo xtask web --test` builds this crate as a WebAssembly module with the profile of the game.
//! `bits.mjs` and `speed.mjs` in `tools/xtask/web/test` load the module into browsers and use the
//! [`exports`](crate::exports). The example `replays` records and verifies natively.
use std::sync::Arc;
use tamaire_play::level::{NAMED, NAMED_3D};
use tamaire_play::{AnyRound, Bot, BotKind, InputFrame, Level, Playback, Replay};

/// Rounds in a series.
pub const ROUNDS: usize = 20;
/// Maximum number of ticks of a round of a series: ten seconds, enough for a body to tear.
pub const MOST_TICKS: usize = 600;

/// Returns the rounds of series number `number`, in the format of [`Game::begin`]. A series contains every
/// level in 2D and 3D. On a level with a basket, the bot differs from that in the previous and the next
/// series. All seeds differ.
pub fn series(number: usize) -> Vec<String> {
    let levels: Vec<&str> = NAMED.iter().chain(&NAMED_3D).map(|(id, _)| *id).collect();
    let game = |round: usize| {
        let (level, lap) = (levels[round % levels.len()], round / levels.len());
        let routes = Level::open(level).map_or(0, |level| level.routes().len());
        let bot = match (routes, (round + lap + number) % 2) {
            // Selects `random` for levels without a basket, because the other bots need one.
            (0, _) => "random",
            (_, 0) => "squeeze",
            _ => "shave",
        };
        format!("{level} {bot} {}", 1 + number * ROUNDS + round)
    };
    (0..ROUNDS).map(game).collect()
}

/// Round played by a bot.
pub struct Game {
    round: AnyRound,
    bot: Bot,
    /// Input of the bot for the next tick.
    frame: InputFrame,
}

impl Game {
    /// Starts a round from `LEVEL BOT SEED`, such as `classic shave 1`.
    ///
    /// # Errors
    /// Returns the reason if the format, the level, the bot or the seed is invalid.
    pub fn begin(text: &str) -> Result<Self, String> {
        let words: Vec<&str> = text.split(' ').collect();
        let [level, bot, seed] = words[..] else {
            return Err(format!("expected LEVEL BOT SEED, found {text:?}"));
        };
        let level = Level::open(level).map_err(|error| error.to_string())?;
        let kind = BotKind::NAMED.iter().find(|(name, _)| *name == bot);
        let (_, kind) = kind.ok_or_else(|| format!("there is no bot {bot:?}"))?;
        let seed = seed.parse();
        let seed = seed.map_err(|error| format!("the seed of {text:?} is invalid: {error}"))?;
        Ok(Self {
            round: AnyRound::new(Arc::new(level)),
            bot: Bot::new(*kind, seed),
            frame: InputFrame::default(),
        })
    }

    /// Computes the bot's input for the next tick.
    pub fn ask(&mut self) {
        self.frame = self.round.ask(&mut self.bot);
    }

    /// Runs a tick. Returns whether the round continues.
    pub fn step(&mut self) -> bool {
        self.round.step(self.frame);
        self.round.progress().outcome.is_none()
    }

    /// Returns the replay of the round until now, as text.
    ///
    /// # Errors
    /// Returns the reason why the replay would be invalid.
    pub fn replay(&self) -> Result<String, String> {
        let replay = self.round.replay();
        replay.text_to_keep().map_err(|error| error.to_string())
    }
}

/// Plays a round of a series and returns its replay as text.
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

/// Plays a replay to its end and returns the final hash of the world.
///
/// # Errors
/// Returns the reason why the replay is invalid, or the first deviation from its recorded hashes.
pub fn verify(bytes: &[u8]) -> Result<u64, String> {
    let wrong = |error: tamaire_play::ReplayError| error.to_string();
    let replay = Replay::of_bytes(bytes).map_err(wrong)?;
    let mut playback = Playback::new(Arc::new(replay)).map_err(wrong)?;
    while !playback.is_over() {
        playback.step().map_err(wrong)?;
    }
    Ok(playback.round().hash())
}
