//! Recorded rounds that play behind the title.

use crate::session::Session;
use std::sync::Arc;
use tamaire_play::Replay;

/// Recorded rounds of the level Classic: one won by squeezing, one by shaving. Playback can diverge after a
/// change of the engine, the rules or the level; a test detects this. CONTRIBUTING.md tells how to record the
/// rounds again.
const RECORDED: [&str; 2] = [
    include_str!("../attract/squeeze.tamaire"),
    include_str!("../attract/shave.tamaire"),
];

/// Returns a session that plays the recording with index `number` modulo the number of recordings.
pub fn attract(number: usize) -> Session {
    let text = RECORDED[number % RECORDED.len()];
    let replay = Replay::read(text).map(Arc::new);
    replay
        .and_then(Session::of_replay)
        .expect("a test plays every recording")
}

#[cfg(test)]
mod tests {
    use super::*;
    use app_shell::Clock;
    use fuwafuwa::DEFAULT_TICK;
    use tamaire_play::{InputFrame, Level, Route};

    #[test]
    fn recordings_replay_without_divergence() {
        let classic = Level::open("classic").unwrap();
        for (number, route) in [Route::Squeeze, Route::Shave].into_iter().enumerate() {
            let (mut session, clock) = (attract(number), Clock::of_machine());
            assert_eq!(session.round().level().hash(), classic.hash());
            while !session.is_over() {
                session.advance(DEFAULT_TICK, &clock, |_| InputFrame::default(), |_| {});
                assert!(session.take_complaint().is_none(), "{route:?}");
            }
            let outcome = session.round().progress().outcome.unwrap();
            assert_eq!(outcome.route, route);
        }
    }
}
