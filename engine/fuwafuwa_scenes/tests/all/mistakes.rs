//! Errors in scenes: each message names the file, the line, the field and what was expected.

use fuwafuwa::{Dim2, Dim3};
use fuwafuwa_scenes::Scene;
use fuwafuwa_scenes::disk::open_scene;
use std::time::{Duration, Instant};

const GOOD: &str = "dim = 2
[[material]]
young = 5000.0

[[body]]
shape = \"ball\"
n = 12
width = 1.0

[[obstacle]]
ball = { centre = [0.0, -1.0, 0.0], radius = 0.5 }

[[hand]]
radius = 0.1
path = [[0.0, -0.3, 0.5, 0.0], [1.0, 1.2, 0.5, 0.0]]
";

fn complaint(text: &str) -> String {
    let built = Scene::read("toy.toml", text, &[]).and_then(|scene| match scene.dim {
        2 => scene.build::<Dim2>().map(|_| ()),
        _ => scene.build::<Dim3>().map(|_| ()),
    });
    built.map_or_else(|error| error.to_string(), |()| "fine".into())
}

#[test]
fn error_names_file_line_field_and_expectation() {
    assert_eq!(complaint(GOOD), "fine");
    let body = "width = 1.0";
    let obstacle = "ball = { centre = [0.0, -1.0, 0.0], radius = 0.5 }";
    for (replaced, by, expected) in [
        // Cases in which the text does not have the structure of a scene.
        (
            "dim = 2",
            "dim = 2 3",
            ", line 1: dim = 2 3: string values must be quoted, expected literal string",
        ),
        (
            "young = 5000.0",
            "young",
            ", line 3: young: key with no value, expected `=`",
        ),
        ("dim = 2", "", ": missing field `dim`"),
        (
            "dim = 2",
            "dim = \"two\"",
            ", line 1: dim = \"two\": invalid type: string \"two\", expected a whole number from 0 to 255",
        ),
        (
            "[[material]]",
            "[material]",
            ", line 2: [material]: invalid type: a table, expected a list of them, as in [[body]]",
        ),
        (
            "young",
            "yuong",
            ", line 3: yuong = 5000.0: unknown field `yuong`, expected one of `like`, `young`, `poisson`, `stress_law`, `prony`, `density`, `mass_damping`, `stiffness_damping`, `damping`, `friction`, `rolling_resistance`, `strength`, `hydrostatic_strength`, `strength_scatter`, `toughness`, `rate_toughening`, `yield_strain`, `plastic_limit`, `unbreakable`, `colour`",
        ),
        (
            "\"ball\"",
            "\"bal\"",
            ", line 6: shape = \"bal\": unknown variant `bal`, expected one of `ball`, `box`, `ring`, `heart`, `flower`, `empty`",
        ),
        (
            "n = 12",
            "n = 12.5",
            ", line 7: n = 12.5: invalid type: floating point `12.5`, expected a whole number of 0 or more",
        ),
        (
            "n = 12",
            "n = 12\nn = 13",
            ", line 8: n = 13: duplicate key",
        ),
        (
            body,
            "at = [0.0, 1.0]",
            ", line 8: at = [0.0, 1.0]: invalid length 2, expected an array of length 3",
        ),
        (
            body,
            "material = 300",
            ", line 8: material = 300: invalid value: integer `300`, expected a whole number from 0 to 255",
        ),
        (
            "radius = 0.1",
            "",
            ", line 13: hand 1, radius: expected exactly one of radius, box and capsule",
        ),
        // Cases in which a value is invalid.
        (
            "dim = 2",
            "dim = 4",
            ", line 1: dim: expected 2 or 3, found 4",
        ),
        (
            "dim = 2",
            "dim = 2\ngravity = [0.0, nan, 0.0]",
            ", line 2: gravity: expected finite numbers, found [0.0, NaN, 0.0]",
        ),
        (
            "dim = 2",
            "dim = 2\ngravity = [0.0, 0.0, 1.0]",
            ", line 2: gravity: expected 0 for the third axis of a world with dim = 2, found [0.0, 0.0, 1.0]",
        ),
        (
            "dim = 2",
            "dim = 2\nseconds = inf",
            ", line 2: seconds: expected 0 to 86400 s, found inf",
        ),
        (
            "dim = 2",
            "dim = 2\nmax_substeps = 4",
            ", line 2: max_substeps: expected 8 to 1024, found 4",
        ),
        (
            "dim = 2",
            "dim = 2\ndrag = 11",
            ", line 2: drag: expected 0 to 10, found 11.0",
        ),
        (
            "dim = 2",
            "dim = 2\nview = [[1, 0, 0], [0, 1, 0]]",
            ", line 2: view: expected a low corner below a high one, found [1.0, 0.0, 0.0] and [0.0, 1.0, 0.0]",
        ),
        (
            "young = 5000.0",
            "young = -1.0",
            ", line 3: material 1, young: expected positive and finite [Pa], found -1.0",
        ),
        (
            "young = 5000.0",
            "poisson = 0.5",
            ", line 3: material 1, poisson: expected 0 to 0.49, found 0.5",
        ),
        (
            "young = 5000.0",
            "stress_law = { yeoh = [-0.1, 0.001] }",
            ", line 3: material 1, stress_law, second: expected 0 to 1e6, or negative with a square below 3 × third; positive if third is negative, found -0.1",
        ),
        (
            "young = 5000.0",
            "stress_law = \"neo_hookean\"\nyield_strain = 0.1",
            ", line 4: material 1, yield_strain: expected infinite under a hyperelastic stress law, found 0.1",
        ),
        (
            "young = 5000.0",
            "prony = [[0.1, 1.0], [0.1, 1.0], [0.1, 1.0]]",
            ", line 3: material 1, prony: expected at most 2 terms, found 3",
        ),
        (
            "young = 5000.0",
            "strength = 3000.0\nhydrostatic_strength = 900.0",
            ", line 4: material 1, hydrostatic_strength: expected finite and above a third of a finite strength [Pa], found 900.0",
        ),
        (
            "young = 5000.0",
            "like = \"ecoflex\"",
            ", line 3: material 1, like: expected a material of the library (ecoflex-00-10, ecoflex-00-30, ecoflex-00-50), found \"ecoflex\"",
        ),
        (
            "young = 5000.0",
            "rate_toughening = [0.1, 3.0]",
            ", line 3: material 1, rate_toughening, exponent: expected 0 to 2, found 3.0",
        ),
        (
            "young = 5000.0",
            "prony = [[0.1, 0.0]]",
            ", line 3: material 1, prony, time: expected 0.001 to 1000 s, found 0.0",
        ),
        (
            "young = 5000.0",
            "density = 0",
            ", line 3: material 1, density: expected positive and finite, found 0.0",
        ),
        (
            "shape = \"ball\"",
            "",
            ", line 5: body 1, shape: expected either a shape, a file, voxels or a state",
        ),
        (
            "shape = \"ball\"",
            "shape = \"ball\"\nfile = \"a.png\"",
            ", line 6: body 1, shape: expected either a shape, a file, voxels or a state",
        ),
        (
            "shape = \"ball\"",
            "file = \"a.vox\"",
            ", line 5: body 1, content: expected the content of the file",
        ),
        (
            "shape = \"ball\"",
            "shape = \"empty\"",
            ", line 5: body 1, part: the grid is empty: at least one voxel must be solid",
        ),
        (
            "n = 12",
            "",
            ", line 5: body 1, n: expected the number of voxels across",
        ),
        (
            "n = 12",
            "n = 0",
            ", line 7: body 1, n: expected 1 to 1024 voxels across, found 0",
        ),
        (
            "n = 12",
            "n = 1000000000000",
            ", line 7: body 1, n: expected 1 to 1024 voxels across, found 1000000000000",
        ),
        (
            "shape = \"ball\"\nn = 12",
            "shape = \"ring\"\nn = 1",
            ", line 7: body 1, n: the grid is empty: at least one voxel must be solid",
        ),
        (
            body,
            "width = 0",
            ", line 8: body 1, width: expected a positive number of metres, found 0",
        ),
        (
            body,
            "width = 1e-45",
            ", line 8: body 1, width: voxel_size must be 0.000001 to 1000 m, given 0.0",
        ),
        (
            body,
            "proportions = [1, 2, 1]",
            ", line 8: body 1, proportions: allowed only for shape = \"box\" or \"empty\"",
        ),
        (
            body,
            "diced = 0.01",
            ", line 8: body 1, diced: expected a voxel, 0.083333336 m, or more, found 0.01",
        ),
        (
            body,
            "material = 2",
            ", line 8: body 1, material: voxels have material 2, but the scene has materials 1 to 1",
        ),
        (
            body,
            "colours = { \"#ff0000\" = 1 }",
            ", line 8: body 1, colours: only a file has colours; expected material, or parts that paint",
        ),
        (
            body,
            "part = [{ fill = 1 }]",
            ", line 8: body 1, part 1, shape: expected exactly one of half_space, box, capsule and ball",
        ),
        (
            body,
            "\n[[body.part]]\nball = { centre = [0, 0, 0], radius = 1 }",
            ", line 9: body 1, part 1, fill: expected either fill or paint",
        ),
        (
            body,
            "\n[[body.part]]\nfill = 0\nball = { centre = [0, 0, 1], radius = 9 }",
            ", line 11: body 1, part 1, ball, centre: expected 0 for the third axis of a world with dim = 2, found [0.0, 0.0, 1.0]",
        ),
        (
            body,
            "\n[[body.part]]\nfill = 0\nball = { centre = [0, 0, 0], radius = 9 }",
            ", line 9: body 1, part: the grid is empty: at least one voxel must be solid",
        ),
        (
            obstacle,
            "friction = 0.5",
            ", line 10: obstacle 1, shape: expected exactly one of half_space, box, capsule and ball",
        ),
        (
            obstacle,
            "half_space = { normal = [0, 0, 0], point = [0, 0, 0] }",
            ", line 11: obstacle 1, half_space, normal: expected a direction, found 0 on every axis",
        ),
        (
            "radius = 0.5",
            "radius = -0.5",
            ", line 11: obstacle 1, ball, radius: expected positive and finite, found -0.5",
        ),
        (
            obstacle,
            "ball = { centre = [0, -1, 0], radius = 0.5 }\nfriction = nan",
            ", line 12: obstacle 1, friction: expected 0 or more, and finite, found NaN",
        ),
        (
            "radius = 0.1",
            "radius = 0",
            ", line 14: hand 1, radius: expected a positive number of metres, found 0",
        ),
        (
            "[1.0, 1.2",
            "[-1.0, 1.2",
            ", line 15: hand 1, path 2: expected a time of 0 s or more, found -1",
        ),
        (
            "[[0.0, -0.3, 0.5, 0.0], [1.0, 1.2, 0.5, 0.0]]",
            "[]",
            ", line 15: hand 1, path: expected a point [seconds, x, y, z] at least",
        ),
    ] {
        let text = GOOD.replacen(replaced, by, 1);
        assert_ne!(text, GOOD, "{replaced}");
        assert_eq!(complaint(&text), format!("toy.toml{expected}"));
    }
}

