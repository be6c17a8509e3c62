//! The game without a window, run from a terminal.

use serde_json::Value;
use std::fs;
use std::path::Path;
use std::process::{Command, Output};
use std::sync::Arc;
use tamaire_play::link::address;
use tamaire_play::replay::VERSION;
use tamaire_play::{AnyRound, Bot, BotKind, Level};
use tempfile::TempDir;

/// Level with a small body that is simulated quickly.
fn small_level(basket_at: f32) -> String {
    format!(
        "dim = 2\n\
         gravity = [0.0, 0.0, 0.0]\n\
         view = [[-1.6, -1.0, 0.0], [1.6, 1.0, 0.0]]\n\
         [game]\n\
         name = {{ en = \"Small\" }}\n\
         basket = {{ centre = [{basket_at:.1}, 0.0, 0.0], half = [0.5, 0.5, 0.0] }}\n\
         wish = [{{ route = \"squeeze\" }}, {{ seconds = 0.5 }}]\n\
         [[body]]\n\
         shape = \"ball\"\n\
         n = 8\n\
         width = 0.6\n\
         at = [-0.3, -0.3, 0.0]\n\
         [[hand]]\n\
         radius = 0.09\n\
         path = [[0.0, -1.4, 0.0, 0.0]]\n"
    )
}

/// Creates a folder with two levels: `won.toml`, which is won by waiting, and `far.toml`, with a distant
/// basket.
fn folder() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("won.toml"), small_level(0.0)).unwrap();
    fs::write(folder.path().join("far.toml"), small_level(1.1)).unwrap();
    folder
}

/// 3D level with a small ball on the floor that a hand can push into the basket or tear.
const SOLID_LEVEL: &str = r#"
dim = 3
gravity = [0.0, -3.0, 0.0]
drag = 0.5
max_substeps = 8
view = [[-1.6, 0.0, -1.0], [1.6, 1.6, 1.0]]
[game]
name = { en = "Solid" }
basket = { centre = [0.9, 0.4, 0.0], half = [0.5, 0.4, 0.6] }
share = 0.5
wish = [{ route = "squeeze" }, { pieces = 2 }]
[[material]]
strength = 800.0
toughness = 133.0
[[body]]
shape = "ball"
n = 8
width = 0.6
at = [-0.6, 0.0, -0.3]
[[obstacle]]
half_space = { normal = [0.0, 1.0, 0.0], point = [0.0, 0.0, 0.0] }
[[obstacle]]
half_space = { normal = [-1.0, 0.0, 0.0], point = [1.6, 0.0, 0.0] }
[[hand]]
radius = 0.12
path = [[0.0, -1.3, 0.3, 0.4]]
"#;

/// Creates a folder with [`SOLID_LEVEL`] as `solid.toml`.
fn folder_in_space() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("solid.toml"), SOLID_LEVEL).unwrap();
    folder
}

/// MagicaVoxel model of a solid cube, `width` voxels wide.
fn cube_model(width: u8) -> Vec<u8> {
    let axis = || 0..width;
    let voxels = axis().flat_map(|z| axis().flat_map(move |y| axis().map(move |x| [x, y, z, 79])));
    let voxels: Vec<[u8; 4]> = voxels.collect();
    let chunk = |name: &[u8; 4], contents: Vec<u8>, children: Vec<u8>| {
        let lengths = [contents.len() as u32, children.len() as u32].map(u32::to_le_bytes);
        [&name[..], lengths.as_flattened(), &contents, &children].concat()
    };
    let size = [u32::from(width).to_le_bytes(); 3].concat();
    let list = [
        &(voxels.len() as u32).to_le_bytes()[..],
        voxels.as_flattened(),
    ];
    let children = [
        chunk(b"SIZE", size, Vec::new()),
        chunk(b"XYZI", list.concat(), Vec::new()),
    ];
    let main = chunk(b"MAIN", Vec::new(), children.concat());
    [b"VOX ", &150u32.to_le_bytes()[..], &main].concat()
}

