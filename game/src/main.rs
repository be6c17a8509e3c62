//! The program. A browser has no command line: the page comes in through [`tamaire::browser`].

#[cfg(not(target_family = "wasm"))]
fn main() -> std::process::ExitCode {
    tamaire::desktop::main()
}

#[cfg(target_family = "wasm")]
fn main() {
    // What the page calls is linked in with this.
    let _ = tamaire::browser::Running::start;
}
