//! Tools of a playground: materials and shapes to add, tools of the hand, and sliders.

use super::buttons::{EDGE, GAP, HIGH, pale};
use super::widgets::{card, slider_with};
use super::{hud, icons};
use crate::game::{Game, Toys};
use crate::words::Words;
use app_shell::Theme;
use app_shell::widgets::note_hovered;
use egui::{
    Color32, Painter, Pos2, Rect, RichText, Role, Sense, Shape, Stroke, Ui, UiBuilder, Vec2,
    WidgetInfo, pos2, vec2,
};
use fuwafuwa_scenes::scene::Form;
use std::f32::consts::TAU;
use tamaire_play::playground::{Change, Stuff, Tool};
use tamaire_sound::Menu;

/// Shapes that can be added.
pub(super) const FORMS: [Form; 5] = [Form::Ball, Form::Box, Form::Ring, Form::Heart, Form::Flower];
/// Width of the card with the sliders [points].
const CARD: f32 = 420.0;
/// Height of the card with the sliders in its first frame [points].
const CARD_HIGH: f32 = 250.0;

/// A button of the playground.
#[derive(Copy, Clone, PartialEq)]
enum Toy {
    Stuff(Stuff),
    Form(Form),
    Tool(Tool),
    Sliders,
    Clear,
}

impl Toy {
    /// Returns all buttons, in order.
    fn all(game: &Game) -> Vec<Self> {
        let stuffs = Stuff::ALL.map(Self::Stuff).into_iter();
        stuffs
            .chain(FORMS.map(Self::Form))
            .chain(game.tools().map(Self::Tool))
            .chain([Self::Sliders, Self::Clear])
            .collect()
    }

    fn name(self, game: &Game) -> String {
        let said = game.words();
        match self {
            Self::Stuff(stuff) => (said.stuff)(stuff).into(),
            Self::Form(form) => (said.add_form)(form).into(),
            Self::Tool(tool) => (said.tool)(tool).into(),
            Self::Sliders => said.sliders.into(),
            Self::Clear => said.clear.into(),
        }
    }

    fn is_chosen(self, game: &Game) -> bool {
        let toys = &game.bout.toys;
        match self {
            Self::Stuff(stuff) => stuff == toys.stuff,
            Self::Tool(tool) => tool == toys.tool,
            Self::Sliders => toys.has_sliders,
            Self::Form(_) | Self::Clear => false,
        }
    }
}

/// Shows the tools of a playground, and draws the tool at the hand. Returns whether the mouse is over them.
pub(super) fn show(game: &mut Game, ui: &mut Ui) -> bool {
    game.controls.covers.clear();
    game.bout.toys.is_pointer_down = false;
    if !game.is_in_playground() {
        return false;
    }
    draw_tool(game, ui.painter());
    let scale = hud::scale(game, ui);
    let places = places(Toy::all(game).len(), ui.max_rect(), scale);
    let mut is_over = false;
    for (toy, rect) in Toy::all(game).into_iter().zip(places) {
        game.controls.covers.push(rect);
        let response = ui.interact(rect, ui.scope_id().with(toy.name(game)), Sense::CLICK);
        response.widget_info(|| WidgetInfo::labeled(Role::Button, true, toy.name(game)));
        note_hovered(ui, &response);
        is_over |= response.hovered();
        draw(game, ui.painter(), toy, rect, response.hovered());
        if response.clicked() {
            press(game, toy);
        }
        response.on_hover_text(RichText::new(toy.name(game)).size(17.0));
    }
    if game.bout.toys.has_sliders {
        is_over |= sliders(game, ui, scale);
    }
    let controls = &game.controls;
    let buttons = controls.buttons.iter().map(|button| button.rect);
    let taken: Vec<Rect> = buttons.chain(controls.covers.iter().copied()).collect();
    let is_free = |at: Pos2| !taken.iter().any(|rect| rect.contains(at));
    game.bout.toys.is_pointer_down = ui.input(|input| {
        let pointer = &input.pointer;
        pointer.primary_down() && pointer.press_origin().is_some_and(is_free)
    });
    is_over
}

