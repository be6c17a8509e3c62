use super::*;
use egui::Key;
use fuwafuwa::DEFAULT_TICK;
use sticks::{Device, DeviceInfo, Direction, Snapshot};

const HANDS: [Vec3; 2] = [Vec3::new(-1.0, 0.0, 0.0), Vec3::new(-1.0, 0.5, 0.0)];
const MANNER: InputMapping = InputMapping {
    sensitivity: 1.0,
    stick_sets_position: false,
    arena: [Vec3::new(-1.6, -1.0, 0.0), Vec3::new(1.6, 1.0, 0.0)],
    turn: None,
};
const PLACES: InputMapping = InputMapping {
    stick_sets_position: true,
    ..MANNER
};

/// Returns the goal of the first player in the next tick.
fn goal(players: &mut Players, devices: &Devices, manner: &InputMapping) -> Option<Vec3> {
    goals(players, devices, manner)[0]
}

fn goals(players: &mut Players, devices: &Devices, manner: &InputMapping) -> [Option<Vec3>; 2] {
    let frame = players.frame(
        devices,
        &Bindings::default(),
        manner,
        &hands(&HANDS),
        DEFAULT_TICK,
    );
    [frame.goal(0), frame.goal(1)]
}

/// Hands with a radius of 0.1 m, far from all bodies.
fn hands(targets: &[Vec3]) -> Hands<'_> {
    Hands {
        targets,
        radius: 0.1,
        distance_to_bodies: &|_| f32::INFINITY,
    }
}

/// Players whose hands follow a pointer at once.
fn picked_up() -> Players {
    Players {
        is_picked_up: [true; PLAYERS],
        ..Players::default()
    }
}

/// Creates a stick with this deflection to the right and upwards.
fn stick(id: u32, lean: [f32; 2]) -> Device {
    let mut stick = Device::at_rest(DeviceId(id), DeviceInfo::default(), 2, 4, 1);
    stick.axes = vec![lean[0], -lean[1]];
    stick
}

fn with_sticks(devices: Vec<Device>) -> Devices {
    let sticks = Snapshot { devices };
    Devices {
        sticks,
        ..Devices::default()
    }
}

fn assert_near(found: Option<Vec3>, expected: [f32; 2]) {
    let found = found.expect("a goal");
    let is_near = (0..2).all(|axis| (found[axis] - expected[axis]).abs() < 1e-3);
    assert!(is_near, "{found:?}, expected {expected:?}");
}

#[test]
fn mouse_position_is_kept_until_next_round() {
    let mut players = picked_up();
    let mut devices = Devices::default();
    assert_eq!(goal(&mut players, &devices, &MANNER), None);
    devices.pointer = Some(Vec3::new(0.7, -0.3, 0.0));
    assert_near(goal(&mut players, &devices, &MANNER), [0.7, -0.3]);
    devices.pointer = None;
    assert_near(goal(&mut players, &devices, &MANNER), [0.7, -0.3]);
    players.start();
    assert_eq!(goal(&mut players, &devices, &MANNER), None);
}

#[test]
fn keys_set_speed_and_diagonals_are_no_faster() {
    let step = PACE * DEFAULT_TICK;
    let held = |keys: &[Key]| Devices {
        keys: keys.iter().copied().collect(),
        ..Devices::default()
    };
    let of =
        |keys: &[Key], manner: &InputMapping| goal(&mut Players::default(), &held(keys), manner);
    assert_near(of(&[Key::D], &MANNER), [-1.0 + step, 0.0]);
    assert_near(of(&[Key::D, Key::ArrowRight], &MANNER), [-1.0 + step, 0.0]);
    assert_eq!(of(&[Key::A, Key::D], &MANNER), None);
    let side = step * 0.5_f32.sqrt();
    assert_near(of(&[Key::W, Key::A], &MANNER), [-1.0 - side, side]);
    let slowly = InputMapping {
        sensitivity: 0.5,
        ..MANNER
    };
    assert_near(of(&[Key::S], &slowly), [-1.0, -0.5 * step]);
    // The goal is clamped to the arena.
    let narrow = InputMapping {
        arena: [Vec3::new(-1.0, -1.0, 0.0), Vec3::new(1.0, 0.0, 0.0)],
        ..MANNER
    };
    assert_near(of(&[Key::W, Key::A], &narrow), [-1.0, 0.0]);
}

