//! Other systems than this one: what compiles for them, and what runs their programs here.

use crate::debian;
use crate::packages::{IfMissing, Lack, apt_get, install_arguments, list_lacks};
use crate::shell::{CANNOT, FAILED, Failure, cargo, execute, is_on_path, root, target};
use crate::wine;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// A system that programs can be built for, and run, from here.
pub struct System {
    /// How it is called.
    pub name: &'static str,
    /// As Rust calls it.
    pub triple: &'static str,
    /// Links its programs; and the Debian package that has it.
    linker: (&'static str, &'static str),
    /// What else compiles for it, as programs or by a file.
    compilers: &'static [(&'static str, &'static str)],
    /// Runs its programs, with these words.
    runner: (&'static str, &'static str),
    words: &'static str,
}

/// 64-bit ARM with Linux, as in many a small computer.
pub const ARM: System = System {
    name: "ARM",
    triple: "aarch64-unknown-linux-gnu",
    linker: ("aarch64-linux-gnu-gcc", "gcc-aarch64-linux-gnu"),
    compilers: &[("/usr/aarch64-linux-gnu/lib/crt1.o", "libc6-dev-arm64-cross")],
    runner: ("qemu-aarch64", "qemu-user"),
    words: "-L /usr/aarch64-linux-gnu",
};

/// 64-bit Windows.
pub const WINDOWS: System = System {
    name: "Windows",
    triple: "x86_64-pc-windows-gnu",
    linker: ("x86_64-w64-mingw32-gcc", "gcc-mingw-w64-x86-64"),
    compilers: &[
        ("x86_64-w64-mingw32-g++", "g++-mingw-w64-x86-64"),
        ("cmake", "cmake"),
        ("make", "make"),
    ],
    runner: ("wine", "wine"),
    words: "",
};

/// What is wanted of a system.
#[derive(Clone, Copy, PartialEq)]
pub enum Wanted {
    /// To build programs for it.
    Build,
    /// And to run them here.
    Run,
}

/// What compiles for a system.
pub struct Compiler {
    pub system: &'static System,
    /// Where Debian's standard library is in source, unless the toolchain in use has it built.
    pub sources: Option<PathBuf>,
}

impl System {
    /// The compiler to use. Where there is none, `undone` says what did not happen.
    pub fn compiler(
        &'static self,
        wanted: Wanted,
        if_missing: IfMissing,
        undone: &str,
    ) -> Result<Compiler, Failure> {
        let mut found = self.find(wanted);
        if if_missing == IfMissing::Install
            && let Err(lacks) = &found
        {
            // Fresh machines have stale lists, or none. An update that fails may leave good ones.
            apt_get(&["update", "--quiet"]);
            let names = lacks.iter().map(|lack| lack.package.as_str());
            apt_get(&install_arguments(names));
            found = self.find(wanted);
        }
        found.map_err(|lacks| Failure {
            message: format!(
                "{undone}:\n{}\nOn Debian, the same with `--install` installs that. \
                 Elsewhere: `rustup target add {}`, and the programs on the path.",
                list_lacks(&lacks),
                self.triple
            ),
            code: CANNOT,
        })
    }

    fn find(&'static self, wanted: Wanted) -> Result<Compiler, Vec<Lack>> {
        let programs = [self.linker].into_iter();
        let programs = programs.chain(self.compilers.iter().copied());
        let runner = (wanted == Wanted::Run).then_some(self.runner);
        let mut lacks: Vec<Lack> = programs
            .chain(runner)
            // An absolute path replaces the folders of the path.
            .filter(|(program, _)| !is_on_path(program))
            .map(|(program, package)| Lack::new(format!("there is no {program}"), package))
            .collect();
        let mut sources = None;
        if !debian::toolchain_has(self.triple) {
            match debian::find(self.triple, debian::description().as_deref(), Path::exists) {
                Err(lack) => lacks.extend([lack, Lack::new("nor its sources", "rust-web-src")]),
                Ok(found) => match found.sources {
                    Err(lack) => lacks.push(lack),
                    Ok(path) => sources = Some(path),
                },
            }
        }
        match lacks.is_empty() {
            true => Ok(Compiler {
                system: self,
                sources,
            }),
            false => Err(lacks),
        }
    }

    /// Where programs for it are built, in folders named for their profiles.
    pub fn folder(&self) -> PathBuf {
        root().join(target()).join("other").join(self.triple)
    }

    /// The game as it is handed out, where it was built.
    fn handed_out(&self) -> Option<PathBuf> {
        let game = self.folder().join("dist/tamaire.exe");
        game.is_file().then_some(game)
    }

    /// Its programs on this machine, with what keeps them from touching the files of whoever works here.
    fn run(&self, program: &Path) -> Command {
        let mut command = Command::new(self.runner.0);
        command.args(self.words.split_whitespace()).arg(program);
        self.shield(&mut command);
        command
    }

