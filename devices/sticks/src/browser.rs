//! Module `owner` of builds for browsers: reads pads through the Gamepad API (W3C) each time a snapshot is
//! taken. A browser shows a pad only after one of its buttons was pressed.

use crate::latest::{Error, Latest};
use crate::{Button, Device, DeviceId, DeviceInfo, Labels, PadButton, Snapshot};
use js_sys::Array;
use std::sync::{Arc, Mutex, PoisonError};
use wasm_bindgen::JsCast;
use wasm_bindgen::prelude::*;

#[wasm_bindgen]
extern "C" {
    #[wasm_bindgen(catch, js_namespace = navigator, js_name = getGamepads)]
    fn get_gamepads() -> Result<Array, JsValue>;

    pub type Gamepad;
    #[wasm_bindgen(method, getter)]
    fn id(this: &Gamepad) -> String;
    #[wasm_bindgen(method, getter)]
    pub fn index(this: &Gamepad) -> u32;
    #[wasm_bindgen(method, getter)]
    fn connected(this: &Gamepad) -> bool;
    #[wasm_bindgen(method, getter)]
    fn mapping(this: &Gamepad) -> String;
    #[wasm_bindgen(method, getter)]
    fn axes(this: &Gamepad) -> Vec<f64>;
    #[wasm_bindgen(method, getter)]
    fn buttons(this: &Gamepad) -> Array;
    #[cfg(feature = "haptic")]
    #[wasm_bindgen(method, getter, js_name = vibrationActuator)]
    pub fn actuator(this: &Gamepad) -> Option<Actuator>;

    type GamepadButton;
    #[wasm_bindgen(method, getter)]
    fn pressed(this: &GamepadButton) -> bool;
    #[wasm_bindgen(method, getter)]
    fn value(this: &GamepadButton) -> f64;

    #[cfg(feature = "haptic")]
    pub type Actuator;
    #[cfg(feature = "haptic")]
    #[wasm_bindgen(method, catch, js_name = playEffect)]
    pub fn play_effect(
        this: &Actuator,
        kind: &str,
        parameters: &JsValue,
    ) -> Result<JsValue, JsValue>;
    #[cfg(feature = "haptic")]
    #[wasm_bindgen(method, catch)]
    pub fn reset(this: &Actuator) -> Result<JsValue, JsValue>;
}

/// Buttons of the standard layout in the order of the Gamepad API, which treats the triggers, 6 and 7, as
/// buttons. `None` stands for a trigger.
const STANDARD: [Option<PadButton>; 17] = {
    use PadButton::*;
    [
        Some(South),
        Some(East),
        Some(West),
        Some(North),
        Some(LeftShoulder),
        Some(RightShoulder),
        None,
        None,
        Some(Back),
        Some(Start),
        Some(LeftStick),
        Some(RightStick),
        Some(Up),
        Some(Down),
        Some(Left),
        Some(Right),
        Some(Guide),
    ]
};
const TRIGGERS: [usize; 2] = [6, 7];

/// Reader of the browser's pads.
pub struct Owner {
    latest: Latest,
    /// Devices of the last snapshot with their indices in the browser's list of pads, and the number of
    /// devices seen since the start.
    places: Mutex<(Vec<(DeviceId, u32)>, u32)>,
}

impl Owner {
    pub fn start(latest: Latest) -> Result<Owner, Error> {
        let places = Mutex::default();
        Ok(Owner { latest, places })
    }

    /// Takes a new snapshot.
    pub fn look(&self) {
        let before = self.latest.get();
        let mut places = self.places.lock().unwrap_or_else(PoisonError::into_inner);
        let (known, count) = &mut *places;
        let pads = pads();
        known.retain(|(_, place)| pads.iter().any(|pad| pad.index() == *place));
        for pad in &pads {
            if known.iter().all(|(_, place)| *place != pad.index()) {
                *count += 1;
                known.push((DeviceId(*count), pad.index()));
            }
        }
        let devices = known.iter().filter_map(|&(id, place)| {
            let pad = pads.iter().find(|pad| pad.index() == place)?;
            Some(device(id, pad, before.device(id)))
        });
        let devices = devices.collect();
        self.latest.set(Snapshot { devices });
    }

