//! Latest snapshot of the devices, and errors of opening them.

use std::sync::{Arc, Mutex, PoisonError};

use crate::Snapshot;

/// Error of opening the sticks. The game can continue without devices.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    #[error("sticks and pads are already open: a process can open them only once at a time")]
    AlreadyOpen,
    #[error("SDL cannot read sticks and pads: {0}")]
    Sdl(String),
    #[error("cannot start the thread that reads sticks and pads: {0}")]
    Thread(#[from] std::io::Error),
}

/// Latest snapshot, published by the owner. The lock is held only to exchange a pointer.
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
