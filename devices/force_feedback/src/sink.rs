//! Devices, as seen from here.

use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;
use web_time::Instant;

/// What is played ends by itself after this time, unless it is told again: the second deadman. Kernels stop the forces of
/// a process that dies, not of one that hangs.
pub const LENGTH: Duration = Duration::from_millis(500);

/// What a device can do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ability {
    /// It pushes the stick along two axes.
    Force,
    /// It has a slow and a fast motor that shake it.
    Rumble,
    /// It cannot be felt.
    Nothing,
}

/// What a device is told.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Output {
    /// To push the stick: x to the right, y away from the player [full forces], each -1 to 1.
    Force([f32; 2]),
    /// To shake, each 0 to 1.
    Rumble {
        /// The slow, strong motor.
        low: f32,
        /// The fast, weak one.
        high: f32,
    },
}

/// The device is not there any more.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Gone;

/// A device. It is called on one thread, 125 to 250 times a second, and must not wait for anything.
pub trait Sink: Send {
    /// What it can do. May become better when a driver is ready at last.
    fn ability(&self) -> Ability;

    /// Where the stick points now: x to the right, y away from the player, each -1 to 1.
    ///
    /// # Errors
    /// [`Gone`], and nothing is played any more.
    fn aim(&mut self) -> Result<[f32; 2], Gone>;

    /// Plays this at once, instead of what was before, for [`LENGTH`]. The same may come again, and starts anew then.
    ///
    /// # Errors
    /// [`Gone`], and nothing is played any more.
    fn play(&mut self, output: Output) -> Result<(), Gone>;
}

/// A device that does nothing.
#[derive(Clone, Copy, Debug, Default)]
pub struct Nothing;

impl Sink for Nothing {
    fn ability(&self) -> Ability {
        Ability::Nothing
    }

    fn aim(&mut self) -> Result<[f32; 2], Gone> {
        Ok([0.0; 2])
    }

    fn play(&mut self, _: Output) -> Result<(), Gone> {
        Ok(())
    }
}

/// A device that writes down what it is told. Clones are the same device.
#[derive(Clone, Debug)]
pub struct Recording(Arc<Mutex<Tape>>);

/// One thing that a [`Recording`] was told.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Played {
    /// When, since the recording was made.
    pub at: Duration,
    /// What.
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
    /// A device that can do this, upright.
    pub fn new(ability: Ability) -> Self {
        Self(Arc::new(Mutex::new(Tape {
            start: Instant::now(),
            ability,
            aim: Ok([0.0; 2]),
            played: Vec::new(),
        })))
    }

    /// Leans it, or unplugs it.
    pub fn lean(&self, aim: Result<[f32; 2], Gone>) {
        self.tape(|tape| tape.aim = aim);
    }

    /// All that it was told since this was asked last.
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

    fn aim(&mut self) -> Result<[f32; 2], Gone> {
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
    /// Nothing, for a device that can do this.
    pub fn zero(ability: Ability) -> Self {
        match ability {
            Ability::Force | Ability::Nothing => Self::Force([0.0; 2]),
            Ability::Rumble => Self::Rumble {
                low: 0.0,
                high: 0.0,
            },
        }
    }

    /// Both numbers as drivers count, -32767 to 32767.
    pub fn levels(&self) -> [i16; 2] {
        let both = match *self {
            Self::Force(both) => both,
            Self::Rumble { low, high } => [low, high],
        };
        // A float that is out of range or no number at all ends up within it.
        both.map(|k| (k.clamp(-1.0, 1.0) * 32767.0).round() as i16)
    }

    /// Whether it does nothing.
    pub fn is_zero(&self) -> bool {
        self.levels() == [0; 2]
    }
}
