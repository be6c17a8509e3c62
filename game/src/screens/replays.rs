//! Rounds that were kept.

use super::doomed::{doom, is_doomed};
use super::widgets::{Weight, button, card, fitted, header, page, place_of_page, veil};
use crate::game::Game;
use crate::platform::Entry;
use crate::platform::HAS_PICTURES;
use egui::{RichText, Ui, vec2};
use tamaire_sound::Menu;

/// Width of a button.
const WIDE: f32 = 130.0;

/// What to do with a replay.
#[derive(Copy, Clone)]
enum Wish {
    Watch,
    Race,
    Clip,
    Delete,
}

pub(super) fn show(game: &mut Game, ui: &mut Ui) {
    veil(ui, 255);
    let (theme, said) = (game.theme(), game.words());
    let mut wanted: Option<(usize, Wish)> = None;
    let mut back = ui.input(|input| input.key_pressed(egui::Key::Escape));
    let area = place_of_page(ui);
    ui.scope_builder(egui::UiBuilder::new().max_rect(area), |ui| {
        let response = header(ui, &theme, said.back, said.replays);
        super::play::focus_first(ui, &response);
        back |= response.clicked();
        page(ui, "replays", 960.0, |ui| {
            if game.replays.is_empty() {
                ui.vertical_centered(|ui| {
                    ui.add_space(60.0);
                    ui.label(RichText::new(said.no_replays).size(22.0).color(theme.faint));
                });
            }
            for (place, saved) in game.replays.iter().enumerate() {
                card(ui, &theme, |ui| {
                    ui.horizontal(|ui| {
                        let name = name_of(game, saved);
                        let count = if HAS_PICTURES { 4.0 } else { 3.0 };
                        let size = vec2(ui.available_width() - count * (WIDE + 10.0), 44.0);
                        let (room, _) = ui.allocate_exact_size(size, egui::Sense::hover());
                        let galley = fitted(ui.painter(), &name, 22.0, size.x, theme.ink);
                        let at = room.left_center() - vec2(0.0, 0.5 * galley.size().y);
                        ui.painter().galley(at, galley, theme.ink);
                        for (text, wish) in [
                            (said.watch, Wish::Watch),
                            (said.race, Wish::Race),
                            (said.clip, Wish::Clip),
                            (
                                match is_doomed(ui, &saved.name) {
                                    true => said.surely,
                                    false => said.delete,
                                },
                                Wish::Delete,
                            ),
                        ]
                        .into_iter()
                        .filter(|(_, wish)| HAS_PICTURES || !matches!(wish, Wish::Clip))
                        {
                            if button(ui, &theme, text, vec2(WIDE, 44.0), Weight::Other).clicked() {
                                wanted = Some((place, wish));
                            }
                        }
                    });
                });
                ui.add_space(8.0);
            }
        });
    });
    if back {
        game.blip(Menu::Back);
        game.go_back();
    } else if let Some((place, wish)) = wanted {
        game.blip(Menu::Confirm);
        let saved = game.replays[place].clone();
        match wish {
            Wish::Watch => game.open_kept(&saved.name, Game::watch),
            Wish::Race => game.open_kept(&saved.name, Game::race),
            Wish::Clip => game.open_kept(&saved.name, Game::keep_clip_of),
            Wish::Delete if is_doomed(ui, &saved.name) => game.delete(&saved),
            Wish::Delete => {}
        }
        doom(ui, matches!(wish, Wish::Delete).then_some(&saved.name));
    }
}

/// By its level, where that is known, and its number.
fn name_of(game: &Game, saved: &Entry) -> String {
    let known = saved.name.rsplit_once('-').and_then(|(id, number)| {
        let level = game.levels.iter().find(|level| level.id == id)?;
        let name = game.settings.language.of(&level.game().name);
        Some(format!("{name} {number}"))
    });
    known.unwrap_or_else(|| saved.name.clone())
}
