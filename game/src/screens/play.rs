//! The round itself, and the little that is written over it.

use crate::game::{Game, Screen};
use crate::look::{Look, Stage};
use egui::epaint::PathShape;
use egui::{Align2, FontId, Painter, Pos2, Response, Stroke, Ui, pos2, vec2};

/// Draws the world behind whatever screen.
pub(super) fn world(game: &mut Game, stage: &mut Stage, ui: &mut Ui) {
    let screen = ui.max_rect();
    let arena = game.session.round().level().arena();
    let view = game.camera.view(screen, arena);
    game.view = Some(view);
    let theme = game.theme();
    let look = Look {
        view,
        theme: &theme,
        elements: game.elements,
        effects: &game.effects,
        time: game.time,
        ghost: game.session.ghost(),
    };
    stage.draw(ui, game.session.round(), &look);
}

/// What is written over a round: time, how full the basket is, who plays.
pub(super) fn show(game: &mut Game, ui: &mut Ui) {
    let (theme, said) = (game.theme(), game.words());
    let screen = ui.max_rect();
    let round = game.session.round();
    let painter = ui.painter();
    let corner = screen.left_top() + vec2(24.0, 22.0);
    let seconds = match round.progress().outcome {
        Some(outcome) => outcome.seconds(),
        None => round.frames().len() as f32 / 60.0,
    };
    let font = FontId::proportional(30.0);
    painter.text(
        corner,
        Align2::LEFT_TOP,
        format!("{seconds:.1}"),
        font,
        theme.ink,
    );
    if round.basket().is_some() {
        draw_fill(painter, screen.right_top() + vec2(-58.0, 58.0), game);
    }
    let mut marks = Vec::new();
    if !game.session.is_played() {
        marks.push(said.watching);
    }
    if game.elements.is_some() {
        marks.push(said.elements_hint);
    }
    if game.slow || game.stepping {
        marks.push((said.action)(crate::input::Action::Slow));
    }
    if game.players.second().is_some() {
        marks.push(said.join_hint);
    }
    let below = corner + vec2(0.0, 40.0);
    painter.text(
        below,
        Align2::LEFT_TOP,
        marks.join(" ・ "),
        FontId::proportional(18.0),
        theme.faint,
    );
    if game.session.is_played() {
        ui.ctx().set_cursor_icon(egui::CursorIcon::None);
    }
    if !game.session.is_played() && game.session.is_over() {
        game.go(Screen::Replays);
    }
}

/// How much of what is needed rests in the basket, as a ring that fills.
fn draw_fill(painter: &Painter, middle: Pos2, game: &Game) {
    let theme = game.theme();
    let round = game.session.round();
    let rules = round.level().game();
    let share = (round.progress().inside / rules.share).clamp(0.0, 1.0);
    let held = (round.progress().held / rules.hold.max(0.1)).clamp(0.0, 1.0);
    painter.circle(middle, 30.0, theme.card, Stroke::new(8.0, theme.button));
    arc(painter, middle, 30.0, share, Stroke::new(8.0, theme.accent));
    arc(painter, middle, 20.0, held, Stroke::new(8.0, theme.good));
    let text = format!("{:.0}", 100.0 * round.progress().inside.max(0.0));
    painter.text(
        middle,
        Align2::CENTER_CENTER,
        text,
        FontId::proportional(18.0),
        theme.ink,
    );
}

fn arc(painter: &Painter, middle: Pos2, radius: f32, share: f32, stroke: Stroke) {
    let count = (48.0 * share) as usize;
    if count < 1 {
        return;
    }
    let point = |step: usize| {
        let angle = std::f32::consts::TAU * share * step as f32 / count as f32;
        pos2(
            middle.x + radius * angle.sin(),
            middle.y - radius * angle.cos(),
        )
    };
    let points: Vec<Pos2> = (0..=count).map(point).collect();
    painter.add(PathShape::line(points, stroke));
}

/// Puts the focus on a widget where nothing else has it, so that a pad alone can go on from there.
pub(super) fn focus_first(ui: &Ui, response: &Response) {
    if ui.memory(|memory| memory.focused().is_none()) {
        response.request_focus();
    }
}