#[test]
fn error_names_invalid_change() {
    let complaint = |change: &str| {
        let scene = Scene::read("toy.toml", GOOD, &[change.into()]);
        let built = scene.and_then(|scene| scene.build::<Dim2>().map(|_| ()));
        built.map_or_else(|error| error.to_string(), |()| "fine".into())
    };
    for (change, expected) in [
        ("body.n=8", "fine"),
        (
            "body.1.part=[{ paint = 1, ball = { centre = [0, 0, 0], radius = 1 } }]",
            "fine",
        ),
        ("material.young=9000", "fine"),
        (
            "body.n",
            "toy.toml with body.n: \"body.n\" must be field=value",
        ),
        (
            "body.n=eight",
            "toy.toml with body.n=eight: \"eight\" in \"body.n=eight\" is not a value; a text requires quotes: 'body.n=\"eight\"'",
        ),
        (
            "body.n=[4",
            "toy.toml with body.n=[4: \"[4\" in \"body.n=[4\" is not a value",
        ),
        (
            "body.3.n=4",
            "toy.toml with body.3.n=4: \"body.3.n=4\": there is no number 3, the last one is 1",
        ),
        (
            "body.n=0",
            "toy.toml with body.n=0: body 1, n: expected 1 to 1024 voxels across, found 0",
        ),
        (
            "body.1.colours.x=1",
            "toy.toml with body.1.colours.x=1: body 1, colours: only a file has colours; expected material, or parts that paint",
        ),
        (
            "feet.n=1",
            "toy.toml with feet.n=1: \"feet.n=1\": there is no entry that n could be a field of",
        ),
        (
            "dim.x=1",
            "toy.toml with dim.x=1: \"dim.x=1\": x is not a field of a single value",
        ),
    ] {
        assert_eq!(complaint(change), expected, "{change}");
    }
    let misspelt = complaint("body.nn=4");
    assert!(
        misspelt.starts_with("toy.toml with body.nn=4: unknown field `nn`"),
        "{misspelt}"
    );
}

