//! Virtual devices for tests. Their input goes through all of SDL; only the driver is simulated.

use std::sync::Weak;
use std::sync::mpsc::{self, Sender};

use crate::latest::Latest;
use crate::owner::{Hub, Order, Owner};
use crate::sdl::puppets::{PuppetAct, PuppetForm, Rumble};
use crate::sdl::{HatBits, Sdl, SdlPermit};
use crate::{DeviceId, Direction, Error, PadButton, Sticks};

/// Virtual device. Dropping it unplugs the device. When a method returns, the snapshot contains its effect.
#[must_use = "a puppet is unplugged when it is dropped"]
pub struct VirtualDevice {
    id: DeviceId,
    owner: Weak<Sender<Order>>,
    rumble: Rumble,
}

impl Sticks {
    /// Opens virtual devices only, so that tests do not depend on real devices. Waits until no other `Sticks`
    /// is open in this process, so that concurrent tests use SDL one after the other.
    pub fn open_for_puppets() -> Result<Sticks, Error> {
        let latest = Latest::default();
        Ok(Sticks {
            owner: Owner::start_with(SdlPermit::wait(), latest.clone(), Sdl::is_puppet)?,
            latest,
        })
    }

    /// Plugs in a pad with all buttons of the standard layout.
    pub fn plug_in_pad(&self, name: &str) -> Result<VirtualDevice, Error> {
        self.plug_in(name, PuppetForm::Pad)
    }

    /// Plugs in a flight stick with the given numbers of axes, buttons and hats.
    pub fn plug_in_stick(
        &self,
        name: &str,
        axes: u16,
        buttons: u16,
        hats: u16,
    ) -> Result<VirtualDevice, Error> {
        self.plug_in(
            name,
            PuppetForm::Stick {
                axes,
                buttons,
                hats,
            },
        )
    }

    fn plug_in(&self, name: &str, form: PuppetForm) -> Result<VirtualDevice, Error> {
        let owner = self.owner.orders();
        let name = name.to_owned();
        let rumble = Rumble::default();
        let felt = rumble.clone();
        let id = done(&owner, move |hub| hub.sdl.plug_in(&name, form, &felt))
            .unwrap_or_else(|| Err("the SDL thread has ended".into()))
            .map_err(Error::Sdl)?;
        Ok(VirtualDevice { id, owner, rumble })
    }
}

impl VirtualDevice {
    pub fn id(&self) -> DeviceId {
        self.id
    }

    /// Moves the axis with this number to a value from −1 to 1. Returns whether the axis exists. On pads,
    /// axes 0 and 1 are the left stick, 2 and 3 the right one, with y towards the player. Axes 4 and 5 are
    /// the triggers, with −1 at rest.
    pub fn axis(&self, axis: usize, value: f32) -> bool {
        self.act(PuppetAct::Axis(axis, (value * 32767.0) as i16))
    }

    /// Presses or releases a button. Returns whether the button exists.
    pub fn button(&self, button: usize, down: bool) -> bool {
        self.act(PuppetAct::Button(button, down))
    }

    /// Presses or releases a pad button. Returns whether the button exists.
    pub fn pad_button(&self, button: PadButton, down: bool) -> bool {
        self.button(button as usize, down)
    }

    /// Moves a hat to one direction, to two adjacent ones, or to none to release it. Returns whether the hat
    /// exists.
    pub fn hat(&self, hat: usize, directions: &[Direction]) -> bool {
        self.act(PuppetAct::Hat(hat, HatBits::of(directions)))
    }

    /// Returns the current rumble of the slow and the fast motor, 0 to 65535.
    pub fn rumble(&self) -> [u16; 2] {
        self.rumble.get()
    }

    fn act(&self, act: PuppetAct) -> bool {
        let id = self.id;
        done(&self.owner, move |hub| {
            hub.opened(id).is_some_and(|open| open.act(act))
        })
        .unwrap_or(false)
    }
}

impl Drop for VirtualDevice {
    fn drop(&mut self) {
        let id = self.id;
        // The call fails if the thread has ended, and then the device is already unplugged.
        let _ = done(&self.owner, move |hub| hub.sdl.unplug(id));
    }
}

/// Runs a task on the thread that owns SDL and publishes its effects. Returns `None` if the thread has ended.
fn done<R: Send + 'static>(
    owner: &Weak<Sender<Order>>,
    act: impl FnOnce(&mut Hub<'_>) -> R + Send + 'static,
) -> Option<R> {
    let (answer, answered) = mpsc::channel();
    let order = Box::new(move |hub: &mut Hub<'_>| {
        let result = act(hub);
        hub.pump();
        // The receiver waits below, so the send succeeds.
        let _ = answer.send(result);
    });
    owner.upgrade()?.send(order).ok()?;
    answered.recv().ok()
}