/// Runs the game in a folder, without a display.
fn tamaire(folder: &Path, arguments: &str) -> Output {
    tamaire_with(folder, arguments, &[])
}

/// Runs the game as [`tamaire`] does, with environment variables.
fn tamaire_with(folder: &Path, arguments: &str, variables: &[(&str, &str)]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_tamaire"));
    for name in ["DISPLAY", "WAYLAND_DISPLAY", "WAYLAND_SOCKET"] {
        command.env_remove(name);
    }
    let arguments = arguments.split_whitespace();
    command
        .current_dir(folder)
        // Some drivers complain if this variable is missing.
        .env("XDG_RUNTIME_DIR", folder)
        .envs(variables.iter().copied())
        .args(arguments)
        .output()
        .unwrap()
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).unwrap()
}

fn json(output: &Output) -> Value {
    serde_json::from_slice(&output.stdout).unwrap_or_else(|error| panic!("{error}: {output:?}"))
}

/// Runs the game, checks that it succeeds, and returns the JSON that it prints.
fn json_of(folder: &Path, arguments: &str) -> Value {
    let output = tamaire(folder, arguments);
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    json(&output)
}

/// Checks that the arguments are refused with this exit status and a message that contains all of `words`.
fn check_refused(arguments: &str, status: i32, words: &[&str]) {
    let folder = folder();
    fs::write(folder.path().join("broken.toml"), "dim = 2\nbody = 5\n").unwrap();
    let output = tamaire(folder.path(), arguments);
    let said = text(&output.stderr);
    assert_eq!(output.status.code(), Some(status), "{arguments}: {said}");
    for word in words {
        assert!(said.contains(word), "{arguments}: {said}");
    }
    assert!(!said.contains("panicked"), "{arguments}: {said}");
}

#[test]
fn round_is_reported_as_json() {
    let folder = folder();
    let line = "--headless --level won.toml --bot idle --json";
    let told = json_of(folder.path(), line);
    assert_eq!(told["level"], "won.toml");
    assert_eq!(told["bot"], "idle");
    assert_eq!(told["won"], true);
    assert_eq!(told["route"], "squeeze");
    // The clock starts with the first push. The bot never pushes, so it meets any limit of time.
    assert_eq!(told["wishes"], serde_json::json!([true, true]));
    assert_eq!(told["seconds"], 0.0);
    assert_eq!(told["pieces"], 1);
    assert_eq!(told["kept"], 1.0);
    let ticks = told["ticks"].as_u64().unwrap();
    assert!(
        (60..66).contains(&ticks),
        "won after a second at rest: {ticks}"
    );
    assert_eq!(told["hash"].as_str().unwrap().len(), 16);
    let [p50, p99, worst] =
        ["p50_tick_ms", "p99_tick_ms", "worst_tick_ms"].map(|field| told[field].as_f64().unwrap());
    assert!(
        0.0 < p50 && p50 <= p99 && p99 <= worst,
        "{p50} {p99} {worst}"
    );
}

#[test]
fn bot_depends_only_on_seed() {
    let folder = folder();
    let hash = |seed: u32| {
        let line =
            format!("--headless --level far.toml --bot random --seconds 2 --json --seed {seed}");
        let told = json(&tamaire(folder.path(), &line));
        assert_eq!(told["ticks"], 120);
        told["hash"].as_str().unwrap().to_string()
    };
    assert_eq!(hash(1), hash(1));
    assert_ne!(hash(1), hash(2));
}

#[test]
fn lost_round_is_reported_without_error() {
    let folder = folder();
    let line = "--headless --level far.toml --bot random --seconds 1";
    let output = tamaire(folder.path(), line);
    let told = text(&output.stdout);
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    assert!(
        told.contains("Small") && told.contains("not won in 1.0 s"),
        "{told}"
    );
}

