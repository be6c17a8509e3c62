//! Yielding during long work in a browser, where such work shares one thread with the page.

use super::host;
use wasm_bindgen_futures::JsFuture;
use web_time::{Duration, Instant};

/// Longest work before the page gets a frame.
const LONGEST: Duration = Duration::from_millis(8);

/// Yields to the page from time to time.
pub struct Breath(Instant);

impl Default for Breath {
    fn default() -> Self {
        Self(Instant::now())
    }
}

impl Breath {
    /// Waits for the next frame if the last one was longer than `LONGEST` ago.
    pub async fn take(&mut self) {
        if self.0.elapsed() > LONGEST {
            // The promise is never rejected.
            let _ = JsFuture::from(host().breathe()).await;
            self.0 = Instant::now();
        }
    }
}
