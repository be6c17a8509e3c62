//! Overlay of a round: clock, goals, fill level of the basket, and unusual modes.

use super::buttons::{self, EDGE, GAP, HIGH, pale};
use super::{goals, icons, toys};
use crate::game::Game;
use crate::input::Action;
use app_shell::Theme;
use app_shell::widgets::fitted;
use egui::{Align2, Color32, FontId, Galley, Painter, Pos2, Rect, Shape, Stroke, Ui, pos2, vec2};
use fuwafuwa_render::frame::ElementColour;
use std::sync::Arc;

/// Height of a line of the 3D instructions [points at scale 1].
const LINE: f32 = 34.0;
/// Height of the strip at the lower edge of the screen at a public stand, which holds the language button
/// [points].
pub(super) const STAND: f32 = 92.0;
/// Radius of the jar that shows the fill level of the basket [points at scale 1].
const JAR: f32 = 36.0;
/// Maximum scale of the overlay. In a small window egui's zoom is reduced, so that menus fit. The overlay
/// needs less room, so it is enlarged again, at most by this factor.
const MOST: f32 = 1.4;
/// Time for which the name of the level is shown at the start of a round [ticks].
const NAME: u64 = 150;
/// Time in which the name fades out [ticks].
const FADE: f32 = 30.0;
/// Minimum width of a window for the overlay [points at scale 1]. A narrower window is not enlarged.
const NARROWEST: f32 = 375.0;

/// Shows the overlay; returns whether the mouse is over a button.
pub(super) fn show(game: &mut Game, ui: &mut Ui) -> bool {
    let scale = scale(game, ui);
    let theme = game.theme();
    let screen = ui.max_rect().shrink(scale * EDGE);
    let mut at = screen.left_top();
    let start = at.x;
    let (end, is_on_button) = buttons::show(game, ui, at, scale);
    at.x = end;
    let round = game.bout.round();
    let mut right = screen.right();
    if round.has_basket() {
        let radius = scale * (JAR + 4.0);
        let middle = screen.right_top() + vec2(-radius, radius);
        draw_jar(ui, middle, scale, game);
        right = middle.x - radius;
    }
    let mut row = ChipRow {
        painter: ui.painter(),
        fill: pale(&theme),
        scale,
        start,
        at,
        right,
    };
    draw_clock(&mut row, &theme, game);
    goals::strip(&mut row, &theme, game);
    draw_chips(&mut row, &theme, game);
    let jar = match round.has_basket() {
        true => screen.top() + 2.0 * scale * (JAR + 4.0),
        false => screen.top(),
    };
    let mut free = screen.with_min_y(jar.max(row.at.y + scale * HIGH) + scale * GAP);
    free.min.y = draw_name(ui, free, scale, game);
    draw_caption(ui, free, scale, game);
    draw_lesson(ui, screen, scale, game);
    is_on_button
}

/// Height of the upper row including its margins [points].
pub(super) fn height(game: &Game, ui: &Ui) -> f32 {
    scale(game, ui) * (EDGE + HIGH + GAP)
}

/// Scale of the overlay.
pub(super) fn scale(game: &Game, ui: &Ui) -> f32 {
    full_scale(game, ui).min(MOST)
}

/// Scale at which things have the same size on the screen in a small window as in a large one.
pub(super) fn full_scale(game: &Game, ui: &Ui) -> f32 {
    let room = (ui.max_rect().width() / NARROWEST).max(1.0);
    (game.settings.text_size / ui.ctx().zoom_factor()).clamp(1.0, room)
}

/// Flow layout of a row that wraps at the right edge.
pub(super) struct ChipRow<'a> {
    pub(super) painter: &'a Painter,
    fill: Color32,
    pub(super) scale: f32,
    start: f32,
    at: Pos2,
    right: f32,
}

impl ChipRow<'_> {
    /// Reserves a rectangle of unscaled width `width` and draws its background.
    pub(super) fn take(&mut self, width: f32) -> Rect {
        let size = self.scale * vec2(width, HIGH);
        if self.at.x + size.x > self.right && self.at.x > self.start {
            self.at = pos2(self.start, self.at.y + self.scale * (HIGH + GAP));
        }
        let rect = Rect::from_min_size(self.at, size);
        self.at.x = rect.right() + self.scale * GAP;
        self.painter.rect_filled(rect, 0.5 * size.y, self.fill);
        rect
    }
}

/// Draws the time since the first push.
fn draw_clock(row: &mut ChipRow, theme: &Theme, game: &Game) {
    let clock = format!("{:.1}", game.bout.round().seconds());
    // Reserves at least four characters, so that the clock does not jump.
    let at = row.take(34.0 + 15.0 * clock.len().max(4) as f32).center();
    let font = FontId::proportional(26.0 * row.scale);
    let painter = row.painter;
    painter.text(at, Align2::CENTER_CENTER, clock, font, theme.ink);
}

