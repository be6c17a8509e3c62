//! Window and screen functions that differ between desktop and browser.

use crate::words::Language;

/// Switches full screen on or off.
pub fn fill_screen(context: &egui::Context, wanted: bool) {
    context.send_viewport_cmd(egui::ViewportCommand::Fullscreen(wanted));
}

/// Does nothing: on a desktop the window closes when its GPU is lost, and the program restarts.
pub fn restart() {}

/// Returns `None`: on a desktop only the program changes the window's full-screen state.
pub fn full_screen_of_page() -> Option<bool> {
    None
}

/// Returns an empty address, since a desktop program has no page. Links then consist of their fragment alone.
pub fn address_of_page() -> String {
    String::new()
}

/// Does nothing: the desktop program contains the fonts of all languages.
pub fn set_language(_: &egui::Context, _: Language, _: bool) {}
