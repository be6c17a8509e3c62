//! The ending: a street at night with a house for each chapter and a window for each level. Each window is lit as its
//! level is counted.

use super::widgets::{focus_first, page_rect, words};
use crate::game::Game;
use crate::journey::chapter_of;
use crate::look::{Maps, Stage};
use app_shell::Theme;
use app_shell::widgets::{ButtonStyle, button, fitted};
use egui::{
    Color32, Mesh, Painter, Pos2, Rect, Role, Sense, Shape, Stroke, StrokeKind, Ui, UiBuilder,
    Vec2, WidgetInfo, pos2, vec2,
};
use std::f32::consts::TAU;
use tamaire_play::level::CHAPTERS;
use tamaire_sound::Menu;

/// Duration of the flight of a ball to its window, in counts.
const FLIGHT: f32 = 1.3;
/// Share of a house that its roof takes.
const ROOF: f32 = 0.22;
/// Colours of the houses.
const WALLS: [Color32; CHAPTERS.len()] = [
    Color32::from_rgb(176, 98, 92),
    Color32::from_rgb(186, 138, 74),
    Color32::from_rgb(86, 128, 110),
    Color32::from_rgb(84, 112, 158),
    Color32::from_rgb(128, 94, 146),
];
const NIGHT: [Color32; 2] = [
    Color32::from_rgb(24, 26, 62),
    Color32::from_rgb(94, 74, 122),
];
const GROUND: Color32 = Color32::from_rgb(46, 40, 58);
const DARK: Color32 = Color32::from_rgb(38, 36, 60);
const LIGHT: Color32 = Color32::from_rgb(255, 226, 150);
/// Colours of the balls, those of the two teams of a sports day.
const BALLS: [Color32; 2] = [
    Color32::from_rgb(226, 72, 66),
    Color32::from_rgb(250, 248, 242),
];

pub(super) fn show(game: &mut Game, stage: &mut Stage, ui: &mut Ui) {
    let (screen, path) = (ui.max_rect(), game.path());
    let theme = game.theme();
    let is_counted = game.ending.is_counted(path.len());
    draw_sky(ui.painter(), screen, game);
    let houses = houses(screen);
    let windows = windows(game, &path, &houses);
    for (house, wall) in houses.iter().zip(WALLS) {
        draw_house(ui.painter(), *house, wall);
    }
    let basket = basket(screen);
    let maps = stage.maps(&game.pictured(), &theme);
    let counts = game.ending.counts();
    for (place, (&window, &index)) in windows.iter().zip(&path).enumerate() {
        let since = counts - (place + 1) as f32;
        draw_window(ui, game, maps, window, index, since);
        let share = 1.0 + since / FLIGHT;
        if (0.0..1.0).contains(&share) && !game.settings.reduced_motion {
            draw_ball(ui.painter(), basket, window.center(), share, place);
        }
    }
    draw_basket(ui.painter(), basket, screen);
    if is_counted {
        draw_fireworks(ui.painter(), screen, game);
        thank(game, ui, &theme, path.len());
    } else {
        call(game, ui, counts as usize);
        let any = ui.interact(screen, ui.scope_id().with("skip"), Sense::click());
        let is_pressed = ui.input(|input| {
            let keys = [egui::Key::Enter, egui::Key::Space, egui::Key::Escape];
            keys.into_iter().any(|key| input.key_pressed(key))
        });
        if any.clicked() || is_pressed {
            game.skip_ending();
        }
    }
}

/// Calls the number that was counted last.
fn call(game: &Game, ui: &Ui, counted: usize) {
    if counted == 0 {
        return;
    }
    let text = (game.words().count)(counted);
    let screen = ui.max_rect();
    let size = 0.1 * screen.size().min_elem();
    let at = pos2(screen.center().x, screen.top() + 0.09 * screen.height());
    words(ui, at, &text, size, LIGHT);
}

/// Shows how much was won, the thanks, and the way back.
fn thank(game: &mut Game, ui: &mut Ui, theme: &Theme, levels: usize) {
    let stars = game.journey().stars();
    let [first, second] = (game.words().thanks)(levels, stars.earned, stars.all);
    let area = page_rect(ui);
    let back = game.words().levels;
    let mut leaves = ui.input(|input| input.key_pressed(egui::Key::Escape));
    let width = area.width().min(640.0);
    let lines = [(second, 34.0), (first, 22.0)];
    let texts =
        lines.map(|(text, size)| fitted(ui.painter(), &text, size, width - 32.0, theme.ink));
    let high = texts.iter().map(|text| text.size().y + 6.0).sum::<f32>() + 28.0 + 56.0;
    let card = Rect::from_min_size(
        pos2(area.center().x - 0.5 * width, area.top()),
        vec2(width, high),
    );
    ui.painter().rect_filled(card, 22.0, theme.card);
    ui.scope_builder(UiBuilder::new().max_rect(card.shrink(14.0)), |ui| {
        ui.vertical_centered(|ui| {
            ui.spacing_mut().item_spacing = Vec2::splat(6.0);
            for text in texts {
                ui.label(text);
            }
            let response = button(ui, theme, back, vec2(220.0, 46.0), ButtonStyle::Main);
            focus_first(ui, &response);
            leaves |= response.clicked();
        });
    });
    if leaves {
        game.blip(Menu::Back);
        game.go(crate::game::Screen::Levels);
    }
}

