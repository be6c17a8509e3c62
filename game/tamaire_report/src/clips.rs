//! The best rounds of the last day as films.

use crate::figures::Figures;
use crate::options::Clip;
use crate::rerun::Rerun;
use tamaire_play::Replay;

/// A film that is larger does not come into the page [bytes].
const MOST_BYTES: usize = 6 << 20;

/// Films of best rounds.
#[derive(Debug, Default)]
pub struct Clips {
    /// The place of each in [`Figures::best`], and an animated GIF.
    pub films: Vec<(usize, Vec<u8>)>,
    /// Why there is none of another.
    pub missing: Vec<String>,
}

impl Clips {
    /// Those of the last day, one for each route. `replays` are those of [`Figures::best`].
    pub fn of(
        figures: &Figures,
        replays: &[String],
        clip: Clip<'_>,
        mut done: impl FnMut(u64),
    ) -> Self {
        let mut clips = Self::default();
        let last = figures.best.last().map(|best| best.day);
        let best = figures.best.iter().enumerate();
        for (k, best) in best.filter(|(_, best)| Some(best.day) == last) {
            match film(&replays[k], clip) {
                Ok(gif) => clips.films.push((k, gif)),
                Err(why) => clips.missing.push(format!("{}: {why}", best.round)),
            }
            done(clips.films.len() as u64);
        }
        clips
    }
}

/// Films what comes out as it was written, and nothing else.
fn film(fragment: &str, clip: Clip<'_>) -> Result<Vec<u8>, String> {
    if fragment.is_empty() {
        return Err("it has no replay, or a very long one".into());
    }
    match Rerun::of(fragment) {
        Rerun::Ran(_) => {}
        Rerun::Astray(why) | Rerun::Unreadable(why) | Rerun::Foreign(why) => return Err(why),
    }
    let replay = Replay::of_fragment(fragment).map_err(|error| error.to_string())?;
    let gif = clip(&replay)?;
    match gif.len() {
        found if found > MOST_BYTES => Err(format!(
            "expected {MOST_BYTES} bytes at most, found {found}"
        )),
        _ if !gif.starts_with(b"GIF8") => Err("this is no GIF".into()),
        _ => Ok(gif),
    }
}
