//! Crayons and tools around the paper.

use super::super::icons;
use super::super::widgets::finger;
use crate::game::{DrawingTool, Game, WIDTHS};
use app_shell::Theme;
use app_shell::widgets::{fitted, focus_ring, highlight, is_on, least_letters};
use egui::{
    Color32, Painter, Pos2, Rect, Response, Role, Sense, Shape, Stroke, StrokeKind, Tooltip, Ui,
    Vec2, WidgetInfo, pos2, vec2,
};
use fuwafuwa_scenes::scene::Form;
use tamaire_maker::drawing::Drawing;
use tamaire_play::playground::Stuff;
use tamaire_sound::Menu;

/// Number of columns of crayons in a portrait window.
const CRAYON_COLUMNS: usize = 4;
/// Maximum height of a crayon with the gap below it [points].
const CRAYON: f32 = 84.0;
/// Length of the tip of a crayon [points].
const TIP: f32 = 22.0;
/// Side of a tool [points].
const TOOL: f32 = 46.0;
/// Gap between tools [points].
const GAP: f32 = 6.0;
/// Thickness of a slab [cells].
const SLAB: usize = 8;
/// Angle by which a button turns the block [rad].
const TURN: f32 = 0.4;

/// Shapes of the stamps, in the order of their names.
const STAMPS: [Form; 5] = [Form::Ball, Form::Box, Form::Ring, Form::Heart, Form::Flower];

/// A round button with a sign.
#[derive(Copy, Clone, PartialEq)]
enum Tool {
    Use(DrawingTool),
    Width(usize),
    Mirror,
    Closes,
    Clear,
    Puff,
    Lathe,
    Slab,
    Turn(usize),
    ToPaper,
    Picture,
    Build,
}

impl Tool {
    /// Returns the tools without a caption for the drawing that is shown, in order.
    fn plain(game: &Game) -> Vec<Self> {
        let mut all: Vec<Self> = (0..WIDTHS.len()).map(Self::Width).collect();
        all.extend([DrawingTool::Crayon, DrawingTool::Paint, DrawingTool::Eraser].map(Self::Use));
        if !game.maker.shows_block {
            all.push(Self::Use(DrawingTool::Bucket));
        }
        all.extend(STAMPS.map(DrawingTool::Stamp).map(Self::Use));
        all.extend([Self::Mirror, Self::Closes, Self::Clear]);
        all
    }

    /// Returns the tools with a caption for the drawing that is shown, in order.
    fn captioned(game: &Game) -> Vec<Self> {
        let block = game.maker.shows_block;
        let mut all = Vec::new();
        match block {
            true => all.extend([Self::Turn(0), Self::Turn(1), Self::ToPaper]),
            false if game.maker.may_turn_solid() => {
                all.extend([Self::Puff, Self::Lathe, Self::Slab]);
            }
            false => {}
        }
        if game.maker.is_alone() {
            all.push(Self::Build);
        }
        if crate::platform::HAS_DIALOG && !block && !game.settings.scanning.is_on() {
            all.push(Self::Picture);
        }
        all
    }

