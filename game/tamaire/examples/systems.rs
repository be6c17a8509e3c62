//! What the game costs a frame besides its simulation and its picture: input, rules as they are
//! shown, camera, effects, feelings, sounds.
//!
//! ```text
//! cargo run --release -p tamaire --example systems
//! ```

use fuwafuwa::Dim2;
use fuwafuwa::world::TICK;
use std::time::{Duration, Instant};
use tamaire::game::Game;
use tamaire::platform::{Files, Pads, Sound};
use tamaire_play::{Bot, BotKind, Round};

fn main() {
    // A round goes the same way each time: the least of three is what a frame takes undisturbed.
    let mut rest = round();
    for _ in 0..2 {
        for (least, found) in rest.iter_mut().zip(round()) {
            *least = found.min(*least);
        }
    }
    rest.sort();
    let milliseconds = |place: usize| 1e3 * rest[place].as_secs_f64();
    println!(
        "{} frames; ms a frame: median {:.2}, 99 of 100 {:.2}, worst {:.2}",
        rest.len(),
        milliseconds(rest.len() / 2),
        milliseconds(rest.len() * 99 / 100),
        milliseconds(rest.len() - 1),
    );
}

/// What each frame of a round costs so.
fn round() -> Vec<Duration> {
    let mut game = Game::new(Files::nowhere(), Sound::none(), Pads::none());
    game.start(0);
    let mut bot = Bot::new(BotKind::Shave, 1);
    let mut beside = Round::<Dim2>::new(game.bout.round().level().clone());
    let mut rest = Vec::new();
    while game.bout.won.is_none() && rest.len() < 40 * 60 {
        game.controls.devices.pointer = game.bout.round().ask(&mut bot).goal(0);
        let whole = time(|| game.pass(TICK));
        // The very same tick without a game around it.
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
