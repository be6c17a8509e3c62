//! Recordings: a scene with the targets of its hands at each tick, so that a run can be repeated and
//! compared.

use crate::scene::{
    BodyText, MAX_SECONDS, Machinery, Scene, SceneError, set_hand_targets, shortened,
};
use fuwafuwa::{Dim, World};
use serde::{Deserialize, Serialize};

/// Version of the recording format. It increases when an older recording would run differently or has other
/// hashes.
pub const VERSION: u32 = 3;
/// Maximum size of a recording [bytes], enough for some hours with two hands.
pub const MAX_BYTES: u64 = 1 << 26;
/// Maximum number of ticks in a recording: those of the longest viewing time of a scene, at 60 ticks a
/// second.
pub const MAX_TICKS: usize = (MAX_SECONDS * 60.0) as usize;

/// A scene, the targets of its hands at each tick, and the resulting hashes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Recording {
    /// Version of the format.
    pub version: u32,
    /// Version of this crate that made the recording.
    pub engine: String,
    /// Scene that was recorded.
    pub scene: Scene,
    /// Target of each hand at each tick [m].
    #[serde(alias = "goals")]
    pub targets: Vec<Vec<[f32; 3]>>,
    /// Hash of the world after every 60th tick and after the last, in hexadecimal.
    pub hashes: Vec<String>,
}

/// Reason why a recording could not be read.
#[derive(Debug, thiserror::Error)]
pub enum RecordingError {
    /// The text is not a valid recording.
    #[error("{name}: {reason}")]
    Text {
        /// Name of the file.
        name: String,
        /// Field with the problem, and what was expected there.
        reason: String,
    },
    /// The recording has another version of the format.
    #[error("{name}: the recording has format {found}, this library reads format {VERSION}")]
    Version {
        /// Name of the file.
        name: String,
        /// Version of the recording's format.
        found: u32,
    },
}

/// Result of a replay.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Comparison {
    /// Number of ticks that were run.
    pub ticks: usize,
    /// First tick with a recorded hash at which the hash of the replay differs, if any.
    pub differs_at: Option<usize>,
}

