//! Public stand: visitors come, play and go, and staff use its pages.

use crate::contrast;
use crate::pads::about;
use crate::window::*;
use app_shell::{Clock, Pads};
use egui::accesskit::Role;
use egui::{Event, Key, PointerButton, Pos2, Vec2, pos2, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use fuwafuwa::DEFAULT_TICK;
use jiff::civil::Time;
use std::cell::RefCell;
use std::path::{Path, PathBuf};
use std::rc::Rc;
use sticks::{Device, DeviceId, Snapshot};
use tamaire::app::App;
use tamaire::exhibit::config::DEFAULT_CONFIG;
use tamaire::exhibit::presence::Attention;
use tamaire::exhibit::staff::StaffPage;
use tamaire::exhibit::{Phase, Stand};
use tamaire::game::{Game, Screen};
use tamaire::look::Stage;
use tamaire::platform::{Files, Sound, StandFolder, TextFile};
use tamaire::screens::{CrashScreen, StandController};
use tamaire::words::Language;
use tamaire_logbook::{Error, Kind, Logbook, Round, RoundEnd, Visit};
use tamaire_play::{BotKind, Playback, Replay};
use tempfile::TempDir;

/// Stand in a test window, shared with the test.
struct Shown {
    window: Window,
    stand: Rc<RefCell<Stand>>,
    folder: TempDir,
}

/// Controller that the window owns; the test keeps access to the stand.
struct Shared(Rc<RefCell<Stand>>);

impl StandController for Shared {
    fn pass(&mut self, game: &mut Game, ctx: &egui::Context, seconds: f32) {
        StandController::pass(&mut *self.0.borrow_mut(), game, ctx, seconds);
    }

    fn show(&mut self, game: &mut Game, stage: &mut Stage, ui: &mut egui::Ui) {
        self.0.borrow_mut().show(game, stage, ui);
    }

    fn end(&mut self) {
        self.0.borrow_mut().end();
    }

    fn close(&mut self, game: &mut Game) {
        StandController::close(&mut *self.0.borrow_mut(), game);
    }
}

/// Opens a stand with the usual configuration file, changed by text replacements, in a window with few pixels, which draws
/// quickly.
fn shown(size: Vec2, changes: &[(&str, &str)]) -> Shown {
    shown_with_pixels(size, 0.25, changes)
}

/// Opens a stand like [`shown`] with `pixels` pixels per point.
fn shown_with_pixels(size: Vec2, pixels: f32, changes: &[(&str, &str)]) -> Shown {
    let folder = folder();
    let mut text = DEFAULT_CONFIG.replace(
        "#folder = \"/var/lib/tam\"",
        &format!("folder = {:?}", folder.path()),
    );
    for (usual, wanted) in changes {
        assert!(text.contains(usual), "{usual}");
        text = text.replace(usual, wanted);
    }
    let file = TextFile(folder.path().join("exhibit.toml"));
    file.write(&text).unwrap();
    let stand = Stand::open(file).unwrap().at(Time::constant(12, 0, 0, 0));
    let stand = Rc::new(RefCell::new(stand));
    let kept = stand.clone();
    let builder = Harness::builder()
        .with_size(size)
        .wgpu()
        .with_pixels_per_point(pixels);
    let builder = builder.with_step_dt(DEFAULT_TICK).with_render_cursor(false);
    let builder = builder.with_theme(egui::Theme::Light);
    let mut window = builder.build_eframe(|context| {
        let mut game = Game::new(Files::nowhere(), Sound::none(), Pads::none());
        game.clock = Clock::of(|| 0.0);
        kept.borrow_mut().prepare(&mut game);
        let mut app = App::new(context, game).expect("a GPU or a software adapter is available");
        app.attendant = Some(Box::new(Shared(kept)));
        app
    });
    frames(&mut window, 2);
    let zoom = window.ctx.zoom_factor();
    window.set_size(size / zoom);
    frames(&mut window, 2);
    Shown {
        window,
        stand,
        folder,
    }
}

impl Shown {
    fn phase(&self) -> Phase {
        self.stand.borrow().phase
    }

    /// Advances by `seconds` without input.
    fn rest(&mut self, seconds: f32) {
        let ctx = self.window.ctx.clone();
        let mut stand = self.stand.borrow_mut();
        let game = game(&mut self.window);
        for _ in 0..(seconds / DEFAULT_TICK) as usize {
            game.update(DEFAULT_TICK);
            // Events left in the context by an earlier frame would count as input.
            ctx.input_mut(|input| {
                input.events.clear();
                input.raw.events.clear();
            });
            stand.pass(game, &ctx, DEFAULT_TICK);
        }
    }

    fn touch(&mut self) {
        press(&mut self.window, Key::Space);
    }

    /// Lets a bot play until it wins.
    fn win(&mut self, kind: BotKind) {
        drive(game(&mut self.window), kind, |game| game.bout.won.is_none());
        game(&mut self.window).update(2.0);
        frames(&mut self.window, 50);
        assert_eq!(screen(&self.window), Screen::Result);
    }

    /// Chooses the first level with `key`, and lets a bot win it.
    fn win_first(&mut self, key: Key) {
        frames(&mut self.window, 50);
        press(&mut self.window, key);
        assert_eq!(self.phase(), Phase::Visit);
        self.win(BotKind::Squeeze);
    }

    /// Closes the stand and returns the contents of its logbook.
    fn end(self) -> (Vec<Visit>, Vec<Round>, Vec<tamaire_logbook::Event>) {
        let Self {
            mut window,
            stand,
            folder,
        } = self;
        stand.borrow_mut().close(game(&mut window));
        drop(window);
        drop(stand);
        read(folder.path())
    }
}

/// Returns a function that adds a row to `rows`.
fn into<T>(rows: &mut Vec<T>) -> impl FnMut(T) -> Result<(), Error> {
    |row| {
        rows.push(row);
        Ok(())
    }
}

fn read(folder: &Path) -> (Vec<Visit>, Vec<Round>, Vec<tamaire_logbook::Event>) {
    let logbook = Logbook::read(&StandFolder(folder.into()).logbook()).unwrap();
    let (mut visits, mut rounds, mut events) = (Vec::new(), Vec::new(), Vec::new());
    logbook.visits(.., into(&mut visits)).unwrap();
    logbook.rounds(.., into(&mut rounds)).unwrap();
    logbook.events(.., into(&mut events)).unwrap();
    (visits, rounds, events)
}

#[test]
fn visit_starts_with_touch_and_is_logged() {
    let mut shown = shown(vec2(960.0, 600.0), &[]);
    assert_eq!(shown.phase(), Phase::Attract);
    shown.rest(60.0);
    assert_eq!(shown.phase(), Phase::Attract, "no visitor yet");
    shown.touch();
    assert_eq!(
        (shown.phase(), screen(&shown.window)),
        (Phase::Visit, Screen::Play)
    );
    shown.win(BotKind::Squeeze);
    let again = game(&mut shown.window).words().play_again;
    click(&mut shown.window, again);
    assert_eq!(screen(&shown.window), Screen::Play);
    // The visitor restarts the round and leaves in the middle of it.
    frames(&mut shown.window, 60);
    press(&mut shown.window, Key::R);
    frames(&mut shown.window, 30);
    shown.rest(19.0);
    assert_eq!(shown.phase(), Phase::Visit);
    shown.rest(12.0);
    assert_eq!(shown.phase(), Phase::Attract);
    let (visits, rounds, _) = shown.end();
    assert_eq!(visits.len(), 1);
    assert!(visits[0].ended.is_some());
    let ends: Vec<RoundEnd> = rounds.iter().map(|round| round.end).collect();
    assert_eq!(ends, [RoundEnd::Won, RoundEnd::Retried, RoundEnd::Left]);
    assert_eq!(
        rounds.iter().map(|round| round.number).collect::<Vec<_>>(),
        [1, 2, 3]
    );
    assert_eq!(
        rounds[1].dare,
        Some(tamaire_play::Route::Shave),
        "{:?}",
        rounds[1]
    );
    for round in rounds {
        let replay = Replay::of_fragment(&round.replay).unwrap();
        let mut playback = Playback::new(replay.into()).unwrap();
        while !playback.is_over() {
            playback.step().unwrap();
        }
        let outcome = playback.round().progress().outcome;
        assert_eq!(outcome.map(|outcome| outcome.route), round.route);
    }
}

#[test]
fn countdown_is_cancelled_by_touch() {
    let mut shown = shown(vec2(960.0, 600.0), &[]);
    shown.touch();
    shown.rest(25.0);
    frames(&mut shown.window, 2);
    let attention = shown.stand.borrow().attention;
    assert!(matches!(attention, Attention::Leaving(left) if (0.3..0.7).contains(&left)));
    shown.touch();
    assert_eq!(shown.stand.borrow().attention, Attention::There);
    shown.rest(19.0);
    assert_eq!(
        (shown.phase(), screen(&shown.window)),
        (Phase::Visit, Screen::Play)
    );
}

#[test]
fn next_visitor_finds_initial_state() {
    let mut shown = shown(vec2(960.0, 600.0), &[]);
    shown.touch();
    frames(&mut shown.window, 3);
    assert_eq!(
        game(&mut shown.window).settings.language,
        Language::Japanese
    );
    click(&mut shown.window, "English");
    assert_eq!(game(&mut shown.window).settings.language, Language::English);
    press(&mut shown.window, Key::F);
    assert_eq!(
        game(&mut shown.window).settings.language,
        Language::Japanese
    );
    press(&mut shown.window, Key::F);
    press(&mut shown.window, Key::E);
    let game = game(&mut shown.window);
    assert_eq!(game.settings.language, Language::English);
    assert!(game.bout.elements.is_some());
    game.controls
        .players
        .join(tamaire::input::InputSource::Keys);
    game.forces.cut();
    shown.rest(31.0);
    let game = crate::window::game(&mut shown.window);
    assert_eq!(game.settings.language, Language::Japanese);
    assert!(!game.forces.is_cut(), "the next visitor has forces again");
    assert!(game.bout.elements.is_none() && game.controls.players.second().is_none());
}

#[test]
fn visitor_cannot_leave_the_stand() {
    let mut shown = shown(vec2(960.0, 600.0), &[("#pin = \"…\"", "pin = \"2004\"")]);
    shown.touch();
    for key in [
        Key::Escape,
        Key::P,
        Key::F11,
        Key::F,
        Key::Period,
        Key::Tab,
        Key::Enter,
    ] {
        press(&mut shown.window, key);
        assert_eq!(screen(&shown.window), Screen::Play, "{key:?}");
        assert!(!game(&mut shown.window).bout.slow && !game(&mut shown.window).bout.stepping);
    }
    shown
        .window
        .event(Event::Paste("https://example.org/#r1AAz".into()));
    shown.window.event(Event::WindowFocused(false));
    frames(&mut shown.window, 2);
    assert_eq!(screen(&shown.window), Screen::Play);
    assert!(shown.window.query_by_label("おわる").is_none());
}

/// Presses or releases the mouse button.
fn button_at(window: &mut Window, pos: Pos2, pressed: bool) {
    window.event(Event::PointerMoved(pos));
    window.event(pointer_button(pos, PointerButton::Primary, pressed));
    frames(window, 1);
}

#[test]
fn staff_enters_pin_and_changes_settings() {
    let pin = ("#pin = \"…\"", "pin = \"2004\"");
    let mut shown = shown(vec2(960.0, 600.0), &[pin, ("\"japanese\"", "\"english\"")]);
    let width = shown.window.ctx.content_rect().width();
    let corner = pos2(width - 10.0, 10.0);
    button_at(&mut shown.window, corner, true);
    frames(&mut shown.window, 200);
    button_at(&mut shown.window, corner, false);
    assert_eq!(shown.phase(), Phase::PinEntry);
    for digit in ["1", "2", "3", "4"] {
        click(&mut shown.window, digit);
    }
    assert_eq!(shown.phase(), Phase::PinEntry, "wrong PIN");
    // A mistyped digit is deleted.
    for key in ["2", "0", "7", "Delete", "0", "4"] {
        click(&mut shown.window, key);
    }
    assert!(matches!(shown.phase(), Phase::Staff(_)));
    let (visits, _, _) = read(shown.folder.path());
    assert!(visits.is_empty(), "staff does not count as a visitor");
    click(&mut shown.window, "Stand");
    let japanese = shown.window.get_by_label("Language: 日本語");
    japanese.click();
    frames(&mut shown.window, 2);
    let file = TextFile(shown.folder.path().join("exhibit.toml"));
    assert!(
        file.read_or("")
            .unwrap()
            .contains("language = \"japanese\"")
    );
    let said = Language::Japanese.at_stand();
    let at = button(&shown.window, said.end).rect().center();
    click(&mut shown.window, said.end);
    for pressed in [true, false] {
        button_at(&mut shown.window, at, pressed);
    }
    assert!(
        !shown.stand.borrow().is_ended,
        "a second press at the same place ends nothing"
    );
    assert_eq!(shown.phase(), Phase::Staff(StaffPage::End));
    click(&mut shown.window, said.keep_open);
    assert_eq!(shown.phase(), Phase::Staff(StaffPage::Settings));
    click(&mut shown.window, "もどる");
    assert_eq!(shown.phase(), Phase::Attract);
    assert_eq!(
        game(&mut shown.window).settings.language,
        Language::Japanese
    );
}

/// Opens a stand with a page for QR codes, and with enough pixels to draw them.
fn with_codes(size: Vec2) -> Shown {
    let page = (
        "#page = \"https://…/\"",
        "page = \"https://museum.example/tamaire/\"",
    );
    shown_with_pixels(size, 0.5, &[page])
}

#[test]
fn code_is_shown_twice_as_long() {
    let mut shown = with_codes(vec2(1280.0, 800.0));
    shown.touch();
    shown.win(BotKind::Squeeze);
    frames(&mut shown.window, 130);
    assert!(shown.stand.borrow().to_take_home().is_some());
    // Input counts as the start of the time without input.
    press(&mut shown.window, Key::F);
    shown.rest(39.0);
    assert_eq!(shown.stand.borrow().attention, Attention::There);
    shown.rest(3.0);
    let attention = shown.stand.borrow().attention;
    assert!(
        matches!(attention, Attention::Leaving(left) if left > 0.8),
        "{attention:?}"
    );
    assert_eq!(shown.stand.borrow().countdown(), 20.0);
    shown.rest(17.0);
    assert_eq!(shown.phase(), Phase::Visit);
    shown.rest(3.0);
    assert_eq!(shown.phase(), Phase::Attract);
}

#[test]
fn winner_is_visible_between_result_and_code() {
    for size in [
        vec2(1280.0, 800.0),
        vec2(1920.0, 1080.0),
        vec2(1080.0, 1920.0),
    ] {
        let mut shown = with_codes(size);
        shown.touch();
        shown.win(BotKind::Squeeze);
        frames(&mut shown.window, 130);
        let code = { shown.window.query_all_by_role(Role::Image) }.next();
        let code = code.expect("a code is shown").rect();
        let again = game(&mut shown.window).words().play_again;
        let card = button(&shown.window, again).rect();
        let bout = &shown.window.state().game.bout;
        let (view, level) = (bout.view.unwrap(), bout.round().level());
        let basket = level.game().basket.as_ref().unwrap();
        let middle = view.to_screen(fuwafuwa::Vec3::from(basket.centre));
        // Half the size of the body in the basket.
        let face = 0.25 * view.scale;
        for covered in [code, card] {
            let covered = covered.expand(face);
            assert!(
                !covered.contains(middle),
                "{size}: {middle:?} in {covered:?}"
            );
        }
        assert!(
            shown
                .window
                .ctx
                .content_rect()
                .shrink(face)
                .contains(middle),
            "{middle:?}"
        );
    }
}

#[test]
fn press_that_began_before_result_chooses_nothing() {
    let mut shown = shown(vec2(1280.0, 800.0), &[]);
    shown.touch();
    shown.win(BotKind::Squeeze);
    let again = game(&mut shown.window).words().play_again;
    let at = button(&shown.window, again).rect().center();
    // The same win once more, now with the button held at the place where the choice appears.
    click(&mut shown.window, again);
    let drive_on = |game: &Game| game.bout.won.is_none();
    drive(game(&mut shown.window), BotKind::Squeeze, drive_on);
    button_at(&mut shown.window, at, true);
    game(&mut shown.window).update(2.0);
    frames(&mut shown.window, 90);
    button_at(&mut shown.window, at, false);
    frames(&mut shown.window, 3);
    assert_eq!(
        screen(&shown.window),
        Screen::Result,
        "the press began before"
    );
    for pressed in [true, false] {
        button_at(&mut shown.window, at, pressed);
    }
    frames(&mut shown.window, 2);
    assert_eq!(screen(&shown.window), Screen::Play, "a new press chooses");
}

#[test]
fn choice_appears_settles_and_explains_its_signs() {
    let levels = ("[\"classic\"]", "[\"classic\", \"neck\"]");
    let mut shown = shown(
        vec2(1280.0, 800.0),
        &[levels, ("\"japanese\"", "\"english\"")],
    );
    shown.touch();
    shown.win_first(Key::Enter);
    click(&mut shown.window, "Another level");
    assert_eq!(shown.phase(), Phase::Choice);
    // The press that opened the choice may be followed at once by another one.
    press(&mut shown.window, Key::Enter);
    assert_eq!(
        shown.phase(),
        Phase::Choice,
        "nobody has seen the choice yet"
    );
    frames(&mut shown.window, 50);
    shown.window.get_by_label("star earned");
    press(&mut shown.window, Key::Enter);
    assert_eq!(shown.phase(), Phase::Visit);
}

#[test]
fn texts_of_the_stand_have_contrast() {
    let pin = ("#pin = \"…\"", "pin = \"2004\"");
    let levels = ("[\"classic\"]", "[\"classic\", \"neck\"]");
    let mut shown = shown(vec2(1280.0, 800.0), &[pin, levels]);
    let mut count = contrast::check(&mut shown.window, "attract");
    shown.window.set_size(vec2(600.0, 1000.0));
    frames(&mut shown.window, 3);
    count += contrast::check(&mut shown.window, "attract, upright");
    shown.window.set_size(vec2(1280.0, 800.0));
    shown.touch();
    frames(&mut shown.window, 50);
    count += contrast::check(&mut shown.window, "choice");
    press(&mut shown.window, Key::Enter);
    frames(&mut shown.window, 2);
    count += contrast::check(&mut shown.window, "play");
    shown.rest(24.0);
    frames(&mut shown.window, 2);
    count += contrast::check(&mut shown.window, "leaving");
    shown.touch();
    shown.win(BotKind::Squeeze);
    count += contrast::check(&mut shown.window, "result");
    let pages = StaffPage::ALL.into_iter().chain([StaffPage::End]);
    let phases = [Phase::PinEntry].into_iter().chain(pages.map(Phase::Staff));
    for phase in phases {
        shown.stand.borrow_mut().phase = phase;
        frames(&mut shown.window, 4);
        count += contrast::check(&mut shown.window, &format!("{phase:?}"));
    }
    assert!(count > 70, "{count} texts");
}

#[test]
fn stand_is_closed_outside_opening_hours() {
    let hours = [
        ("#[hours]", "[hours]"),
        ("#open = \"10:00\"", "open = \"13:30\""),
        ("#close = \"18:00\"", "close = \"18:00\""),
    ];
    let mut shown = shown(vec2(960.0, 600.0), &hours);
    frames(&mut shown.window, 3);
    assert_eq!(shown.phase(), Phase::Closed);
    shown.touch();
    assert_eq!(shown.phase(), Phase::Closed);
    let (visits, _, _) = shown.end();
    assert!(visits.is_empty());
}

#[test]
fn invalid_configuration_is_reported_with_line() {
    let folder = folder();
    let file = TextFile(folder.path().join("exhibit.toml"));
    file.write(&DEFAULT_CONFIG.replace("rest = 20", "rest = -1"))
        .unwrap();
    let Err(error) = Stand::open(file) else {
        panic!("the configuration is invalid");
    };
    assert!(
        error.contains("exhibit.toml") && error.contains("line 13"),
        "{error}"
    );
}

#[test]
fn unplugged_stick_is_logged_and_play_continues() {
    let mut shown = shown(vec2(960.0, 600.0), &[]);
    let stick = Device::at_rest(DeviceId(1), about("Stick"), 2, 4, 0);
    shown.touch();
    for plugged in [vec![stick.clone()], Vec::new(), vec![stick]] {
        game(&mut shown.window).controls.pads = Pads::of(Snapshot { devices: plugged });
        frames(&mut shown.window, 3);
        assert_eq!(screen(&shown.window), Screen::Play);
    }
    let (_, _, events) = shown.end();
    let kinds = events.into_iter().map(|event| (event.kind, event.text));
    let kinds: Vec<_> = kinds.collect();
    let told = |kind: Kind, text: &str| (kind, text.to_string());
    let expected = [
        told(Kind::DeviceFound, "Stick"),
        told(Kind::DeviceLost, "Stick"),
        told(Kind::DeviceFound, "Stick"),
    ];
    assert_eq!(kinds[1..4], expected);
}

/// Writes pictures of all screens in several sizes, to be looked at: `cargo test -p tamaire --test screens --
/// stand_seen --ignored`.
#[test]
#[ignore = "writes pictures for people to look at"]
fn stand_seen() {
    let out = PathBuf::from(std::env::var_os("OUT").expect("OUT names a folder"));
    std::fs::create_dir_all(&out).unwrap();
    for (size, name) in [
        (vec2(1920.0, 1080.0), "wide"),
        (vec2(1080.0, 1920.0), "upright"),
        (vec2(3840.0, 2160.0), "4k"),
        (vec2(1280.0, 720.0), "small"),
    ] {
        for (language, tag) in [("english", "en"), ("japanese", "ja")] {
            let changes = [
                ("\"japanese\"", format!("{language:?}")),
                (
                    "[\"classic\"]",
                    "[\"classic\", \"neck\", \"classic-3d\"]".into(),
                ),
                (
                    "#page = \"https://…/\"",
                    "page = \"https://museum.example/tamaire/\"".into(),
                ),
                ("#pin = \"…\"", "pin = \"2004\"".into()),
            ];
            let changes: Vec<_> = changes.iter().map(|(a, b)| (*a, b.as_str())).collect();
            let mut shown = shown_with_pixels(size, 1.0, &changes);
            let save = |shown: &mut Shown, what: &str| {
                let image = shown.window.render().unwrap();
                image
                    .save(out.join(format!("{name}-{tag}-{what}.png")))
                    .unwrap();
            };
            shown.rest(5.0);
            frames(&mut shown.window, 2);
            save(&mut shown, "attract");
            shown.touch();
            frames(&mut shown.window, 40);
            save(&mut shown, "choice");
            press(&mut shown.window, Key::Enter);
            frames(&mut shown.window, 60);
            save(&mut shown, "play");
            shown.rest(24.0);
            frames(&mut shown.window, 2);
            save(&mut shown, "leaving");
            shown.touch();
            shown.win(BotKind::Shave);
            frames(&mut shown.window, 130);
            save(&mut shown, "result");
            shown.stand.borrow_mut().phase = Phase::PinEntry;
            frames(&mut shown.window, 3);
            save(&mut shown, "door");
            for page in StaffPage::ALL.into_iter().chain([StaffPage::End]) {
                shown.stand.borrow_mut().phase = Phase::Staff(page);
                frames(&mut shown.window, 4);
                save(&mut shown, &format!("{page:?}"));
            }
            shown.window.state_mut().attendant = Some(Box::new(CrashScreen::default()));
            frames(&mut shown.window, 2);
            save(&mut shown, "calm");
        }
    }
}