    fn is_windows(&self) -> bool {
        self.runner.0 == "wine"
    }

    fn shield(&self, command: &mut Command) {
        if self.is_windows() {
            wine::shield(command);
        }
    }
}

impl Compiler {
    /// A call of cargo that builds for the system, and runs there what is to be run.
    pub fn cargo(&self, words: &[&str]) -> Command {
        let System {
            triple,
            linker,
            runner,
            words: runner_words,
            ..
        } = self.system;
        let name = triple.to_uppercase().replace('-', "_");
        let mut command = cargo();
        let (cargo_words, own) = match words.iter().position(|word| *word == "--") {
            Some(end) => words.split_at(end),
            None => (words, &[][..]),
        };
        command.args(cargo_words).args(["--target", triple]);
        command
            .env("CARGO_TARGET_DIR", root().join(target()).join("other"))
            .env(format!("CARGO_TARGET_{name}_LINKER"), linker.0)
            .env(
                format!("CARGO_TARGET_{name}_RUNNER"),
                format!("{} {runner_words}", runner.0).trim(),
            )
            // Flags for the native build, such as a target-cpu, make no sense here.
            .env_remove("RUSTFLAGS")
            .env_remove("CARGO_ENCODED_RUSTFLAGS");
        if self.sources.is_some() {
            command.arg("-Zbuild-std=std,panic_unwind,test");
            command.envs(debian::ENVIRONMENT);
        }
        self.system.shield(&mut command);
        command.args(own);
        command
    }
}

/// The golden scenes and 20 rounds of bots on another system: the same bits?
pub fn check(system: &'static System, if_missing: IfMissing) -> Result<(), Failure> {
    let undone = format!("the golden scenes were NOT run on {}", system.name);
    let compiler = system.compiler(Wanted::Run, if_missing, &undone)?;
    if system.is_windows() {
        wine::prepare(system.linker.0)?;
    }
    execute(
        &mut compiler.cargo(&["test", "--release", "--package", "determinism_checks"]),
        "a scene ends in other bits there: look for arithmetic beyond + - * / and sqrt, and for lanes that sum in another order",
    )?;
    let folder = root().join(target()).join("replays");
    let replays = folder.display().to_string();
    let example = [
        "run",
        "--release",
        "--package",
        "determinism_checks",
        "--example",
        "replays",
        "--",
    ];
    let mut record = cargo();
    record.args(example).args(["record", &replays]);
    execute(&mut record, "the bots' rounds could not be recorded")?;
    execute(
        &mut compiler.cargo(&[&example[..], &["verify", &replays]].concat()),
        "a round that was recorded here goes another way there",
    )?;
    match system.handed_out() {
        Some(game) => watch_all(system, &game, &folder),
        None => Ok(()),
    }
}

/// The same rounds, watched by the game as it is handed out, in a folder whose name is no plain word.
fn watch_all(system: &System, game: &Path, replays: &Path) -> Result<(), Failure> {
    let folder = replays.join("遊び 場");
    let copied = fs::create_dir_all(&folder).and_then(|()| {
        let copy = folder.join("玉入れ tamaire.exe");
        fs::copy(game, &copy).map(|_| copy)
    });
    let entries = fs::read_dir(replays);
    let (copied, entries) = copied
        .and_then(|copied| Ok((copied, entries?)))
        .map_err(|error| Failure {
            message: format!("{}: {error}", game.display()),
            code: FAILED,
        })?;
    let files = entries.flatten().map(|entry| entry.path());
    let mut count = 0;
    for file in files.filter(|file| file.extension().is_some_and(|name| name == "tamaire")) {
        let mut watch = system.run(&copied);
        watch.args(["--headless", "--replay"]).arg(&file);
        execute(
            &mut watch,
            "the game takes a round for changed that was not",
        )?;
        count += 1;
    }
    println!(
        "{}: the game itself watched {count} rounds, and all go as they say",
        system.name
    );
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_for_the_program_stay_behind_those_for_cargo() {
        let compiler = Compiler {
            system: &ARM,
            sources: Some(PathBuf::from("/usr/src")),
        };
        let command = compiler.cargo(&["run", "--", "verify", "here"]);
        let words: Vec<_> = command.get_args().collect();
        assert_eq!(
            words,
            [
                "run",
                "--target",
                "aarch64-unknown-linux-gnu",
                "-Zbuild-std=std,panic_unwind,test",
                "--",
                "verify",
                "here"
            ]
        );
        let runner = command
            .get_envs()
            .find(|(name, _)| *name == "CARGO_TARGET_AARCH64_UNKNOWN_LINUX_GNU_RUNNER");
        let runner = runner.and_then(|(_, value)| value).unwrap();
        assert_eq!(runner, "qemu-aarch64 -L /usr/aarch64-linux-gnu");
    }
}
