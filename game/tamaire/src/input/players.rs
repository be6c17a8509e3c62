//! Assignment of devices to players, and the goals of their hands.

use super::devices::{DEAD, KeyboardPart, RIM, direction, held_on, opposed, rise_of};
use super::{Action, Bindings, Devices, InputMapping, InputSource, ScanAction};
use app_shell::direction::to_world;
use egui::Vec2;
use fuwafuwa::Vec3;
use std::collections::BTreeMap;
use sticks::{Device, DeviceId};
use tamaire_play::{InputFrame, PLAYERS};

/// Change of a stick's position below which the stick counts as still (full deflection = 1).
const NOISE: f32 = 0.01;
/// Speed of the hand's goal with a held key or a fully deflected stick at default sensitivity [m/s].
const PACE: f32 = 2.0;
/// Speed factor for play with one switch. A switch cannot control the force gradually; at this speed a body
/// gives way without tearing.
const SWITCHED: f32 = 0.4;
/// Speed of raising and lowering the hand's goal in 3D at default sensitivity [m/s].
const RISE: f32 = 1.2;

/// Speed at which a hand that was not picked up yet moves towards the pointer [m/s].
const GLIDE: f32 = 1.2;
/// Distance between hand and pointer up to which the pointer picks the hand up [radii of the hand].
const GRASP: f32 = 1.2;
/// Gap that a hand keeps from the soft bodies until it is picked up [m].
const GAP: f32 = 0.03;

/// Speed of bodies up to which a gliding hand keeps its distance from them between two looks [m/s].
const RUSH: f32 = 3.0;
/// Maximum interval between two looks of a gliding hand at the bodies [ticks].
const LOOK: u8 = 5;

/// Angles to the straight way that a gliding hand tries in turn, to get around bodies [rad].
const AROUND: [f32; 7] = [0.0, 0.5, -0.5, 1.0, -1.0, 1.45, -1.45];

/// Hands at the beginning of a tick, and the bodies around them.
#[derive(Copy, Clone)]
pub struct Hands<'a> {
    /// Target position of each hand, or the start position of a hand that has not joined yet [m].
    pub targets: &'a [Vec3],
    /// Radius of a hand [m].
    pub radius: f32,
    /// Distance from a position to the nearest node of a soft body [m]. Slow: it visits all nodes.
    pub distance_to_bodies: &'a dyn Fn(Vec3) -> f32,
}

/// Players and the goals of their hands.
#[derive(Clone, Debug, Default)]
pub struct Players {
    /// Input source of the second player. `None` = one player. The first player has all other devices.
    second: Option<InputSource>,
    /// Whether each player's hand was picked up in this round: a pointer, finger or stick that sets positions
    /// has been at the hand. Before that, the hand only glides towards the position.
    is_picked_up: [bool; PLAYERS],
    /// Position to which a hand that was not picked up yet glides.
    aims: [Option<Aim>; PLAYERS],
    /// Result of each gliding hand's last look at the bodies.
    looks: [Option<Look>; PLAYERS],
    /// Goal that each player requests [m]. The hand and its target position may be far from this goal, for
    /// example behind an obstacle.
    goals: [Option<Vec3>; PLAYERS],
    /// Stick positions in the last tick. A stick that sets a position does so only when it moves, so that
    /// mouse and keys work while it is still.
    leans: BTreeMap<DeviceId, [f32; 2]>,
    /// Device with which each player last moved the hand.
    used: [Option<InputSource>; PLAYERS],
    /// Time since each player last moved the hand with a stick or pad [s].
    rested: [f32; PLAYERS],
}

/// Position that a device sets.
#[derive(Clone, Copy, Debug)]
struct Aim {
    /// Position [m].
    position: Vec3,
    /// Whether the player sees the position on the screen: that of a pointer or finger, not that of a stick.
    is_seen: bool,
}

impl Aim {
    fn seen(position: Vec3) -> Self {
        let is_seen = true;
        Self { position, is_seen }
    }
}

/// What a gliding hand has seen of the bodies. It holds for some ticks.
#[derive(Copy, Clone, Debug)]
struct Look {
    /// Position to which the hand glided [m].
    aim: Vec3,
    /// Whether the straight way is free. Otherwise no way was free, and the hand waits.
    is_free: bool,
    /// Number of ticks for which this holds.
    ticks: u8,
}

