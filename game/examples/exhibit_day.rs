//! A stand's day: visitors that are programs come, hesitate, play, alone or two at once, mash, leave in the middle, try again,
//! and staff looks behind it. Time goes as fast as the machine can. It tells each hour how it goes. At the end all rounds that
//! ended have to be in the logbook, all are run again, and memory and frame times have to be what they were.
//!
//! Most frames are laid out and not drawn, since a GPU in software takes longer to draw than all the rest.
//!
//! ```text
//! cargo run --release -p tamaire --example exhibit_day -- 8 [COPY]
//! ```
//!
//! leaves a copy of the logbook where that is named.

use cpu_time::ThreadTime;
use eframe::egui_wgpu::{RenderState, RendererOptions};
use eframe::wgpu::PollType;
use egui::{Event, Key, Modifiers, PointerButton, pos2, vec2};
use egui_kittest::Harness;
use egui_kittest::wgpu::{WgpuTestRenderer, create_render_state, default_wgpu_setup};
use peak_alloc::PeakAlloc;
use std::path::Path;
use std::process::ExitCode;
use sticks::{About, Device, DeviceId, Labels, Pad, PadButton, Snapshot};
use tamaire::app::App;
use tamaire::exhibit::Stand;
use tamaire::exhibit::config::USUAL;
use tamaire::game::{Game, Screen};
use tamaire::platform::{
    Clock, Files, Pads, Sound, StandFolder, TextFile, in_small_blocks, memory,
};
use tamaire_logbook::{Error, Logbook, Round};
use tamaire_play::{Bot, BotKind, Playback, Replay};

/// A frame lasts so long for the game [s]: it plays six ticks in each.
const STEP: f64 = 0.1;
/// One of so many frames is drawn.
const DRAWN: u64 = 50;
const SIZE: egui::Vec2 = vec2(640.0, 400.0);
/// What is asked of the heap is counted: what a process holds goes up and down by blocks of the system and of a GPU in software.
#[global_allocator]
static HEAP: PeakAlloc = PeakAlloc;

/// Memory and frame times may grow by so much [%] between the first hour and the last.
const MORE_MEMORY: f64 = 5.0;
const SLOWER: f64 = 10.0;
/// Frames of a minute.
const MINUTE: u64 = (60.0 / STEP) as u64;
/// What staff enters.
const PIN: &str = "2004";
/// A hand trembles by so many points.
const TREMBLE: f32 = 6.0;

/// What a visitor is like.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Manner {
    /// Plays with the mouse as a bot does, with an unsteady hand.
    Plays(BotKind),
    /// The same, while somebody else plays along with the pad.
    Pair(BotKind),
    /// Plays with the pad, around and around.
    Pad,
    /// Holds the corner and enters a number, the right one or another.
    Staff(&'static str),
    /// Presses whatever there is.
    Mashes,
    /// Touches it, looks, and goes.
    Looks,
}

/// Somebody who came.
struct Visitor {
    manner: Manner,
    bot: Bot,
    /// Does nothing for so long still [s].
    hesitates: f64,
    /// Goes after so long, whatever is on [s].
    patience: f64,
    /// How often still they would try again.
    tries: u32,
    /// Frames since the first that was not hesitated away.
    frame: usize,
}

/// The stand and whoever comes.
struct Day {
    window: Harness<'static, App>,
    gpu: RenderState,
    random: fastrand::Rng,
    pad: Device,
    visitor: Option<Visitor>,
    /// Nobody comes for so long still [s].
    quiet: f64,
    frames: u64,
    /// How long each frame of this hour took [ms].
    times: Vec<f64>,
    /// The memory of each minute of it [MB]: in use on the heap and the GPU, and held by the process.
    used: Vec<f64>,
    held: Vec<f64>,
    /// The middle of these, by hour: used, held, times.
    hours: Vec<[f64; 3]>,
    visitors: u64,
    wins: u64,
    /// Rounds of visitors that were seen to end.
    ended: u64,
    /// Ticks of such a round that is on, and whether it is won.
    round: Option<(u64, bool)>,
    /// How long it took until the frame was there in which somebody who came could move the hand [ms], at most.
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

