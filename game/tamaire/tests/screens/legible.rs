//! Buttons, texts and messages at the size of a phone: large enough, inside the window, and not on top of each other.

use crate::making::drag;
use crate::window::*;
use egui::accesskit::Role;
use egui::epaint::{Shape, TextShape};
use egui::{Key, Pos2, Rect, Vec2, vec2};
use egui_kittest::kittest::{NodeT, Queryable};
use tamaire::game::Screen;
use tamaire::platform::Files;
use tamaire::words::Language;
use tamaire_play::Level;

/// Size of a phone, and sizes of a window on a desktop.
const SIZES: [Vec2; 3] = [vec2(390.0, 844.0), vec2(1280.0, 800.0), vec2(704.0, 440.0)];
/// Smallest width and height of a button, and smallest letters [points without the zoom].
const FINGER: f32 = 44.0;
const LETTERS: f32 = 12.0;
/// Tolerance of rounding to whole pixels [points].
const NEAR: f32 = 0.6;

/// Opens a window as a finger uses it, with a level that the player has made.
fn phone(size: Vec2, language: Language) -> Window {
    let mut window = open(Files::nowhere(), size, 1.0);
    touch(&mut window, 0, egui::TouchPhase::Start, Pos2::ZERO);
    touch(&mut window, 0, egui::TouchPhase::End, Pos2::ZERO);
    let game = game(&mut window);
    game.settings.language = language;
    game.edit_blank(2);
    assert!(game.keep_draft());
    game.notices.clear();
    window
}

/// Returns names and places of all buttons but those with the given names, in points without the zoom.
fn buttons(window: &Window, without: &[&str]) -> Vec<(String, Rect)> {
    let zoom = window.ctx.zoom_factor();
    let all = window.get_all_by(|node| matches!(node.role(), Role::Button | Role::RadioButton));
    let named = all.filter_map(|node| Some((node.accesskit_node().label()?, node.rect() * zoom)));
    named
        .filter(|(name, _)| !without.contains(&name.as_str()))
        .collect()
}

/// Returns the places of all messages in points without the zoom.
fn messages(window: &Window) -> Vec<Rect> {
    let zoom = window.ctx.zoom_factor();
    let texts = window.state().game.notices.iter();
    let place = |text: &str| window.get_by_label(text).rect() * zoom;
    texts.map(|notice| place(&notice.text)).collect()
}

/// Whether two rectangles have more than an edge in common.
fn overlap(one: Rect, other: Rect) -> bool {
    let common = one.intersect(other);
    common.width() > NEAR && common.height() > NEAR
}

/// Asserts that all buttons are as large as a finger, inside the window, and apart. A page scrolls up and down.
fn assert_pressable(window: &Window, what: &str, without: &[&str], scrolls: bool) {
    let screen = window.ctx.content_rect() * window.ctx.zoom_factor();
    let buttons = buttons(window, without);
    assert!(!buttons.is_empty());
    for (index, (name, rect)) in buttons.iter().enumerate() {
        let least = rect.size().min_elem();
        assert!(
            least > FINGER - NEAR,
            "{what}: {name} has {:?}",
            rect.size()
        );
        let mut inside = screen.expand(NEAR);
        if scrolls {
            (inside.min.y, inside.max.y) = (f32::NEG_INFINITY, f32::INFINITY);
        }
        assert!(inside.contains_rect(*rect), "{what}: {name} at {rect:?}");
        for (other, place) in &buttons[index + 1..] {
            assert!(
                !overlap(*rect, *place),
                "{what}: {name} and {other}, {rect:?}, {place:?}"
            );
        }
    }
}

/// Asserts that all texts of the frame are legible.
fn assert_legible(window: &Window, what: &str) {
    let zoom = window.ctx.zoom_factor();
    for clipped in &window.output().shapes {
        texts(&clipped.shape, &mut |text| {
            for section in &text.galley.job.sections {
                let size = section.format.font_id.size * zoom;
                assert!(
                    size > LETTERS - 0.01,
                    "{what}: {:?} has {size} points",
                    text.galley.text()
                );
            }
        });
    }
}

fn texts(shape: &Shape, look: &mut impl FnMut(&TextShape)) {
    match shape {
        Shape::Text(text) if !text.galley.text().trim().is_empty() => look(text),
        Shape::Vec(shapes) => shapes.iter().for_each(|shape| texts(shape, look)),
        _ => {}
    }
}

/// Visits each size and language.
fn everywhere(visit: impl Fn(&mut Window, Language, &str)) {
    for size in SIZES {
        for language in [Language::English, Language::Japanese] {
            let mut window = phone(size, language);
            visit(&mut window, language, &format!("{size:?} {language:?}"));
        }
    }
}

/// Writes a picture for a person who looks at it, if the variable `LOOK` names a folder.
fn look(window: &mut Window, language: Language, name: &str) {
    let Ok(folder) = std::env::var("LOOK") else {
        return;
    };
    let size = window.ctx.content_rect().size() * window.ctx.zoom_factor();
    let image = window.render().expect("the frame is drawn");
    let path = format!("{folder}/{name}_{language:?}_{}.png", size.x.round());
    image.save(path).expect("the picture is written");
}

