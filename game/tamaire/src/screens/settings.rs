//! Settings of the player.

use super::doomed::{is_pending, set_pending};
use super::widgets::{card, choice, dim_background, header, page, page_rect, slider};
use crate::game::{Game, Screen};
use crate::input::{Action, Scanning};
use crate::settings::Settings;
use crate::words::{Language, Words};
use app_shell::Theme;
use app_shell::widgets::{ButtonStyle, button};
use egui::{RichText, Ui, vec2};
use tamaire_play::Assist;
use tamaire_sound::Menu;

pub(super) fn show(game: &mut Game, ui: &mut Ui) {
    dim_background(ui, 255);
    let (theme, said) = (game.theme(), game.words());
    let before = game.settings.clone();
    let mut chosen = before.clone();
    let listens = game.controls.rebinding.is_some();
    let mut back = !listens && ui.input(|input| input.key_pressed(egui::Key::Escape));
    let (mut to_forces, mut to_licences) = (false, false);
    let area = page_rect(ui);
    ui.scope_builder(egui::UiBuilder::new().max_rect(area), |ui| {
        let response = header(ui, &theme, said.back, said.settings);
        super::play::focus_first(ui, &response);
        back |= response.clicked();
        page(ui, "settings", 820.0, |ui| {
            let options = [(false, said.off), (true, said.on)];
            card(ui, &theme, |ui| {
                ui.set_width(ui.available_width());
                choice(
                    ui,
                    &theme,
                    said.language,
                    &mut chosen.language,
                    &Language::ALL,
                );
            });
            section(ui, &theme, said.sound_section, |ui| {
                slider(ui, &theme, said.volume, &mut chosen.volume, 0.0, 1.0, 0.05);
                slider(
                    ui,
                    &theme,
                    said.effects,
                    &mut chosen.effects,
                    0.0,
                    1.0,
                    0.05,
                );
                slider(ui, &theme, said.music, &mut chosen.music, 0.0, 1.0, 0.05);
                slider(
                    ui,
                    &theme,
                    said.interface,
                    &mut chosen.interface,
                    0.0,
                    1.0,
                    0.05,
                );
            });
            section(ui, &theme, said.play_section, |ui| {
                slider(ui, &theme, said.speed, &mut chosen.speed, 0.5, 1.0, 0.05);
                slider(
                    ui,
                    &theme,
                    said.sensitivity,
                    &mut chosen.sensitivity,
                    0.3,
                    3.0,
                    0.1,
                );
                choice(
                    ui,
                    &theme,
                    said.stick_places,
                    &mut chosen.stick_places,
                    &options,
                );
                choice(ui, &theme, said.race_best, &mut chosen.race_best, &options);
                let strength = &mut chosen.haptics;
                slider(ui, &theme, said.haptics, strength, 0.0, 1.0, 0.05);
                let size = vec2(ui.available_width(), 44.0);
                to_forces = button(ui, &theme, said.try_forces, size, ButtonStyle::Other).clicked();
            });
            section(ui, &theme, said.hands_section, |ui| {
                let toggles = &mut chosen.toggle_keys;
                choice(ui, &theme, said.toggle_keys, toggles, &options);
                choice(ui, &theme, said.dwell, &mut chosen.dwell, &options);
                scanning(ui, &theme, said, &mut chosen.scanning);
            });
            section(ui, &theme, said.assists_section, |ui| {
                for assist in [Assist::WiderBasket, Assist::Unbreakable] {
                    let mut is_on = chosen.assists.contains(&assist);
                    choice(ui, &theme, (said.assist)(assist), &mut is_on, &options);
                    match is_on {
                        true => chosen.assists.insert(assist),
                        false => chosen.assists.remove(&assist),
                    };
                }
            });
            section(ui, &theme, said.look_section, |ui| {
                choice(
                    ui,
                    &theme,
                    said.full_screen,
                    &mut chosen.full_screen,
                    &options,
                );
                choice(
                    ui,
                    &theme,
                    said.reduced_motion,
                    &mut chosen.reduced_motion,
                    &options,
                );
                choice(
                    ui,
                    &theme,
                    said.colour_safe,
                    &mut chosen.colour_safe,
                    &options,
                );
                slider(
                    ui,
                    &theme,
                    said.text_size,
                    &mut chosen.text_size,
                    0.8,
                    1.6,
                    0.1,
                );
            });
            controls(ui, game, &mut chosen);
            if button(
                ui,
                &theme,
                said.reset,
                vec2(240.0, 48.0),
                ButtonStyle::Other,
            )
            .clicked()
            {
                let usual = Settings::default();
                chosen = Settings {
                    language: chosen.language,
                    // A reset never raises the force, and it keeps measured calibrations.
                    haptics: chosen.haptics.min(usual.haptics),
                    calibrations: std::mem::take(&mut chosen.calibrations),
                    // A player who needs these settings could not continue without them.
                    scanning: chosen.scanning,
                    toggle_keys: chosen.toggle_keys,
                    dwell: chosen.dwell,
                    ..usual
                };
            }
            ui.add_space(8.0);
            to_licences = button(
                ui,
                &theme,
                said.licences,
                vec2(240.0, 48.0),
                ButtonStyle::Other,
            )
            .clicked();
        });
    });
    if chosen != before {
        game.settings = chosen.in_range();
        game.keep_settings();
    }
    if to_forces {
        game.blip(Menu::Confirm);
        game.go(Screen::Forces);
    } else if to_licences {
        game.blip(Menu::Confirm);
        game.go(Screen::Licences);
    } else if back {
        game.blip(Menu::Back);
        game.go_back();
    }
}

