//! Reasons for silence.

use crate::State;
use std::fmt;
use std::time::Duration;

/// Maximum age of a state. Two updates at the slowest rate below the limit of 100 ms.
pub const MAX_STATE_AGE: Duration = Duration::from_millis(84);

/// Reason for silence.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stop {
    /// No state was reported yet.
    NoState,
    /// No player uses the device.
    Idle,
    /// The game is paused.
    Paused,
    /// The window lost the focus.
    FocusLost,
    /// A menu is open.
    Menu,
    /// The round is won and the hand is no longer controlled.
    Won,
    /// The world restarts, with the hand at another position.
    Reset,
    /// The device was unplugged.
    Unplugged,
    /// The last state is older than [`MAX_STATE_AGE`].
    Stale,
    /// Emergency stop; lasts until it is released.
    Emergency,
    /// The thread has ended.
    Ended,
}

impl fmt::Display for Stop {
    fn fmt(&self, to: &mut fmt::Formatter) -> fmt::Result {
        to.write_str(match self {
            Self::NoState => "unheard",
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

/// Last command of the game for a device, with its time on a shared clock.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Command {
    /// State, or a reason for silence.
    pub wish: Result<State, Stop>,
    /// Time of the command.
    pub at: Duration,
}

/// Blocks forces.
#[derive(Clone, Copy, Debug, Default)]
pub struct Watchdog {
    emergency: bool,
}

impl Default for Command {
    fn default() -> Self {
        Self {
            wish: Err(Stop::NoState),
            at: Duration::ZERO,
        }
    }
}

impl Watchdog {
    /// Blocks all forces from now on.
    pub fn latch(&mut self) {
        self.emergency = true;
    }

    /// Ends the block.
    pub fn release(&mut self) {
        self.emergency = false;
    }

    /// Returns the state to be felt at the time `now`.
    ///
    /// # Errors
    /// Returns the reason for silence.
    pub fn pass(&self, mail: &Command, now: Duration) -> Result<State, Stop> {
        if self.emergency {
            return Err(Stop::Emergency);
        }
        let state = mail.wish?;
        if now.saturating_sub(mail.at) > MAX_STATE_AGE {
            return Err(Stop::Stale);
        }
        Ok(state)
    }
}
