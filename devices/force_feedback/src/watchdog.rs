//! Why there is no force.

use crate::State;
use std::fmt;
use std::time::Duration;

/// Mail that is older counts for nothing. Two updates at the slowest rate below the 100 ms that it must never outlast.
pub const OLDEST: Duration = Duration::from_millis(84);

/// Why nothing is played.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stop {
    /// Nothing was said yet.
    Unheard,
    /// Nobody plays with it.
    Idle,
    /// The game rests.
    Paused,
    /// Another window has the keyboard.
    FocusLost,
    /// A menu is open.
    Menu,
    /// It is won: nobody pushes any more.
    Won,
    /// The world starts again, and the hand is elsewhere.
    Reset,
    /// The device has gone.
    Unplugged,
    /// What the simulation said last is older than [`OLDEST`].
    Stale,
    /// Somebody pressed the key for it. Lasts until it is released.
    Emergency,
    /// The thread that plays has ended.
    Ended,
}

impl fmt::Display for Stop {
    fn fmt(&self, to: &mut fmt::Formatter) -> fmt::Result {
        to.write_str(match self {
            Self::Unheard => "unheard",
            Self::Idle => "idle",
            Self::Paused => "paused",
            Self::FocusLost => "focus lost",
            Self::Menu => "menu",
            Self::Won => "won",
            Self::Reset => "reset",
            Self::Unplugged => "unplugged",
            Self::Stale => "stale",
            Self::Emergency => "emergency",
            Self::Ended => "ended",
        })
    }
}

/// The latest that the game said about one device, and when, on a clock that both sides share.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mail {
    /// What there is to feel, or why there is nothing.
    pub wish: Result<State, Stop>,
    /// When it was said.
    pub at: Duration,
}

/// Says no.
#[derive(Clone, Copy, Debug, Default)]
pub struct Watchdog {
    emergency: bool,
}

impl Default for Mail {
    fn default() -> Self {
        Self {
            wish: Err(Stop::Unheard),
            at: Duration::ZERO,
        }
    }
}

impl Watchdog {
    /// Holds everything back from now on.
    pub fn latch(&mut self) {
        self.emergency = true;
    }

    /// Lets through again what comes.
    pub fn release(&mut self) {
        self.emergency = false;
    }

    /// What there is to feel at the time `now`.
    ///
    /// # Errors
    /// Why there is nothing.
    pub fn pass(&self, mail: &Mail, now: Duration) -> Result<State, Stop> {
        if self.emergency {
            return Err(Stop::Emergency);
        }
        let state = mail.wish?;
        if now.saturating_sub(mail.at) > OLDEST {
            return Err(Stop::Stale);
        }
        Ok(state)
    }
}
