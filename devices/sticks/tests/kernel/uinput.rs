//! Virtual stick with motors for a real kernel: records the commands of the driver with their times.
//!
//! See the kernel's `Documentation/input/uinput.rst` and `Documentation/input/ff.rst`.

use std::ffi::c_int;
use std::fs::{File, OpenOptions};
use std::io::{self, Read, Write};
use std::os::fd::AsRawFd;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use libc::{
    _IO, _IOW, _IOWR, Ioctl, POLLIN, ff_effect, input_event, pollfd, uinput_abs_setup,
    uinput_ff_erase, uinput_ff_upload, uinput_setup,
};

const EV_SYN: u16 = 0;
const EV_KEY: u16 = 1;
const EV_ABS: u16 = 3;
const EV_FF: u16 = 0x15;
/// Event type of requests from the kernel to the virtual device.
const EV_UINPUT: u16 = 0x101;
const UI_FF_UPLOAD: u16 = 1;
const UI_FF_ERASE: u16 = 2;

const BTN_TRIGGER: u16 = 0x120;
const FF_CONSTANT: u16 = 0x52;
const FF_GAIN: u16 = 0x60;
const FF_AUTOCENTER: u16 = 0x61;

const U: u32 = b'U' as u32;
const UI_DEV_CREATE: Ioctl = _IO(U, 1);
const UI_DEV_DESTROY: Ioctl = _IO(U, 2);
const UI_DEV_SETUP: Ioctl = _IOW::<uinput_setup>(U, 3);
const UI_ABS_SETUP: Ioctl = _IOW::<uinput_abs_setup>(U, 4);
const UI_SET_EVBIT: Ioctl = _IOW::<c_int>(U, 100);
const UI_SET_KEYBIT: Ioctl = _IOW::<c_int>(U, 101);
const UI_SET_FFBIT: Ioctl = _IOW::<c_int>(U, 107);
const UI_BEGIN_FF_UPLOAD: Ioctl = _IOWR::<uinput_ff_upload>(U, 200);
const UI_END_FF_UPLOAD: Ioctl = _IOW::<uinput_ff_upload>(U, 201);
const UI_BEGIN_FF_ERASE: Ioctl = _IOWR::<uinput_ff_erase>(U, 202);
const UI_END_FF_ERASE: Ioctl = _IOW::<uinput_ff_erase>(U, 203);

/// Largest value of an axis in each direction, in device units.
const RIM: f32 = 1000.0;

/// Virtual stick, plugged in until it is dropped.
pub struct Stick {
    desk: Arc<Desk>,
    listener: Option<JoinHandle<()>>,
}

/// Data shared by the test and the thread that answers the kernel.
struct Desk {
    file: File,
    told: Mutex<Vec<Told>>,
    is_plugged_in: AtomicBool,
}

/// Command of the kernel's driver, with its time.
#[derive(Clone, Copy, Debug)]
pub struct Told {
    pub at: Instant,
    pub what: What,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum What {
    /// Creates or changes an effect.
    Upload(Effect),
    /// Starts an effect that is played `times` times; 0 ends the effect.
    Play { id: i16, times: i32 },
    /// Removes an effect.
    Erase { id: i16 },
    /// Sets the strength of the centring spring.
    Autocentre(i32),
    /// Sets the overall gain.
    Gain(i32),
}

/// Constant force effect.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Effect {
    pub id: i16,
    /// Direction of the push: 0 towards the player, 0x4000 to the left, 0x8000 away, 0xc000 to the right.
    pub direction: u16,
    pub level: i16,
    /// Duration after the start; zero is unlimited.
    pub length: Duration,
    pub delay: Duration,
}

