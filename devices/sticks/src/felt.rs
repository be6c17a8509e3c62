//! Feedback of pads in browsers. Browsers support rumble only.

use crate::latest::Latest;
use crate::owner::{Actuator, Gamepad, pads};
use crate::{DeviceId, Sticks};
use force_feedback::{Ability, Gone, OUTPUT_DURATION, Output, Sink};
use js_sys::{Object, Promise, Reflect};
use wasm_bindgen::JsValue;
use wasm_bindgen_futures::JsFuture;

/// Pad as a sink of `force_feedback`; browsers support rumble only.
pub struct Haptic {
    id: DeviceId,
    place: Option<u32>,
    latest: Latest,
}

impl Sticks {
    /// Returns the sink of a device. If the device is missing or has no motors, the sink plays nothing.
    pub fn haptic(&self, id: DeviceId) -> Haptic {
        let (place, latest) = (self.owner.place(id), self.latest.clone());
        Haptic { id, place, latest }
    }
}

impl Haptic {
    fn actuator(&self) -> Option<Actuator> {
        let place = self.place?;
        let pads = pads();
        let pad = pads.iter().find(|pad| pad.index() == place);
        pad.and_then(Gamepad::actuator)
    }
}

impl Sink for Haptic {
    fn ability(&self) -> Ability {
        match self.actuator() {
            Some(_) => Ability::Rumble,
            None => Ability::Nothing,
        }
    }

    fn stick_position(&mut self) -> Result<[f32; 2], Gone> {
        let latest = self.latest.get();
        latest
            .device(self.id)
            .map(|device| device.aim())
            .ok_or(Gone)
    }

    fn play(&mut self, output: Output) -> Result<(), Gone> {
        let (Some(actuator), Output::Rumble { low, high }) = (self.actuator(), output) else {
            return Ok(());
        };
        if output.is_zero() {
            // `reset` ends the effect at once. A browser without `reset` lets the effect run out.
            return actuator.reset().map_or(Ok(()), forget);
        }
        let parameters = Object::new();
        let numbers = [
            ("duration", OUTPUT_DURATION.as_millis() as f64),
            ("strongMagnitude", f64::from(low.clamp(0.0, 1.0))),
            ("weakMagnitude", f64::from(high.clamp(0.0, 1.0))),
        ];
        for (name, number) in numbers {
            // Setting a property of a new object cannot fail.
            let _ = Reflect::set(&parameters, &JsValue::from(name), &JsValue::from(number));
        }
        // Does not wait for the promise, which resolves only when the effect ends or is replaced.
        let played = actuator.play_effect("dual-rumble", &parameters);
        played.map_err(|_| Gone).and_then(forget)
    }
}

/// Ignores the result of a promise: pads that cannot rumble reject the promise later, and nothing depends on
/// it.
fn forget(promise: JsValue) -> Result<(), Gone> {
    wasm_bindgen_futures::spawn_local(async move {
        let _ = JsFuture::from(Promise::resolve(&promise)).await;
    });
    Ok(())
}
