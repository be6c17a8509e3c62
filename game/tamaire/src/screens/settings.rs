//! Settings of the player.

use super::confirmation::{is_asked, is_pending, set_pending};
use super::widgets::{card, choice, dim_background, header, page, page_rect, slider};
use crate::game::{Game, Screen};
use crate::input::{Action, Scanning};
use crate::settings::{Quality, Settings};
use crate::words::{Language, Words};
use app_shell::Theme;
use app_shell::widgets::{ButtonStyle, button};
use egui::{Id, Response, RichText, Ui, vec2};
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
        super::widgets::focus_first(ui, &response);
        back |= response.clicked();
        page(ui, "settings", 820.0, |ui| {
            to_forces = sections(ui, &theme, said, &mut chosen);
            controls(ui, game, &mut chosen);
            let size = vec2(300.0, 48.0);
            ui.add_space(10.0);
            if is_reset_confirmed(ui, &theme, said) {
                chosen = reset(std::mem::take(&mut chosen));
            }
            ui.add_space(8.0);
            to_licences = button(ui, &theme, said.licences, size, ButtonStyle::Other).clicked();
        });
    });
    if chosen != before {
        game.settings = chosen.in_range();
        game.keep_settings();
    }
    if to_forces || to_licences || back {
        // A question that was left unanswered is not asked again on the next visit.
        set_pending(ui, None);
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

/// Shows all settings except keys and buttons. Returns whether the player wants to test sticks and pads.
fn sections(ui: &mut Ui, theme: &Theme, said: &Words, chosen: &mut Settings) -> bool {
    let mut to_forces = false;
    let options = [(false, said.off), (true, said.on)];
    let switch = |ui: &mut Ui, name: &str, is_on: &mut bool| {
        choice(ui, theme, name, is_on, &options);
    };
    let share = |ui: &mut Ui, name: &str, value: &mut f32| {
        slider(ui, theme, name, value, 0.0, 1.0, 0.05);
    };
    card(ui, theme, |ui| {
        ui.set_width(ui.available_width());
        let language = &mut chosen.language;
        choice(ui, theme, said.language, language, &Language::ALL);
    });
    section(ui, theme, said.sound_section, |ui| {
        share(ui, said.volume, &mut chosen.volume);
        share(ui, said.effects, &mut chosen.effects);
        share(ui, said.music, &mut chosen.music);
        share(ui, said.interface, &mut chosen.interface);
    });
    section(ui, theme, said.play_section, |ui| {
        slider(ui, theme, said.speed, &mut chosen.speed, 0.5, 1.0, 0.05);
        let sensitivity = &mut chosen.sensitivity;
        slider(ui, theme, said.sensitivity, sensitivity, 0.3, 3.0, 0.1);
        switch(ui, said.stick_places, &mut chosen.stick_places);
        switch(ui, said.race_best, &mut chosen.race_best);
        switch(ui, said.open_all, &mut chosen.open_all);
        share(ui, said.haptics, &mut chosen.haptics);
        let size = vec2(ui.available_width(), 44.0);
        to_forces = button(ui, theme, said.try_forces, size, ButtonStyle::Other).clicked();
    });
    section(ui, theme, said.hands_section, |ui| {
        switch(ui, said.toggle_keys, &mut chosen.toggle_keys);
        switch(ui, said.dwell, &mut chosen.dwell);
        scanning(ui, theme, said, &mut chosen.scanning);
    });
    section(ui, theme, said.assists_section, |ui| {
        switch(ui, said.calm, &mut chosen.calm);
        for assist in [Assist::WiderBasket, Assist::Unbreakable] {
            let mut is_on = chosen.assists.contains(&assist);
            switch(ui, (said.assist)(assist), &mut is_on);
            match is_on {
                true => chosen.assists.insert(assist),
                false => chosen.assists.remove(&assist),
            };
        }
    });
    section(ui, theme, said.look_section, |ui| {
        switch(ui, said.full_screen, &mut chosen.full_screen);
        switch(ui, said.reduced_motion, &mut chosen.reduced_motion);
        switch(ui, said.colour_safe, &mut chosen.colour_safe);
        let names = Quality::ALL.map(|quality| (quality, (said.quality_name)(quality)));
        choice(ui, theme, said.quality, &mut chosen.quality, &names);
        let text_size = &mut chosen.text_size;
        slider(ui, theme, said.text_size, text_size, 0.8, 1.6, 0.1);
    });
    to_forces
}

/// Returns the default settings, except for those that a reset keeps.
fn reset(chosen: Settings) -> Settings {
    let usual = Settings::default();
    Settings {
        language: chosen.language,
        // A reset never raises the force, and it keeps measured calibrations.
        haptics: chosen.haptics.min(usual.haptics),
        calibrations: chosen.calibrations,
        // A player who needs scanning could not operate the game without it.
        scanning: chosen.scanning,
        toggle_keys: chosen.toggle_keys,
        dwell: chosen.dwell,
        ..usual
    }
}

/// Shows the choice of the scanning interval. A second press confirms that scanning is switched off, because
/// a player with a single switch could not switch it on again.
fn scanning(ui: &mut Ui, theme: &Theme, said: &Words, chosen: &mut Scanning) {
    const OFF: &str = "scanning";
    let before = *chosen;
    let off = match is_pending(ui, OFF) {
        true => said.confirm,
        false => said.off,
    };
    let steps = [Scanning::Slow, Scanning::Medium, Scanning::Quick]
        .map(|speed| (speed, (said.seconds)(speed.step().unwrap_or_default())));
    let mut speeds = vec![(Scanning::Off, off)];
    speeds.extend(steps.iter().map(|(speed, text)| (*speed, text.as_str())));
    if choice(ui, theme, said.scanning, chosen, &speeds) && !chosen.is_on() {
        let is_asked_twice = is_pending(ui, OFF);
        if !is_asked_twice {
            *chosen = before;
        }
        set_pending(ui, (!is_asked_twice).then_some(OFF));
    }
}

/// Shows the button that restores the default settings. A press asks, with the answer "no" in the place of the
/// button. The question waits until it is answered. Returns whether the player has confirmed.
fn is_reset_confirmed(ui: &mut Ui, theme: &Theme, said: &Words) -> bool {
    const RESET: &str = "reset";
    let size = vec2(300.0, 48.0);
    if !is_asked(ui, RESET) {
        let response = button(ui, theme, said.reset, size, ButtonStyle::Other);
        take_focus(ui, &response);
        if response.clicked() {
            set_pending(ui, Some(RESET));
            pass_focus(ui);
        }
        return false;
    }
    let question = RichText::new(said.reset_question);
    ui.label(question.size(21.0).color(theme.ink));
    let mut is_confirmed = false;
    ui.horizontal_wrapped(|ui| {
        let cancel = button(ui, theme, said.cancel, size, ButtonStyle::Main);
        take_focus(ui, &cancel);
        is_confirmed = button(ui, theme, said.reset_now, size, ButtonStyle::Other).clicked();
        if cancel.clicked() || is_confirmed {
            set_pending(ui, None);
            pass_focus(ui);
        }
    });
    is_confirmed
}

/// Lets the next widget that calls [`take_focus`] take the focus. The pressed button is replaced by others, so the
/// focus would be lost.
fn pass_focus(ui: &Ui) {
    ui.data_mut(|data| data.insert_temp(passed_focus(), true));
}

fn take_focus(ui: &Ui, response: &Response) {
    let is_passed = ui.data_mut(|data| data.remove_temp::<bool>(passed_focus()));
    if is_passed == Some(true) {
        response.request_focus();
    }
}

fn passed_focus() -> Id {
    Id::unique("focus of the reset question")
}

fn section(ui: &mut Ui, theme: &Theme, name: &str, contents: impl FnOnce(&mut Ui)) {
    ui.add_space(10.0);
    card(ui, theme, |ui| {
        ui.set_width(ui.available_width());
        ui.label(RichText::new(name).size(26.0).color(theme.accent).strong());
        contents(ui);
    });
}

/// Shows the keys and buttons of all actions. After a click on an action, the next key or button pressed is
/// bound to it.
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
            let weight = ButtonStyle::of(listens);
            let response = button(ui, &theme, &text, vec2(ui.available_width(), 44.0), weight);
            if listens {
                // While the game waits for a key, arrows, Tab and Escape can be bound, too, and do not
                // navigate.
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
