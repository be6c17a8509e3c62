//! Tests of every built-in level, and of invalid levels and replays.

use fuwafuwa::{Dim, Dim2, Dim3, DimVector, MotionType, Shape, Vec3};
use std::sync::Arc;
use tamaire_play::level::{NAMED, built_in};
use tamaire_play::replay::VERSION;
use tamaire_play::{Bot, BotKind, InputFrame, Level, Playback, Replay, ReplayError, Round};

#[test]
fn bodies_stay_whole_without_input_and_in_the_room_with_input() {
    for (id, _) in built_in() {
        match Level::open(id).unwrap().scene().dim {
            2 => stays_whole_and_in_the_room::<Dim2>(id, 180),
            _ => stays_whole_and_in_the_room::<Dim3>(id, 120),
        }
    }
}

#[test]
fn arena_is_closed_on_every_side() {
    for (id, _) in built_in() {
        match Level::open(id).unwrap().scene().dim {
            2 => is_closed::<Dim2>(id),
            _ => is_closed::<Dim3>(id),
        }
    }
}

/// Checks that rigid bodies cover all sides of the arena, so that nothing can leave it.
fn is_closed<D: Dim>(id: &str) {
    const STEPS: i32 = 20;
    let level = Arc::new(Level::open(id).unwrap());
    let [low, high] = level.arena();
    let round = Round::<D>::new(level);
    let bodies = round.world().rigid_bodies().map(|(_, body)| body);
    let walls = bodies.filter(|body| body.motion_type() == MotionType::Fixed);
    let walls: Vec<Shape<D>> = walls.map(|wall| wall.shape()).collect();
    let is_rigid = |at: Vec3| {
        let at = D::Vector::from_vec3(at);
        walls.iter().any(|wall| wall.distance(at).0 < 0.0)
    };
    let deep = if D::N == 3 { 0..=STEPS } else { 0..=0 };
    for (x, y, z) in
        deep.flat_map(|z| (0..=STEPS).flat_map(move |x| (0..=STEPS).map(move |y| (x, y, z))))
    {
        let steps = Vec3::from([x, y, z].map(|step| step as f32));
        let at = low + (high - low) * steps / STEPS as f32;
        for axis in 0..D::N {
            for (side, sign) in [(low, -1.0), (high, 1.0)] {
                let mut out = at;
                out[axis] = side[axis] + 0.001 * sign;
                assert!(is_rigid(out), "{id}: no rigid body at {out:?}");
            }
        }
    }
}

fn stays_whole_and_in_the_room<D: Dim>(id: &str, ticks: usize) {
    let level = Arc::new(Level::open(id).unwrap());
    let mut still = Round::<D>::new(level.clone());
    let mut wild = Round::<D>::new(level.clone());
    let mut bot = Bot::new(BotKind::Random, 7);
    for _ in 0..ticks {
        let report = still.step(InputFrame::default());
        assert_eq!(report.nodes_split, 0, "{id}");
        let frame = bot.frame(&wild);
        assert_eq!(wild.step(frame).quarantined, 0, "{id}");
    }
    assert!(still.progress().outcome.is_none(), "{id}");
    let [low, high] = level.arena();
    for (_, body) in wild.world().soft_bodies() {
        for piece in body.piece_views() {
            let mut inside = (0..D::N)
                .map(|axis| piece.centre[axis] > low[axis] && piece.centre[axis] < high[axis]);
            assert!(inside.all(|inside| inside), "{id}: {piece:?}");
        }
    }
}

/// Returns a replay of a round in which both hands move at random for `ticks` ticks.
fn played<D: Dim>(id: &str, ticks: usize) -> Replay {
    let mut round = Round::<D>::new(Arc::new(Level::open(id).unwrap()));
    let mut bot = Bot::new(BotKind::Random, 3);
    for _ in 0..ticks {
        let frame = bot.frame(&round);
        round.step(frame);
    }
    assert_eq!(round.hands().len(), 2);
    Replay::of(&round)
}

