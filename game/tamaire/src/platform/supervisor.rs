//! Keeps a stand running: the same program as a parent, which starts the game anew when it breaks down, stands still or loses
//! what it draws with.

use super::machine::{StandFolder, digits};
use std::collections::VecDeque;
use std::ffi::OsString;
use std::fs;
use std::io::{self, BufRead, BufReader, Read, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};
use tamaire_logbook::{Entry, Event, Id, Kind, Logbook, Moment};

/// The exit status of a game whose GPU or window was lost.
pub const LOST_GRAPHICS: u8 = 3;

/// Signs to the parent: it lives, and it is ending as it was told to.
const LIVES: u8 = b'.';
const ENDS: u8 = b'e';
/// One that is ending may write for so long what is still to be written.
const ENDING: Duration = Duration::from_secs(30);
/// One that lived for less is not begun anew at once: what is wrong may pass.
const BRIEFLY: Duration = Duration::from_secs(5);
const SHORT_PAUSE: Duration = Duration::from_millis(250);
/// The longest such pause.
pub const PAUSE: Duration = Duration::from_secs(8);
/// So many crash records are kept.
const RECORDS: usize = 100;

/// Between two signs of life [s].
const PULSE: Duration = Duration::from_millis(500);
/// A game that gives none for so long stands still; at its start it may take longer.
const STILL: Duration = Duration::from_millis(3500);
const START: Duration = Duration::from_secs(60);
/// After so many breakdowns in such a time starting anew does not help.
pub const MOST: usize = 10;
const WHILE: Duration = Duration::from_secs(600);
/// How often the parent looks.
const LOOK: Duration = Duration::from_millis(50);
/// What the game told last is waited for so long.
const LAST_WORDS: Duration = Duration::from_millis(300);
/// So many of the last lines that the game told are kept.
const LINES: usize = 60;

/// Signs of life to the parent, told on the thread that draws.
pub struct Pulse {
    told: Option<Instant>,
}

impl Pulse {
    /// None was given yet.
    pub fn begin() -> Self {
        Self { told: None }
    }

    /// Gives one when it is time.
    ///
    /// # Errors
    /// When nobody listens any more.
    pub fn beat(&mut self) -> io::Result<()> {
        if self.told.is_some_and(|told| told.elapsed() < PULSE) {
            return Ok(());
        }
        self.told = Some(Instant::now());
        tell(LIVES)
    }

    /// Says that the program ends as it was told to, which may take a while.
    pub fn end(&self) {
        // Who does not listen need not know.
        let _heard = tell(ENDS);
    }
}

fn tell(sign: u8) -> io::Result<()> {
    let mut out = io::stdout().lock();
    out.write_all(&[sign])?;
    out.flush()
}

/// Says something where anybody may listen, or nobody.
fn say(text: &str) {
    let _heard = writeln!(io::stderr(), "{text}");
}

/// What a game is started with.
pub struct Plan {
    /// The program.
    pub program: PathBuf,
    /// What it is told to be the game.
    pub game: Vec<OsString>,
    /// What it is told to show a calm picture.
    pub calm: Vec<OsString>,
    /// Where the logbook is.
    pub folder: StandFolder,
    /// What the stand is called.
    pub stand: String,
    /// After so many breakdowns within ten minutes it is given up; [`MOST`] usually.
    pub most: usize,
    /// The longest pause before it is begun anew; [`PAUSE`] usually.
    pub pause: Duration,
}

/// How a game ended.
#[derive(Clone, Debug, PartialEq, Eq)]
enum End {
    Meant,
    Failed(Kind),
}

