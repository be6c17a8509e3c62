//! Screens of a public stand for visitors and staff.

mod choice;
mod door;
mod language;
mod leaving;
mod result;
mod staff;

use super::attendant::StandController;
use super::title::draw_name;
use super::widgets::{dim_background, words};
use super::{notices, play};
use crate::exhibit::{Phase, Stand};
use crate::game::{Game, Screen};
use crate::look::Stage;
use app_shell::theme::DIMMED;
use app_shell::widgets::fitted;
use egui::{Color32, Context, CursorIcon, Rect, Ui, ViewportCommand, pos2, vec2};

impl StandController for Stand {
    fn pass(&mut self, game: &mut Game, ctx: &Context, seconds: f32) {
        let is_closing = ctx.input(|input| input.viewport().close_requested());
        if is_closing && !self.is_ended {
            ctx.send_viewport_cmd(ViewportCommand::CancelClose);
        }
        Stand::pass(self, game, ctx, seconds);
        if self.is_ended && !is_closing {
            ctx.send_viewport_cmd(ViewportCommand::Close);
        }
    }

    fn show(&mut self, game: &mut Game, stage: &mut Stage, ui: &mut Ui) {
        match self.phase {
            Phase::Closed => closed(self, game, ui),
            Phase::Staff(page) => {
                staff::show(self, game, page, ui);
                notices::show(game, ui);
            }
            Phase::PinEntry => door::show(self, game, ui),
            Phase::Attract => {
                play::world(game, stage, ui);
                attract(game, ui);
            }
            Phase::Choice => choice::show(self, game, stage, ui),
            Phase::Visit => {
                play::world(game, stage, ui);
                match game.screen() {
                    Screen::Result => result::show(self, game, ui),
                    _ => play::show(game, ui),
                }
            }
        }
        if matches!(self.phase, Phase::Choice | Phase::Visit) && self.config.other_languages {
            language::show(game, ui);
        }
        leaving::show(self, game, ui);
        door::knocked(self, game, ui);
        if self.is_pointer_left() {
            ui.ctx().set_cursor_icon(CursorIcon::None);
        }
    }

    fn end(&mut self) {
        self.is_ended = true;
    }

    fn close(&mut self, game: &mut Game) {
        Stand::close(self, game);
    }
}

/// Static picture that is shown while the game keeps crashing.
#[derive(Default)]
pub struct CrashScreen {
    is_ended: bool,
}

impl StandController for CrashScreen {
    fn pass(&mut self, _: &mut Game, ctx: &Context, _: f32) {
        if ctx.input(|input| input.viewport().close_requested()) && !self.is_ended {
            ctx.send_viewport_cmd(ViewportCommand::CancelClose);
        }
    }

    fn show(&mut self, game: &mut Game, _: &mut Stage, ui: &mut Ui) {
        calm(game, ui, game.settings.language.at_stand().rests);
        ui.ctx().set_cursor_icon(CursorIcon::None);
    }

    fn end(&mut self) {
        self.is_ended = true;
    }

    fn close(&mut self, _: &mut Game) {}
}

/// Shows the name of the game and invites visitors to play.
fn attract(game: &Game, ui: &Ui) {
    dim_background(ui, DIMMED);
    let (theme, screen) = (game.theme(), ui.max_rect());
    let time = match game.settings.reduced_motion {
        true => 0.0,
        false => game.time,
    };
    let bob = 6.0 * (1.6 * time).sin() as f32;
    let top = pos2(
        screen.center().x,
        screen.top() + 0.17 * screen.height() + bob,
    );
    let size = 0.19 * screen.size().min_elem();
    draw_name(game, ui, top, size);
    let call = game.settings.language.at_stand().call;
    let beat = 1.0 + 0.04 * (3.0 * time).sin() as f32;
    let width = screen.width() - 72.0;
    let galley = fitted(ui.painter(), call, 44.0 * beat, width, theme.on_accent);
    let middle = pos2(screen.center().x, screen.bottom() - 0.11 * screen.height());
    let rect = Rect::from_center_size(middle, galley.size() + beat * vec2(64.0, 30.0));
    let painter = ui.painter();
    let round = 0.5 * rect.height();
    painter.rect_filled(
        rect.translate(vec2(0.0, 5.0)),
        round,
        Color32::from_black_alpha(30),
    );
    painter.rect_filled(rect, round, theme.accent);
    painter.galley(rect.center() - 0.5 * galley.size(), galley, theme.on_accent);
}

/// Shows a static picture and the opening time.
fn closed(stand: &Stand, game: &Game, ui: &Ui) {
    let opens = stand.config.hours.map(|hours| hours.open.0);
    let said = game.settings.language.at_stand();
    calm(game, ui, &opens.map(said.opens).unwrap_or_default());
    ui.ctx().set_cursor_icon(CursorIcon::None);
}

/// Draws a static picture with a text below.
fn calm(game: &Game, ui: &Ui, text: &str) {
    let (theme, screen) = (game.theme(), ui.max_rect());
    ui.painter().rect_filled(screen, 0.0, theme.paper);
    let size = 0.16 * screen.size().min_elem();
    let middle = screen.center() - vec2(0.0, 0.4 * size);
    words(ui, middle, "玉入れ", size, theme.accent);
    let galley = fitted(ui.painter(), text, 30.0, screen.width() - 60.0, theme.faint);
    let at = middle + vec2(0.0, size) - 0.5 * galley.size();
    ui.painter().galley(at, galley, theme.faint);
}