#[test]
fn replay_is_genuine_until_changed() {
    let folder = folder();
    let line = "--headless --level far.toml --bot random --seconds 2 --save it.tamaire --json";
    let played = json(&tamaire(folder.path(), line));
    let line = "--headless --replay it.tamaire --json";
    let replayed = json_of(folder.path(), line);
    assert_eq!(replayed["genuine"], true);
    for field in ["hash", "ticks", "kept", "inside", "won"] {
        assert_eq!(replayed[field], played[field], "{field}");
    }

    let path = folder.path().join("it.tamaire");
    let replay = fs::read_to_string(&path).unwrap();
    let check = |changed: String, reason: &str| {
        assert_ne!(changed, replay, "{reason}: nothing was changed");
        fs::write(&path, changed).unwrap();
        let output = tamaire(folder.path(), line);
        assert_eq!(output.status.code(), Some(1), "{output:?}");
        let told = json(&output);
        assert_eq!(told["genuine"], false);
        assert!(told["reason"].as_str().unwrap().contains(reason), "{told}");
    };
    let hash = played["hash"].as_str().unwrap();
    check(replay.replace(hash, "0123456789abcdef"), "was changed");
    check(
        replay.replace("drag = 0.0", "drag = 9.0"),
        "level in this replay was changed",
    );
    check(
        replay.replacen(&format!("version = {VERSION}"), "version = 77", 1),
        "version 77",
    );
    check("hello".into(), "no replay");
}

#[test]
fn films_and_photos_are_written() {
    let folder = folder();
    let pictures = [
        ("film", "round.png", &b"\x89PNG"[..]),
        ("film", "round.gif", b"GIF89a"),
        ("photo", "end.png", b"\x89PNG"),
    ];
    for (what, picture, start) in pictures {
        let line = format!("--headless --level far.toml --bot idle --seconds 1 --{what} {picture}");
        let output = tamaire(folder.path(), &line);
        assert_eq!(output.status.code(), Some(0), "{output:?}");
        let bytes = fs::read(folder.path().join(picture)).unwrap();
        assert!(bytes.starts_with(start) && bytes.len() > 1000, "{picture}");
        // Only a terminal gets a progress bar.
        let said = text(&output.stderr);
        assert!(said.ends_with(&format!("wrote {picture}\n")), "{said}");
        assert!(!has_adapter() || said.lines().count() == 1, "{said}");
    }
}

/// Whether a graphics adapter must be present, as in continuous integration.
fn has_adapter() -> bool {
    std::env::var("CI").is_ok_and(|value| value == "1" || value == "true")
}

