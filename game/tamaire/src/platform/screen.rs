//! What the system does to what is seen.

use crate::words::Language;

/// Makes the window as large as was chosen.
pub fn fill_screen(context: &egui::Context, wanted: bool) {
    context.send_viewport_cmd(egui::ViewportCommand::Fullscreen(wanted));
}

/// A window closes where its GPU is lost, and the program begins anew.
pub fn begin_anew() {}

/// A window is as large as it was told.
pub fn is_full_by_itself() -> Option<bool> {
    None
}

/// The address of the page that opens links; a program has none, and opens what stands behind it.
pub fn address_of_page() -> String {
    String::new()
}

/// Every language can be written.
pub fn speak(_: &egui::Context, _: Language, _: bool) {}