#[test]
fn stick_has_dead_zone_and_speed_grows_with_deflection() {
    let of = |lean| {
        goal(
            &mut Players::default(),
            &with_sticks(vec![stick(1, lean)]),
            &MANNER,
        )
    };
    assert_eq!(of([0.1, -0.1]), None);
    assert_eq!(of([f32::NAN, 1.0]), None);
    assert_near(of([1.0, 0.0]), [-1.0 + PACE * DEFAULT_TICK, 0.0]);
    let half = DEAD + 0.5 * (RIM - DEAD);
    assert_near(of([0.0, half]), [-1.0, 0.5 * PACE * DEFAULT_TICK]);
    let mut hat = stick(1, [0.0; 2]);
    hat.hats[0].button_mut(Direction::Down).press();
    let found = goal(&mut Players::default(), &with_sticks(vec![hat]), &MANNER);
    assert_near(found, [-1.0, -PACE * DEFAULT_TICK]);
}

#[test]
fn still_position_stick_leaves_goal_to_other_devices() {
    let mut players = picked_up();
    let mut devices = with_sticks(vec![stick(1, [0.0; 2]), stick(2, [0.0; 2])]);
    assert_eq!(goal(&mut players, &devices, &PLACES), None, "at rest");
    devices.sticks.devices[1] = stick(2, [1.0, 0.0]);
    assert_near(goal(&mut players, &devices, &PLACES), [1.6, 0.0]);
    devices.pointer = Some(Vec3::new(0.5, 0.5, 0.0));
    assert_near(goal(&mut players, &devices, &PLACES), [0.5, 0.5]);
    devices.pointer = None;
    assert_near(goal(&mut players, &devices, &PLACES), [0.5, 0.5]);
    devices.sticks.devices[1] = stick(2, [0.0, -1.0]);
    assert_near(goal(&mut players, &devices, &PLACES), [0.0, -1.0]);
    devices.sticks.devices[1] = stick(2, [0.0; 2]);
    assert_near(goal(&mut players, &devices, &PLACES), [0.0, 0.0]);
}

#[test]
fn away_in_space_is_away_from_camera_and_lift_raises_hand() {
    let manner = InputMapping {
        arena: [Vec3::new(-1.6, 0.0, -1.0), Vec3::new(1.6, 1.6, 1.0)],
        turn: Some(std::f32::consts::FRAC_PI_2),
        ..MANNER
    };
    let targets = [Vec3::new(0.0, 0.5, 0.0)];
    let goal = |devices: &Devices| {
        let bindings = Bindings::default();
        let frame = picked_up().frame(devices, &bindings, &manner, &hands(&targets), DEFAULT_TICK);
        frame.goal(0).expect("a goal")
    };
    let check = |found: Vec3, expected: [f32; 3]| {
        let is_near = found.abs_diff_eq(expected.into(), 1e-3);
        assert!(is_near, "{found:?}, expected {expected:?}");
    };
    let step = PACE * DEFAULT_TICK;
    // The camera is rotated by 90° to the right, so it looks to the left.
    check(
        goal(&with_sticks(vec![stick(1, [0.0, 1.0])])),
        [-step, 0.5, 0.0],
    );
    check(
        goal(&with_sticks(vec![stick(1, [1.0, 0.0])])),
        [0.0, 0.5, -step],
    );
    let keys = Devices {
        keys: [Key::Q].into(),
        ..Devices::default()
    };
    check(goal(&keys), [0.0, 0.5 + RISE * DEFAULT_TICK, 0.0]);
    let wheel = Devices {
        pointer: Some(Vec3::new(0.3, 0.5, -0.2)),
        lift: 5.0,
        ..Devices::default()
    };
    check(goal(&wheel), [0.3, 1.6, -0.2]);
}

