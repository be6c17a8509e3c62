//! Sticks, motors and all that keeps them safe, against the force feedback of a real kernel: a stick of nothing is plugged
//! in, pushed by a game that is not there, and writes down what its driver is told.
//!
//! `cargo xtask kernel` runs this in a machine of its own, since it needs /dev/uinput, no udev, and nobody else at the
//! devices. There a processor is made of software, ten times as slow, and held up now and then; so where a time is promised,
//! the quicker ones of several tries have to keep it.

#![cfg(target_os = "linux")]

mod hand;
mod uinput;

use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use force_feedback::{Ability, Force, LENGTH, Line, Manner, State, Stop};
use hand::{check, force_at, forces, quiet_since, settings};
use sticks::{Control, DeviceId, Sticks};
use uinput::{Stick, Told, What};

const MS: Duration = Duration::from_millis(1);
/// How long a slow machine may take for what has no hurry.
const PATIENCE: Duration = Duration::from_secs(20);
/// Set for a process that only plays, until it is killed.
const PLAYS: &str = "STICKS_KERNEL_TEST_PLAYS";

const LEFT: [f32; 2] = [-1.0, 0.0];
const RIGHT: [f32; 2] = [1.0, 0.0];
const WAYS: [[f32; 2]; 4] = [LEFT, RIGHT, [0.0, -1.0], [0.0, 1.0]];

/// A game that plays with one stick.
struct Game {
    line: Option<Line>,
    force: Force,
    sticks: Sticks,
}

impl Game {
    fn start() -> Game {
        let mut game = Game {
            line: None,
            force: Force::start(250).expect("the system has a thread"),
            sticks: Sticks::open().expect("SDL starts"),
        };
        game.take_hold();
        game
    }

    /// Of the stick that was plugged in last.
    fn take_hold(&mut self) {
        until("there is a stick", || self.id().is_some());
        let haptic = self.sticks.haptic(self.id().expect("there is a stick"));
        let line = self.force.add(Box::new(haptic), settings());
        until("it can push", || line.report().ability == Ability::Force);
        self.line = Some(line);
    }

    fn line(&self) -> &Line {
        self.line.as_ref().expect("it took hold of a stick")
    }

    fn id(&self) -> Option<DeviceId> {
        let snapshot = self.sticks.snapshot();
        snapshot.devices.last().map(|device| device.id)
    }

    fn aim(&self) -> Option<[f32; 2]> {
        let snapshot = self.sticks.snapshot();
        snapshot.devices.last().map(|device| device.aim())
    }

    /// Leans the stick against something that pushes it back, until it is felt this strongly. Returns when the simulation
    /// said so last.
    fn is_pushed(&self, stick: &Stick, push: [f32; 2], strength: f32) -> Instant {
        let aim = push.map(|k| -k);
        stick.lean(aim).expect("it is plugged in");
        until("it leans", || self.aim() == Some(aim));
        let mut last = Instant::now();
        until("it pushes", || {
            last = simulate(self.line(), push, 50 * MS);
            let felt = force_at(&stick.told(), Instant::now());
            felt[0] * push[0] + felt[1] * push[1] >= strength
        });
        last
    }
}

/// A simulation that goes on for this long, whose hand is pushed by what it touches. Returns when it last said so.
fn simulate(line: &Line, push: [f32; 2], duration: Duration) -> Instant {
    let start = Instant::now();
    loop {
        let now = Instant::now();
        line.feel(State {
            contact: push.map(|k| 300.0 * k),
            manner: Manner::Steers,
        });
        if start.elapsed() >= duration {
            return now;
        }
        sleep(16 * MS);
    }
}

fn plug_in() -> Stick {
    Stick::plug_in().expect("there is /dev/uinput")
}

fn until(what: &str, mut holds: impl FnMut() -> bool) {
    let end = Instant::now() + PATIENCE;
    while !holds() {
        assert!(Instant::now() < end, "never happened: {what}");
        sleep(MS);
    }
}

/// Since when nothing is felt any more.
fn until_quiet(stick: &Stick) -> Instant {
    let quiet = || quiet_since(&stick.told());
    // The whole machine may have been held up and gone on, with a pause that nobody asked for: that one does not last.
    until("it rests", || {
        quiet().is_some_and(|since| since.elapsed() > 50 * MS)
    });
    quiet().expect("nobody says any more that there is something to feel")
}

fn until_erased(stick: &Stick) {
    let is_erasing = |told: &Told| matches!(told.what, What::Erase { .. });
    until("both effects are taken away", || {
        stick.told().into_iter().filter(is_erasing).count() == 2
    });
}