/// Shows the choice of the scanning interval. Switching it off takes a second press: a player with a single
/// switch could not switch it on again.
fn scanning(ui: &mut Ui, theme: &Theme, said: &Words, chosen: &mut Scanning) {
    const OFF: &str = "scanning";
    let before = *chosen;
    let off = match is_pending(ui, OFF) {
        true => said.confirm,
        false => said.off,
    };
    let speeds = [
        (Scanning::Off, off),
        (Scanning::Slow, "2 s"),
        (Scanning::Medium, "1.2 s"),
        (Scanning::Quick, "0.7 s"),
    ];
    if choice(ui, theme, said.scanning, chosen, &speeds) && !chosen.is_on() {
        let is_asked_twice = is_pending(ui, OFF);
        if !is_asked_twice {
            *chosen = before;
        }
        set_pending(ui, (!is_asked_twice).then_some(OFF));
    }
}

fn section(ui: &mut Ui, theme: &Theme, name: &str, contents: impl FnOnce(&mut Ui)) {
    ui.add_space(10.0);
    card(ui, theme, |ui| {
        ui.set_width(ui.available_width());
        ui.label(RichText::new(name).size(26.0).color(theme.accent).strong());
        contents(ui);
    });
}

/// Shows the keys and buttons of all actions. A click on an action waits for a press that is bound to it.
fn controls(ui: &mut Ui, game: &mut Game, chosen: &mut Settings) {
    let (theme, said) = (game.theme(), game.words());
    section(ui, &theme, said.controls, |ui| {
        for action in Action::ALL {
            let [keys, buttons] = chosen.bindings.names(action, game.controls.labels());
            let listens = game.controls.rebinding == Some(action);
            let text = match listens {
                true => said.press_any.to_string(),
                false => format!("{}: {keys}  ·  {buttons}", (said.action)(action)),
            };
            let weight = if listens {
                ButtonStyle::Main
            } else {
                ButtonStyle::Other
            };
            let response = button(ui, &theme, &text, vec2(ui.available_width(), 44.0), weight);
            if listens {
                // While waiting, arrows, Tab and Escape are ordinary keys.
                response.request_focus();
                let all = egui::EventFilter {
                    tab: true,
                    horizontal_arrows: true,
                    vertical_arrows: true,
                    escape: true,
                };
                ui.memory_mut(|memory| memory.set_focus_lock_filter(response.id, all));
            } else if response.clicked() {
                game.controls.rebinding = Some(action);
            }
            ui.add_space(4.0);
        }
    });
}
