//! Sticks and gamepads: their input and their force feedback.

use super::hand::HandInput;
use app_shell::direction::{to_user, to_world};
use app_shell::{Forces, Pads};
use egui::Vec2;
use force_feedback::{Ability, Settings, State, Stop};
use fuwafuwa::Vec3;
use sticks::{Change, Control, Device, DeviceId, Direction, PadButton, Snapshot, radial_dead_zone};

/// Deflection of a stick below which it counts as centred, as a fraction of its range.
const DEAD: f32 = 0.15;
/// Deflection of a stick above which it counts as full, as a fraction of its range.
const RIM: f32 = 0.95;
/// Contact force at which a device gives its full force [N]. Cutting soft tissue needs one to a few newtons.
const FULL: f32 = 5.0;
/// Time without input after which a device gets no rumble [s]. Devices with force feedback keep their forces.
const RESTED: f32 = 1.5;
/// Strength of the rumble per split node; 1 is the strongest rumble.
const TEAR: f32 = 0.04;
/// Maximum strength of the rumble for the nodes split in a tick; 1 is the strongest rumble.
const TORN: f32 = 0.6;

/// Action triggered once per press.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum DeviceAction {
    /// Take up the next tool.
    NextTool,
    /// Pause or resume.
    Pause,
    /// Switch all forces off or on.
    CutForces,
}

/// Sticks and gamepads in use.
pub struct Devices {
    pads: Pads,
    forces: Forces,
    said: Snapshot,
    /// Device that moved the hand last, and the time since then [s].
    used: Option<DeviceId>,
    rested: f32,
}

impl Devices {
    /// Opens all connected devices.
    pub fn open() -> Self {
        Self::of(Pads::open())
    }

    /// Creates the state for the given devices.
    pub fn of(pads: Pads) -> Self {
        Self {
            pads,
            forces: Forces::default(),
            said: Snapshot::default(),
            used: None,
            rested: f32::INFINITY,
        }
    }

    /// Reads the devices. Adds their input to `wishes`, and returns the pressed actions and the camera's
    /// turning speed (right, up). The deflection of a device with force feedback sets the position of the
    /// hand in the room from `low` to `high` [m]. The deflection of other devices sets its velocity.
    pub fn hear(
        &mut self,
        wishes: &mut HandInput,
        [low, high]: [Vec3; 2],
        turn: f32,
        seconds: f32,
    ) -> (Vec<DeviceAction>, Vec2) {
        let now = self.pads.snapshot();
        let mut presses = Vec::new();
        for change in now.since(&self.said) {
            if let Change::Pressed { device, control } = change {
                self.used = Some(device);
                self.rested = 0.0;
                presses.extend(press(control));
            }
        }
        self.rested += seconds;
        let mut look = Vec2::ZERO;
        for device in &now.devices {
            let asked = DeviceInput::of(device);
            look += asked.look;
            if !asked.is_anything() {
                continue;
            }
            self.used = Some(device.id);
            self.rested = 0.0;
            let report = self.forces.report(device.id);
            let pushes = report.is_some_and(|report| report.ability == Ability::Force);
            if pushes {
                let lean = to_world(Some(turn), Vec2::from(device.aim()));
                wishes.place = Some(0.5 * (low + high) + 0.5 * lean * (high - low));
            } else {
                wishes.lean += asked.lean;
            }
            wishes.lift += asked.lift;
            wishes.grips |= asked.grips;
            wishes.turn += asked.turn;
        }
        self.said = now;
        (presses, look.clamp(Vec2::splat(-1.0), Vec2::splat(1.0)))
    }