/// Requests of a player's devices in a tick.
#[derive(Default)]
struct Asked {
    /// Requested position.
    position: Option<Aim>,
    /// Requested direction: to the right, and up (in 3D: away from the camera). Length 1 = full speed.
    lean: Vec2,
    /// Requested speed of raising the hand, from -1 to 1 (full speed).
    lift: f32,
    /// Requested change of height by the mouse wheel or a second finger [m].
    wheel: f32,
}

impl Players {
    /// Returns the input source of the second player.
    pub fn second(&self) -> Option<InputSource> {
        self.second
    }

    /// Returns the stick or pad with which a player last moved the hand. `None` if it was another device.
    /// Only this device gets force feedback.
    pub fn device_of(&self, player: usize) -> Option<DeviceId> {
        match self.used[player] {
            Some(InputSource::Stick(id)) => Some(id),
            _ => None,
        }
    }

    /// Time since a player last moved the hand with a stick or pad [s].
    pub fn idle_time(&self, player: usize) -> f32 {
        self.rested[player]
    }

    /// Position that a player wants [m]. `None` before the first input.
    pub fn wanted(&self, player: usize) -> Option<Vec3> {
        self.goals[player]
    }

    /// Whether the hand of a player follows the pointer: the pointer has been at the hand in this round.
    pub fn is_picked_up(&self, player: usize) -> bool {
        self.is_picked_up[player]
    }

    /// Adds a second player who uses this device. If the second player already uses it, that player leaves.
    pub fn join(&mut self, seat: InputSource) {
        self.second = match self.second {
            Some(taken) if taken == seat => None,
            Some(InputSource::LetterKeys) if seat == InputSource::Keys => None,
            // If the second player joins with the keyboard, the mouse stays with the first player.
            _ => Some(seat),
        };
        self.goals[1] = None;
        (self.aims[1], self.is_picked_up[1]) = (None, false);
        self.used = [self.used[0].filter(|used| *used != seat), self.second];
    }

    /// Prepares for a new round: the goals follow the hands until there is input.
    pub fn start(&mut self) {
        // A stick that is still deflected from the last round has no effect until it moves.
        *self = Self {
            second: self.second,
            leans: std::mem::take(&mut self.leans),
            ..Self::default()
        };
    }

    /// Returns the goals of the hands for the next tick, which is `seconds` long.
    pub fn frame(
        &mut self,
        devices: &Devices,
        bindings: &Bindings,
        manner: &InputMapping,
        hands: &Hands,
        seconds: f32,
    ) -> InputFrame {
        if let Some(InputSource::Stick(id)) = self.second
            && devices.sticks.device(id).is_none()
        {
            self.second = None;
            self.used[1] = None;
        }
        let is_here = |id: &DeviceId| devices.sticks.device(*id).is_some();
        self.leans.retain(|id, _| is_here(id));
        // In a level with a single hand, all devices move this hand.
        let second = self.second.filter(|_| hands.targets.len() > 1);
        let mut frame = InputFrame::default();
        for player in 0..PLAYERS {
            if player == 1 && self.second.is_none() {
                self.goals[1] = None;
                continue;
            }
            // In a level with a single hand, the second player is ignored.
            let Some(&here) = hands.targets.get(player) else {
                continue;
            };
            self.rested[player] += seconds;
            let asked = self.asked(player, second, devices, bindings, manner, here);
            self.move_goal(player, asked, manner, here, hands, seconds);
            if let Some(goal) = self.goals[player].or((player == 1).then_some(here)) {
                frame = frame.with(player, goal);
            }
        }
        frame
    }

    fn move_goal(
        &mut self,
        player: usize,
        asked: Asked,
        manner: &InputMapping,
        here: Vec3,
        hands: &Hands,
        seconds: f32,
    ) {
        let wanted = self.goals[player].unwrap_or(here);
        if asked.position.is_some() || asked.lean != Vec2::ZERO {
            self.aims[player] = asked.position;
        }
        let mut goal = match self.aims[player] {
            Some(aim) => Some(self.approach(player, aim, [here, wanted], manner, hands, seconds)),
            None => {
                self.looks[player] = None;
                self.goals[player]
            }
        };
        if asked.lean != Vec2::ZERO {
            // Starts from the hand's current target position instead of the requested goal, so that pushing
            // against an obstacle does not accumulate.
            let lean = asked.lean * (1.0 / asked.lean.length().max(1.0));
            let step = to_world(manner.turn, lean * PACE * manner.sensitivity * seconds);
            let mut position = manner.clamp_to_arena(here + step);
            if manner.turn.is_some() {
                position.y = wanted.y;
            }
            goal = Some(position);
        }
        let lift = asked.lift.clamp(-1.0, 1.0) * RISE * manner.sensitivity * seconds;
        if lift != 0.0 || asked.wheel != 0.0 {
            let mut position = goal.unwrap_or(here);
            position.y = raised(position.y, here.y, asked.wheel, lift);
            goal = Some(manner.clamp_to_arena(position));
            // At another height, other bodies may be near.
            self.looks[player] = None;
        }
        self.goals[player] = goal;
    }

