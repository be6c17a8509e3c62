//! What time it is, for what must be done in time.

use std::rc::Rc;
use web_time::Instant;

/// A clock that runs evenly, whatever the time of day is set to.
#[derive(Clone)]
pub struct Clock(Rc<dyn Fn() -> f64>);

impl Clock {
    /// That of the machine.
    pub fn of_machine() -> Self {
        let start = Instant::now();
        Self::of(move || start.elapsed().as_secs_f64())
    }

    /// Another one, which tells seconds.
    pub fn of(tell: impl Fn() -> f64 + 'static) -> Self {
        Self(Rc::new(tell))
    }

    /// Seconds since some moment before.
    pub fn now(&self) -> f64 {
        (self.0)()
    }
}