    /// What whoever is there does in a frame.
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
                    events.push(Event::PointerMoved(view.on_screen(goal) + shake));
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

    /// Lets a frame pass.
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
        // A screen would wait for it. One in software is slower than the stand, and what it has still to do piles up.
        let waited = self.gpu.device.poll(PollType::wait_indefinitely());
        waited.expect("the GPU works");
        // Others on the machine do not count.
        let time = 1000.0 * began.elapsed().as_secs_f64();
        self.times.push(time);
        if !was_there && self.is_played() {
            self.welcome = self.welcome.max(time);
        }
        self.frames += 1;
        if self.frames.is_multiple_of(DRAWN) {
            self.window.render().expect("the frame can be drawn");
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

    /// Whether a round is on for a visitor.
    fn is_played(&self) -> bool {
        matches!(self.window.state().game.screen(), Screen::Play)
    }

    /// Counts what ended in this frame.
    fn count(&mut self) {
        let game = &self.window.state().game;
        let bout = &game.bout;
        let is_begun = bout.session.is_played() && bout.round().ticks() > 0;
        let round = is_begun.then(|| (bout.round().ticks(), bout.won.is_some()));
        let is_won = round.is_some_and(|(_, is_won)| is_won);
        if let Some((before, was_won)) = self.round
            && !was_won
        {
            // It was won, left or begun anew.
            self.ended += u64::from(round.is_none_or(|(now, is_won)| is_won || now < before));
            self.wins += u64::from(is_won);
        }
        self.round = round;
    }

    /// Tells how an hour went.
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

/// The middle one of some numbers, which are taken out.
fn middle(numbers: &mut Vec<f64>) -> f64 {
    numbers.sort_by(f64::total_cmp);
    let middle = numbers[numbers.len() / 2];
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

/// Holds the corner for four seconds, and enters a digit each second frame after that.
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

/// Looks into the logbook: how many rounds were won, and how many do not come out as they were written.
fn check(folder: &Path) -> Result<(u64, u64, u64), Error> {
    let logbook = Logbook::read(&StandFolder(folder.into()).logbook())?;
    let (mut rounds, mut wins, mut astray) = (0, 0, 0);
    logbook.rounds(.., |round: Round| {
        rounds += 1;
        wins += u64::from(round.route.is_some());
        if !reproduces(&round) {
            println!("round {} of {} s cannot be reproduced", round.id, round.seconds);
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

/// A stand with its own file, in a window that nobody sees, drawn by this GPU.
fn open(folder: &Path, gpu: RenderState) -> Harness<'static, App> {
    let text = USUAL.replace(
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
        // However long ticks take, all of them are played.
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
    let about = About {
        name: "Pad".into(),
        guid: "pad".into(),
        labels: Labels::Letters,
    };
    let mut pad = Device::at_rest(DeviceId(1), about, 6, 0, 0);
    pad.pad = Some(Pad::default());
    let setup = in_small_blocks(default_wgpu_setup());
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
    println!("{ended} rounds and {wins_seen} wins were observed; {astray} rounds cannot be reproduced");
    // A round of a few ticks begins and ends between two frames, and one is won and begun anew in a single frame.
    let mut is_good = wins >= wins_seen && rounds >= ended && astray == 0;
    if let [first, .., last] = hours.as_slice() {
        let [used, held, frame] = [0, 1, 2].map(|at| 100.0 * (last[at] / first[at] - 1.0));
        println!("memory in use {used:+.1} %, held {held:+.1} %, frames {frame:+.1} %");
        is_good &= used <= MORE_MEMORY && frame <= SLOWER;
    }
    if let Some(copy) = std::env::args().nth(2) {
        std::fs::copy(StandFolder(folder.path().into()).logbook(), copy).expect("the logbook can be copied");
    }
    ExitCode::from(u8::from(!is_good))
}
