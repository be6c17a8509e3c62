//! Interface of a force-feedback device, and stand-ins for tests.

use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;
use web_time::Instant;

/// Time after which a device ends an output that is not repeated. Without this limit, a force would last
/// while the process hangs, because kernels stop forces only when the process dies.
pub const OUTPUT_DURATION: Duration = Duration::from_millis(500);

/// Kind of feedback that a device supports.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ability {
    /// Pushes the stick along two axes.
    Force,
    /// Rumbles with a slow and a fast motor.
    Rumble,
    /// No feedback.
    Nothing,
}

/// Output to a device.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Output {
    /// Forces of the two motors [full forces], each −1 to 1. With the default mounting, x pushes to the right
    /// and y away from the player.
    Force([f32; 2]),
    /// Rumble strengths, each 0 to 1.
    Rumble {
        /// Slow, strong motor.
        low: f32,
        /// Fast, weak motor.
        high: f32,
    },
}

/// Error: the device was unplugged.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Gone;

/// Device that plays forces. All methods are called on one thread, 125 to 250 times a second, and must not
/// block.
pub trait Sink: Send {
    /// Returns the kind of feedback that the device supports. It may improve once a driver is ready.
    fn ability(&self) -> Ability;

    /// Returns the current stick position: x to the right, y away from the player, each −1 to 1.
    ///
    /// # Errors
    /// [`Gone`] if the device was unplugged; an unplugged device plays no further output.
    fn stick_position(&mut self) -> Result<[f32; 2], Gone>;

    /// Plays an output at once for [`OUTPUT_DURATION`], instead of the previous one. Repeating the same
    /// output restarts its duration.
    ///
    /// # Errors
    /// [`Gone`] if the device was unplugged; an unplugged device plays no further output.
    fn play(&mut self, output: Output) -> Result<(), Gone>;
}

/// Device without any feedback.
#[derive(Clone, Copy, Debug, Default)]
pub struct Nothing;

impl Sink for Nothing {
    fn ability(&self) -> Ability {
        Ability::Nothing
    }

    fn stick_position(&mut self) -> Result<[f32; 2], Gone> {
        Ok([0.0; 2])
    }

    fn play(&mut self, _: Output) -> Result<(), Gone> {
        Ok(())
    }
}

/// Stand-in for a device that records its outputs. Clones share one recording.
#[derive(Clone, Debug)]
pub struct Recording(Arc<Mutex<Tape>>);

/// Output recorded by a [`Recording`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Played {
    /// Time since the recording was created.
    pub at: Duration,
    /// Output that was played.
    pub output: Output,
}

#[derive(Debug)]
struct Tape {
    start: Instant,
    ability: Ability,
    aim: Result<[f32; 2], Gone>,
    played: Vec<Played>,
}

impl Default for Recording {
    fn default() -> Self {
        Self::new(Ability::Force)
    }
}

impl Recording {
    /// Creates a device with a capability; its stick is in the middle.
    pub fn new(ability: Ability) -> Self {
        Self(Arc::new(Mutex::new(Tape {
            start: Instant::now(),
            ability,
            aim: Ok([0.0; 2]),
            played: Vec::new(),
        })))
    }

    /// Sets the stick position. `Err(Gone)` unplugs the device.
    pub fn lean(&self, aim: Result<[f32; 2], Gone>) {
        self.tape(|tape| tape.aim = aim);
    }

    /// Returns all outputs that were played since the last call of `take`.
    pub fn take(&self) -> Vec<Played> {
        self.tape(|tape| std::mem::take(&mut tape.played))
    }

    fn tape<R>(&self, act: impl FnOnce(&mut Tape) -> R) -> R {
        act(&mut self.0.lock().unwrap_or_else(PoisonError::into_inner))
    }
}

impl Sink for Recording {
    fn ability(&self) -> Ability {
        self.tape(|tape| tape.ability)
    }

    fn stick_position(&mut self) -> Result<[f32; 2], Gone> {
        self.tape(|tape| tape.aim)
    }

    fn play(&mut self, output: Output) -> Result<(), Gone> {
        self.tape(|tape| {
            let at = tape.start.elapsed();
            tape.played.push(Played { at, output });
            tape.aim.map(|_| ())
        })
    }
}

impl Output {
    /// Returns the zero output for a device with this capability.
    pub fn zero(ability: Ability) -> Self {
        match ability {
            Ability::Force | Ability::Nothing => Self::Force([0.0; 2]),
            Ability::Rumble => Self::Rumble {
                low: 0.0,
                high: 0.0,
            },
        }
    }

    /// Returns both components of the output in driver units, −32767 to 32767.
    pub fn levels(&self) -> [i16; 2] {
        let both = match *self {
            Self::Force(both) => both,
            Self::Rumble { low, high } => [low, high],
        };
        // The cast saturates out-of-range values and turns NaN into 0.
        both.map(|k| (k.clamp(-1.0, 1.0) * 32767.0).round() as i16)
    }

    /// Returns whether the output rounds to zero in driver units.
    pub fn is_zero(&self) -> bool {
        self.levels() == [0; 2]
    }
}
