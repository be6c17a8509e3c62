//! Yielding during long work on a desktop, where such work has its own thread.

/// Yields to other work. Does nothing on a desktop.
#[derive(Default)]
pub struct Breath(());

impl Breath {
    /// Returns at once.
    pub async fn take(&mut self) {}
}
