//! What devices say, as plain values: anybody may make them up, a test or a replay for instance.

use std::sync::Arc;

/// A device from when it is plugged in until it is unplugged; plugged in again it has another.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct DeviceId(pub u32);

/// What all devices said at one time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Snapshot {
    /// In the order in which they were plugged in.
    pub devices: Vec<Device>,
}

/// What one device said, and how often its buttons were pressed since it was plugged in.
#[derive(Clone, Debug, PartialEq)]
pub struct Device {
    pub id: DeviceId,
    pub about: Arc<About>,
    /// Each axis from -1 to 1, as the device numbers them. On sticks the first two are usually x, growing to the right,
    /// and y, growing towards the player. A lever reports 0 until it is first moved if its driver does not tell earlier.
    pub axes: Vec<f32>,
    /// All buttons, as the device numbers them.
    pub buttons: Vec<Button>,
    pub hats: Vec<Hat>,
    /// The same again in the standard layout, if SDL knows where things are on this device. Then it is a pad.
    pub pad: Option<Pad>,
}

/// What stays the same while a device is plugged in.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct About {
    /// For people.
    pub name: String,
    /// Names the model, not the single device, as 32 hexadecimal digits: what to store a mapping or a calibration under.
    /// Differs from platform to platform.
    pub guid: String,
    /// What its maker printed on its buttons, if it is a pad.
    pub labels: Labels,
}

/// What the maker of a pad printed on its buttons.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Labels {
    /// Nobody knows.
    #[default]
    Unknown,
    /// A lowest, as on pads for Xbox and most others.
    Letters,
    /// B lowest, as on pads for Nintendo's consoles.
    Mirrored,
    /// A cross lowest, as on pads for PlayStation.
    Shapes,
}

/// A button, or anything else that is pressed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Button {
    pub down: bool,
    /// How often it went down since the device was plugged in. Wraps around.
    pub presses: u32,
}

/// One of the four ways in which a focus moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Direction {
    Up,
    Right,
    Down,
    Left,
}

/// A small stick for the thumb that knows eight directions, as four buttons of which two may be down.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Hat {
    buttons: [Button; Direction::ALL.len()],
}

/// The standard layout of pads, whoever made the pad.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Pad {
    /// x to the right and y up, each from -1 to 1. Diagonals may be longer than 1.
    pub left: [f32; 2],
    /// As `left`.
    pub right: [f32; 2],
    /// Left and right, from 0 at rest to 1.
    pub triggers: [f32; 2],
    buttons: [Button; PadButton::ALL.len()],
}

/// A button of the standard layout. The four under the right thumb are named for where they are, since makers disagree
/// about their letters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum PadButton {
    South,
    East,
    West,
    North,
    Back,
    Guide,
    Start,
    /// The left stick pressed down.
    LeftStick,
    /// The right stick pressed down.
    RightStick,
    LeftShoulder,
    RightShoulder,
    Up,
    Down,
    Left,
    Right,
    /// Share, capture, microphone: whatever else there is.
    Misc,
    /// The upper or first one at the back, as the next three.
    RightPaddle,
    LeftPaddle,
    LowerRightPaddle,
    LowerLeftPaddle,
    Touchpad,
}

/// Something that can be pressed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Control {
    /// A button of a device that is no pad.
    Button(usize),
    /// A direction of a hat of a device that is no pad.
    Hat(usize, Direction),
    /// A button of a pad.
    Pad(PadButton),
}

/// What makes a snapshot differ from an earlier one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Change {
    Connected(DeviceId),
    Disconnected(DeviceId),
    /// Comes once for each press.
    Pressed {
        device: DeviceId,
        control: Control,
    },
}

impl Snapshot {
    /// The device with this id, while it is plugged in.
    pub fn device(&self, id: DeviceId) -> Option<&Device> {
        self.devices.iter().find(|device| device.id == id)
    }

    /// What happened since an earlier snapshot: first who left, then device by device who came and what was pressed.
    pub fn since(&self, before: &Snapshot) -> Vec<Change> {
        let left = before
            .devices
            .iter()
            .filter(|device| self.device(device.id).is_none());
        let mut changes: Vec<_> = left.map(|device| Change::Disconnected(device.id)).collect();
        for now in &self.devices {
            let before = before.device(now.id);
            if before.is_none() {
                changes.push(Change::Connected(now.id));
            }
            for (control, button) in now.controls() {
                let earlier = before.map_or(Button::default(), |before| before.control(control));
                let pressed = Change::Pressed {
                    device: now.id,
                    control,
                };
                changes.extend((0..button.presses_since(earlier)).map(|_| pressed));
            }
        }
        changes
    }
}

impl Device {
    /// A device with these many axes, buttons and hats, all at rest.
    pub fn at_rest(id: DeviceId, about: About, axes: usize, buttons: usize, hats: usize) -> Device {
        Device {
            id,
            about: Arc::new(about),
            axes: vec![0.0; axes],
            buttons: vec![Button::default(); buttons],
            hats: vec![Hat::default(); hats],
            pad: None,
        }
    }

