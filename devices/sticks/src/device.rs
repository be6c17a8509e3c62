//! Device states as plain values, which tests and replays can also create.

use std::sync::Arc;

/// Id of a device while it is plugged in. Plugging it in again gives another id.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct DeviceId(pub u32);

/// State of all devices at one time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Snapshot {
    /// Devices in the order in which they were plugged in.
    pub devices: Vec<Device>,
}

/// State of one device. Its buttons count their presses since the device was plugged in.
#[derive(Clone, Debug, PartialEq)]
pub struct Device {
    pub id: DeviceId,
    pub about: Arc<DeviceInfo>,
    /// Axes, each from −1 to 1, in the numbering of the device. On sticks the first two are usually x,
    /// increasing to the right, and y, increasing towards the player. A lever may read 0 until it is first
    /// moved.
    pub axes: Vec<f32>,
    /// State of all buttons, in the numbering of the device.
    pub buttons: Vec<Button>,
    pub hats: Vec<Hat>,
    /// State in the standard layout. `Some` if SDL knows the layout of this device. Such a device is called a
    /// pad here.
    pub pad: Option<Pad>,
}

/// Properties that do not change while a device is plugged in.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct DeviceInfo {
    /// Human-readable name.
    pub name: String,
    /// Id of the device model as 32 hexadecimal digits, equal for all devices of a model: a key for storing
    /// mappings or calibrations. Differs between platforms.
    pub guid: String,
    /// Labels printed on the buttons of a pad.
    pub labels: Labels,
}

/// Labels printed on the buttons of a pad.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Labels {
    /// Unknown labels.
    #[default]
    Unknown,
    /// Letters, with A at the bottom, as on Xbox pads and most others.
    Letters,
    /// Letters, with B at the bottom, as on Nintendo pads.
    Mirrored,
    /// Shapes, with a cross at the bottom, as on PlayStation pads.
    Shapes,
}

/// State of a button or of another control that can be pressed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Button {
    pub down: bool,
    /// Number of presses since the device was plugged in. Wraps around at the maximum.
    pub presses: u32,
}

/// Direction of a hat, or of a move of the focus in a menu.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Direction {
    Up,
    Right,
    Down,
    Left,
}

/// State of a thumb hat with eight directions: four buttons, of which two adjacent ones may be down.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Hat {
    buttons: [Button; Direction::ALL.len()],
}

/// State of a pad in the standard layout, independent of its maker.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Pad {
    /// Left stick: x to the right and y up, each from −1 to 1. Diagonals may be longer than 1.
    pub left: [f32; 2],
    /// Right stick: x to the right and y up, each from −1 to 1. Diagonals may be longer than 1.
    pub right: [f32; 2],
    /// Left and right trigger, from 0 at rest to 1.
    pub triggers: [f32; 2],
    buttons: [Button; PadButton::ALL.len()],
}

/// Button of the standard layout. The four buttons under the right thumb are named by their position, because
/// their labels differ between makers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum PadButton {
    South,
    East,
    West,
    North,
    Back,
    Guide,
    Start,
    /// Left stick pressed down.
    LeftStick,
    /// Right stick pressed down.
    RightStick,
    LeftShoulder,
    RightShoulder,
    Up,
    Down,
    Left,
    Right,
    /// Additional button, such as share, capture or microphone.
    Misc,
    /// Upper or primary right paddle on the back of the pad. The next three variants are the other paddles.
    RightPaddle,
    LeftPaddle,
    LowerRightPaddle,
    LowerLeftPaddle,
    Touchpad,
}

/// Control that can be pressed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Control {
    /// Button of a device that is not a pad.
    Button(usize),
    /// Direction of a hat of a device that is not a pad.
    Hat(usize, Direction),
    /// Button of a pad.
    Pad(PadButton),
}

/// Difference between two snapshots.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Change {
    Connected(DeviceId),
    Disconnected(DeviceId),
    /// A press of a control; one entry per press.
    Pressed {
        device: DeviceId,
        control: Control,
    },
}

impl Snapshot {
    /// Returns the device with this id while it is plugged in.
    pub fn device(&self, id: DeviceId) -> Option<&Device> {
        self.devices.iter().find(|device| device.id == id)
    }

    /// Returns the changes since the snapshot `before`: first the disconnections, then for each device its
    /// connection and its presses.
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
    /// Creates a device with the given numbers of axes, buttons and hats, all at rest.
    pub fn at_rest(
        id: DeviceId,
        about: DeviceInfo,
        axes: usize,
        buttons: usize,
        hats: usize,
    ) -> Device {
        Device {
            id,
            about: Arc::new(about),
            axes: vec![0.0; axes],
            buttons: vec![Button::default(); buttons],
            hats: vec![Hat::default(); hats],
            pad: None,
        }
    }

    /// Returns the position of the main stick: of the left stick on a pad, otherwise of the first two axes. x
    /// to the right, y up (away from the player), each from −1 to 1.
    pub fn aim(&self) -> [f32; 2] {
        match (&self.pad, self.axes.as_slice()) {
            (Some(pad), _) => pad.left,
            (None, [x, y, ..]) => [*x, -*y],
            (None, _) => [0.0; 2],
        }
    }

    /// Returns the button for a direction: from the d-pad of a pad, otherwise from all hats combined.
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

    /// Returns the state of a control. If the device has no such control, returns a control at rest.
    pub fn control(&self, control: Control) -> Button {
        let button = match control {
            Control::Button(index) => self.buttons.get(index).copied(),
            Control::Hat(index, direction) => self.hats.get(index).map(|hat| hat.button(direction)),
            Control::Pad(button) => self.pad.map(|pad| pad.button(button)),
        };
        button.unwrap_or_default()
    }

    /// Returns all controls with their states: the standard layout of a pad, otherwise all buttons and hats.
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
    /// Returns the number of presses since the state `before` of this button.
    pub fn presses_since(self, before: Button) -> u32 {
        self.presses.wrapping_sub(before.presses)
    }

    /// Records a press: the button is down and counts one press more.
    pub fn press(&mut self) {
        self.down = true;
        self.presses = self.presses.wrapping_add(1);
    }
}

impl Direction {
    /// All directions, clockwise from the top.
    pub const ALL: [Direction; 4] = [
        Direction::Up,
        Direction::Right,
        Direction::Down,
        Direction::Left,
    ];

    /// Returns the unit vector: x to the right, y up.
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
    /// Returns the label printed on this button, or `None` if it is unknown.
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

    /// All buttons, in the order of SDL.
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
