//! Paper: the drawing in 2D.

use super::super::widgets::{focus_first, words};
use super::picture::Picture;
use super::{pen, tools};
use crate::game::{DrawingTool, Flaws, Game};
use app_shell::widgets::{focus_ring, is_on};
use egui::{
    Color32, Id, Pos2, Rect, Role, Sense, Stroke, StrokeKind, Ui, Vec2, WidgetInfo, pos2, vec2,
};
use fuwafuwa::Vec3;
use tamaire_maker::drawing::Drawing;

/// Maximum number of pieces that are numbered on the paper.
const NUMBERED: usize = 9;

pub(super) fn show(game: &mut Game, ui: &mut Ui, rect: Rect) {
    let name = game.making().paper;
    let sheet = ui.interact(rect, Id::unique("paper"), Sense::click_and_drag());
    sheet.widget_info(|| WidgetInfo::labeled(Role::Button, true, name));
    focus_first(ui, &sheet);
    let moves = pen::moves(game, ui, rect, &sheet);
    let (tool, mut is_refused) = (game.maker.tool, false);
    for (at, pressure) in moves.points {
        let begins = !game.maker.is_drawing();
        let has_drawn = game
            .maker
            .draw_to(to_cells(&game.maker.paper, rect, at), pressure);
        is_refused |= tool == DrawingTool::Bucket && begins && !has_drawn;
        let is_empty = game.maker.paper.is_empty();
        if tool == DrawingTool::Paint && begins && is_empty {
            game.notify(game.making().nothing_to_paint.to_string());
        }
    }
    if moves.is_up {
        game.maker.lift_pen();
    }
    if is_refused {
        game.notify(game.making().not_enclosed.to_string());
    }
    game.maker.is_sheet_on = is_on(ui, &sheet);
    let flaws = game.maker.flaws().clone();
    draw(game, ui, rect);
    warn(game, ui, rect, &flaws);
    pen::draw_cursor(game, ui, rect);
    if let Some(at) = ui.input(|input| input.pointer.hover_pos())
        && sheet.hovered()
    {
        draw_nib(game, ui, rect, at);
    }
    focus_ring(ui, &sheet, rect, 14.0, &game.theme());
}

/// Returns the position on the paper [cells] of a point of the screen.
fn to_cells(paper: &Drawing, rect: Rect, at: Pos2) -> Vec3 {
    let [width, height, _] = paper.size();
    let share = (at - rect.min) / rect.size();
    Vec3::new(share.x * width as f32, (1.0 - share.y) * height as f32, 0.5)
}

/// Returns the place of a cell on the screen.
fn cell_rect(paper: &Drawing, rect: Rect, [x, y]: [usize; 2]) -> Rect {
    let [width, height, _] = paper.size();
    let side = vec2(rect.width() / width as f32, rect.height() / height as f32);
    let corner = rect.min + side * vec2(x as f32, (height - 1 - y) as f32);
    Rect::from_min_size(corner, side)
}

/// Draws the sheet and what is on it.
fn draw(game: &Game, ui: &Ui, rect: Rect) {
    let (theme, painter) = (game.theme(), ui.painter());
    let paper = &game.maker.paper;
    painter.rect_filled(
        rect.translate(vec2(0.0, 4.0)).expand(2.0),
        12.0,
        Color32::from_black_alpha(30),
    );
    painter.rect_filled(rect.expand(2.0), 10.0, Color32::WHITE);
    let dot = theme.faint.gamma_multiply(0.25);
    for row in 1..8 {
        for column in 1..8 {
            let share = vec2(column as f32, row as f32) / 8.0;
            painter.circle_filled(rect.min + share * rect.size(), 1.2, dot);
        }
    }
    if paper.mirror() {
        let x = rect.center().x;
        let ends = [pos2(x, rect.top()), pos2(x, rect.bottom())];
        painter.line_segment(ends, Stroke::new(1.5, theme.accent.gamma_multiply(0.6)));
    }
    let colours = { game.maker.palette.materials().iter().enumerate() }
        .map(|(index, _)| game.maker.palette.colour(index as u8 + 1))
        .collect();
    let id = Id::unique("picture of the paper");
    let mut picture: Picture = ui.data_mut(|data| data.remove_temp(id)).unwrap_or_default();
    let texture = picture.of(ui.ctx(), paper, colours);
    ui.data_mut(|data| data.insert_temp(id, picture));
    let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
    painter.image(texture.id(), rect, whole, Color32::WHITE);
}

/// Marks thin parts, which will break, and numbers separate pieces.
fn warn(game: &Game, ui: &Ui, rect: Rect, flaws: &Flaws) {
    let (theme, painter) = (game.theme(), ui.painter());
    let paper = &game.maker.paper;
    let [width, _, _] = paper.size();
    let pulse = match game.settings.reduced_motion {
        true => 0.6,
        false => 0.5 + 0.3 * (4.0 * game.time).sin() as f32,
    };
    let mark = theme.accent.gamma_multiply(pulse);
    let thin = &flaws.thin;
    for at in (0..thin.len()).filter(|&at| thin[at]) {
        let cell = cell_rect(paper, rect, [at % width, at / width]);
        painter.rect_filled(cell, 1.0, mark);
    }
    let pieces = &flaws.pieces;
    if !(2..=NUMBERED).contains(&pieces.count) {
        return;
    }
    for number in 1..=pieces.count {
        let cells = { pieces.of_cell.iter().enumerate() }
            .filter(|(_, piece)| usize::from(**piece) == number)
            .map(|(at, _)| [at % width, at / width]);
        let mut sum = Vec2::ZERO;
        let mut count = 0.0;
        for cell in cells {
            sum += cell_rect(paper, rect, cell).center().to_vec2();
            count += 1.0;
        }
        if count > 0.0 {
            let at = (sum / count).to_pos2();
            painter.circle(at, 12.0, theme.card, Stroke::new(2.0, theme.ink));
            words(ui, at, &number.to_string(), 16.0, theme.ink);
        }
    }
}

/// Draws the outline of the nib at the pointer.
fn draw_nib(game: &Game, ui: &Ui, rect: Rect, at: Pos2) {
    let maker = &game.maker;
    let cell = rect.width() / maker.paper.size()[0] as f32;
    let radius = (cell * maker.radius()).max(3.0);
    let ink = match maker.tool {
        DrawingTool::Eraser => game.theme().ink,
        _ => tools::crayon_colour(game, maker.crayon),
    };
    let painter = ui.painter();
    match maker.tool {
        DrawingTool::Stamp(_) => {
            let half = cell * maker.stamp_width() * 0.5;
            let place = Rect::from_center_size(at, Vec2::splat(2.0 * half));
            painter.rect_stroke(place, 6.0, Stroke::new(2.0, ink), StrokeKind::Middle);
        }
        _ => {
            painter.circle_stroke(at, radius, Stroke::new(2.0, ink));
        }
    }
}
