//! Large, round widgets of the game. All of them can be reached with a pad.

use crate::game::Game;
use crate::platform::HAS_DIALOG;
use app_shell::Theme;
use app_shell::theme::PAGE;
use app_shell::widgets::{
    ButtonStyle, FADE, LETTERS, RING, button, focus_ring, note_hovered, plain_button,
};
use egui::{
    Align, Align2, Color32, FocusDirection, FontId, Id, Key, Layout, Pos2, Rect, Response, Role,
    Sense, Stroke, TextEdit, Ui, Vec2, WidgetInfo, pos2, vec2,
};
use tamaire_sound::Menu;

/// Margin between the window and a page [points].
pub const EDGE: Vec2 = vec2(28.0, 22.0);
/// Minimum width of a row with the name beside its widget [points]; in a narrower row the name is above.
const LEAST_ROW: f32 = 560.0;

/// Width and height of a button that a finger hits [points without the zoom].
const FINGER: f32 = 44.0;
/// Smallest zoom at which a button is still as large as a finger.
const LEAST_ZOOM: f32 = 0.6;

/// Font size of a headline [points].
const TITLE: f32 = 38.0;

/// Action of a button.
pub type Act = fn(&mut Game);

/// Returns the least width and height of a button that a finger hits [points].
pub fn finger(ui: &Ui) -> f32 {
    FINGER / ui.ctx().zoom_factor().clamp(LEAST_ZOOM, 1.0)
}

/// Covers the world behind a menu with translucent paper.
pub fn dim_background(ui: &Ui, strength: u8) {
    ui.painter()
        .rect_filled(ui.max_rect(), 0.0, PAGE.gamma_multiply_u8(strength));
}

/// Draws text centred at `at`.
pub fn words(ui: &Ui, at: Pos2, text: &str, size: f32, colour: Color32) {
    ui.painter().text(
        at,
        Align2::CENTER_CENTER,
        text,
        FontId::proportional(size),
        colour,
    );
}

/// Shows the buttons of a menu below each other, with the main one first. Returns the chosen action.
pub fn menu(ui: &mut Ui, theme: &Theme, size: Vec2, options: &[(&str, Act)]) -> Option<Act> {
    let mut wanted = None;
    for (index, &(text, act)) in options.iter().enumerate() {
        let response = button(ui, theme, text, size, ButtonStyle::of(index == 0));
        if index == 0 {
            focus_first(ui, &response);
        }
        if response.clicked() {
            wanted = Some(act);
        }
        ui.add_space(10.0);
    }
    wanted
}

/// Performs the chosen action of a menu, or `on_escape` if the Escape key was pressed.
pub fn perform(game: &mut Game, ui: &Ui, wanted: Option<Act>, on_escape: Act) {
    let is_escape = ui.input(|input| input.key_pressed(Key::Escape));
    if let Some(act) = is_escape.then_some(on_escape).or(wanted) {
        game.blip(Menu::Confirm);
        act(game);
    }
}

/// Focuses a widget if nothing has the focus, so that players can navigate from there with a pad alone.
pub fn focus_first(ui: &Ui, response: &Response) {
    let left: Option<Id> = ui.data(|data| data.get_temp(left_field_id()));
    let left = left.filter(|&field| ui.ctx().read_response(field).is_some());
    let focused = ui.memory(|memory| memory.focused());
    let (Some(field), true) = (left, focused.is_none_or(|focused| focused == response.id)) else {
        ui.data_mut(|data| data.remove::<Id>(left_field_id()));
        if focused.is_none() {
            response.request_focus();
        }
        return;
    };
    if focused.is_some() {
        // Keys go on from the field.
        ui.memory_mut(|memory| memory.request_focus(field));
        ui.data_mut(|data| data.remove::<Id>(left_field_id()));
    }
}

/// Id under which the text field is stored that was left with Enter. As long as nothing else gets the focus, no widget has it.
fn left_field_id() -> Id {
    Id::unique("text field that was left with Enter")
}

/// Shows contents on a white card.
pub fn card<R>(ui: &mut Ui, theme: &Theme, contents: impl FnOnce(&mut Ui) -> R) -> R {
    let frame = egui::Frame::new()
        .fill(theme.card)
        .corner_radius(28.0)
        .inner_margin(24.0)
        .shadow(egui::Shadow {
            offset: [0, 6],
            blur: 24,
            spread: 0,
            color: Color32::from_black_alpha(40),
        });
    frame.show(ui, contents).inner
}

