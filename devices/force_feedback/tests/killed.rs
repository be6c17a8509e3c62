//! A process that is killed while it pushes: the last that it told ends by itself.

use force_feedback::{Ability, Force, Gone, LENGTH, Manner, Output, Settings, Sink, State};
use std::fs::File;
use std::io::Write;
use std::process::{Command, Stdio};
use std::time::{Duration, SystemTime, UNIX_EPOCH};

/// Where the child writes.
const PATH: &str = "FORCE_FEEDBACK_TEST_PATH";
const PATIENCE: Duration = Duration::from_secs(60);

/// Writes down in ms when what it is told begins and when it ends, as a device would have it in its memory.
struct Device(File);

impl Sink for Device {
    fn ability(&self) -> Ability {
        Ability::Force
    }

    fn aim(&mut self) -> Result<[f32; 2], Gone> {
        Ok([1.0, 0.0])
    }

    fn play(&mut self, output: Output) -> Result<(), Gone> {
        let start = now();
        let end = start + LENGTH;
        let line = format!(
            "{} {} {}\n",
            start.as_millis(),
            end.as_millis(),
            output.levels()[0]
        );
        self.0.write_all(line.as_bytes()).map_err(|_| Gone)
    }
}

fn now() -> Duration {
    SystemTime::now()
        .duration_since(UNIX_EPOCH)
        .expect("it is later than 1970")
}

/// What the device was told: when, until when and how strongly.
fn told(path: &std::path::Path) -> Vec<[i128; 3]> {
    let text = std::fs::read_to_string(path).unwrap_or_default();
    // The last line may be half written.
    let lines = text
        .split_inclusive('\n')
        .filter(|line| line.ends_with('\n'));
    let numbers = |line: &str| {
        let all: Vec<i128> = line.split_whitespace().flat_map(str::parse).collect();
        all.try_into().expect("a line has three numbers")
    };
    lines.map(numbers).collect()
}

#[test]
#[ignore = "the child of the other test"]
fn push_until_killed() {
    let Some(path) = std::env::var_os(PATH) else {
        return;
    };
    let file = File::create(path).expect("the parent made a place for it");
    let force = Force::start(250).expect("the system has a thread");
    let line = force.add(Box::new(Device(file)), Settings::default());
    let start = std::time::Instant::now();
    // If the parent has gone, so that nobody kills it, it ends.
    while start.elapsed() < PATIENCE {
        line.feel(State {
            contact: [-300.0, 0.0],
            manner: Manner::Steers,
        });
        std::thread::sleep(Duration::from_millis(10));
    }
}

#[test]
fn a_killed_process_pushes_for_half_a_second_at_most() {
    let path = std::env::temp_dir().join(format!("force_feedback_{}", std::process::id()));
    let mut child = Command::new(std::env::current_exe().expect("this is running"))
        .args(["--exact", "push_until_killed", "--ignored"])
        .env(PATH, &path)
        .stdout(Stdio::null())
        .spawn()
        .expect("this test can be started");
    let start = now();
    while told(&path).last().is_none_or(|last| last[2] > -5000) {
        assert!(now() - start < PATIENCE, "it never pushed");
        std::thread::sleep(Duration::from_millis(5));
    }
    // SIGKILL: no handler runs, and nothing is dropped.
    child.kill().expect("it runs");
    child.wait().expect("it was killed");
    let killed = now().as_millis() as i128;
    let before = told(&path);
    std::thread::sleep(LENGTH);
    let after = told(&path);
    std::fs::remove_file(&path).expect("it was just read");

    assert_eq!(after, before, "nobody tells it anything any more");
    let last = after.last().expect("it was told");
    assert_ne!(last[2], 0, "it was killed while it pushed");
    assert!(last[1] <= killed + LENGTH.as_millis() as i128);
    assert!(now().as_millis() as i128 >= last[1], "it is over by now");
}
