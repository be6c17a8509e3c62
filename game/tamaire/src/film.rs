//! A round as a strip of moments, as an animation, as a clip of its last seconds or as a photo of its end.
//!
//! The round is played a second time: the same input gives the same world, and drawing disturbs
//! no timing. It is drawn as in a window; where there is nothing to draw with, element by element.

#[cfg(not(target_family = "wasm"))]
mod device;
#[cfg(target_family = "wasm")]
#[path = "film/lent.rs"]
mod device;
#[cfg(not(target_family = "wasm"))]
mod plain;
mod studio;

use crate::look::{CameraRig, Effects};
use crate::platform::Breath;
#[cfg(target_family = "wasm")]
pub use device::lend;
use fuwafuwa::world::TICK;
use fuwafuwa_painter::{PaintError, Pixmap, film, png_of};
use fuwafuwa_render::ImageError;
use studio::Moment;
pub use studio::Studio;
use tamaire_play::{AnyRound, Route};

/// Moments in a strip, and how many stand side by side.
const MOMENTS: usize = 12;
const COLUMNS: usize = 4;
/// Ticks between two frames of an animation, and how long each is shown [1/100 s].
const PACE: usize = 3;
const HUNDREDTHS: u16 = 5;
/// The last frame is shown for longer [1/100 s].
const LAST: u16 = 200;
/// Ticks of a clip.
const LENGTH: usize = 240;
/// Ticks that are shown after a win, so that the body can beam.
const CHEER: usize = 60;
/// A moment of a film, and a photo.
const MOMENT: Print = Print {
    size: [480, 300],
    is_captioned: true,
};
const CLIP: Print = Print {
    is_captioned: false,
    ..MOMENT
};
const PHOTO: Print = Print {
    size: [1280, 800],
    is_captioned: false,
};

/// What kind of film is made.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum Film {
    /// Moments side by side.
    Strip,
    /// All of the round.
    Animation,
    /// Its last seconds, over and over.
    Clip,
    /// Its end.
    Photo,
}

/// How a picture is to come out.
#[derive(Copy, Clone)]
struct Print {
    /// Width and height without its caption [px].
    size: [u32; 2],
    /// Whether it says below when it is and how it stands.
    is_captioned: bool,
}

/// Why there is no film.
#[derive(Debug, thiserror::Error)]
pub enum FilmError {
    /// A picture without a GPU failed.
    #[error(transparent)]
    Paint(#[from] PaintError),
    /// A picture as in the window failed.
    #[error(transparent)]
    Draw(#[from] ImageError),
    /// A browser draws nothing without one.
    #[cfg(target_family = "wasm")]
    #[error("there is nothing to draw with")]
    NoGpu,
}

impl Film {
    /// The film of a round, as the bytes of its file; `told` hears how many ticks of how many are done. The studio is opened
    /// where there is none yet, and serves the next film too.
    ///
    /// # Errors
    /// When something cannot be drawn.
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
                // The first is the start, the last the end.
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

/// The ticks from the first to the last that are as far from each other as can be.
fn moments_at(ticks: usize, gaps: usize) -> impl Iterator<Item = usize> {
    (0..=gaps).map(move |gap| gap * ticks / gaps.max(1))
}

/// Plays a round again for some ticks; those that are to be shown are.
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
        eprintln!(
            "tamaire: there is nothing to draw with, neither Vulkan nor OpenGL, not even in software, so bodies are shown element by element."
        );
    }
    let mut round = AnyRound::new(played.level().clone());
    let (mut effects, mut camera) = (Effects::default(), CameraRig::default());
    let mut breath = Breath::default();
    for tick in 0..=ticks {
        told(tick, ticks);
        breath.take().await;
        if tick > 0 {
            let frame = played.frames().get(tick - 1).copied();
            round.step(frame.unwrap_or_default());
            effects.see(&round, &mut camera, false);
            effects.pass(TICK);
            let hand = round.hands()[0].position();
            camera.follow(hand, round.level().arena(), TICK, false);
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
                    time: tick as f64 * f64::from(TICK),
                    caption,
                };
                let drawn = opened.shoot(&moment, print.size).await;
                if drawn.is_err() {
                    // The next film may have more luck with another device.
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

/// What was drawn, as the films of the painter take it.
fn pixels_of(drawn: &[u8], [width, height]: [u32; 2]) -> Result<Pixmap, PaintError> {
    let what = "a picture";
    let mut pixels = Pixmap::new(width, height).ok_or(PaintError::NoSize { what })?;
    pixels.data_mut().copy_from_slice(drawn);
    Ok(pixels)
}

/// When it is, and how the round stands.
fn caption(round: &AnyRound, is_last: bool) -> String {
    let progress = round.progress();
    let seconds = round.frames().len() as f32 * TICK;
    match (progress.outcome, progress.pieces) {
        (Some(outcome), _) => {
            format!("{} in {:.1} s!", by_route(outcome.route), outcome.seconds())
        }
        (None, _) if is_last => format!("not won in {seconds:.1} s"),
        (None, 1) => format!("{seconds:.1} s"),
        (None, pieces) => format!("{seconds:.1} s, {pieces} pieces"),
    }
}

/// How it was won, in words.
pub fn by_route(route: Route) -> &'static str {
    match route {
        Route::Squeeze => "squeezed in whole",
        Route::Shave => "shaved to fit",
        Route::Mix => "shaved and squeezed in",
    }
}
