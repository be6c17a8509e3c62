//! Test that kills a process while it pushes the stick: the last output of the process ends by itself.

use force_feedback::{
    Ability, ForceThread, Gone, OUTPUT_DURATION, Output, Settings, Sink, State, StickMode,
};
use std::fs::File;
use std::io::Write;
use std::process::{Command, Stdio};
use std::time::{Duration, SystemTime, UNIX_EPOCH};

/// Environment variable with the path of the file that the child writes.
const PATH: &str = "FORCE_FEEDBACK_TEST_PATH";
const PATIENCE: Duration = Duration::from_secs(60);

/// Device that writes a line for each output to a file: start and end time [ms since 1970], and strength.
struct Device(File);

impl Sink for Device {
    fn ability(&self) -> Ability {
        Ability::Force
    }

    fn stick_position(&mut self) -> Result<[f32; 2], Gone> {
        Ok([1.0, 0.0])
    }

    fn play(&mut self, output: Output) -> Result<(), Gone> {
        let start = now();
        let end = start + OUTPUT_DURATION;
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
        .expect("the time is after 1970")
}

/// Returns the outputs in the file of [`Device`]: start and end time [ms since 1970], and strength.
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
    let file = File::create(path).expect("the file can be created");
    let force = ForceThread::start(250).expect("a thread can be started");
    let line = force.add(Box::new(Device(file)), Settings::default());
    let start = std::time::Instant::now();
    // Ends the loop after a while, in case the parent has ended and cannot kill this process.
    while start.elapsed() < PATIENCE {
        line.set_state(State {
            contact: [-300.0, 0.0],
            manner: StickMode::Velocity,
        });
        std::thread::sleep(Duration::from_millis(10));
    }
}

#[test]
fn force_of_a_killed_process_ends_within_half_a_second() {
    let path = std::env::temp_dir().join(format!("force_feedback_{}", std::process::id()));
    let mut child = Command::new(std::env::current_exe().expect("the path of the test is known"))
        .args(["--exact", "push_until_killed", "--ignored"])
        .env(PATH, &path)
        .stdout(Stdio::null())
        .spawn()
        .expect("the child can be started");
    let start = now();
    while told(&path).last().is_none_or(|last| last[2] > -5000) {
        assert!(now() - start < PATIENCE, "the child never pushed");
        std::thread::sleep(Duration::from_millis(5));
    }
    // `kill` sends SIGKILL, so no handler runs, and nothing is dropped.
    child.kill().expect("the child runs");
    child.wait().expect("the child can be waited for");
    let killed = now().as_millis() as i128;
    let before = told(&path);
    std::thread::sleep(OUTPUT_DURATION);
    let after = told(&path);
    std::fs::remove_file(&path).expect("the file can be removed");

    assert_eq!(after, before, "an output arrived after the kill");
    let last = after.last().expect("there was an output");
    assert_ne!(last[2], 0, "the last output is zero");
    assert!(last[1] <= killed + OUTPUT_DURATION.as_millis() as i128);
    assert!(
        now().as_millis() as i128 >= last[1],
        "the last output still lasts"
    );
}
