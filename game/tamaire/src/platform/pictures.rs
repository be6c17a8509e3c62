//! Photos and clips of finished rounds.

use super::breath::Yielder;
use super::storage::Kind;
use crate::film::{Film, Studio};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use tamaire_play::{Playback, Replay};

/// Maker of photos and clips. Its studio, the offscreen renderer, is opened for the first picture and kept,
/// because closing a GPU device leaks memory in drivers and allocators.
#[derive(Clone, Default)]
pub struct Pictures(Arc<Mutex<Option<Studio>>>);

impl Pictures {
    /// Makes a picture of a round and returns the bytes of its file. `told` is called with the progress, 0 to
    /// 1.
    pub async fn shoot(
        &self,
        kind: Kind,
        replay: Arc<Replay>,
        told: impl Fn(f32),
    ) -> Result<Vec<u8>, String> {
        let film = match kind {
            Kind::Clip => Film::Clip,
            _ => Film::Photo,
        };
        let why = |error: &dyn std::error::Error| error.to_string();
        let mut playback = Playback::new(replay).map_err(|error| why(&error))?;
        let mut breath = Yielder::default();
        while !playback.is_over() {
            playback.step().map_err(|error| why(&error))?;
            breath.yield_now().await;
        }
        let share = |tick: usize, ticks: usize| told(tick as f32 / ticks.max(1) as f32);
        // Only one picture is made at a time, so no other job needs the studio meanwhile.
        let mut studio = self.studio().take();
        let was_open = studio.is_some();
        let mut shot = film.shoot(playback.round(), &mut studio, &share).await;
        if shot.is_err() && was_open && studio.is_none() {
            // The GPU device was lost since the last picture. Tries again with a new one.
            shot = film.shoot(playback.round(), &mut studio, &share).await;
        }
        *self.studio() = studio;
        shot.map_err(|error| why(&error))
    }

    fn studio(&self) -> MutexGuard<'_, Option<Studio>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
