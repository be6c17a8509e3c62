//! A round as a strip of moments or as an animation.
//!
//! The round is played a second time: the same input gives the same world, and painting disturbs
//! no timing.

use super::played::progress;
use super::report::by_route;
use crate::look::{Camera, Effects, Mood};
use fuwafuwa::vector::{plus, scaled};
use fuwafuwa::world::TICK;
use fuwafuwa::{Dim2, Dim3, Rigid, Shape};
use fuwafuwa_painter::soft::{self, Extras};
use fuwafuwa_painter::solid::{Camera as SolidCamera, Solid};
use fuwafuwa_painter::stage;
use fuwafuwa_painter::{Face, PaintError, Painter, Pixmap, Role, film};
use std::path::Path;
use tamaire_play::{AnyRound, Round};

/// Moments in a strip, and how many stand side by side.
const MOMENTS: usize = 12;
const COLUMNS: usize = 4;
/// Ticks between two frames of an animation, and how long each is shown [1/100 s].
const PACE: usize = 3;
const HUNDREDTHS: u16 = 5;
/// The last frame is shown for longer [1/100 s].
const LAST: u16 = 200;
/// Ticks that are shown after a win, so that the body can beam.
const CHEER: usize = 60;
/// Width of a moment [px].
const WIDTH: u32 = 400;
/// As much of the walls is seen around the arena [m].
const WALL: f32 = 0.05;

/// What kind of film is made.
pub enum Film {
    Strip,
    Animation,
}

impl Film {
    /// The kind that the ending of a path asks for.
    pub fn of(path: &Path) -> Self {
        match path.extension() {
            Some(ending) if ending == "gif" => Self::Animation,
            _ => Self::Strip,
        }
    }

    /// The film of a round, as the bytes of its file.
    pub fn shoot(&self, played: &AnyRound) -> Result<Vec<u8>, PaintError> {
        let ticks = played.frames().len();
        match self {
            Self::Strip => {
                let mut moments = Vec::new();
                // The first is the start, the last the end.
                let gaps = MOMENTS.min(ticks + 1) - 1;
                let is_shown = |tick| moments_at(ticks, gaps).any(|moment| moment == tick);
                pass(played, ticks, is_shown, |pixels, _| {
                    moments.push(pixels);
                    Ok(())
                })?;
                film::strip(&moments, COLUMNS)?.png()
            }
            Self::Animation => {
                let is_won = played.progress().outcome.is_some();
                let ticks = ticks + if is_won { CHEER } else { 0 };
                let mut gif = film::Gif::default();
                let is_shown = |tick| tick == ticks || tick % PACE == 0;
                pass(played, ticks, is_shown, |pixels, tick| {
                    gif.add(&pixels, if tick == ticks { LAST } else { HUNDREDTHS })
                })?;
                gif.finish()
            }
        }
    }
}

/// The ticks from the first to the last that are as far from each other as can be.
fn moments_at(ticks: usize, gaps: usize) -> impl Iterator<Item = usize> {
    (0..=gaps).map(move |gap| gap * ticks / gaps.max(1))
}

/// Plays a round again for some ticks; those that are to be shown are.
fn pass(
    played: &AnyRound,
    ticks: usize,
    is_shown: impl Fn(usize) -> bool,
    mut show: impl FnMut(Pixmap, usize) -> Result<(), PaintError>,
) -> Result<(), PaintError> {
    let mut round = AnyRound::new(played.level().clone());
    let mut effects = Effects::default();
    let bar = progress("filming", ticks as u64);
    for tick in 0..=ticks {
        bar.inc(u64::from(tick > 0));
        if tick > 0 {
            let frame = played.frames().get(tick - 1).copied();
            round.step(frame.unwrap_or_default());
            effects.see(&round, &mut Camera::default(), false);
            effects.pass(TICK);
        }
        if is_shown(tick) {
            show(moment(&round, &effects, tick == ticks)?, tick)?;
        }
    }
    Ok(())
}

/// A picture of a round as it is now, and whether that is how it stays.
fn moment(round: &AnyRound, effects: &Effects, is_last: bool) -> Result<Pixmap, PaintError> {
    let mut painter = match round {
        AnyRound::Plane(round) => plane(round, effects),
        AnyRound::Space(round) => space(round)?,
    };
    painter.caption(&caption(round, is_last));
    painter.pixels()
}

/// As the game shows it.
fn plane(round: &Round<Dim2>, effects: &Effects) -> Painter {
    let [low, high] = round.level().arena();
    let view = [low.map(|k| k - WALL), high.map(|k| k + WALL)];
    let (mut painter, frame) = Painter::for_view(view, WIDTH);
    let world = round.world();
    let look_at = round.hands().next().map_or([0.0; 3], Rigid::position);
    let bodies = world.bodies().iter().enumerate();
    let faces = bodies.filter_map(|(place, body)| {
        let feeling = effects.feelings.get(place);
        let mood = match feeling.map_or(Mood::Calm, |feeling| feeling.mood) {
            Mood::Calm => fuwafuwa_painter::Mood::Calm,
            Mood::Wince => fuwafuwa_painter::Mood::Wince,
            Mood::Shock => fuwafuwa_painter::Mood::Shock,
            Mood::Beam => fuwafuwa_painter::Mood::Beam,
        };
        Face::on(body, mood, look_at)
    });
    let extras = Extras {
        basket: round.basket().copied(),
        faces: faces.collect(),
    };
    soft::world(&mut painter, frame, world, &extras);
    for speck in &effects.specks {
        let radius = speck.radius * speck.strength() * frame.unit;
        painter.dot(frame.spot(speck.at), radius, Role::Crumb);
    }
    painter
}

/// From above and the front, without faces and walls.
fn space(round: &Round<Dim3>) -> Result<Painter, PaintError> {
    let [low, high] = round.level().arena();
    let middle = [0, 1, 2].map(|axis| 0.5 * (low[axis] + high[axis]));
    let across = high[0] - low[0];
    let mut solid = Solid::new(SolidCamera {
        eye: plus(middle, scaled([0.0, 1.1, 1.5], across)),
        target: middle,
        across: 1.1 * across,
    });
    stage::space(&mut solid, round.world(), stage::space_skin);
    if let Some(&Shape::Box { centre, half }) = round.basket() {
        solid.edges(centre, half, 2.0, Role::BasketRim);
    }
    let high = WIDTH * 5 / 8;
    let mut painter = Painter::new(WIDTH, high);
    painter.image([0.0; 2], solid.pixels(WIDTH, high)?);
    Ok(painter)
}

fn caption(round: &AnyRound, is_last: bool) -> String {
    let progress = round.progress();
    let seconds = round.frames().len() as f32 * TICK;
    match (progress.outcome, progress.pieces) {
        (Some(outcome), _) => format!("{} in {seconds:.1} s!", by_route(outcome.route)),
        (None, _) if is_last => format!("not won in {seconds:.1} s"),
        (None, 1) => format!("{seconds:.1} s"),
        (None, pieces) => format!("{seconds:.1} s, {pieces} pieces"),
    }
}
