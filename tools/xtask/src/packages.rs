//! Debian packages that the tasks need, and their installation.

use crate::shell::{Failure, answers, execute, output_of};
use std::env;
use std::io::{self, IsTerminal, Write};
use std::process::{Command, Stdio};

/// Reaction to a missing Debian package.
#[derive(Debug, PartialEq, Clone, Copy)]
pub enum IfMissing {
    /// Print the name of the package and continue.
    Say,
    /// Install the package with apt-get, after confirmation if there is a terminal.
    Install,
}

/// Purpose for which a Debian package is needed.
#[derive(Debug, PartialEq, Clone, Copy)]
pub enum Purpose {
    /// Compile the game.
    Build,
    /// Open the window of the game.
    Window,
    /// Draw without a window, as tests do.
    Drawing,
    /// Compile the fuzzer.
    Fuzzing,
    /// Run the game in browsers.
    Browsing,
    /// Run a database server that a stand sends to, as tests do.
    Serving,
    /// Run the game as a stand on a virtual display.
    Staging,
    /// Build a Debian package.
    Packing,
    /// Build an archive for Windows or for a web server.
    Zipping,
    /// List the contents of programs and their licences.
    Listing,
    /// Build the web page.
    Paging,
    /// Build and test the Python package.
    Python,
}

/// Test for whether a package is installed.
#[derive(Debug, PartialEq, Clone, Copy)]
enum Seen {
    /// Passes if this program runs, whether or not it comes from the package.
    Program(&'static str),
    /// Passes if dpkg lists the package as installed.
    Installed,
    /// Passes if python3 finds this module, whether or not it comes from the package.
    Module(&'static str),
}

/// Package of Debian or Ubuntu that a task needs.
#[derive(Debug, PartialEq)]
struct Package {
    name: &'static str,
    seen: Seen,
    purposes: &'static [Purpose],
    /// Reason why the package is needed, for messages.
    why: &'static str,
}

const fn package(
    name: &'static str,
    seen: Seen,
    purposes: &'static [Purpose],
    why: &'static str,
) -> Package {
    Package {
        name,
        seen,
        purposes,
        why,
    }
}

/// All packages that the tasks need, determined by building and running in a minimal Debian root. The C
/// compiler is omitted, because this program could not have been linked without it.
#[rustfmt::skip]
const PACKAGES: &[Package] = {
    use Purpose::{Browsing, Build, Drawing, Fuzzing, Listing, Packing, Paging, Python, Serving, Staging, Window, Zipping};
    use Seen::{Installed, Module, Program};
    &[
        package("cmake", Program("cmake"), &[Build], "configures SDL, which reads sticks and pads"),
        package("make", Program("make"), &[Build], "builds SDL"),
        package("pkg-config", Program("pkg-config"), &[Build], "finds ALSA"),
        package("libasound2-dev", Installed, &[Build], "ALSA, for sound"),
        package("g++", Program("g++"), &[Fuzzing], "compiles libFuzzer"),
        package("chromium", Program("chromium"), &[Browsing], "runs the game"),
        package("firefox-esr", Program("firefox-esr"), &[Browsing], "runs the game"),
        package("xvfb", Installed, &[Browsing, Staging], "a virtual display: without a display, Firefox does not render in software"),
        package("xdotool", Program("xdotool"), &[Staging], "moves a mouse and presses keys"),
        package("xauth", Installed, &[Browsing], "opens the virtual display"),
        package("libegl1", Installed, &[Browsing], "OpenGL for Firefox"),
        package("libgl1-mesa-dri", Installed, &[Browsing], "OpenGL, also without a GPU"),
        package("postgresql", Installed, &[Serving], "a server for logbooks; tests start one of their own"),
        package("dpkg-dev", Program("dpkg-shlibdeps"), &[Packing], "finds the libraries of a program"),
        package("zip", Program("zip"), &[Zipping], "packs archives for Windows and for web servers"),
        package("nodejs", Program("node"), &[Listing, Paging], "packs the page, and collects licences"),
        package("npm", Program("npm"), &[Paging], "installs the tools that optimise the page"),
        package("python3", Program("python3"), &[Python], "runs the Python package"),
        package("python3-venv", Module("ensurepip"), &[Python], "makes environments to build and test in"),
        package("libx11-6", Installed, &[Window], "X11 windows"),
        package("libx11-xcb1", Installed, &[Window], "X11 windows"),
        package("libxcursor1", Installed, &[Window], "the mouse pointer in X11 windows"),
        package("libxi6", Installed, &[Window], "mouse and touch in X11 windows"),
        package("libxkbcommon-x11-0", Installed, &[Window], "keys in X11 windows"),
        package("mesa-vulkan-drivers", Installed, &[Window, Drawing], "Vulkan, also without a GPU"),
    ]
};

/// Missing item, and the Debian package that contains it.
#[derive(Debug, PartialEq)]
pub struct MissingItem {
    what: String,
    pub package: String,
}

impl MissingItem {
    pub fn new(what: impl Into<String>, package: impl Into<String>) -> MissingItem {
        MissingItem {
            what: what.into(),
            package: package.into(),
        }
    }
}

/// Formats the missing items, one per line.
pub fn list_lacks(lacks: &[MissingItem]) -> String {
    let lines: Vec<String> = lacks
        .iter()
        .map(|lack| format!("- {} (Debian: {})", lack.what, lack.package))
        .collect();
    lines.join("\n")
}

/// Installs the packages for these purposes as far as possible. Missing packages are only reported, because
/// the list may not fit every machine.
pub fn provide(purposes: &[Purpose], if_missing: IfMissing) {
    if !answers("dpkg-query") {
        return say_elsewhere(purposes);
    }
    let lacks = missing_on_debian(purposes);
    if lacks.is_empty() {
        return;
    }
    eprintln!("xtask: missing packages:\n{}", list(&lacks));
    let install = install_arguments(lacks.iter().map(|package| package.name));
    let line = format!(
        "{}apt-get {}",
        if is_root() { "" } else { "sudo " },
        install.join(" ")
    );
    if if_missing == IfMissing::Say || !agreed(&line) {
        eprintln!("xtask: continuing without them. To install: {line}");
        return;
    }
    apt_get(&["update", "--quiet"]);
    apt_get(&install);
    let lacks = missing_on_debian(purposes);
    if !lacks.is_empty() {
        eprintln!(
            "xtask: continuing, but these are still missing:\n{}",
            list(&lacks)
        );
    }
}

/// Names of the missing packages for these purposes; empty without dpkg.
pub fn lacking(purposes: &[Purpose]) -> Vec<&'static str> {
    match answers("dpkg-query") {
        true => {
            let lacks = missing_on_debian(purposes);
            lacks.iter().map(|package| package.name).collect()
        }
        false => Vec::new(),
    }
}

/// Returns arguments with which `apt-get` installs these packages without removing others.
pub fn install_arguments<'a>(names: impl Iterator<Item = &'a str>) -> Vec<&'a str> {
    let options = ["install", "--quiet", "--yes", "--no-remove"];
    let options = options.into_iter().chain(["--no-install-recommends"]);
    options.chain(names).collect()
}

