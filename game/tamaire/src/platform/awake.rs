//! Keeps the screen on.

/// Disables the screen saver and power saving of an X server. Does nothing without an X server.
///
/// # Errors
/// The reason why the request could not be sent.
#[cfg(all(unix, not(target_os = "macos")))]
pub fn keep_awake() -> Result<(), String> {
    use x11rb::connection::{Connection, RequestConnection};
    use x11rb::protocol::dpms;
    use x11rb::protocol::xproto::{Blanking, ConnectionExt, Exposures};
    if std::env::var_os("DISPLAY").is_none() {
        return Ok(());
    }
    let why = |error: &dyn std::error::Error| format!("the screen may go dark: {error}");
    let (server, _) = x11rb::connect(None).map_err(|error| why(&error))?;
    let quiet = server.set_screen_saver(0, 0, Blanking::NOT_PREFERRED, Exposures::NOT_ALLOWED);
    quiet.map_err(|error| why(&error))?;
    // Only a server with the DPMS extension switches the screen off to save power.
    if server
        .extension_information(dpms::X11_EXTENSION_NAME)
        .is_ok_and(|found| found.is_some())
    {
        dpms::disable(&server).map_err(|error| why(&error))?;
    }
    server.flush().map_err(|error| why(&error))
}

/// Does nothing: on this platform the screen is configured in the system settings.
#[cfg(not(all(unix, not(target_os = "macos"))))]
pub fn keep_awake() -> Result<(), String> {
    Ok(())
}
