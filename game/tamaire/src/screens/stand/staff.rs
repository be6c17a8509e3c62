//! Staff pages: figures of the day, health of the stand, and its settings.

use super::super::forces;
use super::super::widgets::{
    card, choice, dim_background, focus_first, header, page, page_rect, row, slider,
};
use crate::exhibit::config::ConfigChange;
use crate::exhibit::staff::StaffPage;
use crate::exhibit::{Phase, Stand};
use crate::game::{Game, Screen};
use crate::platform::memory;
use crate::words::{Language, StandWords};
use app_shell::Theme;
use app_shell::widgets::{ButtonStyle, button, fitted};
use egui::{RichText, Sense, Ui, vec2};
use jiff::ToSpan;
use jiff::civil::Time;
use tamaire_play::level::built_in;
use tamaire_sound::Menu;

/// Width of a page [points].
const WIDE: f32 = 780.0;
/// Height of a line [points].
const LINE: f32 = 34.0;
/// Gap between cards [points].
const GAP: f32 = 12.0;
/// Opening hours that are suggested when none are set.
const USUAL_HOURS: [Time; 2] = [Time::constant(10, 0, 0, 0), Time::constant(18, 0, 0, 0)];

/// Action that staff has chosen.
enum StaffAction {
    Leave,
    See(StaffPage),
    Change(ConfigChange),
    TryStick,
    Export,
    End,
}

pub(super) fn show(stand: &mut Stand, game: &mut Game, shown: StaffPage, ui: &mut Ui) {
    if game.screen() == Screen::Forces {
        forces::show(game, ui);
        let strength = game.settings.haptics;
        if game.screen() != Screen::Forces && strength != stand.config.force.strength.0 {
            stand.change(game, &ConfigChange::Strength(strength));
        }
        return;
    }
    dim_background(ui, 255);
    let (theme, said) = (game.theme(), game.settings.language.at_stand());
    let mut wish = None;
    if ui.input(|input| input.key_pressed(egui::Key::Escape)) {
        wish = Some(StaffAction::Leave);
    }
    let area = page_rect(ui);
    ui.scope_builder(egui::UiBuilder::new().max_rect(area), |ui| {
        let back = header(ui, &theme, game.words().back, &stand.config.stand.0);
        focus_first(ui, &back);
        if back.clicked() {
            wish = Some(StaffAction::Leave);
        }
        page(ui, "staff", WIDE, |ui| {
            let deed = match shown {
                StaffPage::Today => Some((said.export, StaffAction::Export)),
                StaffPage::Health => Some((said.try_stick, StaffAction::TryStick)),
                StaffPage::Settings => Some((said.end, StaffAction::See(StaffPage::End))),
                // The button that confirms the end is elsewhere, so that a double press ends nothing.
                StaffPage::End => None,
            };
            // Width of a page button. The button for the action of the current page is one and a half times
            // as wide.
            let width = (ui.available_width() - 5.0 * GAP) / 4.5;
            ui.horizontal(|ui| {
                ui.spacing_mut().item_spacing.x = GAP;
                for (seen, name) in StaffPage::ALL.into_iter().zip(said.pages) {
                    let weight = ButtonStyle::of(seen == shown);
                    if button(ui, &theme, name, vec2(width, 48.0), weight).clicked() {
                        wish = Some(StaffAction::See(seen));
                    }
                }
                ui.add_space(GAP);
                let size = vec2(1.5 * width, 48.0);
                if let Some((does, deed)) = deed
                    && button(ui, &theme, does, size, ButtonStyle::Other).clicked()
                {
                    wish = Some(deed);
                }
            });
            ui.add_space(GAP);
            if let Some(answer) = &stand.answer {
                ui.label(RichText::new(answer).size(19.0).color(theme.ink));
                ui.add_space(GAP);
            }
            card(ui, &theme, |ui| {
                ui.set_width(ui.available_width());
                match shown {
                    StaffPage::Today => today(stand, game, ui),
                    StaffPage::Health => health(stand, game, ui),
                    StaffPage::Settings => {
                        if let Some(change) = settings(stand, game, ui) {
                            wish = Some(StaffAction::Change(change));
                        }
                    }
                    StaffPage::End => {
                        if let Some(chosen) = confirm_end(ui, &theme, said) {
                            wish = Some(chosen);
                        }
                    }
                }
            });
        });
    });
    match stand.memory.take_exported() {
        Some(Ok(path)) => stand.answer = Some((said.exported)(&path)),
        Some(Err(error)) => stand.answer = Some(error),
        None => {}
    }
    let Some(wish) = wish else {
        return;
    };
    game.blip(Menu::Confirm);
    match wish {
        StaffAction::Leave => stand.end_and_reset(game),
        StaffAction::See(page) => stand.phase = Phase::Staff(page),
        StaffAction::Change(change) => stand.change(game, &change),
        StaffAction::TryStick => {
            game.go(Screen::Settings);
            game.go(Screen::Forces);
        }
        StaffAction::Export => stand.memory.export(),
        StaffAction::End => stand.is_ended = true,
    }
}

