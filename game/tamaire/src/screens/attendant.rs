//! Control of the game by a public stand, which replaces the menus.

use crate::game::Game;
use crate::look::Stage;
use egui::{Context, Ui};

/// Controls the game at a public stand, where visitors have no menus.
pub trait StandController {
    /// Tells the supervisor that the program is alive. Called in every pass of the event loop, even if
    /// nothing is drawn.
    fn live(&mut self, _: &Context) {}

    /// Advances by a frame of `seconds`.
    fn pass(&mut self, game: &mut Game, ctx: &Context, seconds: f32);

    /// Shows the current screen of the stand.
    fn show(&mut self, game: &mut Game, stage: &mut Stage, ui: &mut Ui);

    /// Requests the end of the program.
    fn end(&mut self);

    /// Called when the program ends.
    fn close(&mut self, game: &mut Game);
}