#[test]
fn wanted_height_is_kept_when_goal_cannot_follow() {
    let manner = InputMapping {
        arena: [Vec3::new(-1.6, 0.0, -1.0), Vec3::new(1.6, 1.6, 1.0)],
        turn: Some(0.0),
        ..MANNER
    };
    // The body holds the hand down, and the target position may be only a limited distance from the hand.
    let here = Vec3::new(0.0, 0.5, 0.0);
    let mut players = picked_up();
    let mut goal = |devices: &Devices, manner: &InputMapping| {
        let frame = players.frame(
            devices,
            &Bindings::default(),
            manner,
            &hands(&[here]),
            DEFAULT_TICK,
        );
        frame.goal(0).expect("a goal")
    };
    let lift = |lift| Devices {
        lift,
        ..Devices::default()
    };
    let keys = |key| Devices {
        keys: [key].into(),
        ..Devices::default()
    };
    let assert_height = |found: Vec3, height: f32| {
        assert!(
            (found.y - height).abs() < 1e-3,
            "{found:?}, expected {height}"
        );
    };
    goal(&lift(0.5), &manner);
    assert_height(goal(&lift(0.3), &manner), 1.3);
    assert_height(goal(&keys(Key::D), &manner), 1.3);
    assert_height(goal(&with_sticks(vec![stick(1, [0.0, 1.0])]), &manner), 1.3);
    let places = InputMapping {
        stick_sets_position: true,
        ..manner
    };
    let pointing = with_sticks(vec![stick(1, [1.0, 0.0])]);
    assert_height(goal(&pointing, &places), 1.3);
    // Lifting never lowers the requested height. Lowering starts from the current target position, so that
    // excess lift need not be undone first.
    assert_height(goal(&keys(Key::Q), &manner), 1.3);
    assert_height(goal(&keys(Key::Z), &manner), 0.5 - RISE * DEFAULT_TICK);
    goal(&lift(9.0), &manner);
    assert_height(goal(&lift(-0.1), &manner), 0.4);
    assert_eq!(
        players.wanted(0).map(|goal| goal.x > 1.5),
        Some(true),
        "the position of the stick"
    );
}

#[test]
fn lift_has_no_effect_in_plane() {
    let devices = Devices {
        lift: 1.0,
        keys: [Key::Q].into(),
        ..Devices::default()
    };
    let mut players = Players::default();
    assert_eq!(goal(&mut players, &devices, &MANNER), None);
    assert_eq!(players.used[0], None);
}

#[test]
fn each_device_belongs_to_one_player() {
    let mut players = Players::default();
    let mut devices = with_sticks(vec![stick(1, [1.0, 0.0]), stick(2, [0.0; 2])]);
    assert_eq!(goals(&mut players, &devices, &MANNER)[1], None);
    players.join(InputSource::Stick(DeviceId(1)));
    let [first, second] = goals(&mut players, &devices, &MANNER);
    assert_near(first, [-1.0 + PACE * DEFAULT_TICK, 0.0]);
    assert_near(second, [-1.0 + PACE * DEFAULT_TICK, 0.5]);
    // A player who joins and gives no input stays at the start position of the level.
    players.join(InputSource::Keys);
    assert_near(goals(&mut players, &devices, &MANNER)[1], [-1.0, 0.5]);
    players.join(InputSource::Keys);
    assert_eq!(players.second(), None);
    players.join(InputSource::Stick(DeviceId(1)));
    devices.sticks.devices.remove(0);
    assert_eq!(goals(&mut players, &devices, &MANNER)[1], None);
    assert_eq!(players.second(), None, "it was unplugged");
    // In a level with a single hand, the second player has no hand, and so no target position is set.
    players.join(InputSource::Keys);
    let bindings = Bindings::default();
    let frame = players.frame(
        &devices,
        &bindings,
        &MANNER,
        &hands(&HANDS[..1]),
        DEFAULT_TICK,
    );
    assert_eq!(frame.goal(1), None);
}

#[test]
fn screen_buttons_belong_to_player_with_pointer() {
    let manner = InputMapping {
        turn: Some(0.0),
        ..MANNER
    };
    let mut players = Players::default();
    players.join(InputSource::Keys);
    let devices = Devices {
        pressed: [Action::Raise].into(),
        ..Devices::default()
    };
    let [first, second] = goals(&mut players, &devices, &manner);
    assert!(first.expect("it rises").y > HANDS[0].y);
    assert!(second.is_none_or(|stays| stays == HANDS[1]), "{second:?}");
}

