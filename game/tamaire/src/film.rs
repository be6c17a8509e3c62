//! Films of rounds: a strip of moments, an animation, a clip of the last seconds, or a photo of the end.
//!
//! The round is simulated again from its recorded input, so drawing does not disturb its timing. The pictures
//! look the same as in the window. On a desktop without a graphics adapter, the elements of the bodies are
//! drawn instead.

#[cfg(not(target_family = "wasm"))]
mod device;
#[cfg(target_family = "wasm")]
#[path = "film/lent.rs"]
mod device;
#[cfg(not(target_family = "wasm"))]
mod plain;
mod studio;

use crate::look::Effects;
use crate::platform::Yielder;
use app_shell::CameraRig;
#[cfg(target_family = "wasm")]
pub use device::lend;
use fuwafuwa::DEFAULT_TICK;
use fuwafuwa_painter::{PaintError, Pixmap, film, png_of};
use fuwafuwa_render::ImageError;
use std::io::Write;
use studio::Moment;
pub use studio::Studio;
use tamaire_play::{AnyRound, Route};

/// Number of moments in a strip.
const MOMENTS: usize = 12;
/// Number of columns of a film strip, a picture of several moments.
const COLUMNS: usize = 4;
/// Ticks from one frame of an animation or clip to the next.
const PACE: usize = 3;
/// Display time of each frame [1/100 s], equal to [`PACE`] ticks.
const HUNDREDTHS: u16 = 5;
/// Display time of the last frame before the animation repeats [1/100 s].
const LAST: u16 = 200;
/// Length of a clip [ticks].
const LENGTH: usize = 240;
/// Length of the celebration that is added to a won round [ticks].
const CHEER: usize = 60;
/// Format of a moment of a strip or animation.
const MOMENT: Print = Print {
    size: [480, 300],
    is_captioned: true,
};
/// Format of a frame of a clip.
const CLIP: Print = Print {
    is_captioned: false,
    ..MOMENT
};
/// Format of a photo.
const PHOTO: Print = Print {
    size: [1280, 800],
    is_captioned: false,
};

/// Kind of film.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum Film {
    /// Moments of the round side by side.
    Strip,
    /// The whole round.
    Animation,
    /// The last seconds of the round, in a loop.
    Clip,
    /// The end of the round.
    Photo,
}

/// Format of a picture.
#[derive(Copy, Clone)]
struct Print {
    /// Width and height without the caption [px].
    size: [u32; 2],
    /// Whether a caption below the picture states the time and the progress.
    is_captioned: bool,
}

