//! The room in the editor: items to select, drag, stretch and turn.

use super::super::hud;
use super::super::widgets::words;
use crate::game::{Drag, EditorPart, GRID, Game, TURN};
use app_shell::View;
use app_shell::widgets::{ButtonStyle, button, is_on};
use egui::text::LayoutJob;
use egui::{
    Align, Color32, CursorIcon, EventFilter, Id, Key, PointerButton, Pos2, Rect, Response, Role,
    Sense, Shape, Stroke, StrokeKind, Ui, UiBuilder, Vec2, WidgetInfo, pos2, vec2,
};
use fuwafuwa::Vec3;
use fuwafuwa_scenes::Scene;
use tamaire_maker::items::snapped;
use tamaire_maker::items::{self, Item};
use tamaire_sound::Menu;

/// Least side of the place of an item that takes presses [points].
const LEAST: f32 = 26.0;
/// Radius of a handle [points].
const HANDLE: f32 = 9.0;
/// Least distance between two handles at opposite corners [points].
const APART: f32 = 84.0;
/// Distance of the handle for turning above the selection [points].
const ABOVE: f32 = 34.0;
/// Turn of the camera by a drag [rad/point].
const ORBIT: f32 = 0.006;
/// Turn of the camera from which on a button turns it back [rad].
const TURNED: f32 = 0.02;
/// Distance within which things align with each other [points].
const REACH: f32 = 7.0;

pub(super) fn show(game: &mut Game, ui: &mut Ui, room: Rect) {
    let Some(view) = game.bout.view else {
        return;
    };
    floor(game, ui, room, &view);
    let scene = game.maker.draft.scene();
    let mut places: Vec<(Item, Rect)> = items::items(scene)
        .into_iter()
        .filter_map(|item| {
            let [low, high] = items::bounds(scene, item)?;
            let place = on_screen(&view, low, high).intersect(room.expand(LEAST));
            let is_seen = place.width() >= 0.0 && place.height() >= 0.0;
            is_seen.then(|| (item, place.expand2(lacking(place.size()))))
        })
        .collect();
    // The smallest items come last, so that they are above the others.
    places.sort_by(|a, b| b.1.area().total_cmp(&a.1.area()).then(a.0.cmp(&b.0)));
    let numbers = items::numbers(scene);
    for (item, place) in places {
        let name = game.numbered_name(item, numbers[&item]);
        one(game, ui, &view, (item, &name), place);
    }
    if view.space.is_some() {
        look_around(game, ui, room);
    }
    handles(game, ui, &view);
    guides(game, ui, room, &view);
    frame(game, ui, &view);
    problem(game, ui, room);
    hint(game, ui, room, view.space.is_some());
    // A dragged thing that has left the room has no widget that could end its drag.
    if !ui.input(|input| input.pointer.any_down()) {
        game.end_drag();
    }
}

/// Turns the camera in 3D with a drag of the secondary button or of two fingers over the room. A button turns it back.
fn look_around(game: &mut Game, ui: &mut Ui, room: Rect) {
    let (by, has_fingers) = ui.input(|input| {
        let pointer = &input.pointer;
        let is_over = pointer.latest_pos().is_some_and(|at| room.contains(at));
        let turns = is_over && pointer.button_down(PointerButton::Secondary);
        let fingers = input.multi_touch().map(|touch| touch.translation_delta);
        let by = fingers.unwrap_or(if turns { pointer.delta() } else { Vec2::ZERO });
        (by, fingers.is_some())
    });
    if has_fingers {
        game.drop_drag();
    }
    game.bout.camera.orbit(-ORBIT * by.x, ORBIT * by.y);
    let [right, up] = game.bout.camera.orbit_angles();
    if right.hypot(up) > TURNED {
        let (theme, scale) = (game.theme(), hud::full_scale(game, ui));
        let size = scale * vec2(108.0, 44.0);
        let place = Rect::from_min_size(room.right_top() + vec2(-size.x - 8.0, 8.0), size);
        let text = game.making().front_view;
        let shown = ui.scope_builder(UiBuilder::new().max_rect(place), |ui| {
            button(ui, &theme, text, size, ButtonStyle::Other).clicked()
        });
        if shown.inner {
            game.blip(Menu::Confirm);
            game.bout.camera.return_to_front();
        }
    }
}

