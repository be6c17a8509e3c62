//! All calls of SDL, and all unsafe code of this crate, behind a safe interface.
//!
//! Safety of every block below:
//! - **One thread.** SDL is process-wide state, and its event pump belongs to the thread that started it. An
//!   [`Sdl`] needs the only [`SdlPermit`], so there is one at a time. `Sdl` is neither `Send` nor `Sync`, and
//!   neither is an [`OpenDevice`], which borrows it. So all calls come from the thread that started SDL,
//!   between `SDL_Init` and `SDL_Quit`.
//! - **Pointers.** An `OpenDevice` holds pointers from SDL, which SDL counts per open call. Dropping the
//!   `OpenDevice` returns each of them once. SDL keeps them valid until then, even if the device is
//!   unplugged: reads then give 0 or false. Indices out of range also give 0 or false. The pointers cannot
//!   outlive SDL, since `OpenDevice` borrows `Sdl`.
//! - **Strings** from SDL are null or zero-terminated. They are copied at once, before the next call that
//!   might change them.
//! - **Events** are a union of plain data, zeroed before SDL writes to it. A member is read only after
//!   checking the event type that belongs to it.

#![allow(unsafe_code)]

#[cfg(feature = "haptic")]
pub mod motors;
#[cfg(any(test, feature = "virtual"))]
pub mod puppets;

use std::ffi::{CStr, c_char, c_int};
use std::marker::PhantomData;
use std::ptr::NonNull;
use std::sync::{Condvar, Mutex, PoisonError};

use sdl3_sys::error::SDL_GetError;
use sdl3_sys::events::{
    SDL_EVENT_FIRST, SDL_EVENT_GAMEPAD_BUTTON_DOWN, SDL_EVENT_JOYSTICK_ADDED,
    SDL_EVENT_JOYSTICK_BUTTON_DOWN, SDL_EVENT_JOYSTICK_HAT_MOTION, SDL_EVENT_JOYSTICK_REMOVED,
    SDL_EVENT_JOYSTICK_UPDATE_COMPLETE, SDL_EVENT_LAST, SDL_Event, SDL_GETEVENT, SDL_PeepEvents,
    SDL_PumpEvents,
};
use sdl3_sys::gamepad::{
    SDL_CloseGamepad, SDL_GAMEPAD_BUTTON_LABEL_A, SDL_GAMEPAD_BUTTON_LABEL_B,
    SDL_GAMEPAD_BUTTON_LABEL_CROSS, SDL_GAMEPAD_BUTTON_SOUTH, SDL_Gamepad, SDL_GamepadAxis,
    SDL_GamepadButton, SDL_GetGamepadAxis, SDL_GetGamepadButton, SDL_GetGamepadButtonLabel,
    SDL_IsGamepad, SDL_OpenGamepad,
};
use sdl3_sys::guid::SDL_GUIDToString;
use sdl3_sys::hints::{
    SDL_HINT_JOYSTICK_ALLOW_BACKGROUND_EVENTS, SDL_HINT_JOYSTICK_HIDAPI,
    SDL_HINT_JOYSTICK_HIDAPI_LG4FF, SDL_HINT_NO_SIGNAL_HANDLERS, SDL_HINT_OVERRIDE,
    SDL_SetHintWithPriority,
};
use sdl3_sys::init::{SDL_INIT_GAMEPAD, SDL_Init, SDL_Quit};
use sdl3_sys::joystick::{
    SDL_CloseJoystick, SDL_GetJoystickAxis, SDL_GetJoystickButton, SDL_GetJoystickGUID,
    SDL_GetJoystickHat, SDL_GetJoystickName, SDL_GetNumJoystickAxes, SDL_GetNumJoystickButtons,
    SDL_GetNumJoystickHats, SDL_HAT_DOWN, SDL_HAT_LEFT, SDL_HAT_RIGHT, SDL_HAT_UP, SDL_Joystick,
    SDL_JoystickID, SDL_OpenJoystick,
};

use crate::{DeviceId, DeviceInfo, Direction, Labels, PadButton};

