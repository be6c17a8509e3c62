//! Playgrounds: what players add and change happens, comes back when time runs back, and is part of replays and links.

use fuwafuwa::{Dim, Vec3};
use fuwafuwa_scenes::scene::Form;
use std::sync::Arc;
use tamaire_play::playground::{Change, ChangeError, MOST_NODES, Stuff, Tool};
use tamaire_play::{AnyRound, InputFrame, Level, Link, Playback, Replay, Rewind, Round};

const FORMS: [Form; 5] = [Form::Ball, Form::Box, Form::Ring, Form::Heart, Form::Flower];

fn begin(id: &str) -> AnyRound {
    AnyRound::new(Arc::new(Level::open(id).unwrap()))
}

fn bodies(round: &AnyRound) -> usize {
    match round {
        AnyRound::Plane(round) => round.world().soft_bodies().count(),
        AnyRound::Space(round) => round.world().soft_bodies().count(),
    }
}

fn wait(round: &mut AnyRound, ticks: usize) {
    for _ in 0..ticks {
        round.step(InputFrame::default());
    }
}

/// Moves the hand to a position within some ticks.
fn go(round: &mut AnyRound, to: Vec3, ticks: usize) {
    for _ in 0..ticks {
        round.step(InputFrame::towards(to));
    }
}

/// Verifies that the replay of a round, and its link, play to the same end.
fn verify(round: &AnyRound) {
    let text = round.replay().text();
    let Link::Round(sent) = Link::read(&round.replay().link().unwrap()).unwrap() else {
        panic!("a round was sent");
    };
    for replay in [Replay::read(&text).unwrap(), *sent] {
        let mut playback = Playback::new(Arc::new(replay)).unwrap();
        while !playback.is_over() {
            playback.step().unwrap();
        }
        assert_eq!(playback.round().hash(), round.hash());
    }
}

#[test]
fn every_shape_of_every_material_can_be_added_until_the_room_is_full() {
    for id in ["sandbox", "sandbox-3d"] {
        let mut round = begin(id);
        round.change(Change::Clear).unwrap();
        wait(&mut round, 1);
        assert_eq!(bodies(&round), 0);
        for form in FORMS {
            for stuff in Stuff::ALL {
                round.change(Change::Clear).unwrap();
                round.change(Change::add(form, stuff, Vec3::ZERO)).unwrap();
                wait(&mut round, 2);
                assert_eq!(bodies(&round), 1, "{id}, {form:?}, {stuff:?}");
            }
        }
        let add =
            |round: &mut AnyRound| round.change(Change::add(Form::Ball, Stuff::Stone, Vec3::ZERO));
        let mut count = 0;
        let refused = loop {
            match add(&mut round) {
                Ok(()) => count += 1,
                Err(refused) => break refused,
            }
        };
        assert_eq!(refused, ChangeError::Full);
        assert!(count >= 4, "{count}");
        wait(&mut round, 1);
        assert_eq!(bodies(&round), 1 + count);
        assert!(round.nodes() <= MOST_NODES);
    }
    let mut classic = begin("classic");
    assert_eq!(
        classic.change(Change::Clear),
        Err(ChangeError::NoPlayground)
    );
}

/// Returns a playground with a single body in the middle and without gravity.
fn with_one_body(id: &str, stuff: Stuff) -> AnyRound {
    let mut round = begin(id);
    for change in [
        Change::Clear,
        Change::Gravity(0),
        Change::add(Form::Ball, stuff, middle(&round)),
    ] {
        round.change(change).unwrap();
    }
    wait(&mut round, 1);
    round
}

fn middle(round: &AnyRound) -> Vec3 {
    let [low, high] = round.level().arena();
    0.5 * (low + high)
}

fn centre(round: &AnyRound) -> Vec3 {
    let views = match round {
        AnyRound::Plane(round) => round
            .world()
            .soft_bodies()
            .flat_map(|(_, body)| body.piece_views())
            .collect::<Vec<_>>(),
        AnyRound::Space(round) => round
            .world()
            .soft_bodies()
            .flat_map(|(_, body)| body.piece_views())
            .collect(),
    };
    let largest = views.into_iter().max_by(|a, b| a.mass.total_cmp(&b.mass));
    largest.unwrap().centre
}