/// Returns the houses: side by side, in a portrait window one above the other.
fn houses(screen: Rect) -> [Rect; CHAPTERS.len()] {
    let count = CHAPTERS.len() as f32;
    let is_tall = screen.width() < screen.height();
    let street = screen
        .with_min_y(screen.top() + 0.2 * screen.height())
        .with_max_y(screen.bottom() - 0.14 * screen.height())
        .shrink2(vec2(0.03 * screen.width(), 0.0));
    std::array::from_fn(|index| {
        let place = index as f32;
        match is_tall {
            true => {
                let high = street.height() / count;
                let at = pos2(street.left(), street.top() + place * high);
                Rect::from_min_size(at, vec2(street.width(), 0.94 * high))
            }
            false => {
                let wide = street.width() / count;
                // Each house has its own height.
                let lower = street.height() * [0.08, 0.0, 0.12, 0.04, 0.1][index];
                let at = pos2(street.left() + (place + 0.05) * wide, street.top() + lower);
                Rect::from_min_size(at, vec2(0.9 * wide, street.height() - lower))
            }
        }
    })
}

/// Returns the window of each level of the path.
fn windows(game: &Game, path: &[usize], houses: &[Rect; CHAPTERS.len()]) -> Vec<Rect> {
    let chapter = |index: usize| chapter_of(&game.levels[index]).unwrap_or(1) - 1;
    let mut windows = Vec::new();
    for (place, &index) in path.iter().enumerate() {
        let own = chapter(index);
        let is_own = |&&other: &&usize| chapter(other) == own;
        let [before, all] = [&path[..place], path].map(|some| some.iter().filter(is_own).count());
        let house = houses[own];
        let wall = house.with_min_y(house.top() + ROOF * house.height());
        let wall = wall.shrink2(0.04 * wall.size());
        let columns = if house.width() > house.height() { 4 } else { 2 };
        let rows = all.div_ceil(columns).max(2);
        let cell = vec2(wall.width() / columns as f32, wall.height() / rows as f32);
        let (row, column) = (before / columns, before % columns);
        let middle = wall.min + vec2((column as f32 + 0.5) * cell.x, (row as f32 + 0.5) * cell.y);
        let wide = (0.86 * cell.x).min(0.86 * cell.y * 1.5);
        windows.push(Rect::from_center_size(middle, vec2(wide, wide / 1.5)));
    }
    windows
}

fn draw_sky(painter: &Painter, screen: Rect, game: &Game) {
    let mut sky = Mesh::default();
    for (corner, tone) in [
        (screen.left_top(), NIGHT[0]),
        (screen.right_top(), NIGHT[0]),
        (screen.left_bottom(), NIGHT[1]),
        (screen.right_bottom(), NIGHT[1]),
    ] {
        sky.colored_vertex(corner, tone);
    }
    sky.add_triangle(0, 1, 2);
    sky.add_triangle(1, 3, 2);
    painter.add(sky);
    let mut random = fastrand::Rng::with_seed(2004);
    for _ in 0..70 {
        let at = screen.min
            + vec2(
                random.f32() * screen.width(),
                0.6 * random.f32() * screen.height(),
            );
        let (size, phase) = (0.6 + 1.2 * random.f32(), f64::from(TAU * random.f32()));
        let twinkle = match game.settings.reduced_motion {
            true => 0.8,
            false => 0.65 + 0.35 * (1.7 * game.time + phase).sin() as f32,
        };
        painter.circle_filled(at, size, Color32::WHITE.gamma_multiply(twinkle));
    }
    let moon = screen.min + vec2(0.88 * screen.width(), 0.1 * screen.height());
    painter.circle_filled(
        moon,
        0.045 * screen.size().min_elem(),
        Color32::from_rgb(250, 240, 205),
    );
    let ground = screen.with_min_y(screen.bottom() - 0.14 * screen.height());
    painter.rect_filled(ground, 0.0, GROUND);
}

fn draw_house(painter: &Painter, house: Rect, wall: Color32) {
    let eaves = house.top() + ROOF * house.height();
    painter.rect_filled(house.with_min_y(eaves), 4.0, wall);
    let over = 0.03 * house.width();
    let roof = vec![
        pos2(house.left() - over, eaves),
        pos2(house.left() + 0.22 * house.width(), house.top()),
        pos2(house.right() - 0.22 * house.width(), house.top()),
        pos2(house.right() + over, eaves),
    ];
    let tiles = wall.lerp_to_gamma(Color32::BLACK, 0.45);
    painter.add(Shape::convex_polygon(roof, tiles, Stroke::NONE));
}

