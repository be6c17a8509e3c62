//! Simulates days of a public stand, as fast as the machine can.
//!
//! Simulated visitors come, hesitate, play alone or in pairs, press buttons at random, leave in the middle of
//! a round, and try again. Simulated staff open the staff pages. Each hour of the stand is reported. At the
//! end, the logbook must contain all rounds that ended, each round must be reproducible, and memory and frame
//! times must not have grown.
//!
//! Most frames are laid out but not drawn, because drawing in software takes longer than everything else.
//!
//! ```text
//! cargo run --release -p tamaire --example exhibit_day -- 8 [COPY]
//! ```
//!
//! simulates 8 hours, and copies the logbook to COPY if given.

use app_shell::{Clock, Pads, with_small_memory_blocks};
use cpu_time::ThreadTime;
use eframe::egui_wgpu::{RenderState, RendererOptions};
use eframe::wgpu::PollType;
use egui::{Event, Key, Modifiers, PointerButton, pos2, vec2};
use egui_kittest::Harness;
use egui_kittest::wgpu::{WgpuTestRenderer, create_render_state, default_wgpu_setup};
use peak_alloc::PeakAlloc;
use std::path::Path;
use std::process::ExitCode;
use sticks::{Device, DeviceId, DeviceInfo, Labels, Pad, PadButton, Snapshot};
use tamaire::app::App;
use tamaire::exhibit::Stand;
use tamaire::exhibit::config::DEFAULT_CONFIG;
use tamaire::game::{Game, Screen};
use tamaire::platform::{Files, Sound, StandFolder, TextFile, memory};
use tamaire_logbook::{Error, Logbook, Round};
use tamaire_play::{Bot, BotKind, Playback, Replay};

/// Game time of a frame [s], equal to six ticks.
const STEP: f64 = 0.1;
/// One frame in 50 is drawn.
const DRAWN: u64 = 50;
const SIZE: egui::Vec2 = vec2(640.0, 400.0);
/// Counts allocations on the heap. The memory of the whole process is too coarse a measure: it changes by
/// blocks of the operating system and of the software adapter.
#[global_allocator]
static HEAP: PeakAlloc = PeakAlloc;

/// Permitted growth of the memory in use between the first and the last hour [%].
const MORE_MEMORY: f64 = 5.0;
/// Permitted growth of the frame time between the first and the last hour [%].
const SLOWER: f64 = 10.0;
/// Frames in a minute.
const MINUTE: u64 = (60.0 / STEP) as u64;
/// PIN of the staff.
const PIN: &str = "2004";
/// Amplitude of a hand's tremor [points].
const TREMBLE: f32 = 6.0;

/// Behaviour of a visitor.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Manner {
    /// Plays with the mouse as a bot does, with an unsteady hand.
    Plays(BotKind),
    /// Plays with the mouse while a second player uses the pad.
    Pair(BotKind),
    /// Plays with the pad, moving in circles.
    Pad,
    /// Holds the hidden corner of the screen, as staff does, and enters this PIN, right or wrong.
    Staff(&'static str),
    /// Presses buttons at random.
    Mashes,
    /// Touches the stand, watches, and leaves.
    Looks,
}

/// Simulated visitor.
struct Visitor {
    manner: Manner,
    bot: Bot,
    /// Remaining time of hesitation [s].
    hesitates: f64,
    /// Remaining time until the visitor leaves [s].
    patience: f64,
    /// Remaining number of retries.
    tries: u32,
    /// Frames in which the visitor did not hesitate.
    frame: usize,
}

/// Stand and its current visitor.
struct Day {
    window: Harness<'static, App>,
    gpu: RenderState,
    random: fastrand::Rng,
    pad: Device,
    visitor: Option<Visitor>,
    /// Remaining time until the next visitor [s].
    quiet: f64,
    frames: u64,
    /// Duration of each frame in this hour [ms].
    times: Vec<f64>,
    /// Memory in use on heap and GPU in each minute of this hour [MB].
    used: Vec<f64>,
    /// Memory held by the process in each minute of this hour [MB].
    held: Vec<f64>,
    /// Medians of each hour: memory in use [MB], memory held by the process [MB], frame time [ms].
    hours: Vec<[f64; 3]>,
    visitors: u64,
    wins: u64,
    /// Number of visitors' rounds whose end was observed.
    ended: u64,
    /// Ticks of the current round of a visitor, and whether the round is won.
    round: Option<(u64, bool)>,
    /// Maximum time from a visitor's arrival to the first frame in which the hand can move [ms].
    welcome: f64,
}

