use super::Extent;
use crate::report::{Findings, Progress};
use anyhow::Result;
pub fn check(_: &Progress, _: Extent) -> Result<Findings> { Ok(Findings::default()) }
