//! What hands did in a scene, tick by tick, so that it can be run again and compared.

use crate::scene::send;
use crate::scene::{BodyText, MAX_SECONDS, Scene, SceneError, shortened};
use fuwafuwa::{Dim, World};
use serde::{Deserialize, Serialize};

/// Number of the format; it changes when an older recording would run differently.
pub const VERSION: u32 = 1;
/// Most bytes of a recording that are read: some hours of two hands.
pub const MAX_BYTES: u64 = 1 << 26;
/// Most ticks of a recording: as long as a scene can be watched.
pub const MAX_TICKS: usize = (MAX_SECONDS * 60.0) as usize;

/// A scene, the goals of its hands at each tick, and the hashes they led to.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Recording {
    /// Number of the format.
    pub version: u32,
    /// Version of the engine.
    pub engine: String,
    /// The scene it was made in.
    pub scene: Scene,
    /// For each tick, the goal of each hand [m].
    pub goals: Vec<Vec<[f32; 3]>>,
    /// The world's hash after every sixtieth tick and after the last, in hexadecimal.
    pub hashes: Vec<String>,
}

/// Why a recording could not be read.
#[derive(Debug, thiserror::Error)]
pub enum RecordingError {
    /// The text is not that of a recording.
    #[error("{name}: {reason}")]
    Text {
        /// The file.
        name: String,
        /// The field, and what was expected.
        reason: String,
    },
    /// It was made by another version of this library.
    #[error("{name}: the recording has format {found}, this library reads format {VERSION}")]
    Version {
        /// The file.
        name: String,
        /// The format it has.
        found: u32,
    },
}

/// What came of running a recording again.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Comparison {
    /// Ticks that were run.
    pub ticks: usize,
    /// The first tick at which the hash was another, if it was.
    pub differs_at: Option<usize>,
}

impl Recording {
    /// The recording in a text; `name` names it in errors.
    ///
    /// # Errors
    /// [`RecordingError`] when it is none, or one of another format.
    pub fn read(name: &str, text: &str) -> Result<Self, RecordingError> {
        let name = name.to_string();
        let recording: Self = match toml::from_str(text) {
            Ok(recording) => recording,
            Err(error) => {
                // Without the line itself, in which the goals of hours may stand.
                let message = shortened(error.message(), 400);
                let reason = format!("this is no recording: {message}");
                return Err(RecordingError::Text { name, reason });
            }
        };
        if recording.version != VERSION {
            let found = recording.version;
            return Err(RecordingError::Version { name, found });
        }
        match recording.check() {
            Ok(()) => Ok(recording),
            Err(reason) => Err(RecordingError::Text { name, reason }),
        }
    }

    /// It as a text, if that can be opened again.
    ///
    /// # Errors
    /// What is too long in it.
    pub fn text(&self) -> Result<String, String> {
        self.check()?;
        let text = toml::to_string(self).map_err(|error| error.to_string())?;
        let found = text.len() as u64;
        let expected = format!("expected {MAX_BYTES} bytes at most, found {found}");
        (found <= MAX_BYTES).then_some(text).ok_or(expected)
    }

    fn check(&self) -> Result<(), String> {
        let ticks = self.goals.len();
        if ticks > MAX_TICKS {
            return Err(format!("expected {MAX_TICKS} ticks at most, found {ticks}"));
        }
        let mut bodies = self.scene.body.iter();
        if bodies.any(BodyText::lacks_content) {
            // Whose recording it is does not say which files are opened.
            return Err("expected the content of every body that has a file".into());
        }
        Ok(())
    }

    /// Records a scene with the goals of its own hands, for so many ticks. `watch` sees the world
    /// after each.
    ///
    /// # Errors
    /// [`SceneError`] when the scene cannot be built.
    pub fn of<D: Dim>(
        scene: &Scene,
        ticks: u64,
        mut watch: impl FnMut(&World<D>),
    ) -> Result<Self, SceneError> {
        let mut world = scene.build::<D>()?;
        let (mut goals, mut hashes) = (Vec::new(), Vec::new());
        for tick in 0..ticks {
            let wanted = scene.goals(tick);
            send(&mut world, &wanted);
            world.step();
            goals.push(wanted);
            if is_noted(tick as usize, ticks as usize) {
                hashes.push(format!("{:016x}", world.hash()));
            }
            watch(&world);
        }
        Ok(Self {
            version: VERSION,
            engine: env!("CARGO_PKG_VERSION").into(),
            scene: scene.clone(),
            goals,
            hashes,
        })
    }

    /// Runs it again and compares the hashes.
    ///
    /// # Errors
    /// [`SceneError`] when the scene in it cannot be built.
    pub fn replay<D: Dim>(
        &self,
        mut watch: impl FnMut(&World<D>),
    ) -> Result<Comparison, SceneError> {
        let mut world = self.scene.build::<D>()?;
        let mut hashes = self.hashes.iter();
        let mut differs_at = None;
        for (tick, goals) in self.goals.iter().enumerate() {
            send(&mut world, goals);
            world.step();
            watch(&world);
            if is_noted(tick, self.goals.len()) {
                let hash = format!("{:016x}", world.hash());
                if hashes.next() != Some(&hash) && differs_at.is_none() {
                    differs_at = Some(tick);
                }
            }
        }
        Ok(Comparison {
            ticks: self.goals.len(),
            differs_at,
        })
    }
}

fn is_noted(tick: usize, ticks: usize) -> bool {
    tick % 60 == 59 || tick + 1 == ticks
}

#[cfg(test)]
mod tests {
    use super::*;
    use fuwafuwa::Dim2;

    #[test]
    fn a_recording_runs_again_to_the_same_hashes_and_a_changed_one_does_not() {
        let scene = Scene::open("tear", &["body.n=16".into()]).unwrap();
        let recording = Recording::of::<Dim2>(&scene, 70, |_| {}).unwrap();
        assert_eq!(recording.hashes.len(), 2);
        let text = toml::to_string(&recording).unwrap();
        let mut read: Recording = toml::from_str(&text).unwrap();
        assert_eq!(read, recording);
        assert_eq!(read.replay::<Dim2>(|_| {}).unwrap().differs_at, None);
        read.goals[30][0][0] += 0.01;
        assert!(read.replay::<Dim2>(|_| {}).unwrap().differs_at.is_some());
    }

    #[test]
    fn a_recording_opens_no_files_of_its_reader() {
        let scene = Scene::open("drop", &["body.n=8".into()]).unwrap();
        let mut recording = Recording::of::<Dim2>(&scene, 1, |_| {}).unwrap();
        assert_eq!(recording.check(), Ok(()));
        recording.scene.body[0].file = Some("/etc/hosts.png".into());
        assert!(recording.check().unwrap_err().contains("content"));
        recording.scene.body[0].content = Some(String::new());
        assert_eq!(recording.check(), Ok(()));
    }

    #[test]
    fn a_recording_ends() {
        let scene = Scene::open("drop", &["body.n=8".into()]).unwrap();
        let mut recording = Recording::of::<Dim2>(&scene, 1, |_| {}).unwrap();
        recording.goals = vec![Vec::new(); MAX_TICKS + 1];
        for refusal in [recording.check(), recording.text().map(drop)] {
            assert!(refusal.unwrap_err().contains("ticks at most"));
        }
    }

    #[test]
    fn what_is_no_recording_is_refused_with_its_name() {
        let error = Recording::read("mine", "[package]").unwrap_err();
        assert!(error.to_string().starts_with("mine: "), "{error}");
    }
}
