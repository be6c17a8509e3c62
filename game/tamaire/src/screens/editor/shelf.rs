//! Strip below the room: things to add, and what can be done with the selection.

use super::super::making::round_button;
use super::super::{hud, icons};
use super::{EDGE, GAP, signs};
use crate::game::{EditorPart, Game, Screen};
use app_shell::Theme;
use app_shell::widgets::{ButtonStyle, button, fitted, plain_button};
use egui::{
    Painter, Pos2, Rect, Response, Role, ScrollArea, Ui, UiBuilder, Vec2, WidgetInfo, pos2, vec2,
};
use fuwafuwa::Vec3;
use tamaire_maker::items::{Item, Kind};
use tamaire_sound::Menu;

/// Height of a button with text [points].
const HIGH: f32 = 44.0;
/// Width of a button with text [points].
const WIDE: f32 = 108.0;
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
    fn all(game: &Game) -> Vec<Self> {
        let mut all = vec![Self::Properties];
        if let [Item::Body(_)] = game.maker.editor.selection[..] {
            all.push(Self::Draw);
        }
        all.extend([
            Self::Scale(1),
            Self::Scale(-1),
            Self::Turn(1.0),
            Self::Turn(-1.0),
        ]);
        if game.maker.draft.scene().dim == 3 {
            all.extend([
                Self::Lift(1.0),
                Self::Lift(-1.0),
                Self::Nudge(4),
                Self::Nudge(5),
            ]);
            all.extend([Self::Tip(1.0), Self::Tip(-1.0)]);
        }
        if game.settings.scanning.is_on() {
            all.extend((0..4).map(Self::Nudge));
        }
        all.extend([Self::Copy, Self::Remove, Self::Done]);
        all
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
            Self::Done => words.done,
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

/// Returns the height of the strip [points]. `scale` enlarges the buttons.
pub(super) fn height(screen: Rect, scale: f32) -> f32 {
    let rows = if screen.width() < screen.height() {
        3.0
    } else {
        2.0
    };
    rows * (scale * HIGH + GAP) + scale * HIGH + 2.0 * EDGE
}

pub(super) fn show(game: &mut Game, ui: &mut Ui, rect: Rect) {
    let theme = game.theme();
    ui.painter().rect_filled(rect, 0.0, theme.paper);
    let inside = rect.shrink2(vec2(EDGE, 0.5 * EDGE));
    let high = hud::scale(game, ui) * HIGH;
    let first = inside.with_max_y(inside.top() + high);
    modes(game, ui, first);
    let rest = inside.with_min_y(first.bottom() + GAP);
    match game.maker.editor.part {
        EditorPart::Things => things(game, ui, rest),
        EditorPart::Selection => deeds(game, ui, rest),
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

/// Shows the things that can be added.
fn things(game: &mut Game, ui: &mut Ui, rect: Rect) {
    let names: Vec<(Kind, &str)> = { Kind::ALL.into_iter() }
        .map(|kind| (kind, (game.making().kind_name)(kind)))
        .collect();
    let sign = |painter: &Painter, at: Pos2, scale: f32, kind: Kind| {
        signs::draw(painter, &game.theme(), at, scale, kind);
    };
    let chosen = rows(game, ui, rect, "things", &names, Some(&sign));
    if let Some(kind) = chosen {
        game.blip(Menu::Confirm);
        game.add_thing(kind);
    }
}

/// Shows what can be done with the selection.
fn deeds(game: &mut Game, ui: &mut Ui, rect: Rect) {
    let deeds = Deed::all(game);
    let names: Vec<(Deed, &str)> = deeds
        .into_iter()
        .map(|deed| (deed, deed.name(game)))
        .collect();
    if let Some(deed) = rows(game, ui, rect, "deeds", &names, None) {
        deed.perform(game);
    }
}

/// Function that draws the sign of an option at a position in a scale.
type Sign<'a, T> = &'a dyn Fn(&Painter, Pos2, f32, T);

/// Shows buttons in rows that scroll sideways. Returns the chosen one.
fn rows<T: Copy>(
    game: &Game,
    ui: &mut Ui,
    rect: Rect,
    id: &str,
    options: &[(T, &str)],
    sign: Option<Sign<T>>,
) -> Option<T> {
    let theme = game.theme();
    let scale = hud::scale(game, ui);
    let size = scale * vec2(WIDE, HIGH - 4.0);
    let count = (rect.height() / (size.y + 0.5 * GAP)).floor().max(1.0) as usize;
    let mut chosen = None;
    let builder = UiBuilder::new().max_rect(rect);
    ui.scope_builder(builder, |ui| {
        // The wheel scrolls sideways.
        ui.style_mut().always_scroll_the_only_direction = true;
        let area = ScrollArea::horizontal().id_salt(id);
        let area = area.scroll_source(egui::scroll_area::ScrollSource::ALL);
        area.show(ui, |ui| {
            ui.spacing_mut().item_spacing = Vec2::splat(GAP);
            ui.vertical(|ui| {
                // Column by column, so that the first options are seen without scrolling.
                for row in 0..count.min(options.len()) {
                    ui.horizontal(|ui| {
                        for &(option, text) in options.iter().skip(row).step_by(count) {
                            let response = match sign {
                                None => button(ui, &theme, text, size, ButtonStyle::Other),
                                Some(sign) => signed(ui, &theme, (text, size), |painter, at| {
                                    sign(painter, at, scale, option);
                                }),
                            };
                            if response.clicked() {
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
    let room = rect.width() - 1.25 * side;
    let galley = fitted(painter, text, 0.42 * side, room, theme.ink);
    let at = rect.left_center() + vec2(side, -0.5 * galley.size().y);
    painter.galley(at, galley, theme.ink);
    response
}
