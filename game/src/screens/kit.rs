//! Widgets that look like a toy: few, large and round. All of them can be reached with a pad.

use crate::look::Theme;
use egui::{
    Align2, Color32, FontId, Rect, Response, Role, Sense, Stroke, StrokeKind, Ui, Vec2, WidgetInfo,
    pos2, vec2,
};

/// What a button is for.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum Weight {
    /// What most people want here.
    Main,
    /// Something else.
    Other,
}

/// A large round button.
pub fn button(ui: &mut Ui, theme: &Theme, text: &str, size: Vec2, weight: Weight) -> Response {
    let (rect, response) = ui.allocate_exact_size(size, Sense::click());
    let enabled = ui.is_enabled();
    response.widget_info(|| WidgetInfo::labeled(Role::Button, enabled, text));
    let lively = ui
        .ctx()
        .animate_bool(response.id, response.hovered() || response.has_focus());
    let (fill, ink) = match weight {
        Weight::Main => (theme.accent, theme.on_accent),
        Weight::Other => (theme.button, theme.ink),
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
    let font = FontId::proportional(0.42 * size.y);
    ui.painter()
        .text(rect.center(), Align2::CENTER_CENTER, text, font, ink);
    response
}

/// A ring around what a pad or the keyboard is on, which comes into view.
pub fn focus_ring(ui: &Ui, response: &Response, rect: Rect, round: f32, theme: &Theme) {
    if response.gained_focus() && !ui.clip_rect().contains_rect(response.rect) {
        response.scroll_to_me(Some(egui::Align::Center));
    }
    if response.has_focus() {
        let stroke = Stroke::new(4.0, theme.ink);
        let rect = rect.expand(5.0);
        ui.painter()
            .rect_stroke(rect, round + 5.0, stroke, StrokeKind::Middle);
    }
}

/// A white card, and what is on it.
pub fn card<R>(ui: &mut Ui, theme: &Theme, contents: impl FnOnce(&mut Ui) -> R) -> R {
    let frame = egui::Frame::new()
        .fill(theme.card)
        .corner_radius(28.0)
        .inner_margin(24.0)
        .shadow(egui::Shadow {
            offset: [0, 6],
            blur: 24,
            spread: 0,
            color: Color32::from_black_alpha(40),
        });
    frame.show(ui, contents).inner
}

/// A slider with its name before and its value behind it. Left and right move it when it has the focus.
pub fn slider(
    ui: &mut Ui,
    theme: &Theme,
    name: &str,
    value: &mut f32,
    low: f32,
    high: f32,
    step: f32,
) -> Response {
    row(ui, theme, name, |ui| {
        let (rect, mut response) =
            ui.allocate_exact_size(vec2(260.0, 36.0), Sense::click_and_drag());
        let before = *value;
        let track = Rect::from_center_size(rect.center(), vec2(rect.width() - 28.0, 12.0));
        if let Some(pointer) = response.interact_pointer_pos() {
            let share = ((pointer.x - track.left()) / track.width()).clamp(0.0, 1.0);
            *value = low + (high - low) * share;
        }
        if response.has_focus() {
            let filter = egui::EventFilter {
                horizontal_arrows: true,
                ..Default::default()
            };
            ui.memory_mut(|memory| memory.set_focus_lock_filter(response.id, filter));
            let pressed = |key| ui.input(|input| input.num_presses(key)) as f32;
            *value += step * (pressed(egui::Key::ArrowRight) - pressed(egui::Key::ArrowLeft));
        }
        use egui::accesskit::Action;
        let asked = |action| {
            ui.input(|input| input.num_accesskit_action_requests(response.id, action)) as f32
        };
        *value += step * (asked(Action::Increment) - asked(Action::Decrement));
        *value = (step * (*value / step).round()).clamp(low, high);
        if *value != before {
            response.mark_changed();
        }
        let shown = *value;
        response.widget_info(|| WidgetInfo::slider(true, f64::from(shown), name));
        let share = (*value - low) / (high - low);
        let knob = pos2(track.left() + share * track.width(), track.center().y);
        let painter = ui.painter();
        painter.rect_filled(track, 6.0, theme.button);
        let done = Rect::from_min_max(track.min, pos2(knob.x, track.bottom()));
        painter.rect_filled(done, 6.0, theme.accent);
        painter.circle(knob, 14.0, theme.card, Stroke::new(4.0, theme.accent));
        focus_ring(ui, &response, rect, 18.0, theme);
        let text = format!("{:.0} %", 100.0 * *value);
        let font = FontId::proportional(20.0);
        let (place, _) = ui.allocate_exact_size(vec2(74.0, 36.0), Sense::hover());
        ui.painter().text(
            place.right_center(),
            Align2::RIGHT_CENTER,
            text,
            font,
            theme.ink,
        );
        response
    })
}

/// A choice between a few things, all of them in sight.
pub fn choice<T: Copy + PartialEq>(
    ui: &mut Ui,
    theme: &Theme,
    name: &str,
    value: &mut T,
    options: &[(T, &str)],
) -> bool {
    let mut changed = false;
    row(ui, theme, name, |ui| {
        for &(option, text) in options {
            let width = 36.0 + 18.0 * text.chars().count().max(3) as f32;
            let weight = if *value == option {
                Weight::Main
            } else {
                Weight::Other
            };
            // What is chosen is marked by more than its colour.
            let marked = if *value == option {
                format!("● {text}")
            } else {
                text.to_string()
            };
            if button(ui, theme, &marked, vec2(width + 24.0, 40.0), weight).clicked() {
                changed = *value != option;
                *value = option;
            }
        }
    });
    changed
}

fn row<R>(ui: &mut Ui, theme: &Theme, name: &str, contents: impl FnOnce(&mut Ui) -> R) -> R {
    ui.horizontal(|ui| {
        let (place, _) = ui.allocate_exact_size(vec2(230.0, 44.0), Sense::hover());
        let font = FontId::proportional(22.0);
        ui.painter().text(
            place.left_center(),
            Align2::LEFT_CENTER,
            name,
            font,
            theme.ink,
        );
        contents(ui)
    })
    .inner
}

/// A headline.
pub fn title(ui: &mut Ui, theme: &Theme, text: &str) {
    ui.label(
        egui::RichText::new(text)
            .size(38.0)
            .color(theme.ink)
            .strong(),
    );
}

/// A column of so many points in the middle of the screen, and what is in it.
pub fn column<R>(ui: &mut Ui, width: f32, height: f32, contents: impl FnOnce(&mut Ui) -> R) -> R {
    let screen = ui.max_rect();
    let size = vec2(
        width.min(screen.width() - 24.0),
        height.min(screen.height() - 24.0),
    );
    let rect = Rect::from_center_size(screen.center(), size);
    let builder = egui::UiBuilder::new()
        .max_rect(rect)
        .layout(egui::Layout::top_down(egui::Align::Center));
    ui.scope_builder(builder, contents).inner
}
