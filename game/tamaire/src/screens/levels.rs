//! Screen for choosing a level.

use super::buttons::pale;
use super::editor::focus_name;
use super::icons;
use super::widgets::{dim_background, finger, header_to_open, page, page_rect, words};
use crate::game::{Game, ListEntry};
use crate::journey::{Journey, Lock, Section, Stars, stars_of};
use crate::look::{Maps, Stage};
use crate::records::Record;
use crate::words::{Language, Words};
use app_shell::Theme;
use app_shell::widgets::{
    ButtonStyle, LETTERS, button, fitted, focus_ring, highlight, is_on, least_letters, plain_button,
};
use egui::{
    Color32, FontId, Painter, Rect, RectAlign, Response, RichText, Role, Sense, Stroke, Tooltip,
    Ui, Vec2, WidgetInfo, pos2, vec2,
};
use std::collections::BTreeMap;
use tamaire_play::level::CHAPTERS;
use tamaire_play::{Level, Route};
use tamaire_sound::Menu;

/// Gap between tiles [points].
const GAP: f32 = 20.0;
/// Gap below a tile and the buttons of an own level [points].
const OWN_GAP: f32 = 10.0;
/// Approximate width of a tile [points].
const WIDE: f32 = 236.0;
/// Height of a tile below its thumbnail [points].
pub(super) const BELOW: f32 = 92.0;

/// Action that the player has chosen for a level.
enum LevelAction {
    Play(usize),
    TakeOut(usize),
    Change(usize),
    Rename(usize),
    Copy(usize),
    New(u8),
    BringBack,
    BringBackRemoved(usize),
    GoOn,
    SavePack,
    TellLock(Lock),
    ShowEnding,
}

pub(super) fn show(game: &mut Game, stage: &mut Stage, ui: &mut Ui) {
    dim_background(ui, 255);
    let (theme, said) = (game.theme(), game.words());
    let maps = stage.maps(&game.pictured(), &theme);
    let mut wanted = None;
    let area = page_rect(ui);
    let mut back = ui.input(|input| input.key_pressed(egui::Key::Escape));
    ui.scope_builder(egui::UiBuilder::new().max_rect(area), |ui| {
        let Stars { earned, all } = game.journey().stars();
        let title = format!("{}  {}", said.levels, (said.stars)(earned, all));
        let response = header_to_open(ui, game, &title);
        back |= response.clicked();
        page(ui, "levels", f32::INFINITY, |ui| {
            ui.spacing_mut().item_spacing = vec2(GAP, GAP);
            let (columns, size) = grid(ui.available_width(), WIDE, GAP);
            let wide = size.x;
            let journey = game.journey();
            for section in Section::all() {
                let places = game.levels_of(section);
                let can_make = section == Section::Own && game.public.is_none();
                let entries: Vec<ListEntry> = match section {
                    Section::Own => game.own_entries(),
                    _ => places.into_iter().map(ListEntry::Level).collect(),
                };
                if entries.is_empty() && !can_make {
                    continue;
                }
                let lock = game.lock_of(section);
                heading(ui, game, section, &journey, lock);
                if can_make && let Some(action) = make(ui, game) {
                    wanted = Some(action);
                }
                for row in entries.chunks(columns) {
                    let shown = ui.horizontal_top(|ui| {
                        let shown = row.iter().map(|&entry| {
                            let shown = ui.vertical(|ui| {
                                let index = match entry {
                                    ListEntry::Level(index) => index,
                                    ListEntry::Removed(removed) => {
                                        let response = removed_tile(ui, game, removed, size);
                                        if response.clicked() {
                                            wanted = Some(LevelAction::BringBackRemoved(removed));
                                        }
                                        return response.rect;
                                    }
                                };
                                let lock = game.own_lock_of(index).or(lock);
                                let response = match lock {
                                    None => tile(ui, game, maps, index, size),
                                    Some(_) => locked_tile(ui, game, index, size),
                                };
                                if index == game.chosen {
                                    super::widgets::focus_first(ui, &response);
                                }
                                if response.clicked() {
                                    wanted = Some(match lock {
                                        None => LevelAction::Play(index),
                                        Some(lock) => LevelAction::TellLock(lock),
                                    });
                                }
                                if game.is_own(index)
                                    && let Some(action) = own_buttons(ui, game, index, wide)
                                {
                                    wanted = Some(action);
                                }
                                response.rect
                            });
                            shown.inner
                        });
                        shown.collect::<Vec<Rect>>()
                    });
                    if matches!(section, Section::Chapter(_)) {
                        let row = row.iter().filter_map(|entry| match *entry {
                            ListEntry::Level(index) => Some(index),
                            ListEntry::Removed(_) => None,
                        });
                        draw_way(ui, game, &row.collect::<Vec<_>>(), &shown.inner);
                    }
                }
                ui.add_space(6.0);
            }
            if game.has_won_path() {
                let size = vec2(260.0, 52.0);
                if button(ui, &theme, said.ending, size, ButtonStyle::Main).clicked() {
                    wanted = Some(LevelAction::ShowEnding);
                }
            }
            ui.add_space(10.0);
            legend(ui, game);
        });
    });
    if back {
        game.blip(Menu::Back);
        game.go_back();
    }
    let Some(wish) = wanted.filter(|_| !back) else {
        return;
    };
    game.blip(Menu::Confirm);
    match wish {
        LevelAction::Play(index) => game.start(index),
        LevelAction::TakeOut(index) => game.take_out(index),
        LevelAction::Change(index) => game.edit(index),
        LevelAction::Rename(index) => {
            game.rename(index);
            focus_name(ui);
        }
        LevelAction::Copy(index) => game.duplicate(index),
        LevelAction::New(dim) => game.edit_blank(dim),
        LevelAction::BringBack => game.bring_back(),
        LevelAction::BringBackRemoved(removed) => game.bring_back_removed(removed),
        LevelAction::GoOn => game.go_on_editing(),
        LevelAction::SavePack => game.save_pack(),
        LevelAction::ShowEnding => game.show_ending(),
        LevelAction::TellLock(lock) => game.notify(lock_text(game, lock)),
    }
}

