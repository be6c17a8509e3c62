//! Screens of the game. Each screen is a function that draws the state of the game and triggers its actions.

mod attendant;
mod buttons;
mod code;
mod confirmation;
mod editor;
mod ending;
mod forces;
mod goals;
mod hopeless;
mod hud;
mod icons;
mod levels;
mod licences;
mod making;
mod notices;
mod offered;
mod offers;
mod paused;
mod play;
mod replays;
mod result;
mod settings;
#[cfg(not(target_family = "wasm"))]
mod stand;
mod title;
mod together;
mod toolbox;
mod toys;
mod watching;
mod widgets;

pub use attendant::StandController;
#[cfg(not(target_family = "wasm"))]
pub use stand::CrashScreen;

use crate::game::{Game, Screen};
use crate::look::Stage;
use egui::Ui;

/// Shows the current screen.
pub fn show(game: &mut Game, stage: &mut Stage, ui: &mut Ui) {
    if game.is_seen() {
        play::world(game, stage, ui);
    }
    match game.screen() {
        Screen::Title => title::show(game, ui),
        Screen::Together => together::show(game, ui),
        Screen::Levels => levels::show(game, stage, ui),
        Screen::Ending => ending::show(game, stage, ui),
        Screen::Paper => making::show(game, ui),
        Screen::Editor => editor::show(game, ui),
        Screen::Properties => editor::properties(game, ui),
        Screen::Finish => editor::finish(game, ui),
        Screen::Play => play::show(game, ui),
        Screen::Paused => paused::show(game, ui),
        Screen::Toolbox => toolbox::show(game, ui),
        Screen::Result => result::show(game, ui),
        Screen::Offered => offered::show(game, stage, ui),
        Screen::Settings => settings::show(game, ui),
        Screen::Forces => forces::show(game, ui),
        Screen::Licences => licences::show(game, ui),
        Screen::Replays => replays::show(game, stage, ui),
    }
    notices::show(game, ui);
}
