//! Cross compilation for other systems, and running the compiled programs on this machine.

use crate::debian;
use crate::packages::{IfMissing, MissingItem, apt_get, install_arguments, list_lacks};
use crate::shell::{Failure, cargo, execute, is_on_path, root, target};
use crate::wine;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Target system for which this machine can build programs and run them in an emulator.
pub struct System {
    /// Name of the system, for messages.
    pub name: &'static str,
    /// Rust's target triple.
    pub triple: &'static str,
    /// Linker, and the Debian package that contains it.
    linker: (&'static str, &'static str),
    /// Other programs or files that the build requires, each with its Debian package.
    compilers: &'static [(&'static str, &'static str)],
    /// Emulator and its Debian package; `words` are its arguments.
    runner: (&'static str, &'static str),
    words: &'static str,
}

/// 64-bit ARM with Linux.
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

/// Intended use of a target system.
#[derive(Clone, Copy, PartialEq)]
pub enum Wanted {
    /// Build programs for the system.
    Build,
    /// Build programs for the system and run them on this machine.
    Run,
}

/// Toolchain for a target system.
pub struct Compiler {
    pub system: &'static System,
    /// Sources of the standard library, from Debian, from which cargo builds it. `None` if the toolchain in
    /// use contains a built standard library.
    pub sources: Option<PathBuf>,
}

impl System {
    /// Returns the toolchain for this system. If there is none, the error begins with `undone`, which names
    /// the task that needed it.
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
            // Updates the package lists, which are old or missing on fresh machines. If the update fails, the
            // old lists may still suffice.
            apt_get(&["update", "--quiet"]);
            let names = lacks.iter().map(|lack| lack.package.as_str());
            apt_get(&install_arguments(names));
            found = self.find(wanted);
        }
        found.map_err(|lacks| {
            Failure::cannot(format!(
                "{undone}:\n{}\nOn Debian, add `--install` to install the packages. \
                 Elsewhere, run `rustup target add {}` and put the programs on the path.",
                list_lacks(&lacks),
                self.triple
            ))
        })
    }

    fn find(&'static self, wanted: Wanted) -> Result<Compiler, Vec<MissingItem>> {
        let programs = [self.linker].into_iter();
        let programs = programs.chain(self.compilers.iter().copied());
        let runner = (wanted == Wanted::Run).then_some(self.runner);
        let mut lacks: Vec<MissingItem> = programs
            .chain(runner)
            // Looks for a program on the search path; an absolute path is checked as it is.
            .filter(|(program, _)| !is_on_path(program))
            .map(|(program, package)| MissingItem::new(format!("{program} not found"), package))
            .collect();
        let mut sources = None;
        if !debian::toolchain_has(self.triple) {
            match debian::find(self.triple, debian::description().as_deref(), Path::exists) {
                Err(lack) => lacks.extend([lack, MissingItem::new("no sources", "rust-web-src")]),
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

    /// Folder of programs built for this system, with a subfolder for each profile.
    pub fn folder(&self) -> PathBuf {
        root().join(target()).join("other").join(self.triple)
    }

    /// Returns the path of the game's release build for Windows, if it exists.
    fn handed_out(&self) -> Option<PathBuf> {
        let game = self.folder().join("dist/tamaire.exe");
        game.is_file().then_some(game)
    }

    /// Returns a command that runs a program of this system in its emulator. Wine gets a prefix of its own,
    /// so that it does not touch the user's files.
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
    /// Returns a cargo command that builds for the system and runs programs in its emulator.
    pub fn cargo(&self, words: &[&str]) -> Command {
        let mut command = cargo();
        let (cargo_words, own) = match words.iter().position(|word| *word == "--") {
            Some(end) => words.split_at(end),
            None => (words, &[][..]),
        };
        command.args(cargo_words);
        command.args(["--target", self.system.triple]);
        if self.sources.is_some() {
            command.arg("-Zbuild-std=std,panic_unwind,test");
        }
        self.set_variables(&mut command);
        command.args(own);
        command
    }

    /// Sets the variables with which a command, or a cargo that it starts, builds for the system.
    pub fn set_variables(&self, command: &mut Command) {
        let System {
            triple,
            linker,
            runner,
            words,
            ..
        } = self.system;
        let name = triple.to_uppercase().replace('-', "_");
        command
            .env("CARGO_TARGET_DIR", root().join(target()).join("other"))
            .env(format!("CARGO_TARGET_{name}_LINKER"), linker.0)
            .env(
                format!("CARGO_TARGET_{name}_RUNNER"),
                format!("{} {words}", runner.0).trim(),
            )
            // Removes flags for the native build, such as a target-cpu, which do not apply to the target
            // system.
            .env_remove("RUSTFLAGS")
            .env_remove("CARGO_ENCODED_RUSTFLAGS");
        if self.sources.is_some() {
            command.envs(debian::ENVIRONMENT);
        }
        self.system.shield(command);
    }
}

/// Checks that the golden scenes and 20 rounds of bots give the same bits on another system.
pub fn check(system: &'static System, if_missing: IfMissing) -> Result<(), Failure> {
    let undone = format!("the golden scenes were NOT run on {}", system.name);
    let compiler = system.compiler(Wanted::Run, if_missing, &undone)?;
    if system.is_windows() {
        wine::prepare(system.linker.0)?;
    }
    execute(
        &mut compiler.cargo(&["test", "--release", "--package", "determinism_checks"]),
        "the result of a scene differs in its bits: look for arithmetic beyond + - * / and sqrt, and for SIMD lanes that are summed in another order",
    )?;
    let folder = root().join(target()).join("replays");
    let replays = folder.display().to_string();
    let example = "run --release --package determinism_checks --example replays --";
    let example: Vec<&str> = example.split(' ').collect();
    let mut record = cargo();
    record.args(&example).args(["record", &replays]);
    execute(&mut record, "the rounds of the bots could not be recorded")?;
    execute(
        &mut compiler.cargo(&[&example[..], &["verify", &replays]].concat()),
        "a round recorded here gives another result there",
    )?;
    match system.handed_out() {
        Some(game) => watch_all(system, &game, &folder),
        None => Ok(()),
    }
}

/// Verifies recorded rounds with the release build of the game. The replays lie in a folder whose name has
/// spaces and Japanese characters.
fn watch_all(system: &System, game: &Path, replays: &Path) -> Result<(), Failure> {
    let folder = replays.join("遊び 場");
    let copied = fs::create_dir_all(&folder).and_then(|()| {
        let copy = folder.join("玉入れ tamaire.exe");
        fs::copy(game, &copy).map(|_| copy)
    });
    let entries = fs::read_dir(replays);
    let (copied, entries) = copied
        .and_then(|copied| Ok((copied, entries?)))
        .map_err(|error| Failure::failed(format!("{}: {error}", game.display())))?;
    let files = entries.flatten().map(|entry| entry.path());
    let mut count = 0;
    for file in files.filter(|file| file.extension().is_some_and(|name| name == "tamaire")) {
        let mut watch = system.run(&copied);
        watch.args(["--headless", "--replay"]).arg(&file);
        execute(
            &mut watch,
            "the game reports an unchanged round as manipulated",
        )?;
        count += 1;
    }
    println!(
        "{}: the release build of the game verified {count} rounds",
        system.name
    );
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn program_arguments_follow_cargo_arguments() {
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