/// Returns the height of the single body of a playground [m].
fn height(round: &AnyRound) -> f32 {
    fn extent<D: Dim>(round: &Round<D>) -> f32 {
        let bodies = round.world().soft_bodies();
        let nodes = bodies.flat_map(|(_, body)| body.positions());
        let heights = nodes.map(|node| node.xyz().y);
        let bounds = [f32::INFINITY, f32::NEG_INFINITY];
        let [low, high] = heights.fold(bounds, |[low, high], y| [low.min(y), high.max(y)]);
        high - low
    }
    match round {
        AnyRound::Plane(round) => extent(round),
        AnyRound::Space(round) => extent(round),
    }
}

/// Returns a playground with a box that lies on the floor, without air.
fn with_lying_box(id: &str, stuff: Stuff, gravity: f32) -> AnyRound {
    let mut round = begin(id);
    let [low, _] = round.level().arena();
    let mut at = middle(&round);
    at.y = low.y + 0.25;
    for change in [
        Change::Clear,
        Change::Air(0),
        Change::Gravity((2.0 * gravity) as u8),
        Change::add(Form::Box, stuff, at),
    ] {
        round.change(change).unwrap();
    }
    round
}

/// Returns how far a box has sunk under its own weight after 0.3 s and after 10 s [m].
fn sag(id: &str, stuff: Stuff) -> [f32; 2] {
    let mut round = with_lying_box(id, stuff, 1.0);
    wait(&mut round, 1);
    let full = height(&round);
    [18, 582].map(|ticks| {
        wait(&mut round, ticks);
        full - height(&round)
    })
}

/// Returns the greatest rate of change of the height of a box [m/s], from 2 s to 2.5 s after it was laid on the floor.
fn trembling(id: &str, stuff: Stuff) -> f32 {
    let mut round = with_lying_box(id, stuff, 4.0);
    wait(&mut round, 120);
    let mut last = height(&round);
    let mut speed = || {
        wait(&mut round, 1);
        let passed = last;
        last = height(&round);
        60.0 * (last - passed).abs()
    };
    (0..30).map(|_| speed()).fold(0.0, f32::max)
}

/// A column of height h sinks by ρ g h² / 2 E at rest, a little less on a floor that holds its foot. At first, dough is nine
/// times as stiff.
#[test]
fn dough_creeps_under_its_own_weight() {
    let at_rest = 100.0 * 1.0 * 0.5 * 0.5 / (2.0 * 400.0);
    for id in ["sandbox", "sandbox-3d"] {
        let [early, late] = sag(id, Stuff::Dough).map(|sag| sag / at_rest);
        assert!(
            early < 0.45 && (0.65..1.0).contains(&late),
            "{id}: {early}, {late}"
        );
    }
}

#[test]
fn jelly_trembles_longest() {
    for id in ["sandbox", "sandbox-3d"] {
        let jelly = trembling(id, Stuff::Jelly);
        for (stuff, least) in [
            (Stuff::Rubber, 1.4),
            (Stuff::Biscuit, 3.0),
            (Stuff::Dough, 3.0),
        ] {
            let other = trembling(id, stuff);
            assert!(jelly > least * other, "{id}, {stuff:?}: {jelly}, {other}");
        }
    }
}

#[test]
fn grab_carries_a_body_and_lets_it_go() {
    for id in ["sandbox", "sandbox-3d"] {
        let mut round = with_one_body(id, Stuff::Rubber);
        let from = centre(&round);
        round.change(Change::Tool(Tool::Grab)).unwrap();
        go(&mut round, from, 90);
        assert!(
            (centre(&round) - from).length() < 0.02,
            "{id}: the hand passes through"
        );
        round.change(Change::Press(true)).unwrap();
        go(&mut round, from + 0.5 * Vec3::X, 120);
        let carried = centre(&round);
        assert!(
            (carried - from - 0.5 * Vec3::X).length() < 0.1,
            "{id}: {carried}"
        );
        round.change(Change::Press(false)).unwrap();
        go(&mut round, from, 120);
        assert!((centre(&round) - carried).length() < 0.15, "{id}");
        verify(&round);
    }
}

#[test]
fn knife_cuts_a_body_in_two_while_it_is_pressed() {
    for id in ["sandbox", "sandbox-3d"] {
        let mut round = with_one_body(id, Stuff::Rubber);
        let at = centre(&round);
        round.change(Change::Tool(Tool::Knife)).unwrap();
        let [left, right] = [at - 0.45 * Vec3::X, at + 0.45 * Vec3::X];
        go(&mut round, left, 120);
        go(&mut round, right, 60);
        assert_eq!(round.progress().pieces, 1, "{id}: not pressed");
        round.change(Change::Press(true)).unwrap();
        go(&mut round, left, 60);
        assert_eq!(bodies(&round), 1);
        assert!(round.progress().pieces >= 2, "{id}");
        verify(&round);
    }
}