/// Runs apt-get as root or through sudo; returns whether it succeeded.
pub fn apt_get(arguments: &[&str]) -> bool {
    let mut command = if is_root() {
        Command::new("apt-get")
    } else {
        let mut sudo = Command::new("sudo");
        if !io::stdin().is_terminal() {
            // Keeps sudo from asking for a password, because there is no terminal.
            sudo.arg("--non-interactive");
        }
        sudo.arg("apt-get");
        sudo
    };
    command.args(arguments);
    command.env("DEBIAN_FRONTEND", "noninteractive");
    let outcome = execute(
        &mut command,
        "this requires Debian or Ubuntu, root or sudo, and a network",
    );
    if let Err(Failure { message, .. }) = &outcome {
        eprintln!("xtask: {message}");
    }
    outcome.is_ok()
}

/// Returns the packages for these purposes that `is_there` rejects.
fn missing(purposes: &[Purpose], is_there: impl Fn(&Package) -> bool) -> Vec<&'static Package> {
    let needed = |package: &&Package| package.purposes.iter().any(|it| purposes.contains(it));
    let lacks = PACKAGES.iter().filter(needed);
    lacks.filter(|package| !is_there(package)).collect()
}

fn missing_on_debian(purposes: &[Purpose]) -> Vec<&'static Package> {
    let statuses = Command::new("dpkg-query")
        .args(["--show", "--showformat=${Package} ${db:Status-Status}\\n"])
        .args(PACKAGES.iter().map(|package| package.name))
        // Hides the complaints of dpkg-query, one for each unknown package.
        .stderr(Stdio::null())
        .output()
        .map_or_else(|_| Vec::new(), |output| output.stdout);
    let statuses = String::from_utf8_lossy(&statuses);
    missing(purposes, |package| match package.seen {
        Seen::Program(program) => answers(program),
        Seen::Installed => is_installed(&statuses, package.name),
        Seen::Module(module) => imports(module),
    })
}

/// Whether python3 can import a module.
fn imports(module: &str) -> bool {
    output_of("python3", &["-c", &format!("import {module}")]).is_some()
}

/// Whether a package is installed. `statuses` are lines of name and status from dpkg-query.
fn is_installed(statuses: &str, name: &str) -> bool {
    // Requires at least one line with the name: a package installed for two architectures has two.
    let mut lines = statuses.lines().filter_map(|line| line.split_once(' '));
    lines.any(|line| line == (name, "installed"))
}