/// Draws a chip, a label with a pale background, for each unusual mode.
fn draw_chips(row: &mut ChipRow, theme: &Theme, game: &Game) {
    let said = game.words();
    let mut chip = |sign: &str, text: &str| {
        let font = FontId::proportional(19.0 * row.scale);
        let text = format!("{sign} {text}");
        let galley = row.painter.layout_no_wrap(text, font, theme.ink);
        let rect = row.take(galley.size().x / row.scale + 28.0);
        let at = rect.center() - 0.5 * galley.size();
        row.painter.galley(at, galley, theme.ink);
    };
    if !game.bout.session.is_played() {
        chip("●", said.watching);
    }
    if game.bout.session.is_rewinding() {
        let left = game.bout.session.seconds_to_rewind();
        chip("«", &format!("{} {left:.1}", (said.action)(Action::Rewind)));
    } else if game.bout.round().rewinds() > 0 {
        chip("«", said.rewound);
    }
    if !game.bout.round().level().game().assists.is_empty() {
        chip("+", said.assisted);
    }
    if game.bout.stepping {
        chip("▶1", (said.action)(Action::Step));
    } else if game.bout.slow {
        chip("▶…", (said.action)(Action::Slow));
    }
    if game.controls.players.second().is_some() {
        chip("●●", said.join_hint);
    }
    if game.forces.is_cut() {
        chip("×", said.forces_cut);
    }
    if game.bout.elements.is_some() && game.bout.turn().is_some() && game.bout.session.is_played() {
        let ways = [Action::Deeper, Action::Shallower];
        let keys = ways.map(|way| game.settings.bindings.first_names(&[way], false));
        if let Some(how) = (said.look_inside)(game.controls.means, &keys) {
            chip("↕", &how);
        }
    }
    if let Some(colour) = game.bout.elements {
        draw_legend(row, theme, colour);
    }
}

/// Returns the lower edge of the part of the screen that the buttons of a stand or a playground leave free.
fn lower_edge(ui: &Ui, screen: Rect, game: &Game) -> f32 {
    let taken = match game.public {
        Some(_) => STAND,
        None => toys::height(game, ui),
    };
    screen.bottom() - taken
}

/// Draws the 3D instructions in the lower left corner. Each line disappears once its action was tried.
fn draw_lesson(ui: &Ui, screen: Rect, scale: f32, game: &Game) {
    let (theme, painter) = (game.theme(), ui.painter());
    let mut bottom = lower_edge(ui, screen, game);
    for (index, (line, is_missing)) in game.lesson().into_iter().enumerate().rev() {
        let id = egui::Id::unique(("lesson", index));
        let strength = match game.settings.reduced_motion {
            true => f32::from(u8::from(is_missing)),
            false => ui.ctx().animate_bool_with_time(id, is_missing, 0.5),
        };
        if strength == 0.0 {
            continue;
        }
        let ink = theme.ink.gamma_multiply(strength);
        let width = screen.width() - scale * 28.0;
        let galley = fitted(painter, &line, scale * 19.0, width, ink);
        let size = vec2(galley.size().x + scale * 28.0, scale * LINE);
        let rect = Rect::from_min_size(pos2(screen.left(), bottom - size.y), size);
        let fill = pale(&theme).gamma_multiply(strength);
        painter.rect_filled(rect, 0.5 * size.y, fill);
        painter.galley(rect.center() - 0.5 * galley.size(), galley, ink);
        // While a line fades out, the lines above it move down.
        bottom -= strength * scale * (LINE + 0.5 * GAP);
    }
}

/// Draws the name of the level at the top of the `free` part of the screen, in the first seconds of a round. Returns the
/// upper edge of what is then free.
fn draw_name(ui: &Ui, free: Rect, scale: f32, game: &Game) -> f32 {
    let round = game.bout.round();
    let left = NAME.saturating_sub(round.ticks()) as f32;
    let session = &game.bout.session;
    let is_busy = session.is_rewinding() || session.is_winding() || game.bout.elements.is_some();
    // Notices lie at the same place.
    if left == 0.0 || is_busy || game.notices.iter().next().is_some() {
        return free.top();
    }
    let strength = match game.settings.reduced_motion {
        true => 1.0,
        false => (left / FADE).min(1.0),
    };
    let name = game.settings.language.of(&round.level().game().name);
    let ink = game.theme().ink.gamma_multiply(strength);
    let width = free.width() - scale * 48.0;
    let fill = pale(&game.theme()).gamma_multiply(strength);
    let galley = fitted(ui.painter(), name, 30.0 * scale, width, ink);
    let below = draw_label(ui, free, scale, galley, fill);
    if !round.is_weightless() {
        return below;
    }
    let galley = fitted(
        ui.painter(),
        game.words().nothing_falls,
        19.0 * scale,
        width,
        ink,
    );
    draw_label(ui, free.with_min_y(below), scale, galley, fill)
}