/// Shows a slider with its name on the left and its value in percent on the right. The left and right arrow keys
/// move it while it has the focus.
pub fn slider(
    ui: &mut Ui,
    theme: &Theme,
    name: &str,
    value: &mut f32,
    low: f32,
    high: f32,
    step: f32,
) -> Response {
    let percent = |value: f32| format!("{:.0} %", 100.0 * value);
    slider_with(ui, theme, name, value, [low, high, step], percent)
}

/// Shows a slider as [`slider`] does, with a value from the first to the second number of `range` in steps of the
/// third one, and the text of the value on the right.
pub fn slider_with(
    ui: &mut Ui,
    theme: &Theme,
    name: &str,
    value: &mut f32,
    range: [f32; 3],
    text: impl Fn(f32) -> String,
) -> Response {
    let [low, high, step] = range;
    row(ui, theme, name, |ui| {
        let width = (ui.available_width() - 84.0).max(60.0);
        let (mut response, asked) = track(ui, theme, name, *value, [low, high], step, width);
        if let Some(asked) = asked {
            let chosen = (step * (asked / step).round()).clamp(low, high);
            if chosen != *value {
                *value = chosen;
                response.mark_changed();
            }
        }
        let text = text(*value);
        let font = FontId::proportional(20.0);
        let (rect, _) = ui.allocate_exact_size(vec2(74.0, 36.0), Sense::hover());
        ui.painter().text(
            rect.right_center(),
            Align2::RIGHT_CENTER,
            text,
            font,
            theme.ink,
        );
        response
    })
}

/// Shows the track and the knob of a slider, `width` points wide. Returns the value that the player asks for in
/// this frame by pointer or keys, if any.
pub fn track(
    ui: &mut Ui,
    theme: &Theme,
    name: &str,
    value: f32,
    [low, high]: [f32; 2],
    step: f32,
    width: f32,
) -> (Response, Option<f32>) {
    use egui::accesskit::Action;
    let (rect, response) = ui.allocate_exact_size(vec2(width, 36.0), Sense::click_and_drag());
    note_hovered(ui, &response);
    let track = Rect::from_center_size(rect.center(), vec2(rect.width() - 28.0, 12.0));
    let mut asked = response.interact_pointer_pos().map(|pointer| {
        let share = ((pointer.x - track.left()) / track.width()).clamp(0.0, 1.0);
        low + (high - low) * share
    });
    let has_focus = response.has_focus();
    if has_focus {
        let filter = egui::EventFilter {
            horizontal_arrows: true,
            ..Default::default()
        };
        ui.memory_mut(|memory| memory.set_focus_lock_filter(response.id, filter));
    }
    let presses = ui.input(|input| {
        let pressed = |key| match has_focus {
            true => input.num_presses(key) as f32,
            false => 0.0,
        };
        let requests = |action| input.num_accesskit_action_requests(response.id, action) as f32;
        pressed(Key::ArrowRight) - pressed(Key::ArrowLeft) + requests(Action::Increment)
            - requests(Action::Decrement)
    });
    if presses != 0.0 {
        asked = Some((asked.unwrap_or(value) + step * presses).clamp(low, high));
    }
    let shown = asked.unwrap_or(value);
    response.widget_info(|| WidgetInfo::slider(true, f64::from(shown), name));
    let share = ((shown - low) / (high - low)).clamp(0.0, 1.0);
    let knob = pos2(track.left() + share * track.width(), track.center().y);
    let painter = ui.painter();
    painter.rect_filled(track, 6.0, theme.button);
    let done = Rect::from_min_max(track.min, pos2(knob.x, track.bottom()));
    painter.rect_filled(done, 6.0, theme.accent);
    painter.circle(knob, 14.0, theme.card, Stroke::new(4.0, theme.accent));
    focus_ring(ui, &response, rect, 18.0, theme);
    (response, asked)
}