/// Reason why a film could not be made.
#[derive(Debug, thiserror::Error)]
pub enum FilmError {
    /// Drawing without a GPU, or encoding, failed.
    #[error(transparent)]
    Paint(#[from] PaintError),
    /// Drawing on the GPU failed.
    #[error(transparent)]
    Draw(#[from] ImageError),
    /// There is no GPU, without which films cannot be drawn in a browser.
    #[cfg(target_family = "wasm")]
    #[error("no graphics adapter was found to draw the film")]
    NoGpu,
}

impl Film {
    /// Makes the film of a round and returns the bytes of its file. `told` is called with the number of
    /// finished ticks and the total number of ticks. If `studio` is `None`, opens an offscreen renderer and
    /// stores it in `studio` for the next film.
    ///
    /// # Errors
    /// If drawing or encoding fails.
    pub async fn shoot(
        &self,
        played: &AnyRound,
        studio: &mut Option<Studio>,
        told: &dyn Fn(usize, usize),
    ) -> Result<Vec<u8>, FilmError> {
        let is_won = played.progress().outcome.is_some();
        let ticks = played.frames().len() + if is_won { CHEER } else { 0 };
        match self {
            Self::Strip => {
                let mut moments = Vec::new();
                // The first moment is the start, the last one the end.
                let gaps = MOMENTS.min(ticks + 1) - 1;
                let is_shown = |tick| moments_at(ticks, gaps).any(|moment| moment == tick);
                let show = |pixels, _| {
                    moments.push(pixels);
                    Ok(())
                };
                pass(played, ticks, studio, told, MOMENT, is_shown, show).await?;
                Ok(film::strip(&moments, COLUMNS)?.png()?)
            }
            Self::Animation | Self::Clip => {
                let (print, first) = match self {
                    Self::Clip => (CLIP, ticks.saturating_sub(LENGTH)),
                    _ => (MOMENT, 0),
                };
                let mut gif = film::Gif::default();
                let is_shown =
                    |tick: usize| tick >= first && (tick == ticks || tick.is_multiple_of(PACE));
                let show = |pixels: Pixmap, tick| {
                    gif.add(&pixels, if tick == ticks { LAST } else { HUNDREDTHS })
                };
                pass(played, ticks, studio, told, print, is_shown, show).await?;
                Ok(gif.finish()?)
            }
            Self::Photo => {
                let mut photo = Vec::new();
                let is_last = |tick| tick == ticks;
                let show = |pixels: Pixmap, _| {
                    photo = png_of(&pixels)?;
                    Ok(())
                };
                pass(played, ticks, studio, told, PHOTO, is_last, show).await?;
                Ok(photo)
            }
        }
    }
}

/// Returns `gaps + 1` ticks from 0 to `ticks`, evenly spaced.
fn moments_at(ticks: usize, gaps: usize) -> impl Iterator<Item = usize> {
    (0..=gaps).map(move |gap| gap * ticks / gaps.max(1))
}

/// Simulates a round again for `ticks` ticks and passes pictures of the selected ticks to `show`.
async fn pass(
    played: &AnyRound,
    ticks: usize,
    studio: &mut Option<Studio>,
    told: &dyn Fn(usize, usize),
    print: Print,
    is_shown: impl Fn(usize) -> bool,
    mut show: impl FnMut(Pixmap, usize) -> Result<(), PaintError>,
) -> Result<(), FilmError> {
    *studio = studio.take().or_else(Studio::open);
    if studio.is_none() {
        // Standard error may be closed.
        let _ = writeln!(
            std::io::stderr(),
            "tamaire: no graphics adapter: neither Vulkan nor OpenGL is available, not even in software, so bodies are drawn element by element"
        );
    }
    let mut round = AnyRound::new(played.level().clone());
    let (mut effects, mut camera) = (Effects::default(), CameraRig::default());
    let mut breath = Yielder::default();
    for tick in 0..=ticks {
        told(tick, ticks);
        breath.yield_now().await;
        if tick > 0 {
            let frame = played.frames().get(tick - 1).copied();
            round.step(frame.unwrap_or_default());
            effects.process_tick(&round, &mut camera, false);
            effects.advance(DEFAULT_TICK);
            let hand = round.hands()[0].position;
            camera.follow(hand, round.level().arena(), DEFAULT_TICK, false);
        }
        if !is_shown(tick) {
            continue;
        }
        let caption = caption(&round, tick == ticks);
        let caption = print.is_captioned.then_some(caption.as_str());
        let pixels = match studio {
            Some(opened) => {
                let moment = Moment {
                    round: &round,
                    effects: &effects,
                    camera: &camera,
                    time: tick as f64 * f64::from(DEFAULT_TICK),
                    caption,
                };
                let drawn = opened.shoot(&moment, print.size).await;
                if drawn.is_err() {
                    // The device may be lost, so the next film opens a new studio.
                    *studio = None;
                }
                pixels_of(&drawn?, Studio::size(&moment, print.size))?
            }
            #[cfg(not(target_family = "wasm"))]
            None => plain::picture(&round, print.size, caption)?,
            #[cfg(target_family = "wasm")]
            None => return Err(FilmError::NoGpu),
        };
        show(pixels, tick)?;
    }
    if let Some(opened) = studio {
        opened.rest();
    }
    Ok(())
}

/// Converts a drawn picture to the pixel format of the film encoder.
fn pixels_of(drawn: &[u8], [width, height]: [u32; 2]) -> Result<Pixmap, PaintError> {
    let what = "a picture";
    let mut pixels = Pixmap::new(width, height).ok_or(PaintError::NoSize { what })?;
    pixels.data_mut().copy_from_slice(drawn);
    Ok(pixels)
}

/// Returns the caption of a picture: time and progress of the round.
fn caption(round: &AnyRound, is_last: bool) -> String {
    let progress = round.progress();
    let seconds = round.seconds();
    match (progress.outcome, progress.pieces) {
        (Some(outcome), _) => {
            format!("{} in {:.1} s!", by_route(outcome.route), outcome.seconds())
        }
        (None, _) if is_last => format!("not won in {seconds:.1} s"),
        (None, 1) => format!("{seconds:.1} s"),
        (None, pieces) => format!("{seconds:.1} s, {pieces} pieces"),
    }
}

/// Returns a phrase for the way in which a round was won.
pub fn by_route(route: Route) -> &'static str {
    match route {
        Route::Squeeze => "squeezed in whole",
        Route::Shave => "shaved to fit",
        Route::Mix => "shaved and squeezed in",
    }
}
