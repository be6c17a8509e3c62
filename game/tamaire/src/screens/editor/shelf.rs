//! Strip below the room: things to add, and what can be done with the selection.

use super::super::making::round_button;
use super::super::{hud, icons};
use super::{EDGE, GAP, signs};
use crate::game::{EditorPart, Game, Screen};
use app_shell::Theme;
use app_shell::widgets::{ButtonStyle, LETTERS, button, plain_button, wrapped};
use egui::{
    Painter, Pos2, Rect, Response, Role, ScrollArea, Ui, UiBuilder, Vec2, WidgetInfo, pos2, vec2,
};
use fuwafuwa::Vec3;
use tamaire_maker::items::{Item, Kind};
use tamaire_sound::Menu;

/// Height of a button [points at scale 1].
const HIGH: f32 = 44.0;
/// Width of a thing that can be added, and least width of another button [points at scale 1].
const WIDE: [f32; 2] = [108.0, 80.0];
/// Height of the scroll bar below the buttons [points].
const BAR: f32 = 8.0;

/// Actions on the selection.
#[derive(Copy, Clone, PartialEq)]
enum Deed {
    Draw,
    Properties,
    Turn(f32),
    Lift(f32),
    Tip(f32),
    Nudge(usize),
    Scale(i32),
    Copy,
    Remove,
    Done,
}

impl Deed {
    /// Returns all actions in pairs, which are shown side by side. Those that some selections lack come last, so that the
    /// others have the same places for each selection.
    fn pairs(game: &Game) -> Vec<[Option<Self>; 2]> {
        let mut pairs = vec![
            [Self::Properties, Self::Copy],
            [Self::Remove, Self::Done],
            [Self::Scale(1), Self::Scale(-1)],
            [Self::Turn(1.0), Self::Turn(-1.0)],
        ];
        if game.maker.draft.scene().dim == 3 {
            pairs.extend([
                [Self::Lift(1.0), Self::Lift(-1.0)],
                [Self::Nudge(4), Self::Nudge(5)],
                [Self::Tip(1.0), Self::Tip(-1.0)],
            ]);
        }
        if game.settings.scanning.is_on() {
            pairs.extend([[0, 1], [2, 3]].map(|ways| ways.map(Self::Nudge)));
        }
        let mut pairs: Vec<_> = pairs.into_iter().map(|pair| pair.map(Some)).collect();
        if let Some(Item::Body(_)) = game.main_item() {
            pairs.push([Some(Self::Draw), None]);
        }
        pairs
    }

    fn name(self, game: &Game) -> &'static str {
        let words = game.making();
        match self {
            Self::Draw => words.draw,
            Self::Properties => words.properties,
            Self::Turn(steps) => words.turn[usize::from(steps < 0.0)],
            Self::Lift(steps) => words.lift[usize::from(steps < 0.0)],
            Self::Tip(steps) => words.tip[usize::from(steps < 0.0)],
            Self::Nudge(way) => words.nudge[way],
            Self::Scale(steps) => words.scale[usize::from(steps < 0)],
            Self::Copy => words.copy,
            Self::Remove => words.remove,
            Self::Done => words.unselect,
        }
    }

    fn perform(self, game: &mut Game) {
        game.blip(Menu::Confirm);
        match self {
            Self::Draw => game.draw_selected(),
            Self::Properties => {
                game.maker.editor.moves_by_keys = false;
                game.go(Screen::Properties);
            }
            Self::Turn(steps) => {
                // Seen from above, a turn about the vertical axis goes the same way.
                let axis = if game.maker.draft.scene().dim == 3 {
                    Vec3::Y
                } else {
                    Vec3::Z
                };
                game.turn_selection(axis, steps);
            }
            Self::Tip(steps) => game.turn_selection(Vec3::Z, steps),
            Self::Nudge(way) => {
                let ways = [-Vec3::X, Vec3::X, -Vec3::Y, Vec3::Y, -Vec3::Z, Vec3::Z];
                game.nudge(0.1 * ways[way]);
            }
            Self::Lift(steps) => game.nudge(0.1 * steps * Vec3::Y),
            Self::Scale(steps) => game.scale_selection(steps),
            Self::Copy => game.copy_selection(),
            Self::Remove => game.remove_selection(),
            Self::Done => game.select_nothing(),
        }
    }
}

/// Returns the number of rows of buttons below the switches.
fn rows_in(screen: Rect) -> usize {
    if is_narrow(screen) { 3 } else { 2 }
}

/// Whether the switches and the tabs need two rows.
fn is_narrow(screen: Rect) -> bool {
    screen.width() < screen.height()
}

/// Returns the height of the strip [points]. `scale` enlarges the buttons.
pub(super) fn height(screen: Rect, scale: f32) -> f32 {
    let heads = if is_narrow(screen) { 2.0 } else { 1.0 };
    (heads + rows_in(screen) as f32) * (scale * HIGH + GAP) + BAR + EDGE
}

