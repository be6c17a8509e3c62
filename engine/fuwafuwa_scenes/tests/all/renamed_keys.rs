//! Scene files with keys that were renamed after version 0.2 give the same scenes as files with the new keys.

use fuwafuwa::Dim2;
use fuwafuwa_scenes::{Recording, Scene};

const OLD: &str = r#"
dim = 2
most_substeps = 32

[[body]]
shape = "box"
n = 6
at = [0.0, 1.0, 0.0]
turned = [0.0, 0.0, 0.4]

[[rigid]]
ball = { centre = [0.0, 0.0, 0.0], radius = 0.15 }
drive = "free"
mass = 3.0
at = [0.4, 2.4, 0.0]
turned = [0.0, 0.0, 0.5]
velocity = [0.0, -1.0, 0.0]
spin = [0.0, 0.0, 2.0]

[[rigid]]
ball = { centre = [0.0, 0.0, 0.0], radius = 0.1 }
drive = "hand"
limit = 50.0

[[hand]]
radius = 0.1
path = [[0.0, -0.5, 0.5, 0.0], [1.0, 1.2, 0.5, 0.0]]

[[joint]]
tie = "rope"
length = 2.0
ends = [{ body = 1, at = [0.5, 1.5, 0.0], radius = 0.1 }, { rigid = 1, at = [0.4, 2.4, 0.0] }]
"#;

const NEW: &str = r#"
dim = 2
max_substeps = 32

[[body]]
shape = "box"
n = 6
at = [0.0, 1.0, 0.0]
rotation_vector = [0.0, 0.0, 0.4]

[[rigid_body]]
ball = { centre = [0.0, 0.0, 0.0], radius = 0.15 }
motion_type = "dynamic"
mass = 3.0
at = [0.4, 2.4, 0.0]
rotation_vector = [0.0, 0.0, 0.5]
velocity = [0.0, -1.0, 0.0]
angular_velocity = [0.0, 0.0, 2.0]

[[rigid_body]]
ball = { centre = [0.0, 0.0, 0.0], radius = 0.1 }
motion_type = "coupled"
max_force = 50.0

[[hand]]
radius = 0.1
path = [[0.0, -0.5, 0.5, 0.0], [1.0, 1.2, 0.5, 0.0]]

[[joint]]
kind = "rope"
length = 2.0
anchors = [
    { body = 1, point = [0.5, 1.5, 0.0], radius = 0.1 },
    { rigid_body = 1, point = [0.4, 2.4, 0.0] },
]
"#;

#[test]
fn read_accepts_old_keys_of_scene() {
    let [old, new] = [OLD, NEW].map(|text| Scene::read("toy", text, &[]).unwrap());
    assert_eq!(old, new);
    let [old, new] = [old, new].map(|scene| scene.build::<Dim2>().unwrap().hash());
    assert_eq!(old, new);
}

#[test]
fn read_accepts_old_keys_of_recording() {
    let scene = Scene::read("toy", NEW, &[]).unwrap();
    let recording = Recording::of::<Dim2>(&scene, 2, |_| {}).unwrap();
    let text = recording.text().unwrap();
    assert!(text.contains("targets = "), "{text}");
    let old = text.replacen("targets = ", "goals = ", 1);
    assert_eq!(Recording::read("old", &old).unwrap(), recording);
}
