//! Measures the cost of a frame without simulation and rendering: input, rules, camera, effects, expressions
//! of bodies, and sounds.
//!
//! ```text
//! cargo run --release -p tamaire --example systems
//! ```

use app_shell::Pads;
use fuwafuwa::{DEFAULT_TICK, Dim2};
use std::time::{Duration, Instant};
use tamaire::game::Game;
use tamaire::platform::{Files, Sound};
use tamaire_play::{Bot, BotKind, Round};

fn main() {
    // Repeats the same deterministic round three times. The minimum time of each frame is the one without
    // disturbances.
    let mut rest = round();
    for _ in 0..2 {
        for (least, found) in rest.iter_mut().zip(round()) {
            *least = found.min(*least);
        }
    }
    rest.sort();
    let milliseconds = |place: usize| 1e3 * rest[place].as_secs_f64();
    println!(
        "{} frames; ms per frame: median {:.2}, 99th percentile {:.2}, maximum {:.2}",
        rest.len(),
        milliseconds(rest.len() / 2),
        milliseconds(rest.len() * 99 / 100),
        milliseconds(rest.len() - 1),
    );
}

/// Returns the cost of each frame of a round, minus the cost of simulating it.
fn round() -> Vec<Duration> {
    let mut game = Game::new(Files::nowhere(), Sound::none(), Pads::none());
    game.start(0);
    let mut bot = Bot::new(BotKind::Shave, 1);
    let mut beside = Round::<Dim2>::new(game.bout.round().level().clone());
    let mut rest = Vec::new();
    while game.bout.won.is_none() && rest.len() < 40 * 60 {
        game.controls.devices.pointer = game.bout.round().ask(&mut bot).goal(0);
        let whole = time(|| game.update(DEFAULT_TICK));
        // Simulates the same tick in a second round, outside of the game.
        let played = game.bout.round().frames();
        let Some(&frame) = played.get(beside.frames().len()) else {
            continue;
        };
        let simulation = time(|| {
            beside.step(frame);
        });
        rest.push(whole.saturating_sub(simulation));
    }
    assert_eq!(beside.world().hash(), game.bout.round().hash());
    rest
}

fn time(what: impl FnOnce()) -> Duration {
    let start = Instant::now();
    what();
    start.elapsed()
}
