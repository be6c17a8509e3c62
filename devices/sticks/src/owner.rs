//! The thread that owns SDL: it pumps events, updates the device states, and publishes changed ones.

use std::sync::Arc;
use std::sync::mpsc::{self, Receiver, RecvTimeoutError, Sender};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use sdl3_sys::gamepad::{
    SDL_GAMEPAD_AXIS_LEFT_TRIGGER, SDL_GAMEPAD_AXIS_LEFTX, SDL_GAMEPAD_AXIS_LEFTY,
    SDL_GAMEPAD_AXIS_RIGHT_TRIGGER, SDL_GAMEPAD_AXIS_RIGHTX, SDL_GAMEPAD_AXIS_RIGHTY,
};

use crate::latest::{Error, Latest};
use crate::sdl::{ControlEvent, DeviceEvent, HatBits, OpenDevice, Sdl, SdlPermit};
use crate::{Button, Device, DeviceId, Direction, Hat, Pad, PadButton, Snapshot};

/// Maximum age of a snapshot while a device is connected. Players feel a larger value as lag; at 1 ms the
/// thread uses twice as much processor time.
const PERIOD: Duration = Duration::from_millis(2);
/// Interval of the updates while no device is connected. The delay is not felt, and the idle thread costs
/// almost nothing.
const IDLE_PERIOD: Duration = Duration::from_millis(100);
/// Timeout for starting SDL. A broken device can block SDL forever; the game must continue without it.
const PATIENCE: Duration = Duration::from_secs(5);

/// Owner of the SDL thread. Dropping it ends the thread and returns once the thread has ended.
pub struct Owner {
    /// Sender of tasks to the thread; `None` only during drop.
    orders: Option<Arc<Sender<Order>>>,
    thread: Option<JoinHandle<()>>,
}

/// Task for the thread that owns SDL.
pub type Order = Box<dyn FnOnce(&mut Hub<'_>) + Send>;

/// State of the SDL thread.
pub struct Hub<'sdl> {
    pub sdl: &'sdl Sdl,
    connected: Vec<Connected<'sdl>>,
    latest: Latest,
    accepts: fn(&Sdl, DeviceId) -> bool,
}

struct Connected<'sdl> {
    /// Feedback of the device. Declared before `open`, so that its effects are removed before the device is
    /// closed.
    #[cfg(feature = "haptic")]
    held: crate::held::Feedback<'sdl>,
    open: OpenDevice<'sdl>,
    device: Device,
}

impl Owner {
    pub fn start(latest: Latest) -> Result<Owner, Error> {
        let turn = SdlPermit::take().ok_or(Error::AlreadyOpen)?;
        Owner::start_with(turn, latest, |_, _| true)
    }

    /// Starts the SDL thread and waits until it has found the connected devices.
    pub fn start_with(
        turn: SdlPermit,
        latest: Latest,
        accepts: fn(&Sdl, DeviceId) -> bool,
    ) -> Result<Owner, Error> {
        let (orders, inbox) = mpsc::channel();
        let (ready, started) = mpsc::channel();
        let thread =
            thread::Builder::new()
                .name("sticks".into())
                .spawn(move || match Sdl::start(turn) {
                    Ok(sdl) => {
                        let mut hub = Hub {
                            sdl: &sdl,
                            connected: Vec::new(),
                            latest,
                            accepts,
                        };
                        hub.pump();
                        // Sending fails only if the caller panicked; the inbox is then closed too, and the
                        // thread ends.
                        let _ = ready.send(Ok(()));
                        hub.run(&inbox);
                    }
                    Err(error) => {
                        let _ = ready.send(Err(error));
                    }
                })?;
        let mut owner = Owner {
            orders: Some(Arc::new(orders)),
            thread: Some(thread),
        };
        match started.recv_timeout(PATIENCE) {
            Ok(Ok(())) => Ok(owner),
            Ok(Err(error)) => Err(Error::Sdl(error)),
            Err(RecvTimeoutError::Disconnected) => Err(Error::Sdl("SDL thread panicked".into())),
            Err(RecvTimeoutError::Timeout) => {
                // Does not join the thread, because SDL may block it forever. If SDL starts later, the thread
                // finds its inbox closed and ends.
                owner.thread = None;
                let seconds = PATIENCE.as_secs();
                let reason =
                    format!("SDL did not start within {seconds} s; a device may be broken");
                Err(Error::Sdl(reason))
            }
        }
    }

    /// Returns a sender of tasks for the thread. The reference is weak, because the thread runs as long as a
    /// sender exists.
    #[cfg(any(test, feature = "virtual", feature = "haptic"))]
    pub fn orders(&self) -> std::sync::Weak<Sender<Order>> {
        self.orders.as_ref().map(Arc::downgrade).unwrap_or_default()
    }
}

impl Drop for Owner {
    fn drop(&mut self) {
        self.orders = None;
        if let Some(thread) = self.thread.take() {
            // An error means that the thread panicked. The panic was already printed, and the devices are
            // closed.
            let _ = thread.join();
        }
    }
}

