//! Where long work has a thread of its own.

/// Lets others go on.
#[derive(Default)]
pub struct Breath(());

impl Breath {
    /// They do anyway.
    pub async fn take(&mut self) {}
}