    /// Returns the short text under the sign, empty if there is none.
    fn caption(self, game: &Game) -> &'static str {
        let words = game.making();
        let [puff, lathe, slab, build, picture] = words.tool_captions;
        match self {
            Self::Puff => puff,
            Self::Lathe => lathe,
            Self::Slab => slab,
            Self::Build => build,
            Self::Picture => picture,
            Self::Turn(side) => words.nudge[side],
            Self::ToPaper => words.paper,
            _ => "",
        }
    }

    fn name(self, game: &Game) -> &'static str {
        let words = game.making();
        match self {
            Self::Use(DrawingTool::Crayon) => words.draw,
            Self::Use(DrawingTool::Paint) => words.paint,
            Self::Use(DrawingTool::Eraser) => words.eraser,
            Self::Use(DrawingTool::Bucket) => words.bucket,
            Self::Use(DrawingTool::Stamp(form)) => {
                let place = STAMPS.iter().position(|known| *known == form);
                words.stamps[place.unwrap_or(0)]
            }
            Self::Width(index) => words.widths[index],
            Self::Mirror => words.mirror,
            Self::Closes => words.closes,
            Self::Clear => words.clear,
            Self::Puff => words.puff,
            Self::Lathe => words.lathe,
            Self::Slab => words.slab,
            Self::Turn(side) => words.turn[side],
            Self::ToPaper => words.to_paper,
            Self::Picture => words.picture,
            Self::Build => words.build_level,
        }
    }

    /// Returns whether the tool is chosen; `None` for one that acts at once.
    fn is_chosen(self, game: &Game) -> Option<bool> {
        let maker = &game.maker;
        match self {
            Self::Use(tool) => Some(tool == maker.tool),
            Self::Width(index) => Some(index == maker.width),
            Self::Mirror => Some(maker.drawing().mirror()),
            Self::Closes => Some(maker.drawing().closes()),
            _ => None,
        }
    }

    fn press(self, game: &mut Game) {
        game.blip(Menu::Confirm);
        let maker = &mut game.maker;
        maker.lift_pen();
        match self {
            Self::Use(tool) => maker.tool = tool,
            Self::Width(index) => maker.width = index,
            Self::Mirror => {
                let is_on = maker.drawing().mirror();
                maker.drawing_mut().set_mirror(!is_on);
            }
            Self::Closes => {
                let is_on = maker.drawing().closes();
                maker.drawing_mut().set_closes(!is_on);
            }
            Self::Clear => {
                maker.picture = None;
                maker.drawing_mut().clear();
            }
            Self::Puff => maker.make_solid(Drawing::puffed),
            Self::Lathe => maker.make_solid(Drawing::lathed),
            Self::Slab => maker.make_solid(|paper| paper.slab(SLAB)),
            Self::Turn(side) => maker.angles[0] += [-TURN, TURN][side],
            Self::ToPaper => maker.show_block(false),
            Self::Picture => game.ask_for_file(),
            Self::Build => game.edit_room(),
        }
    }

    fn draw(self, game: &Game, painter: &Painter, at: Pos2, scale: f32, ink: Color32) {
        let colour = crayon_colour(game, game.maker.crayon);
        let line = Stroke::new(2.0 * scale, ink);
        let point = |x: f32, y: f32| at + scale * vec2(x, y);
        match self {
            Self::Use(DrawingTool::Crayon) => {
                crayon_icon(painter, at, scale, colour, ink);
            }
            Self::Use(DrawingTool::Paint) => {
                painter.circle(at, 9.0 * scale, Color32::TRANSPARENT, line);
                let half = (0..=16).map(|k| {
                    let angle = std::f32::consts::PI * k as f32 / 16.0;
                    at + 8.0 * scale * vec2(angle.cos(), angle.sin())
                });
                painter.add(Shape::convex_polygon(half.collect(), colour, Stroke::NONE));
            }
            Self::Use(DrawingTool::Eraser) => {
                let body = Rect::from_center_size(at, scale * vec2(20.0, 12.0));
                painter.rect(body, 3.0, Color32::WHITE, line, StrokeKind::Middle);
                let cap = body.with_max_x(body.left() + 8.0 * scale);
                painter.rect(cap, 3.0, ink, line, StrokeKind::Middle);
            }
            Self::Use(DrawingTool::Bucket) => {
                let bucket = [[-8.0, -4.0], [6.0, -8.0], [8.0, 4.0], [-4.0, 9.0]];
                let bucket = bucket.map(|[x, y]| point(x, y)).to_vec();
                painter.add(Shape::convex_polygon(bucket, colour, line));
                painter.circle(
                    point(-10.0, 5.0),
                    2.5 * scale,
                    colour,
                    Stroke::new(1.0, ink),
                );
            }
            Self::Use(DrawingTool::Stamp(form)) => {
                super::super::toys::draw_form(painter, &game.theme(), form, at, scale, colour);
            }
            Self::Width(index) => {
                painter.circle_filled(at, [2.5, 5.0, 9.0][index] * scale, ink);
            }
            Self::Mirror => {
                painter.line_segment([point(0.0, -11.0), point(0.0, 11.0)], line);
                for side in [-1.0, 1.0] {
                    let wing = [[3.0, -7.0], [10.0, 6.0], [3.0, 6.0]];
                    let wing = wing.map(|[x, y]| point(side * x, y)).to_vec();
                    painter.add(Shape::convex_polygon(wing, ink, Stroke::NONE));
                }
            }
            Self::Closes => {
                painter.circle(at, 9.0 * scale, colour, line);
            }
            Self::Clear => {
                let page = Rect::from_center_size(at, scale * vec2(15.0, 19.0));
                painter.rect(page, 2.0, Color32::WHITE, line, StrokeKind::Middle);
            }
            Self::Puff => {
                let cushion = Rect::from_center_size(at, scale * vec2(22.0, 15.0));
                painter.rect(cushion, 7.0 * scale, colour, line, StrokeKind::Middle);
                painter.circle_filled(point(-5.0, -3.0), 2.5 * scale, Color32::WHITE);
            }
            Self::Lathe => {
                icons::again(painter, at, scale, ink);
                painter.line_segment([point(0.0, -11.0), point(0.0, 11.0)], line);
            }
            Self::Slab => {
                let top = [[-10.0, 0.0], [0.0, -6.0], [10.0, 0.0], [0.0, 6.0]];
                let shifted = top.map(|[x, y]| point(x, y + 5.0)).to_vec();
                painter.add(Shape::convex_polygon(shifted, ink, Stroke::NONE));
                let top = top.map(|[x, y]| point(x, y)).to_vec();
                painter.add(Shape::convex_polygon(top, colour, line));
            }
            Self::Turn(side) => {
                let way = [-1.0, 1.0][side];
                painter.line_segment([point(-9.0 * way, 0.0), point(9.0 * way, 0.0)], line);
                let head = [[9.0, 0.0], [3.0, -5.0], [3.0, 5.0]];
                let head = head.map(|[x, y]| point(way * x, y)).to_vec();
                painter.add(Shape::convex_polygon(head, ink, Stroke::NONE));
            }
            Self::ToPaper => {
                let page = Rect::from_center_size(at, scale * vec2(15.0, 19.0));
                painter.rect(page, 2.0, Color32::WHITE, line, StrokeKind::Middle);
                crayon_icon(
                    painter,
                    at + scale * vec2(4.0, 0.0),
                    0.8 * scale,
                    colour,
                    ink,
                );
            }
            Self::Build => {
                icons::basket(painter, at, scale, ink);
            }
            Self::Picture => {
                let frame = Rect::from_center_size(at, scale * vec2(20.0, 16.0));
                painter.rect(frame, 2.0, Color32::WHITE, line, StrokeKind::Middle);
                let hill = [[-8.0, 6.0], [-2.0, -2.0], [4.0, 6.0]];
                let hill = hill.map(|[x, y]| point(x, y)).to_vec();
                painter.add(Shape::convex_polygon(hill, ink, Stroke::NONE));
                painter.circle_filled(point(5.0, -3.0), 2.5 * scale, ink);
            }
        }
    }
}