/// Tells at the lower edge of the room how things are moved by keys, or in 3D.
fn hint(game: &Game, ui: &Ui, room: Rect, is_space: bool) {
    let words = game.making();
    let has_touch = ui.input(|input| input.any_touches() || input.has_touch_screen());
    let editor = &game.maker.editor;
    let marked = { items::items(game.maker.draft.scene()).into_iter() }.find(|&item| {
        let response = ui.ctx().read_response(item_id(item));
        response.is_some_and(|response| is_on(ui, &response))
    });
    let text = match marked {
        Some(item) if !editor.selection.contains(&item) => words.how_marked,
        Some(_) if editor.moves_by_keys => words.how_held[usize::from(is_space)],
        Some(_) => words.how_selected,
        None if is_space && editor.selection.is_empty() => {
            words.how_in_space[usize::from(has_touch)]
        }
        None if selected_tie(game).is_some() => words.how_tied,
        None => return,
    };
    let theme = game.theme();
    let scale = hud::full_scale(game, ui);
    let font = egui::FontId::proportional(15.0 * scale);
    let mut job = LayoutJob::simple(text.to_string(), font, theme.ink, room.width() - 40.0);
    job.halign = Align::Center;
    let galley = ui.painter().layout_job(job);
    let size = galley.size();
    let place = Rect::from_center_size(
        pos2(room.center().x, room.bottom() - 0.5 * size.y - 8.0),
        size,
    );
    ui.painter().rect_filled(
        place.expand2(vec2(12.0, 5.0)),
        12.0,
        theme.card.gamma_multiply(0.8),
    );
    let at = place.center() - galley.rect.center().to_vec2();
    ui.painter().galley(at, galley, theme.ink);
}

/// Returns the id of the widget of an item.
fn item_id(item: Item) -> Id {
    Id::unique(("item", item))
}

/// Gives the keyboard focus to an item.
pub(super) fn focus(ui: &Ui, item: Item) {
    ui.memory_mut(|memory| memory.request_focus(item_id(item)));
}

/// Returns the box on the screen around a box in the world.
fn on_screen(view: &View, low: Vec3, high: Vec3) -> Rect {
    let mut place = Rect::NOTHING;
    for corner in 0..8u8 {
        let pick = |axis: u8| corner >> axis & 1 == 1;
        let at = Vec3::new(
            if pick(0) { high.x } else { low.x },
            if pick(1) { high.y } else { low.y },
            if pick(2) { high.z } else { low.z },
        );
        place.extend_with(view.to_screen(at));
    }
    place
}

/// Returns by how much a place has to grow on each side to take presses.
fn lacking(size: Vec2) -> Vec2 {
    (0.5 * (Vec2::splat(LEAST) - size)).max(Vec2::ZERO)
}

/// Returns the point of the world below the pointer, at the height of the selection in 3D [m].
fn under(game: &Game, view: &View, at: Pos2) -> Vec3 {
    let middle = game.selection_box();
    let height = middle.map_or(0.0, |[low, high]| 0.5 * (low.y + high.y));
    view.to_world(at, height)
}

/// Whether a drag in 3D moves things up and down instead of along the floor.
fn lifts(game: &Game, ui: &Ui) -> bool {
    game.maker.editor.lifts || ui.input(|input| input.modifiers.shift)
}

/// Returns the way up or down of a drag in 3D to a point of the screen [m].
fn lifted(game: &Game, ui: &Ui, view: &View, at: Pos2) -> Vec3 {
    let from = ui.input(|input| input.pointer.press_origin()).unwrap_or(at);
    let middle = game.selection_box().map(|[low, high]| 0.5 * (low + high));
    let scale = middle.map_or(view.scale, |middle| view.scale_at(middle));
    (from.y - at.y) / scale.max(1.0) * Vec3::Y
}

