//! The system's dialog in which a file is picked.

use super::given::{Given, Picked};
use std::sync::mpsc::{self, Receiver, TryRecvError};
use std::thread;
use std::time::{Duration, Instant};

/// Whether there is one here.
pub const IS_THERE: bool = true;

/// A dialog that ends sooner than this never came up.
const SOON: Duration = Duration::from_millis(400);

/// The dialog, which the game goes on behind.
#[derive(Default)]
pub struct Dialog(Option<Receiver<Picked>>);

impl Dialog {
    /// Asks for a file, unless one is being asked for; `kind` says of what kind, to the player.
    pub fn ask(&mut self, kind: &str) {
        if self.0.is_some() {
            return;
        }
        let endings = ["toml", "tamaire", "png", "vox"];
        // It is made on the thread of the window, which some systems ask for, and waited for on another.
        let asked = rfd::AsyncFileDialog::new().add_filter(kind, &endings);
        let (asked, began) = (asked.pick_file(), Instant::now());
        let (tell, told) = mpsc::channel();
        let wait = move || {
            let picked = match pollster::block_on(asked) {
                Some(file) => Picked::File(Given::at(file.path())),
                None if began.elapsed() < SOON => Picked::NoDialog,
                None => Picked::Nothing,
            };
            // The game may have ended.
            let _ = tell.send(picked);
        };
        let thread = thread::Builder::new().name("dialog".into()).spawn(wait);
        self.0 = thread.is_ok().then_some(told);
    }

    /// What was picked since this was asked last.
    pub fn take(&mut self) -> Option<Picked> {
        let picked = match self.0.as_ref()?.try_recv() {
            Ok(picked) => picked,
            Err(TryRecvError::Empty) => return None,
            Err(TryRecvError::Disconnected) => Picked::Nothing,
        };
        self.0 = None;
        Some(picked)
    }
}
