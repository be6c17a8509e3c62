//! Tests of sticks, motors and all safety functions against the force feedback of a real kernel. A virtual
//! stick is plugged in, records the commands of its driver, and is pushed by a simulated game.
//!
//! `cargo xtask kernel` runs the tests in a virtual machine, because they need /dev/uinput, no udev, and
//! exclusive devices. The emulated processor is a tenth as fast as a real one and is sometimes delayed. Time
//! limits therefore apply to the lower quartile of several tries.

#![cfg(target_os = "linux")]

mod hand;
mod uinput;

use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use force_feedback::{Ability, ForceThread, Line, OUTPUT_DURATION, State, StickMode, Stop};
use hand::{check, force_at, forces, quiet_since, settings};
use sticks::{Control, DeviceId, Sticks};
use uinput::{Stick, Told, What};

const MS: Duration = Duration::from_millis(1);
/// Timeout of all waits without a limit of their own. Long, because the machine is slow.
const PATIENCE: Duration = Duration::from_secs(20);
/// Environment variable that makes a process of this test push the stick until it is killed.
const PLAYS: &str = "STICKS_KERNEL_TEST_PLAYS";

const LEFT: [f32; 2] = [-1.0, 0.0];
const RIGHT: [f32; 2] = [1.0, 0.0];
const WAYS: [[f32; 2]; 4] = [LEFT, RIGHT, [0.0, -1.0], [0.0, 1.0]];

/// Simulated game with one stick.
struct Game {
    line: Option<Line>,
    force: ForceThread,
    sticks: Sticks,
}

impl Game {
    fn start() -> Game {
        let mut game = Game {
            line: None,
            force: ForceThread::start(250).expect("a thread can be started"),
            sticks: Sticks::open().expect("SDL starts"),
        };
        game.take_hold();
        game
    }

    /// Connects the game to the stick that was plugged in last.
    fn take_hold(&mut self) {
        until("there is a stick", || self.id().is_some());
        let haptic = self.sticks.haptic(self.id().expect("there is a stick"));
        let line = self.force.add(Box::new(haptic), settings());
        until("force ready", || line.report().ability == Ability::Force);
        self.line = Some(line);
    }

    fn line(&self) -> &Line {
        self.line.as_ref().expect("the game has a stick")
    }

    fn id(&self) -> Option<DeviceId> {
        let snapshot = self.sticks.snapshot();
        snapshot.devices.last().map(|device| device.id)
    }

    fn aim(&self) -> Option<[f32; 2]> {
        let snapshot = self.sticks.snapshot();
        snapshot.devices.last().map(|device| device.aim())
    }

    /// Leans the stick against an obstacle until its force reaches `strength`. Returns the time of the last
    /// reported state.
    fn is_pushed(&self, stick: &Stick, push: [f32; 2], strength: f32) -> Instant {
        let aim = push.map(|k| -k);
        stick.lean(aim).expect("the stick is plugged in");
        until("the stick leans", || self.aim() == Some(aim));
        let mut last = Instant::now();
        until("the force is felt", || {
            last = simulate(self.line(), push, 50 * MS);
            let felt = force_at(&stick.told(), Instant::now());
            felt[0] * push[0] + felt[1] * push[1] >= strength
        });
        last
    }
}

/// Simulates a contact with the force `push` for a duration. Returns the time of the last reported state.
fn simulate(line: &Line, push: [f32; 2], duration: Duration) -> Instant {
    let start = Instant::now();
    loop {
        let now = Instant::now();
        line.set_state(State {
            contact: push.map(|k| 300.0 * k),
            manner: StickMode::Velocity,
        });
        if start.elapsed() >= duration {
            return now;
        }
        sleep(16 * MS);
    }
}

fn plug_in() -> Stick {
    Stick::plug_in().expect("/dev/uinput exists")
}

fn until(what: &str, mut holds: impl FnMut() -> bool) {
    let end = Instant::now() + PATIENCE;
    while !holds() {
        assert!(Instant::now() < end, "never happened: {what}");
        sleep(MS);
    }
}