/// Returns the number of tiles in a row of width `width`, and their size, for tiles about `wide` wide with gaps `gap`
/// [points].
pub(super) fn grid(width: f32, wide: f32, gap: f32) -> (usize, Vec2) {
    let columns = ((width + gap) / (wide + gap)).round().max(2.0);
    let wide = (width - (columns - 1.0) * gap) / columns;
    (columns as usize, vec2(wide, 0.62 * (wide - 20.0) + BELOW))
}

/// Returns why a chapter or level is closed.
fn lock_text(game: &Game, lock: Lock) -> String {
    match lock {
        Lock::Stars { missing, before } => (game.words().opens_with)(missing, before),
        Lock::Calm => game.words().not_in_calm.to_string(),
    }
}

/// Shows the title of a section, and of a chapter its stars, or how it opens.
fn heading(ui: &mut Ui, game: &Game, section: Section, journey: &Journey, lock: Option<Lock>) {
    let (theme, said) = (game.theme(), game.words());
    let (title, stars) = match section {
        Section::Day => (said.daily.to_string(), None),
        Section::First => (said.first_levels.to_string(), None),
        Section::Chapter(number) => {
            let chapter = CHAPTERS[number - 1];
            let name = match game.settings.language {
                Language::English => chapter.en,
                Language::Japanese => chapter.ja,
            };
            let title = (said.chapter)(number, name);
            (title, Some(journey.chapters[number - 1]))
        }
        Section::More => (said.more_levels.to_string(), None),
        Section::Own => (said.own_levels.to_string(), None),
    };
    let note = match (lock, stars) {
        (Some(lock), _) => lock_text(game, lock),
        (None, Some(stars)) => (said.stars)(stars.earned, stars.all),
        (None, None) => String::new(),
    };
    let label = format!("{title}  {note}");
    let (wide, painter) = (ui.available_width(), ui.painter());
    let letters = least_letters(ui.ctx()).max(19.0);
    let name = fitted(painter, &title, 26.0, wide - 8.0, theme.ink);
    let note = fitted(painter, &note, letters, wide - 8.0, theme.ink);
    // A note without room beside the title is below it.
    let is_below = name.size().x + note.size().x + 26.0 > wide;
    let below = if is_below { note.size().y } else { 0.0 };
    let size = vec2(wide, 34.0 + below);
    let (rect, response) = ui.allocate_exact_size(size, Sense::hover());
    response.widget_info(|| WidgetInfo::labeled(Role::Label, true, label.trim()));
    let middle = rect.top() + 17.0;
    let at = pos2(rect.left() + 4.0, middle - 0.5 * name.size().y);
    let after = match is_below {
        true => pos2(at.x, rect.top() + 34.0),
        false => pos2(at.x + name.size().x + 18.0, middle - 0.5 * note.size().y),
    };
    let painter = ui.painter();
    painter.galley(at, name, theme.ink);
    painter.galley(after, note, theme.ink);
}