/// Returns the colour of a crayon.
pub(super) fn crayon_colour(game: &Game, number: u8) -> Color32 {
    let [red, green, blue] = game.maker.palette.colour(number);
    Color32::from_rgb(red, green, blue)
}

/// Draws a small crayon that points to the lower left.
fn crayon_icon(painter: &Painter, at: Pos2, scale: f32, colour: Color32, ink: Color32) {
    let line = Stroke::new(1.5 * scale, ink);
    let shape = |points: &[[f32; 2]]| {
        points
            .iter()
            .map(|&[x, y]| at + scale * vec2(x, y))
            .collect()
    };
    let stem = shape(&[[-4.0, -1.0], [6.0, -11.0], [11.0, -6.0], [1.0, 4.0]]);
    painter.add(Shape::convex_polygon(stem, colour, line));
    let tip = shape(&[[-4.0, -1.0], [1.0, 4.0], [-9.0, 9.0]]);
    painter.add(Shape::convex_polygon(tip, colour, line));
}

/// Returns the height of the crayons in a portrait window [points].
pub(super) fn crayons_height(finger: f32) -> f32 {
    Stuff::ALL.len().div_ceil(CRAYON_COLUMNS) as f32 * (finger + GAP) - GAP
}

/// Shows the crayons as fat sticks. The chosen one sticks out.
pub(super) fn crayons(game: &mut Game, ui: &mut Ui, rect: Rect) {
    let theme = game.theme();
    let columns = match rect.height() > rect.width() {
        true => 1,
        false => CRAYON_COLUMNS,
    };
    let rows = Stuff::ALL.len().div_ceil(columns) as f32;
    let step = vec2(
        (rect.width() + GAP) / columns as f32,
        ((rect.height() + GAP) / rows).min(CRAYON),
    );
    for (place, stuff) in Stuff::ALL.into_iter().enumerate() {
        let number = stuff.number();
        let corner = vec2((place % columns) as f32, (place / columns) as f32);
        let cell = Rect::from_min_size(rect.min + corner * step, step - Vec2::splat(GAP));
        let name = (game.words().stuff)(stuff);
        let is_chosen = game.maker.crayon == number;
        let response = chooser(ui, cell, name, Some(is_chosen));
        let lively = highlight(ui, &response);
        let painter = ui.painter();
        let fill = crayon_colour(game, number);
        draw_crayon(painter, &theme, cell, fill, is_chosen, lively);
        let size = least_letters(ui.ctx()).max(18.0);
        // The label is on the stem of the crayon.
        let room = cell.width() - 26.0 - TIP;
        let galley = fitted(painter, name, size, room, theme.ink);
        let at = cell.left_center() + vec2(12.0, -0.5 * galley.size().y);
        let label = Rect::from_min_size(at, galley.size()).expand2(vec2(4.0, 0.0));
        painter.rect_filled(label, 6.0, theme.card.gamma_multiply(0.82));
        painter.galley(at, galley, theme.ink);
        focus_ring(ui, &response, cell, 12.0, &theme);
        if response.clicked() {
            game.blip(Menu::Confirm);
            game.maker.lift_pen();
            game.maker.crayon = number;
            if game.maker.tool == DrawingTool::Eraser {
                game.maker.tool = DrawingTool::Crayon;
            }
        }
    }
}