/// Lists required packages on systems without apt. Programs are listed only if missing. Libraries are always
/// listed on other Linux systems, which name them differently. On macOS and Windows only cmake is listed,
/// because these systems contain the libraries.
fn say_elsewhere(purposes: &[Purpose]) {
    let lacks = missing(purposes, |package| match package.seen {
        Seen::Program(program) => answers(program),
        Seen::Installed => false,
        Seen::Module(module) => imports(module),
    });
    let of_this_system = |package: &&&Package| cfg!(target_os = "linux") || package.name == "cmake";
    let names: Vec<&str> = lacks
        .iter()
        .filter(of_this_system)
        .map(|package| package.name)
        .collect();
    if !names.is_empty() {
        eprintln!(
            "xtask: this task needs (names of Debian's packages): {}",
            names.join(", ")
        );
    }
}

fn list(packages: &[&Package]) -> String {
    let line = |package: &&Package| format!("- {}: {}", package.name, package.why);
    let lines: Vec<String> = packages.iter().map(line).collect();
    lines.join("\n")
}

/// Asks whether to run the command; without a terminal the answer is yes.
fn agreed(line: &str) -> bool {
    if !io::stdin().is_terminal() || !io::stderr().is_terminal() {
        return true;
    }
    eprint!("xtask: run `{line}`? [Y/n] ");
    let mut answer = String::new();
    let heard = io::stderr()
        .flush()
        .and_then(|()| io::stdin().read_line(&mut answer));
    // An answer of zero bytes, without even an end of line, counts as no: the terminal was closed.
    heard.is_ok_and(|bytes| bytes > 0) && is_yes(&answer)
}

fn is_yes(answer: &str) -> bool {
    matches!(
        answer.trim().to_ascii_lowercase().as_str(),
        "" | "y" | "yes"
    )
}

fn is_root() -> bool {
    let id = Command::new("id").arg("-u").output();
    id.is_ok_and(|output| output.stdout.trim_ascii() == b"0")
}

/// Whether a window can be opened.
pub fn has_display() -> bool {
    let named = |name| env::var_os(name).is_some_and(|value| !value.is_empty());
    named("DISPLAY") || named("WAYLAND_DISPLAY")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(purposes: &[Purpose], there: &[&str], expect: &[&str]) {
        let lacks = missing(purposes, |package| there.contains(&package.name));
        let names: Vec<&str> = lacks.iter().map(|package| package.name).collect();
        assert_eq!(names, expect, "{purposes:?} with {there:?}");
    }

    #[test]
    fn missing_lists_needed_packages_that_are_absent() {
        let build = ["cmake", "make", "pkg-config", "libasound2-dev"];
        check(&[Purpose::Build], &[], &build);
        check(&[Purpose::Build], &build, &[]);
        check(&[Purpose::Build], &["cmake", "make"], &build[2..]);
        check(&[Purpose::Drawing], &[], &["mesa-vulkan-drivers"]);
        check(&[Purpose::Serving], &[], &["postgresql"]);
        check(
            &[Purpose::Packing, Purpose::Zipping],
            &["zip"],
            &["dpkg-dev"],
        );
        check(&[Purpose::Listing], &[], &["nodejs"]);
        check(&[], &[], &[]);
        // The package is listed once, although it has both purposes.
        let window = missing(&[Purpose::Window, Purpose::Drawing], |_| false);
        let mesa = window
            .iter()
            .filter(|package| package.name.starts_with("mesa"));
        assert_eq!(mesa.count(), 1);
    }

    #[test]
    fn is_installed_requires_status_installed() {
        let statuses = "make installed\nlibxi6 config-files\nlibx11-6 not-installed\n\
                        libx11-6 installed\nlibx11-6-data installed\n";
        for (name, expect) in [
            ("make", true),
            ("libxi6", false),
            ("libx11-6", true),
            ("libx11", false),
            ("cmake", false),
        ] {
            assert_eq!(is_installed(statuses, name), expect, "{name}");
        }
        assert!(!is_installed("", "make"));
    }

    #[test]
    fn is_yes_accepts_yes_and_empty_line() {
        for answer in ["\n", "y\n", "Y\n", "yes\r\n"] {
            assert!(is_yes(answer), "{answer:?}");
        }
        for answer in ["n\n", "no\n", "what?\n"] {
            assert!(!is_yes(answer), "{answer:?}");
        }
    }

    #[test]
    fn install_arguments_forbid_removal() {
        let arguments = install_arguments(["make"].into_iter());
        assert!(arguments.contains(&"--no-remove"), "{arguments:?}");
        assert_eq!(arguments.last(), Some(&"make"));
    }
}