/// Height of the tools at the lower edge [points]; 0 outside a playground.
pub(super) fn height(game: &Game, ui: &Ui) -> f32 {
    if !game.is_in_playground() {
        return 0.0;
    }
    let (screen, scale) = (ui.max_rect(), hud::scale(game, ui));
    let top = places(Toy::all(game).len(), screen, scale).map(|place| place.top());
    screen.bottom() - top.fold(screen.bottom(), f32::min)
}

/// Returns the places of `count` buttons: in rows at the lower edge, the last row lowest.
fn places(count: usize, screen: Rect, scale: f32) -> impl Iterator<Item = Rect> {
    let side = scale * HIGH;
    let step = side + scale * 0.6 * GAP;
    let columns = (((screen.width() - 2.0 * EDGE) / step) as usize).clamp(1, count);
    let rows = count.div_ceil(columns);
    // Rows of about the same length.
    let columns = count.div_ceil(rows);
    (0..count).map(move |index| {
        let (row, column) = (index / columns, index % columns);
        let in_row = columns.min(count - row * columns);
        let left = screen.center().x - 0.5 * step * in_row as f32;
        let up = scale * EDGE + step * (rows - row) as f32;
        let at = pos2(left + step * column as f32, screen.bottom() - up);
        Rect::from_min_size(at, Vec2::splat(side))
    })
}

fn press(game: &mut Game, toy: Toy) {
    game.blip(Menu::Confirm);
    match toy {
        Toy::Stuff(stuff) => game.bout.toys.stuff = stuff,
        Toy::Form(form) => game.add_body(form),
        Toy::Tool(tool) => game.choose_tool(tool),
        Toy::Sliders => game.bout.toys.has_sliders ^= true,
        Toy::Clear => {
            game.change_playground(Change::Clear);
        }
    }
}

/// Shows the sliders. Returns whether the mouse is over them.
fn sliders(game: &mut Game, ui: &mut Ui, scale: f32) -> bool {
    let (theme, said, screen) = (game.theme(), game.words(), ui.max_rect());
    let width = CARD.min(screen.width() - 2.0 * EDGE);
    let low = screen.bottom() - height(game, ui) - scale * GAP;
    // The height of the card is known from the frame before.
    let id = egui::Id::unique("height of the sliders");
    let high = ui.data(|data| data.get_temp(id)).unwrap_or(CARD_HIGH);
    let size = vec2(width, high);
    let place = Rect::from_min_size(pos2(screen.center().x - 0.5 * width, low - size.y), size);
    let mut toys = game.bout.toys;
    // A scope would make the whole screen count as hovered, so that the mouse would not move the hand.
    let mut child = ui.new_child(UiBuilder::new().max_rect(place));
    card(&mut child, &theme, |ui| {
        ui.set_width(ui.available_width());
        room_sliders(ui, &theme, said, &mut toys);
    });
    let shown = child.min_rect();
    game.controls.covers.push(shown);
    ui.data_mut(|data| data.insert_temp(id, shown.height()));
    game.set_room(toys);
    ui.rect_contains_pointer(shown)
}

/// Shows the sliders for gravity, air and the size of the hand.
pub(super) fn room_sliders(ui: &mut Ui, theme: &Theme, said: &Words, toys: &mut Toys) {
    let mut show = |name: &str, value: &mut f32, range: [f32; 3], digits: usize| {
        slider_with(ui, theme, name, value, range, |value| {
            format!("{value:.digits$}")
        });
    };
    show(said.gravity, &mut toys.gravity, [0.0, 20.0, 0.5], 1);
    show(said.air, &mut toys.air, [0.0, 5.0, 0.1], 1);
    show(said.hand_size, &mut toys.hand, [3.0, 30.0, 1.0], 0);
}

