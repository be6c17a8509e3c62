//! The game for learning programs: many rounds of a level, stepped on several threads.

mod episode;
pub mod network;
mod observation;
mod reward;

use crate::convert::{Any, name_of, named, rows};
use crate::error::{OrInvalid, file_error, invalid, invalid_parameter};
use crate::file::File;
use crate::picture::{Paint, rgb};
use episode::{Episode, Settings, Step};
use fuwafuwa::DimVector;
use fuwafuwa_painter::{PaintError, Pixmap};
use fuwafuwa_scenes::disk::reader_in;
use numpy::ndarray::ArrayView2;
use numpy::{IntoPyArray, PyArray1, PyArray2, PyArray3, PyReadonlyArray2};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};
use reward::REWARDS;
use std::path::Path;
use std::sync::{Arc, Mutex};
use std::thread;
use tamaire_play::level::built_in;
use tamaire_play::replay::MAX_BYTES;
use tamaire_play::{AnyRound, Level, PLAYERS, Playback, Replay, Round, Route};

/// Names of the routes of a win.
const ROUTES: [(&str, Route); 3] = [
    ("squeeze", Route::Squeeze),
    ("shave", Route::Shave),
    ("mix", Route::Mix),
];
/// Maximum number of rounds.
const MAX_ROUNDS: i64 = 4096;
/// Maximum number of threads.
const MAX_THREADS: i64 = 256;
/// Maximum number of ticks in a step: one second.
const MAX_TICKS: i64 = 60;

/// Rounds of a level of the game tamaire. `fuwafuwa.envs` makes them environments.
#[pyclass(name = "_Rounds", module = "fuwafuwa._core")]
#[derive(Clone)]
pub struct Rounds {
    settings: Arc<Settings>,
    episodes: Vec<Episode>,
    threads: usize,
}

/// Opens a built-in level by its name, or reads a level from a file.
fn level_of(source: &str) -> PyResult<Level> {
    if built_in().any(|(known, _)| known == source) {
        return Level::open(source).or_invalid();
    }
    let path = Path::new(source);
    if !path.is_file() {
        let known: Vec<&str> = built_in().map(|(known, _)| known).collect();
        let expected = format!("a file or one of {}", known.join(", "));
        return Err(invalid_parameter("level", expected, format!("{source:?}")));
    }
    let bytes = std::fs::read(path).map_err(|error| file_error(path, &error))?;
    let folder = path.parent().unwrap_or(Path::new("."));
    Level::read(source, &bytes, &reader_in(folder)).or_invalid()
}

/// Paints the room of a round.
fn picture(round: &AnyRound, width: u32) -> Result<Pixmap, PaintError> {
    fn paint<D: Paint>(round: &Round<D>, width: u32) -> Result<Pixmap, PaintError> {
        let view = round.level().arena().map(D::Vector::from_vec3);
        D::paint(round.world(), view, width, false)
    }
    match round {
        AnyRound::Plane(round) => paint(round, width),
        AnyRound::Space(round) => paint(round, width),
    }
}

fn number_in<T: PartialOrd + std::fmt::Debug>(
    field: &str,
    number: T,
    low: T,
    high: T,
) -> PyResult<T> {
    // The comparison is false for NaN.
    match low <= number && number <= high {
        true => Ok(number),
        false => {
            let expected = format!("a number from {low:?} to {high:?}");
            Err(invalid_parameter(field, expected, format!("{number:?}")))
        }
    }
}

impl Rounds {
    /// Calls `act` for each episode with its index, on several threads.
    fn for_each<T: Send>(
        &mut self,
        py: Python<'_>,
        act: impl Fn(usize, &mut Episode) -> T + Sync,
    ) -> Vec<T> {
        let threads = self.threads.min(self.episodes.len());
        let episodes = &mut self.episodes;
        py.detach(|| {
            if threads <= 1 {
                let all = episodes.iter_mut().enumerate();
                return all.map(|(index, episode)| act(index, episode)).collect();
            }
            // Each thread takes the next episode, because steps of torn bodies take longer than others.
            let queue = Mutex::new(episodes.iter_mut().enumerate());
            let work = || {
                let mut done = Vec::new();
                loop {
                    let next = queue
                        .lock()
                        .expect("no thread panics while it holds the queue")
                        .next();
                    let Some((index, episode)) = next else {
                        return done;
                    };
                    done.push((index, act(index, episode)));
                }
            };
            let mut done = thread::scope(|scope| {
                let others: Vec<_> = (1..threads).map(|_| scope.spawn(work)).collect();
                let mut done = work();
                for other in others {
                    done.extend(other.join().expect("steps of rounds do not panic"));
                }
                done
            });
            done.sort_unstable_by_key(|(index, _)| *index);
            done.into_iter().map(|(_, result)| result).collect()
        })
    }

    fn episode(&self, index: usize) -> PyResult<&Episode> {
        let count = self.episodes.len();
        self.episodes.get(index).ok_or_else(|| {
            invalid_parameter("index", format!("less than {count}"), index.to_string())
        })
    }