/// Draws a crayon into a cell, pointing to the right.
fn draw_crayon(
    painter: &Painter,
    theme: &Theme,
    cell: Rect,
    fill: Color32,
    is_chosen: bool,
    lively: f32,
) {
    let out = if is_chosen { 0.0 } else { 12.0 } - 3.0 * lively;
    let line = Stroke::new(if is_chosen { 3.0 } else { 1.5 }, theme.ink);
    let (right, half) = (cell.right() - out, 0.36 * cell.height());
    let y = cell.center().y;
    let points = vec![
        pos2(cell.left(), y - half),
        pos2(right - TIP, y - half),
        pos2(right, y),
        pos2(right - TIP, y + half),
        pos2(cell.left(), y + half),
    ];
    painter.add(Shape::convex_polygon(points, fill, line));
}

/// Shows undo and redo.
pub(super) fn history(game: &mut Game, ui: &mut Ui, rect: Rect) {
    let words = game.making();
    let side = rect.height().min(0.45 * rect.width());
    let (can_undo, can_redo) = {
        let drawing = game.maker.drawing();
        (drawing.can_undo(), drawing.can_redo())
    };
    for (way, name, is_able) in [(-1.0, words.undo, can_undo), (1.0, words.redo, can_redo)] {
        let at = rect.center() + vec2(way * (0.5 * side + 3.0), 0.0);
        let place = Rect::from_center_size(at, Vec2::splat(side));
        let theme = game.theme();
        if step_button(ui, &theme, place, name, way, is_able) {
            game.blip(Menu::Confirm);
            step(game, way > 0.0);
        }
    }
    let [undoes, redoes] = step_keys(ui);
    if undoes {
        step(game, false);
    }
    if redoes {
        step(game, true);
    }
}