impl<'sdl> Hub<'sdl> {
    /// Runs until the owner is dropped. Tasks from the inbox are executed at once and do not delay the
    /// pumping of events.
    fn run(&mut self, inbox: &Receiver<Order>) {
        let mut pumped = Instant::now();
        loop {
            let period = if self.connected.is_empty() {
                IDLE_PERIOD
            } else {
                PERIOD
            };
            match inbox.recv_timeout(period.saturating_sub(pumped.elapsed())) {
                Ok(order) => order(self),
                Err(RecvTimeoutError::Timeout) => {}
                Err(RecvTimeoutError::Disconnected) => return,
            }
            if pumped.elapsed() >= period {
                self.pump();
                #[cfg(feature = "haptic")]
                for connected in &mut self.connected {
                    connected.held.expire(&connected.open);
                }
                pumped = Instant::now();
            }
        }
    }

    /// Returns a connected device and its feedback state.
    #[cfg(feature = "haptic")]
    pub fn held(
        &mut self,
        id: DeviceId,
    ) -> Option<(&OpenDevice<'sdl>, &mut crate::held::Feedback<'sdl>)> {
        let mut all = self.connected.iter_mut();
        let connected = all.find(|connected| connected.device.id == id)?;
        Some((&connected.open, &mut connected.held))
    }

    /// Reads all events and publishes changed states.
    pub fn pump(&mut self) {
        let mut news = false;
        self.sdl.pump(|id, what| {
            news = true;
            self.take_in(id, what);
        });
        if news {
            let devices = self
                .connected
                .iter()
                .map(|connected| connected.device.clone())
                .collect();
            self.latest.set(Snapshot { devices });
        }
    }

    fn take_in(&mut self, id: DeviceId, what: DeviceEvent) {
        match what {
            DeviceEvent::Added => self.add(id),
            DeviceEvent::Removed => self.connected.retain(|connected| connected.device.id != id),
            DeviceEvent::Moved(part) => {
                let mut all = self.connected.iter_mut();
                if let Some(connected) = all.find(|connected| connected.device.id == id) {
                    connected.take_in(part);
                }
            }
        }
    }

    /// Opens a device. A device that cannot be opened, usually for lack of permission, is treated as absent.
    fn add(&mut self, id: DeviceId) {
        let is_known = self
            .connected
            .iter()
            .any(|connected| connected.device.id == id);
        if is_known || !(self.accepts)(self.sdl, id) {
            return;
        }
        if let Some(open) = self.sdl.open(id) {
            let (axes, buttons, hats) = (open.axis_count(), open.button_count(), open.hat_count());
            let mut device = Device::at_rest(id, open.about(), axes, buttons, hats);
            device.pad = open.is_pad().then(Pad::default);
            let mut connected = Connected {
                #[cfg(feature = "haptic")]
                held: crate::held::Feedback::default(),
                open,
                device,
            };
            connected.read();
            self.connected.push(connected);
        }
    }

    #[cfg(any(test, feature = "virtual"))]
    pub fn opened(&self, id: DeviceId) -> Option<&OpenDevice<'sdl>> {
        let connected = self
            .connected
            .iter()
            .find(|connected| connected.device.id == id);
        connected.map(|connected| &connected.open)
    }
}

/// Publishes an empty snapshot at the end of the thread, also after a panic, so that no button stays down.
impl Drop for Hub<'_> {
    fn drop(&mut self) {
        self.latest.set(Snapshot::default());
    }
}

impl Connected<'_> {
    fn take_in(&mut self, part: ControlEvent) {
        let device = &mut self.device;
        match part {
            ControlEvent::ButtonDown(number) => {
                if let Some(button) = device.buttons.get_mut(number) {
                    button.press();
                }
            }
            ControlEvent::PadButtonDown(number) => {
                if let (Some(pad), Some(button)) = (&mut device.pad, PadButton::ALL.get(number)) {
                    pad.button_mut(*button).press();
                }
            }
            ControlEvent::Hat(number, bits) => {
                if let Some(hat) = device.hats.get_mut(number) {
                    move_hat(hat, bits);
                }
            }
            ControlEvent::All => self.read(),
        }
    }

    /// Reads buttons and axes but counts no presses. Presses are counted from events, because a press may
    /// begin and end between two reads.
    fn read(&mut self) {
        let Connected { open, device, .. } = self;
        for (number, axis) in device.axes.iter_mut().enumerate() {
            *axis = open.axis(number);
        }
        for (number, button) in device.buttons.iter_mut().enumerate() {
            button.down = open.button(number);
        }
        for (number, hat) in device.hats.iter_mut().enumerate() {
            move_hat(hat, open.hat(number));
        }
        if let Some(pad) = &mut device.pad {
            pad.left = [
                open.pad_axis(SDL_GAMEPAD_AXIS_LEFTX),
                -open.pad_axis(SDL_GAMEPAD_AXIS_LEFTY),
            ];
            pad.right = [
                open.pad_axis(SDL_GAMEPAD_AXIS_RIGHTX),
                -open.pad_axis(SDL_GAMEPAD_AXIS_RIGHTY),
            ];
            pad.triggers = [
                open.pad_axis(SDL_GAMEPAD_AXIS_LEFT_TRIGGER),
                open.pad_axis(SDL_GAMEPAD_AXIS_RIGHT_TRIGGER),
            ];
            for button in PadButton::ALL {
                pad.button_mut(button).down = open.pad_button(button);
            }
        }
    }
}

fn move_hat(hat: &mut Hat, bits: HatBits) {
    for direction in Direction::ALL {
        let button: &mut Button = hat.button_mut(direction);
        match (button.down, bits.has(direction)) {
            (false, true) => button.press(),
            (_, down) => button.down = down,
        }
    }
}