/// The empty part of the room: a press selects nothing, a drag selects what is in a frame.
fn floor(game: &mut Game, ui: &mut Ui, room: Rect, view: &View) {
    let floor = ui.interact(
        room,
        Id::unique("floor of the editor"),
        // The floor takes no keyboard focus.
        Sense::CLICK | Sense::DRAG,
    );
    if floor.clicked() {
        game.select_nothing();
    }
    if floor.drag_started_by(PointerButton::Primary)
        && let Some(at) = floor.interact_pointer_pos()
    {
        let from = ui.input(|input| input.pointer.press_origin()).unwrap_or(at);
        game.maker.editor.drag = Some(Drag::Frame(view.to_world(from, 0.0)));
    }
    follow(game, ui, view, &floor);
}

/// An item: a press selects it, a drag moves the selection.
fn one(game: &mut Game, ui: &mut Ui, view: &View, (item, name): (Item, &str), place: Rect) {
    let response = ui.interact(place, item_id(item), Sense::click_and_drag());
    let is_selected = game.maker.editor.is_selected(item);
    response.widget_info(|| WidgetInfo::selected(Role::Button, true, is_selected, name));
    let ink = game.theme().accent;
    let has_keys = is_on(ui, &response);
    if has_keys {
        let rim = Stroke::new(5.0, game.theme().ink);
        ui.painter()
            .rect_stroke(place.expand(4.0), 6.0, rim, StrokeKind::Outside);
    }
    if is_selected && has_keys && game.maker.editor.moves_by_keys {
        // Dashed: the arrow keys move this item.
        let line = Stroke::new(4.0, ink);
        let corners = [
            place.left_top(),
            place.right_top(),
            place.right_bottom(),
            place.left_bottom(),
            place.left_top(),
        ];
        ui.painter()
            .extend(Shape::dashed_line(&corners, line, 10.0, 7.0));
    } else if is_selected {
        let rim = Stroke::new(2.5, ink);
        ui.painter()
            .rect_stroke(place, 4.0, rim, StrokeKind::Outside);
    } else if response.hovered() {
        let rim = Stroke::new(2.0, ink.gamma_multiply(0.5));
        ui.painter()
            .rect_stroke(place, 4.0, rim, StrokeKind::Outside);
    }
    if let Some(text) = switch_sign(game, item) {
        let theme = game.theme();
        let radius = 11.0;
        ui.painter().circle(
            place.center(),
            radius,
            theme.card,
            Stroke::new(2.0, theme.ink),
        );
        words(ui, place.center(), &text, 15.0, theme.ink);
    }
    if response.hovered() {
        ui.ctx().set_cursor_icon(CursorIcon::Grab);
    }
    if response.clicked() {
        let (adds, is_alone) = ui.input(|input| {
            let modifiers = input.modifiers;
            (modifiers.shift || modifiers.command, modifiers.alt)
        });
        let before = game.maker.editor.is_adding;
        // With keys, a second press takes hold of a selected item.
        let is_by_pointer = response.clicked_by(PointerButton::Primary)
            && response.interact_pointer_pos().is_some();
        if is_selected && !is_by_pointer {
            game.maker.editor.moves_by_keys ^= true;
        } else {
            game.maker.editor.is_adding |= adds;
            match is_alone {
                true => game.select_alone(item),
                false => game.select(item),
            }
            game.maker.editor.is_adding = before;
            game.maker.editor.moves_by_keys = is_by_pointer;
        }
        response.request_focus();
    }
    if response.drag_started_by(PointerButton::Primary) {
        game.select_to_drag(item);
        let from = ui.input(|input| input.pointer.press_origin());
        if let Some(from) = from {
            game.maker.editor.drag = Some(Drag::Move(under(game, view, from)));
        }
    }
    follow(game, ui, view, &response);
    if is_selected && response.has_focus() {
        by_arrows(game, ui, &response);
    }
}

/// Returns the number of a button, or that of the button that moves an obstacle or opens a joint.
fn switch_sign(game: &Game, item: Item) -> Option<String> {
    let scene = game.maker.draft.scene();
    let number = match item {
        Item::Switch(index) => Some(index + 1),
        Item::Obstacle(index) => scene.obstacle.get(index)?.switch,
        Item::Joint(index) => scene.joint.get(index)?.switch,
        _ => None,
    };
    number.map(|number| number.to_string())
}