impl Recording {
    /// Parses a recording; `name` names it in errors.
    ///
    /// # Errors
    /// [`RecordingError`] if the text is not a recording, or has another version of the format.
    pub fn read(name: &str, text: &str) -> Result<Self, RecordingError> {
        let name = name.to_string();
        let recording: Self = match toml::from_str(text) {
            Ok(recording) => recording,
            Err(error) => {
                // Leaves the quoted line of the file out of the error, because this line may contain hours of
                // hand targets.
                let message = shortened(error.message(), 400);
                let reason = format!("not a valid recording: {message}");
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

    /// Returns the recording as text that [`Recording::read`] accepts.
    ///
    /// # Errors
    /// Names the limit that the recording exceeds, or reports a body file without content.
    pub fn text(&self) -> Result<String, String> {
        self.check()?;
        let text = toml::to_string(self).map_err(|error| error.to_string())?;
        let found = text.len() as u64;
        let expected = format!("expected {MAX_BYTES} bytes at most, found {found}");
        (found <= MAX_BYTES).then_some(text).ok_or(expected)
    }

    fn check(&self) -> Result<(), String> {
        let ticks = self.targets.len();
        if ticks > MAX_TICKS {
            return Err(format!("expected {MAX_TICKS} ticks at most, found {ticks}"));
        }
        let mut bodies = self.scene.body.iter();
        if bodies.any(BodyText::lacks_content) {
            // Rejects bodies whose file is only named: a recording from an unknown author must not decide
            // which local files are opened.
            return Err("expected the content of every body that has a file".into());
        }
        Ok(())
    }

    /// Records a scene with the targets of its own hands for `ticks` ticks. `watch` is called with the world
    /// after each tick.
    ///
    /// # Errors
    /// [`SceneError`] if the scene cannot be built.
    pub fn of<D: Dim>(
        scene: &Scene,
        ticks: u64,
        mut watch: impl FnMut(&World<D>),
    ) -> Result<Self, SceneError> {
        let mut world = scene.build::<D>()?;
        let mut machinery = Machinery::new(scene, &world);
        let (mut targets, mut hashes) = (Vec::new(), Vec::new());
        for tick in 0..ticks {
            let now = scene.hand_targets(tick);
            set_hand_targets(&mut world, &now);
            machinery.step(&mut world);
            targets.push(now);
            if is_noted(tick as usize, ticks as usize) {
                hashes.push(format!("{:016x}", world.hash()));
            }
            watch(&world);
        }
        Ok(Self {
            version: VERSION,
            engine: env!("CARGO_PKG_VERSION").into(),
            scene: scene.clone(),
            targets,
            hashes,
        })
    }

    /// Runs the recording again and compares the hashes. `watch` is called with the world after each tick.
    ///
    /// # Errors
    /// [`SceneError`] if the scene cannot be built.
    pub fn replay<D: Dim>(
        &self,
        mut watch: impl FnMut(&World<D>),
    ) -> Result<Comparison, SceneError> {
        let mut world = self.scene.build::<D>()?;
        let mut machinery = Machinery::new(&self.scene, &world);
        let mut hashes = self.hashes.iter();
        let mut differs_at = None;
        for (tick, targets) in self.targets.iter().enumerate() {
            set_hand_targets(&mut world, targets);
            machinery.step(&mut world);
            watch(&world);
            if is_noted(tick, self.targets.len()) {
                let hash = format!("{:016x}", world.hash());
                if hashes.next() != Some(&hash) && differs_at.is_none() {
                    differs_at = Some(tick);
                }
            }
        }
        Ok(Comparison {
            ticks: self.targets.len(),
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
    fn replay_reproduces_hashes_unless_targets_change() {
        let scene = Scene::open("tear", &["body.n=16".into()]).unwrap();
        let recording = Recording::of::<Dim2>(&scene, 70, |_| {}).unwrap();
        assert_eq!(recording.hashes.len(), 2);
        let text = toml::to_string(&recording).unwrap();
        let mut read: Recording = toml::from_str(&text).unwrap();
        assert_eq!(read, recording);
        assert_eq!(read.replay::<Dim2>(|_| {}).unwrap().differs_at, None);
        read.targets[30][0][0] += 0.01;
        assert!(read.replay::<Dim2>(|_| {}).unwrap().differs_at.is_some());
    }

    #[test]
    fn read_refuses_older_format_by_its_number() {
        let scene = Scene::open("drop", &["body.n=8".into()]).unwrap();
        let recording = Recording::of::<Dim2>(&scene, 1, |_| {}).unwrap();
        let text = recording.text().unwrap();
        assert_eq!(Recording::read("mine", &text).unwrap(), recording);
        let older = text.replacen("version = 3", "version = 1", 1);
        let error = Recording::read("mine", &older).unwrap_err().to_string();
        let expected = "mine: the recording has format 1, this library reads format 3";
        assert_eq!(error, expected);
    }

    #[test]
    fn check_rejects_body_file_without_content() {
        let scene = Scene::open("drop", &["body.n=8".into()]).unwrap();
        let mut recording = Recording::of::<Dim2>(&scene, 1, |_| {}).unwrap();
        assert_eq!(recording.check(), Ok(()));
        recording.scene.body[0].file = Some("/etc/hosts.png".into());
        assert!(recording.check().unwrap_err().contains("content"));
        recording.scene.body[0].content = Some(String::new());
        assert_eq!(recording.check(), Ok(()));
    }

    #[test]
    fn check_rejects_more_than_max_ticks() {
        let scene = Scene::open("drop", &["body.n=8".into()]).unwrap();
        let mut recording = Recording::of::<Dim2>(&scene, 1, |_| {}).unwrap();
        recording.targets = vec![Vec::new(); MAX_TICKS + 1];
        for refusal in [recording.check(), recording.text().map(drop)] {
            assert!(refusal.unwrap_err().contains("ticks at most"));
        }
    }

    #[test]
    fn read_error_names_file_for_foreign_text() {
        let error = Recording::read("mine", "[package]").unwrap_err();
        assert!(error.to_string().starts_with("mine: "), "{error}");
    }
}
