//! The files of a scene, taken into it so that it can travel alone: whole where they are small, else what its bodies need
//! of them.

use super::body::BodyText;
use super::budget::Budget;
use super::error::Wrong;
use super::grid::{check_across, colours};
use crate::import::{Model, Picture};
use fuwafuwa::grid::MAX_EXTENT;
use std::path::Path;

/// A file of so many bytes travels as it is. A photo has a hundred times as many, and its body needs as few.
const SMALL: usize = 1 << 16;

impl BodyText {
    pub(super) fn embed_file(
        &mut self,
        known: &[(&str, &[u8])],
        budget: &mut Budget,
    ) -> Result<(), Wrong> {
        let Some(file) = self.file.clone() else {
            return Ok(());
        };
        if let Some((_, bytes)) = known.iter().find(|(name, _)| Path::new(name) == file) {
            self.embed(bytes);
        } else if self.content.is_none() {
            let bytes = self.file_bytes(&file)?;
            // What is wrong with it is told when the body is built.
            let less = match bytes.len() > SMALL {
                true => self.needed_of(&file, &bytes, budget)?,
                false => None,
            };
            self.embed(&less.unwrap_or(bytes));
        }
        Ok(())
    }

    /// A file from which the same voxels come as from this one.
    fn needed_of(
        &self,
        file: &Path,
        bytes: &[u8],
        budget: &mut Budget,
    ) -> Result<Option<Vec<u8>>, Wrong> {
        let name = file.to_string_lossy();
        let ending = file.extension().unwrap_or_default().to_ascii_lowercase();
        budget.take_pixels(bytes.len(), 1)?;
        Ok(match ending.to_str() {
            Some("png") => {
                let across = self.n.unwrap_or(MAX_EXTENT);
                let known = check_across(across).and_then(|()| colours(self));
                let picture = Picture::decode(&name, bytes);
                let (Ok(colours), Ok(picture)) = (known, picture) else {
                    return Ok(None);
                };
                budget.take_pixels(picture.size().iter().product(), colours.named.len())?;
                picture.needed(across, &colours)
            }
            Some("vox") => Model::decode(&name, bytes).ok().map(|model| model.bytes()),
            _ => None,
        })
    }
}
