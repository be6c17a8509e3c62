//! The program that fuzzes the doors. Only a build with `--cfg fuzzing`, as `cargo xtask fuzz` makes it,
//! contains libFuzzer.
#![cfg_attr(fuzzing, no_main)]

#[cfg(fuzzing)]
mod libfuzzer;

#[cfg(not(fuzzing))]
fn main() {
    eprintln!("fuzz: built without libFuzzer; run `cargo xtask fuzz` instead");
    std::process::exit(2);
}
