//! The files of a scene, taken into it so that it can travel alone: whole where they are small, else what its bodies need
//! of them.

use super::body::BodyText;
use super::error::Wrong;
use super::grid::{check_across, colours};
use crate::import::{Model, Picture};
use fuwafuwa::grid::MAX_EXTENT;
use std::path::Path;

/// A file of so many bytes travels as it is. A photo has a hundred times as many, and its body needs as few.
const SMALL: usize = 1 << 16;

impl BodyText {
    pub(super) fn embed_file(&mut self, known: &[(&str, &[u8])]) -> Result<(), Wrong> {
        let Some(file) = self.file.clone() else {
            return Ok(());
        };
        if let Some((_, bytes)) = known.iter().find(|(name, _)| Path::new(name) == file) {
            self.embed(bytes);
        } else if self.content.is_none() {
            let bytes = self.file_bytes(&file)?;
            // What is wrong with it is told when the body is built.
            let less = (bytes.len() > SMALL).then(|| self.needed_of(&file, &bytes));
            self.embed(&less.flatten().unwrap_or(bytes));
        }
        Ok(())
    }

    /// A file from which the same voxels come as from this one.
    fn needed_of(&self, file: &Path, bytes: &[u8]) -> Option<Vec<u8>> {
        let name = file.to_string_lossy();
        let ending = file.extension()?.to_str()?.to_ascii_lowercase();
        match ending.as_str() {
            "png" => {
                let across = self.n.unwrap_or(MAX_EXTENT);
                check_across(across).ok()?;
                let picture = Picture::decode(&name, bytes).ok()?;
                picture.needed(across, &colours(self).ok()?)
            }
            "vox" => Some(Model::decode(&name, bytes).ok()?.bytes()),
            _ => None,
        }
    }
}