impl Day {
    fn somebody(&mut self) -> Visitor {
        let random = &mut self.random;
        let kinds = [BotKind::Squeeze, BotKind::Shave, BotKind::Random];
        let manner = match random.u32(..20) {
            0..8 => Manner::Plays(kinds[random.usize(..2)]),
            8..10 => Manner::Plays(BotKind::Random),
            10..13 => Manner::Pair(kinds[random.usize(..3)]),
            13..15 => Manner::Pad,
            15..17 => Manner::Mashes,
            17 => Manner::Staff(if random.bool() { PIN } else { "7777" }),
            _ => Manner::Looks,
        };
        let bot = match manner {
            Manner::Plays(kind) | Manner::Pair(kind) => kind,
            _ => BotKind::Idle,
        };
        let looks = manner == Manner::Looks;
        Visitor {
            manner,
            bot: Bot::new(bot, random.u64(..)),
            hesitates: 5.0 * random.f64(),
            patience: if looks {
                1.0
            } else {
                10.0 + 110.0 * random.f64()
            },
            tries: random.u32(..4),
            frame: 0,
        }
    }

    /// Adds the input events of the current visitor for one frame.
    fn act(&mut self, events: &mut Vec<Event>) {
        let Some(visitor) = &mut self.visitor else {
            self.quiet -= STEP;
            if self.quiet < 0.0 {
                self.visitor = Some(self.somebody());
                self.visitors += 1;
                self.quiet = 10.0 + 60.0 * self.random.f64();
                tap(events, Key::Space);
            }
            return;
        };
        visitor.patience -= STEP;
        visitor.hesitates -= STEP;
        if visitor.patience < 0.0 {
            self.visitor = None;
            let pad = self.pad.pad.get_or_insert_default();
            for button in PadButton::ALL {
                pad.button_mut(button).down = false;
            }
            pad.left = [0.0; 2];
            return;
        }
        if visitor.hesitates > 0.0 {
            return;
        }
        visitor.frame += 1;
        let game = &mut self.window.state_mut().game;
        let random = &mut self.random;
        match (game.screen(), visitor.manner) {
            (Screen::Result, _) if visitor.tries == 0 => visitor.patience = 0.0,
            (Screen::Result, _) => {
                visitor.tries -= 1;
                visitor.hesitates = 2.0 + 3.0 * random.f64();
                tap(events, Key::Enter);
            }
            (_, Manner::Staff(number)) => knock(events, visitor.frame, number),
            (_, Manner::Plays(_) | Manner::Pair(_)) => {
                let goal = game.bout.round().ask(&mut visitor.bot).goal(0);
                let view = game.bout.view;
                if let (Some(goal), Some(view)) = (goal, view) {
                    let shake = egui::vec2(random.f32() - 0.5, random.f32() - 0.5) * TREMBLE;
                    events.push(Event::PointerMoved(view.to_screen(goal) + shake));
                }
                if random.u32(..600) == 0 {
                    tap(events, Key::R);
                }
            }
            (_, Manner::Pad) => {
                let pad = self.pad.pad.get_or_insert_default();
                let turn = visitor.patience as f32 * 1.7;
                pad.left = [turn.cos(), turn.sin()];
                if random.u32(..40) == 0 {
                    pad.button_mut(PadButton::Back).press();
                }
            }
            (_, Manner::Mashes) => mash(events, random),
            (_, Manner::Looks) => {}
        }
        if let Manner::Pair(_) = visitor.manner {
            let pad = self.pad.pad.get_or_insert_default();
            let turn = visitor.frame as f32 * 0.1;
            pad.left = [turn.cos(), turn.sin()];
            if visitor.frame == 1 {
                pad.button_mut(PadButton::Back).press();
            }
        }
        if visitor.manner == Manner::Mashes {
            let button = PadButton::ALL[random.usize(..PadButton::ALL.len())];
            let pad = self.pad.pad.get_or_insert_default();
            pad.button_mut(button).press();
            pad.button_mut(button).down = false;
            pad.left = [2.0 * random.f32() - 1.0, 2.0 * random.f32() - 1.0];
        }
    }

    /// Runs a frame.
    fn step(&mut self) {
        let mut events = Vec::new();
        self.act(&mut events);
        for event in events {
            self.window.event(event);
        }
        let plugged = vec![self.pad.clone()];
        self.window.state_mut().game.controls.pads = Pads::of(Snapshot { devices: plugged });
        let was_there = self.is_played();
        let began = ThreadTime::now();
        self.window.step();
        // Measures the time of this thread, so that other processes do not count.
        let time = 1000.0 * began.elapsed().as_secs_f64();
        self.times.push(time);
        if !was_there && self.is_played() {
            self.welcome = self.welcome.max(time);
        }
        self.frames += 1;
        if self.frames.is_multiple_of(DRAWN) {
            self.window.render().expect("the frame can be drawn");
            // Waits for the software adapter, which is slower than a stand's. Its work would pile up, since no
            // screen throttles the frames.
            let waited = self.gpu.device.poll(PollType::wait_indefinitely());
            waited.expect("the GPU works");
        }
        if self.frames.is_multiple_of(MINUTE) {
            let of_gpu = self.gpu.device.generate_allocator_report();
            let of_gpu = of_gpu.map_or(0, |report| report.total_allocated_bytes);
            self.used
                .push((HEAP.current_usage() as u64 + of_gpu) as f64 / 1e6);
            self.held.push(memory().unwrap_or(0) as f64 / 1e6);
        }
        self.count();
    }

