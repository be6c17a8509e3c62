//! Shapes and materials of bodies in scenes.

use crate::picture::png_of;
use fuwafuwa::{
    Dim, Dim2, Dim3, Material, PronyTerm, SoftBody, StrengthCriterion, StressLaw, Vec2, library,
};
use fuwafuwa_scenes::disk::open_scene;
use fuwafuwa_scenes::scene::MaterialText;
use fuwafuwa_scenes::{Recording, Scene, SceneError};
use std::path::PathBuf;

fn bodies<D: Dim>(text: &str) -> Vec<SoftBody<D>> {
    let scene = Scene::read("toy.toml", text, &[]).unwrap();
    let world = scene.build::<D>();
    let world = world.unwrap_or_else(|error| panic!("{error}"));
    world.soft_bodies().map(|(_, body)| body.clone()).collect()
}

/// Returns the materials of a flat body, or of the middle layer of a 3D body; the highest row first.
fn picture<D: Dim>(body: &SoftBody<D>) -> Vec<String> {
    let grid = body.grid();
    let [width, height, depth] = grid.size();
    let sign = |at| char::from(b".12345"[usize::from(grid.material(at))]);
    let row = |y| (0..width).map(|x| sign([x, y, depth / 2])).collect();
    (0..height).rev().map(row).collect()
}

const TWO: &str = "
[[material]]
young = 1000.0
friction = 0.1

[[material]]
young = 2000.0
friction = 0.2

[[material]]
young = 3000.0
friction = 0.3
";

#[test]
fn parts_apply_in_order() {
    let text = "
[[body]]
shape = \"empty\"
n = 5
width = 5.0
proportions = [1.4, 1.0, 1.0]
part = [
    { fill = 1, box = { centre = [3.5, 2.0, 0.0], half = [2.5, 2.0, 0.0] } },
    { paint = 2, half_space = { normal = [-1, 0, 0], point = [4.0, 0.0, 0.0] } },
    { fill = 3, ball = { centre = [0.5, 4.5, 0.0], radius = 0.1 } },
    { fill = 0, capsule = { from = [2.5, 1.5, 0.0], to = [4.5, 1.5, 0.0], radius = 0.2 } },
]
";
    let bodies = bodies::<Dim2>(&format!("dim = 2\n{TWO}{text}"));
    let expected = ["3......", ".11122.", ".11122.", ".1...2.", ".11122."];
    assert_eq!(picture(&bodies[0]), expected);
    assert_eq!(bodies[0].piece_views().len(), 2);
    assert_eq!(bodies[0].grid().voxel_size(), 1.0);
}

#[test]
fn part_paints_core_of_3d_ball() {
    let text = "
[[body]]
shape = \"ball\"
n = 7
width = 7.0
[[body.part]]
paint = 2
ball = { centre = [3.5, 3.5, 3.5], radius = 1.2 }
";
    let bodies = bodies::<Dim3>(&format!("dim = 3\n{TWO}{text}"));
    let expected = [
        ".......", ".11111.", ".11211.", ".12221.", ".11211.", ".11111.", ".......",
    ];
    assert_eq!(picture(&bodies[0]), expected);
}

#[test]
fn shapes_build_in_2d_and_3d() {
    for form in ["ball", "box", "ring", "heart", "flower"] {
        let body = format!("[[body]]\nshape = \"{form}\"\nn = 16\n");
        let flat = bodies::<Dim2>(&format!("dim = 2\n{body}"));
        let solid = bodies::<Dim3>(&format!("dim = 3\n{body}"));
        assert!(flat[0].grid().solid_count() > 60, "{form}");
        assert!(solid[0].grid().solid_count() > 300, "{form}");
    }
}