/// Moves the selection with the arrow keys, while the player holds a selected item with the keys. Escape lets it go.
fn by_arrows(game: &mut Game, ui: &Ui, response: &Response) {
    let moves = game.maker.editor.moves_by_keys;
    let filter = EventFilter {
        tab: false,
        horizontal_arrows: moves,
        vertical_arrows: moves,
        escape: moves,
    };
    ui.memory_mut(|memory| memory.set_focus_lock_filter(response.id, filter));
    if !moves {
        return;
    }
    let count = |key| ui.input(|input| input.num_presses(key)) as f32;
    let by = vec2(
        count(Key::ArrowRight) - count(Key::ArrowLeft),
        count(Key::ArrowUp) - count(Key::ArrowDown),
    );
    let deep = count(Key::PageDown) - count(Key::PageUp);
    if by != Vec2::ZERO || deep != 0.0 {
        game.nudge(GRID * Vec3::new(by.x, by.y, deep));
    }
    if ui.input(|input| input.key_pressed(Key::Escape)) {
        game.maker.editor.moves_by_keys = false;
    }
}

/// Goes on with the drag that began on a widget.
fn follow(game: &mut Game, ui: &Ui, view: &View, response: &Response) {
    if response.drag_stopped() {
        if let (Some(drag @ Drag::End(..)), Some(at)) =
            (game.maker.editor.drag, response.interact_pointer_pos())
        {
            let mut before = game.maker.draft.scene_before().clone();
            if !tie(game, ui, view, drag, at)(&mut before) {
                game.notify(game.making().needs_thing.to_string());
            }
        }
        if let (Some(Drag::Frame(from)), Some(at)) =
            (game.maker.editor.drag, response.interact_pointer_pos())
        {
            select_in(game, view, Rect::from_two_pos(view.to_screen(from), at));
        }
        game.end_drag();
        return;
    }
    let (true, Some(at), Some(drag)) = (
        response.dragged(),
        response.interact_pointer_pos(),
        game.maker.editor.drag,
    ) else {
        return;
    };
    let selection = game.maker.editor.selection.clone();
    let snaps = game.maker.editor.snaps && !ui.input(|input| input.modifiers.alt);
    match drag {
        Drag::Frame(_) => {}
        Drag::Move(from) => {
            let mut by = match view.space.is_some() && lifts(game, ui) {
                true => lifted(game, ui, view, at),
                false => under(game, view, at) - from,
            };
            game.maker.editor.guides.clear();
            if snaps {
                let before = game.maker.draft.scene_before();
                let reach = REACH / view.scale.max(1.0);
                let (aligned, guides) = items::aligned(before, &selection, by, reach);
                by = match guides.is_empty() {
                    true => snapped(by, GRID),
                    false => aligned,
                };
                game.maker.editor.guides = guides;
            }
            let by = game.within_view(by);
            game.preview_level(|scene| items::translate(scene, &selection, by));
        }
        Drag::Stretch(about, handle) => {
            let now = under(game, view, at);
            let factors = Vec3::from([0, 1, 2].map(|axis| {
                let (before, after) = (handle[axis] - about[axis], now[axis] - about[axis]);
                let share = if before.abs() < 1e-3 {
                    1.0
                } else {
                    after / before
                };
                share.clamp(0.05, 20.0)
            }));
            game.preview_level(|scene| items::stretch(scene, &selection, about, factors));
        }
        Drag::End(..) => {
            let tie = tie(game, ui, view, drag, at);
            game.preview_level(|scene| {
                tie(scene);
            });
        }
        Drag::Turn(about, handle) => {
            let now = under(game, view, at);
            let angle = |point: Vec3| (point.y - about.y).atan2(point.x - about.x);
            let mut turn = angle(now) - angle(handle);
            if snaps {
                turn = (turn / TURN).round() * TURN;
            }
            let mut turned = Vec::new();
            game.preview_level(|scene| {
                turned = items::rotate(scene, &selection, about, Vec3::Z, turn);
            });
            game.maker.editor.turned = Some(turned);
        }
    }
}

