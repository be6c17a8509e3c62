//! Virtual devices that SDL simulates.

use std::ffi::{CString, c_int, c_void};
use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};

use sdl3_sys::joystick::{
    SDL_AttachVirtualJoystick, SDL_DetachVirtualJoystick, SDL_IsJoystickVirtual,
    SDL_JOYSTICK_TYPE_FLIGHT_STICK, SDL_JOYSTICK_TYPE_GAMEPAD, SDL_JoystickID,
    SDL_SetJoystickVirtualAxis, SDL_SetJoystickVirtualButton, SDL_SetJoystickVirtualHat,
    SDL_VirtualJoystickDesc,
};

use super::{HatBits, OpenDevice, Sdl};
use crate::{DeviceId, Direction, PadButton};

/// Kind of a virtual device, with its numbers of controls.
#[derive(Clone, Copy, Debug)]
pub enum PuppetForm {
    Pad,
    Stick { axes: u16, buttons: u16, hats: u16 },
}

/// Rumble strengths that SDL last sent to a virtual device.
#[derive(Clone, Debug, Default)]
pub struct Rumble(Arc<AtomicU32>);

impl Rumble {
    /// Returns the rumble strengths of the slow and the fast motor, 0 to 65535.
    pub fn get(&self) -> [u16; 2] {
        let both = self.0.load(Ordering::Relaxed);
        [(both >> 16) as u16, both as u16]
    }
}

/// # Safety
/// `rumble` is the pointer given to SDL by `plug_in`.
unsafe extern "C" fn take_rumble(rumble: *mut c_void, low: u16, high: u16) -> bool {
    // SAFETY: guaranteed by the caller; valid until `clean_up`.
    let rumble = unsafe { &*rumble.cast::<AtomicU32>() };
    rumble.store(u32::from(low) << 16 | u32::from(high), Ordering::Relaxed);
    true
}

/// # Safety
/// `rumble` is the pointer given to SDL by `plug_in`, and it is not used after this call.
unsafe extern "C" fn clean_up(rumble: *mut c_void) {
    // SAFETY: guaranteed by the caller.
    drop(unsafe { Arc::from_raw(rumble.cast_const().cast::<AtomicU32>()) });
}

/// Change of a control of a virtual device.
#[derive(Clone, Copy, Debug)]
pub enum PuppetAct {
    Axis(usize, i16),
    Button(usize, bool),
    Hat(usize, HatBits),
}

impl Sdl {
    /// Plugs in a virtual device. The device stays until it is unplugged or SDL ends.
    pub fn plug_in(
        &self,
        name: &str,
        form: PuppetForm,
        rumble: &Rumble,
    ) -> Result<DeviceId, String> {
        let name = CString::new(name).map_err(|error| error.to_string())?;
        let mut wish = SDL_VirtualJoystickDesc::new();
        wish.name = name.as_ptr();
        let kind;
        (kind, wish.naxes, wish.nbuttons, wish.nhats) = match form {
            PuppetForm::Pad => (SDL_JOYSTICK_TYPE_GAMEPAD, 6, PadButton::ALL.len() as u16, 0),
            PuppetForm::Stick {
                axes,
                buttons,
                hats,
            } => (SDL_JOYSTICK_TYPE_FLIGHT_STICK, axes, buttons, hats),
        };
        wish.r#type = kind.0 as u16;
        let given = Arc::into_raw(rumble.0.clone()).cast_mut().cast::<c_void>();
        wish.userdata = given;
        wish.Rumble = Some(take_rumble);
        wish.Cleanup = Some(clean_up);
        // SAFETY: see the module; SDL copies the description and its name, and the callbacks are functions of
        // the program. SDL passes `userdata` to `clean_up` when the device is removed. If SDL refuses the
        // device, it is unknown whether `clean_up` was called: a test then leaks a few bytes rather than
        // freeing them twice.
        match unsafe { SDL_AttachVirtualJoystick(&wish) } {
            SDL_JoystickID(0) => Err(self.error()),
            SDL_JoystickID(id) => Ok(DeviceId(id)),
        }
    }

    pub fn unplug(&self, id: DeviceId) {
        // SAFETY: see the module; an unknown id is refused.
        unsafe { SDL_DetachVirtualJoystick(SDL_JoystickID(id.0)) };
    }

    pub fn is_puppet(&self, id: DeviceId) -> bool {
        // SAFETY: as above.
        unsafe { SDL_IsJoystickVirtual(SDL_JoystickID(id.0)) }
    }
}

impl OpenDevice<'_> {
    /// Changes a control of a virtual device. Returns whether the control exists.
    pub fn act(&self, act: PuppetAct) -> bool {
        let joystick = self.joystick.as_ptr();
        // SAFETY: see the module; SDL refuses other devices and indices out of range.
        unsafe {
            match act {
                PuppetAct::Axis(axis, value) => {
                    SDL_SetJoystickVirtualAxis(joystick, axis as c_int, value)
                }
                PuppetAct::Button(button, down) => {
                    SDL_SetJoystickVirtualButton(joystick, button as c_int, down)
                }
                PuppetAct::Hat(hat, bits) => {
                    SDL_SetJoystickVirtualHat(joystick, hat as c_int, bits.0)
                }
            }
        }
    }
}

impl HatBits {
    pub fn of(directions: &[Direction]) -> HatBits {
        HatBits(
            directions
                .iter()
                .fold(0, |bits, direction| bits | HatBits::bit(*direction)),
        )
    }
}
