//! The program. A browser has no command line: the page comes in through [`tamaire::browser`].

// Who clicks on it sees the game, and no console beside it.
#![cfg_attr(all(windows, not(debug_assertions)), windows_subsystem = "windows")]

#[cfg(not(target_family = "wasm"))]
fn main() -> std::process::ExitCode {
    #[cfg(all(windows, not(debug_assertions)))]
    console::attach();
    tamaire::desktop::main()
}

#[cfg(target_family = "wasm")]
fn main() {
    // What the page calls is linked in with this.
    let _ = tamaire::browser::Running::start;
}

/// Where the program was typed into a console, it answers there.
#[cfg(all(windows, not(debug_assertions)))]
mod console {
    /// Whoever started this program.
    const PARENT: u32 = u32::MAX;

    #[link(name = "kernel32")]
    unsafe extern "system" {
        // It takes a number, and does nothing where there is no console.
        safe fn AttachConsole(process: u32) -> i32;
    }

    pub fn attach() {
        // Without a console nobody is there to read.
        let _attached = AttachConsole(PARENT);
    }
}
