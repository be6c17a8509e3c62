//! Who plays which hand with which device, and where they want it to be.

use super::devices::{DEAD, RIM, direction, held_on, opposed, rise_of};
use super::{Action, Bindings, Devices, Manner, Offer, Seat};
use egui::Vec2;
use fuwafuwa::Vector;
use fuwafuwa::vector::plus;
use std::collections::BTreeMap;
use sticks::DeviceId;
use tamaire_play::{InputFrame, PLAYERS};

/// A stick that moves by less than this does not move.
const NOISE: f32 = 0.01;
/// How fast a key or a stick that leans fully moves the goal at the usual sensitivity [m/s].
const PACE: f32 = 2.0;
/// The share of that at which one switch moves it, which cannot push now harder, now less: so a body gives way and stays whole.
const SWITCHED: f32 = 0.4;
/// How fast it rises in space [m/s].
const RISE: f32 = 1.2;

/// Who plays, and where they want their hands to be.
#[derive(Clone, Debug, Default)]
pub struct Players {
    /// What the second player holds, while there is one; the first has all the rest.
    second: Option<Seat>,
    /// Where each wants to be [m]. The hand may be far from there, and its goal as well.
    goals: [Option<Vector>; PLAYERS],
    /// How sticks leaned in the last tick. One that points at a position does so when it moves; while
    /// it is still, be it at rest, mouse and keys have their say.
    leans: BTreeMap<DeviceId, [f32; 2]>,
    /// With what each moved the hand last, and how long ago [s].
    used: [Option<Seat>; PLAYERS],
    rested: [f32; PLAYERS],
}

/// What the devices of a player ask for in a tick.
#[derive(Default)]
struct Asked {
    /// To be somewhere [m].
    position: Option<Vector>,
    /// To go to the right and away, at full pace where this is 1 long.
    lean: Vec2,
    /// To rise, at full pace where this is 1.
    lift: f32,
    /// To be higher at once [m].
    wheel: f32,
}

impl Players {
    /// What the second player holds.
    pub fn second(&self) -> Option<Seat> {
        self.second
    }

    /// The stick or pad with which a player moved the hand last, unless it was something else. Who has several feels one.
    pub fn device_of(&self, player: usize) -> Option<DeviceId> {
        match self.used[player] {
            Some(Seat::Stick(id)) => Some(id),
            _ => None,
        }
    }

    /// For how long a player has left the hand alone [s].
    pub fn rested(&self, player: usize) -> f32 {
        self.rested[player]
    }

    /// Where a player wants to be [m], when that was ever said.
    pub fn wanted(&self, player: usize) -> Option<Vector> {
        self.goals[player]
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
        let wanted = self.goals[player].unwrap_or(here);
        let asked = self.asked(player, devices, bindings, manner, wanted[1]);
        let mut goal = asked.position.or(self.goals[player]);
        if asked.lean != Vec2::ZERO {
            // From where the goal is now: what pushes in vain winds nothing up.
            let lean = asked.lean * (1.0 / asked.lean.length().max(1.0));
            let step = Manner::along(manner.turn, lean * PACE * manner.sensitivity * seconds);
            let mut position = manner.within(plus(here, step));
            if manner.turn.is_some() {
                position[1] = wanted[1];
            }
            goal = Some(position);
        }
        let lift = asked.lift.clamp(-1.0, 1.0) * RISE * manner.sensitivity * seconds;
        if lift != 0.0 || asked.wheel != 0.0 {
            let mut position = goal.unwrap_or(here);
            position[1] = raised(position[1], here[1], asked.wheel, lift);
            goal = Some(manner.within(position));
        }
        self.goals[player] = goal;
    }

    /// What the devices of a player, who wants to be at a height [m], ask for.
    fn asked(
        &mut self,
        player: usize,
        devices: &Devices,
        bindings: &Bindings,
        manner: &Manner,
        height: f32,
    ) -> Asked {
        let holds = |seat: Seat| match player {
            0 => self.second != Some(seat),
            _ => self.second == Some(seat),
        };
        let rises = if manner.turn.is_some() { 1.0 } else { 0.0 };
        let mut asked = Asked::default();
        if holds(Seat::Keys) {
            let held = |action| devices.holds_key(bindings, action);
            asked.lean = direction(held);
            asked.lift = rises * opposed(held, Action::Raise, Action::Lower);
            if asked.lean != Vec2::ZERO || asked.lift != 0.0 {
                self.used[player] = Some(Seat::Keys);
            }
        }
        if let Some(offer) = devices.taken.filter(|_| player == 0) {
            match offer {
                Offer::Way(way) => asked.lean += SWITCHED * way,
                Offer::Raise => asked.lift += rises,
                Offer::Lower => asked.lift -= rises,
                Offer::Pause => {}
            }
            self.used[player] = Some(Seat::Keys);
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
                asked.lean += Vec2::from(stick);
            } else if moved || self.used[player] == Some(Seat::Stick(device.id)) {
                asked.position = Some(manner.position_of(stick, height));
            }
            let held = held_on(device, bindings);
            let means = |action| held.contains(&action);
            let hat = direction(means);
            let rise = opposed(means, Action::Raise, Action::Lower) + rise_of(device);
            let rise = rises * rise;
            asked.lean += hat;
            asked.lift += rise;
            // One that pushes back stays where it is put, in a hand or not.
            let leans = stick != [0.0; 2] && !pushes_back;
            if moved || leans || hat != Vec2::ZERO || rise != 0.0 {
                self.used[player] = Some(Seat::Stick(device.id));
                self.rested[player] = 0.0;
            }
        }
        let pressed = |action| devices.pressed.contains(&action);
        let thumbs = rises * opposed(pressed, Action::Raise, Action::Lower);
        if holds(Seat::Pointer) && thumbs != 0.0 {
            asked.lift += thumbs;
            self.used[player] = Some(Seat::Pointer);
        }
        let wheel = rises * devices.lift;
        if holds(Seat::Pointer) && (devices.pointer.is_some() || wheel != 0.0) {
            asked.position = devices.pointer.or(asked.position);
            asked.wheel = wheel;
            self.used[player] = Some(Seat::Pointer);
        }
        if player == 1 && self.second == Some(Seat::Finger) && devices.second.is_some() {
            asked.position = devices.second;
            self.used[1] = Some(Seat::Finger);
        }
        asked
    }
}

/// A height that is wanted, after the wheel was turned and something leaned [m]; the goal is at the height `here`. Whoever
/// turns back does so from there, and what leans in vain winds nothing up; but nobody who goes up comes down for it.
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
