//! The little that is shown over a round: time, how full the basket is, what is different from usual.

use super::marks;
use crate::game::Game;
use crate::input::{Action, Seat};
use crate::look::Theme;
use egui::{
    Align2, Color32, FontId, Painter, Pos2, Rect, Role, Sense, Shape, Stroke, Ui, WidgetInfo, pos2,
    vec2,
};
use fuwafuwa_render::frame::ElementColour;

/// Draws what stands for an action.
type Mark = fn(&Painter, Pos2, Color32);

/// Height of what stands in the upper row.
const HIGH: f32 = 44.0;
/// Radius of the jar.
const JAR: f32 = 36.0;

/// Shows it; gives back whether the mouse is on a button.
pub(super) fn show(game: &mut Game, ui: &mut Ui) -> bool {
    let theme = game.theme();
    let screen = ui.max_rect();
    let said = game.words();
    let mut at = screen.left_top() + vec2(16.0, 14.0);
    let mut is_on_button = false;
    let buttons: [(Action, &str, Mark); 2] = [
        (Action::Pause, said.paused, draw_pause),
        (Action::Retry, said.again, draw_again),
    ];
    for (action, name, draw) in buttons {
        let rect = Rect::from_min_size(at, vec2(HIGH, HIGH));
        // Not for the keyboard, which has its own keys for it.
        let response = ui.interact(rect, egui::Id::unique(name), Sense::CLICK);
        response.widget_info(|| WidgetInfo::labeled(Role::Button, true, name));
        is_on_button |= response.hovered();
        let fill = if response.hovered() {
            theme.card
        } else {
            pale(&theme)
        };
        ui.painter().circle_filled(rect.center(), 0.5 * HIGH, fill);
        draw(ui.painter(), rect.center(), theme.ink);
        if response.clicked() {
            game.act(action, Seat::Pointer);
        }
        at.x += HIGH + 8.0;
    }
    let round = game.session.round();
    let seconds = match round.progress().outcome {
        Some(outcome) => outcome.seconds(),
        None => round.frames().len() as f32 / 60.0,
    };
    let clock = format!("{seconds:.1}");
    // As wide as it will ever be: what jumps cannot be read.
    let width = 34.0 + 15.0 * clock.len().max(4) as f32;
    let rect = Rect::from_min_size(at, vec2(width, HIGH));
    let painter = ui.painter();
    painter.rect_filled(rect, 0.5 * HIGH, pale(&theme));
    let font = FontId::proportional(26.0);
    painter.text(rect.center(), Align2::CENTER_CENTER, clock, font, theme.ink);
    at.x += width + 8.0;
    draw_chips(painter, game, at);
    if round.basket().is_some() {
        let middle = screen.right_top() + vec2(-18.0 - JAR, 16.0 + JAR);
        draw_jar(ui, middle, game);
    }
    is_on_button
}

/// What is different from usual, each on a chip with a sign.
fn draw_chips(painter: &Painter, game: &Game, mut at: Pos2) {
    let (theme, said) = (game.theme(), game.words());
    let mut chip = |sign: &str, text: &str| {
        let font = FontId::proportional(17.0);
        let text = format!("{sign} {text}");
        let galley = painter.layout_no_wrap(text, font, theme.ink);
        let rect = Rect::from_min_size(at, vec2(galley.size().x + 28.0, HIGH));
        painter.rect_filled(rect, 0.5 * HIGH, pale(&theme));
        painter.galley(rect.center() - 0.5 * galley.size(), galley, theme.ink);
        at.x += rect.width() + 8.0;
    };
    if !game.session.is_played() {
        chip("●", said.watching);
    }
    if game.stepping {
        chip("▶1", (said.action)(Action::Step));
    } else if game.slow {
        chip("▶…", (said.action)(Action::Slow));
    }
    if game.players.second().is_some() {
        chip("●●", said.join_hint);
    }
    if let Some(colour) = game.elements {
        draw_legend(painter, &theme, at, colour);
    }
}