/// Draws a window: dark, or from its count on lit with a picture of the level. `since` is the time since the level was
/// counted, in counts.
fn draw_window(ui: &Ui, game: &Game, maps: &Maps, window: Rect, index: usize, since: f32) {
    let (painter, level) = (ui.painter(), &game.levels[index]);
    let name = game.settings.language.of(&level.game().name);
    let response = ui.interact(window, ui.scope_id().with(index), Sense::hover());
    response.widget_info(|| WidgetInfo::labeled(Role::Image, true, name));
    if since < 0.0 {
        painter.rect_filled(window, 5.0, DARK);
        return;
    }
    // The light flares up and calms down.
    let flare = match game.settings.reduced_motion {
        true => 0.0,
        false => (-1.4 * since).exp(),
    };
    let glow = LIGHT.gamma_multiply(0.22 + 0.5 * flare);
    painter.rect_filled(window.expand(5.0 + 6.0 * flare), 9.0, glow);
    painter.rect_filled(window, 5.0, LIGHT);
    maps.draw(painter, window, level);
    painter.rect_filled(window, 5.0, LIGHT.gamma_multiply(0.16 + 0.5 * flare));
    painter.rect_stroke(window, 5.0, Stroke::new(3.0, LIGHT), StrokeKind::Outside);
}

/// Returns the rim of the basket.
fn basket(screen: Rect) -> Rect {
    let size = screen.size().min_elem() * vec2(0.16, 0.1);
    let middle = pos2(screen.center().x, screen.bottom() - 0.1 * screen.height());
    Rect::from_center_size(middle, size)
}

fn draw_basket(painter: &Painter, basket: Rect, screen: Rect) {
    let straw = Color32::from_rgb(206, 160, 96);
    let pole = [
        basket.center_bottom(),
        pos2(basket.center().x, screen.bottom()),
    ];
    painter.line_segment(
        pole,
        Stroke::new(7.0, straw.lerp_to_gamma(Color32::BLACK, 0.35)),
    );
    let narrow = 0.2 * basket.width();
    let sides = vec![
        basket.left_top(),
        basket.right_top(),
        basket.right_bottom() - vec2(narrow, 0.0),
        basket.left_bottom() + vec2(narrow, 0.0),
    ];
    painter.add(Shape::convex_polygon(sides, straw, Stroke::NONE));
    let rim = Stroke::new(5.0, straw.lerp_to_gamma(Color32::WHITE, 0.35));
    painter.line_segment([basket.left_top(), basket.right_top()], rim);
}

/// Draws a ball on its way from the basket to a window. `share` is the part of the way, 0 to 1.
fn draw_ball(painter: &Painter, basket: Rect, window: Pos2, share: f32, place: usize) {
    let from = basket.center_top();
    let rise = 0.35 * (from.y - window.y).abs() + 40.0;
    let at = from.lerp(window, share) - vec2(0.0, 4.0 * rise * share * (1.0 - share));
    let radius = 0.11 * basket.width();
    painter.circle_filled(at, radius, BALLS[place % BALLS.len()]);
    painter.circle_stroke(at, radius, Stroke::new(2.0, GROUND));
}

/// Draws fireworks over the street: more of them if every star was earned.
fn draw_fireworks(painter: &Painter, screen: Rect, game: &Game) {
    if game.settings.reduced_motion {
        return;
    }
    let stars = game.journey().stars();
    let count = if stars.earned == stars.all { 7 } else { 3 };
    for rocket in 0..count {
        let time = game.time / 1.9 + f64::from(rocket) / f64::from(count);
        let (round, age) = (time.floor(), time.fract() as f32);
        let mut random = fastrand::Rng::with_seed(round as u64 * 31 + u64::from(rocket as u32));
        let at = screen.min
            + vec2(
                (0.08 + 0.84 * random.f32()) * screen.width(),
                (0.06 + 0.3 * random.f32()) * screen.height(),
            );
        let tone = WALLS[random.usize(0..WALLS.len())].lerp_to_gamma(Color32::WHITE, 0.4);
        let reach = 0.16 * screen.size().min_elem() * (1.0 - (1.0 - age).powi(3));
        for ray in 0..18 {
            let way = Vec2::angled(TAU * ray as f32 / 18.0);
            let fall = vec2(0.0, 0.05 * screen.height() * age * age);
            let tip = at + reach * way + fall;
            painter.circle_filled(tip, 3.2 * (1.0 - age), tone.gamma_multiply(1.0 - age));
        }
    }
}
