//! What leads the game where visitors find no menus.

use crate::game::Game;
use crate::look::Stage;
use egui::{Context, Ui};

/// What leads the game where visitors find no menus.
pub trait Attendant {
    /// The program lives, whether or not anything is drawn.
    fn live(&mut self, _: &Context) {}

    /// Lets a frame pass that took so long [s].
    fn pass(&mut self, game: &mut Game, ctx: &Context, seconds: f32);

    /// Shows what there is to see.
    fn show(&mut self, game: &mut Game, stage: &mut Stage, ui: &mut Ui);

    /// It is to end.
    fn end(&mut self);

    /// The program ends.
    fn close(&mut self, game: &mut Game);
}