#[test]
fn hand_glides_to_pointer_until_picked_up() {
    let mut players = Players::default();
    let mut here = HANDS[0];
    let mut devices = Devices {
        pointer: Some(Vec3::new(0.0, 0.0, 0.0)),
        ..Devices::default()
    };
    let mut follow = |players: &mut Players, devices: &Devices| {
        let targets = [here];
        let bindings = Bindings::default();
        let frame = players.frame(devices, &bindings, &MANNER, &hands(&targets), DEFAULT_TICK);
        let before = here;
        here = frame.goal(0).expect("a goal");
        (here - before).length()
    };
    // The mouse moved in the first tick only. The hand still arrives, 1 m away, in less than a second.
    let step = GLIDE * DEFAULT_TICK;
    let mut ticks = 0;
    while !players.is_picked_up(0) {
        let moved = follow(&mut players, &devices);
        assert!(moved < step + 1e-3 || players.is_picked_up(0), "{moved} m");
        devices.pointer = None;
        ticks += 1;
        assert!(ticks < 60, "the hand never arrives");
    }
    // From now on, the hand is wherever the pointer is.
    devices.pointer = Some(Vec3::new(1.0, 0.5, 0.0));
    assert!(follow(&mut players, &devices) > 1.0);
    players.start();
    devices.pointer = Some(Vec3::new(-1.0, 0.5, 0.0));
    assert!(follow(&mut players, &devices) < step + 1e-3, "a new round");
}

/// Lets a hand follow devices, and returns its goals. A body occupies x > -0.5.
fn follow(
    players: &mut Players,
    (devices, manner): (&Devices, &InputMapping),
    here: Vec3,
    ticks: usize,
) -> Vec<Vec3> {
    let wall = |at: Vec3| (-0.5 - at.x).abs();
    let mut goals = vec![here];
    for _ in 0..ticks {
        let surroundings = Hands {
            targets: &[goals[goals.len() - 1]],
            radius: 0.1,
            distance_to_bodies: &wall,
        };
        let bindings = Bindings::default();
        let frame = players.frame(devices, &bindings, manner, &surroundings, DEFAULT_TICK);
        goals.push(frame.goal(0).expect("a goal"));
    }
    goals
}

#[test]
fn hand_stops_before_body_until_picked_up() {
    let at = |position| Devices {
        pointer: Some(position),
        ..Devices::default()
    };
    let on_body = at(Vec3::new(0.3, 0.0, 0.0));
    let mut players = Players::default();
    let goals = follow(&mut players, (&on_body, &MANNER), HANDS[0], 120);
    let stopped = goals[120];
    assert!((-0.66..=-0.63 + 1e-3).contains(&stopped.x), "{stopped}");
    // The pointer touches the hand and may then push the body.
    let at_hand = at(stopped + Vec3::new(0.05, 0.0, 0.0));
    let goals = follow(&mut players, (&at_hand, &MANNER), stopped, 1);
    assert!(players.is_picked_up(0));
    let goals = follow(&mut players, (&on_body, &MANNER), goals[1], 1);
    assert_near(Some(goals[1]), [0.3, 0.0]);
}

#[test]
fn hand_of_stick_glides_on_into_body() {
    let deflected = with_sticks(vec![stick(1, [0.2, 0.0])]);
    let mut players = Players::default();
    let goals = follow(&mut players, (&deflected, &PLACES), HANDS[0], 120);
    let steps = goals.windows(2).map(|pair| (pair[1] - pair[0]).length());
    // The last step is up to the radius at which the hand is picked up.
    let glide = GLIDE * DEFAULT_TICK + 1e-3;
    assert!(steps.filter(|&step| step > glide).count() <= 1, "{goals:?}");
    assert!(goals[1].x < -0.5 && goals[120].x > 0.0, "{goals:?}");
    assert!(players.is_picked_up(0));
}

