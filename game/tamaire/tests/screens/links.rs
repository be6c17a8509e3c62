//! Rounds and levels shared as links.

use crate::window::*;
use egui::{Event, OutputCommand};
use tamaire::game::Screen;
use tamaire::platform::Files;
use tamaire::words::Language;

/// Returns the text that a button copies to the clipboard.
fn copied(window: &mut Window, button: &str) -> String {
    self::button(window, button).click();
    for _ in 0..5 {
        window.step();
        let commands = &window.output().platform_output.commands;
        let mut texts = commands.iter().filter_map(|command| match command {
            OutputCommand::CopyText(text) => Some(text.clone()),
            _ => None,
        });
        if let Some(text) = texts.next() {
            return text;
        }
    }
    panic!("nothing was copied");
}

fn paste(window: &mut Window, text: &str) {
    window.event(Event::Paste(text.to_string()));
    frames(window, 3);
}

#[test]
fn round_link_is_watched_and_raced() {
    let mut sender = window(Files::nowhere());
    game(&mut sender).start(0);
    win(&mut sender);
    assert_eq!(screen(&sender), Screen::Result);
    let link = copied(&mut sender, "Copy link");
    assert!(link.starts_with("#r1") && link.len() < 2000, "{link}");

    let mut receiver = window(Files::nowhere());
    for (button, is_played) in [("Watch", false), ("Race it", true)] {
        paste(&mut receiver, &format!("https://example.org/play/{link}"));
        assert_eq!(screen(&receiver), Screen::Offered);
        click(&mut receiver, button);
        assert_eq!(screen(&receiver), Screen::Play);
        let session = &game(&mut receiver).bout.session;
        assert_eq!(session.is_played(), is_played);
        assert_eq!(session.ghost().is_some(), is_played);
    }
    paste(&mut receiver, &link);
    click(&mut receiver, "Back");
    assert_eq!(screen(&receiver), Screen::Title);
}

#[test]
fn level_link_is_played() {
    let mut sender = window(Files::nowhere());
    game(&mut sender).start(2);
    frames(&mut sender, 5);
    game(&mut sender).pause_round();
    frames(&mut sender, 3);
    let link = copied(&mut sender, "Link to this level");
    let mut receiver = window(Files::nowhere());
    paste(&mut receiver, &link);
    assert_eq!(screen(&receiver), Screen::Play);
    assert_eq!(game(&mut receiver).chosen, 2);
}

#[test]
fn invalid_link_is_reported_in_each_language() {
    for (language, _) in Language::ALL {
        let mut window = window(Files::nowhere());
        game(&mut window).settings.language = language;
        for text in [
            "hello",
            "#r1AAAA",
            "#r9AAAAz",
            "#l1zzzz",
            "https://example.org/#",
        ] {
            game(&mut window).notices.clear();
            paste(&mut window, text);
            assert_eq!(screen(&window), Screen::Title);
            let game = game(&mut window);
            assert_eq!(game.notices.iter().count(), 1, "{text}: {language:?}");
        }
    }
}
