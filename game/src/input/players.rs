//! Who plays which hand with which device, and where they want it to be.

use super::{Action, Bindings};
use egui::{Key, Vec2};
use fuwafuwa::Vector;
use fuwafuwa::vector::plus;
use std::collections::{BTreeMap, BTreeSet};
use sticks::{Device, DeviceId, Snapshot};
use tamaire_play::{InputFrame, PLAYERS};

/// A stick that leans less than this does nothing, and one that leans more than `RIM` leans fully.
const DEAD: f32 = 0.15;
const RIM: f32 = 0.95;
/// A stick that moves by less than this does not move.
const NOISE: f32 = 0.01;
/// How fast a key or a stick that leans fully moves the goal at the usual sensitivity [m/s].
const PACE: f32 = 2.0;
/// How fast it rises in space [m/s].
const RISE: f32 = 1.2;

/// A place at the table: what a player holds.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum Seat {
    /// Mouse or touch.
    Pointer,
    /// Keys.
    Keys,
    /// A stick or pad.
    Stick(DeviceId),
}

/// What the devices say at a moment.
#[derive(Clone, Debug, Default)]
pub struct Devices {
    /// Where the mouse or a finger points in the world [m], when it moved or is down.
    pub pointer: Option<Vector>,
    /// Keys that are held.
    pub keys: BTreeSet<Key>,
    /// How far the wheel was turned, for the hand to rise in space [m].
    pub lift: f32,
    /// Sticks and pads.
    pub sticks: Snapshot,
    /// Those of them that push back. They have no spring to the middle, so they point at places.
    pub pushing: BTreeSet<DeviceId>,
}

/// Who plays, and where they want their hands to be.
#[derive(Clone, Debug, Default)]
pub struct Players {
    /// What the second player holds, while there is one; the first has all the rest.
    second: Option<Seat>,
    /// Where each wants to be [m].
    goals: [Option<Vector>; PLAYERS],
    /// How sticks leaned in the last tick. One that points at a place does so when it moves; while
    /// it is still, be it at rest, mouse and keys have their say.
    leans: BTreeMap<DeviceId, [f32; 2]>,
    /// With what each moved the hand last, and how long ago [s].
    used: [Option<Seat>; PLAYERS],
    rested: [f32; PLAYERS],
}

/// How the devices of a player are taken.
#[derive(Copy, Clone, Debug)]
pub struct Manner {
    /// 1 = usual.
    pub sensitivity: f32,
    /// Whether a stick points at a place in the arena, instead of saying how fast to go.
    pub stick_places: bool,
    /// Low and high corner of where goals may be [m].
    pub arena: [Vector; 2],
    /// In space by how much the camera went around to the right [rad]: what is away from the player goes along the floor,
    /// away from the camera.
    pub turn: Option<f32>,
}

impl Manner {
    /// Which way in the world it is when somebody leans: to the right, and away.
    fn along(&self, lean: Vec2) -> Vector {
        let Some(turn) = self.turn else {
            return [lean.x, lean.y, 0.0];
        };
        let (sin, cos) = turn.sin_cos();
        [
            cos * lean.x - sin * lean.y,
            0.0,
            -sin * lean.x - cos * lean.y,
        ]
    }

    /// The nearest place in the arena. A level in the plane says nothing about the third axis.
    fn within(&self, mut place: Vector) -> Vector {
        let [low, high] = self.arena;
        let axes = if self.turn.is_some() { 3 } else { 2 };
        for axis in 0..axes {
            place[axis] = place[axis].clamp(low[axis], high[axis]);
        }
        place
    }

    /// The place in the arena at which a stick points, as high as another [m].
    fn place_of(&self, stick: [f32; 2], here: Vector) -> Vector {
        let [low, high] = self.arena;
        let way = self.along(Vec2::from(stick));
        let mut place = [0, 1, 2].map(|axis: usize| {
            0.5 * (low[axis] + high[axis]) + 0.5 * way[axis] * (high[axis] - low[axis])
        });
        if self.turn.is_some() {
            place[1] = here[1];
        }
        place
    }
}

impl Players {
    /// What the second player holds.
    pub fn second(&self) -> Option<Seat> {
        self.second
    }

    /// The stick or pad with which a player moved the hand last, unless it was something else. Who has several feels one.
    pub fn held(&self, player: usize) -> Option<DeviceId> {
        match self.used[player] {
            Some(Seat::Stick(id)) => Some(id),
            _ => None,
        }
    }

    /// For how long a player has left the hand alone [s].
    pub fn rested(&self, player: usize) -> f32 {
        self.rested[player]
    }

