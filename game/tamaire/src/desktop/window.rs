//! The window of the game.

use crate::app::App;
use crate::game::Game;
use crate::screens::StandController;
use app_shell::window::{WindowOutcome, open};

/// Application id: the name of the desktop entry to which the window belongs.
const APP: &str = "tamaire";

/// Opens a window for a game and, at a stand, its controller. Returns when the window is closed.
pub(super) fn open_game(
    viewport: egui::ViewportBuilder,
    make: impl FnOnce() -> (Game, Option<Box<dyn StandController>>) + 'static,
) -> WindowOutcome {
    open(
        APP,
        viewport
            .with_title("玉入れ tamaire")
            .with_app_id(APP)
            .with_icon(icon()),
        |context| {
            let (game, attendant) = make();
            let mut app = App::new(context, game)?;
            app.attendant = attendant;
            let watch = app.gpu.clone();
            Ok((Box::new(app), watch))
        },
    )
}

/// Icon of the window.
fn icon() -> egui::IconData {
    let picture = include_bytes!("../../web/icon-192.png");
    eframe::icon_data::from_png_bytes(picture).expect("web/icon-192.png is a valid PNG")
}

#[cfg(test)]
mod tests {
    #[test]
    fn icon_is_valid_and_has_expected_width() {
        assert_eq!(super::icon().width, 192);
    }
}
