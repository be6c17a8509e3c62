//! Checks on the page on which a level is finished.

use crate::told::tells;
use crate::window::*;
use app_shell::Clock;
use egui::accesskit::Role;
use egui::vec2;
use egui_kittest::kittest::{NodeT, Queryable};
use fuwafuwa_scenes::Scene;
use std::cell::Cell;
use std::sync::Arc;
use tamaire::game::Screen;
use tamaire::platform::Files;
use tamaire_play::Level;
use tamaire_play::level::NAMED;

/// Returns the progress of the checks as it is told [%]. `None` = no progress is shown.
fn progress(window: &Window) -> Option<u32> {
    let bar = window.query_by_role(Role::ProgressIndicator)?;
    let label = bar.accesskit_node().label()?;
    label.strip_suffix(" %")?.parse().ok()
}

#[test]
fn checks_show_their_progress_until_all_is_found() {
    let (id, text) = NAMED[0];
    let scene = Scene::read(id, text, &["body.n=6".to_string()]).unwrap();
    let level = Arc::new(Level::from_scene("small", scene).unwrap());
    // A tick takes two readings of the clock. The time that the maker needs is not measured with it.
    for (reading, is_quick) in [(0.0002, true), (0.01, false)] {
        let mut window = open(Files::nowhere(), vec2(1000.0, 1400.0), 0.25);
        let words = window.state().game.making();
        let [squeezed, shaved] = words.can_be;
        game(&mut window).edit_level(&level);
        game(&mut window).test_level();
        win(&mut window);
        game(&mut window).go(Screen::Editor);
        let now = Cell::new(0.0);
        game(&mut window).clock = Clock::of(move || {
            now.set(now.get() + reading);
            now.get()
        });
        game(&mut window).go(Screen::Finish);
        frames(&mut window, 2);
        for open in [squeezed, shaved, words.real_time] {
            window.get_by_label(&format!("…  {open}"));
        }
        let mut shares = vec![progress(&window).expect("the progress is shown")];
        while let Some(share) = progress(&window) {
            assert!(tells(&window, "Bots are trying"));
            shares.push(share);
            frames(&mut window, 1);
            assert!(shares.len() < 20_000);
        }
        assert!(shares.is_sorted() && shares[0] < 10, "{shares:?}");
        shares.dedup();
        assert!(
            shares.len() > 20 && *shares.last().unwrap() > 80,
            "{shares:?}"
        );
        assert!(!tells(&window, "Bots are trying") && !tells(&window, "…"));
        assert!(tells(&window, &format!("✓  {squeezed}  ")));
        assert!(tells(&window, &format!("✓  {}  ", words.won_by_maker)));
        let real_time = match is_quick {
            true => format!("✓  {}", words.real_time),
            false => format!("!  {}", words.not_real_time),
        };
        window.get_by_label(&real_time);
    }
}
