//! Tests with virtual devices. Their input goes through all of SDL.

#[cfg(feature = "haptic")]
mod felt;

use std::thread;
use std::time::{Duration, Instant};

use crate::{
    Button, Change, Control, Device, Direction, Error, Navigator, PadButton, Sticks, VirtualDevice,
};

#[test]
fn snapshot_is_empty_without_devices() {
    assert!(open().snapshot().devices.is_empty());
}

#[test]
fn flight_stick_reports_all_axes_buttons_and_hats() {
    let sticks = open();
    let stick = stick(&sticks, "Wing", 7, 32, 2);
    for axis in 0..7 {
        assert!(stick.axis(axis, axis as f32 / 3.0 - 1.0));
    }
    for button in (0..32).step_by(3) {
        assert!(stick.button(button, true));
    }
    assert!(stick.hat(1, &[Direction::Up, Direction::Right]));

    let device = device(&sticks, &stick);
    assert_eq!(device.about.name, "Wing");
    assert_eq!(device.about.guid.len(), 32);
    assert!(device.pad.is_none());
    assert_eq!(
        [device.axes.len(), device.buttons.len(), device.hats.len()],
        [7, 32, 2]
    );
    for (number, axis) in device.axes.iter().enumerate() {
        near(*axis, number as f32 / 3.0 - 1.0);
    }
    for (number, button) in device.buttons.iter().enumerate() {
        assert_eq!(button.down, number % 3 == 0, "button {number}");
    }
    let down = Direction::ALL.map(|direction| device.hats[1].button(direction).down);
    assert_eq!(down, [true, true, false, false]);
    near(device.aim()[0], -1.0);
    near(device.aim()[1], 2.0 / 3.0);
}

#[test]
fn missing_controls_are_refused() {
    let sticks = open();
    let stick = stick(&sticks, "Small", 2, 1, 1);
    assert!(!stick.axis(2, 1.0));
    assert!(!stick.button(1, true));
    assert!(!stick.hat(1, &[]));
    let device = device(&sticks, &stick);
    assert_eq!(device.control(Control::Button(7)), Button::default());
    assert_eq!(
        device.control(Control::Pad(PadButton::South)),
        Button::default()
    );
}

#[test]
fn pad_has_the_standard_layout() {
    let (sticks, pad) = open_with_pad();
    for (axis, value) in [0.5, -0.25, -1.0, 1.0, 1.0, 0.0].into_iter().enumerate() {
        assert!(pad.axis(axis, value));
    }
    let layout = device(&sticks, &pad).pad.expect("SDL knows its layout");
    near(layout.left[0], 0.5);
    near(layout.left[1], 0.25);
    near(layout.right[0], -1.0);
    near(layout.right[1], -1.0);
    near(layout.triggers[0], 1.0);
    near(layout.triggers[1], 0.5);

    for button in PadButton::ALL {
        assert!(pad.pad_button(button, true));
        let device = device(&sticks, &pad);
        let down = device
            .controls()
            .filter(|(_, button)| button.down)
            .map(|(control, _)| control);
        assert_eq!(down.collect::<Vec<_>>(), [Control::Pad(button)]);
        assert!(pad.pad_button(button, false));
    }
    let device = device(&sticks, &pad);
    assert!(device.controls().all(|(_, button)| button
        == Button {
            down: false,
            presses: 1
        }));
}

#[test]
fn pad_at_rest_reports_zeros() {
    let (sticks, pad) = open_with_pad();
    let layout = device(&sticks, &pad).pad.expect("SDL knows its layout");
    assert_eq!(
        (layout.left, layout.right, layout.triggers),
        ([0.0; 2], [0.0; 2], [0.0; 2])
    );
}

#[test]
fn presses_between_two_polls_are_counted() {
    let sticks = open();
    let stick = stick(&sticks, "Stick", 2, 2, 1);
    let before = sticks.snapshot();
    for _press in 0..5 {
        stick.button(1, true);
        stick.button(1, false);
        stick.hat(0, &[Direction::Left]);
        stick.hat(0, &[Direction::Left, Direction::Up]);
        stick.hat(0, &[]);
    }
    let now = sticks.snapshot();
    let pressed = |control| Change::Pressed {
        device: stick.id(),
        control,
    };
    let wanted = [
        Control::Button(1),
        Control::Hat(0, Direction::Up),
        Control::Hat(0, Direction::Left),
    ];
    assert_eq!(
        now.since(&before),
        wanted
            .into_iter()
            .flat_map(|control| [pressed(control); 5])
            .collect::<Vec<_>>()
    );
    assert!(now.since(&now).is_empty());
}

#[test]
fn snapshots_report_connections_and_disconnections() {
    let sticks = open();
    let none = sticks.snapshot();
    let first = stick(&sticks, "First", 2, 1, 0);
    let one = sticks.snapshot();
    assert_eq!(one.since(&none), [Change::Connected(first.id())]);

    let id = first.id();
    drop(first);
    let second = stick(&sticks, "First", 2, 1, 0);
    assert_ne!(second.id(), id, "another connection has another id");
    assert_eq!(
        sticks.snapshot().since(&one),
        [Change::Disconnected(id), Change::Connected(second.id())]
    );
}

#[test]
fn device_unplugged_while_held_disappears() {
    let (sticks, pad) = open_with_pad();
    let stick = stick(&sticks, "Stick", 2, 1, 0);
    pad.axis(0, 1.0);
    pad.pad_button(PadButton::South, true);
    stick.button(0, true);
    let before = sticks.snapshot();
    let id = pad.id();
    drop(pad);
    let now = sticks.snapshot();
    assert_eq!(now.since(&before), [Change::Disconnected(id)]);
    assert!(
        device(&sticks, &stick).buttons[0].down,
        "the other device changed"
    );
}