/// Permission to run SDL. Only one exists in a process, so SDL is never started twice at a time.
pub struct SdlPermit(());

/// SDL while it runs. Stays on the thread that started it.
pub struct Sdl {
    _turn: SdlPermit,
    /// Whether force feedback is available.
    #[cfg(feature = "haptic")]
    feels: bool,
    _stays_on_this_thread: PhantomData<*const ()>,
}

/// An open device.
pub struct OpenDevice<'sdl> {
    joystick: NonNull<SDL_Joystick>,
    gamepad: Option<NonNull<SDL_Gamepad>>,
    _sdl: PhantomData<&'sdl Sdl>,
}

/// Event of a device.
#[derive(Clone, Copy, Debug)]
pub enum DeviceEvent {
    Added,
    Removed,
    Moved(ControlEvent),
}

/// Control of a device that may have changed.
#[derive(Clone, Copy, Debug)]
pub enum ControlEvent {
    ButtonDown(usize),
    PadButtonDown(usize),
    Hat(usize, HatBits),
    /// All controls: SDL has finished an update of the device. Includes changes that were already reported.
    All,
}

/// Pressed directions of a hat, one bit per direction, as SDL defines them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct HatBits(pub u8);

/// Whether no thread runs SDL at present. Only one thread at a time may run it.
static TURN: Mutex<bool> = Mutex::new(true);
static GIVEN_BACK: Condvar = Condvar::new();

impl SdlPermit {
    /// Takes the permission to run SDL, or returns `None` if it is in use. Dropping the permission returns
    /// it.
    pub fn take() -> Option<SdlPermit> {
        let mut free = TURN.lock().unwrap_or_else(PoisonError::into_inner);
        std::mem::take(&mut *free).then(|| SdlPermit(()))
    }

    /// Waits until the permission is available and takes it.
    #[cfg(any(test, feature = "virtual"))]
    pub fn wait() -> SdlPermit {
        let free = TURN.lock().unwrap_or_else(PoisonError::into_inner);
        let wait = GIVEN_BACK.wait_while(free, |free| !*free);
        *wait.unwrap_or_else(PoisonError::into_inner) = false;
        SdlPermit(())
    }
}

impl Drop for SdlPermit {
    fn drop(&mut self) {
        *TURN.lock().unwrap_or_else(PoisonError::into_inner) = true;
        GIVEN_BACK.notify_one();
    }
}

impl Sdl {
    pub fn start(turn: SdlPermit) -> Result<Sdl, String> {
        #[allow(unused_mut, reason = "changed only with the feature haptic")]
        let mut sdl = Sdl {
            _turn: turn,
            #[cfg(feature = "haptic")]
            feels: false,
            _stays_on_this_thread: PhantomData,
        };
        // SAFETY: see the module; the hints are zero-terminated constants. Reasons for the hints:
        // - Signals: the program handles them itself.
        // - Background events: without a window SDL never considers itself in the background, but drivers
        //   check the hint.
        // - Logitech wheels use the kernel driver: SDL 3.4 reads the wrong structure when it compares a
        //   haptic device of its own driver with another.
        // - On Linux all devices use the kernel driver: the kernel ends the effects of a killed process,
        //   which SDL's own drivers cannot.
        let started = unsafe {
            let set = |hint, value: &CStr| {
                SDL_SetHintWithPriority(hint, value.as_ptr(), SDL_HINT_OVERRIDE)
            };
            set(SDL_HINT_NO_SIGNAL_HANDLERS, c"1");
            set(SDL_HINT_JOYSTICK_ALLOW_BACKGROUND_EVENTS, c"1");
            set(SDL_HINT_JOYSTICK_HIDAPI_LG4FF, c"0");
            if cfg!(target_os = "linux") {
                set(SDL_HINT_JOYSTICK_HIDAPI, c"0");
            }
            SDL_Init(SDL_INIT_GAMEPAD)
        };
        if !started {
            return Err(sdl.error());
        }
        #[cfg(feature = "haptic")]
        sdl.start_to_feel();
        Ok(sdl)
    }