#[test]
fn buttons_of_paper_and_block_fit_fingers_and_messages_cover_none() {
    everywhere(|window, language, what| {
        let words = language.making();
        for is_alone in [true, false] {
            match is_alone {
                true => game(window).open_paper(),
                false => {
                    game(window).edit_blank(2);
                    game(window).go(Screen::Editor);
                    game(window).draw_new_body();
                }
            }
            for shows_block in [false, true] {
                if shows_block && !is_alone {
                    continue;
                }
                game(window).maker.show_block(shows_block);
                game(window).notify(words.not_enclosed.to_string());
                game(window).notify(words.draw_first.to_string());
                frames(window, 3);
                let name = if shows_block { "block" } else { "paper" };
                look(window, language, &format!("{name}_{is_alone}"));
                let what = format!("{name}, {what}");
                let without = [words.paper, words.block];
                assert_pressable(window, &what, &without, false);
                assert_legible(window, &what);
                for message in messages(window) {
                    for (name, rect) in buttons(window, &without) {
                        assert!(!overlap(message, rect), "{what}: a message covers {name}");
                    }
                }
            }
        }
    });
}

#[test]
fn buttons_of_finish_fit_fingers_and_messages_cover_none() {
    everywhere(|window, language, what| {
        let words = language.making();
        game(window).go(Screen::Editor);
        game(window).go(Screen::Finish);
        frames(window, 3);
        look(window, language, "finish");
        assert_pressable(window, what, &[], true);
        assert_legible(window, what);
        let saved = (language.words().saved)(
            "my-level-1.toml",
            Some("/home/mika/.local/share/…e/tamaire/games/levels"),
        );
        click(window, words.keep);
        game(window).notify(saved);
        frames(window, 3);
        click(window, words.save_file);
        frames(window, 6);
        look(window, language, "finish_saved");
        assert!(messages(window).len() > 1);
        assert_legible(window, what);
        for (name, _) in buttons(window, &[]) {
            button(window, &name).scroll_to_me();
            frames(window, 30);
            let rect = button(window, &name).rect() * window.ctx.zoom_factor();
            for message in messages(window) {
                assert!(!overlap(message, rect), "{what}: a message covers {name}");
            }
        }
    });
}

#[test]
fn buttons_of_own_levels_fit_fingers_and_remove_is_apart() {
    everywhere(|window, language, what| {
        let words = language.making();
        game(window).go(Screen::Levels);
        frames(window, 3);
        look(window, language, "levels_top");
        let name = game(window).levels.last().unwrap().clone();
        let name = game(window)
            .settings
            .language
            .of(&name.game().name)
            .to_string();
        let of = |text: &str| format!("{text}: {name}");
        button(window, &of(words.remove)).scroll_to_me();
        frames(window, 60);
        look(window, language, "levels_own");
        // The page scrolls below the buttons at its top, which have a test of their own.
        let said = language.words();
        assert_pressable(window, what, &[said.back, said.open], true);
        assert_legible(window, what);
        let zoom = window.ctx.zoom_factor();
        let place = |text: &str| button(window, &of(text)).rect() * zoom;
        let remove = place(words.remove);
        for text in [words.change, words.rename, words.duplicate] {
            let gap = remove.signed_distance_to_pos(place(text).center())
                - 0.5 * place(text).size().min_elem();
            assert!(gap > 4.0, "{what}: {text} is {gap} from {}", words.remove);
        }
        button(window, &of(words.remove)).scroll_to_me();
        click(window, &of(words.rename));
        assert_eq!(screen(window), Screen::Finish);
        assert!(window.get_by_label(words.name).is_focused(), "{what}");
    });
}

#[test]
fn headline_of_levels_is_beside_or_below_its_buttons() {
    everywhere(|window, language, what| {
        game(window).go(Screen::Levels);
        frames(window, 3);
        let said = language.words();
        let title = format!("{}  ★", said.levels);
        let title = window.get_by_label_contains(&title);
        for name in [said.back, said.open] {
            let covered = window.query_by_role_and_label(Role::Button, name);
            if let Some(covered) = covered {
                let size = covered.rect().size() * window.ctx.zoom_factor();
                assert!(
                    size.min_elem() > FINGER - NEAR,
                    "{what}: {name} has {size:?}"
                );
                assert!(!overlap(title.rect(), covered.rect()), "{what}: {name}");
            }
        }
    });
}

#[test]
fn messages_in_the_editor_cover_no_button() {
    everywhere(|window, language, what| {
        game(window).edit_blank(2);
        game(window).go(Screen::Editor);
        for text in [language.making().kept, language.making().copied] {
            game(window).notify(text.to_string());
        }
        frames(window, 3);
        look(window, language, "editor");
        for message in messages(window) {
            for (name, rect) in buttons(window, &[]) {
                assert!(!overlap(message, rect), "{what}: a message covers {name}");
            }
        }
    });
}

