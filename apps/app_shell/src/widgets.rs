//! Large round buttons, and focus handling for keys and gamepads.

use crate::Theme;
use egui::text::LayoutJob;
use egui::{
    Align, Color32, Context, FontId, Galley, Id, Painter, Rect, Response, Role, Sense, Stroke,
    StrokeKind, Ui, Vec2, WidgetInfo, vec2,
};
use std::sync::Arc;

/// Distance from a focused widget to the outside of its focus ring [points].
pub const RING: f32 = 7.0;

/// Height over which the contents of a page fade at its upper and lower edge [points].
pub const FADE: f32 = 56.0;

/// Font size on a button, as a share of the button's height.
pub const LETTERS: f32 = 0.42;

/// Importance of a button.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum ButtonStyle {
    /// Main action of a screen.
    Main,
    /// Any other action.
    Other,
}

impl ButtonStyle {
    /// Returns [`ButtonStyle::Main`] if `is_main`, otherwise [`ButtonStyle::Other`].
    pub fn of(is_main: bool) -> Self {
        match is_main {
            true => Self::Main,
            false => Self::Other,
        }
    }
}

/// Shows a large round button, with its text as accessible name.
pub fn button(ui: &mut Ui, theme: &Theme, text: &str, size: Vec2, weight: ButtonStyle) -> Response {
    let response = plain_button(ui, theme, text, size, weight);
    let enabled = ui.is_enabled();
    response.widget_info(|| WidgetInfo::labeled(Role::Button, enabled, text));
    response
}

/// Shows a button without an accessible name; the caller sets one.
pub fn plain_button(
    ui: &mut Ui,
    theme: &Theme,
    text: &str,
    size: Vec2,
    weight: ButtonStyle,
) -> Response {
    let (rect, response) = ui.allocate_exact_size(size, Sense::click());
    let lively = highlight(ui, &response);
    let (fill, ink) = match weight {
        ButtonStyle::Main => (theme.accent, theme.on_accent),
        ButtonStyle::Other => (theme.button, theme.ink),
    };
    let rect = rect.expand(3.0 * lively);
    let pressed = if response.is_pointer_button_down_on() {
        2.0
    } else {
        0.0
    };
    let rect = rect.translate(vec2(0.0, pressed));
    let round = 0.5 * rect.height();
    let painter = ui.painter();
    painter.rect_filled(
        rect.translate(vec2(0.0, 4.0 - pressed)),
        round,
        Color32::from_black_alpha(28),
    );
    painter.rect_filled(rect, round, fill);
    focus_ring(ui, &response, rect, round, theme);
    let room = rect.size() - vec2(28.0, 4.0);
    let galley = wrapped(ui.painter(), text, LETTERS * size.y, room, ink);
    let at = rect.center() - galley.rect.center().to_vec2();
    ui.painter().galley(at, galley, ink);
    response
}

/// Lays out text on one line, or centred on two lines if it would be much smaller on one. Shrinks it if it does not fit into
/// `room`. Lines break at spaces only.
pub fn wrapped(painter: &Painter, text: &str, size: f32, room: Vec2, ink: Color32) -> Arc<Galley> {
    /// Least share of the size on one line.
    const SHRUNK: f32 = 0.85;
    let one = fitted(painter, text, size, room.x, ink);
    let least = one
        .job
        .sections
        .first()
        .map_or(size, |part| part.format.font_id.size);
    if least >= SHRUNK * size {
        return one;
    }
    let two = text.match_indices(' ').map(|(at, _)| {
        let mut job = LayoutJob::simple(text.to_string(), FontId::default(), ink, f32::INFINITY);
        job.text.replace_range(at..=at, "\n");
        job.halign = Align::Center;
        job
    });
    let laid = |job: &LayoutJob, size: f32| {
        let mut job = job.clone();
        job.sections[0].format.font_id = FontId::proportional(size);
        painter.layout_job(job)
    };
    let narrowest = two.min_by(|a, b| {
        let [a, b] = [a, b].map(|job| laid(job, size).size().x);
        a.total_cmp(&b)
    });
    let Some(job) = narrowest else {
        return one;
    };
    let whole = laid(&job, size).size();
    let share = (room / whole).min_elem().min(1.0);
    match share * size > least {
        true => laid(&job, share * size),
        false => one,
    }
}

/// Returns the least font size that is legible on a phone [points]: 12 points without the zoom.
pub fn least_letters(ctx: &Context) -> f32 {
    12.0 / ctx.zoom_factor().min(1.0)
}

/// Lays out text on one line, shrunk if it is wider than `width`.
pub fn fitted(painter: &Painter, text: &str, size: f32, width: f32, ink: Color32) -> Arc<Galley> {
    let lay = |size| painter.layout_no_wrap(text.to_string(), FontId::proportional(size), ink);
    let galley = lay(size);
    match galley.size().x > width {
        true => lay((size * width / galley.size().x).max(8.0)),
        false => galley,
    }
}

/// Stores whether menus are used with keys or a gamepad. The focus ring is drawn only then, because mouse and
/// touch need none.
pub fn note_use_of_keys(ctx: &Context, by_keys: bool) {
    ctx.data_mut(|data| data.insert_temp(Id::unique("by keys"), by_keys));
}

/// Returns whether this widget has the focus and menus are used with keys or a gamepad.
pub fn is_on(ui: &Ui, response: &Response) -> bool {
    let by_keys = ui.data(|data| data.get_temp(Id::unique("by keys")));
    response.has_focus() && by_keys == Some(true)
}

/// Stores this widget for [`take_hovered`] if the mouse is over it.
pub fn note_hovered(ui: &Ui, response: &Response) {
    if response.hovered() {
        ui.data_mut(|data| data.insert_temp(Id::unique("hovered"), Some(response.id)));
    }
}

/// Returns the widget that the mouse was over most recently since the last call.
pub fn take_hovered(ctx: &Context) -> Option<Id> {
    ctx.data_mut(|data| data.remove_temp(Id::unique("hovered")).flatten())
}

/// Returns the animated highlight of a hovered or focused widget, 0 to 1.
pub fn highlight(ui: &Ui, response: &Response) -> f32 {
    let is_lively = response.hovered() || is_on(ui, response);
    note_hovered(ui, response);
    ui.ctx().animate_bool(response.id, is_lively)
}

/// Draws the focus ring of a widget, and scrolls a newly focused widget into view.
pub fn focus_ring(ui: &Ui, response: &Response, rect: Rect, round: f32, theme: &Theme) {
    let is_on = is_on(ui, response);
    let seen = Id::unique("what had the focus");
    if is_on && ui.data(|data| data.get_temp(seen)) != Some(response.id) {
        ui.data_mut(|data| data.insert_temp(seen, response.id));
        ui.scroll_to_rect(response.rect.expand(RING + FADE), None);
    }
    if is_on {
        let stroke = Stroke::new(4.0, theme.ink);
        let rect = rect.expand(RING - 2.0);
        ui.painter()
            .rect_stroke(rect, round + RING - 2.0, stroke, StrokeKind::Middle);
    }
}