    /// A device asks to join, or to leave again.
    pub fn join(&mut self, seat: Seat) {
        self.second = match self.second {
            Some(taken) if taken == seat => None,
            // The mouse cannot press a button that the keyboard has: a keyboard that joins twice
            // leaves, and one that is alone keeps the mouse for the first player.
            _ => Some(seat),
        };
        self.goals[1] = None;
        self.used = [self.used[0].filter(|used| *used != seat), self.second];
    }

    /// A new round: everybody wants to be where the hand is.
    pub fn start(&mut self) {
        // A stick that leans from before means nothing until it moves.
        *self = Self {
            second: self.second,
            leans: std::mem::take(&mut self.leans),
            ..Self::default()
        };
    }

    /// What they want in the next tick, `seconds` long; `hands` are where the hands' goals are now,
    /// or where they will come in [m].
    pub fn frame(
        &mut self,
        devices: &Devices,
        bindings: &Bindings,
        manner: &Manner,
        hands: &[Vector],
        seconds: f32,
    ) -> InputFrame {
        if let Some(Seat::Stick(id)) = self.second
            && devices.sticks.device(id).is_none()
        {
            self.second = None;
            self.used[1] = None;
        }
        let is_here = |id: &DeviceId| devices.sticks.device(*id).is_some();
        self.leans.retain(|id, _| is_here(id));
        let mut frame = InputFrame::default();
        for player in 0..PLAYERS {
            if player == 1 && self.second.is_none() {
                self.goals[1] = None;
                continue;
            }
            // A level may have one hand only.
            let Some(&here) = hands.get(player) else {
                continue;
            };
            self.move_goal(player, devices, bindings, manner, here, seconds);
            if let Some(goal) = self.goals[player].or((player == 1).then_some(here)) {
                frame = frame.with(player, goal);
            }
        }
        frame
    }

    fn move_goal(
        &mut self,
        player: usize,
        devices: &Devices,
        bindings: &Bindings,
        manner: &Manner,
        here: Vector,
        seconds: f32,
    ) {
        self.rested[player] += seconds;
        let holds = |seat: Seat| match player {
            0 => self.second != Some(seat),
            _ => self.second == Some(seat),
        };
        let (mut lean, mut lift, mut wheel) = (Vec2::ZERO, 0.0, 0.0);
        let mut place = None;
        if holds(Seat::Keys) {
            let means = |action| move |&key| bindings.of_key(key) == Some(action);
            let held = |action| devices.keys.iter().any(means(action));
            let (keys, rise) = (direction(held), opposed(held, Action::Raise, Action::Lower));
            if keys != Vec2::ZERO || rise != 0.0 {
                self.used[player] = Some(Seat::Keys);
            }
            lean += keys;
            lift += rise;
        }
        let all = devices.sticks.devices.iter();
        for device in all.filter(|device| holds(Seat::Stick(device.id))) {
            let stick = sticks::radial_dead_zone(device.aim(), DEAD, RIM);
            let before = self.leans.entry(device.id).or_default();
            let moved = (Vec2::from(stick) - Vec2::from(*before)).length() > NOISE;
            if moved || stick == [0.0; 2] {
                *before = stick;
            }
            let pushes_back = devices.pushing.contains(&device.id);
            if !manner.stick_places && !pushes_back {
                lean += Vec2::from(stick);
            } else if moved || self.used[player] == Some(Seat::Stick(device.id)) {
                place = Some(manner.place_of(stick, here));
            }
            let held: Vec<Action> = device
                .controls()
                .filter(|(_, button)| button.down)
                .filter_map(|(control, _)| bindings.of_button(control))
                .collect();
            let means = |action| held.contains(&action);
            let rise = match manner.turn {
                Some(_) => opposed(means, Action::Raise, Action::Lower) + rise_of(device),
                None => 0.0,
            };
            let hat = direction(means);
            lean += hat;
            lift += rise;
            // One that pushes back stays where it is put, in a hand or not.
            let leans = stick != [0.0; 2] && !pushes_back;
            if moved || leans || hat != Vec2::ZERO || rise != 0.0 {
                self.used[player] = Some(Seat::Stick(device.id));
                self.rested[player] = 0.0;
            }
        }
        if holds(Seat::Pointer) && (devices.pointer.is_some() || devices.lift != 0.0) {
            place = devices.pointer.or(place);
            wheel = devices.lift;
            self.used[player] = Some(Seat::Pointer);
        }
        if let Some(place) = place {
            self.goals[player] = Some(place);
        }
        if lean != Vec2::ZERO {
            // From where the goal is now: what pushes in vain winds nothing up.
            let step = lean * (1.0 / lean.length().max(1.0)) * PACE * manner.sensitivity * seconds;
            self.goals[player] = Some(manner.within(plus(here, manner.along(step))));
        }
        if manner.turn.is_some() && (lift != 0.0 || wheel != 0.0) {
            let mut goal = self.goals[player].unwrap_or(here);
            goal[1] = here[1] + wheel + lift.clamp(-1.0, 1.0) * RISE * manner.sensitivity * seconds;
            self.goals[player] = Some(manner.within(goal));
        }
    }
}

