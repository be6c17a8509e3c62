//! Force feedback through SDL.

use std::ffi::{c_int, c_void};
use std::marker::PhantomData;
use std::ptr::NonNull;

use sdl3_sys::assert::{
    SDL_ASSERTION_ALWAYS_IGNORE, SDL_AssertData, SDL_AssertState, SDL_SetAssertionHandler,
};
use sdl3_sys::haptic::{
    SDL_CloseHaptic, SDL_CreateHapticEffect, SDL_GetHapticFeatures, SDL_GetNumHapticAxes,
    SDL_HAPTIC_CARTESIAN, SDL_HAPTIC_CONSTANT, SDL_HAPTIC_INFINITY, SDL_Haptic, SDL_HapticConstant,
    SDL_HapticDirection, SDL_HapticEffect, SDL_HapticEffectID, SDL_HapticEffectType,
    SDL_OpenHapticFromJoystick, SDL_RunHapticEffect, SDL_UpdateHapticEffect,
};
use sdl3_sys::init::{SDL_INIT_HAPTIC, SDL_InitSubSystem};
use sdl3_sys::joystick::{
    SDL_GetJoystickProduct, SDL_GetJoystickProperties, SDL_GetJoystickVendor,
    SDL_PROP_JOYSTICK_CAP_RUMBLE_BOOLEAN, SDL_RumbleJoystick,
};
use sdl3_sys::properties::SDL_GetBooleanProperty;

use super::{OpenDevice, Sdl};

/// Assertion handler of SDL that continues after a failed assertion. For example, SDL fails an assertion for
/// a device that was not listed at the start. Without the handler, debug builds of SDL ask on the terminal
/// and block this thread.
unsafe extern "C" fn go_on(_: *const SDL_AssertData, _: *mut c_void) -> SDL_AssertState {
    SDL_ASSERTION_ALWAYS_IGNORE
}

/// Two constant forces of an open device, along x and y. Dropping the value removes the effects.
pub struct Motors<'sdl> {
    haptic: NonNull<SDL_Haptic>,
    effects: [SDL_HapticEffectID; 2],
    /// Duration of the effects after their start [ms].
    length: u32,
    _sdl: PhantomData<&'sdl Sdl>,
}

/// SDL directions of the two forces, for pushes to the right and away from the player. SDL names the side
/// that a force comes from, with x to the right and y towards the player. The directions are constant,
/// because drivers restart an effect when its direction changes.
const FROM: [[i32; 3]; 2] = [[-1, 0, 0], [0, 1, 0]];

impl Sdl {
    /// Starts SDL's haptic subsystem. If this fails, devices can still be read.
    pub(super) fn start_to_feel(&mut self) {
        // SAFETY: see the module; the handler is a function of the program and stays valid.
        self.feels = unsafe {
            SDL_SetAssertionHandler(Some(go_on), std::ptr::null_mut());
            SDL_InitSubSystem(SDL_INIT_HAPTIC)
        };
    }

    /// Opens the motors of a device and uploads zero forces that last `length` [ms], or without limit for
    /// `None`. Returns `None` if the device has no force feedback on two axes, as SDL reports for all pads.
    /// `Motors` must be dropped before the device.
    pub fn motors<'sdl>(
        &'sdl self,
        open: &OpenDevice<'sdl>,
        length: Option<u32>,
    ) -> Option<Motors<'sdl>> {
        if !self.feels {
            return None;
        }
        // SAFETY: see the module; a device without haptics gives null. `drop` closes it. Opening also turns
        // off the centring spring of some sticks and sets the gain to maximum.
        let haptic = unsafe { SDL_OpenHapticFromJoystick(open.joystick.as_ptr()) };
        let mut motors = Motors {
            haptic: NonNull::new(haptic)?,
            effects: [SDL_HapticEffectID(-1); 2],
            length: length.unwrap_or(SDL_HAPTIC_INFINITY),
            _sdl: PhantomData,
        };
        if !motors.has(SDL_HAPTIC_CONSTANT) || motors.axis_count() < 2 {
            return None;
        }
        for axis in 0..2 {
            // SAFETY: as above; SDL copies the effect.
            let effect = unsafe { SDL_CreateHapticEffect(haptic, &motors.effect(axis, 0)) };
            if effect.0 < 0 {
                return None;
            }
            motors.effects[axis] = effect;
        }
        Some(motors)
    }
}

impl OpenDevice<'_> {
    /// Returns the USB vendor id and product id of the device; 0 if unknown.
    pub fn model(&self) -> (u16, u16) {
        let joystick = self.joystick.as_ptr();
        // SAFETY: see the module.
        unsafe {
            (
                SDL_GetJoystickVendor(joystick),
                SDL_GetJoystickProduct(joystick),
            )
        }
    }

    pub fn can_rumble(&self) -> bool {
        // SAFETY: see the module; the name is a zero-terminated constant.
        unsafe {
            let properties = SDL_GetJoystickProperties(self.joystick.as_ptr());
            SDL_GetBooleanProperty(properties, SDL_PROP_JOYSTICK_CAP_RUMBLE_BOOLEAN, false)
        }
    }

    /// Rumbles for `length` [ms] with the strengths of the slow and the fast motor. Returns whether SDL
    /// accepted the call.
    pub fn rumble(&self, low: u16, high: u16, length: u32) -> bool {
        // SAFETY: see the module.
        unsafe { SDL_RumbleJoystick(self.joystick.as_ptr(), low, high, length) }
    }
}

impl Motors<'_> {
    /// Sets the levels of the x and the y force; `anew` also restarts their duration. Returns whether SDL
    /// accepted all changes.
    pub fn push(&self, levels: [i16; 2], anew: bool) -> bool {
        let haptic = self.haptic.as_ptr();
        let mut could = true;
        for (axis, level) in levels.into_iter().enumerate() {
            // SAFETY: see the module; the effect belongs to this device, and SDL copies the new values.
            unsafe {
                let effect = self.effects[axis];
                could &= SDL_UpdateHapticEffect(haptic, effect, &self.effect(axis, level));
                if anew {
                    could &= SDL_RunHapticEffect(haptic, effect, 1);
                }
            }
        }
        could
    }

    fn effect(&self, axis: usize, level: i16) -> SDL_HapticEffect {
        SDL_HapticEffect {
            constant: SDL_HapticConstant {
                r#type: SDL_HAPTIC_CONSTANT,
                direction: SDL_HapticDirection {
                    r#type: SDL_HAPTIC_CARTESIAN,
                    dir: FROM[axis],
                },
                length: self.length,
                level,
                ..SDL_HapticConstant::default()
            },
        }
    }

    fn has(&self, feature: SDL_HapticEffectType) -> bool {
        // SAFETY: see the module.
        let features = unsafe { SDL_GetHapticFeatures(self.haptic.as_ptr()) };
        features & u32::from(feature.0) != 0
    }

    fn axis_count(&self) -> c_int {
        // SAFETY: see the module.
        unsafe { SDL_GetNumHapticAxes(self.haptic.as_ptr()) }
    }
}

impl Drop for Motors<'_> {
    fn drop(&mut self) {
        // SAFETY: see the module; the haptic device is closed as often as it was opened, and SDL removes its
        // effects first.
        unsafe { SDL_CloseHaptic(self.haptic.as_ptr()) };
    }
}