#[test]
fn change_applies_to_default_material() {
    let bare = GOOD.replace("[[material]]\nyoung = 5000.0", "");
    let changes = ["material.young=9000".to_string()];
    let scene = Scene::read("toy.toml", &bare, &changes).unwrap();
    assert_eq!(scene.materials()[0].elasticity.young, 9000.0);
}

#[test]
fn read_rejects_foreign_texts_with_short_error() {
    let deep = 300_000;
    for text in [
        "x = ".to_string() + &"[".repeat(deep),
        "x = ".to_string() + &"{a = ".repeat(deep),
        "a.".repeat(deep) + "a = 1",
        format!("[[{}a]]", "a.".repeat(deep)),
        format!("dim = \"{}\"", "é".repeat(deep)),
        "\u{0}\u{1}\u{fffd}".repeat(100),
        String::new(),
    ] {
        let complaint = complaint(&text);
        assert!(
            complaint.len() < 1000 && complaint.starts_with("toy.toml"),
            "{complaint}"
        );
    }
    let files = [("Cargo.toml", "unknown field"), ("src", "a folder")];
    for (file, expected) in files {
        let error = open_scene(file, &[]).unwrap_err().to_string();
        assert!(
            error.starts_with(file) && error.contains(expected),
            "{error}"
        );
    }
    let unknown = open_scene("nowhere", &[]).unwrap_err().to_string();
    assert!(unknown.contains("the scenes are drop, "), "{unknown}");
    if cfg!(unix) {
        let endless = open_scene("/dev/zero", &[]).unwrap_err().to_string();
        assert!(endless.contains("a device"), "{endless}");
    }
}

