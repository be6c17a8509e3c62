//! Tools of a playground as a page, for players with keys, a pad or one switch.

use super::toys;
use super::widgets::{card, choice, dim_background, focus_first, header, page, page_rect};
use crate::game::Game;
use app_shell::widgets::{ButtonStyle, button};
use egui::{Key, Ui, UiBuilder, vec2};
use tamaire_play::playground::{Change, Stuff};
use tamaire_sound::Menu;

/// Size of the buttons that add a shape [points].
const ADD: egui::Vec2 = vec2(150.0, 48.0);

pub(super) fn show(game: &mut Game, ui: &mut Ui) {
    dim_background(ui, 255);
    let (theme, said) = (game.theme(), game.words());
    let mut back = ui.input(|input| input.key_pressed(Key::Escape));
    let area = page_rect(ui);
    ui.scope_builder(UiBuilder::new().max_rect(area), |ui| {
        let response = header(ui, &theme, said.back, said.tools);
        focus_first(ui, &response);
        back |= response.clicked();
        page(ui, "tools", 860.0, |ui| {
            let mut chosen = game.bout.toys;
            card(ui, &theme, |ui| {
                ui.set_width(ui.available_width());
                let tools = game.tools().map(|tool| (tool, (said.tool)(tool)));
                let tools: Vec<_> = tools.collect();
                if choice(ui, &theme, said.hand_tool, &mut chosen.tool, &tools) {
                    game.choose_tool(chosen.tool);
                }
                toys::room_sliders(ui, &theme, said, &mut chosen);
                game.set_room(chosen);
            });
            ui.add_space(12.0);
            card(ui, &theme, |ui| {
                ui.set_width(ui.available_width());
                let stuffs = Stuff::ALL.map(|stuff| (stuff, (said.stuff)(stuff)));
                let stuff = &mut game.bout.toys.stuff;
                choice(ui, &theme, said.material, stuff, &stuffs);
                ui.horizontal_wrapped(|ui| {
                    for form in toys::FORMS {
                        let name = (said.add_form)(form);
                        if button(ui, &theme, name, ADD, ButtonStyle::Other).clicked() {
                            game.blip(Menu::Confirm);
                            game.add_body(form);
                        }
                    }
                    if button(ui, &theme, said.clear, ADD, ButtonStyle::Other).clicked() {
                        game.blip(Menu::Confirm);
                        game.change_playground(Change::Clear);
                    }
                });
            });
        });
    });
    if back {
        game.blip(Menu::Back);
        game.go_back();
    }
}