pub(super) fn show(game: &mut Game, ui: &mut Ui, rect: Rect) {
    let theme = game.theme();
    ui.painter().rect_filled(rect, 0.0, theme.paper);
    let inside = rect.shrink2(vec2(EDGE, 0.5 * EDGE));
    let high = hud::full_scale(game, ui) * HIGH;
    let first = inside.with_max_y(inside.top() + high);
    let head = match is_narrow(ui.max_rect()) {
        true => {
            modes(game, ui, first);
            first.translate(vec2(0.0, high + GAP))
        }
        false => {
            let [left, right] = halves(first);
            modes(game, ui, right);
            left
        }
    };
    tabs(game, ui, head);
    let rest = inside.with_min_y(head.bottom() + GAP);
    match game.maker.editor.part {
        EditorPart::Things => things(game, ui, rest),
        EditorPart::Selection => deeds(game, ui, rest),
    }
}

/// Returns the left and the right half of a place, with a gap between them.
fn halves(place: Rect) -> [Rect; 2] {
    let middle = place.center().x;
    [
        place.with_max_x(middle - 0.5 * GAP),
        place.with_min_x(middle + 0.5 * GAP),
    ]
}

/// Shows the tabs of the strip: the things to add, and what can be done with the selection, if there is one.
fn tabs(game: &mut Game, ui: &mut Ui, rect: Rect) {
    let (theme, words) = (game.theme(), game.making());
    let selected = match (game.main_item(), game.maker.editor.selection.len()) {
        (_, 0) => None,
        (Some(item), _) => Some(game.item_name(item)),
        (None, count) => Some((words.selected)(count)),
    };
    let tabs = [
        (EditorPart::Things, Some(words.things.to_string())),
        (EditorPart::Selection, selected),
    ];
    let selection = words.selection;
    for ((part, text), place) in tabs.into_iter().zip(halves(rect)) {
        let Some(text) = text else {
            continue;
        };
        let is_shown = game.maker.editor.part == part;
        let builder = UiBuilder::new().max_rect(place);
        let shown = ui.scope_builder(builder, |ui| {
            let style = ButtonStyle::of(is_shown);
            let response = plain_button(ui, &theme, &text, place.size(), style);
            // The thing itself has the same name.
            let name = match part {
                EditorPart::Things => text,
                EditorPart::Selection => format!("{selection}: {text}"),
            };
            response.widget_info(|| WidgetInfo::selected(Role::Button, true, is_shown, &name));
            response.clicked()
        });
        if shown.inner {
            game.blip(Menu::Confirm);
            game.maker.editor.part = part;
        }
    }
}

/// Shows the switches of the editor and the way to the level's own properties.
fn modes(game: &mut Game, ui: &mut Ui, rect: Rect) {
    let (theme, words) = (game.theme(), game.making());
    let side = rect.height();
    let editor = &game.maker.editor;
    let mut switches = vec![
        (words.snap, editor.snaps),
        (words.select_more, editor.is_adding),
    ];
    if game.maker.draft.scene().dim == 3 {
        switches.push((words.drag_lifts, editor.lifts));
    }
    let mut left = rect.left();
    for (index, (name, is_on)) in switches.into_iter().enumerate() {
        let place = Rect::from_min_size(pos2(left, rect.top()), Vec2::splat(side));
        let response = round_button(
            ui,
            &theme,
            place,
            name,
            Some(is_on),
            |painter, at, scale| {
                draw_switch(painter, at, scale, theme.ink, index);
            },
        );
        if response.clicked() {
            game.blip(Menu::Confirm);
            match index {
                0 => game.maker.editor.snaps ^= true,
                1 => game.maker.editor.is_adding ^= true,
                _ => game.maker.editor.lifts ^= true,
            }
        }
        left += side + GAP;
    }
    let mut buttons = vec![
        (words.level_settings, Mode::Level),
        (words.draw_new, Mode::Draw),
    ];
    if game.can_paste() {
        buttons.push((words.paste, Mode::Paste));
    }
    let count = buttons.len() as f32;
    let wide = (rect.right() - left - (count - 1.0) * GAP) / count;
    for (text, mode) in buttons {
        let place = Rect::from_min_size(pos2(left, rect.top()), vec2(wide.min(5.0 * side), side));
        let builder = UiBuilder::new().max_rect(place);
        let pressed = ui.scope_builder(builder, |ui| {
            button(ui, &theme, text, place.size(), ButtonStyle::Other).clicked()
        });
        if pressed.inner {
            game.blip(Menu::Confirm);
            match mode {
                Mode::Level => {
                    game.select_nothing();
                    game.go(Screen::Properties);
                }
                Mode::Draw => game.draw_new_body(),
                Mode::Paste => game.paste(),
            }
        }
        left = place.right() + GAP;
    }
}

/// A button beside the switches of the editor.
#[derive(Copy, Clone)]
enum Mode {
    Level,
    Draw,
    Paste,
}