/// Undoes or redoes a step of the drawing.
fn step(game: &mut Game, forward: bool) {
    let maker = &mut game.maker;
    maker.lift_pen();
    maker.picture = None;
    match forward {
        true => maker.drawing_mut().redo(),
        false => maker.drawing_mut().undo(),
    };
}

/// Shows the button for undo (`way` = -1) or redo. Returns whether it is pressed.
pub(in crate::screens) fn step_button(
    ui: &mut Ui,
    theme: &Theme,
    place: Rect,
    name: &str,
    way: f32,
    is_able: bool,
) -> bool {
    let ink = if is_able {
        theme.ink
    } else {
        theme.faint.gamma_multiply(0.5)
    };
    let response = round(ui, theme, place, name, None, |painter, at, scale| {
        turn_back(painter, at, scale, ink, way);
    });
    response.clicked()
}

/// Returns whether the keys for undo and for redo are pressed.
pub(in crate::screens) fn step_keys(ui: &Ui) -> [bool; 2] {
    use egui::{Key, Modifiers};
    ui.input_mut(|input| {
        // First, because Ctrl+Z matches Ctrl+Shift+Z, too.
        let redoes = input.consume_key(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z)
            || input.consume_key(Modifiers::COMMAND, Key::Y);
        [input.consume_key(Modifiers::COMMAND, Key::Z), redoes]
    })
}

/// Draws an arrow that bends back to the left (`way` = -1) or to the right.
fn turn_back(painter: &Painter, at: Pos2, scale: f32, ink: Color32, way: f32) {
    let point = |x: f32, y: f32| at + scale * vec2(way * x, y);
    let arc = (0..=12).map(|k| {
        let angle = std::f32::consts::PI * (k as f32 / 12.0);
        let (sin, cos) = angle.sin_cos();
        point(-1.0 + 7.0 * sin, 2.0 - 6.0 * cos)
    });
    painter.line(arc.collect(), Stroke::new(2.5 * scale, ink));
    let head = [point(10.0, -4.0), point(3.0, -10.0), point(3.0, 2.0)];
    let head = head.map(|at| at - scale * vec2(way * 4.0, 0.0)).to_vec();
    painter.add(Shape::convex_polygon(head, ink, Stroke::NONE));
}