    /// Where the stick points that a hand holds: a pad's left one, else the first two axes. x to the right, y up (away
    /// from the player), each from -1 to 1.
    pub fn aim(&self) -> [f32; 2] {
        match (&self.pad, self.axes.as_slice()) {
            (Some(pad), _) => pad.left,
            (None, [x, y, ..]) => [*x, -*y],
            (None, _) => [0.0; 2],
        }
    }

    /// The d-pad of a pad, or all hats taken together.
    pub fn hat(&self, direction: Direction) -> Button {
        if let Some(pad) = &self.pad {
            return pad.button(direction.into());
        }
        let mut all = Button::default();
        for hat in &self.hats {
            let one = hat.button(direction);
            all.down |= one.down;
            all.presses = all.presses.wrapping_add(one.presses);
        }
        all
    }

    /// The button at a place; one at rest if the device has no such place.
    pub fn control(&self, control: Control) -> Button {
        let button = match control {
            Control::Button(index) => self.buttons.get(index).copied(),
            Control::Hat(index, direction) => self.hats.get(index).map(|hat| hat.button(direction)),
            Control::Pad(button) => self.pad.map(|pad| pad.button(button)),
        };
        button.unwrap_or_default()
    }

    /// Everything that can be pressed: on pads the standard layout, on other devices the buttons and hats.
    pub fn controls(&self) -> impl Iterator<Item = (Control, Button)> {
        let is_pad = self.pad.is_some();
        let pad = PadButton::ALL
            .into_iter()
            .filter(move |_| is_pad)
            .map(Control::Pad);
        let buttons = (0..self.buttons.len()).map(Control::Button);
        let hats = (0..self.hats.len())
            .flat_map(|hat| Direction::ALL.map(|direction| Control::Hat(hat, direction)));
        let raw = buttons.chain(hats).filter(move |_| !is_pad);
        pad.chain(raw)
            .map(|control| (control, self.control(control)))
    }
}

impl Button {
    /// How often it went down since an earlier time.
    pub fn presses_since(self, before: Button) -> u32 {
        self.presses.wrapping_sub(before.presses)
    }

    /// Takes note that it went down.
    pub fn press(&mut self) {
        self.down = true;
        self.presses = self.presses.wrapping_add(1);
    }
}

impl Direction {
    /// Clockwise from the top.
    pub const ALL: [Direction; 4] = [
        Direction::Up,
        Direction::Right,
        Direction::Down,
        Direction::Left,
    ];

    /// x to the right, y up.
    pub const fn vector(self) -> [f32; 2] {
        match self {
            Direction::Up => [0.0, 1.0],
            Direction::Right => [1.0, 0.0],
            Direction::Down => [0.0, -1.0],
            Direction::Left => [-1.0, 0.0],
        }
    }
}

impl Hat {
    pub fn button(&self, direction: Direction) -> Button {
        self.buttons[direction as usize]
    }

    pub fn button_mut(&mut self, direction: Direction) -> &mut Button {
        &mut self.buttons[direction as usize]
    }
}

impl Pad {
    pub fn button(&self, button: PadButton) -> Button {
        self.buttons[button as usize]
    }

    pub fn button_mut(&mut self, button: PadButton) -> &mut Button {
        &mut self.buttons[button as usize]
    }
}

impl PadButton {
    /// What stands on it, where that is known and is a word or a sign.
    pub fn label(self, labels: Labels) -> Option<&'static str> {
        let place = match self {
            PadButton::South => 0,
            PadButton::East => 1,
            PadButton::West => 2,
            PadButton::North => 3,
            PadButton::LeftShoulder => 4,
            PadButton::RightShoulder => 5,
            PadButton::Back => 6,
            PadButton::Start => 7,
            _ => return None,
        };
        let all = match labels {
            Labels::Unknown => return None,
            Labels::Letters => ["A", "B", "X", "Y", "LB", "RB", "View", "Menu"],
            Labels::Mirrored => ["B", "A", "Y", "X", "L", "R", "−", "+"],
            Labels::Shapes => ["×", "○", "□", "△", "L1", "R1", "Share", "Options"],
        };
        Some(all[place])
    }

    /// All of them, in the order of SDL.
    pub const ALL: [PadButton; 21] = [
        PadButton::South,
        PadButton::East,
        PadButton::West,
        PadButton::North,
        PadButton::Back,
        PadButton::Guide,
        PadButton::Start,
        PadButton::LeftStick,
        PadButton::RightStick,
        PadButton::LeftShoulder,
        PadButton::RightShoulder,
        PadButton::Up,
        PadButton::Down,
        PadButton::Left,
        PadButton::Right,
        PadButton::Misc,
        PadButton::RightPaddle,
        PadButton::LeftPaddle,
        PadButton::LowerRightPaddle,
        PadButton::LowerLeftPaddle,
        PadButton::Touchpad,
    ];
}

impl From<Direction> for PadButton {
    fn from(direction: Direction) -> PadButton {
        match direction {
            Direction::Up => PadButton::Up,
            Direction::Right => PadButton::Right,
            Direction::Down => PadButton::Down,
            Direction::Left => PadButton::Left,
        }
    }
}
