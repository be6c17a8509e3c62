//! Models dropped onto the window.

use crate::hostile::drop_file;
use crate::space::{assert_near, goal, in_space, point_at};
use crate::window::*;
use std::path::Path;
use tamaire::game::Screen;
use tamaire::platform::{Files, OpenRequest};
use tamaire_play::AnyRound;

const MODEL: &str = "pudding.vox";

#[test]
fn dropped_model_is_played_in_3d() {
    let mut window = window(Files::nowhere());
    let model = level_file(MODEL);
    for level in ["classic", "hoop"] {
        start(&mut window, level);
        frames(&mut window, 10);
        drop_file(&mut window, model.clone());
        assert_eq!(
            (screen(&window), notices(&window).as_str()),
            (Screen::Play, ""),
            "{level}"
        );
        let round = window.state().game.bout.round();
        assert!(matches!(round, AnyRound::Space(_)), "{level}");
        assert_eq!(round.level().game().name.en, "pudding");
        assert!(
            round.progress().mass > 0.0 && ticks(&window) <= 2,
            "{level}"
        );
        // The level appears once in the list, however often the file is dropped.
        let levels = &window.state().game.levels;
        let name = &round.level().id;
        assert_eq!(levels.iter().filter(|level| &level.id == name).count(), 1);
        point_at(&mut window, -1.0, 0.7);
        assert!(
            (goal(&window, 0).z - 0.7).abs() < 0.05,
            "{level}: the hand follows the mouse"
        );
    }
}

#[test]
fn level_of_command_line_is_played() {
    let mut window = window(Files::nowhere());
    let levels = window.state().game.levels.len();
    let model = level_file(MODEL);
    for (named, expected, more) in [
        (Path::new("hoop"), "Through the hoop", 0),
        (&model, "pudding", 1),
        (&model, "pudding", 1),
    ] {
        window.state_mut().game.open(OpenRequest::at(named));
        frames(&mut window, 3);
        let game = &window.state().game;
        assert_eq!(screen(&window), Screen::Play, "{named:?}");
        assert_eq!(game.levels.len(), levels + more, "{named:?}");
        let name = &game.bout.round().level().game().name.en;
        assert_eq!(
            (name.as_str(), name),
            (expected, &game.levels[game.chosen].game().name.en)
        );
    }
}

#[test]
fn damaged_model_is_named_and_round_continues() {
    let folder = folder();
    let whole = std::fs::read(level_file(MODEL)).expect("the level is built in");
    let mut window = in_space();
    point_at(&mut window, -1.0, 0.7);
    let levels = window.state().game.levels.len();
    let mut size = whole.clone();
    // The stated number of voxels is made far larger than the number that the file contains.
    let count = whole
        .windows(4)
        .position(|word| word == b"XYZI")
        .expect("the model has a voxel chunk")
        + 12;
    size[count..count + 4].copy_from_slice(&u32::MAX.to_le_bytes());
    let damaged: [(&str, &[u8], &str); 5] = [
        ("cut.vox", &whole[..whole.len() / 2], "cut.vox"),
        ("head.VOX", &whole[..3], "head.VOX"),
        ("empty.vox", b"", "empty.vox"),
        ("count.vox", &size, "count.vox"),
        (
            "picture.vox",
            b"\x89PNG\r\n\x1a\n and no model",
            "picture.vox",
        ),
    ];
    for (file, bytes, told) in damaged {
        let path = folder.path().join(file);
        std::fs::write(&path, bytes).expect("the test owns the folder");
        let (before, at) = (ticks(&window), goal(&window, 0));
        drop_file(&mut window, path);
        let said = notices(&window);
        assert!(
            said.contains(told) && said.contains("expected"),
            "{file}: {said}"
        );
        assert_eq!(window.state().game.levels.len(), levels, "{file}");
        assert_eq!(screen(&window), Screen::Play, "{file}");
        assert!(ticks(&window) > before, "{file}: the round continues");
        assert_near(goal(&window, 0), at);
    }
}

#[test]
fn note_on_a_dropped_model_is_shown() {
    let folder = folder();
    let mut animated = std::fs::read(level_file(MODEL)).expect("the level is built in");
    // Repeats the model, without the palette at the end: a second frame.
    let frame = animated[20..animated.len() - 12 - 1024].to_vec();
    animated.extend(frame);
    let length = animated.len() as u32 - 20;
    animated[16..20].copy_from_slice(&length.to_le_bytes());
    let path = folder.path().join("moving.vox");
    std::fs::write(&path, animated).expect("the test owns the folder");
    let mut window = window(Files::nowhere());
    drop_file(&mut window, path);
    let said = notices(&window);
    assert!(said.contains("moving.vox is an animation"), "{said}");
    assert_eq!(screen(&window), Screen::Play);
}