    /// Whether a visitor plays a round.
    fn is_played(&self) -> bool {
        matches!(self.window.state().game.screen(), Screen::Play)
    }

    /// Counts the rounds that ended in this frame.
    fn count(&mut self) {
        let game = &self.window.state().game;
        let bout = &game.bout;
        let is_begun = bout.session.is_played() && bout.round().ticks() > 0;
        let round = is_begun.then(|| (bout.round().ticks(), bout.won.is_some()));
        let is_won = round.is_some_and(|(_, is_won)| is_won);
        if let Some((before, was_won)) = self.round
            && !was_won
        {
            // The round was won, left or restarted.
            self.ended += u64::from(round.is_none_or(|(now, is_won)| is_won || now < before));
            self.wins += u64::from(is_won);
        }
        self.round = round;
    }

    /// Reports an hour.
    fn pass_hour(&mut self) {
        let worst = self.times.iter().copied().fold(0.0, f64::max);
        let middle = middle(&mut self.times);
        let [used, held] = [&mut self.used, &mut self.held].map(self::middle);
        self.hours.push([used, held, middle]);
        println!(
            "hour {:3}: {used:6.1} MB in use, {held:6.1} MB held, frame time: median {middle:5.2} ms, maximum {worst:.0} ms; \
             {} visitors, {} rounds, {} wins",
            self.hours.len(),
            self.visitors,
            self.ended,
            self.wins
        );
    }
}

/// Returns the median and clears the numbers.
fn middle(numbers: &mut Vec<f64>) -> f64 {
    numbers.sort_by(f64::total_cmp);
    let middle = output::quantile(numbers, 0.5).expect("every hour has numbers");
    numbers.clear();
    middle
}

fn tap(events: &mut Vec<Event>, key: Key) {
    for pressed in [true, false] {
        events.push(Event::Key {
            key,
            physical_key: None,
            pressed,
            repeat: false,
            modifiers: Modifiers::NONE,
        });
    }
}

/// Holds the hidden corner of the screen for four seconds, then enters a digit of the PIN every second frame.
fn knock(events: &mut Vec<Event>, frame: usize, number: &str) {
    const HELD: usize = (4.0 / STEP) as usize;
    let corner = pos2(SIZE.x - 20.0, 20.0);
    events.push(Event::PointerMoved(corner));
    if frame == 1 || frame == HELD {
        events.push(Event::PointerButton {
            pos: corner,
            button: PointerButton::Primary,
            pressed: frame == 1,
            modifiers: Modifiers::NONE,
        });
    }
    let digit = (frame.saturating_sub(HELD + 10)).checked_div(2);
    let digit = digit.filter(|_| frame > HELD + 10 && frame.is_multiple_of(2));
    if let Some(digit) = digit.and_then(|at| number.get(at - 1..at)) {
        events.push(Event::Text(digit.into()));
    }
}

fn mash(events: &mut Vec<Event>, random: &mut fastrand::Rng) {
    let names = ["Escape", "E", "F", "J", "R", "F11", "Enter", "Tab"];
    let keys = names.map(|name| Key::from_name(name).expect("egui knows the key"));
    if random.u32(..4) == 0 {
        tap(events, keys[random.usize(..keys.len())]);
    }
    let at = pos2(SIZE.x * random.f32(), SIZE.y * random.f32());
    events.push(Event::PointerMoved(at));
    if random.u32(..5) == 0 {
        for pressed in [true, false] {
            events.push(Event::PointerButton {
                pos: at,
                button: PointerButton::Primary,
                pressed,
                modifiers: Modifiers::NONE,
            });
        }
    }
}

/// Returns the numbers of rounds, of wins, and of rounds in the logbook that cannot be reproduced.
fn check(folder: &Path) -> Result<(u64, u64, u64), Error> {
    let logbook = Logbook::read(&StandFolder(folder.into()).logbook())?;
    let (mut rounds, mut wins, mut astray) = (0, 0, 0);
    logbook.rounds(.., |round: Round| {
        rounds += 1;
        wins += u64::from(round.route.is_some());
        if !reproduces(&round) {
            println!(
                "round {} of {} s cannot be reproduced",
                round.id, round.seconds
            );
            astray += 1;
        }
        Ok::<(), Error>(())
    })?;
    Ok((rounds, wins, astray))
}

