//! List of saved rounds.

use super::confirmation::{is_pending, set_pending};
use super::icons;
use super::widgets::{card, dim_background, header_to_open, page, page_rect};
use crate::game::{Game, RoundDetails, SavedRound};
use crate::look::{Maps, Stage};
use crate::platform::{Entry, local_date};
use app_shell::widgets::{ButtonStyle, button, fitted};
use egui::{Rect, Response, RichText, Role, Sense, Stroke, StrokeKind, Ui, Vec2, WidgetInfo, vec2};
use tamaire_sound::Menu;

/// Size of a button [points].
const BUTTON: Vec2 = vec2(118.0, 44.0);
/// Size of a thumbnail [points].
const PICTURE: Vec2 = vec2(111.0, 74.0);
/// Number of buttons in a row.
const COLUMNS: usize = 3;
/// Minimum width of the text beside the buttons [points].
const LEAST_TEXT: f32 = 200.0;
/// Gap between thumbnail, text and buttons of a row [points].
const GAP: f32 = 10.0;

/// Action that the player has chosen for a replay.
#[derive(Copy, Clone)]
enum ReplayAction {
    Watch,
    Race,
    Clip,
    Link,
    Download,
    Delete,
}

pub(super) fn show(game: &mut Game, stage: &mut Stage, ui: &mut Ui) {
    dim_background(ui, 255);
    let (theme, said) = (game.theme(), game.words());
    let maps = stage.maps(&game.pictured(), &theme);
    let mut wanted: Option<(Entry, ReplayAction)> = None;
    let mut back = ui.input(|input| input.key_pressed(egui::Key::Escape));
    let area = page_rect(ui);
    ui.scope_builder(egui::UiBuilder::new().max_rect(area), |ui| {
        let response = header_to_open(ui, game, said.replays);
        super::widgets::focus_first(ui, &response);
        back |= response.clicked();
        page(ui, "replays", 960.0, |ui| {
            if game.shelf.is_empty() {
                ui.vertical_centered(|ui| {
                    ui.add_space(60.0);
                    ui.label(RichText::new(said.no_replays).size(22.0).color(theme.faint));
                });
            }
            for kept in game.shelf.iter() {
                card(ui, &theme, |ui| {
                    ui.spacing_mut().item_spacing = vec2(GAP, GAP);
                    if let Some(wish) = show_one(ui, game, maps, kept) {
                        wanted = Some((kept.entry.clone(), wish));
                    }
                });
                ui.add_space(8.0);
            }
        });
    });
    if back {
        game.blip(Menu::Back);
        game.go_back();
    } else if let Some((entry, wish)) = wanted {
        game.blip(Menu::Confirm);
        let name = &entry.name;
        match wish {
            ReplayAction::Watch => game.open_kept(name, Game::watch),
            ReplayAction::Race => game.open_kept(name, Game::race),
            ReplayAction::Clip => game.open_kept(name, Game::keep_clip_of),
            ReplayAction::Link => game.open_kept(name, Game::copy_link_of),
            ReplayAction::Download => game.hand_out(&entry),
            ReplayAction::Delete if is_pending(ui, name) => game.delete(&entry),
            ReplayAction::Delete => {}
        }
        set_pending(ui, matches!(wish, ReplayAction::Delete).then_some(name));
    }
}

/// Shows a replay with its buttons, which go below the text in a narrow window.
fn show_one(ui: &mut Ui, game: &Game, maps: &Maps, kept: &SavedRound) -> Option<ReplayAction> {
    let all = ui.available_width();
    let beside = COLUMNS as f32 * (BUTTON.x + GAP);
    let is_wide = all >= PICTURE.x + 2.0 * GAP + LEAST_TEXT + beside;
    let text = all - PICTURE.x - GAP - if is_wide { beside } else { 0.0 };
    let mut wanted = None;
    ui.horizontal(|ui| {
        picture(ui, game, maps, kept, text);
        if is_wide {
            ui.vertical(|ui| wanted = buttons(ui, game, kept));
        }
    });
    if !is_wide {
        wanted = buttons(ui, game, kept);
    }
    wanted
}