    /// Calls `happened` with each device event since the last call.
    pub fn pump(&self, mut happened: impl FnMut(DeviceId, DeviceEvent)) {
        // SAFETY: see the module.
        unsafe { SDL_PumpEvents() };
        let mut event = SDL_Event::default();
        // SAFETY: there is room for the one requested event.
        while unsafe {
            SDL_PeepEvents(
                &mut event,
                1,
                SDL_GETEVENT,
                SDL_EVENT_FIRST.0,
                SDL_EVENT_LAST.0,
            )
        } == 1
        {
            if let Some((id, what)) = read(&event) {
                happened(id, what);
            }
        }
    }

    /// Opens a device, as a pad if SDL knows its layout. Returns `None` if the device was unplugged or the
    /// user may not read it.
    pub fn open(&self, id: DeviceId) -> Option<OpenDevice<'_>> {
        let id = SDL_JoystickID(id.0);
        // SAFETY: see the module; an unknown id gives null.
        let joystick = NonNull::new(unsafe { SDL_OpenJoystick(id) })?;
        // SAFETY: as above.
        let gamepad = if unsafe { SDL_IsGamepad(id) } {
            NonNull::new(unsafe { SDL_OpenGamepad(id) })
        } else {
            None
        };
        Some(OpenDevice {
            joystick,
            gamepad,
            _sdl: PhantomData,
        })
    }

    fn error(&self) -> String {
        // SAFETY: see the module.
        unsafe { text(SDL_GetError()) }
    }
}

impl Drop for Sdl {
    fn drop(&mut self) {
        // SAFETY: no device is open, since each open device borrows `self`.
        unsafe { SDL_Quit() };
    }
}

impl OpenDevice<'_> {
    pub fn about(&self) -> DeviceInfo {
        let mut guid = [0 as c_char; 33];
        // SAFETY: see the module; a GUID with its terminating zero needs 33 bytes, and SDL gets the length.
        unsafe {
            let guid_of = SDL_GetJoystickGUID(self.joystick.as_ptr());
            SDL_GUIDToString(guid_of, guid.as_mut_ptr(), guid.len() as c_int);
            DeviceInfo {
                name: text(SDL_GetJoystickName(self.joystick.as_ptr())),
                guid: text(guid.as_ptr()),
                labels: self.labels(),
            }
        }
    }

    /// Returns the label set of a pad. It follows from the label of the lowest button under the right thumb.
    fn labels(&self) -> Labels {
        let Some(gamepad) = self.gamepad else {
            return Labels::Unknown;
        };
        // SAFETY: see the module.
        let lowest =
            unsafe { SDL_GetGamepadButtonLabel(gamepad.as_ptr(), SDL_GAMEPAD_BUTTON_SOUTH) };
        match lowest {
            SDL_GAMEPAD_BUTTON_LABEL_A => Labels::Letters,
            SDL_GAMEPAD_BUTTON_LABEL_B => Labels::Mirrored,
            SDL_GAMEPAD_BUTTON_LABEL_CROSS => Labels::Shapes,
            _ => Labels::Unknown,
        }
    }

    pub fn axis_count(&self) -> usize {
        // SAFETY: see the module; this also holds for the next two calls.
        count(unsafe { SDL_GetNumJoystickAxes(self.joystick.as_ptr()) })
    }

    pub fn button_count(&self) -> usize {
        count(unsafe { SDL_GetNumJoystickButtons(self.joystick.as_ptr()) })
    }

    pub fn hat_count(&self) -> usize {
        count(unsafe { SDL_GetNumJoystickHats(self.joystick.as_ptr()) })
    }

    /// Returns the value of an axis, −1 to 1; 0 if there is no such axis.
    pub fn axis(&self, axis: usize) -> f32 {
        // SAFETY: see the module; this also holds for the next two calls.
        unit(unsafe { SDL_GetJoystickAxis(self.joystick.as_ptr(), axis as c_int) })
    }

    pub fn button(&self, button: usize) -> bool {
        unsafe { SDL_GetJoystickButton(self.joystick.as_ptr(), button as c_int) }
    }

    pub fn hat(&self, hat: usize) -> HatBits {
        HatBits(unsafe { SDL_GetJoystickHat(self.joystick.as_ptr(), hat as c_int) })
    }

    pub fn is_pad(&self) -> bool {
        self.gamepad.is_some()
    }

    /// Returns the value of a pad axis, −1 to 1, with y towards the player; 0 if the device is not a pad.
    pub fn pad_axis(&self, axis: SDL_GamepadAxis) -> f32 {
        // SAFETY: see the module.
        self.gamepad.map_or(0.0, |pad| {
            unit(unsafe { SDL_GetGamepadAxis(pad.as_ptr(), axis) })
        })
    }

    pub fn pad_button(&self, button: PadButton) -> bool {
        let number = SDL_GamepadButton(button as c_int);
        // SAFETY: see the module.
        self.gamepad
            .is_some_and(|pad| unsafe { SDL_GetGamepadButton(pad.as_ptr(), number) })
    }
}