/// Waits for a zero force. Returns the time since which the force is zero.
fn until_quiet(stick: &Stick) -> Instant {
    let quiet = || quiet_since(&stick.told());
    // A force that returns was zero only because the whole machine was delayed. Waits on in this case.
    until("the force is zero", || {
        quiet().is_some_and(|since| since.elapsed() > 50 * MS)
    });
    quiet().expect("the force is still zero")
}

fn until_erased(stick: &Stick) {
    let is_erasing = |told: &Told| matches!(told.what, What::Erase { .. });
    until("both effects are erased", || {
        stick.told().into_iter().filter(is_erasing).count() == 2
    });
}

/// Prints the times and checks that their lower quartile keeps the limit. A slow machine can only lengthen
/// them.
fn took(what: &str, mut times: Vec<Duration>, promised: Duration) {
    times.sort();
    let [quick, middle, longest] = [1, 2, 4].map(|k| times[(times.len() - 1) * k / 4]);
    println!("{what}: {quick:.1?} lower quartile, {middle:.1?} median, {longest:.1?} maximum");
    assert!(
        quick <= promised,
        "{what}: limit {promised:?}, measured {times:.1?}"
    );
}

#[test]
#[ignore = "cargo xtask kernel"]
fn axes_and_presses_are_read() {
    let stick = plug_in();
    let game = Game::start();
    for aim in [[1.0, 0.0], [0.0, 1.0], [-0.5, -1.0]] {
        stick.lean(aim).expect("the stick is plugged in");
        until("the stick leans", || {
            let near = |[x, y]: [f32; 2]| (x - aim[0]).abs() + (y - aim[1]).abs() < 0.01;
            game.aim().is_some_and(near)
        });
    }
    for _ in 0..3 {
        stick.press(2).expect("the stick is plugged in");
    }
    until("three presses are counted", || {
        let snapshot = game.sticks.snapshot();
        let button = snapshot.devices[0].control(Control::Button(2));
        button.presses == 3 && !button.down
    });
}

