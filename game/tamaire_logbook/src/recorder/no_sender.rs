//! Stand-in for the sender in builds without the feature `postgres`.

use crate::Server;
use crate::server::Progress;
use std::path::Path;

#[derive(Debug)]
pub struct Sender {
    trouble: Option<String>,
}

impl Sender {
    pub fn begin(_: &Path, _: &str, server: &Server) -> Self {
        let trouble = server.name().err();
        Self { trouble }
    }

    pub fn progress(&self) -> Progress {
        let trouble = self.trouble.clone();
        Progress { unsent: 0, trouble }
    }
}