    /// Returns an array with the observation of each episode in a row.
    fn observed<'py>(
        &self,
        py: Python<'py>,
        observations: impl IntoIterator<Item = Vec<f32>>,
    ) -> Bound<'py, PyArray2<f32>> {
        let values: Vec<f32> = observations.into_iter().flatten().collect();
        rows(py, values.len() / self.episodes.len(), values)
    }

    /// Checks that a list has a value for each round.
    fn check_count(&self, field: &str, found: usize) -> PyResult<()> {
        let count = self.episodes.len();
        match found == count {
            true => Ok(()),
            false => Err(invalid_parameter(
                field,
                format!("{count} values"),
                found.to_string(),
            )),
        }
    }

    /// Returns the actions of each episode, the velocities of one hand after the other.
    fn actions<'a>(&self, actions: &'a PyReadonlyArray2<'_, f32>) -> PyResult<ArrayView2<'a, f32>> {
        let view = actions.as_array();
        let expected = [self.episodes.len(), self.settings.action_size()];
        if view.shape() != expected {
            let expected = format!("an array of shape {expected:?}");
            return Err(invalid_parameter(
                "actions",
                expected,
                format!("shape {:?}", view.shape()),
            ));
        }
        if let Some(wrong) = view.iter().find(|number| !number.is_finite()) {
            return Err(invalid_parameter(
                "actions",
                "finite numbers",
                wrong.to_string(),
            ));
        }
        Ok(view)
    }
}

#[pymethods]
impl Rounds {
    #[new]
    #[pyo3(signature = (
        level, num_envs=1, *, reward="shaped", ticks_per_step=4, max_speed=2.0, max_steps=300, max_pieces=0, hands=1,
        random_start=true, threads=1
    ))]
    #[allow(clippy::too_many_arguments)] // all but two are keywords with defaults
    fn new(
        py: Python<'_>,
        level: &str,
        num_envs: i64,
        reward: &str,
        ticks_per_step: i64,
        max_speed: f32,
        max_steps: i64,
        max_pieces: i64,
        hands: i64,
        random_start: bool,
        threads: i64,
    ) -> PyResult<Self> {
        let count = number_in("num_envs", num_envs, 1, MAX_ROUNDS)? as usize;
        let threads = number_in("threads", threads, 1, MAX_THREADS)? as usize;
        let (reward, level) = (named("reward", reward, &REWARDS)?, level_of(level)?);
        if level.game().all_baskets().is_empty() {
            let given = format!("{:?}", level.id);
            return Err(invalid_parameter("level", "a level with a basket", given));
        }
        let leaders = level
            .scene()
            .hand
            .iter()
            .filter(|hand| hand.follows.is_none());
        let most_hands = PLAYERS.min(leaders.count()) as i64;
        let limit = i64::from(i32::MAX);
        let settings = Settings {
            level: Arc::new(level),
            reward,
            ticks: number_in("ticks_per_step", ticks_per_step, 1, MAX_TICKS)? as u32,
            max_speed: number_in("max_speed", max_speed, 0.01, tamaire_play::round::TOP_SPEED)?,
            max_steps: number_in("max_steps", max_steps, 0, limit)? as u32,
            max_pieces: number_in("max_pieces", max_pieces, 0, limit)? as usize,
            players: number_in("hands", hands, 1, most_hands)? as usize,
            random_start,
        };
        let settings = Arc::new(settings);
        let first = py.detach(|| Episode::new(settings.clone()));
        let episodes = (0..count)
            .map(|_| first.with_own_random_numbers())
            .collect();
        Ok(Self {
            settings,
            episodes,
            threads,
        })
    }

    /// Starts new rounds where `chosen` is true. A seed of None continues the random numbers of the round.
    fn reset<'py>(
        &mut self,
        py: Python<'py>,
        seeds: Vec<Option<u64>>,
        chosen: Vec<bool>,
    ) -> PyResult<Bound<'py, PyArray2<f32>>> {
        self.check_count("seeds", seeds.len())?;
        self.check_count("chosen", chosen.len())?;
        let observations = self.for_each(py, |index, episode| {
            if chosen[index] {
                episode.reset(seeds[index]);
            }
            episode.observe()
        });
        Ok(self.observed(py, observations))
    }

    /// Steps all rounds: actions (count, hands * d) from -1 to 1. Rounds for which `restart` is true start again
    /// instead. Returns observations (count, numbers), rewards, terminated and truncated (count,).
    #[pyo3(signature = (actions, restart=None))]
    fn step<'py>(
        &mut self,
        py: Python<'py>,
        actions: PyReadonlyArray2<'py, f32>,
        restart: Option<Vec<bool>>,
    ) -> PyResult<Bound<'py, PyTuple>> {
        if self.episodes.iter().any(|episode| !episode.has_begun()) {
            return Err(invalid("reset() must be called before step()"));
        }
        // Copied, because other threads of Python may write into the array while this one releases the GIL.
        let actions = self.actions(&actions)?.to_owned();
        let restart = restart.unwrap_or_else(|| vec![false; self.episodes.len()]);
        self.check_count("restart", restart.len())?;
        let results = self.for_each(py, |index, episode| {
            let step = match restart[index] {
                true => {
                    episode.reset(None);
                    Step::default()
                }
                false => episode.step(&actions.row(index).to_vec()),
            };
            (step, episode.observe())
        });
        let (steps, observations): (Vec<Step>, Vec<_>) = results.into_iter().unzip();
        let rewards = PyArray1::from_iter(py, steps.iter().map(|step| step.reward));
        let flags = |is_set: fn(&Step) -> bool| PyArray1::from_iter(py, steps.iter().map(is_set));
        let [terminated, truncated] = [flags(|step| step.terminated), flags(|step| step.truncated)];
        (
            self.observed(py, observations),
            rewards,
            terminated,
            truncated,
        )
            .into_pyobject(py)
    }

    /// Returns the observations (count, numbers).
    fn observe<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray2<f32>> {
        self.observed(py, self.episodes.iter().map(Episode::observe))
    }

    /// Names of the numbers of an observation.
    #[getter]
    fn observation_names(&self) -> Vec<String> {
        self.settings.observation_names()
    }

    /// Number of numbers in an action: d for each hand.
    #[getter]
    fn action_size(&self) -> usize {
        self.settings.action_size()
    }

    /// Number of dimensions: 2 or 3.
    #[getter]
    fn dim(&self) -> usize {
        self.settings.dim()
    }

    fn __copy__(&self) -> Self {
        self.clone()
    }

    fn __deepcopy__(&self, _memo: &Any<'_>) -> Self {
        self.clone()
    }

    /// Returns the progress of a round as a dict.
    fn progress<'py>(&self, py: Python<'py>, index: usize) -> PyResult<Bound<'py, PyDict>> {
        let round = self.episode(index)?.round();
        let progress = round.progress();
        let dict = PyDict::new(py);
        dict.set_item("within", progress.within)?;
        dict.set_item("inside", progress.inside)?;
        dict.set_item("kept", progress.kept)?;
        dict.set_item("pieces", progress.pieces)?;
        dict.set_item("held", progress.held)?;
        dict.set_item("seconds", round.seconds())?;
        dict.set_item("ticks", round.ticks())?;
        dict.set_item("is_success", progress.outcome.is_some())?;
        let route = progress
            .outcome
            .map(|outcome| name_of(outcome.route, &ROUTES));
        dict.set_item("route", route)?;
        Ok(dict)
    }

    /// Returns a picture of the room of a round: uint8 array (height, width, 3).
    fn rgb<'py>(
        &self,
        py: Python<'py>,
        index: usize,
        width: u32,
    ) -> PyResult<Bound<'py, PyArray3<u8>>> {
        number_in("width", width, 16, 4096)?;
        let episode = self.episode(index)?;
        let image = py.detach(|| picture(episode.round(), width)).or_invalid()?;
        Ok(rgb(&image).into_pyarray(py))
    }

    /// Returns the hash of the world of a round.
    fn hash(&self, index: usize) -> PyResult<u64> {
        Ok(self.episode(index)?.round().hash())
    }

    /// Returns a round as the text of a replay file.
    fn replay(&self, index: usize) -> PyResult<String> {
        self.episode(index)?
            .round()
            .replay()
            .text_to_keep()
            .or_invalid()
    }
}

