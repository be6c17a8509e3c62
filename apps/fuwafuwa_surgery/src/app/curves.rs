//! Plots of the measurements over time.

use super::pictures::RED;
use super::session::Session;
use crate::measures::Sample;
use app_shell::Theme;
use app_shell::widgets::fitted;
use egui::{Align2, Color32, FontId, Pos2, Rect, Stroke, Ui, pos2, vec2};
use fuwafuwa::DEFAULT_TICK;

/// Time span of the plots [s].
const SPAN: f32 = 20.0;
/// Height of the line of text above a curve [points].
const HEAD: f32 = 28.0;
const BLUE: Color32 = Color32::from_rgb(47, 111, 159);

/// Plot of a measured quantity over time.
struct Curve {
    name: &'static str,
    unit: &'static str,
    colour: Color32,
    /// Minimum upper end of the vertical axis. The axis extends beyond it to show larger values.
    least: f32,
    value: fn(&Sample) -> f32,
}

const CURVES: [Curve; 2] = [
    Curve {
        name: "Force",
        unit: "N",
        colour: RED,
        least: 1.0,
        value: |sample| sample.force.length(),
    },
    Curve {
        name: "Cut",
        unit: "mm²",
        colour: BLUE,
        least: 100.0,
        value: |sample| 1e6 * sample.area as f32,
    },
];

/// Draws the plots side by side, and the measurements without a plot as text at their right.
pub fn show(ui: &mut Ui, session: &Session, theme: &Theme) {
    let rect = ui.available_rect_before_wrap();
    let wide = 0.36 * rect.width();
    for (number, curve) in CURVES.iter().enumerate() {
        let left = rect.left() + number as f32 * (wide + 10.0);
        let place = Rect::from_min_size(pos2(left, rect.top()), vec2(wide, rect.height()));
        draw(ui, place, curve, session.procedure().samples(), theme);
    }
    let left = rect.left() + 2.0 * (wide + 10.0) + 8.0;
    let place = Rect::from_min_max(pos2(left, rect.top()), rect.max);
    numbers(ui, place, session, theme);
}

fn draw(ui: &Ui, rect: Rect, curve: &Curve, samples: &[Sample], theme: &Theme) {
    let painter = ui.painter().with_clip_rect(rect);
    painter.rect_filled(rect, 12.0, theme.card);
    let seen = &samples[samples.len().saturating_sub((SPAN / DEFAULT_TICK) as usize)..];
    let most = seen.iter().map(curve.value).fold(0.0, f32::max);
    let top = (1.15 * most).max(curve.least);
    // The curve stays below the line of text.
    let text_at = rect.shrink2(vec2(10.0, 6.0));
    let room = text_at.with_min_y(text_at.top() + HEAD);
    let floor = Stroke::new(1.0, theme.faint.gamma_multiply(0.5));
    painter.hline(room.x_range(), room.bottom(), floor);
    let newest = samples.len();
    let first = newest - seen.len();
    let at = |(place, sample): (usize, &Sample)| -> Pos2 {
        let ago = (newest - first - place) as f32 * DEFAULT_TICK / SPAN;
        let high = (curve.value)(sample) / top;
        pos2(
            room.right() - ago * room.width(),
            room.bottom() - high * room.height(),
        )
    };
    let points: Vec<Pos2> = seen.iter().enumerate().map(at).collect();
    if points.len() > 1 {
        painter.line(points, Stroke::new(2.0, curve.colour));
    }
    let now = samples.last().map_or(0.0, curve.value);
    let digits = if curve.least < 10.0 { 2 } else { 0 };
    let text = format!("{}  {now:.digits$} {}", curve.name, curve.unit);
    let font = FontId::proportional(20.0);
    painter.text(
        text_at.left_top(),
        Align2::LEFT_TOP,
        text,
        font,
        curve.colour,
    );
    let font = FontId::proportional(14.0);
    let text = format!("scale {top:.digits$} {}, {SPAN:.0} s", curve.unit);
    painter.text(
        text_at.right_top(),
        Align2::RIGHT_TOP,
        text,
        font,
        theme.faint,
    );
}

fn numbers(ui: &Ui, rect: Rect, session: &Session, theme: &Theme) {
    let painter = ui.painter().with_clip_rect(rect);
    let sample = session.last();
    let mut rows = vec![format!(
        "{:.1} s   knife path in tissue {:.0} mm",
        session.procedure().ticks() as f32 * DEFAULT_TICK,
        1e3 * sample.path
    )];
    let torque = 1e3 * sample.torque.length();
    rows.push(format!(
        "torque {torque:.1} mN m   work {:.1} mJ",
        1e3 * sample.work
    ));
    let shown = session.parts.iter().take(3);
    let volumes: Vec<String> = shown
        .map(|part| format!("{:.1}", part.millilitres))
        .collect();
    let rest = session.parts.len().saturating_sub(3);
    let more = if rest > 0 {
        format!(" and {rest} more")
    } else {
        String::new()
    };
    rows.push(format!("pieces [ml]: {}{more}", volumes.join(", ")));
    let inertia = session.procedure().table().inertia;
    if inertia > 1.0 {
        rows.push(format!(
            "mass scaled ×{inertia:.0} for speed; stiffness unchanged"
        ));
    }
    rows.push(format!("{:.1} ms per tick", 1e3 * session.cost()));
    let step = (rect.height() / rows.len() as f32).min(26.0);
    for (number, row) in rows.iter().enumerate() {
        let at = pos2(rect.left(), rect.top() + step * number as f32);
        let size = if number < 3 { 18.0 } else { 15.0 };
        let galley = fitted(&painter, row, size, rect.width(), theme.ink);
        painter.galley(at, galley, theme.ink);
    }
}
