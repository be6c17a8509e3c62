//! Page on which a level is checked, kept and sent.

use super::super::widgets::{
    card, dim_background, finger, focus_first, header, page, page_rect, text_field,
};
use crate::game::{Game, MOST_NAME};
use app_shell::Theme;
use app_shell::widgets::{ButtonStyle, button, least_letters};
use egui::{Color32, Id, Key, RichText, Sense, Ui, UiBuilder, WidgetInfo, vec2};
use tamaire_maker::check::{Check, Finding};
use tamaire_sound::Menu;

/// Width of the page [points].
const WIDE: f32 = 700.0;
/// Width and height of the QR code [points].
const CODE: f32 = 560.0;

/// Id under which is stored whether the field of the name gets the focus.
fn naming_id() -> Id {
    Id::unique("the field of the name gets the focus")
}

/// Focuses the field of the name when the page is shown.
pub(in crate::screens) fn focus_name(ui: &Ui) {
    ui.data_mut(|data| data.insert_temp(naming_id(), true));
}

pub(in crate::screens) fn show(game: &mut Game, ui: &mut Ui) {
    dim_background(ui, 255);
    let (theme, said, words) = (game.theme(), game.words(), game.making());
    game.check_draft(ui.input(|input| input.stable_dt));
    let mut back = ui.input(|input| input.key_pressed(Key::Escape));
    let area = page_rect(ui);
    ui.scope_builder(UiBuilder::new().max_rect(area), |ui| {
        let response = header(ui, &theme, said.back, words.finish);
        focus_first(ui, &response);
        back |= response.clicked();
        page(ui, "finish", WIDE, |ui| {
            card(ui, &theme, |ui| {
                ui.set_width(ui.available_width());
                names(game, ui, &theme);
            });
            ui.add_space(12.0);
            card(ui, &theme, |ui| {
                ui.set_width(ui.available_width());
                checks(game, ui, &theme);
            });
            ui.add_space(12.0);
            card(ui, &theme, |ui| {
                ui.set_width(ui.available_width());
                deeds(game, ui, &theme);
            });
        });
    });
    if back {
        game.maker.typed_name = None;
        game.settle_preview();
        game.blip(Menu::Back);
        game.leave_finish();
    }
}

/// Shows the names of the level and of its maker.
fn names(game: &mut Game, ui: &mut Ui, theme: &Theme) {
    let words = game.making();
    let known = game.draft_name().to_string();
    let mut name = game.maker.typed_name.clone().unwrap_or(known);
    let before = name.clone();
    let field = text_field(ui, theme, words.name, &mut name, MOST_NAME);
    if ui.data_mut(|data| data.remove_temp(naming_id())) == Some(true) {
        field.request_focus();
    }
    if name != before {
        game.name_draft(&name);
        // Spaces at the end stay while the player types.
        game.maker.typed_name = Some(name);
    }
    let mut maker = game.settings.maker_name.clone();
    text_field(ui, theme, words.made_by, &mut maker, MOST_NAME);
    if maker != game.settings.maker_name {
        game.settings.maker_name = maker;
        game.keep_settings();
    }
}

