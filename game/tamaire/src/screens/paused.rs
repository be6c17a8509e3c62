//! Pause menu.

use super::goals;
use super::widgets::{Act, card, column, dim_background, menu, perform, title};
use crate::game::{Game, Screen, credits};
use app_shell::widgets::fitted;
use egui::{Ui, vec2};

pub(super) fn show(game: &mut Game, ui: &mut Ui) {
    dim_background(ui, 130);
    let (theme, said) = (game.theme(), game.words());
    let wanted = column(ui, 380.0, 0.5, |ui| {
        card(ui, &theme, |ui| {
            title(ui, &theme, said.paused);
            let name = game
                .settings
                .language
                .of(&game.bout.round().level().game().name);
            let galley = fitted(ui.painter(), name, 21.0, ui.available_width(), theme.faint);
            ui.label(galley);
            for text in credits(game.bout.round().level(), game.making()) {
                let galley = fitted(ui.painter(), &text, 17.0, ui.available_width(), theme.faint);
                ui.label(galley);
            }
            goals::lines(ui, &theme, game);
            ui.add_space(6.0);
            let mut options: Vec<(&str, Act)> = vec![
                (said.go_on, |game| game.go(Screen::Play)),
                (said.again, Game::retry),
                (said.save, Game::keep_replay),
                (said.link_to_level, Game::copy_link_to_level),
                (said.settings, |game| game.go(Screen::Settings)),
                (said.levels, |game| game.go(Screen::Levels)),
            ];
            if game.is_in_playground() {
                options.insert(1, (said.tools, |game| game.go(Screen::Toolbox)));
            }
            if game.is_test() {
                options.insert(1, (game.making().to_editor, Game::end_test));
            } else if game.is_with_drawing() {
                options.insert(1, (game.making().to_paper, Game::leave_round));
                options.insert(2, (game.making().build_level, Game::edit_room));
            } else if game.public.is_none() {
                options.push((game.making().change_this, Game::edit_current));
            }
            if game.may_show_way() {
                options.insert(2, (said.show_way, Game::show_way));
            }
            menu(ui, &theme, vec2(300.0, 46.0), &options)
        })
    });
    perform(game, ui, wanted, |game| game.go(Screen::Play));
}