#[test]
fn equal_devices_have_separate_states() {
    let sticks = open();
    let [one, two] = [0, 1].map(|_| sticks.plug_in_pad("Same").expect("valid device"));
    one.axis(0, 1.0);
    two.axis(0, -1.0);
    two.pad_button(PadButton::Start, true);
    let [a, b] = [&one, &two].map(|puppet| device(&sticks, puppet));
    assert_eq!(a.about, b.about);
    near(a.aim()[0], 1.0);
    near(b.aim()[0], -1.0);
    assert_eq!(
        [&a, &b].map(|device| device.control(Control::Pad(PadButton::Start)).presses),
        [0, 1]
    );
}

#[test]
fn twelve_devices_can_be_connected() {
    let sticks = open();
    let puppets: Vec<_> = (0..12)
        .map(|_| sticks.plug_in_pad("Pad").expect("valid device"))
        .collect();
    assert_eq!(sticks.snapshot().devices.len(), 12);
    drop(puppets);
    assert!(sticks.snapshot().devices.is_empty());
}

#[test]
fn sticks_open_once_at_a_time_and_can_be_reopened() {
    let first = open();
    assert!(matches!(Sticks::open(), Err(Error::AlreadyOpen)));
    drop(first);
    for _again in 0..20 {
        let (sticks, pad) = open_with_pad();
        assert!(device(&sticks, &pad).pad.is_some());
    }
}

#[test]
fn virtual_device_may_outlive_the_sticks() {
    let (sticks, pad) = open_with_pad();
    let last = sticks.latest.clone();
    drop(sticks);
    assert!(!pad.pad_button(PadButton::South, true));
    assert!(last.get().devices.is_empty(), "a button is still held");
}

#[test]
fn panic_on_the_thread_releases_all_buttons() {
    let (sticks, pad) = open_with_pad();
    pad.pad_button(PadButton::South, true);
    order(&sticks, |_hub| panic!("intended panic of a test"));
    let end = Instant::now() + Duration::from_secs(5);
    while !sticks.snapshot().devices.is_empty() {
        assert!(
            Instant::now() < end,
            "the thread has ended and the button is still held"
        );
        thread::sleep(Duration::from_millis(1));
    }
    assert!(!pad.pad_button(PadButton::South, false));
    drop((pad, sticks));
    assert!(
        open().snapshot().devices.is_empty(),
        "old devices after reopening"
    );
}

#[test]
fn snapshots_miss_no_press_while_a_device_moves() {
    let (sticks, pad) = open_with_pad();
    let start = sticks.snapshot();
    let seen = thread::scope(|scope| {
        let reader = scope.spawn(|| {
            let (mut seen, mut before) = (0, start.clone());
            while seen < 200 {
                let now = sticks.snapshot();
                seen += now.since(&before).len();
                before = now;
            }
            seen
        });
        for _press in 0..200 {
            pad.pad_button(PadButton::East, true);
            pad.pad_button(PadButton::East, false);
        }
        reader.join().expect("the reader does not panic")
    });
    assert_eq!(seen, 200);
}

#[test]
fn navigator_works_with_a_pad() {
    let (sticks, pad) = open_with_pad();
    let mut navigator = Navigator::default();
    pad.pad_button(PadButton::Down, true);
    assert!(
        navigator.step(&device(&sticks, &pad), 0.0).is_empty(),
        "a button that was already down moves the focus"
    );
    pad.pad_button(PadButton::Down, false);
    for _tap in 0..2 {
        pad.pad_button(PadButton::Right, true);
        pad.pad_button(PadButton::Right, false);
    }
    assert_eq!(
        navigator.step(&device(&sticks, &pad), 0.016),
        [Direction::Right; 2]
    );
    pad.axis(1, 1.0);
    assert_eq!(
        navigator.step(&device(&sticks, &pad), 0.016),
        [Direction::Down]
    );
}

#[cfg(target_os = "linux")]
#[test]
fn sdl_leaves_signal_handlers_alone() {
    let _sticks = open();
    let status =
        std::fs::read_to_string("/proc/self/status").expect("/proc/self/status can be read");
    let caught = status
        .lines()
        .find_map(|line| line.strip_prefix("SigCgt:"))
        .expect("the status has SigCgt");
    let caught = u64::from_str_radix(caught.trim(), 16).expect("SigCgt is hexadecimal");
    let (interrupt, terminate) = (1 << (2 - 1), 1 << (15 - 1));
    assert_eq!(caught & (interrupt | terminate), 0, "SDL caught a signal");
}

fn open() -> Sticks {
    Sticks::open_for_puppets().expect("SDL starts, with or without devices")
}

fn open_with_pad() -> (Sticks, VirtualDevice) {
    let sticks = open();
    let pad = sticks.plug_in_pad("Pad").expect("valid device");
    (sticks, pad)
}

fn stick(sticks: &Sticks, name: &str, axes: u16, buttons: u16, hats: u16) -> VirtualDevice {
    let stick = sticks.plug_in_stick(name, axes, buttons, hats);
    stick.expect("valid device")
}

fn device(sticks: &Sticks, puppet: &VirtualDevice) -> Device {
    sticks
        .snapshot()
        .device(puppet.id())
        .expect("the device is plugged in")
        .clone()
}

/// Sends a task to the thread that owns SDL.
fn order(sticks: &Sticks, task: impl FnOnce(&mut crate::owner::Hub<'_>) + Send + 'static) {
    let orders = sticks.owner.orders().upgrade();
    let sent = orders.expect("the SDL thread runs").send(Box::new(task));
    sent.expect("the SDL thread runs");
}

fn near(is: f32, wanted: f32) {
    assert!((is - wanted).abs() < 1e-4, "{is} is not {wanted}");
}