/// Shows the thumbnail of the level, and beside it a text of width `text`.
fn picture(ui: &mut Ui, game: &Game, maps: &Maps, kept: &SavedRound, text: f32) {
    let theme = game.theme();
    let found = kept.found.as_ref().and_then(Option::as_ref);
    let (rect, _) = ui.allocate_exact_size(PICTURE, Sense::hover());
    ui.painter().rect_filled(rect, 12.0, theme.paper);
    if let Some(found) = found {
        maps.draw(ui.painter(), rect, &found.level);
    }
    let frame = Stroke::new(4.0, theme.card);
    ui.painter()
        .rect_stroke(rect.expand(2.0), 13.0, frame, StrokeKind::Middle);
    let (rect, response) = ui.allocate_exact_size(vec2(text, PICTURE.y), Sense::hover());
    tell(ui, game, kept, found, rect, &response);
}

/// Shows the buttons of a replay in rows.
fn buttons(ui: &mut Ui, game: &Game, kept: &SavedRound) -> Option<ReplayAction> {
    let (theme, said) = (game.theme(), game.words());
    let delete = match is_pending(ui, &kept.entry.name) {
        true => said.confirm,
        false => said.delete,
    };
    let all = [
        (said.watch, ReplayAction::Watch),
        (said.race, ReplayAction::Race),
        (delete, ReplayAction::Delete),
        (said.link, ReplayAction::Link),
        (said.clip, ReplayAction::Clip),
        (said.download, ReplayAction::Download),
    ];
    let is_here =
        |wish: &ReplayAction| !matches!(wish, ReplayAction::Download) || game.files.hands_out();
    let here: Vec<_> = all.into_iter().filter(|(_, wish)| is_here(wish)).collect();
    let mut wanted = None;
    for row in here.chunks(COLUMNS) {
        ui.horizontal(|ui| {
            for &(text, wish) in row {
                if button(ui, &theme, text, BUTTON, ButtonStyle::Other).clicked() {
                    wanted = Some(wish);
                }
            }
        });
    }
    wanted
}

/// Draws level, date, and result of a round.
fn tell(
    ui: &Ui,
    game: &Game,
    kept: &SavedRound,
    found: Option<&RoundDetails>,
    rect: Rect,
    response: &Response,
) {
    let (theme, said, painter) = (game.theme(), game.words(), ui.painter());
    let name = name_of(game, kept, found);
    let date = local_date(kept.entry.written);
    let (route, end) = match found {
        Some(found) => {
            let help = match found.level.game().assists.is_empty() {
                true => String::new(),
                false => format!(", {}", said.assisted),
            };
            let seconds = format!("{}{help}", (said.seconds)(found.seconds));
            match found.outcome {
                Some(outcome) => (
                    Some(outcome.route),
                    format!("{} {seconds}", (said.route)(outcome.route)),
                ),
                None => (None, seconds),
            }
        }
        None => (None, String::new()),
    };
    response
        .widget_info(|| WidgetInfo::labeled(Role::Label, true, format!("{name}, {date}, {end}")));
    let mut top = rect.top();
    for (text, size, ink) in [(&name, 22.0, theme.ink), (&date, 17.0, theme.faint)] {
        let galley = fitted(painter, text, size, rect.width(), ink);
        painter.galley(egui::pos2(rect.left(), top), galley, ink);
        top += size + 4.0;
    }
    let mut left = rect.left();
    if let Some(route) = route {
        let at = egui::pos2(left + 14.0, top + 11.0);
        icons::route(painter, &theme, at, 9.0, route, true);
        left += 32.0;
    }
    let galley = fitted(painter, &end, 17.0, rect.right() - left, theme.faint);
    painter.galley(egui::pos2(left, top), galley, theme.faint);
}

/// Returns the level's name with the number of the replay, or the file name if the level is unknown.
fn name_of(game: &Game, kept: &SavedRound, found: Option<&RoundDetails>) -> String {
    let name = &kept.entry.name;
    let Some((id, number)) = name.rsplit_once('-') else {
        return name.clone();
    };
    let known = game.levels.iter().find(|level| level.id == id);
    let level = found.map(|found| &found.level).or(known);
    level.map_or_else(
        || name.clone(),
        |level| {
            let name = game.settings.language.of(&level.game().name);
            format!("{name} {number}")
        },
    )
}
