//! Entry point of the desktop program. In a browser the page calls [`tamaire::browser`] instead, because
//! there is no command line.

// Keeps Windows from opening a console window beside the game.
#![cfg_attr(all(windows, not(debug_assertions)), windows_subsystem = "windows")]

#[cfg(not(target_family = "wasm"))]
fn main() -> std::process::ExitCode {
    #[cfg(all(windows, not(debug_assertions)))]
    console::attach();
    tamaire::desktop::main()
}

#[cfg(target_family = "wasm")]
fn main() {
    // This reference keeps the linker from removing the functions that the web page calls.
    let _ = tamaire::browser::Running::start;
}

/// Output to the console of the parent process on Windows, if the program was started from one.
#[cfg(all(windows, not(debug_assertions)))]
mod console {
    /// `ATTACH_PARENT_PROCESS`: the console of the parent process.
    const PARENT: u32 = u32::MAX;

    #[link(name = "kernel32")]
    unsafe extern "system" {
        // Safe: the only argument is a number, and the call fails without effect if the parent has no
        // console.
        safe fn AttachConsole(process: u32) -> i32;
    }

    pub fn attach() {
        // The call fails if there is no console. Output is then discarded.
        let _attached = AttachConsole(PARENT);
    }
}
