//! Which level?

use super::kit::{Weight, button, focus_ring, title};
use super::veil;
use crate::game::{Game, Screen};
use egui::{Align2, FontId, Rect, Response, Role, Sense, Ui, WidgetInfo, pos2, vec2};
use tamaire_play::{Level, Route};
use tamaire_sound::Menu;

pub(super) fn show(game: &mut Game, ui: &mut Ui) {
    veil(ui, 235);
    let (theme, said) = (game.theme(), game.words());
    let mut wanted = None;
    let area = ui.max_rect().shrink2(vec2(32.0, 24.0));
    let mut back = ui.input(|input| input.key_pressed(egui::Key::Escape));
    ui.scope_builder(egui::UiBuilder::new().max_rect(area), |ui| {
        ui.horizontal(|ui| {
            back |= button(ui, &theme, said.back, vec2(140.0, 48.0), Weight::Other).clicked();
            ui.add_space(16.0);
            title(ui, &theme, said.levels);
        });
        ui.add_space(12.0);
        egui::ScrollArea::vertical().show(ui, |ui| {
            ui.set_width(ui.available_width());
            ui.horizontal_wrapped(|ui| {
                ui.spacing_mut().item_spacing = vec2(20.0, 20.0);
                for place in 0..game.levels.len() {
                    let response = tile(ui, game, place);
                    if place == game.chosen {
                        super::play::focus_first(ui, &response);
                    }
                    if response.clicked() {
                        wanted = Some(place);
                    }
                }
            });
        });
    });
    if back {
        game.blip(Menu::Back);
        game.go(Screen::Title);
    } else if let Some(level) = wanted {
        game.blip(Menu::Confirm);
        game.start(level);
    }
}

/// A level as a card: a little map, its name, what was reached.
fn tile(ui: &mut Ui, game: &Game, place: usize) -> Response {
    let theme = game.theme();
    let level = &game.levels[place];
    let name = game.settings.language.of(&level.game().name);
    let (rect, response) = ui.allocate_exact_size(vec2(230.0, 210.0), Sense::click());
    response.widget_info(|| WidgetInfo::labeled(Role::Button, true, name));
    let lively = ui
        .ctx()
        .animate_bool(response.id, response.hovered() || response.has_focus());
    let rect = rect.translate(vec2(0.0, -4.0 * lively));
    let painter = ui.painter();
    painter.rect_filled(
        rect.translate(vec2(0.0, 5.0)),
        22.0,
        egui::Color32::from_black_alpha(30),
    );
    painter.rect_filled(rect, 22.0, theme.card);
    let map = Rect::from_min_size(rect.min + vec2(12.0, 12.0), vec2(206.0, 128.0));
    painter.rect_filled(map, 14.0, theme.paper);
    draw_map(&painter.with_clip_rect(map), map, level, game);
    let font = FontId::proportional(21.0);
    painter.text(
        pos2(rect.center().x, rect.top() + 160.0),
        Align2::CENTER_CENTER,
        name,
        font,
        theme.ink,
    );
    let record = game.records.of(&level.id);
    let mut stars = String::new();
    for wish in 0..level.game().wish.len() {
        let reached = record.is_some_and(|record| record.wishes.contains(&wish));
        stars.push(if reached { '★' } else { '☆' });
    }
    for (route, mark) in [
        (Route::Squeeze, "●"),
        (Route::Shave, "◆"),
        (Route::Mix, "▲"),
    ] {
        if record.is_some_and(|record| record.best.contains_key(&route)) {
            stars.push(' ');
            stars.push_str(mark);
        }
    }
    let at = pos2(rect.center().x, rect.top() + 188.0);
    painter.text(
        at,
        Align2::CENTER_CENTER,
        stars,
        FontId::proportional(18.0),
        theme.accent,
    );
    focus_ring(ui, &response, rect, 22.0, &theme);
    response
}

fn draw_map(painter: &egui::Painter, map: Rect, level: &Level, game: &Game) {
    let theme = game.theme();
    let view = crate::look::Camera::default().view(map.shrink(6.0), level.arena());
    let scene = level.scene();
    if let Some(basket) = &scene.game.as_ref().and_then(|game| game.basket.as_ref()) {
        let size = 2.0 * view.scale * vec2(basket.half[0], basket.half[1]);
        let rect = Rect::from_center_size(view.on_screen(basket.centre), size);
        painter.rect_filled(rect, 3.0, theme.accent.gamma_multiply(0.25));
    }
    for (place, body) in scene.body.iter().enumerate() {
        let width = body.width;
        let centre = [body.at[0] + 0.5 * width, body.at[1] + 0.5 * width, 0.0];
        let colour = theme.material(1 + place as u8);
        painter.circle_filled(view.on_screen(centre), 0.5 * width * view.scale, colour);
    }
    for obstacle in &scene.obstacle {
        if let Some(bar) = &obstacle.capsule {
            let [red, green, blue] = theme.world.bar.map(|k| (255.0 * k) as u8);
            let stroke = egui::Stroke::new(
                2.0 * bar.radius * view.scale,
                egui::Color32::from_rgb(red, green, blue),
            );
            painter.line_segment([view.on_screen(bar.from), view.on_screen(bar.to)], stroke);
        }
    }
}