    /// Sends the contact force [N] to the device that moved the hand last. The force is rotated by `turn`,
    /// the camera's azimuth [rad]. If `silence` is given, no device gets feedback, for that reason.
    pub fn feel(&mut self, contact: Vec3, turn: f32, silence: Option<Stop>) {
        self.forces.attend(&self.said, &self.pads, |_| {
            Some(Settings {
                full: FULL,
                ..Settings::default()
            })
        });
        let (used, rested) = (self.used, self.rested);
        let forces = &self.forces;
        forces.tell(|id| {
            if let Some(why) = silence {
                return Err(why);
            }
            let report = forces.report(id);
            let pushes = report.is_some_and(|report| report.ability == Ability::Force);
            if used != Some(id) || (!pushes && rested > RESTED) {
                return Err(Stop::Idle);
            }
            let manner = match pushes {
                true => force_feedback::StickMode::Position,
                false => force_feedback::StickMode::Velocity,
            };
            let contact = to_user(Some(turn), contact);
            Ok(State { contact, manner })
        });
        self.forces.update();
    }

    /// Sends the feedback of a tear to the device in use; `nodes` is the number of split nodes.
    pub fn tear(&self, nodes: u32) {
        if let (Some(device), true) = (self.used, nodes > 0) {
            self.forces.tear(device, (TEAR * nodes as f32).min(TORN));
        }
    }

    /// Switches all forces off, or on again. Returns whether they are off afterwards.
    pub fn cut_or_restore(&mut self) -> bool {
        match self.forces.is_cut() {
            true => self.forces.restore(),
            false => self.forces.cut(),
        }
        self.forces.is_cut()
    }

    /// Describes the feedback of the device in use, as text for the user.
    pub fn told(&self) -> String {
        let device = self.used.and_then(|id| self.said.device(id));
        let Some(device) = device else {
            return "no stick or gamepad in use: forces are displayed only".into();
        };
        let report = self.forces.report(device.id);
        let able = match report.map(|report| report.ability) {
            Some(Ability::Force) => "force feedback in the plane of the table",
            Some(Ability::Rumble) => "rumbles with the force",
            _ => "no force feedback",
        };
        format!("{}: {able}", device.about.name)
    }
}

/// Input of a device.
#[derive(Default)]
struct DeviceInput {
    lean: Vec2,
    lift: f32,
    turn: Vec3,
    look: Vec2,
    grips: bool,
}

impl DeviceInput {
    fn of(device: &Device) -> Self {
        let lean = Vec2::from(radial_dead_zone(device.aim(), DEAD, RIM));
        let held = |control| f32::from(u8::from(device.control(control).down));
        let hat = |direction| f32::from(u8::from(device.hat(direction).down));
        let tilt = hat(Direction::Up) - hat(Direction::Down);
        let over = hat(Direction::Left) - hat(Direction::Right);
        match device.pad {
            Some(pad) => {
                let button = |which| held(Control::Pad(which));
                let pull = |k: f32| radial_dead_zone([k, 0.0], DEAD, RIM)[0];
                let [down, up] = pad.triggers.map(pull);
                let around = button(PadButton::LeftShoulder) - button(PadButton::RightShoulder);
                Self {
                    lean,
                    lift: up - down,
                    turn: Vec3::new(around, tilt, over),
                    look: Vec2::from(radial_dead_zone(pad.right, DEAD, RIM)),
                    grips: button(PadButton::South) > 0.0,
                }
            }
            None => {
                let button = |which| held(Control::Button(which));
                Self {
                    lean,
                    lift: button(9) - button(10),
                    turn: Vec3::new(button(4) - button(5), tilt, over),
                    look: Vec2::new(button(7) - button(6), 0.0),
                    grips: button(0) > 0.0,
                }
            }
        }
    }

    fn is_anything(&self) -> bool {
        self.lean != Vec2::ZERO || self.lift != 0.0 || self.turn != Vec3::ZERO || self.grips
    }
}

fn press(control: Control) -> Option<DeviceAction> {
    match control {
        Control::Pad(PadButton::North) | Control::Button(1) => Some(DeviceAction::NextTool),
        Control::Pad(PadButton::Start) | Control::Button(3) => Some(DeviceAction::Pause),
        Control::Pad(PadButton::Back) | Control::Button(8) => Some(DeviceAction::CutForces),
        _ => None,
    }
}