impl Stick {
    /// Plugs in an upright stick with two axes, four buttons and room for 16 effects.
    pub fn plug_in() -> io::Result<Stick> {
        let file = OpenOptions::new()
            .read(true)
            .write(true)
            .open("/dev/uinput")?;
        for kind in [EV_KEY, EV_ABS, EV_FF] {
            number(&file, UI_SET_EVBIT, kind)?;
        }
        for button in BTN_TRIGGER..BTN_TRIGGER + 4 {
            number(&file, UI_SET_KEYBIT, button)?;
        }
        for effect in [FF_CONSTANT, FF_GAIN, FF_AUTOCENTER] {
            number(&file, UI_SET_FFBIT, effect)?;
        }
        for code in 0..2 {
            let mut axis: uinput_abs_setup = zeroed();
            axis.code = code;
            (axis.absinfo.minimum, axis.absinfo.maximum) = (-RIM as i32, RIM as i32);
            structure(&file, UI_ABS_SETUP, &mut axis)?;
        }
        let mut setup: uinput_setup = zeroed();
        // USB, with the vendor and product id that pid.codes reserves for tests.
        (setup.id.bustype, setup.id.vendor, setup.id.product) = (3, 0x1209, 1);
        for (to, from) in setup.name.iter_mut().zip(b"Virtual stick") {
            *to = *from as _;
        }
        setup.ff_effects_max = 16;
        structure(&file, UI_DEV_SETUP, &mut setup)?;
        nothing(&file, UI_DEV_CREATE)?;

        let desk = Arc::new(Desk {
            file,
            told: Mutex::default(),
            is_plugged_in: AtomicBool::new(true),
        });
        let on_thread = desk.clone();
        let listener = std::thread::spawn(move || on_thread.listen());
        Ok(Stick {
            desk,
            listener: Some(listener),
        })
    }

    /// Moves the stick: x to the right, y away from the player, each −1 to 1.
    pub fn lean(&self, [x, y]: [f32; 2]) -> io::Result<()> {
        // In the kernel y increases towards the player.
        for (code, place) in [(0, x), (1, -y)] {
            self.say(EV_ABS, code, (place * RIM) as i32)?;
        }
        self.say(EV_SYN, 0, 0)
    }

    /// Presses and releases a button.
    pub fn press(&self, button: u16) -> io::Result<()> {
        for value in [1, 0] {
            self.say(EV_KEY, BTN_TRIGGER + button, value)?;
            self.say(EV_SYN, 0, 0)?;
        }
        Ok(())
    }

    /// Returns all commands of the driver since the stick was plugged in.
    pub fn told(&self) -> Vec<Told> {
        self.desk.told().clone()
    }

    fn say(&self, kind: u16, code: u16, value: i32) -> io::Result<()> {
        let mut event: input_event = zeroed();
        (event.type_, event.code, event.value) = (kind, code, value);
        (&self.desk.file).write_all(bytes_of(&mut event))
    }
}

/// Unplugs the stick.
impl Drop for Stick {
    fn drop(&mut self) {
        self.desk.is_plugged_in.store(false, Ordering::Relaxed);
        nothing(&self.desk.file, UI_DEV_DESTROY).expect("the device was created");
        if let Some(listener) = self.listener.take() {
            let heard = listener.join();
            if !std::thread::panicking() {
                heard.expect("the listener understood all commands");
            }
        }
    }
}

impl Desk {
    /// Answers the kernel's requests until the device is destroyed. Polls, because the destruction of the
    /// device makes every answer fail but does not wake a blocked read.
    fn listen(&self) {
        while self.is_plugged_in.load(Ordering::Relaxed) {
            let has_answered = !is_readable(&self.file) || self.answer().is_ok();
            if !has_answered {
                return;
            }
        }
    }