impl Drop for OpenDevice<'_> {
    fn drop(&mut self) {
        // SAFETY: see the module; each pointer is closed as often as it was opened.
        unsafe {
            if let Some(gamepad) = self.gamepad {
                SDL_CloseGamepad(gamepad.as_ptr());
            }
            SDL_CloseJoystick(self.joystick.as_ptr());
        }
    }
}

impl HatBits {
    pub fn has(self, direction: Direction) -> bool {
        self.0 & HatBits::bit(direction) != 0
    }

    fn bit(direction: Direction) -> u8 {
        match direction {
            Direction::Up => SDL_HAT_UP,
            Direction::Right => SDL_HAT_RIGHT,
            Direction::Down => SDL_HAT_DOWN,
            Direction::Left => SDL_HAT_LEFT,
        }
    }
}

/// Converts an event of SDL; `None` if it does not concern a device's state.
fn read(event: &SDL_Event) -> Option<(DeviceId, DeviceEvent)> {
    // SAFETY: SDL fills in the member that belongs to the type of the event.
    let (id, what) = unsafe {
        match event.event_type() {
            SDL_EVENT_JOYSTICK_ADDED => (event.jdevice.which, DeviceEvent::Added),
            SDL_EVENT_JOYSTICK_REMOVED => (event.jdevice.which, DeviceEvent::Removed),
            SDL_EVENT_JOYSTICK_BUTTON_DOWN => {
                let moved = ControlEvent::ButtonDown(event.jbutton.button.into());
                (event.jbutton.which, DeviceEvent::Moved(moved))
            }
            SDL_EVENT_GAMEPAD_BUTTON_DOWN => {
                let moved = ControlEvent::PadButtonDown(event.gbutton.button.into());
                (event.gbutton.which, DeviceEvent::Moved(moved))
            }
            SDL_EVENT_JOYSTICK_HAT_MOTION => {
                let moved = ControlEvent::Hat(event.jhat.hat.into(), HatBits(event.jhat.value));
                (event.jhat.which, DeviceEvent::Moved(moved))
            }
            SDL_EVENT_JOYSTICK_UPDATE_COMPLETE => {
                (event.jdevice.which, DeviceEvent::Moved(ControlEvent::All))
            }
            _ => return None,
        }
    };
    Some((DeviceId(id.0), what))
}

/// Maps the range −32768 to 32767 to −1 to 1. Maps 0 to exactly 0.
fn unit(value: i16) -> f32 {
    f32::from(value) / if value < 0 { 32768.0 } else { 32767.0 }
}

/// Converts a count from SDL, which is −1 for an unknown device; the result is then 0.
fn count(number: c_int) -> usize {
    usize::try_from(number).unwrap_or(0)
}

/// # Safety
/// `from` is null, or a zero-terminated string that does not change during the call.
unsafe fn text(from: *const c_char) -> String {
    if from.is_null() {
        return String::new();
    }
    // SAFETY: the caller guarantees a zero-terminated string, and the pointer is not null.
    unsafe { CStr::from_ptr(from) }
        .to_string_lossy()
        .into_owned()
}