/// Draws the explanation of the element view at the top of the `free` part of the screen.
fn draw_caption(ui: &Ui, free: Rect, scale: f32, game: &Game) {
    let Some(colour) = game.bout.elements else {
        return;
    };
    let text = (game.words().elements_caption)(colour).to_string();
    let font = FontId::proportional(18.0 * scale);
    let width = (free.width() - scale * 48.0).min(scale * 620.0);
    let ink = game.theme().ink;
    let galley = ui.painter().layout(text, font, ink, width);
    draw_label(ui, free, scale, galley, pale(&game.theme()));
}

/// Draws a text on a background at the top of the `free` part of the screen. Returns the upper edge of what is then
/// free.
fn draw_label(ui: &Ui, free: Rect, scale: f32, galley: Arc<Galley>, fill: Color32) -> f32 {
    let size = galley.size() + scale * vec2(32.0, 16.0);
    let at = pos2(free.center().x - 0.5 * size.x, free.top());
    let rect = Rect::from_min_size(at, size);
    ui.painter().rect_filled(rect, scale * 16.0, fill);
    let at = rect.center() - 0.5 * galley.size();
    ui.painter().galley(at, galley, Color32::BLACK);
    rect.bottom() + scale * GAP
}

/// Draws the legend of element colours: small to large, or relaxed to strained.
fn draw_legend(row: &mut ChipRow, theme: &Theme, colour: ElementColour) {
    let (rect, scale, painter) = (row.take(176.0), row.scale, row.painter);
    let middle = rect.center().y;
    let line = Stroke::new(1.0, theme.ink);
    match colour {
        ElementColour::Level => {
            let mut x = rect.left() + 20.0 * scale;
            for level in 0..5u8 {
                let side = scale * [5.0, 9.0, 14.0, 20.0, 28.0][usize::from(level)];
                let square = Rect::from_center_size(pos2(x + 0.5 * side, middle), vec2(side, side));
                painter.rect_filled(square, 0.0, theme.level(level));
                painter.rect_stroke(square, 0.0, line, egui::StrokeKind::Inside);
                x += side + 14.0 * scale;
            }
        }
        ElementColour::Strain => {
            let bar = rect.shrink2(scale * vec2(41.0, 15.0));
            let bar = bar.translate(vec2(-3.0 * scale, 0.0));
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
                    scale * size,
                    Stroke::new(2.5 * scale, theme.ink),
                ));
            };
            round(rect.left() + 22.0 * scale, vec2(9.0, 9.0));
            round(rect.right() - 22.0 * scale, vec2(13.0, 5.0));
        }
    }
}

/// Draws the fill level of the basket as a jar with a target line. The mass inside is pale, the mass at rest
/// is strong. A ring closes while the mass at rest stays above the target.
fn draw_jar(ui: &Ui, middle: Pos2, scale: f32, game: &Game) {
    let theme = game.theme();
    let round = game.bout.round();
    let (progress, rules) = (round.progress(), round.level().game());
    let painter = ui.painter();
    let smooth = |name: &str, share: f32| {
        let id = egui::Id::unique(("jar", name));
        ui.ctx()
            .animate_value_with_time(id, share.clamp(0.0, 1.0), 0.2)
    };
    let rim = scale * (JAR + 4.0);
    let below = middle + vec2(0.0, 3.0 * scale);
    painter.circle_filled(below, rim, Color32::from_black_alpha(28));
    painter.circle_filled(middle, rim, theme.card);
    let glass = scale * (JAR - 5.0);
    painter.circle_filled(middle, glass, theme.paper);
    // Angle from the lowest point of the jar to the fill level at `share` of its height.
    let angle = |share: f32| (1.0 - 2.0 * share).clamp(-1.0, 1.0).acos();
    let point = |angle: f32| middle + glass * vec2(angle.sin(), angle.cos());
    let fill = theme.material(1);
    let levels = [
        // Required share of the mass, share inside the basket, and share at rest in the basket.
        (rules.share, 0.16),
        (smooth("within", progress.within), 0.45),
        (smooth("inside", progress.inside), 1.0),
    ];
    for (share, strength) in levels {
        if share > 0.005 {
            let most = angle(share);
            let filled = (0..=32).map(|step| point(most * (step as f32 / 16.0 - 1.0)));
            let fill = fill.gamma_multiply(strength);
            painter.add(Shape::convex_polygon(filled.collect(), fill, Stroke::NONE));
        }
    }
    let line = angle(rules.share);
    let ends = [point(-line), point(line)];
    let dashes = Stroke::new(2.5 * scale, theme.ink);
    painter.extend(Shape::dashed_line(&ends, dashes, 6.0 * scale, 4.0 * scale));
    let edge = Stroke::new(2.0 * scale, theme.ink.gamma_multiply(0.35));
    painter.circle_stroke(middle, glass, edge);
    let held = round.share_held();
    if held > 0.0 {
        let ring = Stroke::new(7.0 * scale, theme.good);
        icons::arc(painter, middle, scale * JAR, held, ring);
    }
    if progress.outcome.is_some() {
        for (width, ink) in [(7.0, theme.card), (5.0, theme.good)] {
            let stroke = Stroke::new(width * scale, ink);
            icons::tick(painter, middle, 0.55 * scale * JAR, stroke);
        }
    }
}
