//! The files of a scene, taken into it so that it can travel alone: whole where they are small, else what its bodies need
//! of them.

use super::body::{BodyText, ending_of};
use super::budget::Budget;
use super::error::Wrong;
use super::grid::{check_across, colours};
use crate::import::{ImportError, Model, Picture, Place, Problem};
use fuwafuwa::grid::MAX_EXTENT;
use std::io;

/// A file of so many bytes travels as it is. A photo has a hundred times as many, and its body needs as few.
const SMALL: usize = 1 << 16;

/// Hands out the bytes of a picture or a model that a scene names. Only who opens a scene knows where those lie.
pub type Fetch<'a> = &'a dyn Fn(&str) -> io::Result<Vec<u8>>;

impl BodyText {
    pub(super) fn embed_file(&mut self, fetch: Fetch, budget: &mut Budget) -> Result<(), Wrong> {
        let Some(file) = self.file.clone().filter(|_| self.content.is_none()) else {
            return Ok(());
        };
        let bytes = fetch(&file).map_err(|error| {
            Wrong::file(ImportError {
                file: file.clone(),
                place: Place::File,
                problem: Problem::Unreadable(error),
            })
        })?;
        // What is wrong with it is told when the body is built.
        let less = match bytes.len() > SMALL {
            true => self.needed_of(&file, &bytes, budget)?,
            false => None,
        };
        self.embed(&less.unwrap_or(bytes));
        Ok(())
    }

    /// A file from which the same voxels come as from this one.
    fn needed_of(
        &self,
        file: &str,
        bytes: &[u8],
        budget: &mut Budget,
    ) -> Result<Option<Vec<u8>>, Wrong> {
        budget.take_pixels(bytes.len(), 1)?;
        Ok(match ending_of(file).as_str() {
            "png" => {
                let across = self.n.unwrap_or(MAX_EXTENT);
                let known = check_across(across).and_then(|()| colours(self));
                let picture = Picture::decode(file, bytes);
                let (Ok(colours), Ok(picture)) = (known, picture) else {
                    return Ok(None);
                };
                budget.take_pixels(picture.size().iter().product(), colours.named.len())?;
                picture.needed(across, &colours)
            }
            "vox" => Model::decode(file, bytes).ok().map(|model| model.bytes()),
            _ => None,
        })
    }
}