/// How far the triggers of a pad are pulled, or its right stick leans, for the hand to rise.
fn rise_of(device: &Device) -> f32 {
    let Some(pad) = &device.pad else {
        return 0.0;
    };
    let [_, up] = sticks::radial_dead_zone(pad.right, DEAD, RIM);
    let [[left, _], [right, _]] = pad
        .triggers
        .map(|pull| sticks::radial_dead_zone([pull, 0.0], DEAD, RIM));
    up + right - left
}

/// 1, -1 or 0.
fn opposed(held: impl Fn(Action) -> bool, more: Action, less: Action) -> f32 {
    f32::from(i8::from(held(more)) - i8::from(held(less)))
}

/// The way in which the four ways that are held lead together.
fn direction(held: impl Fn(Action) -> bool) -> Vec2 {
    Vec2::new(
        opposed(&held, Action::Right, Action::Left),
        opposed(&held, Action::Up, Action::Down),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use fuwafuwa::world::TICK;
    use sticks::{About, Device, Direction};

    const HANDS: [Vector; 2] = [[-1.0, 0.0, 0.0], [-1.0, 0.5, 0.0]];
    const MANNER: Manner = Manner {
        sensitivity: 1.0,
        stick_places: false,
        arena: [[-1.6, -1.0, 0.0], [1.6, 1.0, 0.0]],
        turn: None,
    };
    const PLACES: Manner = Manner {
        stick_places: true,
        ..MANNER
    };

    /// What the first player wants next.
    fn goal(players: &mut Players, devices: &Devices, manner: &Manner) -> Option<Vector> {
        goals(players, devices, manner)[0]
    }

    fn goals(players: &mut Players, devices: &Devices, manner: &Manner) -> [Option<Vector>; 2] {
        let frame = players.frame(devices, &Bindings::default(), manner, &HANDS, TICK);
        [frame.goal(0), frame.goal(1)]
    }

    /// A stick that leans so far to the right and upwards.
    fn stick(id: u32, lean: [f32; 2]) -> Device {
        let about = About {
            name: String::new(),
            guid: String::new(),
        };
        let mut stick = Device::at_rest(DeviceId(id), about, 2, 4, 1);
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

    fn assert_near(found: Option<Vector>, expected: [f32; 2]) {
        let found = found.expect("a goal");
        let is_near = (0..2).all(|axis| (found[axis] - expected[axis]).abs() < 1e-3);
        assert!(is_near, "{found:?}, expected {expected:?}");
    }

    #[test]
    fn the_mouse_says_where_and_its_word_holds() {
        let mut players = Players::default();
        let mut devices = Devices::default();
        assert_eq!(goal(&mut players, &devices, &MANNER), None);
        devices.pointer = Some([0.7, -0.3, 0.0]);
        assert_near(goal(&mut players, &devices, &MANNER), [0.7, -0.3]);
        devices.pointer = None;
        assert_near(goal(&mut players, &devices, &MANNER), [0.7, -0.3]);
        players.start();
        assert_eq!(goal(&mut players, &devices, &MANNER), None);
    }

    #[test]
    fn keys_say_how_fast_and_diagonals_are_no_faster() {
        let step = PACE * TICK;
        let held = |keys: &[Key]| Devices {
            keys: keys.iter().copied().collect(),
            ..Devices::default()
        };
        let of = |keys: &[Key], manner: &Manner| goal(&mut Players::default(), &held(keys), manner);
        assert_near(of(&[Key::D], &MANNER), [-1.0 + step, 0.0]);
        assert_near(of(&[Key::D, Key::ArrowRight], &MANNER), [-1.0 + step, 0.0]);
        assert_eq!(of(&[Key::A, Key::D], &MANNER), None);
        let side = step * 0.5_f32.sqrt();
        assert_near(of(&[Key::W, Key::A], &MANNER), [-1.0 - side, side]);
        let slowly = Manner {
            sensitivity: 0.5,
            ..MANNER
        };
        assert_near(of(&[Key::S], &slowly), [-1.0, -0.5 * step]);
        // A goal stays in the arena, whatever pushes it out.
        let narrow = Manner {
            arena: [[-1.0, -1.0, 0.0], [1.0, 0.0, 0.0]],
            ..MANNER
        };
        assert_near(of(&[Key::W, Key::A], &narrow), [-1.0, 0.0]);
    }

    #[test]
    fn a_stick_that_hardly_leans_does_nothing_and_one_that_leans_far_goes_fast() {
        let of = |lean| {
            goal(
                &mut Players::default(),
                &with_sticks(vec![stick(1, lean)]),
                &MANNER,
            )
        };
        assert_eq!(of([0.1, -0.1]), None);
        assert_eq!(of([f32::NAN, 1.0]), None);
        assert_near(of([1.0, 0.0]), [-1.0 + PACE * TICK, 0.0]);
        let half = DEAD + 0.5 * (RIM - DEAD);
        assert_near(of([0.0, half]), [-1.0, 0.5 * PACE * TICK]);
        let mut hat = stick(1, [0.0; 2]);
        hat.hats[0].button_mut(Direction::Down).press();
        let found = goal(&mut Players::default(), &with_sticks(vec![hat]), &MANNER);
        assert_near(found, [-1.0, -PACE * TICK]);
    }

    #[test]
    fn a_stick_that_points_at_places_leaves_the_rest_to_others_while_it_is_still() {
        let mut players = Players::default();
        let mut devices = with_sticks(vec![stick(1, [0.0; 2]), stick(2, [0.0; 2])]);
        assert_eq!(goal(&mut players, &devices, &PLACES), None, "at rest");
        devices.sticks.devices[1] = stick(2, [1.0, 0.0]);
        assert_near(goal(&mut players, &devices, &PLACES), [1.6, 0.0]);
        devices.pointer = Some([0.5, 0.5, 0.0]);
        assert_near(goal(&mut players, &devices, &PLACES), [0.5, 0.5]);
        devices.pointer = None;
        assert_near(goal(&mut players, &devices, &PLACES), [0.5, 0.5]);
        devices.sticks.devices[1] = stick(2, [0.0, -1.0]);
        assert_near(goal(&mut players, &devices, &PLACES), [0.0, -1.0]);
        devices.sticks.devices[1] = stick(2, [0.0; 2]);
        assert_near(goal(&mut players, &devices, &PLACES), [0.0, 0.0]);
    }

    #[test]
    fn in_space_what_is_away_is_away_from_the_camera_and_the_hand_rises() {
        let manner = Manner {
            arena: [[-1.6, 0.0, -1.0], [1.6, 1.6, 1.0]],
            turn: Some(std::f32::consts::FRAC_PI_2),
            ..MANNER
        };
        let hands = [[0.0, 0.5, 0.0]];
        let goal = |devices: &Devices| {
            let bindings = Bindings::default();
            let frame = Players::default().frame(devices, &bindings, &manner, &hands, TICK);
            frame.goal(0).expect("a goal")
        };
        let check = |found: Vector, expected: Vector| {
            let is_near = (0..3).all(|axis| (found[axis] - expected[axis]).abs() < 1e-3);
            assert!(is_near, "{found:?}, expected {expected:?}");
        };
        let step = PACE * TICK;
        // The camera went around to the right, so it looks to the left.
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
        check(goal(&keys), [0.0, 0.5 + RISE * TICK, 0.0]);
        let wheel = Devices {
            pointer: Some([0.3, 0.5, -0.2]),
            lift: 5.0,
            ..Devices::default()
        };
        check(goal(&wheel), [0.3, 1.6, -0.2]);
    }

    #[test]
    fn each_device_belongs_to_one_player() {
        let mut players = Players::default();
        let mut devices = with_sticks(vec![stick(1, [1.0, 0.0]), stick(2, [0.0; 2])]);
        assert_eq!(goals(&mut players, &devices, &MANNER)[1], None);
        players.join(Seat::Stick(DeviceId(1)));
        let [first, second] = goals(&mut players, &devices, &MANNER);
        assert_near(first, [-1.0 + PACE * TICK, 0.0]);
        assert_near(second, [-1.0 + PACE * TICK, 0.5]);
        // Who comes in and holds still is where the level says.
        players.join(Seat::Keys);
        assert_near(goals(&mut players, &devices, &MANNER)[1], [-1.0, 0.5]);
        players.join(Seat::Keys);
        assert_eq!(players.second(), None);
        players.join(Seat::Stick(DeviceId(1)));
        devices.sticks.devices.remove(0);
        assert_eq!(goals(&mut players, &devices, &MANNER)[1], None);
        assert_eq!(players.second(), None, "it was unplugged");
        // A level may have one hand only.
        players.join(Seat::Keys);
        let bindings = Bindings::default();
        let frame = players.frame(&devices, &bindings, &MANNER, &HANDS[..1], TICK);
        assert_eq!(frame.goal(1), None);
    }
}