#[test]
fn drawing_for_the_editor_is_done_and_goes_back_there() {
    for language in [Language::English, Language::Japanese] {
        let mut window = phone(SIZES[0], language);
        let words = language.making();
        game(&mut window).go(Screen::Editor);
        game(&mut window).draw_new_body();
        frames(&mut window, 3);
        assert!(window.query_by_label(words.drop).is_none());
        let rect = window.get_by_label(words.paper).rect();
        drag(
            &mut window,
            &[rect.center(), rect.center() + vec2(80.0, 0.0)],
        );
        click(&mut window, words.done);
        assert_eq!(screen(&window), Screen::Editor);
    }
}

#[test]
fn tool_shows_its_name_while_keys_focus_it() {
    let mut window = phone(SIZES[1], Language::English);
    game(&mut window).open_paper();
    frames(&mut window, 3);
    let count = |window: &Window| window.get_all_by_label_contains("Mirror").count();
    for _ in 0..60 {
        if button_or_choice(&window, "Mirror").is_focused() {
            break;
        }
        assert_eq!(count(&window), 1);
        press(&mut window, Key::Tab);
    }
    frames(&mut window, 3);
    assert_eq!(count(&window), 2, "the button and its label");
}

fn button_or_choice<'w>(window: &'w Window, name: &'w str) -> egui_kittest::Node<'w> {
    window.get_by(|node| {
        node.label().as_deref() == Some(name)
            && matches!(node.role(), Role::Button | Role::RadioButton)
    })
}

#[test]
fn clearing_is_where_no_tool_of_the_block_is() {
    for size in SIZES {
        let mut window = phone(size, Language::English);
        game(&mut window).open_paper();
        frames(&mut window, 3);
        let clear = button(&window, "New page").rect();
        game(&mut window).maker.show_block(true);
        frames(&mut window, 3);
        for (name, rect) in buttons(&window, &["Block", "New page"]) {
            let rect = rect / window.ctx.zoom_factor();
            assert!(!overlap(clear, rect), "{size:?}: {name}");
        }
    }
}

/// A level whose body lies in the basket at the start.
fn won_by_itself() -> Level {
    let mut scene = Level::open("classic").unwrap().scene().clone();
    let game = scene.game.as_mut().unwrap();
    let basket = game.basket.as_mut().unwrap();
    basket.half = [3.0; 3];
    Level::from_scene("my-level-1", scene).unwrap()
}

#[test]
fn level_that_wins_by_itself_says_so() {
    for language in [Language::English, Language::Japanese] {
        let mut window = phone(SIZES[0], language);
        let (said, words) = (language.words(), language.making());
        game(&mut window).edit_level(&std::sync::Arc::new(won_by_itself()));
        game(&mut window).go(Screen::Finish);
        for _ in 0..600 {
            frames(&mut window, 1);
            if window
                .query_by_label_contains(words.wins_by_itself)
                .is_some()
            {
                break;
            }
        }
        look(&mut window, language, "finish_by_itself");
        window.get_by_label_contains(words.wins_by_itself);
        game(&mut window).go(Screen::Editor);
        game(&mut window).test_level();
        for _ in 0..900 {
            frames(&mut window, 1);
            if screen(&window) == Screen::Result {
                break;
            }
        }
        frames(&mut window, 3);
        look(&mut window, language, "result_by_itself");
        window.get_by_label(said.won_by_itself);
        for route in [tamaire_play::Route::Squeeze, tamaire_play::Route::Shave] {
            assert!(window.query_by_label((said.route)(route)).is_none());
            assert!(window.query_by_label((said.other_way)(route)).is_none());
        }
        assert!(window.query_by_label_contains("-0").is_none());
    }
}

/// Number of lines of the frame in the colour of ropes and springs.
fn ropes(window: &Window) -> usize {
    const ROPE: egui::Color32 = egui::Color32::from_rgb(120, 84, 52);
    let is_rope = |shape: &Shape| match shape {
        Shape::Path(path) => matches!(path.stroke.color, egui::epaint::ColorMode::Solid(ROPE)),
        _ => false,
    };
    let shapes = window.output().shapes.iter();
    shapes.filter(|clipped| is_rope(&clipped.shape)).count()
}

#[test]
fn thumbnails_show_ropes_and_springs() {
    let mut window = open(Files::nowhere(), SIZES[0], 1.0);
    for id in ["classic", "walk-the-dog", "yo-yo-fishing"] {
        let mut scene = Level::open(id).unwrap().scene().clone();
        let joints = scene.joint.len();
        // A level of others, which is shown before it is played.
        scene.game.as_mut().unwrap().name.en = "Theirs".into();
        let level = Level::from_scene("theirs", scene).unwrap();
        let link = level.link().unwrap();
        game(&mut window).open_link(&format!("https://example.org/#{link}"));
        frames(&mut window, 80);
        assert_eq!(screen(&window), Screen::Offered);
        look(&mut window, Language::English, &format!("offered_{id}"));
        assert_eq!(ropes(&window) > 0, joints > 0, "{id}");
        press(&mut window, Key::Escape);
    }
}