/// Shows a choice between a few visible options; returns whether it changed.
pub fn choice<T: Copy + PartialEq>(
    ui: &mut Ui,
    theme: &Theme,
    name: &str,
    value: &mut T,
    options: &[(T, &str)],
) -> bool {
    const HIGH: f32 = 44.0;
    let mut changed = false;
    row(ui, theme, name, |ui| {
        // All buttons get the width of the widest one, so that nothing moves when another option is chosen.
        let mark = |text: &str| format!("● {text}");
        let measure = |text: &str| {
            let font = FontId::proportional(LETTERS * HIGH);
            ui.painter()
                .layout_no_wrap(mark(text), font, theme.ink)
                .size()
                .x
        };
        let width = options
            .iter()
            .map(|(_, text)| measure(text))
            .fold(60.0, f32::max)
            + 36.0;
        ui.spacing_mut().item_spacing.x = 2.0 * RING;
        // Narrower buttons rather than a wider card, if all options are in one row.
        let count = options.len() as f32;
        let room = (ui.available_width() - (count - 1.0) * 2.0 * RING) / count;
        let width = match ui.layout().main_wrap() {
            true => width,
            false => width.min(room),
        };
        for &(option, text) in options {
            let is_chosen = *value == option;
            // A dot marks the chosen option, since colour alone would not be visible to everyone.
            let marked = match is_chosen {
                true => mark(text),
                false => text.to_string(),
            };
            let weight = ButtonStyle::of(is_chosen);
            let response = plain_button(ui, theme, &marked, vec2(width, HIGH), weight);
            let role = Role::RadioButton;
            let told = format!("{name}: {text}");
            response.widget_info(|| WidgetInfo::selected(role, true, is_chosen, &told));
            if response.clicked() {
                changed = *value != option;
                *value = option;
            }
        }
    });
    changed
}

/// Shows a row with a name on the left and its widget on the right.
pub fn row<R>(ui: &mut Ui, theme: &Theme, name: &str, contents: impl FnOnce(&mut Ui) -> R) -> R {
    let all = ui.available_width();
    // In a narrow row the name is above its widget.
    let is_above = all < LEAST_ROW;
    let width = if is_above { all } else { 0.4 * all };
    // A long name takes two lines, so that all names have letters of one size.
    let font = FontId::proportional(21.0);
    let galley = { ui.painter() }.layout(name.to_string(), font, theme.ink, width - 8.0);
    let head = |ui: &mut Ui, height: f32| {
        let height = height.max(galley.size().y);
        let (rect, _) = ui.allocate_exact_size(vec2(width, height), Sense::hover());
        let at = rect.left_center() - vec2(0.0, 0.5 * galley.size().y);
        ui.painter().galley(at, galley.clone(), theme.ink);
    };
    if is_above {
        head(ui, 30.0);
        return ui.horizontal_wrapped(contents).inner;
    }
    ui.horizontal(|ui| {
        head(ui, 44.0);
        contents(ui)
    })
    .inner
}

/// Shows a line of text with a name that can be edited, at most `most` characters. Control characters are left out.
pub fn text_field(
    ui: &mut Ui,
    theme: &Theme,
    name: &str,
    value: &mut String,
    most: usize,
) -> Response {
    let response = row(ui, theme, name, |ui| {
        let size = vec2(ui.available_width().min(380.0), finger(ui));
        let margin = egui::Margin::symmetric(12, 6);
        let frame = egui::Frame::new().fill(theme.button).corner_radius(12.0);
        ui.visuals_mut().text_cursor.stroke = Stroke::new(2.5, theme.ink);
        let edit = TextEdit::singleline(value)
            .char_limit(most)
            .font(FontId::proportional(22.0))
            .text_color(theme.ink)
            .frame(frame.inner_margin(margin))
            .align(Align2::LEFT_CENTER);
        ui.add_sized(size, edit)
    });
    response.widget_info(|| WidgetInfo {
        label: Some(name.into()),
        ..WidgetInfo::text_edit(true, value.clone(), value.clone(), name)
    });
    value.retain(|letter| !letter.is_control());
    if response.has_focus() {
        let frame = Stroke::new(3.0, theme.ink);
        let kind = egui::StrokeKind::Outside;
        ui.painter().rect_stroke(response.rect, 12.0, frame, kind);
    }
    if response.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter)) {
        ui.data_mut(|data| data.insert_temp(left_field_id(), response.id));
    }
    response
}

/// Shows a headline.
pub fn title(ui: &mut Ui, theme: &Theme, text: &str) {
    ui.label(
        egui::RichText::new(text)
            .size(TITLE)
            .color(theme.ink)
            .strong(),
    );
}

/// Shows the top of a screen with a back button and a headline; returns the button's response.
pub fn header(ui: &mut Ui, theme: &Theme, back: &str, text: &str) -> Response {
    header_with(ui, theme, back, text, None).0
}

/// Shows a [`header`] with a button on the right that opens a file, where file dialogs exist.
pub fn header_to_open(ui: &mut Ui, game: &mut Game, text: &str) -> Response {
    let (theme, said) = (game.theme(), game.words());
    // The system's file dialog cannot be operated with a single switch.
    let can_pick = HAS_DIALOG && !game.settings.scanning.is_on();
    let right = can_pick.then_some(said.open);
    let (back, opens) = header_with(ui, &theme, said.back, text, right);
    if opens {
        game.ask_for_file();
    }
    back
}