#[test]
fn pin_holds_a_body_up_against_gravity() {
    for id in ["sandbox", "sandbox-3d"] {
        let mut round = with_one_body(id, Stuff::Rubber);
        let at = centre(&round);
        round.change(Change::Tool(Tool::Pin)).unwrap();
        go(&mut round, at, 120);
        round.change(Change::Press(true)).unwrap();
        round.change(Change::Gravity(20)).unwrap();
        wait(&mut round, 120);
        assert!(
            (centre(&round) - at).length() < 0.1,
            "{id}: {}",
            centre(&round)
        );
        // Without the pin it falls.
        let mut falls = with_one_body(id, Stuff::Rubber);
        falls.change(Change::Gravity(20)).unwrap();
        wait(&mut falls, 120);
        assert!(centre(&falls).y < at.y - 0.2, "{id}");
        verify(&round);
    }
}

#[test]
fn pins_are_refused_when_there_are_too_many() {
    let mut round = with_one_body("sandbox", Stuff::Rubber);
    round.change(Change::Tool(Tool::Pin)).unwrap();
    let at = centre(&round);
    go(&mut round, at, 60);
    let mut pins = 0;
    let refused = loop {
        match round.change(Change::Press(true)) {
            Ok(()) => pins += 1,
            Err(refused) => break refused,
        }
        round.step(InputFrame::default());
        assert!(pins < 1000, "pins have a limit");
    };
    assert_eq!((refused, pins), (ChangeError::TooManyPins, 200));
}

#[test]
fn dragging_a_slider_in_a_pause_is_one_change() {
    let mut round = begin("sandbox");
    for tenths in 0..50 {
        round.change(Change::Air(tenths)).unwrap();
    }
    wait(&mut round, 1);
    assert_eq!(round.changes().len(), 1);
    assert_eq!(round.gravity_and_air()[1], 4.9);
    verify(&round);
}

#[test]
fn hand_grows_and_air_brakes() {
    let mut round = begin("sandbox");
    round.change(Change::HandSize(25)).unwrap();
    wait(&mut round, 1);
    assert!((round.hands()[0].radius - 0.25).abs() < 1e-6);
    let speed = |air: u8| {
        let mut round = with_one_body("sandbox", Stuff::Rubber);
        round.change(Change::Air(air)).unwrap();
        round.change(Change::Gravity(4)).unwrap();
        let from = centre(&round).y;
        wait(&mut round, 30);
        from - centre(&round).y
    };
    assert!(speed(50) < 0.7 * speed(0), "{} {}", speed(50), speed(0));
}

/// Makes random changes and movements, and returns the hash after each tick.
fn play_at_random(
    round: &mut AnyRound,
    rewind: &mut Rewind,
    random: &mut fastrand::Rng,
    ticks: usize,
    hashes: &mut Vec<u64>,
) {
    for _ in 0..ticks {
        if random.u8(..) < 12 {
            let at = Vec3::new(random.f32() - 0.5, 0.8 * random.f32(), 0.0);
            let change = match random.u8(0..7) {
                0 => Change::add(
                    FORMS[random.usize(0..5)],
                    Stuff::ALL[random.usize(..Stuff::ALL.len())],
                    at,
                ),
                1 => Change::Gravity(random.u8(..)),
                2 => Change::Air(random.u8(..)),
                3 => Change::HandSize(random.u8(..)),
                4 => Change::Tool(
                    [Tool::Push, Tool::Grab, Tool::Knife, Tool::Pin][random.usize(0..4)],
                ),
                5 if random.u8(..) < 60 => Change::Clear,
                _ => Change::Press(random.bool()),
            };
            // A full room refuses a body.
            let _made = round.change(change);
        }
        let to = Vec3::new(
            2.0 * random.f32() - 1.0,
            random.f32() - 0.5,
            random.f32() - 0.5,
        );
        round.step(InputFrame::towards(to));
        rewind.note(round);
        hashes.truncate(round.ticks() as usize);
        hashes.push(round.hash());
    }
}