/// Prints how long it took, and sees whether the quicker tries keep what was promised: the machine only ever adds to it.
fn took(what: &str, mut times: Vec<Duration>, promised: Duration) {
    times.sort();
    let [quick, middle, longest] = [1, 2, 4].map(|k| times[(times.len() - 1) * k / 4]);
    println!("{what}: {quick:.1?} when quick, {middle:.1?} mostly, {longest:.1?} at most");
    assert!(
        quick <= promised,
        "{what}: {promised:?} was promised, not {times:.1?}"
    );
}

#[test]
#[ignore = "cargo xtask kernel"]
fn what_the_stick_says_is_read() {
    let stick = plug_in();
    let game = Game::start();
    for aim in [[1.0, 0.0], [0.0, 1.0], [-0.5, -1.0]] {
        stick.lean(aim).expect("it is plugged in");
        until("it leans", || {
            let near = |[x, y]: [f32; 2]| (x - aim[0]).abs() + (y - aim[1]).abs() < 0.01;
            game.aim().is_some_and(near)
        });
    }
    for _ in 0..3 {
        stick.press(2).expect("it is plugged in");
    }
    until("three presses are counted", || {
        let snapshot = game.sticks.snapshot();
        let button = snapshot.devices[0].control(Control::Button(2));
        button.presses == 3 && !button.down
    });
}

#[test]
#[ignore = "cargo xtask kernel"]
fn the_stick_is_pushed_the_way_that_the_hand_is() {
    let stick = plug_in();
    let game = Game::start();
    for push in WAYS {
        let before = stick.told().len();
        game.is_pushed(&stick, push, 0.2);
        game.line().stop(Stop::Paused);
        until_quiet(&stick);
        for [x, y] in forces(&stick.told()).split_off(before) {
            let (along, across) = (x * push[0] + y * push[1], x * push[1] - y * push[0]);
            assert!(
                along >= 0.0 && across == 0.0,
                "pushed {push:?}: felt {:?}",
                [x, y]
            );
        }
    }
    check(&stick.told());
}

#[test]
#[ignore = "cargo xtask kernel"]
fn a_stick_that_is_shaken_keeps_its_bounds() {
    let stick = plug_in();
    let game = Game::start();
    // As strongly as it may be.
    game.is_pushed(&stick, LEFT, settings().clamp - 0.001);
    for turn in 0..30 {
        let (way, back) = (WAYS[turn % 2], WAYS[(turn + 1) % 2]);
        stick.lean(back).expect("it is plugged in");
        simulate(game.line(), way, 80 * MS);
    }
    game.line().stop(Stop::Menu);
    until_quiet(&stick);
    check(&stick.told());
}

#[test]
#[ignore = "cargo xtask kernel"]
fn every_way_to_stop_is_quick() {
    /// Stops it, and returns when that began.
    type Way = fn(&mut Game) -> Instant;
    let pause: Way = |game| {
        let start = Instant::now();
        game.line().stop(Stop::Paused);
        start
    };
    let drop_line: Way = |game| {
        let start = Instant::now();
        game.line = None;
        start
    };
    let panic: Way = |game| {
        let line = game.line.take().expect("it is pushed");
        let (tell, told) = std::sync::mpsc::channel();
        let thread = std::thread::spawn(move || {
            simulate(&line, LEFT, 50 * MS);
            tell.send(Instant::now()).expect("the test waits for it");
            // A panic, but for what it prints.
            std::panic::resume_unwind(Box::new(()));
        });
        thread.join().expect_err("it panics");
        told.recv().expect("it told when")
    };
    let emergency: Way = |game| {
        let start = Instant::now();
        game.force.emergency_stop();
        start
    };
    let drop_thread: Way = |game| {
        let start = Instant::now();
        game.force = Force::start(250).expect("the system has a thread");
        start
    };
    let ways = [
        ("to pause", pause),
        ("to drop the line", drop_line),
        ("to panic", panic),
        ("an emergency stop", emergency),
        ("to drop the thread", drop_thread),
    ];
    for (what, way) in ways {
        let times = (0..7).map(|_try| {
            let stick = plug_in();
            let mut game = Game::start();
            game.is_pushed(&stick, LEFT, 0.08);
            let start = way(&mut game);
            until_quiet(&stick).saturating_duration_since(start)
        });
        took(what, times.collect(), 20 * MS);
    }
}

#[test]
#[ignore = "cargo xtask kernel"]
fn a_simulation_that_stalls_stops_within_a_tenth_of_a_second() {
    let stick = plug_in();
    let game = Game::start();
    let times = (0..7).map(|_try| {
        let last = game.is_pushed(&stick, LEFT, 0.08);
        // This is the thread that simulates, and here it hangs.
        sleep(300 * MS);
        assert_eq!(game.line().report().silent, Some(Stop::Stale));
        until_quiet(&stick).saturating_duration_since(last)
    });
    took("a stall", times.collect(), 100 * MS);
    check(&stick.told());
}