/// Runs the game until it ends as it was told to.
///
/// # Errors
/// When it cannot be started, or broke down again and again: then the calm picture was shown for as long as that went.
pub fn supervise(plan: &Plan) -> Result<(), String> {
    let mut failures: VecDeque<Instant> = VecDeque::new();
    let mut pause = SHORT_PAUSE;
    let mut notes = Vec::new();
    loop {
        let began = Instant::now();
        let (end, record) = run(plan, &plan.game);
        let End::Failed(kind) = end else {
            break;
        };
        say(&format!(
            "tamaire: the game {}: it begins anew",
            kind.text()
        ));
        notes.push(note(plan, kind, record));
        notes.retain(|note: &JoinHandle<()>| !note.is_finished());
        let now = Instant::now();
        failures.push_back(now);
        while failures.front().is_some_and(|&first| now - first > WHILE) {
            failures.pop_front();
        }
        if failures.len() >= plan.most {
            join(notes);
            return Err(give_up(plan));
        }
        if began.elapsed() < BRIEFLY && failures.len() > 1 {
            thread::sleep(pause.min(plan.pause));
            pause *= 2;
        } else {
            pause = SHORT_PAUSE;
        }
    }
    join(notes);
    Ok(())
}

fn join(notes: Vec<JoinHandle<()>>) {
    for note in notes {
        // One that panicked has told so itself.
        let _ended = note.join();
    }
}

/// Shows the calm picture for as long as that can be shown; what there is to tell.
fn give_up(plan: &Plan) -> String {
    let reason = format!(
        "the game broke down {} times within {} minutes; see {}",
        plan.most,
        WHILE.as_secs() / 60,
        plan.folder.0.join("crashes").display()
    );
    say(&format!("tamaire: {reason}"));
    join(vec![note(plan, Kind::GaveUp, reason.clone())]);
    for _ in 0..MOST {
        // It draws next to nothing. Where even that breaks down for good there is no picture to show.
        if run(plan, &plan.calm).0 == End::Meant {
            break;
        }
        thread::sleep(plan.pause);
    }
    reason
}

/// Runs the program once; how it ended, and what there is to know of it.
fn run(plan: &Plan, words: &[OsString]) -> (End, String) {
    let mut command = Command::new(&plan.program);
    command.args(words).stdin(Stdio::null());
    command.stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = match command.spawn() {
        Ok(child) => child,
        Err(error) => {
            let record = format!("{}: {error}", plan.program.display());
            return (End::Failed(Kind::Crashed), record);
        }
    };
    let signs = Arc::new(Mutex::new(Signs::default()));
    let lines = Arc::new(Mutex::new(VecDeque::new()));
    let listeners = [
        listen(&mut child, signs.clone()),
        read(&mut child, lines.clone()),
    ];
    let began = Instant::now();
    let (status, is_still) = wait(&mut child, began, &signs);
    let gone = Instant::now();
    for listener in listeners.into_iter().flatten() {
        // What it began itself may go on, and hold what it told to.
        while !listener.is_finished() && gone.elapsed() < LAST_WORDS {
            thread::sleep(LOOK);
        }
    }
    let end = match (status, is_still) {
        (_, true) => End::Failed(Kind::Hung),
        (Some(status), _) if status.success() => End::Meant,
        (Some(status), _) if status.code() == Some(LOST_GRAPHICS.into()) => {
            End::Failed(Kind::LostGraphics)
        }
        _ => End::Failed(Kind::Crashed),
    };
    let told = lines.lock().unwrap_or_else(PoisonError::into_inner);
    let told: Vec<String> = told.iter().cloned().collect();
    let unknown = || "it could not be waited for".to_string();
    let status = status.map_or_else(unknown, |status| status.to_string());
    let seconds = began.elapsed().as_secs_f32();
    let record = format!("{status} after {seconds:.1} s\n{}", told.join("\n"));
    (end, record)
}

/// What the game told of itself.
#[derive(Clone, Copy, Debug, Default)]
struct Signs {
    /// When it gave the last sign of life.
    last: Option<Instant>,
    /// When it said that it ends.
    ends: Option<Instant>,
}

