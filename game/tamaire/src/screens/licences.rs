//! Screen with the licences of the included software.

use super::widgets::{card, dim_background, header, page, page_rect};
use crate::game::Game;
use crate::licences::lines;
use app_shell::widgets::{ButtonStyle, button};
use egui::{
    Align, Color32, Label, Layout, OpenUrl, Rect, RichText, Sense, TextWrapMode, Ui, UiBuilder,
    vec2,
};
use tamaire_sound::Menu;

/// Line height [points].
const LINE: f32 = 20.0;
/// Font size [points].
const LETTERS: f32 = 15.0;
/// Number of lines in a focusable block. Keys and pads scroll block by block.
const LINES: usize = 16;

pub(super) fn show(game: &mut Game, ui: &mut Ui) {
    dim_background(ui, 255);
    let (theme, said) = (game.theme(), game.words());
    let mut back = ui.input(|input| input.key_pressed(egui::Key::Escape));
    let area = page_rect(ui);
    ui.scope_builder(UiBuilder::new().max_rect(area), |ui| {
        let response = header(ui, &theme, said.back, said.licences);
        super::widgets::focus_first(ui, &response);
        back |= response.clicked();
        page(ui, "licences", 820.0, |ui| {
            if cfg!(target_family = "wasm") {
                // `licences.txt`, a file beside the page, has all licence texts.
                let all = vec2(240.0, 48.0);
                if button(ui, &theme, "licences.txt", all, ButtonStyle::Other).clicked() {
                    ui.ctx().open_url(OpenUrl::new_tab("licences.txt"));
                }
                ui.add_space(12.0);
            }
            card(ui, &theme, |ui| {
                for (index, lines) in lines().chunks(LINES).enumerate() {
                    let size = vec2(ui.available_width(), LINE * lines.len() as f32);
                    ui.spacing_mut().item_spacing.y = 0.0;
                    let (_, place) = ui.allocate_space(size);
                    let id = ui.scope_id().with(index);
                    let part = ui.interact(place, id, Sense::focusable_noninteractive());
                    if part.gained_focus() {
                        ui.scroll_to_rect(place, None);
                    }
                    if ui.is_rect_visible(place) {
                        write(ui, place, lines, theme.ink);
                    }
                }
            });
        });
    });
    if back {
        game.blip(Menu::Back);
        game.go_back();
    }
}

/// Writes the lines of a block.
fn write(ui: &mut Ui, place: Rect, lines: &[&str], ink: Color32) {
    let builder = UiBuilder::new().max_rect(place);
    ui.scope_builder(builder.layout(Layout::top_down(Align::Min)), |ui| {
        for line in lines {
            let text = RichText::new(*line).size(LETTERS).color(ink);
            let label = Label::new(text).wrap_mode(TextWrapMode::Extend);
            let (room, layout) = (
                vec2(place.width(), LINE),
                Layout::left_to_right(Align::Center),
            );
            ui.allocate_ui_with_layout(room, layout, |ui| ui.add(label));
        }
    });
}
