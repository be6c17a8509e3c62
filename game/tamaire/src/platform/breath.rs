//! Yielding during long work on a desktop, where such work has its own thread.

/// Yields to other work. Does nothing on a desktop.
#[derive(Default)]
pub struct Yielder(());

impl Yielder {
    /// Returns at once, since other threads run anyway.
    pub async fn yield_now(&mut self) {}
}
