//! Where the latest snapshot is left, and why there may never be one.

use std::sync::{Arc, Mutex, PoisonError};

use crate::Snapshot;

/// Why no device can be read. The game goes on without.
#[derive(Debug, thiserror::Error)]
pub enum NoSticks {
    #[error("sticks and pads are being read already: a process can open them only once at a time")]
    AlreadyOpen,
    #[error("SDL cannot read sticks and pads: {0}")]
    Sdl(String),
    #[error("no thread could be started to read sticks and pads: {0}")]
    Thread(#[from] std::io::Error),
}

/// Where the owner leaves the latest snapshot. The lock is held only to exchange a pointer.
#[derive(Clone, Default)]
pub struct Latest(Arc<Mutex<Arc<Snapshot>>>);

impl Latest {
    pub fn get(&self) -> Arc<Snapshot> {
        self.0
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .clone()
    }

    #[cfg(any(feature = "sdl", target_family = "wasm"))]
    pub fn set(&self, snapshot: Snapshot) {
        *self.0.lock().unwrap_or_else(PoisonError::into_inner) = Arc::new(snapshot);
    }
}
