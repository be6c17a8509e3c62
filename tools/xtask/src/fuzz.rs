//! Fuzzing of the entry points ("doors") of `tools/fuzz` with libFuzzer. A stable compiler suffices, because
//! every LLVM contains the coverage passes. cargo-fuzz needs a nightly compiler only for sanitizers, which
//! are not used here.

use crate::packages::{IfMissing, Purpose, provide};
use crate::shell::{Failure, cargo, execute, output_of, root, target};
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;

/// Compiler flags that add coverage counters and trace comparisons. With `cfg(fuzzing)` all PNG checksums
/// count as valid.
const FLAGS: &str = "--cfg fuzzing -Cpasses=sancov-module -Cllvm-args=-sanitizer-coverage-level=4 \
    -Cllvm-args=-sanitizer-coverage-inline-8bit-counters -Cllvm-args=-sanitizer-coverage-pc-table \
    -Cllvm-args=-sanitizer-coverage-trace-compares";

/// Time limit for a single input [s].
const MOST_SECONDS: u32 = 2;
/// Memory limit for a single input [MiB].
const MOST_MEMORY: u32 = 1024;

/// Maximum length of an input [bytes].
const MOST_BYTES: u32 = 1 << 16;

/// Default duration of a run over all doors [min].
const MINUTES: f32 = 9.0;

/// Result of fuzzing a door.
struct Outcome {
    seconds: u64,
    is_good: bool,
    log: String,
}

/// Fuzzes the named doors, or all doors if none is named. The duration is divided equally among the doors.
pub fn run(words: &[String]) -> Result<(), Failure> {
    let (minutes, doors) = parse_arguments(words).map_err(Failure::failed)?;
    provide(&[Purpose::Build, Purpose::Fuzzing], IfMissing::Install);
    let (program, folder) = build()?;
    let doors = match doors.is_empty() {
        true => all_doors(&folder.join("seeds"))?,
        false => doors.to_vec(),
    };
    let found = folder.join("found");
    fs::create_dir_all(&found).map_err(|error| Failure::failed(error.to_string()))?;
    let seconds = (60.0 * minutes / doors.len() as f32).max(1.0) as u32;
    println!("door        inputs  coverage    corpus  seconds  slowest [s]  memory [MiB]");
    let mut bad = Vec::new();
    for door in &doors {
        let outcome = fuzz_door(&program, &folder, door, seconds);
        let outcome = outcome.map_err(|error| Failure::failed(format!("{door}: {error}")))?;
        println!("{door:10}{}", row(&outcome));
        if !outcome.is_good {
            bad.push(door.as_str());
        }
    }
    if bad.is_empty() {
        return Ok(());
    }
    Err(Failure::failed(format!(
        "{} failed: the inputs are in {}, the logs beside it; fix the fault, and add \
         the input to tools/fuzz/found",
        bad.join(", "),
        found.display()
    )))
}

/// Parses the number of minutes and the names of the doors.
fn parse_arguments(words: &[String]) -> Result<(f32, &[String]), String> {
    let Some((first, doors)) = words.split_first() else {
        return Ok((MINUTES, &[]));
    };
    let minutes = first.parse().ok();
    let minutes = minutes.filter(|minutes: &f32| minutes.is_finite() && *minutes > 0.0);
    let minutes = minutes.ok_or(format!("expected a number of minutes, found {first:?}"));
    Ok((minutes?, doors))
}

/// Builds the fuzzer and writes its seeds; returns the program and its folder.
fn build() -> Result<(PathBuf, PathBuf), Failure> {
    let host = output_of("rustc", &["-vV"]).unwrap_or_default();
    let host = host.lines().find_map(|line| line.strip_prefix("host: "));
    let host = host.ok_or_else(|| Failure::failed("`rustc -vV` prints no host triple"))?;
    let folder = root().join(target()).join("fuzz");
    let mut command = cargo();
    command.args(["build", "--profile", "fuzz", "--package", "fuzz_targets"]);
    command.args(["--bin", "fuzz"]);
    // Gives the target explicitly, so that the flags do not apply to build scripts.
    command
        .args(["--target", host, "--target-dir"])
        .arg(&folder);
    command.env("RUSTFLAGS", FLAGS);
    execute(
        &mut command,
        "the fuzzer does not compile, see above; it must match the doors of tools/fuzz",
    )?;
    let program = folder.join(host).join("fuzz/fuzz");
    let mut seeds = Command::new(&program);
    seeds.env("SEEDS", folder.join("seeds"));
    execute(&mut seeds, "the fuzzer could not write its seeds")?;
    Ok((program, folder))
}

