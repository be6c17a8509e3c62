//! Contrast of all texts on the screens, measured on what egui draws.

use crate::window::*;
use app_shell::theme::contrast;
use egui::{Color32, Pos2, Shape, vec2};
use fuwafuwa::DEFAULT_TICK;
use fuwafuwa_render::frame::ElementColour;
use std::collections::BTreeSet;
use tamaire::game::Screen;
use tamaire::platform::{Files, OpenRequest};
use tamaire::words::Language;
use tamaire_play::link::address;

/// Least contrast of text [WCAG 2.2, level AA].
const LEAST: f32 = 4.5;

/// Checks each visible text of the last frame. Text over a world is checked against the darkest part of the
/// room's floor and walls. Returns the number of texts.
pub fn check(window: &mut Window, what: &str) -> usize {
    let drawn = flat(window.output());
    let mut faint = BTreeSet::new();
    let mut count = 0;
    for (index, (shape, clip)) in drawn.iter().enumerate() {
        let Shape::Text(text) = shape else {
            continue;
        };
        let middle = text.visual_bounding_rect().center();
        let ink = match text.override_text_color {
            Some(ink) => ink,
            None => ink_of(text),
        };
        // Translucent text is a shadow, or is fading in or out.
        let is_opaque = ink.a() == 255 && text.opacity_factor == 1.0;
        if !is_opaque || !clip.contains(middle) || text.galley.text().trim().is_empty() {
            continue;
        }
        let ground = ground(&drawn[..index], middle, world_at(window, middle));
        let found = contrast(ink, ground);
        count += 1;
        if found < LEAST {
            let text = text.galley.text();
            faint.insert(format!("{text:?}: {found:.2}, {ink:?} on {ground:?}"));
        }
    }
    assert!(faint.is_empty(), "{what}: {faint:#?}");
    count
}

/// Shapes of the last frame in the order in which they are drawn, each with its clip rectangle.
fn flat(output: &egui::FullOutput) -> Vec<(Shape, egui::Rect)> {
    fn add(shape: &Shape, clip: egui::Rect, all: &mut Vec<(Shape, egui::Rect)>) {
        match shape {
            Shape::Vec(parts) => parts.iter().for_each(|part| add(part, clip, all)),
            shape => all.push((shape.clone(), clip)),
        }
    }
    let mut all = Vec::new();
    for clipped in &output.shapes {
        add(&clipped.shape, clipped.clip_rect, &mut all);
    }
    all
}

fn ink_of(text: &egui::epaint::TextShape) -> Color32 {
    let section = text.galley.job.sections.first();
    match section.map(|section| section.format.color) {
        Some(ink) if ink != Color32::PLACEHOLDER => ink,
        _ => text.fallback_color,
    }
}

/// Darkest colour of the world at a point of the screen: the frame around a 2D room, otherwise floor and walls.
fn world_at(window: &Window, at: Pos2) -> Color32 {
    let game = &window.state().game;
    let palette = game.theme().world;
    let view = game.bout.view.filter(|view| view.space.is_none());
    let is_in_room = view.is_none_or(|view| {
        let [low, high] = game.bout.round().level().arena();
        egui::Rect::from_two_pos(view.to_screen(low), view.to_screen(high)).contains(at)
    });
    let colour = if is_in_room {
        palette.floor[1]
    } else {
        palette.frame
    };
    let [red, green, blue] = colour.map(|part| (255.0 * part + 0.5) as u8);
    Color32::from_rgb(red, green, blue)
}

/// Colour behind a text at `at`: all fills that cover this point, over the world.
fn ground(before: &[(Shape, egui::Rect)], at: Pos2, world: Color32) -> Color32 {
    before.iter().fold(world, |ground, (shape, clip)| {
        match fill_at(shape, at).filter(|_| clip.contains(at)) {
            Some(fill) => ground.blend(fill),
            None => ground,
        }
    })
}

fn fill_at(shape: &Shape, at: Pos2) -> Option<Color32> {
    match shape {
        // A blurred rectangle is the shadow of a card, which covers the shadow.
        Shape::Rect(rect) => {
            (rect.rect.contains(at) && rect.blur_width == 0.0).then_some(rect.fill)
        }
        Shape::Circle(circle) => {
            (circle.center.distance(at) <= circle.radius).then_some(circle.fill)
        }
        Shape::Path(path) => (path.closed && contains(&path.points, at)).then_some(path.fill),
        _ => None,
    }
}