#[test]
fn build_limits_number_of_bodies_and_sum_of_voxels() {
    let many = GOOD.to_string() + &"[[body]]\nshape = \"box\"\nn = 1\n".repeat(1024);
    assert_eq!(
        complaint(&many),
        "toy.toml, line 5: body: expected 1024 bodies at most, found 1025"
    );
    let body = |text: &str| GOOD.to_string() + "[[body]]\n" + text;
    let two = body("shape = \"box\"\nn = 12\n");
    let scene = Scene::read("toy.toml", &two, &[]).unwrap();
    let world = scene.build::<Dim2>().unwrap();
    let bodies = world.soft_bodies();
    let solid: usize = bodies.map(|(_, body)| body.grid().solid_count()).sum();
    let less = solid - 1;
    assert!(scene.build_within::<Dim2>(solid).is_ok());
    assert_eq!(
        scene.build_within::<Dim2>(less).unwrap_err().to_string(),
        format!(
            "toy.toml, line 18: body 2, n: expected {less} solid voxels at most in all bodies together, found {solid}"
        )
    );
    // A large grid that is almost empty is limited by its memory.
    let dots = body("voxels = { size = [100, 100, 1], voxel_size = 0.1, runs = \"1x1 9999x0\" }\n");
    let scene = Scene::read("toy.toml", &dots, &[]).unwrap();
    assert!(scene.build_within::<Dim2>(1300).is_ok());
    let error = scene.build_within::<Dim2>(1200).unwrap_err().to_string();
    assert!(
        error.contains("expected 9600 voxels at most, solid or empty, in the grids"),
        "{error}"
    );
}

/// Regression: a text of 1 MB could require 10^12 distance evaluations. It could also contain any number of
/// obstacles, each of which is tested against every node.
#[test]
fn build_rejects_expensive_scenes_before_work_begins() {
    let part = "[[body.part]]\nfill = 0\nball = { centre = [9.0, 9.0, 0.0], radius = 0.1 }\n";
    let body = "[[body]]\nshape = \"box\"\nn = 1024\n";
    let parts = format!("dim = 2\n{body}{}", part.repeat(200));
    let expected = "expected 128 at most in a body of 1048576 voxels, found 200";
    assert!(
        complaint(&parts).contains(expected),
        "{}",
        complaint(&parts)
    );

    let diced = format!("dim = 2\n{body}diced = 0.001\n");
    assert!(
        complaint(&diced).contains("are too many"),
        "{}",
        complaint(&diced)
    );

    let ball = "[[obstacle]]\nball = { centre = [0.0, -1.0, 0.0], radius = 0.5 }\n";
    let walls = GOOD.to_string() + &ball.repeat(256);
    let expected = "obstacle: expected 256 at most, found 257";
    assert!(
        complaint(&walls).contains(expected),
        "{}",
        complaint(&walls)
    );
    let hand = "[[hand]]\nradius = 0.1\npath = [[0.0, -0.3, 0.5, 0.0]]\n";
    let hands = GOOD.to_string() + &hand.repeat(256);
    let expected = "hand: expected 256 at most, found 257";
    assert!(
        complaint(&hands).contains(expected),
        "{}",
        complaint(&hands)
    );
}

