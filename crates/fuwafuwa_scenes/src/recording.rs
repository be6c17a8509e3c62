//! What hands did in a scene, tick by tick, so that it can be run again and compared.

use crate::scene::Scene;
use fuwafuwa::{Dim, World};
use serde::{Deserialize, Serialize};

/// Number of the format; it changes when an older recording would run differently.
pub const VERSION: u32 = 1;

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

/// What came of running a recording again.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Comparison {
    /// Ticks that were run.
    pub ticks: usize,
    /// The first tick at which the hash was another, if it was.
    pub differs_at: Option<usize>,
}

impl Recording {
    /// Records a scene with the goals of its own hands, for so many ticks. `watch` sees the world
    /// after each.
    ///
    /// # Errors
    /// [`crate::SceneError`] when the scene cannot be built.
    pub fn of<D: Dim>(
        scene: &Scene,
        ticks: u64,
        mut watch: impl FnMut(&World<D>),
    ) -> Result<Self, crate::SceneError> {
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
    /// [`crate::SceneError`] when the scene in it cannot be built.
    pub fn replay<D: Dim>(
        &self,
        mut watch: impl FnMut(&World<D>),
    ) -> Result<Comparison, crate::SceneError> {
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

fn send<D: Dim>(world: &mut World<D>, goals: &[[f32; 3]]) {
    let hands = world.manipulators().len();
    for (hand, &goal) in goals.iter().enumerate().take(hands) {
        world.set_goal(hand, goal);
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
}