/// Asks whether the stand shall end; returns the answer.
fn confirm_end(ui: &mut Ui, theme: &Theme, said: &StandWords) -> Option<StaffAction> {
    ui.label(RichText::new(said.ends).size(21.0).color(theme.ink));
    ui.add_space(2.0 * GAP);
    let size = vec2(260.0, 52.0);
    let mut answer = None;
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing = vec2(2.0 * GAP, GAP);
        if button(ui, theme, said.keep_open, size, ButtonStyle::Main).clicked() {
            answer = Some(StaffAction::See(StaffPage::Settings));
        }
        if button(ui, theme, said.end_now, size, ButtonStyle::Other).clicked() {
            answer = Some(StaffAction::End);
        }
    });
    answer
}

/// Shows a name and its value.
fn show_value(ui: &mut Ui, theme: &Theme, name: &str, value: &str) {
    let (rect, _) = ui.allocate_exact_size(vec2(ui.available_width(), LINE), Sense::hover());
    let half = 0.5 * rect.width() - 8.0;
    let left = fitted(ui.painter(), name, 20.0, half, theme.faint);
    let right = fitted(ui.painter(), value, 23.0, half, theme.ink);
    let painter = ui.painter();
    painter.galley(
        rect.left_center() - vec2(0.0, 0.5 * left.size().y),
        left,
        theme.faint,
    );
    let at = rect.right_center() - vec2(right.size().x, 0.5 * right.size().y);
    painter.galley(at, right, theme.ink);
}

fn today(stand: &Stand, game: &Game, ui: &mut Ui) {
    let (theme, said) = (game.theme(), game.settings.language.at_stand());
    let day = stand.memory.today();
    let share = |count: u64| match day.rounds {
        0 => count.to_string(),
        rounds => format!("{count}  ({:.0} %)", 100.0 * count as f64 / rounds as f64),
    };
    let first = day.median_to_first_win;
    let values = [
        day.visits.to_string(),
        day.rounds.to_string(),
        share(day.wins),
        share(day.squeezed),
        share(day.shaved),
        share(day.mixed),
        share(day.retries),
        first.map_or(said.unknown.into(), said.seconds),
    ];
    for (name, value) in said.figures.into_iter().zip(values) {
        show_value(ui, &theme, name, &value);
    }
}

fn health(stand: &Stand, game: &Game, ui: &mut Ui) {
    let (theme, said) = (game.theme(), game.settings.language.at_stand());
    let logbook = stand.memory.health();
    let frame = |percent| {
        stand
            .frames
            .percentile(percent)
            .map(|seconds| format!("{:.1} ms", 1000.0 * seconds))
    };
    let devices = &game.controls.devices.sticks.devices;
    let names: Vec<&str> = devices
        .iter()
        .map(|device| device.about.name.as_str())
        .collect();
    let recording = match (&logbook.problem, logbook.dropped) {
        (Some(trouble), _) => trouble.clone(),
        (None, 0) => said.recording.into(),
        (None, dropped) => format!("{} (-{dropped})", said.recording),
    };
    let unknown = || said.unknown.to_string();
    let forces = match game.forces.is_cut() {
        true => game.words().forces_cut.into(),
        false => format!("{:.0} %", 100.0 * game.settings.haptics),
    };
    let sound = match game.is_mute() || game.settings.volume == 0.0 {
        true => said.off.into(),
        false => game.sound_trouble().unwrap_or_else(|| "✓".into()),
    };
    let values = [
        frame(50).unwrap_or_else(unknown),
        frame(99).unwrap_or_else(unknown),
        memory().map_or_else(unknown, said.bytes),
        stand.memory.room().map_or_else(unknown, said.bytes),
        if names.is_empty() {
            "-".into()
        } else {
            names.join(", ")
        },
        forces,
        sound,
        recording,
        (said.bytes)(logbook.bytes),
        logbook.unsent.to_string(),
    ];
    for (name, value) in said.health.into_iter().zip(values) {
        show_value(ui, &theme, name, &value);
    }
}