/// Draws the way from each level of a chapter to the next one in its row: full where the level was won.
fn draw_way(ui: &Ui, game: &Game, row: &[usize], tiles: &[Rect]) {
    let theme = game.theme();
    for (pair, &index) in tiles.windows(2).zip(row) {
        let record = game.records.of_level(&game.levels[index]);
        let is_won = record.is_some_and(Record::is_won);
        let colour = if is_won { theme.accent } else { theme.faint };
        let (from, to) = (pair[0].right_center(), pair[1].left_center());
        for step in 0..3 {
            let at = from.lerp(to, (step as f32 + 0.5) / 3.0);
            ui.painter().circle_filled(at, 3.0, colour);
        }
    }
}

/// Shows a closed level: a card with its name and a lock.
fn locked_tile(ui: &mut Ui, game: &Game, index: usize, size: Vec2) -> Response {
    let theme = game.theme();
    let name = game.settings.language.of(&game.levels[index].game().name);
    let (rect, response) = ui.allocate_exact_size(size, Sense::click());
    response.widget_info(|| WidgetInfo::labeled(Role::Button, false, name));
    let painter = ui.painter();
    painter.rect_filled(rect, 22.0, theme.card.gamma_multiply(0.6));
    let middle = rect.center() - vec2(0.0, 18.0);
    icons::lock(painter, middle, 1.6, theme.faint);
    let galley = fitted(painter, name, 21.0, rect.width() - 24.0, theme.faint);
    let at = pos2(rect.center().x, rect.bottom() - 44.0) - 0.5 * galley.size();
    painter.galley(at, galley, theme.faint);
    focus_ring(ui, &response, rect, 22.0, &theme);
    response
}

/// Shows a card in place of a removed level, which brings it back. Below it is as much room as the buttons had, so that a
/// second press of the one that removed the level meets nothing.
fn removed_tile(ui: &mut Ui, game: &Game, removed: usize, size: Vec2) -> Response {
    let (theme, words) = (game.theme(), game.making());
    let (rect, response) = ui.allocate_exact_size(size, Sense::click());
    let text = (words.bring_back)(game.removed_name(removed));
    response.widget_info(|| WidgetInfo::labeled(Role::Button, true, &text));
    let lively = highlight(ui, &response);
    let place = rect.translate(vec2(0.0, -4.0 * lively));
    let painter = ui.painter();
    painter.rect_filled(place, 22.0, theme.card.gamma_multiply(0.6));
    for (text, ink, down) in [
        (words.removed, theme.faint, -20.0),
        (&text, theme.ink, 20.0),
    ] {
        let galley = fitted(painter, text, 21.0, place.width() - 24.0, ink);
        let at = place.center() + vec2(0.0, down) - 0.5 * galley.size();
        painter.galley(at, galley, ink);
    }
    focus_ring(ui, &response, place, 22.0, &theme);
    ui.spacing_mut().item_spacing.y = OWN_GAP;
    for _ in 0..2 {
        ui.allocate_exact_size(vec2(size.x, finger(ui)), Sense::hover());
    }
    response
}

