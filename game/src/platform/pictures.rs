//! Photos and clips of rounds that were played.

use super::storage::Kind;
use crate::film::Film;
use std::sync::Arc;
use tamaire_play::{Playback, Replay};

/// Whether there are any.
pub const ARE_THERE: bool = true;

/// A picture of a round, as the bytes of its file; `told` hears the share that is done.
pub fn shoot(kind: Kind, replay: Arc<Replay>, told: &dyn Fn(f32)) -> Result<Vec<u8>, String> {
    let film = match kind {
        Kind::Clip => Film::Clip,
        _ => Film::Photo,
    };
    let why = |error: &dyn std::error::Error| error.to_string();
    let mut playback = Playback::new(replay).map_err(|error| why(&error))?;
    while !playback.is_over() {
        playback.step().map_err(|error| why(&error))?;
    }
    let share = |tick: usize, ticks: usize| told(tick as f32 / ticks.max(1) as f32);
    let shot = film.shoot(playback.round(), &share);
    shot.map_err(|error| why(&error))
}
