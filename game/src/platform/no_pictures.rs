//! In a browser there are no photos and clips yet.

use super::storage::Kind;
use std::sync::Arc;
use tamaire_play::Replay;

/// Whether there are any.
pub const ARE_THERE: bool = false;

/// Makes none.
#[derive(Clone, Default)]
pub struct Pictures;

impl Pictures {
    /// None.
    pub fn shoot(&self, _: Kind, _: Arc<Replay>, _: &dyn Fn(f32)) -> Result<Vec<u8>, String> {
        Err("there are no pictures here".into())
    }
}