/// Waits for the end, and ends what stands still.
fn wait(child: &mut Child, began: Instant, signs: &Mutex<Signs>) -> (Option<ExitStatus>, bool) {
    loop {
        match child.try_wait() {
            Ok(Some(status)) => return (Some(status), false),
            Ok(None) => {}
            Err(_) => return (None, false),
        }
        let Signs { last, ends } = *signs.lock().unwrap_or_else(PoisonError::into_inner);
        let is_still = match (ends, last) {
            (Some(ends), _) => ends.elapsed() > ENDING,
            (None, Some(last)) => last.elapsed() > STILL,
            (None, None) => began.elapsed() > START,
        };
        if is_still {
            // One that was stopped ends too.
            let _gone = child.kill();
            return (child.wait().ok(), true);
        }
        thread::sleep(LOOK);
    }
}

/// Hears what it tells of itself.
fn listen(child: &mut Child, signs: Arc<Mutex<Signs>>) -> Option<JoinHandle<()>> {
    let mut out = child.stdout.take()?;
    Some(thread::spawn(move || {
        let mut bytes = [0; 64];
        while let Ok(count) = out.read(&mut bytes)
            && count > 0
        {
            let mut signs = signs.lock().unwrap_or_else(PoisonError::into_inner);
            signs.last = Some(Instant::now());
            if bytes[..count].contains(&ENDS) {
                signs.ends = signs.last;
            }
        }
    }))
}

/// Passes on what it says, and keeps the last of it.
fn read(child: &mut Child, lines: Arc<Mutex<VecDeque<String>>>) -> Option<JoinHandle<()>> {
    let mut err = BufReader::new(child.stderr.take()?);
    Some(thread::spawn(move || {
        let mut line = Vec::new();
        // Drivers say anything, and whoever says something has to be heard.
        while err
            .read_until(b'\n', &mut line)
            .is_ok_and(|count| count > 0)
        {
            let text = String::from_utf8_lossy(&line).trim_end().to_string();
            line.clear();
            say(&text);
            let mut lines = lines.lock().unwrap_or_else(PoisonError::into_inner);
            if lines.len() == LINES {
                lines.pop_front();
            }
            lines.push_back(text);
        }
    }))
}

/// Writes down what happened, beside the logbook and in it, while the game begins anew.
fn note(plan: &Plan, kind: Kind, record: String) -> JoinHandle<()> {
    let (folder, stand, at) = (plan.folder.clone(), plan.stand.clone(), Moment::now());
    thread::spawn(move || {
        if let Err(error) = keep_record(&folder.0.join("crashes"), at, &kind, &record) {
            say(&format!("tamaire: {}: {error}", folder.0.display()));
        }
        let event = |kind, text| {
            let (id, stand) = (Id::random(), stand.clone());
            Entry::Event(Event {
                id,
                stand,
                at,
                kind,
                text,
            })
        };
        let noted = Logbook::open(&folder.logbook(), &stand);
        let noted = noted.and_then(|(mut logbook, aside)| {
            let aside = aside.map(|aside| format!("{}: {}", aside.path.display(), aside.reason));
            let aside = aside.map(|text| event(Kind::DamagedFile, text));
            let all: Vec<Entry> = aside.into_iter().chain([event(kind, record)]).collect();
            logbook.write_all(&all)
        });
        if let Err(error) = noted {
            say(&format!("tamaire: {error}"));
        }
    })
}

