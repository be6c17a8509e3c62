//! Reasons to output no force, and their check before each step.

use crate::State;
use std::fmt;
use std::time::Duration;

/// Maximum age of a state that gives a force. The force must end within 100 ms of the last state. The 16 ms
/// between both limits allow two updates at the slowest of [`RATES`](crate::RATES).
pub const MAX_STATE_AGE: Duration = Duration::from_millis(84);

/// Reason to output no force.
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
    /// The thread that drives the devices has ended.
    Ended,
}

impl fmt::Display for Stop {
    fn fmt(&self, to: &mut fmt::Formatter) -> fmt::Result {
        to.write_str(match self {
            Self::NoState => "no state",
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

/// Last command of the game for a device, with the time at which it was given.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Command {
    /// State from which to compute the force, or a reason to output no force.
    pub wish: Result<State, Stop>,
    /// Time of the command on the clock that all devices share.
    pub at: Duration,
}

/// Check before each step. Blocks forces during an emergency stop, after other stops, and when the last state
/// is too old.
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
    /// Starts an emergency stop: blocks all forces until [`Watchdog::release`].
    pub fn latch(&mut self) {
        self.emergency = true;
    }

    /// Ends an emergency stop.
    pub fn release(&mut self) {
        self.emergency = false;
    }

    /// Returns the state from which to compute the force at the time `now`.
    ///
    /// # Errors
    /// The reason to output no force.
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