/// Shows the tools in rows: those without a caption, then those with one.
pub(super) fn show(game: &mut Game, ui: &mut Ui, rect: Rect) {
    let theme = game.theme();
    let (plain, captioned) = (Tool::plain(game), Tool::captioned(game));
    let counts = [plain.len(), captioned.len()];
    let size = least_letters(ui.ctx()).max(15.0);
    // Captions are left out where the tools would be too small for fingers.
    let line = 1.4 * size;
    let with_captions = grid(counts, rect.size(), line);
    let has_captions = with_captions.1 >= finger(ui);
    let (line, (columns, side)) = match has_captions {
        true => (line, with_captions),
        false => (0.0, grid(counts, rect.size(), 0.0)),
    };
    let spare = rect.width() - columns as f32 * (side + GAP) + GAP;
    let first = rect.min + vec2(0.5 * spare, 0.0);
    let rows = plain.len().div_ceil(columns);
    let below = first + vec2(0.0, rows as f32 * (side + GAP));
    // Clearing is at the end of its row, where no other button is on the next sheet.
    let clear = rows * columns - 1;
    let in_plain = plain.into_iter().enumerate().map(|(place, tool)| {
        let place = if tool == Tool::Clear { clear } else { place };
        (first, place, side + GAP, tool)
    });
    let captioned = captioned.into_iter().enumerate();
    let in_captioned = captioned.map(|(place, tool)| (below, place, side + GAP + line, tool));
    for (first, place, step, tool) in in_plain.chain(in_captioned) {
        let corner = vec2((place % columns) as f32, (place / columns) as f32);
        let at = first + corner * vec2(side + GAP, step);
        let place = Rect::from_min_size(at, Vec2::splat(side));
        let (name, is_chosen) = (tool.name(game), tool.is_chosen(game));
        let response = round(ui, &theme, place, name, is_chosen, |painter, at, scale| {
            tool.draw(game, painter, at, scale, theme.ink);
        });
        if has_captions {
            let (painter, room) = (ui.painter(), side + GAP);
            let caption = fitted(painter, tool.caption(game), size, room, theme.ink);
            let at = place.center_bottom() - vec2(0.5 * caption.size().x, 0.0);
            painter.galley(at, caption, theme.ink);
        }
        if response.clicked() {
            tool.press(game);
        }
    }
}

/// Returns the number of columns and the side of square tools in a room, as large as possible: a number of tools without a
/// caption, and below them a number of tools with captions of height `line` [points].
fn grid([plain, captioned]: [usize; 2], room: Vec2, line: f32) -> (usize, f32) {
    let side = |columns: usize| {
        let below = captioned.div_ceil(columns);
        let rows = (plain.div_ceil(columns) + below) as f32;
        let high = room.y - line * below as f32;
        let wide = (room.x + GAP) / columns as f32 - GAP;
        wide.min((high + GAP) / rows - GAP).min(2.4 * TOOL)
    };
    let best = (1..=plain.max(1)).max_by(|&a, &b| side(a).total_cmp(&side(b)));
    let columns = best.unwrap_or(1);
    (columns, side(columns).max(20.0))
}

/// Registers a rectangle as a choice with a name, or as a button if `is_chosen` is `None`.
fn chooser(ui: &Ui, rect: Rect, name: &str, is_chosen: Option<bool>) -> Response {
    let response = ui.interact(rect, ui.scope_id().with(name), Sense::click());
    response.widget_info(|| match is_chosen {
        Some(is_chosen) => WidgetInfo::selected(Role::RadioButton, true, is_chosen, name),
        None => WidgetInfo::labeled(Role::Button, true, name),
    });
    response
}

/// Shows a round button with a sign, which `draw` draws at a position in a scale. `is_chosen` tells whether a choice is
/// made; `None` for a button that acts at once.
pub(in crate::screens) fn round(
    ui: &mut Ui,
    theme: &Theme,
    rect: Rect,
    name: &str,
    is_chosen: Option<bool>,
    draw: impl FnOnce(&Painter, Pos2, f32),
) -> Response {
    let response = chooser(ui, rect, name, is_chosen);
    let is_chosen = is_chosen == Some(true);
    let lively = highlight(ui, &response);
    let painter = ui.painter();
    let (middle, radius) = (rect.center(), 0.5 * rect.width() + lively);
    let fill = if is_chosen { theme.card } else { theme.button };
    painter.circle_filled(middle, radius, fill);
    if is_chosen {
        painter.circle_stroke(middle, radius - 1.5, Stroke::new(3.0, theme.accent));
    }
    draw(painter, middle, rect.width() / TOOL);
    focus_ring(ui, &response, rect, radius, theme);
    let label = egui::RichText::new(name).size(least_letters(ui.ctx()).max(17.0));
    if is_on(ui, &response) {
        let tooltip = Tooltip::always_open(ui.ctx().clone(), ui.layer_id(), response.id, &response);
        tooltip.gap(6.0).show(|ui| ui.label(label));
        return response;
    }
    response.on_hover_text(label)
}