/// Regression: the voxels were counted only after the memory for the grid was allocated.
#[test]
fn build_rejects_too_large_grid_before_allocation() {
    let dim3 = |text: &str| {
        let scene = Scene::read("toy.toml", text, &[]).unwrap();
        let start = Instant::now();
        let complaint = scene.build_within::<Dim3>(1 << 15).unwrap_err().to_string();
        assert!(start.elapsed() < Duration::from_secs(3), "{complaint}");
        complaint
    };
    let large = dim3("dim = 3\n[[body]]\nshape = \"flower\"\nn = 400\n");
    assert!(
        large.contains("n: expected 262144 voxels at most, solid or empty"),
        "{large}"
    );
}

#[test]
fn build_limits_length_of_lists() {
    let material = "[[material]]\n".repeat(256);
    let colours: Vec<String> = (0..256).map(|k| format!("\"#{k:06x}\" = 1")).collect();
    let colours = colours.join(", ");
    let wish = "[[game.wish]]\nseconds = 1.0\n".repeat(9);
    for (text, expected) in [
        (
            format!("dim = 2\n{material}"),
            "material: expected 255 at most, found 256",
        ),
        (
            format!("dim = 2\n[[body]]\nfile = \"a.png\"\ncolours = {{ {colours} }}\n"),
            "body 1, colours: expected 255 at most, found 256",
        ),
        (
            format!("dim = 2\n[game]\nname = {{ en = \"a\" }}\n{wish}"),
            "game, wish: expected 8 at most, found 9",
        ),
        (
            "dim = 2\n[game]\nname = { en = \"a\" }\nhint = [[16.0, 0.0, 0.0, 0.0]]\n".into(),
            "game, hint: expected 15 s at most, found 16",
        ),
        (
            "dim = 2\n[game]\nname = { en = \"a\" }\nhint = [[1.0, 0.0, 0.0, 0.0], [0.5, 0.0, 0.0, 0.0]]\n"
                .into(),
            "game, hint 2: expected a time of 1 s or more, found 0.5",
        ),
    ] {
        let scene = Scene::read("toy.toml", &text, &[]).unwrap();
        let built = scene.build::<Dim2>().map(drop);
        let error = built.and(scene.baskets::<Dim2>().map(drop)).unwrap_err();
        assert!(error.to_string().contains(expected), "{error}");
    }
    let path = "path = [".to_string() + &"[0,0,0,0],\n".repeat(10_001);
    let text = GOOD.replace("path = [", &path);
    let expected = "path: expected 10000 points at most, found";
    assert!(complaint(&text).contains(expected), "{}", complaint(&text));
}

#[test]
fn error_truncates_quoted_text() {
    let long = "z".repeat(1 << 19);
    for text in [
        format!("dim = 2\n[[body]]\nfile = \"{long}\"\n"),
        format!("dim = 2\n[[body]]\nfile = \"{long}.png\"\ncontent = \"\"\n"),
        format!("dim = 2\n[[body]]\nfile = \"a.png\"\ncolours = {{ {long} = 1 }}\n"),
    ] {
        let complaint = complaint(&text);
        assert!(complaint.len() < 1000, "{} bytes", complaint.len());
    }
}

#[test]
fn read_takes_linear_time_for_long_text() {
    let path = "path = [".to_string() + &"[0,0,0,0],\n".repeat(30_000) + "[0,0,0,nan]";
    let text = GOOD.replace("path = [[0.0, -0.3, 0.5, 0.0]", &path);
    let start = Instant::now();
    assert!(complaint(&text).starts_with("toy.toml, line "));
    assert!(start.elapsed() < Duration::from_secs(10));
}
