//! Files embedded in a scene, so that it is self-contained: small files whole, large ones reduced to the
//! voxels of their bodies.

use super::body::{BodyText, extension_of};
use super::budget::Budget;
use super::error::FieldError;
use super::grid::{check_across, colours};
use crate::import::{FilePosition, ImportError, Model, Picture, Problem};
use fuwafuwa::MAX_EXTENT;
use std::io;

/// Maximum size of a file that is embedded whole [bytes]. Larger files, such as photos, are reduced to the
/// voxels of their bodies.
const SMALL: usize = 1 << 16;

/// Function that reads a picture or a model named in a scene. It decides where files are searched.
pub type Fetch<'a> = &'a dyn Fn(&str) -> io::Result<Vec<u8>>;

impl BodyText {
    pub(super) fn embed_file(
        &mut self,
        fetch: Fetch,
        budget: &mut Budget,
    ) -> Result<(), FieldError> {
        let Some(file) = self.file.clone().filter(|_| self.content.is_none()) else {
            return Ok(());
        };
        let bytes = fetch(&file).map_err(|error| {
            FieldError::file(ImportError {
                file: file.clone(),
                position: FilePosition::File,
                problem: Problem::Unreadable(error),
            })
        })?;
        // An invalid file is embedded whole, and its error is reported when the body is built.
        let less = match bytes.len() > SMALL {
            true => self.reduced_file(&file, &bytes, budget)?,
            false => None,
        };
        self.embed(&less.unwrap_or(bytes));
        Ok(())
    }

    /// Returns a smaller file that gives the same voxels; `None` if the file is invalid.
    fn reduced_file(
        &self,
        file: &str,
        bytes: &[u8],
        budget: &mut Budget,
    ) -> Result<Option<Vec<u8>>, FieldError> {
        budget.take_pixels(bytes.len(), 1)?;
        Ok(match extension_of(file).as_str() {
            "png" => {
                let across = self.n.unwrap_or(MAX_EXTENT);
                let known = check_across(across).and_then(|()| colours(self));
                let picture = Picture::decode(file, bytes);
                let (Ok(colours), Ok(picture)) = (known, picture) else {
                    return Ok(None);
                };
                budget.take_pixels(picture.size().iter().product(), colours.named.len())?;
                picture.reduced_png(across, &colours)
            }
            "vox" => Model::decode(file, bytes).ok().map(|model| model.bytes()),
            _ => None,
        })
    }
}
