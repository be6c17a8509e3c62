//! Yielding during long work in a browser, where such work shares one thread with the page.

use super::host;
use wasm_bindgen_futures::JsFuture;
use web_time::{Duration, Instant};

/// Longest time of uninterrupted work, after which the page gets a frame.
const LONGEST: Duration = Duration::from_millis(8);

/// Yields to the page from time to time.
pub struct Yielder(Instant);

impl Default for Yielder {
    fn default() -> Self {
        Self(Instant::now())
    }
}

impl Yielder {
    /// Waits for the next frame if the work has lasted longer than `LONGEST` since the previous wait.
    pub async fn yield_now(&mut self) {
        if self.0.elapsed() > LONGEST {
            // The promise is never rejected.
            let _ = JsFuture::from(host().breathe()).await;
            self.0 = Instant::now();
        }
    }
}