#[test]
fn crack_stops_at_unbreakable_core() {
    // The body is coarser than in the named scene and its material around the core is weaker, so that the
    // body tears soon.
    let changes = [
        "body.n=32",
        "material.1.strength=200",
        "material.1.toughness=30",
    ];
    let scene = Scene::open("core", &changes.map(String::from)).unwrap();
    let mut world = scene.build::<Dim2>().unwrap();
    let mut released = 0;
    for tick in 0..80 {
        scene.set_hand_targets(&mut world, tick);
        released += world.step().nodes_split;
    }
    assert!(released > 50, "{released}");
    let views = world.soft_bodies().next().unwrap().1.element_views();
    let mut of_core: Vec<_> = views
        .filter(|view| view.material == 2)
        .map(|view| view.piece)
        .collect();
    of_core.sort_unstable();
    of_core.dedup();
    assert_eq!(of_core.len(), 1, "the core must stay in one piece");
}

#[test]
fn hand_follows_path_with_each_shape() {
    let shapes = [
        ("radius = 0.1", 0.1),
        ("box = { centre = [0, 0, 0], half = [0.4, 0.2, 0] }", 0.2),
        (
            "capsule = { from = [-1, 0, 0], to = [1, 0, 0], radius = 0.3 }",
            0.3,
        ),
    ];
    for (text, thick) in shapes {
        let text = format!("dim = 2\n[[hand]]\n{text}\npath = [[0, 0, 2, 0], [1, 0, 1, 0]]\n");
        let scene = Scene::read("toy.toml", &text, &[]).unwrap();
        let mut world = scene.build::<Dim2>().unwrap();
        (0..120).for_each(|tick| {
            scene.set_hand_targets(&mut world, tick);
            world.step();
        });
        let hand = world.nth_target_follower(0).unwrap();
        let hand = world.rigid_body(hand).unwrap();
        assert_eq!(hand.shape().inradius(), thick);
        let (distance, _) = hand.shape().distance(Vec2::new(0.0, 2.0));
        assert!((distance + thick - 1.0).abs() < 0.01, "{text}: {distance}");
    }
}

/// Creates a folder for a test, with a scene in it.
fn folder(name: &str, scene: &str) -> PathBuf {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name);
    std::fs::create_dir_all(&folder).unwrap();
    std::fs::write(folder.join("scene.toml"), scene).unwrap();
    folder
}

fn open(folder: &std::path::Path) -> Result<Scene, SceneError> {
    open_scene(folder.join("scene.toml").to_str().unwrap(), &[])
}

/// Encodes a picture of red (`r`), blue (`b`) and transparent pixels (anything else).
fn painting(rows: &[&str]) -> Vec<u8> {
    let colour = |sign| match sign {
        b'r' => [230, 20, 20, 255],
        b'b' => [20, 20, 250, 255],
        _ => [0; 4],
    };
    let samples: Vec<u8> = rows
        .iter()
        .flat_map(|row| row.bytes())
        .flat_map(colour)
        .collect();
    png_of(rows[0].len() as u32, rows.len() as u32, &samples)
}