    /// Returns the next goal of a hand on its way to the position `aim` that a pointer, finger or stick sets.
    ///
    /// When a round begins, the pointer may lie anywhere, also on a body. The hand must not dash there. Until
    /// the pointer has been at the hand, the hand glides slowly, and it goes around bodies or stops before it
    /// touches one. A player does not see the position of a stick, so a stick could not fetch a hand that has
    /// stopped: the hand of a stick glides on and pushes gently. `here` is the target position of the hand,
    /// `wanted` its goal.
    fn approach(
        &mut self,
        player: usize,
        aim: Aim,
        [here, wanted]: [Vec3; 2],
        manner: &InputMapping,
        hands: &Hands,
        seconds: f32,
    ) -> Vec3 {
        let Aim {
            position: aim,
            is_seen,
        } = aim;
        let (mut way, mut here) = (aim - here, here);
        if manner.turn.is_some() {
            // In 3D a pointer sets the position along the floor. The height is set separately.
            (way.y, here.y) = (0.0, wanted.y);
        }
        let distance = way.length();
        if self.is_picked_up[player] || distance <= GRASP * hands.radius {
            self.is_picked_up[player] = true;
            self.aims[player] = None;
            return aim;
        }
        let step = way * (GLIDE * seconds / distance).min(1.0);
        if !step.is_finite() {
            return here;
        }
        if !is_seen {
            return here + step;
        }
        if let Some(look) = &mut self.looks[player]
            && look.ticks > 0
            && (look.is_free || look.aim == aim)
        {
            look.ticks -= 1;
            return if look.is_free { here + step } else { here };
        }
        let near = (hands.distance_to_bodies)(here);
        // For so many ticks neither the hand nor a body can close the gap.
        let ticks = (near - hands.radius - GAP) / ((GLIDE + RUSH) * seconds);
        if ticks >= 1.0 {
            let ticks = (ticks as u8).min(LOOK) - 1;
            let is_free = true;
            self.looks[player] = Some(Look {
                aim,
                is_free,
                ticks,
            });
            return here + step;
        }
        let least = near.min(hands.radius + GAP);
        let is_free = |next: &Vec3| {
            let is_nearer = (aim - next).length() < (aim - here).length();
            is_nearer && (hands.distance_to_bodies)(*next) >= least
        };
        let mut steps = AROUND
            .iter()
            .map(|&angle| here + manner.turned(step, angle));
        let found = steps.find(is_free);
        self.looks[player] = found.is_none().then_some(Look {
            aim,
            is_free: false,
            ticks: LOOK - 1,
        });
        found.unwrap_or(here)
    }

    /// Returns the part of the keyboard that moves the hand of a player. `second` is the input source of the second
    /// player.
    fn keyboard_of(player: usize, second: Option<InputSource>) -> Option<KeyboardPart> {
        match (player, second) {
            (0, Some(InputSource::Keys)) => None,
            (0, Some(InputSource::LetterKeys)) => Some(KeyboardPart::Arrows),
            (0, _) | (1, Some(InputSource::Keys)) => Some(KeyboardPart::Whole),
            (1, Some(InputSource::LetterKeys)) => Some(KeyboardPart::Letters),
            _ => None,
        }
    }