/// Draws a button.
fn draw(game: &Game, painter: &Painter, toy: Toy, rect: Rect, is_hovered: bool) {
    let theme = game.theme();
    let is_chosen = toy.is_chosen(game);
    let (middle, radius) = (rect.center(), 0.5 * rect.width());
    let fill = if is_hovered || is_chosen {
        theme.card
    } else {
        pale(&theme)
    };
    painter.circle_filled(middle, radius, fill);
    if is_chosen {
        painter.circle_stroke(middle, radius - 1.5, Stroke::new(3.0, theme.accent));
    }
    let scale = rect.width() / HIGH;
    match toy {
        Toy::Stuff(stuff) => {
            painter.circle_filled(middle, 12.0 * scale, colour(game, stuff));
            painter.circle_stroke(middle, 12.0 * scale, Stroke::new(1.5, theme.ink));
        }
        Toy::Form(form) => {
            let fill = colour(game, game.bout.toys.stuff);
            draw_form(painter, &theme, form, middle, scale, fill);
        }
        Toy::Tool(tool) => icon(tool)(painter, middle, scale, theme.ink),
        Toy::Sliders => icons::sliders(painter, middle, scale, theme.ink),
        Toy::Clear => icons::broom(painter, middle, scale, theme.ink),
    }
}

/// Returns the colour in which bodies of a material are drawn.
fn colour(game: &Game, stuff: Stuff) -> Color32 {
    let own = game.bout.round().level().colours();
    let colour = game.theme().world.tinted_material(stuff.number(), own);
    let [red, green, blue] = colour.map(|channel| (255.0 * channel).round() as u8);
    Color32::from_rgb(red, green, blue)
}

pub(super) fn draw_form(
    painter: &Painter,
    theme: &Theme,
    form: Form,
    at: Pos2,
    scale: f32,
    fill: Color32,
) {
    let line = Stroke::new(1.5, theme.ink);
    let outline = |radius: &dyn Fn(f32) -> Vec2| {
        let points = (0..48).map(|k| at + scale * radius(TAU * k as f32 / 48.0));
        points.collect::<Vec<Pos2>>()
    };
    match form {
        Form::Box => {
            let square = Rect::from_center_size(at, Vec2::splat(20.0 * scale));
            painter.rect(square, 2.0, fill, line, egui::StrokeKind::Inside);
        }
        Form::Ring => {
            painter.circle_stroke(at, 9.0 * scale, Stroke::new(7.0 * scale, theme.ink));
            painter.circle_stroke(at, 9.0 * scale, Stroke::new(5.0 * scale, fill));
        }
        Form::Heart => {
            let heart = |angle: f32| {
                let (sin, cos) = angle.sin_cos();
                let up = 13.0 * cos
                    - 5.0 * (2.0 * angle).cos()
                    - 2.0 * (3.0 * angle).cos()
                    - (4.0 * angle).cos();
                0.72 * vec2(16.0 * sin.powi(3), -up)
            };
            painter.add(Shape::Path(egui::epaint::PathShape {
                points: outline(&heart),
                closed: true,
                fill,
                stroke: line.into(),
            }));
        }
        Form::Flower => {
            for petal in 0..5 {
                let way = Vec2::angled(TAU * (petal as f32 / 5.0 - 0.25));
                painter.circle(at + 7.0 * scale * way, 5.5 * scale, fill, line);
            }
            painter.circle_filled(at, 7.0 * scale, fill);
        }
        Form::Ball | Form::Empty => {
            painter.circle(at, 11.0 * scale, fill, line);
        }
    }
}

/// Returns the function that draws the icon of a tool.
pub(super) fn icon(tool: Tool) -> fn(&Painter, Pos2, f32, Color32) {
    match tool {
        Tool::Push => icons::hand,
        Tool::Grab => icons::grab,
        Tool::Knife => icons::knife,
        Tool::Pin => icons::pin,
    }
}

/// Draws the tool at the hand.
fn draw_tool(game: &Game, painter: &Painter) {
    let tool = game.bout.toys.tool;
    let Some(view) = game.bout.view.filter(|_| tool != Tool::Push) else {
        return;
    };
    let hand = &game.bout.round().hands()[0];
    let at = view.to_screen(hand.position);
    let radius = view.scale_at(hand.position) * hand.radius;
    let scale = (radius / 12.0).max(0.8);
    icon(tool)(painter, at, scale, Color32::WHITE);
}
