//! Supervisor of a stand. A parent process restarts the game when it crashes, hangs or loses its GPU.

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

/// Exit status of a game that lost its GPU or window.
pub const LOST_GRAPHICS: u8 = 3;

/// Heartbeat that the game sends to the supervisor.
const LIVES: u8 = b'.';
/// Announcement of a regular end, sent by the game.
const ENDS: u8 = b'e';
/// Maximum time for pending writes after the announcement of the end.
const ENDING: Duration = Duration::from_secs(30);
/// Run time of the game below which a repeated crash delays the restart, so that a temporary cause can pass.
const BRIEFLY: Duration = Duration::from_secs(5);
/// First delay of a restart. The delay doubles with each further crash soon after a start.
const SHORT_PAUSE: Duration = Duration::from_millis(250);
/// Usual value of [`SupervisorConfig::pause`], the longest delay of a restart.
pub const PAUSE: Duration = Duration::from_secs(8);
/// Maximum number of stored crash records.
const RECORDS: usize = 100;

/// Time between two heartbeats.
const PULSE: Duration = Duration::from_millis(500);
/// Time without a heartbeat after which the game counts as hung.
const STILL: Duration = Duration::from_millis(3500);
/// Maximum time until the first heartbeat.
const START: Duration = Duration::from_secs(60);
/// Number of crashes within ten minutes after which the supervisor stops restarting the game.
pub const MAX_CRASHES: usize = 10;
/// Period in which crashes are counted for [`MAX_CRASHES`].
const WHILE: Duration = Duration::from_secs(600);
/// Interval at which the state of the game is checked.
const LOOK: Duration = Duration::from_millis(50);
/// Maximum time to wait for the last output of a game that has ended.
const LAST_WORDS: Duration = Duration::from_millis(300);
/// Number of output lines of the game that are kept for a crash record.
const LINES: usize = 60;

/// Sender of heartbeats to the supervisor. It is used on the drawing thread, so that a hang of this thread is
/// noticed.
pub struct Heartbeat {
    told: Option<Instant>,
}

impl Heartbeat {
    /// Creates a sender; the first heartbeat is due at once.
    pub fn begin() -> Self {
        Self { told: None }
    }

    /// Sends a heartbeat if it is due.
    ///
    /// # Errors
    /// If the supervisor has ended.
    pub fn beat(&mut self) -> io::Result<()> {
        if self.told.is_some_and(|told| told.elapsed() < PULSE) {
            return Ok(());
        }
        self.told = Some(Instant::now());
        tell(LIVES)
    }

    /// Announces a regular end of the program, which may take a while.
    pub fn end(&self) {
        // Ignores a failure to send, because without a supervisor the signal is not needed.
        let _heard = tell(ENDS);
    }
}

fn tell(sign: u8) -> io::Result<()> {
    let mut out = io::stdout().lock();
    out.write_all(&[sign])?;
    out.flush()
}

/// Prints to stderr. A closed stderr is no error.
fn say(text: &str) {
    let _heard = writeln!(io::stderr(), "{text}");
}

/// Parameters of the supervisor.
pub struct SupervisorConfig {
    /// Path of the program.
    pub program: PathBuf,
    /// Arguments that start the game.
    pub game: Vec<OsString>,
    /// Arguments that start the program with a static picture instead of the game.
    pub calm: Vec<OsString>,
    /// Folder of the logbook.
    pub folder: StandFolder,
    /// Name of the stand.
    pub stand: String,
    /// Number of crashes within ten minutes after which the supervisor stops restarting the game. Usually
    /// [`MAX_CRASHES`].
    pub most: usize,
    /// Longest delay of a restart. Usually [`PAUSE`].
    pub pause: Duration,
}

/// Way in which a run of the game ended.
#[derive(Clone, Debug, PartialEq, Eq)]
enum End {
    Meant,
    Failed(Kind),
}