/// Returns the names of the built-in levels with a basket.
#[pyfunction(name = "_level_names")]
pub fn level_names() -> Vec<&'static str> {
    let has_basket = |name: &&str| {
        let level = Level::open(name).expect("tests open all built-in levels");
        !level.game().all_baskets().is_empty()
    };
    built_in()
        .map(|(name, _)| name)
        .filter(has_basket)
        .collect()
}

/// Plays a replay: a path or the bytes of the file. Returns the outcome as a dict, or None for a round that was not
/// won. Raises `Error` where the round differs from the recording.
#[pyfunction(name = "_verify_replay")]
pub fn verify_replay<'py>(
    py: Python<'py>,
    replay: &Any<'py>,
) -> PyResult<Option<Bound<'py, PyDict>>> {
    let file = File::read(replay, MAX_BYTES as u64)?;
    let named =
        |error: tamaire_play::ReplayError| crate::error::invalid(format!("{}: {error}", file.name));
    let replay = Replay::of_bytes(&file.bytes).map_err(named)?;
    let outcome = replay.outcome;
    py.detach(|| {
        let mut playback = Playback::new(Arc::new(replay))?;
        while !playback.is_over() {
            playback.step()?;
        }
        Ok(())
    })
    .map_err(named)?;
    let dict = |outcome: tamaire_play::Outcome| {
        let dict = PyDict::new(py);
        dict.set_item("seconds", outcome.seconds())?;
        dict.set_item("route", name_of(outcome.route, &ROUTES))?;
        dict.set_item("kept", outcome.kept)?;
        dict.set_item("inside", outcome.inside)?;
        dict.set_item("pieces", outcome.pieces)?;
        dict.set_item("lost", outcome.lost)?;
        Ok(dict)
    };
    outcome.map(dict).transpose()
}