#[test]
fn pointer_does_not_take_hand_from_keys() {
    let mut players = Players::default();
    let bindings = Bindings::default();
    let mut follow = |devices: &Devices, here: Vec3| {
        let targets = [here];
        let frame = players.frame(devices, &bindings, &MANNER, &hands(&targets), DEFAULT_TICK);
        frame.goal(0).expect("a goal")
    };
    let key = Devices {
        keys: [Key::D].into(),
        ..Devices::default()
    };
    let here = follow(&key, HANDS[0]);
    assert!(here.x > HANDS[0].x);
    let bumped = Devices {
        pointer: Some(Vec3::new(1.0, 0.8, 0.0)),
        ..Devices::default()
    };
    let there = follow(&bumped, here);
    assert!((there - here).length() < GLIDE * DEFAULT_TICK + 1e-3);
    let back = follow(&key, there);
    let aside = follow(&Devices::default(), back);
    assert_eq!(aside, back, "a key ends the gliding");
}

#[test]
fn arrows_and_letters_move_two_hands() {
    let mut players = Players::default();
    players.join(InputSource::LetterKeys);
    let devices = Devices {
        keys: [Key::ArrowRight, Key::W].into(),
        ..Devices::default()
    };
    let step = PACE * DEFAULT_TICK;
    let [first, second] = goals(&mut players, &devices, &MANNER);
    assert_near(first, [-1.0 + step, 0.0]);
    assert_near(second, [-1.0, 0.5 + step]);
    // Alone again, both halves of the keyboard move the first hand.
    players.join(InputSource::Keys);
    assert_eq!(players.second(), None);
    let side = step * 0.5_f32.sqrt();
    assert_near(
        goal(&mut Players::default(), &devices, &MANNER),
        [-1.0 + side, side],
    );
}

#[test]
fn hand_glides_around_body() {
    // A ball with a radius of 0.4 m around the origin reaches across the straight way.
    let ball = |at: Vec3| (at.length() - 0.4).abs();
    let devices = Devices {
        pointer: Some(Vec3::new(0.3, 0.6, 0.0)),
        ..Devices::default()
    };
    let mut players = Players::default();
    let mut here = HANDS[0];
    for tick in 0.. {
        let surroundings = Hands {
            targets: &[here],
            radius: 0.1,
            distance_to_bodies: &ball,
        };
        let bindings = Bindings::default();
        let frame = players.frame(&devices, &bindings, &MANNER, &surroundings, DEFAULT_TICK);
        if players.is_picked_up(0) {
            break;
        }
        here = frame.goal(0).expect("a goal");
        assert!(here.length() > 0.4 + 0.1, "{here}");
        assert!(tick < 240, "the hand stays at {here}");
    }
}

#[test]
fn whole_keyboard_moves_the_only_hand_of_a_level() {
    let step = PACE * DEFAULT_TICK;
    for second in [InputSource::Keys, InputSource::LetterKeys] {
        for key in [Key::D, Key::ArrowRight] {
            let mut players = Players::default();
            players.join(second);
            let devices = Devices {
                keys: [key].into_iter().collect(),
                ..Devices::default()
            };
            let targets = [HANDS[0]];
            let hands = hands(&targets);
            let bindings = Bindings::default();
            let frame = players.frame(&devices, &bindings, &MANNER, &hands, DEFAULT_TICK);
            assert_near(frame.goal(0), [-1.0 + step, 0.0]);
            assert_eq!(players.second(), Some(second), "the player stays");
        }
    }
}

#[test]
fn gliding_hand_far_from_bodies_seldom_looks_at_them() {
    let count = std::cell::Cell::new(0);
    // A wall of bodies at x = 0.
    let distance = |position: Vec3| {
        count.set(count.get() + 1);
        -position.x
    };
    let mut players = Players::default();
    let devices = Devices {
        pointer: Some(Vec3::new(1.0, 0.0, 0.0)),
        ..Devices::default()
    };
    let mut here = HANDS[0];
    for _ in 0..120 {
        let targets = [here];
        let hands = Hands {
            targets: &targets,
            radius: 0.1,
            distance_to_bodies: &distance,
        };
        let bindings = Bindings::default();
        let frame = players.frame(&devices, &bindings, &MANNER, &hands, DEFAULT_TICK);
        here = frame.goal(0).expect("the pointer sets a goal");
        assert!(here.x <= -0.1 - GAP + 1e-4, "{here}");
    }
    assert!(here.x > -0.3, "the hand has come near: {here}");
    assert!(count.get() < 8 * 120 / 2, "{} looks", count.get());
}
