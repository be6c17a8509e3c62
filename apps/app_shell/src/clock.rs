//! Monotonic clock.

use std::rc::Rc;
use web_time::Instant;

/// Monotonic clock, which changes of the system time do not affect.
#[derive(Clone)]
pub struct Clock(Rc<dyn Fn() -> f64>);

impl Clock {
    /// Returns the monotonic clock of the machine.
    pub fn of_machine() -> Self {
        let start = Instant::now();
        Self::of(move || start.elapsed().as_secs_f64())
    }

    /// Returns a test clock that reads the time [s] from the function `tell`.
    pub fn of(tell: impl Fn() -> f64 + 'static) -> Self {
        Self(Rc::new(tell))
    }

    /// Time since an arbitrary moment in the past [s].
    pub fn now(&self) -> f64 {
        (self.0)()
    }
}
