//! Prints the state of all sticks and pads until interrupted: `cargo run -p sticks --example list`.

use std::sync::Arc;
use std::thread::sleep;
use std::time::Duration;

use sticks::{Change, Device, Snapshot, Sticks};

fn main() -> Result<(), sticks::Error> {
    let sticks = Sticks::open()?;
    println!("Plug in a stick or a pad, move it, press its buttons. Ctrl+C exits.");
    let mut before = Arc::new(Snapshot::default());
    loop {
        let now = sticks.snapshot();
        for change in now.since(&before) {
            println!("{change:?}");
            if let Change::Connected(id) = change
                && let Some(device) = now.device(id)
            {
                describe(device);
            }
        }
        for device in &now.devices {
            if before.device(device.id) != Some(device) {
                println!("{}", line(device));
            }
        }
        before = now;
        sleep(Duration::from_millis(50));
    }
}

fn describe(device: &Device) {
    let kind = if device.pad.is_some() { "pad" } else { "stick" };
    let [axes, buttons, hats] = [device.axes.len(), device.buttons.len(), device.hats.len()];
    println!(
        "  {kind} {:?}, model {}",
        device.about.name, device.about.guid
    );
    println!("  {axes} axes, {buttons} buttons, {hats} hats");
}

fn line(device: &Device) -> String {
    let axes: Vec<_> = device
        .axes
        .iter()
        .map(|axis| format!("{axis:+.2}"))
        .collect();
    let down: Vec<_> = device
        .controls()
        .filter(|(_, button)| button.down)
        .map(|(control, _)| control)
        .collect();
    format!("  {:?} {} {down:?}", device.id, axes.join(" "))
}
