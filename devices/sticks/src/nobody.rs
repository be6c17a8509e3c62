//! `owner` for builds without SDL: finds no device.

use crate::latest::{Latest, NoSticks};

pub struct Owner;

impl Owner {
    pub fn start(_latest: Latest) -> Result<Owner, NoSticks> {
        Ok(Owner)
    }
}