#[test]
fn changes_come_back_when_time_runs_back_and_are_in_the_replay() {
    for (id, seed, rounds) in [("sandbox", 1, 4), ("sandbox", 2, 4), ("sandbox-3d", 3, 2)] {
        let mut random = fastrand::Rng::with_seed(seed);
        let mut round = begin(id);
        let mut rewind = Rewind::new(&round);
        let mut hashes = vec![round.hash()];
        for _ in 0..rounds {
            play_at_random(&mut round, &mut rewind, &mut random, 80, &mut hashes);
            let to = round.ticks().saturating_sub(random.u64(5..50));
            rewind.begin(&round);
            round.count_rewind();
            while round.ticks() > to && rewind.left(&round) > 0 {
                while !rewind.is_ready() {
                    rewind.prepare(&round);
                }
                rewind.back(&mut round);
                assert_eq!(
                    round.hash(),
                    hashes[round.ticks() as usize],
                    "{id}, seed {seed}"
                );
            }
            rewind.end();
        }
        // A change after the last tick is not part of the replay.
        round.change(Change::Clear).unwrap();
        verify(&round);
    }
}

#[test]
fn changes_in_a_level_with_a_basket_or_too_many_at_once_are_no_replay() {
    let mut round = begin("sandbox");
    for _ in 0..40 {
        // More than the limit is refused.
        let _made = round.change(Change::Press(false));
    }
    assert_eq!(round.changes().len(), 32);
    assert_eq!(round.change(Change::Clear), Err(ChangeError::TooMany));
    wait(&mut round, 5);
    verify(&round);
    let genuine = round.replay();
    let refused = |replay: &Replay| Replay::read(&replay.text()).unwrap_err().to_string();

    let mut crowded = genuine.clone();
    crowded.changes.push(crowded.changes[0]);
    assert!(refused(&crowded).contains("expected at most 32 between two ticks"));

    let mut classic = begin("classic");
    wait(&mut classic, 5);
    let mut forged = classic.replay();
    forged.changes = genuine.changes;
    assert!(refused(&forged).contains("expected none in a level with a basket"));
}

#[test]
fn cleared_room_has_space_at_once() {
    let mut round = begin("sandbox");
    let add = |round: &mut AnyRound| round.change(Change::add(Form::Box, Stuff::Stone, Vec3::ZERO));
    while add(&mut round).is_ok() {
        wait(&mut round, 1);
    }
    round.change(Change::Clear).unwrap();
    add(&mut round).unwrap();
    wait(&mut round, 1);
    assert_eq!(bodies(&round), 1);
}

#[test]
fn nothing_tears_in_an_unbreakable_playground() {
    let level = Level::open("sandbox").unwrap();
    let level = level
        .assisted(&[tamaire_play::Assist::Unbreakable].into())
        .unwrap();
    let mut round = AnyRound::new(Arc::new(level));
    let at = middle(&round);
    for change in [
        Change::Clear,
        Change::Gravity(0),
        Change::add(Form::Ball, Stuff::Biscuit, at),
    ] {
        round.change(change).unwrap();
    }
    round.change(Change::Tool(Tool::Knife)).unwrap();
    go(&mut round, at - 0.45 * Vec3::X, 120);
    round.change(Change::Press(true)).unwrap();
    go(&mut round, at + 0.45 * Vec3::X, 60);
    round.change(Change::Tool(Tool::Push)).unwrap();
    for k in 0..60 {
        go(&mut round, at + [-0.5, 0.5][k % 2] * Vec3::X, 15);
    }
    assert_eq!(round.progress().pieces, 1);
}

#[test]
fn first_player_stays_first_when_the_hand_grows() {
    let mut round = begin("sandbox");
    round.change(Change::HandSize(20)).unwrap();
    let both = |round: &AnyRound| {
        let starts = [0, 1].map(|player| round.start(player));
        InputFrame::towards(starts[0]).with(1, starts[1])
    };
    let frame = both(&round);
    round.step(frame);
    round.change(Change::HandSize(5)).unwrap();
    round.step(frame);
    let AnyRound::Plane(plane) = &round else {
        panic!("the level is in 2D");
    };
    let shown: Vec<f32> = fuwafuwa::inspect::hands(plane.world())
        .map(|(_, hand)| hand.local_shape().inradius())
        .collect();
    assert_eq!(shown.len(), 2);
    assert!(
        (shown[0] - 0.05).abs() < 1e-6 && shown[1] > 0.06,
        "{shown:?}"
    );
}