    #[cfg(feature = "haptic")]
    pub fn place(&self, id: DeviceId) -> Option<u32> {
        let places = self.places.lock().unwrap_or_else(PoisonError::into_inner);
        let known = places.0.iter().find(|(known, _)| *known == id);
        known.map(|(_, place)| *place)
    }
}

/// Returns the connected pads, or no pads if the page may not read them.
pub fn pads() -> Vec<Gamepad> {
    let list = get_gamepads().unwrap_or_default();
    let there = list.iter().filter(|pad| !pad.is_falsy());
    let pads = there.map(JsCast::unchecked_into::<Gamepad>);
    pads.filter(Gamepad::connected).collect()
}

fn device(id: DeviceId, pad: &Gamepad, before: Option<&Device>) -> Device {
    let axes: Vec<f32> = pad.axes().iter().map(|axis| *axis as f32).collect();
    let buttons = pad.buttons();
    let buttons: Vec<_> = buttons.iter().map(JsCast::unchecked_into).collect();
    let is_down = |button: usize| buttons.get(button).is_some_and(GamepadButton::pressed);
    let about = match before {
        Some(before) => before.about.clone(),
        None => Arc::new(about(&pad.id())),
    };
    let count = |index: usize| {
        let before = before.and_then(|before| before.buttons.get(index));
        counted(before.copied().unwrap_or_default(), is_down(index))
    };
    let is_standard = pad.mapping() == "standard";
    Device {
        id,
        about,
        buttons: (0..buttons.len()).map(count).collect(),
        hats: Vec::new(),
        pad: is_standard.then(|| {
            let axis = |index: usize| axes.get(index).copied().unwrap_or(0.0);
            let trigger = |index: usize| buttons.get(index).map_or(0.0, |k| k.value() as f32);
            let mut standard = before.and_then(|before| before.pad).unwrap_or_default();
            standard.left = [axis(0), -axis(1)];
            standard.right = [axis(2), -axis(3)];
            standard.triggers = TRIGGERS.map(trigger);
            for (index, button) in STANDARD.into_iter().enumerate() {
                if let Some(button) = button {
                    let before = standard.button(button);
                    *standard.button_mut(button) = counted(before, is_down(index));
                }
            }
            standard
        }),
        axes,
    }
}

/// Returns the button with its new state, and counts a press if it has just gone down.
fn counted(mut button: Button, is_down: bool) -> Button {
    if is_down && !button.down {
        button.press();
    }
    button.down = is_down;
    button
}

/// Parses the text by which the browser identifies a pad. Chromium writes `Name (STANDARD GAMEPAD Vendor:
/// 045e Product: 02ea)`, Firefox `045e-02ea-Name`.
fn about(id: &str) -> DeviceInfo {
    let chromium = || -> Option<_> {
        let (name, rest) = id.split_once(" (")?;
        let vendor = rest.split_once("Vendor: ")?.1.get(..4)?;
        let product = rest.split_once("Product: ")?.1.get(..4)?;
        Some((name, vendor, product))
    };
    let firefox = || -> Option<_> {
        let mut parts = id.splitn(3, '-');
        let (vendor, product) = (parts.next()?, parts.next()?);
        (vendor.len() == 4 && product.len() == 4).then_some((parts.next()?, vendor, product))
    };
    let (name, vendor, product) = chromium().or_else(firefox).unwrap_or((id, "", ""));
    let maker = name.to_lowercase();
    let is = |vendors: &[&str], names: &[&str]| {
        vendors.contains(&vendor) || names.iter().any(|name| maker.contains(name))
    };
    let labels = if is(&["054c"], &["dualshock", "dualsense", "playstation"]) {
        Labels::Shapes
    } else if is(&["057e"], &["nintendo", "joy-con"]) {
        Labels::Mirrored
    } else if is(&["045e"], &["xbox", "xinput"]) {
        Labels::Letters
    } else {
        Labels::Unknown
    };
    // Builds a GUID like the first half of SDL's from the vendor and product numbers. Without these numbers,
    // uses the beginning of the pad's name.
    let known = match vendor {
        "" => name.bytes().map(|byte| format!("{byte:02x}")).collect(),
        _ => format!("0000{vendor}0000{product}"),
    };
    let guid = format!("{known:0<32.32}");
    let name = name.trim().to_string();
    DeviceInfo { name, guid, labels }
}
