//! Where long work and the page have one thread.

use super::host;
use wasm_bindgen_futures::JsFuture;
use web_time::{Duration, Instant};

/// So long may work go on before the page is drawn again.
const LONGEST: Duration = Duration::from_millis(8);

/// Lets the page go on, now and then.
pub struct Breath(Instant);

impl Default for Breath {
    fn default() -> Self {
        Self(Instant::now())
    }
}

impl Breath {
    /// Waits for the next frame if the last one was long ago.
    pub async fn take(&mut self) {
        if self.0.elapsed() > LONGEST {
            // The page never refuses.
            let _ = JsFuture::from(host().breathe()).await;
            self.0 = Instant::now();
        }
    }
}