fn reproduces(round: &Round) -> bool {
    let Ok(replay) = Replay::of_fragment(&round.replay) else {
        return false;
    };
    let Ok(mut playback) = Playback::new(replay.into()) else {
        return false;
    };
    while !playback.is_over() {
        if playback.step().is_err() {
            return false;
        }
    }
    let outcome = playback.round().progress().outcome;
    outcome.map(|outcome| outcome.route) == round.route
}

/// Opens a stand in an offscreen window drawn by `gpu`. Its configuration and its logbook are in `folder`.
fn open(folder: &Path, gpu: RenderState) -> Harness<'static, App> {
    let text = DEFAULT_CONFIG.replace(
        "#folder = \"/var/lib/tam\"",
        &format!("folder = {folder:?}"),
    );
    let text = text.replace("[\"classic\"]", "[\"classic\", \"neck\", \"cat\"]");
    let text = text.replace("clips = 50", "clips = 5");
    let text = text.replace("#pin = \"…\"", &format!("pin = {PIN:?}"));
    let text = text.replace(
        "#page = \"https://…/\"",
        "page = \"https://example.org/tamaire/\"",
    );
    let file = TextFile(folder.join("exhibit.toml"));
    file.write(&text).expect("the configuration can be written");
    let builder = Harness::builder().with_size(SIZE);
    let builder = builder.renderer(WgpuTestRenderer::from_render_state(gpu));
    let builder = builder.with_step_dt(STEP as f32).with_render_cursor(false);
    builder.build_eframe(|context| {
        let mut game = Game::new(Files::nowhere(), Sound::none(), Pads::none());
        // A stopped clock makes the game play all ticks, however long they take.
        game.clock = Clock::of(|| 0.0);
        let mut stand = Stand::open(file).expect("the configuration is valid");
        stand.prepare(&mut game);
        let mut app = App::new(context, game).expect("a GPU or a software adapter is available");
        app.attendant = Some(Box::new(stand));
        app
    })
}

fn main() -> ExitCode {
    let hours = std::env::args().nth(1).and_then(|word| word.parse().ok());
    let hours: u64 = hours.unwrap_or(8);
    let folder = tempfile::tempdir().expect("a temporary folder can be created");
    let about = DeviceInfo {
        name: "Pad".into(),
        guid: "pad".into(),
        labels: Labels::Letters,
    };
    let mut pad = Device::at_rest(DeviceId(1), about, 6, 0, 0);
    pad.pad = Some(Pad::default());
    let setup = with_small_memory_blocks(default_wgpu_setup());
    let gpu = create_render_state(setup, RendererOptions::PREDICTABLE);
    let mut day = Day {
        window: open(folder.path(), gpu.clone()),
        gpu,
        random: fastrand::Rng::with_seed(2004),
        pad,
        visitor: None,
        quiet: 5.0,
        frames: 0,
        times: Vec::new(),
        used: Vec::new(),
        held: Vec::new(),
        hours: Vec::new(),
        visitors: 0,
        wins: 0,
        ended: 0,
        round: None,
        welcome: 0.0,
    };
    for _ in 0..hours {
        for _ in 0..(3600.0 / STEP) as u64 {
            day.step();
        }
        day.pass_hour();
    }
    let Day {
        mut window,
        hours,
        visitors,
        wins: wins_seen,
        ended,
        welcome,
        ..
    } = day;
    eframe::App::on_exit(window.state_mut());
    drop(window);
    let (rounds, wins, astray) = match check(folder.path()) {
        Ok(found) => found,
        Err(error) => {
            eprintln!("{error}");
            return ExitCode::FAILURE;
        }
    };
    println!(
        "{visitors} visitors, ready to play within {welcome:.0} ms; {rounds} rounds and {wins} wins in the logbook"
    );
    println!(
        "{ended} rounds and {wins_seen} wins were observed; {astray} rounds cannot be reproduced"
    );
    // Counting once per frame misses a round of a few ticks, and a win that is followed by a restart within
    // the same frame. So the logbook may contain more rounds and wins than were counted.
    let mut is_good = wins >= wins_seen && rounds >= ended && astray == 0;
    if let [first, .., last] = hours.as_slice() {
        let [used, held, frame] = [0, 1, 2].map(|at| 100.0 * (last[at] / first[at] - 1.0));
        println!("memory in use {used:+.1} %, held {held:+.1} %, frames {frame:+.1} %");
        is_good &= used <= MORE_MEMORY && frame <= SLOWER;
    }
    if let Some(copy) = std::env::args().nth(2) {
        std::fs::copy(StandFolder(folder.path().into()).logbook(), copy)
            .expect("the logbook can be copied");
    }
    ExitCode::from(u8::from(!is_good))
}