/// Selects all items that are in a frame of the screen.
fn select_in(game: &mut Game, view: &View, frame: Rect) {
    let scene = game.maker.draft.scene();
    let is_in = |item: &Item| {
        let place = items::bounds(scene, *item).map(|[low, high]| on_screen(view, low, high));
        place.is_some_and(|place| frame.contains(place.center()))
    };
    let found: Vec<Item> = items::items(scene).into_iter().filter(is_in).collect();
    if found.is_empty() {
        return game.select_nothing();
    }
    game.maker.editor.selection = found;
    game.maker.editor.part = EditorPart::Selection;
}

/// Returns the rope or spring that is selected alone, and the positions of its ends [m].
fn selected_tie(game: &Game) -> Option<(usize, [Vec3; 2])> {
    let &[item @ Item::Joint(joint)] = &game.maker.editor.selection[..] else {
        return None;
    };
    let ends = items::ends_of(game.maker.draft.scene(), item)?;
    Some((joint, ends))
}

/// Returns the change that ties the dragged end of a rope or spring to what is below the pointer, or fixes it in the room. It
/// returns whether that is possible.
fn tie(
    game: &Game,
    ui: &Ui,
    view: &View,
    drag: Drag,
    at: Pos2,
) -> impl Fn(&mut Scene) -> bool + use<> {
    let Drag::End(joint, end, from) = drag else {
        unreachable!("only a drag of an end ties it");
    };
    let scene = game.maker.draft.scene_before();
    let [low, high] = scene.view.map(Vec3::from);
    let most = |eye: Vec3| eye.distance(0.5 * (low + high)) + low.distance(high);
    let hit = match view.ray(at) {
        Some(ray) => items::first_hit(scene, ray, most(ray.0)),
        None => Some(view.to_world(at, 0.0)).filter(|&to| items::holder_at(scene, to).is_some()),
    };
    let free = || {
        let origin = ui.input(|input| input.pointer.press_origin()).unwrap_or(at);
        let to = match view.space.is_some() && lifts(game, ui) {
            true => from + (origin.y - at.y) / view.scale_at(from).max(1.0) * Vec3::Y,
            false => view.to_world(at, from.y),
        };
        let snaps = game.maker.editor.snaps && !ui.input(|input| input.modifiers.alt);
        if snaps { snapped(to, GRID) } else { to }
    };
    let to = hit.unwrap_or_else(free);
    move |scene| items::tie_end(scene, joint, end, to)
}

/// Shows the handles of the selection. Those of a rope or spring are its ends.
fn handles(game: &mut Game, ui: &mut Ui, view: &View) {
    // While an end is dragged, its handle follows it.
    let Some((joint, ends)) = selected_tie(game) else {
        return frame_handles(game, ui, view);
    };
    let ink = game.theme().accent;
    for (end, at) in ends.into_iter().enumerate() {
        let name = ("end", end as i32, 0);
        let drag = Drag::End(joint, end, at);
        one_handle(game, ui, view, (name, view.to_screen(at)), drag, ink);
    }
}