#[test]
#[ignore = "cargo xtask kernel"]
fn force_has_the_direction_of_the_contact() {
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
fn shaken_stick_keeps_the_limits() {
    let stick = plug_in();
    let game = Game::start();
    // Pushes until the force is almost the strongest allowed.
    game.is_pushed(&stick, LEFT, settings().clamp - 0.001);
    for turn in 0..30 {
        let (way, back) = (WAYS[turn % 2], WAYS[(turn + 1) % 2]);
        stick.lean(back).expect("the stick is plugged in");
        simulate(game.line(), way, 80 * MS);
    }
    game.line().stop(Stop::Menu);
    until_quiet(&stick);
    check(&stick.told());
}

#[test]
#[ignore = "cargo xtask kernel"]
fn every_stop_takes_at_most_20_ms() {
    /// Function that stops the force and returns the start time of the stop.
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
        let line = game.line.take().expect("the game has a line");
        let (tell, told) = std::sync::mpsc::channel();
        let thread = std::thread::spawn(move || {
            simulate(&line, LEFT, 50 * MS);
            tell.send(Instant::now()).expect("the test waits");
            // Unwinds like a panic, but without printing a message.
            std::panic::resume_unwind(Box::new(()));
        });
        thread.join().expect_err("the thread panics");
        told.recv().expect("the thread sent the time")
    };
    let emergency: Way = |game| {
        let start = Instant::now();
        game.force.emergency_stop();
        start
    };
    let drop_thread: Way = |game| {
        let start = Instant::now();
        game.force = ForceThread::start(250).expect("a thread can be started");
        start
    };
    let ways = [
        ("pause", pause),
        ("drop of the line", drop_line),
        ("panic", panic),
        ("emergency stop", emergency),
        ("drop of the thread", drop_thread),
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
fn force_ends_within_100_ms_of_a_stall() {
    let stick = plug_in();
    let game = Game::start();
    let times = (0..7).map(|_try| {
        let last = game.is_pushed(&stick, LEFT, 0.08);
        // This thread reports the states, so no reports arrive while it sleeps, as in a game that hangs.
        sleep(300 * MS);
        assert_eq!(game.line().report().silent, Some(Stop::Stale));
        until_quiet(&stick).saturating_duration_since(last)
    });
    took("stall", times.collect(), 100 * MS);
    check(&stick.told());
}

#[test]
#[ignore = "cargo xtask kernel"]
fn released_device_keeps_no_effect_and_can_be_reused() {
    let stick = plug_in();
    let mut game = Game::start();
    game.is_pushed(&stick, LEFT, 0.05);
    game.line = None;
    until_erased(&stick);
    for _try in 0..5 {
        // Drops the line without waiting until the previous sink has released the device.
        game.line = None;
        game.take_hold();
        game.is_pushed(&stick, LEFT, 0.05);
    }
}

#[test]
#[ignore = "cargo xtask kernel"]
fn device_pushes_again_after_being_replugged() {
    let mut stick = plug_in();
    let mut game = Game::start();
    for _try in 0..3 {
        let before = game.id();
        game.is_pushed(&stick, LEFT, 0.05);
        drop(stick);
        until("the line reports it", || {
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

/// Another process that pushes the stick. Dropping it kills the process.
struct Process(Child);

impl Process {
    /// Starts the process and waits until it pushes.
    fn start(stick: &Stick) -> Process {
        stick.lean(RIGHT).expect("the stick is plugged in");
        let child = Command::new(std::env::current_exe().expect("the path of the test is known"))
            .args(["--exact", "the_process_that_plays", "--ignored"])
            .env(PLAYS, "1")
            .stdout(Stdio::null())
            .spawn()
            .expect("the process can be started");
        let process = Process(child);
        until("the force is felt", || {
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
        // Ignores the error, which means that the process was already killed.
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
fn kernel_stops_the_force_of_a_killed_process() {
    let stick = plug_in();
    let mut process = Process::start(&stick);
    let start = Instant::now();
    // `kill` sends SIGKILL, so no handler runs, and nothing is dropped.
    process.0.kill().expect("the process runs");
    process.0.wait().expect("the process can be waited for");
    let time = until_quiet(&stick) - start;
    until_erased(&stick);
    let told = stick.told();
    let after: Vec<What> = told
        .iter()
        .filter(|told| told.at > start)
        .map(|told| told.what)
        .collect();
    println!("kill: {time:.1?}; commands afterwards: {after:?}");
    assert!(time < OUTPUT_DURATION);
}

#[test]
#[ignore = "cargo xtask kernel"]
fn force_of_a_hanging_process_ends_and_later_ramps_up() {
    let stick = plug_in();
    let process = Process::start(&stick);
    process.signal("-STOP");
    // Waits until the commands on their way have arrived.
    sleep(50 * MS);
    let (start, hung) = (Instant::now(), stick.told());
    assert_ne!(
        force_at(&hung, start),
        [0.0; 2],
        "the process hangs without a force"
    );
    let ends = (0..=500).find(|ms| force_at(&hung, start + *ms * MS) == [0.0; 2]);
    println!("hang: the force ends by itself after {ends:?} ms");
    assert!(ends.is_some());
    sleep(3 * OUTPUT_DURATION);
    assert_eq!(
        stick.told().len(),
        hung.len(),
        "the hanging process sent commands"
    );

    process.signal("-CONT");
    until("the force is felt again", || {
        force_at(&stick.told(), Instant::now()) != [0.0; 2]
    });
    let told = stick.told();
    let felt = forces(&told).split_off(hung.len());
    let first = felt.iter().find(|force| **force != [0.0; 2]);
    println!("continue: first force {first:.3?}");
    assert!(first.is_some_and(|[x, _]| x.abs() < 0.02), "{felt:.3?}");
}