#[test]
#[ignore = "cargo xtask kernel"]
fn a_device_that_is_let_go_keeps_nothing_and_can_be_taken_again() {
    let stick = plug_in();
    let mut game = Game::start();
    game.is_pushed(&stick, LEFT, 0.05);
    game.line = None;
    until_erased(&stick);
    for _try in 0..5 {
        // Nobody waits here until the one before has let go.
        game.line = None;
        game.take_hold();
        game.is_pushed(&stick, LEFT, 0.05);
    }
}

#[test]
#[ignore = "cargo xtask kernel"]
fn a_device_that_is_unplugged_and_plugged_in_again_pushes_again() {
    let mut stick = plug_in();
    let mut game = Game::start();
    for _try in 0..3 {
        let before = game.id();
        game.is_pushed(&stick, LEFT, 0.05);
        drop(stick);
        until("the line says so", || {
            simulate(game.line(), LEFT, 30 * MS);
            game.line().report().silent == Some(Stop::Unplugged)
        });
        assert_eq!(game.id(), None);

        stick = plug_in();
        until("there is a stick", || game.id().is_some());
        assert_ne!(game.id(), before);
        game.line = None;
        game.take_hold();
        game.is_pushed(&stick, LEFT, 0.05);
        game.line().stop(Stop::Paused);
        until_quiet(&stick);
        check(&stick.told());
    }
}

/// Another process that plays.
struct Process(Child);

impl Process {
    /// Starts it, and waits until it pushes.
    fn start(stick: &Stick) -> Process {
        stick.lean(RIGHT).expect("it is plugged in");
        let child = Command::new(std::env::current_exe().expect("this is running"))
            .args(["--exact", "the_process_that_plays", "--ignored"])
            .env(PLAYS, "1")
            .stdout(Stdio::null())
            .spawn()
            .expect("this can be started");
        let process = Process(child);
        until("it pushes", || {
            force_at(&stick.told(), Instant::now())[0] < -0.1
        });
        process
    }

    fn signal(&self, signal: &str) {
        let id = self.0.id().to_string();
        let status = Command::new("kill").args([signal, &id]).status();
        assert!(status.is_ok_and(|status| status.success()), "{signal}");
    }
}

impl Drop for Process {
    fn drop(&mut self) {
        // It may have been killed already.
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

#[test]
#[ignore = "the process of other tests"]
fn the_process_that_plays() {
    if std::env::var_os(PLAYS).is_some() {
        let game = Game::start();
        simulate(game.line(), LEFT, PATIENCE);
    }
}

#[test]
#[ignore = "cargo xtask kernel"]
fn the_kernel_stops_a_process_that_is_killed() {
    let stick = plug_in();
    let mut process = Process::start(&stick);
    let start = Instant::now();
    // SIGKILL: no handler runs, and nothing is dropped.
    process.0.kill().expect("it runs");
    process.0.wait().expect("it was killed");
    let time = until_quiet(&stick) - start;
    until_erased(&stick);
    let told = stick.told();
    let after: Vec<What> = told
        .iter()
        .filter(|told| told.at > start)
        .map(|told| told.what)
        .collect();
    println!("to be killed: {time:.1?}; the device was told {after:?}");
    assert!(time < LENGTH);
}

#[test]
#[ignore = "cargo xtask kernel"]
fn a_process_that_hangs_pushes_for_half_a_second_and_begins_gently_when_it_goes_on() {
    let stick = plug_in();
    let process = Process::start(&stick);
    process.signal("-STOP");
    // What was on its way arrives.
    sleep(50 * MS);
    let (start, hung) = (Instant::now(), stick.told());
    assert_ne!(force_at(&hung, start), [0.0; 2], "it hangs while it pushes");
    let ends = (0..=500).find(|ms| force_at(&hung, start + *ms * MS) == [0.0; 2]);
    println!("to hang: the push ends by itself after {ends:?} ms");
    assert!(ends.is_some());
    sleep(3 * LENGTH);
    assert_eq!(stick.told().len(), hung.len(), "nobody prolongs it");

    process.signal("-CONT");
    until("it pushes again", || {
        force_at(&stick.told(), Instant::now()) != [0.0; 2]
    });
    let told = stick.told();
    let felt = forces(&told).split_off(hung.len());
    let first = felt.iter().find(|force| **force != [0.0; 2]);
    println!("to go on: it begins with {first:.3?}");
    assert!(first.is_some_and(|[x, _]| x.abs() < 0.02), "{felt:.3?}");
}
