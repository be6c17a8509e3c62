//! A stand on a virtual screen with simulated players, whose game is killed and stopped again and again.
//!
//! Run by `cargo xtask stand`; needs Xvfb and xdotool, and takes some ten minutes.
#![cfg(target_os = "linux")]

use std::collections::{BTreeSet, HashSet};
use std::env;
use std::fs;
use std::io::{BufRead, BufReader, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, Command, Stdio};
use std::thread;
use std::time::{Duration, Instant};
use tamaire::exhibit::config::DEFAULT_CONFIG;
use tamaire_logbook::{Error, Event, Kind, Logbook, Round};
use tempfile::TempDir;

const TAMAIRE: &str = env!("CARGO_BIN_EXE_tamaire");
/// Number of times that the game is killed or suspended. The environment variable `KILLS` overrides the
/// number.
const KILLS: usize = 54;
/// Number of crashes within ten minutes that a stand survives. After one more crash the stand gives up.
const BORNE: usize = 9;
/// Every ninth time the game is suspended (SIGSTOP) instead of killed.
const STOPPED: usize = 9;
/// Longest time that the test waits for any single condition.
const LONG: Duration = Duration::from_secs(60);
const SIZE: (u32, u32) = (640, 400);
/// Number of colours above which the game counts as drawn; an empty screen has one.
const COLOURS: usize = 50;

/// Virtual X server whose framebuffer can be read.
struct Screen {
    server: Child,
    folder: TempDir,
    name: String,
}

impl Screen {
    fn open() -> Self {
        let folder = tempfile::tempdir().unwrap();
        let (width, height) = SIZE;
        let mut server = Command::new("Xvfb");
        server.args(["-displayfd", "1", "-nolisten", "tcp", "-screen", "0"]);
        server.arg(format!("{width}x{height}x24"));
        server.arg("-fbdir").arg(folder.path());
        server.stdout(Stdio::piped()).stderr(Stdio::null());
        let mut server = server.spawn().expect("Xvfb is installed (Debian: xvfb)");
        let mut number = String::new();
        let mut told = BufReader::new(server.stdout.take().unwrap());
        told.read_line(&mut number).unwrap();
        let name = format!(":{}", number.trim());
        Self {
            server,
            folder,
            name,
        }
    }

    /// Whether the game is drawn on this screen.
    fn is_drawn(&self) -> bool {
        let picture = fs::read(self.folder.path().join("Xvfb_screen0")).unwrap();
        let (width, height) = SIZE;
        let pixels = &picture[picture.len() - (4 * width * height) as usize..];
        let colours: HashSet<&[u8]> = pixels.chunks_exact(4).collect();
        colours.len() > COLOURS
    }

    fn wait_until(&self, is_drawn: bool) -> Duration {
        let began = Instant::now();
        while self.is_drawn() != is_drawn {
            assert!(
                began.elapsed() < LONG,
                "timeout: expected drawn = {is_drawn}"
            );
            thread::sleep(Duration::from_millis(20));
        }
        began.elapsed()
    }
}

impl Drop for Screen {
    fn drop(&mut self) {
        let _gone = self.server.kill();
        let _gone = self.server.wait();
    }
}

/// Simulated player with mouse and keys.
struct Hand {
    tool: Child,
    told: ChildStdin,
    random: fastrand::Rng,
}

impl Hand {
    fn on(screen: &Screen) -> Self {
        let mut tool = Command::new("xdotool");
        tool.arg("-")
            .env("DISPLAY", &screen.name)
            .stdin(Stdio::piped());
        let mut tool = tool
            .spawn()
            .expect("xdotool is installed (Debian: xdotool)");
        let told = tool.stdin.take().unwrap();
        let random = fastrand::Rng::with_seed(50);
        Self { tool, told, random }
    }

    fn tell(&mut self, words: &str) {
        writeln!(self.told, "{words}").unwrap();
        self.told.flush().unwrap();
    }

    /// Moves the mouse at random for `time`.
    fn play(&mut self, time: Duration) {
        let began = Instant::now();
        while began.elapsed() < time {
            let (x, y) = (self.random.u32(..SIZE.0), self.random.u32(..SIZE.1));
            self.tell(&format!("mousemove {x} {y}"));
            thread::sleep(Duration::from_millis(60));
        }
    }
}

impl Drop for Hand {
    fn drop(&mut self) {
        let _gone = self.tool.kill();
        let _gone = self.tool.wait();
    }
}

/// Stand that was started from the command line, as an operator does.
struct Stand {
    parent: Child,
}

impl Stand {
    fn begin(screen: &Screen, file: &Path) -> Self {
        let mut parent = Command::new(TAMAIRE);
        parent
            .args(["--mute", "--exhibit"])
            .arg(file)
            .env("DISPLAY", &screen.name);
        parent.env_remove("WAYLAND_DISPLAY");
        Self {
            parent: parent.spawn().unwrap(),
        }
    }

    /// Process id of the running game, if there is one.
    fn game(&self) -> Option<String> {
        let parent = self.parent.id().to_string();
        let mut find = Command::new("pgrep");
        let found = find.args(["-P", &parent]).output().unwrap();
        let found = String::from_utf8(found.stdout).unwrap();
        found.lines().next().map(str::to_string)
    }

