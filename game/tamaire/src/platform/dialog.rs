//! File dialog of the system.

use super::given::{DialogResult, OpenRequest};
use std::sync::mpsc::{self, Receiver, TryRecvError};
use std::thread;
use std::time::{Duration, Instant};

/// Whether file dialogs are supported.
pub const IS_THERE: bool = true;

/// Minimum time for which a dialog stays open. A dialog that closes sooner never appeared: the system has no
/// file dialog.
const SOON: Duration = Duration::from_millis(400);

/// File dialog, which does not block the game.
#[derive(Default)]
pub struct Dialog(Option<Receiver<DialogResult>>);

impl Dialog {
    /// Opens the dialog unless it is open. `kind` describes the files to the player.
    pub fn ask(&mut self, kind: &str) {
        if self.0.is_some() {
            return;
        }
        // Some systems distinguish upper and lower case here.
        let endings = [
            "toml", "tamaire", "zip", "vox", "png", "jpg", "jpeg", "webp", "gif", "bmp", "ZIP",
            "VOX", "PNG", "JPG", "JPEG", "WEBP", "GIF", "BMP",
        ];
        // The dialog is created on the window's thread, as some systems require, and awaited on another
        // thread.
        let asked = rfd::AsyncFileDialog::new().add_filter(kind, &endings);
        let (asked, began) = (asked.pick_file(), Instant::now());
        let (tell, told) = mpsc::channel();
        let wait = move || {
            let picked = match pollster::block_on(asked) {
                Some(file) => DialogResult::File(OpenRequest::at(file.path())),
                None if began.elapsed() < SOON => DialogResult::NoDialog,
                None => DialogResult::Nothing,
            };
            // Sending fails if the game has ended.
            let _ = tell.send(picked);
        };
        let thread = thread::Builder::new().name("dialog".into()).spawn(wait);
        self.0 = thread.is_ok().then_some(told);
    }

    /// Returns the result of the dialog, once.
    pub fn take(&mut self) -> Option<DialogResult> {
        let picked = match self.0.as_ref()?.try_recv() {
            Ok(picked) => picked,
            Err(TryRecvError::Empty) => return None,
            Err(TryRecvError::Disconnected) => DialogResult::Nothing,
        };
        self.0 = None;
        Some(picked)
    }
}