#[test]
fn picture_in_scene_folder_becomes_body() {
    let scene = format!(
        "dim = 2\n{TWO}
[[body]]
file = \"painting.png\"
width = 2.0
colours = {{ \"#ff0000\" = 2, \"#0000FF\" = 1 }}
[[body]]
file = \"painting.png\"
n = 2
material = 3
at = [0.0, 3.0, 0.0]
"
    );
    let folder = folder("picture", &scene);
    std::fs::write(folder.join("painting.png"), painting(&["rb. ", "rrrr"])).unwrap();
    let scene = open(&folder).unwrap();
    let world = scene.build::<Dim2>().unwrap();
    let [first, second] = [0, 1].map(|n| &world[world.nth_soft_body(n).unwrap()]);
    assert_eq!(picture(first), ["21..", "2222"]);
    assert_eq!(first.grid().voxel_size(), 0.5);
    assert_eq!(picture(second), ["33"]);

    // The scene can be recorded, and the text of the recording can be replayed.
    let recording = Recording::of::<Dim2>(&scene, 3, |_| {}).unwrap();
    let read: Recording = toml::from_str(&toml::to_string(&recording).unwrap()).unwrap();
    assert_eq!(read, recording);
    assert_eq!(read.replay::<Dim2>(|_| {}).unwrap().differs_at, None);

    std::fs::write(folder.join("painting.png"), b"\x89PNG no more").unwrap();
    let error = open(&folder).unwrap_err().to_string();
    assert!(
        error.contains("scene.toml, line 16: body 1, file: "),
        "{error}"
    );
    assert!(
        error.contains("painting.png, byte 0: expected a PNG"),
        "{error}"
    );
}

/// A model of two voxels, one above the other, with palette indices 79 and 80.
const MODEL: &[u8] = b"VOX \x96\0\0\0MAIN\0\0\0\0\x30\0\0\0SIZE\x0c\0\0\0\0\0\0\0\
    \x01\0\0\0\x01\0\0\0\x02\0\0\0XYZI\x0c\0\0\0\0\0\0\0\x02\0\0\0\0\0\0\x4f\0\0\x01\x50";

#[test]
fn model_in_scene_folder_becomes_body() {
    let with = |colours: &str| {
        let scene = format!("dim = 3\n{TWO}\n[[body]]\nfile = \"a.vox\"\n{colours}");
        let folder = folder("model", &scene);
        std::fs::write(folder.join("a.vox"), MODEL).unwrap();
        let world = open(&folder).unwrap().build::<Dim3>();
        world
            .map(|world| picture(world.soft_bodies().next().unwrap().1))
            .map_err(|error| error.to_string())
    };
    let expected = ["1", "3"].map(String::from).to_vec();
    assert_eq!(with("colours = { \"79\" = 3, \"80\" = 1 }"), Ok(expected));
    // Without a palette in the file, index 79 is #99ccff and index 80 is #99cccc.
    let expected = ["1", "3"].map(String::from).to_vec();
    let named = with("colours = { \"#90c8ff\" = 3, \"#90c8c8\" = 1 }");
    assert_eq!(named, Ok(expected));
    for (fields, expected) in [
        (
            "",
            ": body 1, material: voxels have material 80, but the scene has materials 1 to 3",
        ),
        (
            "colours = { \"79\" = 3 }",
            "expected a material for the palette index 80, found none",
        ),
        (
            "colours = { \"0\" = 3 }",
            "or a palette index from 1 to 255, found \"0\"",
        ),
        (
            "colours = { red = 3 }",
            "or a palette index from 1 to 255, found \"red\"",
        ),
        (
            "colours = { \"#ff00\" = 3 }",
            "or a palette index from 1 to 255, found \"#ff00\"",
        ),
        (
            "n = 8",
            "line 17: body 1, n: not allowed for a model, which has a fixed number of voxels; expected only width",
        ),
        (
            "material = 2",
            "line 17: body 1, material: the palette indices of a model are its materials, see colours",
        ),
    ] {
        let error = with(fields).unwrap_err();
        assert!(error.ends_with(expected), "{error}\nlacks: {expected}");
    }
}

#[test]
fn material_reads_and_writes_laws_of_stress_time_and_strength() {
    let text = "
dim = 2
[[material]]
poisson = 0.49
stress_law = { yeoh = [0.05, -0.001] }
prony = [[0.5, 0.2], [1.0, 10.0]]
[[material]]
stress_law = \"neo_hookean\"
hydrostatic_strength = 5000.0
rate_toughening = [0.01, 0.5]
[[body]]
shape = \"ball\"
n = 4
";
    let scene = Scene::read("toy.toml", text, &[]).unwrap();
    let [yeoh, neo_hookean] = scene.materials()[..] else {
        panic!("two materials")
    };
    let law = StressLaw::Yeoh {
        second: 0.05,
        third: -0.001,
    };
    assert_eq!(yeoh.stress_law, law);
    let terms = [PronyTerm::new(0.5, 0.2), PronyTerm::new(1.0, 10.0)];
    assert_eq!(yeoh.prony, terms);
    assert_eq!(neo_hookean.stress_law, StressLaw::NeoHookean);
    assert_eq!(neo_hookean.prony, [PronyTerm::NONE; 2]);
    let hydrostatic = 5000.0;
    assert_eq!(
        neo_hookean.strength_criterion,
        StrengthCriterion::DruckerPrager { hydrostatic }
    );
    assert_eq!(neo_hookean.rate_toughening.exponent, 0.5);
    let again = Scene::read("toy.toml", &scene.text().unwrap(), &[]).unwrap();
    assert_eq!(again.materials(), scene.materials());
}

#[test]
fn material_like_one_of_library_takes_its_values_except_given_ones() {
    let text = "
dim = 3
[[material]]
like = \"gelatine-10\"
density = 1020.0
[[body]]
shape = \"ball\"
n = 4
";
    let scene = Scene::read("toy.toml", text, &[]).unwrap();
    let [gelatine] = scene.materials()[..] else {
        panic!("one material")
    };
    let expected = Material {
        density: 1020.0,
        ..library::find("gelatine-10").unwrap().material()
    };
    assert_eq!(gelatine, expected);
    assert!((gelatine.fracture_energy() - 1.1).abs() < 1e-3);
}

/// Returns the only material of a scene, or the error of the scene.
fn material_of(fields: &str) -> Result<Material, String> {
    let text = format!("dim = 3\n[[material]]\n{fields}\n[[body]]\nshape = \"ball\"\nn = 4\n");
    let scene = Scene::read("toy.toml", &text, &[]).and_then(|scene| {
        scene.build::<fuwafuwa::Dim3>()?;
        Ok(scene)
    });
    scene
        .map(|scene| scene.materials()[0])
        .map_err(|error| error.to_string())
}

#[test]
fn own_strength_of_material_like_another_uses_greatest_tension() {
    let like = "like = \"polyurethane\"\n";
    let hydrostatic = 1e6;
    let published = StrengthCriterion::DruckerPrager { hydrostatic };
    assert_eq!(material_of(like).unwrap().strength_criterion, published);
    for fields in ["unbreakable = true", "strength = 4e6", "strength = 1e5"] {
        let material = material_of(&format!("{like}{fields}")).unwrap();
        let criterion = material.strength_criterion;
        assert_eq!(criterion, StrengthCriterion::GreatestTension, "{fields}");
    }
    let both = material_of(&format!("{like}strength = 4e6\nhydrostatic_strength = 5e6")).unwrap();
    let hydrostatic = 5e6;
    assert_eq!(
        both.strength_criterion,
        StrengthCriterion::DruckerPrager { hydrostatic }
    );
    // A hydrostatic strength of its own must suit the strength.
    let error = material_of(&format!("{like}strength = 4e6\nhydrostatic_strength = 1e6"));
    assert!(error.unwrap_err().contains("hydrostatic_strength"));
}

#[test]
fn own_modulus_of_material_like_another_keeps_the_fracture_energy() {
    // Gelatine with 10 % has 1.1 J/m², so that K = √(G Y / (1 − ν²)).
    let stiff = material_of("like = \"gelatine-10\"\nyoung = 73200.0\npoisson = 0.3").unwrap();
    assert!((stiff.fracture_energy() - 1.1).abs() < 1e-5);
    assert!(
        (stiff.toughness - 297.462).abs() < 0.01,
        "{}",
        stiff.toughness
    );
    let given = material_of("like = \"gelatine-10\"\nyoung = 73200.0\ntoughness = 50.0").unwrap();
    assert_eq!(given.toughness, 50.0);
    // Materials without `like` keep the toughness of the default.
    let plain = material_of("young = 73200.0").unwrap();
    assert_eq!(plain.toughness, Material::default().toughness);
    // A material without a fracture energy never has a growing crack.
    let liver = material_of("like = \"tofu-firm\"\nyoung = 1000.0").unwrap();
    assert_eq!(liver.toughness, f32::INFINITY);
}

#[test]
fn stress_law_without_its_constants_is_named_in_words() {
    let error = material_of("stress_law = \"yeoh\"").unwrap_err();
    assert!(error.contains("as in { yeoh = [0.01, 0.0001] }"), "{error}");
    assert!(!error.contains("variant"), "{error}");
    let error = material_of("stress_law = { neo_hookean = 1.0 }").unwrap_err();
    assert!(!error.contains("variant"), "{error}");
}

#[test]
fn table_of_material_is_read_back() {
    for record in library::MATERIALS {
        let material = record.material();
        let table = MaterialText::table_of(&material).unwrap();
        let fields = table.strip_prefix("[[material]]\n").unwrap();
        assert_eq!(material_of(fields).unwrap(), material, "{table}");
    }
}