fn play(replay: Replay) -> Result<(), ReplayError> {
    let mut playback = Playback::new(Arc::new(replay))?;
    while !playback.is_over() {
        playback.step()?;
    }
    Ok(())
}

#[test]
fn replay_reproduces_the_round_and_detects_changes() {
    let replay = played::<Dim2>("classic", 130);
    let text = replay.text();
    let read = Replay::read(&text).unwrap();
    assert_eq!(read, replay);
    play(read).unwrap();

    let changed = |from: &str, to: &str| {
        assert!(text.contains(from), "{from}");
        Replay::read(&text.replacen(from, to, 1))
            .and_then(play)
            .unwrap_err()
    };
    let hash = format!("\"{}\"", replay.hashes[1]);
    let differs = changed(&hash, "\"0123456789abcdef\"");
    assert!(
        matches!(differs, ReplayError::Differs { second: 2 }),
        "{differs}"
    );
    let other = changed(&format!("version = {VERSION}"), "version = 99");
    assert!(
        matches!(other, ReplayError::Version { found: 99 }),
        "{other}"
    );
    let level = changed("drag = 1.0", "drag = 0.5");
    assert!(matches!(level, ReplayError::LevelChanged), "{level}");
    assert!(matches!(Replay::read("hello"), Err(ReplayError::Text(_))));
}

#[test]
fn replay_of_a_3d_level_reproduces_the_round() {
    let replay = played::<Dim3>("pudding", 70);
    let read = Replay::read(&replay.text()).unwrap();
    assert_eq!(read, replay);
    play(read).unwrap();
}

#[test]
fn replay_of_two_hands_is_small() {
    let mut round = Round::<Dim2>::new(Arc::new(Level::open("classic").unwrap()));
    let mut bot = Bot::new(BotKind::Random, 3);
    for _ in 0..60 {
        let frame = bot.frame(&round);
        round.step(frame);
    }
    let length = Replay::of(&round).text().len();
    assert!(length < 5_000 + 60 * 50, "{length} bytes for a second");
}

#[test]
fn invalid_level_is_reported_with_its_line() {
    let (_, classic) = NAMED[0];
    let nothing = |_: &str| Err(std::io::ErrorKind::NotFound.into());
    let refused = |text: &str| {
        let level = Level::read("mine.toml", text.as_bytes(), &nothing);
        level.unwrap_err().to_string()
    };
    let share = refused(&classic.replace("share = 0.6", "share = 1.6"));
    assert!(
        share.contains("line 11") && share.contains("expected above 0, up to 1"),
        "{share}"
    );
    let word = refused(&classic.replace("share = 0.6", "shares = 0.6"));
    assert!(
        word.contains("line 11") && word.contains("shares"),
        "{word}"
    );
    let none = refused(&classic.replace("[game]", "[gaem]"));
    assert!(none.contains("gaem"), "{none}");
    let no_game = refused(
        "dim = 2\n[[body]]\nshape = \"ball\"\nn = 8\n[[hand]]\nradius = 0.1\npath = [[0.0, 0.0, 0.0, 0.0]]\n",
    );
    assert!(no_game.contains("[game]"), "{no_game}");
    let unknown = Level::open("clasic").unwrap_err().to_string();
    assert!(unknown.contains("classic"), "{unknown}");
    let picture = Level::read("mine.png", b"not a picture", &nothing);
    let picture = picture.unwrap_err().to_string();
    assert!(picture.contains("mine.png"), "{picture}");
    for (bytes, found) in [
        (&b"\xff"[..], "an unknown type of file"),
        (b"", "an empty file"),
        (b"%PDF-1.7", "a PDF document"),
        (b"d\0i\0m\0 \0=\0 \x002\0", "a text in UTF-16, not in UTF-8"),
    ] {
        let other = Level::read("mine.toml", bytes, &nothing).unwrap_err();
        let expected = format!("mine.toml: expected a level, a picture or a model, found {found}");
        assert_eq!(other.to_string(), expected);
    }
}