/// Returns the names of all doors, which are the names of the folders of seeds.
fn all_doors(seeds: &Path) -> Result<Vec<String>, Failure> {
    let folders = fs::read_dir(seeds).map_err(|error| Failure::failed(error.to_string()))?;
    let folders = folders.flatten().filter(|entry| entry.path().is_dir());
    let mut doors: Vec<_> = folders
        .map(|entry| entry.file_name().to_string_lossy().into_owned())
        .collect();
    doors.sort();
    Ok(doors)
}

/// Fuzzes a door for some seconds. Inputs with new coverage are kept for the next run.
fn fuzz_door(program: &Path, folder: &Path, door: &str, seconds: u32) -> std::io::Result<Outcome> {
    let [corpus, seeds] = ["corpus", "seeds"].map(|part| folder.join(part).join(door));
    fs::create_dir_all(&corpus)?;
    let log = folder.join(format!("{door}.log"));
    let words = folder.join("seeds").join(format!("{door}.words"));
    let prefix = folder.join("found").join(format!("{door}-"));
    let mut command = Command::new(program);
    command.env("DOOR", door).stderr(File::create(&log)?);
    command.arg(format!("-max_total_time={seconds}"));
    command.arg(format!("-timeout={MOST_SECONDS}"));
    command.arg(format!("-rss_limit_mb={MOST_MEMORY}"));
    command.arg(format!("-max_len={MOST_BYTES}"));
    command.arg(format!("-dict={}", words.display()));
    command.arg(format!("-artifact_prefix={}", prefix.display()));
    command.arg("-print_final_stats=1").args([corpus, seeds]);
    let start = Instant::now();
    let status = command.status()?;
    Ok(Outcome {
        seconds: start.elapsed().as_secs(),
        is_good: status.success(),
        log: fs::read_to_string(&log)?,
    })
}

/// Formats libFuzzer's final statistics.
fn row(outcome: &Outcome) -> String {
    let told = |name: &str| {
        let mut lines = outcome.log.lines().rev();
        lines
            .find_map(|line| line.strip_prefix(name))
            .unwrap_or("?")
            .trim()
            .to_string()
    };
    // Returns the last value of a name in libFuzzer's lines, such as `cov: 50 ft: 60 corp: 10/1Kb`. Of
    // `10/1Kb` the result is 10.
    let last = |name: &str| {
        let after = outcome
            .log
            .rsplit_once(name)
            .map_or("?", |(_, after)| after);
        let word = after.split_whitespace().next().unwrap_or("?");
        word.split('/').next().unwrap_or("?").to_string()
    };
    format!(
        "{:>8}{:>10}{:>10}{:>9}{:>13}{:>14}",
        told("stat::number_of_executed_units:"),
        last(" cov:"),
        last(" corp:"),
        outcome.seconds,
        told("stat::slowest_unit_time_sec:"),
        told("stat::peak_rss_mb:"),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arguments_are_minutes_then_doors() {
        let words = |line: &str| {
            line.split_whitespace()
                .map(String::from)
                .collect::<Vec<_>>()
        };
        assert_eq!(parse_arguments(&[]), Ok((MINUTES, &[][..])));
        let line = words("0.5 png vox");
        assert_eq!(parse_arguments(&line), Ok((0.5, &words("png vox")[..])));
        for line in ["png", "-1", "nan", "0"] {
            assert!(parse_arguments(&words(line)).is_err(), "{line}");
        }
    }

    #[test]
    fn row_uses_last_statistics() {
        let log = "#2 INITED cov: 5 ft: 6 corp: 1/1b\n#99 DONE cov: 50 ft: 60 corp: 10/1Kb\n\
                   stat::number_of_executed_units: 99\nstat::slowest_unit_time_sec:  1\nstat::peak_rss_mb: 40\n";
        let outcome = Outcome {
            seconds: 7,
            is_good: true,
            log: log.into(),
        };
        let row = row(&outcome);
        let found: Vec<&str> = row.split_whitespace().collect();
        assert_eq!(found, ["99", "50", "10", "7", "1", "40"]);
    }
}