/// Shows the buttons that make a level, the one that saves all own levels, and the one that brings back a removed level.
fn make(ui: &mut Ui, game: &Game) -> Option<LevelAction> {
    let (theme, words) = (game.theme(), game.making());
    let mut wanted = None;
    let removed = game.removed_level();
    let bring_back = removed.map(|level| {
        let name = game.settings.language.of(&level.game().name);
        (words.bring_back)(name)
    });
    ui.horizontal_wrapped(|ui| {
        let high = finger(ui);
        let most = ui.available_width();
        let mut press = |text: &str, action: LevelAction| {
            let font = FontId::proportional(LETTERS * high);
            let galley = { ui.painter() }.layout_no_wrap(text.to_string(), font, theme.ink);
            let size = vec2((galley.size().x + 44.0).min(most), high);
            if button(ui, &theme, text, size, ButtonStyle::Other).clicked() {
                wanted = Some(action);
            }
        };
        press(words.new_level, LevelAction::New(2));
        press(words.new_level_3d, LevelAction::New(3));
        if game.has_own_levels() {
            press(words.save_pack, LevelAction::SavePack);
        }
        if game.has_unsaved_level() {
            let text = (words.go_on_with)(game.draft_name());
            press(&text, LevelAction::GoOn);
        }
        if let Some(text) = &bring_back {
            press(text, LevelAction::BringBack);
        }
    });
    wanted
}

/// Shows the buttons below a level that the player made or added, in two rows. The one that removes the level is apart.
fn own_buttons(ui: &mut Ui, game: &Game, index: usize, wide: f32) -> Option<LevelAction> {
    let name = game.settings.language.of(&game.levels[index].game().name);
    let (theme, words) = (game.theme(), game.making());
    let mut wanted = None;
    let rows = [
        (
            8.0,
            [
                (words.change, LevelAction::Change(index)),
                (words.rename, LevelAction::Rename(index)),
            ],
        ),
        (
            30.0,
            [
                (words.duplicate, LevelAction::Copy(index)),
                (words.remove, LevelAction::TakeOut(index)),
            ],
        ),
    ];
    ui.spacing_mut().item_spacing.y = OWN_GAP;
    for (gap, row) in rows {
        let size = vec2(0.5 * (wide - gap), finger(ui));
        ui.horizontal(|ui| {
            ui.spacing_mut().item_spacing.x = gap;
            for (text, action) in row {
                if matches!(action, LevelAction::Rename(_)) && !game.can_rename(index) {
                    continue;
                }
                let response = plain_button(ui, &theme, text, size, ButtonStyle::Other);
                let told = format!("{text}: {name}");
                response.widget_info(|| WidgetInfo::labeled(Role::Button, true, &told));
                if response.clicked() {
                    wanted = Some(action);
                }
            }
        });
    }
    wanted
}