/// Shows the settings of the stand; returns the change to make.
fn settings(stand: &Stand, game: &mut Game, ui: &mut Ui) -> Option<ConfigChange> {
    let (theme, words) = (game.theme(), game.words());
    let said = game.settings.language.at_stand();
    let mut change = None;
    let config = &stand.config;
    let mut language = config.language;
    if choice(ui, &theme, words.language, &mut language, &Language::ALL) {
        change = Some(ConfigChange::Language(language));
    }
    let kinds = [
        (
            words.volume,
            config.sound.volume.0,
            ConfigChange::Volume as fn(f32) -> ConfigChange,
        ),
        (
            words.haptics,
            config.force.strength.0,
            ConfigChange::Strength,
        ),
    ];
    for (name, value, kind) in kinds {
        let mut chosen = value;
        slider(ui, &theme, name, &mut chosen, 0.0, 1.0, 0.05);
        // A dragged value is stored when the drag ends, not in every frame.
        let rests = ui.input(|input| !input.pointer.any_down());
        let id = ui.scope_id().with(name);
        let dragged = ui.data_mut(|data| data.get_temp::<f32>(id));
        match (chosen != value, rests) {
            (true, true) => change = Some(kind(chosen)),
            (true, false) => {
                ui.data_mut(|data| data.insert_temp(id, chosen));
            }
            (false, true) => {
                if let Some(dragged) = dragged.filter(|&dragged| dragged != value) {
                    change = Some(kind(dragged));
                }
                ui.data_mut(|data| data.remove::<f32>(id));
            }
            (false, false) => {}
        }
    }
    if let Some(hours) = hours(stand, game, ui) {
        change = Some(ConfigChange::Hours(hours));
    }
    row(ui, &theme, said.levels, |_| ());
    levels(stand, game, ui).or(change)
}

/// Shows the opening hours; returns a changed value.
fn hours(stand: &Stand, game: &Game, ui: &mut Ui) -> Option<Option<(Time, Time)>> {
    let (theme, said) = (game.theme(), game.settings.language.at_stand());
    let known = stand
        .config
        .hours
        .map(|hours| (hours.open.0, hours.close.0));
    let mut chosen = None;
    row(ui, &theme, said.hours, |ui| {
        let Some((open, close)) = known else {
            let [open, close] = USUAL_HOURS;
            let size = vec2(200.0, 44.0);
            let text = (said.from_to)(open, close);
            ui.label(RichText::new(said.always).size(21.0).color(theme.ink));
            if button(ui, &theme, &text, size, ButtonStyle::Other).clicked() {
                chosen = Some(Some((open, close)));
            }
            return;
        };
        for (is_open, time) in [(true, open), (false, close)] {
            for (sign, by) in [("-", -30.minutes()), ("+", 30.minutes())] {
                if button(ui, &theme, sign, vec2(44.0, 44.0), ButtonStyle::Other).clicked() {
                    chosen = Some(Some(match is_open {
                        true => (open.wrapping_add(by), close),
                        false => (open, close.wrapping_add(by)),
                    }));
                }
                if sign == "-" {
                    let text = RichText::new(time.strftime("%H:%M").to_string());
                    ui.label(text.size(21.0).color(theme.ink));
                }
            }
        }
        let size = vec2(104.0, 44.0);
        if button(ui, &theme, said.always, size, ButtonStyle::Other).clicked() {
            chosen = Some(None);
        }
    });
    chosen
}

/// Shows the levels of the stand. A press adds or removes a level.
fn levels(stand: &Stand, game: &Game, ui: &mut Ui) -> Option<ConfigChange> {
    let theme = game.theme();
    // A chosen level replaces chapters.
    let has_levels = stand.config.chapters.0.is_empty();
    let chosen: Vec<&str> = { stand.config.levels.0.iter() }
        .filter(|_| has_levels)
        .map(|level| level.id.as_str())
        .collect();
    let mut changed = None;
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing = vec2(8.0, 8.0);
        let known = { stand.known.iter() }.filter(|level| level.has_basket());
        for level in known.filter(|level| built_in().any(|(id, _)| id == level.id)) {
            let (id, name) = (
                level.id.as_str(),
                game.settings.language.of(&level.game().name),
            );
            let is_in = chosen.contains(&id);
            let text = if is_in {
                format!("● {name}")
            } else {
                name.to_string()
            };
            let weight = ButtonStyle::of(is_in);
            if button(ui, &theme, &text, vec2(176.0, 42.0), weight).clicked() {
                let others = chosen.iter().filter(|&&known| known != id);
                let added = (!is_in).then_some(&id);
                changed = Some(others.chain(added).map(|id| id.to_string()).collect());
            }
        }
    });
    changed.map(ConfigChange::Levels)
}