/// Shows the handles around the selection in 2D: corners stretch, sides stretch along one axis, the one above turns.
fn frame_handles(game: &mut Game, ui: &mut Ui, view: &View) {
    let Some([low, high]) = game.selection_box().filter(|_| view.space.is_none()) else {
        return;
    };
    let middle = 0.5 * (low + high);
    let ink = game.theme().accent;
    let along = |share: f32, axis: usize| low[axis] + share * (high[axis] - low[axis]);
    // The handles are outside of the selection, and apart, so that a thin thing can be taken between them.
    let tight = on_screen(view, low, high).expand(1.5 * HANDLE);
    let spare = (0.5 * (Vec2::splat(APART) - tight.size())).max(Vec2::ZERO);
    let frame = tight.expand2(spare);
    for (x, y) in [
        (0.0, 0.0),
        (1.0, 0.0),
        (0.0, 1.0),
        (1.0, 1.0),
        (0.5, 0.0),
        (0.5, 1.0),
        (0.0, 0.5),
        (1.0, 0.5),
    ] {
        let at = frame.lerp_inside(vec2(x, 1.0 - y));
        let under = view.to_world(at, 0.0);
        // A handle in the middle of a side leaves the other axis as it is.
        let handle = Vec3::new(
            if x == 0.5 { middle.x } else { under.x },
            if y == 0.5 { middle.y } else { under.y },
            middle.z,
        );
        let opposite = Vec3::new(along(1.0 - x, 0), along(1.0 - y, 1), middle.z);
        let name = ("handle", (2.0 * x) as i32, (2.0 * y) as i32);
        let drag = Drag::Stretch(opposite, handle);
        one_handle(game, ui, view, (name, at), drag, ink);
    }
    let at = frame.center_top() - vec2(0.0, ABOVE);
    let line = [frame.center_top(), at];
    ui.painter().line_segment(line, Stroke::new(2.0, ink));
    let drag = Drag::Turn(middle, view.to_world(at, 0.0));
    one_handle(game, ui, view, (("turn", 0, 0), at), drag, ink);
}

fn one_handle(
    game: &mut Game,
    ui: &mut Ui,
    view: &View,
    (name, at): ((&str, i32, i32), Pos2),
    drag: Drag,
    ink: Color32,
) {
    let place = Rect::from_center_size(at, Vec2::splat(2.4 * HANDLE));
    let response = ui.interact(place, Id::unique(name), Sense::DRAG);
    let radius = if response.hovered() {
        HANDLE
    } else {
        0.75 * HANDLE
    };
    let rim = Stroke::new(2.5, ink);
    ui.painter().circle(at, radius, Color32::WHITE, rim);
    if response.drag_started_by(PointerButton::Primary) {
        game.maker.editor.drag = Some(drag);
    }
    follow(game, ui, view, &response);
}

/// Draws the lines on which the dragged things align.
fn guides(game: &Game, ui: &Ui, room: Rect, view: &View) {
    if !matches!(game.maker.editor.drag, Some(Drag::Move(_))) {
        return;
    }
    let line = Stroke::new(1.5, game.theme().accent.gamma_multiply(0.7));
    for guide in &game.maker.editor.guides {
        let mut at = Vec3::ZERO;
        at[guide.axis] = guide.at;
        let at = view.to_screen(at);
        let ends = match guide.axis {
            0 => [pos2(at.x, room.top()), pos2(at.x, room.bottom())],
            1 => [pos2(room.left(), at.y), pos2(room.right(), at.y)],
            _ => continue,
        };
        ui.painter().add(Shape::dashed_line(&ends, line, 6.0, 5.0));
    }
}

/// Draws the frame that selects what is in it.
fn frame(game: &Game, ui: &Ui, view: &View) {
    let Some(Drag::Frame(from)) = game.maker.editor.drag else {
        return;
    };
    let Some(at) = ui.input(|input| input.pointer.latest_pos()) else {
        return;
    };
    let place = Rect::from_two_pos(view.to_screen(from), at);
    let ink = game.theme().accent;
    let (fill, rim) = (ink.gamma_multiply(0.12), Stroke::new(1.5, ink));
    ui.painter().rect(place, 2.0, fill, rim, StrokeKind::Middle);
}

/// Tells why the level cannot be played.
fn problem(game: &Game, ui: &Ui, room: Rect) {
    let Some(problem) = &game.maker.editor.problem else {
        return;
    };
    let theme = game.theme();
    let font = egui::FontId::proportional(18.0);
    let wide = room.width() - 40.0;
    let galley = { ui.painter() }.layout(problem.clone(), font, theme.accent, wide);
    let at = pos2(room.center().x - 0.5 * galley.size().x, room.top() + 8.0);
    let place = Rect::from_min_size(at, galley.size()).expand(8.0);
    ui.painter().rect_filled(place, 8.0, theme.card);
    ui.painter().galley(at, galley, theme.accent);
}