/// Shows a level as a card with thumbnail, name and achievements.
pub(super) fn tile(ui: &mut Ui, game: &Game, maps: &Maps, index: usize, size: Vec2) -> Response {
    let theme = game.theme();
    let level = &game.levels[index];
    let name = game.settings.language.of(&level.game().name);
    let (rect, response) = ui.allocate_exact_size(size, Sense::click());
    response.widget_info(|| WidgetInfo::labeled(Role::Button, true, name));
    let lively = highlight(ui, &response);
    let rect = rect.translate(vec2(0.0, -4.0 * lively));
    let painter = ui.painter();
    let shadow = Color32::from_black_alpha(30);
    painter.rect_filled(rect.translate(vec2(0.0, 5.0)), 22.0, shadow);
    painter.rect_filled(rect, 22.0, theme.card);
    let map_size = vec2(rect.width() - 20.0, 0.62 * (rect.width() - 20.0));
    let map = Rect::from_min_size(rect.min + vec2(10.0, 10.0), map_size);
    painter.rect_filled(map, 14.0, theme.paper);
    maps.draw(painter, map, level);
    // Covers the square corners of the thumbnail.
    let frame = Stroke::new(6.0, theme.card);
    painter.rect_stroke(map.expand(3.0), 17.0, frame, egui::StrokeKind::Middle);
    if level.scene().dim == 3 {
        icons::space(ui, map.min + vec2(8.0, 8.0), &theme);
    }
    let galley = fitted(painter, name, 21.0, rect.width() - 24.0, theme.ink);
    let at = pos2(rect.center().x, map.bottom() + 23.0) - 0.5 * galley.size();
    painter.galley(at, galley, theme.ink);

    let record = game.records.of_level(level);
    let base = rect.bottom() - 26.0;
    let mut x = rect.center().x;
    let stars: Vec<bool> = stars_of(level, record)
        .map(|(_, is_earned)| is_earned)
        .collect();
    let routes = level.routes();
    let gap = if routes.is_empty() { 0.0 } else { 16.0 };
    let width = 24.0 * stars.len() as f32 + gap + 32.0 * routes.len() as f32;
    x -= 0.5 * width;
    for reached in stars {
        let star = star(reached);
        let tone = if reached { theme.accent } else { theme.faint };
        words(ui, pos2(x + 12.0, base), star, 20.0, tone);
        x += 24.0;
    }
    x += gap;
    for &route in routes {
        let is_done = record.is_some_and(|record| {
            let by = |route| {
                record.best.contains_key(&route) || record.best_rewound.contains_key(&route)
            };
            by(route) || by(Route::Mix)
        });
        icons::route(painter, &theme, pos2(x + 16.0, base), 10.0, route, is_done);
        x += 32.0;
    }
    if let Some(record) = record {
        draw_best_time(painter, &theme, game.words(), map, record);
        let at = map.right_top() + vec2(-14.0, 14.0);
        let is_unaided = !record.best.is_empty() || !record.best_rewound.is_empty();
        let tone = if is_unaided { theme.good } else { theme.faint };
        painter.circle(at, 14.0, tone, Stroke::new(3.0, theme.card));
        icons::tick(painter, at, 7.0, Stroke::new(3.0, theme.card));
    }
    focus_ring(ui, &response, rect, 22.0, &theme);
    let can_explain = game.public.is_none();
    if can_explain && (response.hovered() || is_on(ui, &response)) {
        explain(ui, game, &response, level, record);
    }
    response
}

/// Draws the shortest time of a record in the lower right corner of the thumbnail, in grey if only aided rounds were won.
fn draw_best_time(painter: &Painter, theme: &Theme, said: &Words, map: Rect, record: &Record) {
    let shortest = |best: &BTreeMap<Route, u64>| best.values().min().copied();
    let unaided = shortest(&record.best).or_else(|| shortest(&record.best_rewound));
    let Some(ticks) = unaided.or_else(|| shortest(&record.best_assisted)) else {
        return;
    };
    let time = (said.seconds)(ticks as f32 * fuwafuwa::DEFAULT_TICK);
    let ink = if unaided.is_some() {
        theme.ink
    } else {
        theme.faint
    };
    let font = FontId::proportional(least_letters(painter.ctx()).max(16.0));
    let galley = painter.layout_no_wrap(time, font, ink);
    let size = galley.size() + vec2(16.0, 6.0);
    let place = Rect::from_min_size(map.right_bottom() - size - vec2(6.0, 6.0), size);
    painter.rect_filled(place, 0.5 * size.y, pale(theme));
    painter.galley(place.min + vec2(8.0, 3.0), galley, ink);
}

fn star(is_earned: bool) -> &'static str {
    if is_earned { "★" } else { "☆" }
}

/// Greatest height of a line of a tooltip [points].
const LINE: f32 = 28.0;