/// Shows a header with the button `right` at its right end. Returns the back button's response and whether the other
/// button is pressed.
fn header_with(
    ui: &mut Ui,
    theme: &Theme,
    back: &str,
    text: &str,
    right: Option<&str>,
) -> (Response, bool) {
    const WIDE: f32 = 140.0;
    const BETWEEN: f32 = 16.0;
    let size = vec2(WIDE, finger(ui).max(48.0));
    let room = vec2(ui.available_width(), size.y + 8.0);
    let layout = Layout::left_to_right(Align::Center);
    let font = FontId::proportional(TITLE);
    let galley = { ui.painter() }.layout_no_wrap(text.to_string(), font, theme.ink);
    let width = galley.size().x;
    let buttons = if right.is_some() { 2.0 } else { 1.0 };
    // A headline without room beside the buttons is below them.
    let is_below = width + buttons * (WIDE + BETWEEN) + BETWEEN > room.x;
    let inner = ui.allocate_ui_with_layout(room, layout, |ui| {
        // The next widget may be far to the right, where egui's downward search does not find it. So the
        // arrow keys move the focus from the back button in the order of the widgets.
        let id = ui.next_auto_id();
        if ui.memory(|memory| memory.has_focus(id)) {
            step_through(ui);
        }
        let response = button(ui, theme, back, size, ButtonStyle::Other);
        ui.add_space(BETWEEN);
        if !is_below {
            title(ui, theme, text);
        }
        let right_to_left = Layout::right_to_left(Align::Center);
        let opens = ui.with_layout(right_to_left, |ui| {
            right.is_some_and(|text| button(ui, theme, text, size, ButtonStyle::Other).clicked())
        });
        (response, opens.inner)
    });
    if is_below {
        title(ui, theme, text);
    }
    ui.add_space(6.0);
    inner.inner
}

/// Makes the up and down arrow keys move the focus to the previous and the next widget, wherever these are.
/// Call this function before the current widget is added.
fn step_through(ui: &Ui) {
    for (key, direction) in [
        (Key::ArrowDown, FocusDirection::Next),
        (Key::ArrowUp, FocusDirection::Previous),
    ] {
        if ui.input(|input| input.key_pressed(key)) {
            ui.memory_mut(|memory| memory.move_focus(direction));
        }
    }
}

/// Area of a page. It reaches down to the notices, or to the lower edge of the window, where the contents scroll out of
/// sight.
pub fn page_rect(ui: &Ui) -> Rect {
    let mut rect = ui.max_rect().shrink2(EDGE);
    rect.max.y = ui.max_rect().bottom() - notices_height(ui);
    rect
}

/// Id under which the height of the notices below a page is stored.
fn notices_id() -> Id {
    Id::unique("height of the notices below a page")
}

/// Returns the height of the notices below a page [points], 0 without notices.
pub fn notices_height(ui: &Ui) -> f32 {
    ui.data(|data| data.get_temp(notices_id())).unwrap_or(0.0)
}

/// Notes the height of the notices below a page [points], and whether the page stays where it is when it grows.
pub fn note_notices_height(ui: &Ui, height: f32, page_stays: bool) {
    ui.data_mut(|data| {
        data.insert_temp(notices_id(), height);
        data.insert_temp(notices_id(), page_stays);
    });
}

/// Shows the scrolling part of a screen: a column of at most `width` points with room for focus rings. The
/// column fades at an edge where contents are scrolled out of sight. The scroll position is stored under
/// `name`.
pub fn page(ui: &mut Ui, name: &str, width: f32, contents: impl FnOnce(&mut Ui)) {
    let area = egui::ScrollArea::vertical()
        .id_salt(name)
        .auto_shrink(false);
    let output = area.show(ui, |ui| {
        follow_notices(ui);
        let all = ui.available_width();
        let inner = (all - 2.0 * (RING + 2.0)).min(width);
        let side = 0.5 * (all - inner);
        ui.add_space(RING + 3.0);
        ui.horizontal(|ui| {
            ui.spacing_mut().item_spacing.x = 0.0;
            ui.add_space(side);
            ui.vertical(|ui| {
                ui.spacing_mut().item_spacing.x = 10.0;
                ui.set_width(inner);
                contents(ui);
            });
        });
        ui.add_space(RING + EDGE.y);
    });
    let seen = output.inner_rect.with_max_x(ui.clip_rect().right());
    let seen = seen.with_min_x(ui.clip_rect().left());
    let above = output.state.clamped_offset().y;
    let below = output.content_size.y - seen.height() - above;
    // For the upper and the lower edge of a page: its position, its inward direction, and the height of the
    // contents beyond it. The fade at an edge is at most this high.
    for (edge, inwards, more) in [(seen.top(), 1.0, above), (seen.bottom(), -1.0, below)] {
        let far = edge + inwards * FADE.min(more.max(0.0));
        let mut mesh = egui::Mesh::default();
        for (y, colour) in [(edge, PAGE), (far, PAGE.gamma_multiply(0.0))] {
            for x in [seen.left(), seen.right()] {
                mesh.colored_vertex(pos2(x, y), colour);
            }
        }
        mesh.add_triangle(0, 1, 2);
        mesh.add_triangle(1, 2, 3);
        ui.painter().add(mesh);
    }
}

