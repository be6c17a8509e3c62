//! Help with the controls, and the legend of the colours.

use super::section::Shown;
use crate::case::Case;
use app_shell::Theme;
use app_shell::widgets::{ButtonStyle, button};
use egui::{Align2, Color32, FontId, Pos2, Rect, Stroke, StrokeKind, Ui, UiBuilder, pos2, vec2};
use fuwafuwa_render::{Colour, Palette};

/// Controls in the window: action and keys.
pub const CONTROLS: [[&str; 2]; 10] = [
    ["Move the tool", "mouse, arrows, or W A S D"],
    ["Raise and lower it", "wheel, or Q Z"],
    ["Grip with the forceps", "left button, or space"],
    ["Look around", "right button, or [ ]"],
    ["Choose knife, forceps, hook", "1, 2, 3"],
    ["Turn the tool", "J L, I K, U O"],
    ["Straighten the tool", "X"],
    ["Pause; restart", "P; R"],
    ["Switch all forces off or on", "F12"],
    ["Show or hide this help", "F1, or ?"],
];

/// Distance of the parts from the edges of the view [points].
const EDGE: f32 = 12.0;
/// Size of the button that opens the help [points].
const BUTTON: egui::Vec2 = vec2(110.0, 36.0);
/// Height of a row of the help [points].
const ROW: f32 = 30.0;
/// Width of the help [points].
const WIDE: f32 = 520.0;
/// Side of a coloured square of the legend [points].
const SQUARE: f32 = 16.0;
/// Maximum number of materials in the legend.
const MOST_ROWS: usize = 12;

/// Shows the button that opens or closes the help in the upper left corner of the view, and the open help below
/// it. Returns the rectangles of both.
pub fn show(ui: &mut Ui, theme: &Theme, view: Rect, is_open: &mut bool) -> Vec<Rect> {
    let place = Rect::from_min_size(view.min + vec2(EDGE, EDGE), BUTTON);
    let weight = ButtonStyle::of(*is_open);
    let builder = UiBuilder::new().max_rect(place);
    let response = ui.scope_builder(builder, |ui| button(ui, theme, "Keys (F1)", BUTTON, weight));
    if response.inner.clicked() {
        *is_open = !*is_open;
    }
    if !*is_open {
        return vec![place];
    }
    let size = vec2(
        WIDE.min(view.width() - 2.0 * EDGE),
        ROW * CONTROLS.len() as f32 + 28.0,
    );
    let card = Rect::from_min_size(place.left_bottom() + vec2(0.0, EDGE), size);
    let painter = ui.painter().with_clip_rect(view);
    painter.rect_filled(card, 18.0, theme.card);
    for (row, [action, keys]) in CONTROLS.into_iter().enumerate() {
        let y = card.top() + 14.0 + ROW * (row as f32 + 0.5);
        let [left, right] = [card.left() + 20.0, card.right() - 20.0];
        let font = FontId::proportional(17.0);
        let ink = theme.ink;
        painter.text(
            pos2(left, y),
            Align2::LEFT_CENTER,
            action,
            font.clone(),
            ink,
        );
        painter.text(pos2(right, y), Align2::RIGHT_CENTER, keys, font, ink);
    }
    vec![place, card]
}

/// Shows the legend of the colours of the slices in the lower left corner of the view.
pub fn legend(ui: &Ui, theme: &Theme, view: Rect, case: &Case, shown: Shown, colours: &Palette) {
    let rows = match shown {
        Shown::Materials => materials(case, colours),
        Shown::Strain => [0.0, 0.25, 0.5]
            .map(|strain| {
                (
                    Some(colours.strain(strain)),
                    format!("strain {:.0} %", 100.0 * strain),
                )
            })
            .to_vec(),
    };
    let painter = ui.painter().with_clip_rect(view);
    let font = FontId::proportional(16.0);
    let texts: Vec<_> = { rows.into_iter() }
        .map(|(colour, name)| {
            (
                colour,
                painter.layout_no_wrap(name, font.clone(), theme.ink),
            )
        })
        .collect();
    let wide = { texts.iter() }
        .map(|(_, text)| text.size().x)
        .fold(0.0, f32::max);
    let size = vec2(wide + SQUARE + 36.0, 24.0 * texts.len() as f32 + 16.0);
    let corner = view.left_bottom() + vec2(EDGE, -EDGE - size.y);
    let card = Rect::from_min_size(corner, size);
    painter.rect_filled(card, 14.0, theme.card.gamma_multiply(0.9));
    for (row, (colour, text)) in texts.into_iter().enumerate() {
        let y = card.top() + 8.0 + 24.0 * (row as f32 + 0.5);
        let middle = pos2(card.left() + 14.0 + 0.5 * SQUARE, y);
        let square = Rect::from_center_size(middle, vec2(SQUARE, SQUARE));
        if let Some(colour) = colour {
            painter.rect(
                square,
                4.0,
                screen(colour),
                Stroke::new(1.0, theme.ink),
                StrokeKind::Inside,
            );
        }
        let at: Pos2 = pos2(square.right() + 8.0, y - 0.5 * text.size().y);
        painter.galley(at, text, theme.ink);
    }
}

/// Returns the colour and the name of each material of the organ, at most [`MOST_ROWS`], and a row without a colour
/// that counts the others. Materials of a scan have numbers only.
fn materials(case: &Case, colours: &Palette) -> Vec<(Option<Colour>, String)> {
    let count = case.tissues.len();
    let last = count.min(MOST_ROWS) as u8;
    let named =
        (1..=last).map(|number| (Some(colours.material(number)), case.material_name(number)));
    let more = (count > MOST_ROWS).then(|| (None, format!("and {} more", count - MOST_ROWS)));
    named.chain(more).collect()
}

fn screen(colour: Colour) -> Color32 {
    let [red, green, blue] = colour.map(|k| (255.0 * k + 0.5) as u8);
    Color32::from_rgb(red, green, blue)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::phantom;

    #[test]
    fn legend_names_materials_and_numbers_those_without_a_name() {
        let colours = crate::app::pictures::palette();
        let mut case = phantom::case(32).unwrap();
        let names = |case: &Case| -> Vec<String> {
            { materials(case, &colours).into_iter() }
                .map(|(_, name)| name)
                .collect()
        };
        assert_eq!(names(&case), ["flesh", "core", "growth", "vessels"]);
        case.names.clear();
        case.tissues.truncate(2);
        assert_eq!(names(&case), ["material 1", "material 2"]);
        case.tissues = crate::case::tissues(255);
        assert_eq!(names(&case).len(), MOST_ROWS + 1);
        assert_eq!(names(&case)[MOST_ROWS], "and 243 more");
        case.tissues.truncate(MOST_ROWS);
        assert_eq!(names(&case).len(), MOST_ROWS);
    }
}