    /// Collects the requests of a player's devices. `second` is the input source of the second player, `here` the
    /// target position of the player's hand [m].
    fn asked(
        &mut self,
        player: usize,
        second: Option<InputSource>,
        devices: &Devices,
        bindings: &Bindings,
        manner: &InputMapping,
        here: Vec3,
    ) -> Asked {
        let holds = |seat: InputSource| match player {
            0 => second != Some(seat),
            _ => second == Some(seat),
        };
        let rises = if manner.turn.is_some() { 1.0 } else { 0.0 };
        let mut asked = Asked::default();
        if let Some(part) = Self::keyboard_of(player, second) {
            let held = |action| devices.holds_key(bindings, part, action);
            asked.lean = direction(held);
            asked.lift = rises * opposed(held, Action::Raise, Action::Lower);
            if asked.lean != Vec2::ZERO || asked.lift != 0.0 {
                self.used[player] = Some(InputSource::Keys);
            }
        }
        if let Some(offer) = devices.taken.filter(|_| player == 0) {
            match offer {
                ScanAction::Move(way) => asked.lean += SWITCHED * way,
                ScanAction::Raise => asked.lift += rises,
                ScanAction::Lower => asked.lift -= rises,
                ScanAction::Tool | ScanAction::Rewind | ScanAction::Pause => {}
            }
            self.used[player] = Some(InputSource::Keys);
        }
        let all = devices.sticks.devices.iter();
        for device in all.filter(|device| holds(InputSource::Stick(device.id))) {
            let pushes_back = devices.pushing.contains(&device.id);
            let height = self.goals[player].unwrap_or(here).y;
            let wish = self.asked_by_stick(player, device, pushes_back, bindings, manner, height);
            asked.position = wish.position.or(asked.position);
            asked.lean += wish.lean;
            asked.lift += wish.lift;
        }
        let pressed = |action| devices.pressed.contains(&action);
        let thumbs = rises * opposed(pressed, Action::Raise, Action::Lower);
        if holds(InputSource::Pointer) && thumbs != 0.0 {
            asked.lift += thumbs;
            self.used[player] = Some(InputSource::Pointer);
        }
        let wheel = rises * devices.lift;
        if holds(InputSource::Pointer) && (devices.pointer.is_some() || wheel != 0.0) {
            asked.position = devices.pointer.map(Aim::seen).or(asked.position);
            asked.wheel = wheel;
            self.used[player] = Some(InputSource::Pointer);
        }
        if player == 1 && second == Some(InputSource::Finger) && devices.second.is_some() {
            asked.position = devices.second.map(Aim::seen);
            self.used[1] = Some(InputSource::Finger);
        }
        asked
    }

    /// Collects the requests of a stick or pad. `pushes_back` says whether it has force feedback, `height` is the
    /// height of the player's goal [m].
    fn asked_by_stick(
        &mut self,
        player: usize,
        device: &Device,
        pushes_back: bool,
        bindings: &Bindings,
        manner: &InputMapping,
        height: f32,
    ) -> Asked {
        let mut asked = Asked::default();
        let stick = sticks::radial_dead_zone(device.aim(), DEAD, RIM);
        let before = self.leans.entry(device.id).or_default();
        let moved = (Vec2::from(stick) - Vec2::from(*before)).length() > NOISE;
        if moved || stick == [0.0; 2] {
            *before = stick;
        }
        if !manner.stick_sets_position && !pushes_back {
            asked.lean += Vec2::from(stick);
        } else if moved || self.used[player] == Some(InputSource::Stick(device.id)) {
            asked.position = Some(Aim {
                position: manner.position_of(stick, height),
                is_seen: false,
            });
        }
        let held = held_on(device, bindings);
        let means = |action| held.contains(&action);
        let hat = direction(means);
        let rises = if manner.turn.is_some() { 1.0 } else { 0.0 };
        let rise = rises * (opposed(means, Action::Raise, Action::Lower) + rise_of(device));
        asked.lean += hat;
        asked.lift += rise;
        // A force-feedback stick keeps its position when it is let go, so its deflection does not show
        // that it is in use.
        let leans = stick != [0.0; 2] && !pushes_back;
        if moved || leans || hat != Vec2::ZERO || rise != 0.0 {
            self.used[player] = Some(InputSource::Stick(device.id));
            self.rested[player] = 0.0;
        }
        asked
    }
}

/// Returns the requested height after wheel and lift input [m]. `here` is the current target height of the
/// hand. A reversal starts from `here`, and lifting against an obstacle does not accumulate. Upward input
/// never lowers the hand, and downward input never raises it.
fn raised(mut wanted: f32, here: f32, wheel: f32, lift: f32) -> f32 {
    let further = |by: f32| if by > 0.0 { f32::max } else { f32::min };
    if wheel != 0.0 {
        wanted = further(wheel)(wanted, here) + wheel;
    }
    if lift != 0.0 {
        wanted = further(lift)(wanted, here + lift);
    }
    wanted
}

#[cfg(test)]
mod tests;
