//! The program. A browser has no command line: it comes in through the library.

#[cfg(not(target_family = "wasm"))]
fn main() -> std::process::ExitCode {
    tamaire::desktop::main()
}

#[cfg(target_family = "wasm")]
fn main() {}
