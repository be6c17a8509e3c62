//! Clips of the best rounds of the last day.

use crate::figures::Figures;
use crate::options::Clip;
use crate::rerun::Rerun;
use tamaire_play::Replay;

/// Maximum size of a clip [bytes]. Larger clips are left out of the page.
const MOST_BYTES: usize = 6 << 20;

/// Clips of the best rounds.
#[derive(Debug, Default)]
pub struct Clips {
    /// Index into [`Figures::best`] and animated GIF of each clip.
    pub films: Vec<(usize, Vec<u8>)>,
    /// Reason for each missing clip, with the id of the round.
    pub missing: Vec<String>,
}

impl Clips {
    /// Makes a clip of the fastest win by each route on the last day. `replays` are the replays of
    /// [`Figures::best`]. `done` receives the number of clips made so far.
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

/// Makes a clip of a replay. Returns the reason if the replay diverges from its recorded hashes when run
/// again, or if no clip can be made.
fn film(fragment: &str, clip: Clip<'_>) -> Result<Vec<u8>, String> {
    if fragment.is_empty() {
        return Err("the round has no replay, or a very long one".into());
    }
    match Rerun::of(fragment) {
        Rerun::Ran(_) => {}
        Rerun::Astray(why) | Rerun::Unreadable(why) | Rerun::Foreign(why) => return Err(why),
    }
    let replay = Replay::of_fragment(fragment).map_err(|error| error.to_string())?;
    let gif = clip(&replay)?;
    match gif.len() {
        found if found > MOST_BYTES => Err(format!(
            "clip too large: expected at most {MOST_BYTES} bytes, found {found}"
        )),
        _ if !gif.starts_with(b"GIF8") => Err("the clip is no GIF".into()),
        _ => Ok(gif),
    }
}