/// Scrolls a page by the height of new notices, so that they do not cover the button that was pressed.
fn follow_notices(ui: &Ui) {
    let id = Id::unique("height of the notices in the last frame");
    let height = notices_height(ui);
    let before: f32 = ui.data(|data| data.get_temp(id)).unwrap_or(0.0);
    let page_stays = ui.data(|data| data.get_temp(notices_id())) == Some(true);
    if height > before && !page_stays {
        let by = vec2(0.0, before - height);
        ui.scroll_with_delta_animation(by, egui::style::ScrollAnimation::none());
    }
    ui.data_mut(|data| data.insert_temp(id, height));
}

/// Margin around a column [points].
const AROUND: f32 = 12.0;

/// Shows a [`column`] that hides little of the world. In a landscape window `across` is its horizontal
/// position, from 0 (left) to 1 (right). In a portrait window the column is above the world if `is_above` is
/// set, otherwise below it.
pub fn column_beside<R>(
    ui: &mut Ui,
    width: f32,
    (across, is_above): (f32, bool),
    contents: impl FnOnce(&mut Ui) -> R,
) -> R {
    let mut part = ui.max_rect();
    if part.width() > part.height() {
        return column(ui, width, across, contents);
    }
    // A high column may cover more of the world, so that it need not scroll.
    let wanted = ui.data(|data| data.get_temp::<f32>(column_id(width)));
    let least = wanted.map_or(0.0, |height| height + 2.0 * AROUND);
    let share = if is_above { 0.4 } else { 0.47 };
    let height = (share * part.height()).max(least).min(part.height());
    match is_above {
        true => part.max.y = part.min.y + height,
        false => part.min.y = part.max.y - height,
    }
    let part = egui::UiBuilder::new().max_rect(part);
    ui.scope_builder(part, |ui| column(ui, width, 0.5, contents))
        .inner
}

/// Id under which the height of a column of this width is stored.
fn column_id(width: f32) -> Id {
    Id::unique(("column", width as u32))
}

/// Returns the part of the screen that a [`column`] can use.
pub fn column_part(screen: Rect, width: f32, across: f32) -> Rect {
    let screen = screen.shrink(AROUND);
    let width = width.min(screen.width());
    let left = screen.left() + across * (screen.width() - width);
    Rect::from_x_y_ranges(left..=left + width, screen.y_range())
}

/// Shows a vertically centred column of `width` points, at `across` from 0 (left) to 1 (right). It scrolls if
/// it is higher than the screen.
pub fn column<R>(ui: &mut Ui, width: f32, across: f32, contents: impl FnOnce(&mut Ui) -> R) -> R {
    let screen = ui.max_rect().shrink(AROUND);
    let id = column_id(width);
    let known = ui.data(|data| data.get_temp::<f32>(id));
    let part = column_part(ui.max_rect(), width, across);
    let height = known.unwrap_or(screen.height()).min(screen.height());
    let rect = Rect::from_center_size(part.center(), vec2(part.width(), height));
    let centred = egui::Layout::top_down(egui::Align::Center);
    let builder = egui::UiBuilder::new().max_rect(rect).layout(centred);
    let fill = |ui: &mut Ui| {
        let result = contents(ui);
        (result, ui.min_rect().height())
    };
    let (result, height) = ui
        .scope_builder(builder, |ui| match known {
            Some(height) if height > screen.height() => {
                egui::ScrollArea::vertical().show(ui, fill).inner
            }
            _ => fill(ui),
        })
        .inner;
    if known != Some(height) {
        ui.data_mut(|data| data.insert_temp(id, height));
        // egui repeats the frame, so that the column is never shown at a wrong position.
        ui.ctx().request_discard("the height of a column");
    }
    result
}