/// Whether a point lies in a polygon: a ray to the right crosses an odd number of edges.
fn contains(corners: &[Pos2], at: Pos2) -> bool {
    let edges = (0..corners.len()).map(|k| (corners[k], corners[(k + 1) % corners.len()]));
    let crossed = edges.filter(|(a, b)| {
        (a.y > at.y) != (b.y > at.y) && at.x < a.x + (at.y - a.y) / (b.y - a.y) * (b.x - a.x)
    });
    crossed.count() % 2 == 1
}

#[test]
fn all_texts_have_contrast_in_both_themes() {
    let folder = folder();
    let mut window = open(Files::in_folder(folder.path()), vec2(1280.0, 800.0), 0.25);
    for colour_safe in [false, true] {
        for language in [Language::English, Language::Japanese] {
            game(&mut window).settings.colour_safe = colour_safe;
            game(&mut window).settings.language = language;
            let mut count = 0;
            for screen in [
                Screen::Title,
                Screen::Together,
                Screen::Levels,
                Screen::Settings,
                Screen::Forces,
                Screen::Licences,
                Screen::Replays,
            ] {
                game(&mut window).go(screen);
                frames(&mut window, 3);
                count += check(
                    &mut window,
                    &format!("{screen:?}, colour-blind {colour_safe}"),
                );
            }
            assert!(count > 60, "{count} texts");
            start(&mut window, "classic-3d");
            game(&mut window).bout.slow = true;
            game(&mut window).bout.elements = Some(ElementColour::Level);
            // The instructions have faded in.
            frames(&mut window, 60);
            check(&mut window, "Play");
            game(&mut window).bout.elements = None;
            press(&mut window, egui::Key::P);
            assert!(check(&mut window, "Paused") > 6);
            start(&mut window, "classic");
            win(&mut window);
            game(&mut window).keep_replay();
            wait_for_files(&mut window);
            assert!(check(&mut window, "Result") > 20);
            let replay = game(&mut window).bout.round().replay();
            let link = address("https://example.org/play/", &replay.link().unwrap());
            game(&mut window).watch(replay.into()).unwrap();
            frames(&mut window, 3);
            assert!(check(&mut window, "Watching") > 5);
            game(&mut window).open_link(&link);
            frames(&mut window, 3);
            assert_eq!(screen(&window), Screen::Offered);
            assert!(check(&mut window, "Offered") > 5);
            game(&mut window).notices.clear();
        }
    }
}

/// Level without a floor, out of which the body falls.
const BOTTOMLESS: &str = include_str!("../bottomless.toml");

#[test]
fn hopeless_round_is_told_with_contrast_in_windows_of_any_shape() {
    let folder = folder();
    let path = folder.path().join("bottomless.toml");
    std::fs::write(&path, BOTTOMLESS).unwrap();
    for size in [vec2(1280.0, 800.0), vec2(390.0, 844.0)] {
        let mut window = open(Files::nowhere(), size, 0.25);
        game(&mut window).open(OpenRequest::at(&path));
        (0..150).for_each(|_| game(&mut window).update(DEFAULT_TICK));
        for (language, _) in Language::ALL {
            game(&mut window).settings.language = language;
            frames(&mut window, 3);
            let told = language.words().hopeless;
            let room = window.ctx.content_rect();
            let is_told = flat(window.output()).iter().any(|(shape, _)| match shape {
                Shape::Text(text) if text.galley.text().starts_with(told) => {
                    room.contains_rect(text.visual_bounding_rect())
                }
                _ => false,
            });
            assert!(is_told, "{language:?} at {size}");
            check(&mut window, &format!("hopeless at {size}"));
        }
    }
}

#[test]
fn title_has_contrast_in_windows_of_any_shape() {
    for size in [vec2(390.0, 844.0), vec2(2000.0, 600.0), vec2(800.0, 800.0)] {
        let mut window = open(Files::nowhere(), size, 0.25);
        frames(&mut window, 5);
        assert!(check(&mut window, &format!("title at {size}")) > 5);
    }
}