    fn signal(&self, signal: &str) {
        let game = self.game().expect("a game is running");
        let sent = Command::new("kill").args([signal, &game]).status();
        assert!(sent.unwrap().success());
    }

    /// Ends the stand with SIGTERM, as an operating system does.
    fn end(mut self) {
        let parent = self.parent.id().to_string();
        let game = self.game();
        let sent = Command::new("kill").args(["-TERM", &parent]).status();
        assert!(sent.unwrap().success());
        self.parent.wait().unwrap();
        // The game ends with its parent process.
        let began = Instant::now();
        while game.as_ref().is_some_and(|game| is_alive(game)) {
            assert!(began.elapsed() < LONG, "the game outlives its parent");
            thread::sleep(Duration::from_millis(20));
        }
    }
}

impl Drop for Stand {
    fn drop(&mut self) {
        // No process survives a failed test: the game ends with its parent.
        let _gone = self.parent.kill();
        let _gone = self.parent.wait();
    }
}

fn is_alive(process: &str) -> bool {
    let stat = fs::read_to_string(format!("/proc/{process}/stat")).unwrap_or_default();
    stat.rsplit(')')
        .next()
        .is_some_and(|rest| !rest.trim().is_empty() && !rest.trim().starts_with('Z'))
}

/// Ids of the rounds in a logbook that is being written.
fn rounds(logbook: &Path) -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    if let Ok(logbook) = Logbook::read(logbook) {
        let each = |round: Round| {
            found.insert(round.id.to_string());
            Ok::<(), Error>(())
        };
        logbook.rounds(.., each).unwrap();
    }
    found
}

fn events(logbook: &Path) -> Vec<Kind> {
    let mut found = Vec::new();
    let each = |event: Event| {
        found.push(event.kind);
        Ok::<(), Error>(())
    };
    Logbook::read(logbook).unwrap().events(.., each).unwrap();
    found
}

/// Returns median and maximum, if there are any values.
fn told(times: &mut [Duration]) -> Option<[Duration; 2]> {
    times.sort();
    Some([*times.get(times.len() / 2)?, *times.last()?])
}

#[test]
#[ignore = "needs Xvfb and xdotool, and takes ten minutes: `cargo xtask stand`"]
fn stand_restarts_killed_game_without_losing_rounds() {
    let kills = env::var("KILLS").map_or(KILLS, |kills| kills.parse().unwrap());
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("exhibit.toml");
    let logbook: PathBuf = folder.path().join("visits.sqlite");
    let usual = "#folder = \"/var/lib/tam\"";
    let text = DEFAULT_CONFIG.replace(usual, &format!("folder = {:?}", folder.path()));
    fs::write(&file, text).unwrap();
    let screen = Screen::open();
    let mut hand = Hand::on(&screen);
    let (mut known, mut stopped) = (BTreeSet::new(), 0);
    let (mut back, mut back_from_stop, mut written) = (Vec::new(), Vec::new(), Vec::new());
    let mut stand = Stand::begin(&screen, &file);
    screen.wait_until(true);
    for kill in 0..kills {
        if kill > 0 && kill % BORNE == 0 {
            stand.end();
            screen.wait_until(false);
            stand = Stand::begin(&screen, &file);
            screen.wait_until(true);
        }
        // The player plays, ends a round, and begins another.
        hand.play(Duration::from_secs(5));
        let before = rounds(&logbook).len();
        hand.tell("key r");
        let pressed = Instant::now();
        while rounds(&logbook).len() == before {
            assert!(pressed.elapsed() < LONG, "{kill}: the round is not written");
            thread::sleep(Duration::from_millis(10));
        }
        written.push(pressed.elapsed());
        let time = Duration::from_millis(hand.random.u64(..3000));
        hand.play(time);
        known.extend(rounds(&logbook));
        if kill % STOPPED == STOPPED - 1 {
            stopped += 1;
            stand.signal("-STOP");
            // A suspended game stays visible until the supervisor replaces it.
            let began = Instant::now();
            screen.wait_until(false);
            screen.wait_until(true);
            back_from_stop.push(began.elapsed());
        } else {
            stand.signal("-KILL");
            screen.wait_until(false);
            back.push(screen.wait_until(true));
        }
    }
    stand.end();
    let kept = rounds(&logbook);
    println!(
        "{kills} times, {stopped} of them stopped; {} rounds. Median and maximum time:",
        kept.len()
    );
    println!("  until it was back after a kill   {:.1?}", told(&mut back));
    println!(
        "  until it was back after a stop   {:.1?}",
        told(&mut back_from_stop)
    );
    println!(
        "  until a round was written        {:.2?}",
        told(&mut written)
    );
    assert!(known.is_subset(&kept));
    assert!(known.len() >= kills);
    let events = events(&logbook);
    let count = |kind: Kind| events.iter().filter(|&event| *event == kind).count();
    assert_eq!(count(Kind::Crashed), kills - stopped);
    assert_eq!(count(Kind::Hung), stopped);
    // Each round of the logbook can be played again.
    let out = folder.path().join("report");
    let mut report = Command::new(TAMAIRE);
    report.args(["report", "--rerun", "--no-clips", "--out"]);
    let counted = report.arg(&out).arg(&logbook).output().unwrap();
    let counted = String::from_utf8_lossy(&counted.stdout).into_owned();
    assert!(
        counted.ends_with(&format!(" {} rounds\n", kept.len())),
        "{counted}"
    );
}
