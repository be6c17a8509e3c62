//! Generates the bindings between the game and its page, as wasm-bindgen's program does with `--target web`.
//!
//! A separate program, so that other tasks need not compile its dependencies.

use std::env;
use std::path::PathBuf;
use std::process::ExitCode;
use wasm_bindgen_cli_support::Bindgen;

fn main() -> ExitCode {
    let words: Vec<PathBuf> = env::args_os().skip(1).map(PathBuf::from).collect();
    let [module, folder] = &words[..] else {
        eprintln!("usage: xtask_bindgen MODULE.wasm FOLDER");
        return ExitCode::from(2);
    };
    let mut bindgen = Bindgen::new();
    let made = bindgen
        .input_path(module)
        // A fifth of the module, used by debuggers only.
        .remove_name_section(true)
        .remove_producers_section(true)
        .typescript(false)
        .web(true)
        .and_then(|bindgen| bindgen.generate(folder));
    match made {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("xtask_bindgen: {}: {error:#}", module.display());
            ExitCode::FAILURE
        }
    }
}