/// Without this variable, drivers complain about the display that they look for.
#[test]
fn photo_without_a_session_prints_no_errors_of_drivers() {
    let folder = folder();
    let line = "--headless --level far.toml --bot idle --seconds 1 --photo it.png";
    let output = Command::new(env!("CARGO_BIN_EXE_tamaire"))
        .current_dir(folder.path())
        .env_remove("DISPLAY")
        .env_remove("WAYLAND_DISPLAY")
        .env_remove("XDG_RUNTIME_DIR")
        .args(line.split_whitespace())
        .output()
        .unwrap();
    let said = text(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{said}");
    assert!(!said.contains("XDG_RUNTIME_DIR"), "{said}");
    assert!(said.ends_with("wrote it.png\n"), "{said}");
}

#[test]
fn photo_without_adapter_shows_elements_and_warns() {
    // Graphics API that this operating system does not have.
    let none = if cfg!(target_os = "macos") {
        "dx12"
    } else {
        "metal"
    };
    for (folder, level) in [(folder(), "far.toml"), (folder_in_space(), "solid.toml")] {
        let line = format!("--headless --level {level} --bot idle --seconds 1 --photo it.png");
        let output = tamaire_with(folder.path(), &line, &[("WGPU_BACKEND", none)]);
        let said = text(&output.stderr);
        assert_eq!(output.status.code(), Some(0), "{said}");
        assert!(said.contains("no graphics adapter"), "{said}");
        assert_eq!(said.lines().count(), 2, "{said}");
        let photo = fs::read(folder.path().join("it.png")).unwrap();
        assert!(photo.starts_with(b"\x89PNG") && photo.len() > 1000);
    }
}

#[test]
fn invalid_arguments_are_refused_with_reason() {
    check_refused("--headless --level nowhere", 2, &["nowhere", "classic"]);
    check_refused(
        "--headless --level broken.toml",
        2,
        &["broken.toml", "line 2"],
    );
    check_refused("--headless --bot cheat", 2, &["cheat", "squeeze", "idle"]);
    check_refused("--headless --seconds 0", 2, &["1 to 3600 seconds"]);
    check_refused("--headless --seconds -3", 2, &["1 to 3600 seconds"]);
    check_refused("--headless --film film.mp4", 2, &[".png or .gif"]);
    check_refused("--headless --photo photo.gif", 2, &[".png"]);
    check_refused(
        "--headless --film no/folder.png",
        2,
        &["the folder does not exist"],
    );
    check_refused("--headless --save it.txt", 2, &[".tamaire"]);
    check_refused("--headless --replay none.tamaire", 2, &["none.tamaire"]);
    check_refused("--headless --replay it.tamaire --bot idle", 2, &["--bot"]);
    check_refused("--bot idle", 2, &["--headless"]);
    check_refused("--headles", 2, &["--headless"]);
    check_refused(
        "--headless --replay won.toml",
        1,
        &["won.toml", "no replay"],
    );
}

/// The content of a file decides whether it is a level or a replay, not its name.
#[test]
fn content_of_a_file_decides_what_is_played() {
    let folder = folder();
    let line = "--headless --level far.toml --bot random --seconds 1 --save it.tamaire --json";
    let played = json_of(folder.path(), line);
    let path = |name: &str| folder.path().join(name);
    fs::copy(path("it.tamaire"), path("replay.txt")).unwrap();
    fs::copy(path("far.toml"), path("level.tamaire")).unwrap();
    for name in ["it.tamaire", "replay.txt"] {
        let told = json_of(folder.path(), &format!("--headless {name} --json"));
        assert_eq!(told["genuine"], true, "{name}");
        assert_eq!(told["hash"], played["hash"], "{name}");
    }
    let line = "--headless level.tamaire --json --bot idle --seconds 1";
    assert_eq!(json_of(folder.path(), line)["level"], "level.tamaire");
}

#[test]
fn options_of_bots_are_refused_with_a_replay() {
    let folder = folder();
    let line = "--headless --level far.toml --bot idle --seconds 1 --save it.tamaire";
    assert_eq!(tamaire(folder.path(), line).status.code(), Some(0));
    for (option, value) in [
        ("save", "copy.tamaire"),
        ("bot", "squeeze"),
        ("seed", "1"),
        ("seconds", "60"),
    ] {
        let line = format!("--headless it.tamaire --{option} {value}");
        let output = tamaire(folder.path(), &line);
        let said = text(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{line}: {said}");
        let reason = format!("--{option} cannot be used with a replay");
        assert!(said.contains(&reason), "{line}: {said}");
        assert!(!folder.path().join("copy.tamaire").exists(), "{line}");
    }
}

/// Runs the game with arguments that may contain spaces.
fn tamaire_args(folder: &Path, arguments: &[&std::ffi::OsStr]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_tamaire"))
        .current_dir(folder)
        .env_remove("DISPLAY")
        .env_remove("WAYLAND_DISPLAY")
        .args(arguments)
        .output()
        .unwrap()
}

#[test]
fn links_are_played_without_a_window() {
    let folder = folder();
    let level = Level::read(
        "mine.toml",
        small_level(0.0).as_bytes(),
        &|_| unreachable!(),
    )
    .unwrap();
    let mut round = AnyRound::new(Arc::new(level.clone()));
    round.play(&mut Bot::new(BotKind::Idle, 1), 90);
    let to_level = address("https://example.org/play/", &level.link().unwrap());
    let to_round = address("https://example.org/play/", &round.replay().link().unwrap());
    let told = json_of(
        folder.path(),
        &format!("--headless {to_level} --json --bot idle"),
    );
    assert_eq!(
        (&told["level"], &told["won"]),
        (&"mine.toml".into(), &true.into())
    );
    let told = json_of(
        folder.path(),
        &format!("--headless --level {to_level} --json --bot idle"),
    );
    assert_eq!(told["won"], true);
    let mailed = to_round.replace('#', "%23");
    for link in [to_round.clone(), format!("<{mailed}>.")] {
        let told = json_of(folder.path(), &format!("--headless {link} --json"));
        assert_eq!(told["genuine"], true);
        assert_eq!(told["hash"], format!("{:016x}", round.hash()));
    }
    if cfg!(target_os = "linux") {
        let output = tamaire(folder.path(), &to_round);
        assert_eq!(output.status.code(), Some(0), "{output:?}");
        assert!(text(&output.stdout).contains("genuine"), "{output:?}");
    }
    let cut = &to_level[..to_level.len() - 9];
    for (link, reason) in [
        (cut, "the end of this link is missing"),
        (
            "https://example.org/",
            "this is not a link to a round or a level",
        ),
    ] {
        let output = tamaire(folder.path(), &format!("--headless {link}"));
        let said = text(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{said}");
        assert!(
            said.contains(reason) && !said.contains("level or file"),
            "{said}"
        );
    }
}

/// Each case has a file that cannot be opened, or no file. The message names exactly that cause.
#[cfg(target_os = "linux")]
#[test]
fn file_that_cannot_be_opened_is_refused_with_its_reason() {
    use std::ffi::OsStr;
    use std::os::unix::ffi::OsStrExt;
    let folder = folder();
    fs::create_dir(folder.path().join("folder.toml")).unwrap();
    std::os::unix::fs::symlink("loop.toml", folder.path().join("loop.toml")).unwrap();
    fs::write(folder.path().join("picture.toml"), b"\xff\xd8\xff\xe0 JFIF").unwrap();
    let long = "n".repeat(300);
    for (name, reason) in [
        (OsStr::new("missing.toml"), "no level or file"),
        (OsStr::new("folder.toml"), "found a folder"),
        (OsStr::new("far.toml/inside.toml"), "Not a directory"),
        (OsStr::new("loop.toml"), "symbolic link"),
        (OsStr::new(&long), "File name too long"),
        (OsStr::new("picture.toml"), "picture.toml"),
        (OsStr::from_bytes(b"\xff.toml"), "no level or file"),
    ] {
        for flag in ["--headless", "--mute"] {
            let output = tamaire_args(folder.path(), &[OsStr::new(flag), name]);
            let said = text(&output.stderr);
            assert_eq!(output.status.code(), Some(2), "{said}");
            assert!(said.contains(reason), "{name:?}: {said}");
            let is_missing = reason == "no level or file";
            assert_eq!(said.contains("no level or file"), is_missing, "{said}");
        }
    }
    // A file with a name outside of UTF-8 is opened like any other.
    let odd = OsStr::from_bytes(b"\xff.toml");
    fs::write(folder.path().join(odd), small_level(0.0)).unwrap();
    let bot = ["--headless", "--bot", "idle"].map(OsStr::new);
    let output = tamaire_args(folder.path(), &[&bot[..], &[odd]].concat());
    assert_eq!(output.status.code(), Some(0), "{output:?}");
}

#[cfg(unix)]
#[test]
fn pipes_and_devices_are_refused_without_waiting() {
    let folder = folder();
    let pipe = folder.path().join("pipe.tamaire");
    assert!(
        Command::new("mkfifo")
            .arg(&pipe)
            .status()
            .unwrap()
            .success()
    );
    for file in ["pipe.tamaire", "/dev/zero"] {
        for flag in ["--replay", "--level"] {
            let output = tamaire(folder.path(), &format!("--headless {flag} {file}"));
            let said = text(&output.stderr);
            assert_eq!(output.status.code(), Some(2), "{said}");
            assert!(said.contains(file) && said.contains("a device"), "{said}");
        }
    }
}

#[test]
fn round_is_played_without_display() {
    if !cfg!(target_os = "linux") {
        return;
    }
    let folder = folder();
    for line in ["won.toml", "--level won.toml"] {
        let output = tamaire(folder.path(), line);
        assert_eq!(output.status.code(), Some(0), "{output:?}");
        let (said, told) = (text(&output.stderr), text(&output.stdout));
        assert!(
            said.contains("no display") && said.contains("--headless"),
            "{said}"
        );
        assert!(
            told.contains("Small, played by the bot squeeze") && told.contains("result"),
            "{told}"
        );
    }
}

#[test]
fn list_shows_ids_and_names_of_levels() {
    let told = text(&tamaire(Path::new("."), "--list").stdout);
    let classic = told.lines().find(|line| line.starts_with("classic "));
    assert!(
        classic.is_some_and(|line| line.contains("Classic")),
        "{told}"
    );
    assert!(told.lines().any(|line| line.starts_with("classic-3d ")));
}

#[test]
fn force_log_records_substeps_and_device_updates() {
    let folder = folder();
    let run = "--headless --bot squeeze --force-log forces.csv";
    assert_eq!(tamaire(folder.path(), run).status.code(), Some(0));
    let table = fs::read_to_string(folder.path().join("forces.csv")).unwrap();
    let mut lines = table
        .lines()
        .map(|line| line.split(',').collect::<Vec<_>>());
    let columns = lines.next().unwrap();
    let at = |name: &str| columns.iter().position(|column| *column == name).unwrap();
    let rows: Vec<Vec<&str>> = lines.collect();
    assert!(rows.iter().all(|row| row.len() == columns.len()));
    let number = |row: &Vec<&str>, name: &str| row[at(name)].parse::<f64>().unwrap();
    let of = |kind: &str| -> Vec<&Vec<&str>> {
        let rows = rows.iter().filter(|row| row[at("row")] == kind);
        rows.collect()
    };
    let (substeps, updates) = (of("substep"), of("device"));

    // The table has 960 substeps and 250 device updates a second.
    let seconds = number(substeps[substeps.len() - 1], "seconds");
    assert!(
        (substeps.len() as f64 - 960.0 * seconds).abs() <= 1.0,
        "{seconds}"
    );
    assert!((updates.len() as f64 - 250.0 * seconds).abs() <= 10.0);

    // The hand pushes the body to the right, so the stick is pushed to the left. The force on the stick
    // changes smoothly except when the force ends.
    let least = |rows: &[&Vec<&str>], name| {
        let values = rows.iter().map(|row| number(row, name));
        values.fold(0.0, f64::min)
    };
    assert!(least(&substeps, "contact_x_N") < -100.0);
    assert!(least(&updates, "stick_x") < -0.05);
    for pair in updates
        .windows(2)
        .filter(|pair| pair[1][at("silent")].is_empty())
    {
        for name in ["stick_x", "stick_y"] {
            let step = number(pair[1], name) - number(pair[0], name);
            assert!(step.abs() <= 0.1201, "{step}");
        }
    }
    assert!(updates.iter().any(|row| number(row, "pad_slow") > 0.1));
    let last = updates[updates.len() - 1];
    assert_eq!((last[at("silent")], number(last, "stick_x")), ("won", 0.0));

    check_refused("--headless --force-log forces.txt", 2, &[".csv"]);
    check_refused(
        "--headless --force-log no/forces.csv",
        2,
        &["no/forces.csv"],
    );
}

#[test]
fn round_3d_is_reported_recorded_and_filmed() {
    let folder = folder_in_space();
    let line = "--headless --level solid.toml --bot squeeze --seconds 20 --json --save it.tamaire \
                --film it.png --force-log forces.csv";
    let told = json_of(folder.path(), line);
    assert_eq!(
        (&told["bot"], &told["won"]),
        (&"squeeze".into(), &true.into()),
        "{told}"
    );
    assert!(told["inside"].as_f64().unwrap() >= 0.5, "{told}");
    let ticks = told["ticks"].as_u64().unwrap();

    // The table has eight substeps a tick. A hand that comes from the side is pushed along all axes.
    let table = fs::read_to_string(folder.path().join("forces.csv")).unwrap();
    let rows: Vec<Vec<&str>> = table
        .lines()
        .map(|line| line.split(',').collect())
        .collect();
    let is_substep = |row: &&Vec<&str>| row[1] == "substep";
    assert_eq!(rows.iter().filter(is_substep).count() as u64, 8 * ticks);
    for (column, name) in (3..).zip(["contact_x_N", "contact_y_N", "contact_z_N"]) {
        assert_eq!(rows[0][column], name);
        let forces = rows
            .iter()
            .filter(is_substep)
            .map(|row| row[column].parse::<f64>());
        let most = forces.map(|force| force.unwrap().abs()).fold(0.0, f64::max);
        assert!(most > 0.1, "{name}: {most} N");
    }

    let film = fs::read(folder.path().join("it.png")).unwrap();
    assert!(film.starts_with(b"\x89PNG") && film.len() > 10_000);

    let line = "--headless --replay it.tamaire --json";
    let replayed = json(&tamaire(folder.path(), line));
    assert_eq!(replayed["genuine"], true, "{replayed}");
    assert_eq!(replayed["hash"], told["hash"]);

    let path = folder.path().join("it.tamaire");
    let replay = fs::read_to_string(&path).unwrap();
    fs::write(
        &path,
        replay.replace("gravity = [0.0, -3.0", "gravity = [0.0, -2.0"),
    )
    .unwrap();
    let output = tamaire(folder.path(), line);
    assert_eq!(output.status.code(), Some(1), "{output:?}");
    assert_eq!(json(&output)["genuine"], false);
}

#[test]
fn shaving_bot_tears_3d_body_and_film_is_written() {
    let folder = folder_in_space();
    let line = "--headless --level solid.toml --bot shave --seconds 1 --json --film it.gif";
    let told = json_of(folder.path(), line);
    assert!(told["pieces"].as_u64().unwrap() > 1, "{told}");
    assert!(told["kept"].as_f64().unwrap() < 0.99, "{told}");
    let film = fs::read(folder.path().join("it.gif")).unwrap();
    assert!(film.starts_with(b"GIF89a") && film.len() > 10_000);
}

#[test]
fn model_is_played_as_3d_level() {
    let folder = folder_in_space();
    fs::write(folder.path().join("Dice.vox"), cube_model(4)).unwrap();
    fs::write(folder.path().join("broken.vox"), &cube_model(4)[..100]).unwrap();
    let play = |name: &str| {
        let line = format!("--headless --level {name} --bot idle --seconds 1 --json");
        tamaire(folder.path(), &line)
    };
    let told = json(&play("Dice.vox"));
    assert_eq!(
        (&told["level"], &told["name"]),
        (&"Dice.vox".into(), &"Dice".into())
    );
    assert_eq!((&told["pieces"], &told["won"]), (&1.into(), &false.into()));

    let output = play("broken.vox");
    let said = text(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert!(
        said.contains("broken.vox") && !said.contains("panicked"),
        "{said}"
    );
}