/// Keeps a record of a breakdown as a file, and no more of them than are of use.
fn keep_record(folder: &Path, at: Moment, kind: &Kind, record: &str) -> io::Result<()> {
    fs::create_dir_all(folder)?;
    let mut known: Vec<PathBuf> = fs::read_dir(folder)?
        .filter_map(|entry| Some(entry.ok()?.path()))
        .collect();
    known.sort();
    for old in known.iter().take((known.len() + 1).saturating_sub(RECORDS)) {
        fs::remove_file(old)?;
    }
    let name = format!("{}-{}", digits(at), at.utc_ms % 1000);
    fs::write(folder.join(format!("{name}-{}.txt", kind.text())), record)
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    fn plan(folder: &Path, script: &str) -> Plan {
        let words = |script: &str| ["-c", script].map(OsString::from).to_vec();
        Plan {
            program: "sh".into(),
            game: words(script),
            calm: words("echo calm > calm"),
            folder: StandFolder(folder.into()),
            stand: "test".into(),
            most: MOST,
            pause: Duration::ZERO,
        }
    }

    fn events(folder: &Path) -> Vec<(Kind, String)> {
        let logbook = Logbook::read(&StandFolder(folder.into()).logbook()).unwrap();
        let mut found = Vec::new();
        let each = |event: Event| {
            found.push((event.kind, event.text));
            Ok::<(), tamaire_logbook::Error>(())
        };
        logbook.events(.., each).unwrap();
        found
    }

    #[test]
    fn what_breaks_down_begins_anew_until_it_ends_as_it_was_meant() {
        let folder = tempfile::tempdir().unwrap();
        let (count, path) = ("count", folder.path());
        // Twice it fails, each time in another way.
        let script = format!(
            "cd '{}'; echo x >> {count}; case $(wc -l < {count}) in \
             1) echo broken >&2; kill -9 $$;; 2) exit {LOST_GRAPHICS};; *) exit 0;; esac",
            path.display()
        );
        supervise(&plan(path, &script)).unwrap();
        let events = events(path);
        let kinds: Vec<Kind> = events.iter().map(|(kind, _)| kind.clone()).collect();
        assert_eq!(kinds, [Kind::Crashed, Kind::LostGraphics]);
        assert!(
            events[0].1.contains("broken") && events[0].1.contains("signal: 9"),
            "{events:?}"
        );
        assert_eq!(fs::read_dir(path.join("crashes")).unwrap().count(), 2);
    }

    #[test]
    fn what_stands_still_is_ended_within_five_seconds() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path();
        let script = format!(
            "cd '{}'; printf .; if [ -e once ]; then exit 0; fi; touch once; kill -STOP $$; sleep 100",
            path.display()
        );
        let began = Instant::now();
        supervise(&plan(path, &script)).unwrap();
        assert!(began.elapsed() > STILL);
        assert_eq!(events(path)[0].0, Kind::Hung);
    }

    #[test]
    fn what_breaks_down_again_and_again_makes_room_for_a_calm_picture() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path();
        let mut plan = plan(path, "exit 7");
        plan.calm = [
            "-c".into(),
            format!("touch '{}/calm'", path.display()).into(),
        ]
        .to_vec();
        let reason = supervise(&plan).unwrap_err();
        assert!(reason.contains("10 times"), "{reason}");
        assert!(path.join("calm").exists());
        let events = events(path);
        assert_eq!(events.len(), MOST + 1);
        assert_eq!(events[MOST].0, Kind::GaveUp);
    }

    #[test]
    fn what_is_killed_fifty_times_is_back_fifty_times() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().to_path_buf();
        let script = format!(
            "cd '{}'; if [ -e enough ]; then exit 0; fi; printf .; echo $$ > draft; mv draft pid; exec sleep 600",
            path.display()
        );
        let plan = Plan {
            most: 100,
            ..plan(&path, &script)
        };
        let killer = thread::spawn(move || {
            let mut random = fastrand::Rng::with_seed(50);
            for kill in 0..50 {
                let pid = loop {
                    match fs::read_to_string(path.join("pid")) {
                        Ok(pid) => break pid,
                        Err(_) => thread::sleep(Duration::from_millis(2)),
                    }
                };
                fs::remove_file(path.join("pid")).unwrap();
                thread::sleep(Duration::from_millis(random.u64(..30)));
                if kill == 49 {
                    fs::write(path.join("enough"), "").unwrap();
                }
                let killed = Command::new("kill").args(["-9", pid.trim()]).status();
                assert!(killed.unwrap().success());
            }
        });
        supervise(&plan).unwrap();
        killer.join().unwrap();
        let events = events(folder.path());
        assert_eq!(events.len(), 50);
        assert!(events.iter().all(|(kind, _)| *kind == Kind::Crashed));
    }
}