    fn answer(&self) -> io::Result<()> {
        let mut event: input_event = zeroed();
        (&self.file).read_exact(bytes_of(&mut event))?;
        let (id, value) = (event.code as i16, event.value);
        match (event.type_, event.code) {
            (EV_UINPUT, UI_FF_UPLOAD) => {
                let mut upload: uinput_ff_upload = zeroed();
                upload.request_id = value as u32;
                structure(&self.file, UI_BEGIN_FF_UPLOAD, &mut upload)?;
                self.note(What::Upload(Effect::read(&upload.effect)));
                return structure(&self.file, UI_END_FF_UPLOAD, &mut upload);
            }
            (EV_UINPUT, UI_FF_ERASE) => {
                let mut erase: uinput_ff_erase = zeroed();
                erase.request_id = value as u32;
                structure(&self.file, UI_BEGIN_FF_ERASE, &mut erase)?;
                let id = erase.effect_id as i16;
                self.note(What::Erase { id });
                return structure(&self.file, UI_END_FF_ERASE, &mut erase);
            }
            (EV_FF, FF_GAIN) => self.note(What::Gain(value)),
            (EV_FF, FF_AUTOCENTER) => self.note(What::Autocentre(value)),
            (EV_FF, _) => self.note(What::Play { id, times: value }),
            _ => {}
        }
        Ok(())
    }

    fn note(&self, what: What) {
        let at = Instant::now();
        self.told().push(Told { at, what });
    }

    fn told(&self) -> MutexGuard<'_, Vec<Told>> {
        self.told.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Effect {
    fn read(effect: &ff_effect) -> Effect {
        assert_eq!(
            effect.type_, FF_CONSTANT,
            "only constant forces are supported"
        );
        // In the union, `struct ff_constant_effect` begins with the level, as 16 bits.
        let [first, second, ..] = effect.u[0].to_ne_bytes();
        Effect {
            id: effect.id,
            direction: effect.direction,
            level: i16::from_ne_bytes([first, second]),
            length: Duration::from_millis(effect.replay.length.into()),
            delay: Duration::from_millis(effect.replay.delay.into()),
        }
    }
}

/// # Safety
/// Implement it only for structures of plain numbers that are valid with all bytes zero.
unsafe trait Plain {}
// SAFETY: see libc; these are the structures that the kernel reads and writes.
unsafe impl Plain for input_event {}
unsafe impl Plain for uinput_setup {}
unsafe impl Plain for uinput_abs_setup {}
unsafe impl Plain for uinput_ff_upload {}
unsafe impl Plain for uinput_ff_erase {}

/// Returns a zeroed kernel structure.
fn zeroed<T: Plain>() -> T {
    // SAFETY: guaranteed by `Plain`.
    unsafe { std::mem::zeroed() }
}

fn bytes_of(event: &mut input_event) -> &mut [u8] {
    let length = size_of_val(event);
    // SAFETY: the event has numbers of 8, 8, 2, 2 and 4 bytes, without padding, and all bit patterns are
    // valid.
    unsafe { std::slice::from_raw_parts_mut(std::ptr::from_mut(event).cast(), length) }
}

/// Returns whether data can be read now or within 20 ms.
fn is_readable(file: &File) -> bool {
    let mut poll = pollfd {
        fd: file.as_raw_fd(),
        events: POLLIN,
        revents: 0,
    };
    // SAFETY: the count of one matches the one structure `poll`.
    let status = unsafe { libc::poll(&mut poll, 1, 20) };
    status > 0
}

fn nothing(file: &File, request: Ioctl) -> io::Result<()> {
    // SAFETY: the request takes no argument.
    outcome(unsafe { libc::ioctl(file.as_raw_fd(), request) })
}

fn number(file: &File, request: Ioctl, number: u16) -> io::Result<()> {
    // SAFETY: the request takes a number and follows no pointer.
    outcome(unsafe { libc::ioctl(file.as_raw_fd(), request, c_int::from(number)) })
}

fn structure<T: Plain>(file: &File, request: Ioctl, structure: &mut T) -> io::Result<()> {
    // SAFETY: the size of the structure is part of the request, and the kernel keeps no pointer.
    outcome(unsafe { libc::ioctl(file.as_raw_fd(), request, std::ptr::from_mut(structure)) })
}

fn outcome(status: c_int) -> io::Result<()> {
    if status < 0 {
        return Err(io::Error::last_os_error());
    }
    Ok(())
}
