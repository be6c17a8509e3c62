//! What plays by itself behind the title: recorded rounds.

use crate::session::Session;
use std::sync::Arc;
use tamaire_play::Replay;

/// One of each route. After a change of the engine, of the rules or of Classic they go astray, which
/// a test notices; CONTRIBUTING.md says how to record them again.
const RECORDED: [&str; 2] = [
    include_str!("../attract/squeeze.tamaire"),
    include_str!("../attract/shave.tamaire"),
];

/// One recorded round after the other, by number.
pub fn attract(number: usize) -> Session {
    let text = RECORDED[number % RECORDED.len()];
    let replay = Replay::read(text).map(Arc::new);
    replay
        .and_then(Session::of_replay)
        .expect("the tests play it")
}

#[cfg(test)]
mod tests {
    use super::*;
    use app_shell::Clock;
    use fuwafuwa::TICK;
    use tamaire_play::{InputFrame, Level, Route};

    #[test]
    fn what_was_recorded_still_goes_as_it_went() {
        let classic = Level::open("classic").unwrap();
        for (number, route) in [Route::Squeeze, Route::Shave].into_iter().enumerate() {
            let (mut session, clock) = (attract(number), Clock::of_machine());
            assert_eq!(session.round().level().hash(), classic.hash());
            while !session.is_over() {
                session.advance(TICK, &clock, |_| InputFrame::default(), |_| {});
                assert!(session.take_complaint().is_none(), "{route:?}");
            }
            let outcome = session.round().progress().outcome.unwrap();
            assert_eq!(outcome.route, route);
        }
    }
}
