//! Detection of visitors from their input.

use super::config::Times;
use egui::{Context, Event};
use std::collections::BTreeMap;
use sticks::{Change, DeviceId, Snapshot};

/// Smallest change of a stick or trigger axis that counts as input; full deflection = 1. Worn sticks tremble
/// by less.
const MOVED: f32 = 0.15;
/// Smallest mouse travel that counts as input, at any speed [points]. A shock to the table moves the mouse by
/// less.
const PUSHED: f32 = 4.0;
/// Time without mouse movement after which the measured travel restarts from zero [s].
const KNOCKED: f32 = 1.0;

/// Attention of a visitor.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub enum Attention {
    /// A visitor gave input recently.
    #[default]
    There,
    /// There was no input for long. The value is the remaining fraction of the countdown.
    Leaving(f32),
    /// The countdown has ended.
    Gone,
}

/// Detector of input.
#[derive(Default)]
pub struct Presence {
    /// Time since the last input [s].
    rest: f32,
    /// Time since the last mouse movement [s].
    pointer_rest: f32,
    /// Mouse travel that has not counted as input yet [points].
    pushed: f32,
    before: Snapshot,
    /// Positions of sticks and triggers when their movement last counted as input.
    axes: BTreeMap<DeviceId, [f32; 6]>,
}

impl Presence {
    /// Whether there was input since the last call. With `they_stir`, the game itself moves the sticks, so
    /// stick positions are ignored.
    pub fn is_touched(&mut self, ctx: &Context, sticks: &Snapshot, they_stir: bool) -> bool {
        // The game removes the keys that it handles from `events`, but not from the raw input.
        let by_hand = ctx.input(|input| input.raw.events.iter().any(is_deed));
        let way = ctx.input(|input| input.pointer.delta().length());
        let by_stick = self.is_moved(sticks, they_stir);
        by_hand || self.is_pushed(way) || by_stick
    }

    /// Adds the latest mouse travel `way` [points] and returns whether the mouse has moved far enough to
    /// count as input.
    fn is_pushed(&mut self, way: f32) -> bool {
        if self.pointer_rest > KNOCKED {
            self.pushed = 0.0;
        }
        self.pushed += way;
        if way > 0.0 {
            self.pointer_rest = 0.0;
        }
        let is_pushed = self.pushed > PUSHED;
        if is_pushed {
            self.pushed = 0.0;
        }
        is_pushed
    }

    /// Whether a stick or pad was used since the last call.
    fn is_moved(&mut self, now: &Snapshot, they_stir: bool) -> bool {
        let changes = now.since(&self.before);
        let mut is_moved = changes
            .iter()
            .any(|change| matches!(change, Change::Pressed { .. }));
        self.before = now.clone();
        self.axes.retain(|id, _| now.device(*id).is_some());
        for device in &now.devices {
            let [right, triggers] = device
                .pad
                .map_or([[0.0; 2]; 2], |pad| [pad.right, pad.triggers]);
            let [x, y] = device.aim();
            let axes = [x, y, right[0], right[1], triggers[0], triggers[1]];
            let known = self.axes.entry(device.id).or_insert(axes);
            let differs = known
                .iter()
                .zip(axes)
                .any(|(known, now)| (known - now).abs() > MOVED);
            if differs {
                *known = axes;
                is_moved |= !they_stir;
            }
        }
        is_moved
    }

    /// Advances by `seconds` [s], with or without input, and returns the attention of the visitor.
    pub fn pass(&mut self, seconds: f32, is_touched: bool, times: &Times) -> Attention {
        self.pointer_rest += seconds;
        self.rest = if is_touched { 0.0 } else { self.rest + seconds };
        let left = 1.0 - (self.rest - times.rest.0) / times.countdown.0;
        match left {
            left if left > 1.0 => Attention::There,
            left if left > 0.0 => Attention::Leaving(left),
            _ => Attention::Gone,
        }
    }

    /// Resets the time without input to zero, as at the beginning of a visit.
    pub fn begin(&mut self) {
        self.rest = 0.0;
    }

    /// Whether the mouse has not moved for long.
    pub fn is_pointer_left(&self, times: &Times) -> bool {
        self.pointer_rest > times.pointer.0
    }
}

/// Whether a person caused an event. Key repeats do not count, because an object may lie on the key.
fn is_deed(event: &Event) -> bool {
    match event {
        Event::Key {
            pressed, repeat, ..
        } => *pressed && !repeat,
        Event::PointerButton { pressed, .. } => *pressed,
        Event::Touch { .. } | Event::MouseWheel { .. } => true,
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::super::config::Seconds;
    use super::*;
    use sticks::{Device, DeviceInfo};

    const TIMES: Times = Times {
        rest: Seconds(20.0),
        countdown: Seconds(10.0),
        pointer: Seconds(3.0),
    };

    fn stick(lean: f32) -> Snapshot {
        let mut device = Device::at_rest(DeviceId(1), DeviceInfo::default(), 2, 0, 0);
        device.axes[0] = lean;
        Snapshot {
            devices: vec![device],
        }
    }

    #[test]
    fn pause_counts_down_until_input_stops_it() {
        let mut presence = Presence::default();
        let mut pass = |seconds, touched| presence.pass(seconds, touched, &TIMES);
        assert_eq!(pass(19.0, false), Attention::There);
        assert!(matches!(pass(6.0, false), Attention::Leaving(left) if (0.4..0.6).contains(&left)));
        assert_eq!(pass(0.1, true), Attention::There);
        assert!(matches!(pass(29.0, false), Attention::Leaving(_)));
        assert_eq!(pass(2.0, false), Attention::Gone);
    }

    #[test]
    fn trembling_or_leaning_stick_is_no_input() {
        let mut presence = Presence::default();
        presence.is_moved(&stick(0.0), false);
        assert!(presence.is_moved(&stick(0.9), false));
        for tick in 0..100 {
            let tremble = 0.03 * f32::from(i8::from(tick % 2 == 0));
            assert!(!presence.is_moved(&stick(0.9 + tremble), false));
        }
        assert!(presence.is_moved(&stick(0.5), false));
    }

    #[test]
    fn stick_moved_by_game_is_no_input() {
        let mut presence = Presence::default();
        presence.is_moved(&stick(0.0), true);
        assert!(!presence.is_moved(&stick(0.9), true));
        assert!(!presence.is_moved(&stick(0.9), false), "position unchanged");
        assert!(presence.is_moved(&stick(0.0), false));
    }

    #[test]
    fn slow_mouse_movement_is_input_and_shock_is_not() {
        let mut presence = Presence::default();
        let pushes = (0..20).filter(|_| presence.is_pushed(0.5)).count();
        assert_eq!(pushes, 2);
        for _ in 0..20 {
            presence.pass(2.0, false, &TIMES);
            assert!(!presence.is_pushed(3.0));
        }
    }
}