/// Runs the game until its regular end.
///
/// # Errors
/// If the game cannot be started or crashes repeatedly. The function then shows a static picture before it
/// returns the error.
pub fn supervise(plan: &SupervisorConfig) -> Result<(), String> {
    let mut failures: VecDeque<Instant> = VecDeque::new();
    let mut pause = SHORT_PAUSE;
    let mut notes = Vec::new();
    loop {
        let began = Instant::now();
        let (end, record) = run(plan, &plan.game);
        let End::Failed(kind) = end else {
            break;
        };
        say(&format!("tamaire: the game {}; restarting it", kind.text()));
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
        // Ignores a panic of the thread, which has printed its message already.
        let _ended = note.join();
    }
}

/// Shows a static picture until the program is ended. Returns the reason for giving up.
fn give_up(plan: &SupervisorConfig) -> String {
    let reason = format!(
        "the game failed {} times within {} minutes; see {}",
        plan.most,
        WHILE.as_secs() / 60,
        plan.folder.0.join("crashes").display()
    );
    say(&format!("tamaire: {reason}"));
    join(vec![note(plan, Kind::GaveUp, reason.clone())]);
    for _ in 0..MAX_CRASHES {
        // The static picture needs almost no drawing, so it may work where the game fails. If the picture
        // fails repeatedly, too, the screen stays empty.
        if run(plan, &plan.calm).0 == End::Meant {
            break;
        }
        thread::sleep(plan.pause);
    }
    reason
}

/// Runs the program once. Returns how it ended, and a crash record.
fn run(plan: &SupervisorConfig, words: &[OsString]) -> (End, String) {
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
        // The wait is limited: a child process of the game may outlive the game and hold the pipe open.
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
    let unknown = || "the exit status is unknown".to_string();
    let status = status.map_or_else(unknown, |status| status.to_string());
    let seconds = began.elapsed().as_secs_f32();
    let record = format!("{status} after {seconds:.1} s\n{}", told.join("\n"));
    (end, record)
}

/// Signals received from the game.
#[derive(Clone, Copy, Debug, Default)]
struct Signs {
    /// Time of the last heartbeat.
    last: Option<Instant>,
    /// Time of the announcement of the end.
    ends: Option<Instant>,
}

/// Waits for the end of the game, and kills it if it hangs. Returns the exit status and whether it hung.
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
            // Ends even a process that a signal has stopped.
            let _gone = child.kill();
            return (child.wait().ok(), true);
        }
        thread::sleep(LOOK);
    }
}

/// Receives the heartbeats of the game.
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

/// Forwards the error output of the game, and keeps its last lines.
fn read(child: &mut Child, lines: Arc<Mutex<VecDeque<String>>>) -> Option<JoinHandle<()>> {
    let mut err = BufReader::new(child.stderr.take()?);
    Some(thread::spawn(move || {
        let mut line = Vec::new();
        // Output of drivers may be invalid UTF-8. It is read all the same, since a full pipe would block the
        // game.
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

/// Starts writing a crash record to a file and to the logbook; the game restarts in the meantime.
fn note(plan: &SupervisorConfig, kind: Kind, record: String) -> JoinHandle<()> {
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

/// Writes a crash record to a file and deletes the oldest records.
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

    fn plan(folder: &Path, script: &str) -> SupervisorConfig {
        let words = |script: &str| ["-c", script].map(OsString::from).to_vec();
        SupervisorConfig {
            program: "sh".into(),
            game: words(script),
            calm: words("echo calm > calm"),
            folder: StandFolder(folder.into()),
            stand: "test".into(),
            most: MAX_CRASHES,
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
    fn crashed_game_is_restarted_until_regular_end() {
        let folder = tempfile::tempdir().unwrap();
        let (count, path) = ("count", folder.path());
        // The script fails twice, in different ways.
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
    fn hung_game_is_killed_within_five_seconds() {
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
    fn calm_picture_is_shown_after_repeated_crashes() {
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
        assert_eq!(events.len(), MAX_CRASHES + 1);
        assert_eq!(events[MAX_CRASHES].0, Kind::GaveUp);
    }

    #[test]
    fn supervisor_restarts_game_after_each_of_fifty_kills() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().to_path_buf();
        let script = format!(
            "cd '{}'; if [ -e enough ]; then exit 0; fi; printf .; echo $$ > draft; mv draft pid; exec sleep 600",
            path.display()
        );
        let plan = SupervisorConfig {
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