/// Draws the sign of a switch of the editor: a grid, two frames, or two arrows.
fn draw_switch(
    painter: &egui::Painter,
    at: egui::Pos2,
    scale: f32,
    ink: egui::Color32,
    index: usize,
) {
    let line = egui::Stroke::new(2.0 * scale, ink);
    match index {
        0 => {
            for k in [-6.0, 0.0, 6.0] {
                for ends in [[[k, -9.0], [k, 9.0]], [[-9.0, k], [9.0, k]]] {
                    let ends = ends.map(|[x, y]| at + scale * vec2(x, y));
                    painter.line_segment(ends, line);
                }
            }
        }
        1 => {
            for k in [-3.0, 3.0] {
                let middle = at + scale * vec2(k, k);
                let place = Rect::from_center_size(middle, scale * Vec2::splat(11.0));
                painter.rect_stroke(place, 2.0, line, egui::StrokeKind::Middle);
            }
        }
        _ => {
            icons::up(painter, at - scale * vec2(0.0, 4.0), 0.7 * scale, ink);
            icons::down(painter, at + scale * vec2(0.0, 4.0), 0.7 * scale, ink);
        }
    }
}

/// Shows the things that can be added, the most usual ones in the first columns.
fn things(game: &mut Game, ui: &mut Ui, rect: Rect) {
    let names: Vec<(Kind, &str)> = { Kind::ALL.into_iter() }
        .map(|kind| (kind, (game.making().kind_name)(kind)))
        .collect();
    let (theme, scale) = (game.theme(), hud::full_scale(game, ui));
    let count = rows_in(ui.max_rect());
    let columns: Vec<Vec<_>> = names.chunks(count).map(<[_]>::to_vec).collect();
    let chosen = grid(
        game,
        ui,
        (rect, WIDE[0]),
        "things",
        &columns,
        |ui, (kind, text), size| {
            signed(ui, &theme, (text, size), |painter, at| {
                signs::draw(painter, &theme, at, scale, kind);
            })
            .clicked()
        },
    );
    if let Some((kind, _)) = chosen {
        game.blip(Menu::Confirm);
        game.add_thing(kind);
    }
}

/// Shows what can be done with the selection.
fn deeds(game: &mut Game, ui: &mut Ui, rect: Rect) {
    let pairs = Deed::pairs(game);
    let theme = game.theme();
    let count = rows_in(ui.max_rect());
    let columns: Vec<Vec<Deed>> = { pairs.chunks(count) }
        .flat_map(|rows| [0, 1].map(|side| rows.iter().filter_map(|pair| pair[side]).collect()))
        .collect();
    let chosen = grid(
        game,
        ui,
        (rect, WIDE[1]),
        "deeds",
        &columns,
        |ui, deed: Deed, size| {
            button(ui, &theme, deed.name(game), size, ButtonStyle::Other).clicked()
        },
    );
    if let Some(deed) = chosen {
        deed.perform(game);
    }
}

/// Shows columns of buttons of at least the width `wide` [points at scale 1], which scroll sideways. `show` shows an option
/// in a size and returns whether it is pressed. Returns the chosen option.
fn grid<T: Copy>(
    game: &Game,
    ui: &mut Ui,
    (rect, wide): (Rect, f32),
    id: &str,
    columns: &[Vec<T>],
    mut show: impl FnMut(&mut Ui, T, Vec2) -> bool,
) -> Option<T> {
    let scale = hud::full_scale(game, ui);
    // The columns that are seen fill the width.
    let seen = ((rect.width() + GAP) / (scale * wide + GAP))
        .floor()
        .max(1.0);
    let wide = (rect.width() + GAP) / seen - GAP;
    let size = vec2(wide.min(1.5 * scale * WIDE[0]), scale * HIGH);
    let mut chosen = None;
    ui.scope_builder(UiBuilder::new().max_rect(rect), |ui| {
        // The wheel scrolls sideways.
        ui.style_mut().always_scroll_the_only_direction = true;
        // Each level begins at the start.
        let area = ScrollArea::horizontal().id_salt((id, game.maker.editor.opened));
        let area = area.scroll_source(egui::scroll_area::ScrollSource::ALL);
        area.show(ui, |ui| {
            ui.spacing_mut().item_spacing = Vec2::splat(GAP);
            ui.horizontal_top(|ui| {
                for column in columns {
                    ui.vertical(|ui| {
                        for &option in column {
                            if show(ui, option, size) {
                                chosen = Some(option);
                            }
                        }
                    });
                }
            });
        });
    });
    chosen
}

/// Shows a button with a sign on the left and its text beside it.
fn signed(
    ui: &mut Ui,
    theme: &Theme,
    (text, size): (&str, Vec2),
    draw: impl FnOnce(&Painter, Pos2),
) -> Response {
    let response = plain_button(ui, theme, "", size, ButtonStyle::Other);
    response.widget_info(|| WidgetInfo::labeled(Role::Button, true, text));
    let (rect, side) = (response.rect, size.y);
    let painter = ui.painter();
    draw(painter, rect.left_center() + vec2(0.55 * side, 0.0));
    let place = rect
        .with_min_x(rect.left() + side)
        .shrink2(vec2(0.1 * side, 2.0));
    let galley = wrapped(painter, text, LETTERS * side, place.size(), theme.ink);
    let at = place.center() - galley.rect.center().to_vec2();
    painter.galley(at, galley, theme.ink);
    response
}