/// What the colours of elements tell: small to large, or at ease to strained.
fn draw_legend(painter: &Painter, theme: &Theme, at: Pos2, colour: ElementColour) {
    let rect = Rect::from_min_size(at, vec2(176.0, HIGH));
    painter.rect_filled(rect, 0.5 * HIGH, pale(theme));
    let middle = rect.center().y;
    let line = Stroke::new(1.0, theme.ink);
    match colour {
        ElementColour::Level => {
            let mut x = rect.left() + 20.0;
            for level in 0..5u8 {
                let side = [5.0, 9.0, 14.0, 20.0, 28.0][usize::from(level)];
                let square = Rect::from_center_size(pos2(x + 0.5 * side, middle), vec2(side, side));
                painter.rect_filled(square, 0.0, theme.level(level));
                painter.rect_stroke(square, 0.0, line, egui::StrokeKind::Inside);
                x += side + 14.0;
            }
        }
        ElementColour::Strain => {
            let bar = rect.shrink2(vec2(40.0, 15.0));
            for step in 0..24 {
                let share = step as f32 / 24.0;
                let left = bar.left() + share * bar.width();
                let size = vec2(bar.width() / 24.0 + 0.5, bar.height());
                let part = Rect::from_min_size(pos2(left, bar.top()), size);
                painter.rect_filled(part, 0.0, theme.strain(0.5 * share));
            }
            painter.rect_stroke(bar, 2.0, line, egui::StrokeKind::Outside);
            let round = |x: f32, size: egui::Vec2| {
                painter.add(Shape::ellipse_stroke(
                    pos2(x, middle),
                    size,
                    Stroke::new(2.5, theme.ink),
                ));
            };
            round(rect.left() + 22.0, vec2(9.0, 9.0));
            round(rect.right() - 22.0, vec2(13.0, 5.0));
        }
    }
}

/// How much rests in the basket: a jar to be filled up to its line, then a ring that closes.
fn draw_jar(ui: &Ui, middle: Pos2, game: &Game) {
    let theme = game.theme();
    let round = game.session.round();
    let (progress, rules) = (round.progress(), round.level().game());
    let painter = ui.painter();
    let inside = progress.inside.clamp(0.0, 1.0);
    let id = egui::Id::unique("jar");
    let shown = ui.ctx().animate_value_with_time(id, inside, 0.2);
    painter.circle_filled(
        middle + vec2(0.0, 3.0),
        JAR + 4.0,
        Color32::from_black_alpha(28),
    );
    painter.circle_filled(middle, JAR + 4.0, theme.card);
    let glass = JAR - 5.0;
    painter.circle_filled(middle, glass, theme.paper);
    // Part of the way up the glass, as an angle from its lowest point.
    let angle = |share: f32| (1.0 - 2.0 * share).clamp(-1.0, 1.0).acos();
    let point = |angle: f32| middle + glass * vec2(angle.sin(), angle.cos());
    // What is wanted, pale, and what is there.
    let fill = theme.material(1);
    for (share, fill) in [(rules.share, fill.gamma_multiply(0.16)), (shown, fill)] {
        if share > 0.005 {
            let most = angle(share);
            let filled = (0..=32).map(|step| point(most * (step as f32 / 16.0 - 1.0)));
            painter.add(Shape::convex_polygon(filled.collect(), fill, Stroke::NONE));
        }
    }
    let line = angle(rules.share);
    let ends = [point(-line), point(line)];
    painter.extend(Shape::dashed_line(
        &ends,
        Stroke::new(2.5, theme.ink),
        6.0,
        4.0,
    ));
    painter.circle_stroke(
        middle,
        glass,
        Stroke::new(2.0, theme.ink.gamma_multiply(0.35)),
    );
    let held = match progress.outcome {
        Some(_) => 1.0,
        None => (progress.held / rules.hold.max(0.1)).clamp(0.0, 1.0),
    };
    if held > 0.0 {
        let ring = Stroke::new(7.0, theme.good);
        marks::arc(painter, middle, JAR, held, ring);
    }
    if progress.outcome.is_some() {
        marks::tick(painter, middle, 0.55 * JAR, Stroke::new(7.0, theme.card));
        marks::tick(painter, middle, 0.55 * JAR, Stroke::new(5.0, theme.good));
    }
}

fn pale(theme: &Theme) -> Color32 {
    theme.card.gamma_multiply(0.72)
}

fn draw_pause(painter: &Painter, at: Pos2, ink: Color32) {
    for x in [-5.0, 5.0] {
        let bar = Rect::from_center_size(at + vec2(x, 0.0), vec2(5.0, 17.0));
        painter.rect_filled(bar, 2.0, ink);
    }
}

/// An arrow that comes back to where it began.
fn draw_again(painter: &Painter, at: Pos2, ink: Color32) {
    let stroke = Stroke::new(3.5, ink);
    marks::arc(painter, at, 9.0, 0.8, stroke);
    let head = at + vec2(0.0, -9.0);
    let corners = vec![
        head + vec2(-7.0, 0.0),
        head + vec2(2.0, -6.0),
        head + vec2(2.0, 6.0),
    ];
    painter.add(Shape::convex_polygon(corners, ink, Stroke::NONE));
}