/// Shows what bots found out about the level, and whether its maker has won it.
fn checks(game: &mut Game, ui: &mut Ui, theme: &Theme) {
    let (said, words) = (game.words(), game.making());
    let line = |ui: &mut Ui, sign: &str, text: &str, ink: Color32| {
        let size = least_letters(ui.ctx()).max(21.0);
        let text = RichText::new(format!("{sign}  {text}"));
        ui.label(text.size(size).color(ink));
    };
    let won = game.win_of_maker();
    if let Some(problem) = game.draft_problem() {
        line(ui, "×", &problem, theme.accent);
        return;
    }
    let Some(check) = &game.maker.check else {
        return;
    };
    let told = |finding: Finding, name: &str| match finding {
        Finding::Open => Some(("…", name.to_string(), theme.faint)),
        Finding::Yes(None) => Some(("✓", name.to_string(), theme.good)),
        Finding::Yes(Some(seconds)) => {
            let time = (said.seconds)(seconds);
            Some(("✓", format!("{name}  {time}"), theme.good))
        }
        Finding::NotFound | Finding::NotAsked => None,
    };
    let findings = check.findings();
    if findings.has_short_rope {
        line(ui, "!", words.short_rope, theme.accent);
    }
    if check.level().has_basket() {
        let wins_by_itself = matches!(findings.by_itself, Finding::Yes(_));
        if wins_by_itself {
            line(ui, "!", words.wins_by_itself, theme.accent);
        }
        let squeezed = match (findings.squeezed, won) {
            // What the maker has done can be done.
            (Finding::NotFound, Some(won)) if won.is_whole => Finding::Yes(None),
            (finding, _) => finding,
        };
        let ways = words.can_be.into_iter().zip(words.not_found);
        for (finding, (name, not_found)) in [squeezed, findings.shaved].into_iter().zip(ways) {
            if finding == Finding::NotFound {
                line(ui, "–", not_found, theme.ink);
            } else if let Some((sign, text, ink)) = told(finding, name) {
                line(ui, sign, &text, ink);
            }
        }
        match won {
            Some(won) => {
                let time = (said.seconds)(won.seconds);
                line(
                    ui,
                    "✓",
                    &format!("{}  {time}", words.won_by_maker),
                    theme.good,
                );
            }
            None => line(ui, "–", words.not_won_by_maker, theme.ink),
        }
        if matches!(findings.straight, Finding::Yes(_)) && !wins_by_itself {
            line(ui, "•", words.straight_wins, theme.ink);
        }
    }
    if !check.level().has_basket() {
        line(ui, "–", words.is_playground, theme.ink);
    }
    let speed = match findings.real_time {
        Finding::NotFound => Some(("•", words.not_real_time.to_string(), theme.ink)),
        finding => told(finding, words.real_time),
    };
    if let Some((sign, text, ink)) = speed {
        line(ui, sign, &text, ink);
    }
    progress(ui, theme, check);
}

/// Shows how far the checks are. Its room stays empty when they are finished, so that no button moves.
fn progress(ui: &mut Ui, theme: &Theme, check: &Check) {
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), 14.0), Sense::hover());
    if check.is_done() {
        return;
    }
    let share = check.progress();
    response.widget_info(|| {
        let percent = format!("{:.0} %", 100.0 * share);
        WidgetInfo::labeled(egui::Role::ProgressIndicator, true, percent)
    });
    ui.painter().rect_filled(rect, 7.0, theme.button);
    let done = rect.with_max_x(rect.left() + share * rect.width());
    ui.painter().rect_filled(done, 7.0, theme.good);
    ui.ctx().request_repaint();
}

/// Shows a button of the page. Returns whether it is pressed.
fn press(ui: &mut Ui, theme: &Theme, text: &str, is_main: bool) -> bool {
    let size = vec2(ui.available_width().min(400.0), finger(ui).max(48.0));
    button(ui, theme, text, size, ButtonStyle::of(is_main)).clicked()
}

/// Shows the buttons that keep and send the level.
fn deeds(game: &mut Game, ui: &mut Ui, theme: &Theme) {
    let (said, words) = (game.words(), game.making());
    if press(ui, theme, words.keep, true) {
        game.blip(Menu::Confirm);
        game.keep_draft();
    }
    ui.add_space(8.0);
    if press(ui, theme, said.link, false) {
        game.blip(Menu::Confirm);
        game.copy_link_to_draft();
    }
    ui.add_space(8.0);
    if press(ui, theme, words.save_file, false) {
        game.blip(Menu::Confirm);
        game.save_draft_file();
    }
    ui.add_space(8.0);
    if !game.has_page() {
        return;
    }
    if press(ui, theme, words.code, false) {
        game.blip(Menu::Confirm);
        game.maker.shows_code ^= true;
    }
    if game.maker.shows_code {
        code(game, ui, theme);
    }
}

/// Shows the QR code of the link, or why there is none.
fn code(game: &mut Game, ui: &mut Ui, theme: &Theme) {
    match game.code_of_draft() {
        Some(found) => {
            let most = CODE.min(ui.available_width());
            super::super::code::draw(ui, &found, most);
        }
        None => {
            let text = RichText::new(game.making().too_long_for_code);
            ui.label(text.size(19.0).color(theme.ink));
        }
    }
}