/// Shows a tooltip with the stars and best times of a level.
fn explain(ui: &Ui, game: &Game, tile: &Response, level: &Level, record: Option<&Record>) {
    let (theme, said) = (game.theme(), game.words());
    let stars = stars_of(level, record).map(|(wish, is_earned)| {
        let name = wish.map_or(said.fill_basket.to_string(), said.wish);
        format!("{} {name}", star(is_earned))
    });
    let time = |(&route, &ticks): (&Route, &u64)| {
        let time = (said.seconds)(ticks as f32 * fuwafuwa::DEFAULT_TICK);
        format!("{} {time}", (said.route)(route))
    };
    let times = record.into_iter().flat_map(|record| &record.best);
    let assisted = record.into_iter().flat_map(|record| &record.best_assisted);
    let assisted = assisted.map(|best| format!("{}, {}", time(best), said.assisted));
    let rewound = record.into_iter().flat_map(|record| &record.best_rewound);
    let rewound = rewound.map(|best| format!("{}, {}", time(best), said.rewound));
    let times = times.map(time).chain(rewound).chain(assisted);
    let lines: Vec<String> = stars.chain(times).collect();
    // The tooltip of a tile that is scrolled away would cover the header.
    if lines.is_empty() || !ui.is_rect_visible(tile.rect) {
        return;
    }
    // Without room below the tile, the tooltip is above it, or beside it if the header is there.
    let height = LINE * (lines.len() + 1) as f32;
    let places: &[RectAlign] = match tile.rect.top() - height > ui.clip_rect().top() {
        true => &[RectAlign::TOP_START, RectAlign::TOP_END],
        false => &[
            RectAlign::RIGHT_START,
            RectAlign::LEFT_START,
            RectAlign::RIGHT_END,
            RectAlign::LEFT_END,
        ],
    };
    let mut tooltip = Tooltip::always_open(ui.ctx().clone(), ui.layer_id(), tile.id, tile);
    tooltip.popup = tooltip.popup.align_alternatives(places);
    tooltip.gap(6.0).show(|ui| {
        for line in lines {
            ui.label(RichText::new(line).size(17.0).color(theme.ink));
        }
    });
}

/// Height of a row of the legend [points].
pub(super) const LEGEND: f32 = 30.0;

/// Shows the legend of the symbols on the tiles, in centred rows.
pub(super) fn legend(ui: &mut Ui, game: &Game) {
    const SIGN: f32 = 46.0;
    const BETWEEN: f32 = 20.0;
    let (theme, said) = (game.theme(), game.words());
    let [won, wish, squeezed, shaved] = said.legend;
    let route = |route| {
        move |ui: &Ui, theme: &Theme, at| icons::route(ui.painter(), theme, at, 10.0, route, true)
    };
    let [squeeze, shave] = [Route::Squeeze, Route::Shave].map(route);
    let signs: [(&str, &Sign); 4] = [
        (won, &|ui, theme, at| {
            ui.painter().circle_filled(at, 12.0, theme.good);
            icons::tick(ui.painter(), at, 6.0, Stroke::new(3.0, theme.card));
        }),
        (wish, &|ui, theme, at| {
            words(ui, at, "★", 20.0, theme.accent)
        }),
        (squeezed, &squeeze),
        (shaved, &shave),
    ];
    let letters = least_letters(ui.ctx()).max(17.0);
    let texts = signs.map(|(name, _)| fitted(ui.painter(), name, letters, 300.0, theme.faint));
    let widths = texts.each_ref().map(|text| SIGN + text.size().x + BETWEEN);
    let (mut first, all) = (0, ui.available_width());
    while first < signs.len() {
        // As many signs as fit into the row, at least one.
        let mut width = 0.0;
        let fits = widths[first..].iter().take_while(|wide| {
            width += **wide;
            width - BETWEEN <= all
        });
        let count = fits.count().max(1);
        let width: f32 = widths[first..first + count].iter().sum::<f32>() - BETWEEN;
        let (row, _) = ui.allocate_exact_size(vec2(all, LEGEND), Sense::hover());
        let mut left = row.center().x - 0.5 * width;
        for index in first..first + count {
            let (name, sign) = signs[index];
            sign(ui, &theme, pos2(left + 0.5 * 40.0, row.center().y));
            let text = &texts[index];
            let at = pos2(left + SIGN, row.center().y - 0.5 * text.size().y);
            let place = Rect::from_min_size(at, text.size());
            let response = ui.interact(place, ui.scope_id().with(name), Sense::hover());
            response.widget_info(|| WidgetInfo::labeled(Role::Label, true, name));
            ui.painter().galley(at, text.clone(), theme.faint);
            left += widths[index];
        }
        first += count;
    }
}

/// Function that draws a sign of the legend at its centre.
type Sign<'a> = dyn Fn(&Ui, &Theme, egui::Pos2) + 'a;
