//! Web version of the game: a folder of files for any web server.
//!
//! cargo compiles the game and its sound for wasm32. `xtask_bindgen` generates the bindings between the game
//! and the page (`game/tamaire/web`), and `tools/xtask/web/pack.mjs` packs the folder.

use crate::packages::{self, IfMissing, Purpose};
use crate::shell::{Failure, cargo, execute, is_on_path, root, target};
use crate::wasm::{self, Compiler, TARGET};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Task for the web version.
#[derive(Debug, PartialEq)]
pub enum Web {
    /// Builds the web version. Previews of the page refer to the address, if one is given.
    Build(Option<String>),
    /// Builds the web version and serves it on this machine.
    Serve,
    /// Builds the web version and tests it in browsers.
    Test,
}

/// Builds the web version, and serves or tests it.
pub fn run(web: Web, if_missing: IfMissing) -> Result<(), Failure> {
    if web == Web::Test {
        provide_browsers(if_missing)?;
    }
    let compiler = wasm::compiler(if_missing, "the game was NOT built for a browser")?;
    let address = match &web {
        Web::Build(address) => address.as_deref(),
        Web::Serve | Web::Test => None,
    };
    build(&compiler, address)?;
    let site = folder().join("site");
    match web {
        Web::Build(_) => Ok(()),
        Web::Serve => node("serve.mjs", &[&site], "the server failed"),
        Web::Test => {
            let checks = wasm::compile_checks(&compiler)?;
            // Starts a virtual display, because Firefox renders in software only if there is a display.
            let mut play = Command::new("xvfb-run");
            play.args(["--auto-servernum", "node", "tools/xtask/web/test/all.mjs"])
                .args([&site, &checks]);
            execute(&mut play, "a test in a browser failed, see above")
        }
    }
}

/// Folder of the intermediate files (`stage`) and of the packed page (`site`).
pub fn folder() -> PathBuf {
    root().join(target()).join("web")
}

fn build(compiler: &Compiler, address: Option<&str>) -> Result<(), Failure> {
    let stage = folder().join("stage");
    let game = wasm::compile(compiler, &["tamaire", "--bin", "tamaire"])?;
    let sound = "tamaire_sound --features worklet --crate-type cdylib";
    let sound = wasm::compile(compiler, &sound.split(' ').collect::<Vec<_>>())?;
    let mut bind = cargo();
    bind.args(["run", "--package", "xtask_bindgen", "--"])
        .args([&game, &stage]);
    execute(
        &mut bind,
        "the bindings between the game and the page could not be generated",
    )?;
    let licences = folder().join("licences.txt");
    fs::copy(sound, stage.join("sound.wasm"))
        .map_err(|error| Failure::failed(format!("{}: {error}", folder().display())))?;
    provide_node_modules()?;
    node(
        "licences.mjs",
        &[&licences, Path::new(TARGET), Path::new("tamaire")],
        "the licences could not be collected",
    )?;
    let (page, site) = (root().join("game/tamaire/web"), folder().join("site"));
    let mut words: Vec<&Path> = vec![&stage, &page, &licences, &site];
    words.extend(address.map(Path::new));
    node("pack.mjs", &words, "the folder could not be packed")
}

/// Installs the npm packages of the lock file, unless they are up to date.
fn provide_node_modules() -> Result<(), Failure> {
    let here = root().join("tools/xtask/web");
    let stamp = |path: &str| {
        fs::metadata(here.join(path))
            .and_then(|data| data.modified())
            .ok()
    };
    if stamp("node_modules/.package-lock.json") > stamp("package-lock.json") {
        return Ok(());
    }
    let mut install = Command::new("npm");
    install
        .args(["ci", "--no-audit", "--no-fund", "--prefix"])
        .arg(&here);
    execute(
        &mut install,
        "npm could not install the tools that pack the page",
    )
}

fn node(script: &str, words: &[&Path], hint: &str) -> Result<(), Failure> {
    let script = Path::new("tools/xtask/web").join(script);
    execute(Command::new("node").arg(script).args(words), hint)
}

/// Installs browsers and a virtual display if allowed. Fails if one is missing afterwards.
fn provide_browsers(if_missing: IfMissing) -> Result<(), Failure> {
    packages::provide(&[Purpose::Browsing], if_missing);
    let programs = ["chromium", "firefox-esr", "xvfb-run"];
    let missing: Vec<&str> = programs
        .into_iter()
        .filter(|program| !is_on_path(program))
        .collect();
    match missing[..] {
        [] => Ok(()),
        _ => Err(Failure::cannot(format!(
            "the game was NOT tested in browsers: {} not found on the path",
            missing.join(", ")
        ))),
    }
}
