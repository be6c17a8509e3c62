//! Files embedded in a scene, so that it is self-contained: small pictures whole, large ones and models
//! reduced to the voxels of their bodies.

use super::body::{BodyText, extension_of};
use super::budget::Budget;
use super::error::FieldError;
use super::grid::{check_across, colours};
use crate::import::{FilePosition, ImportError, ImportNote, Model, Picture, Problem};
use fuwafuwa::MAX_EXTENT;
use std::io;

/// Maximum size of a picture that is embedded whole [bytes]. Larger files, such as photos, are reduced to the
/// voxels of their bodies.
const SMALL: usize = 1 << 16;

/// Function that reads a picture or a model named in a scene. It decides where files are searched.
pub type Fetch<'a> = &'a dyn Fn(&str) -> io::Result<Vec<u8>>;

impl BodyText {
    /// Embeds the file of the body. Returns notes on what was left out of the file or may surprise.
    pub(super) fn embed_file(
        &mut self,
        fetch: Fetch,
        budget: &mut Budget,
    ) -> Result<Vec<ImportNote>, FieldError> {
        let Some(file) = self.file.clone().filter(|_| self.content.is_none()) else {
            return Ok(Vec::new());
        };
        let bytes = fetch(&file).map_err(|error| {
            FieldError::file(ImportError {
                file: file.clone(),
                position: FilePosition::File,
                problem: Problem::Unreadable(error),
            })
        })?;
        if extension_of(&file) == "vox" {
            return self.embed_model(&file, &bytes, budget);
        }
        // An invalid file is embedded whole, and its error is reported when the body is built.
        let less = match bytes.len() > SMALL {
            true => self.reduced_picture(&file, &bytes, budget)?,
            false => None,
        };
        self.embed(&less.unwrap_or(bytes));
        Ok(Vec::new())
    }

    /// Embeds the visible models of a file, or the part of it that the body is made from. A file that is no
    /// longer than these models is embedded whole, as is an invalid file, whose error is reported when the
    /// body is built.
    fn embed_model(
        &mut self,
        file: &str,
        bytes: &[u8],
        budget: &mut Budget,
    ) -> Result<Vec<ImportNote>, FieldError> {
        let Ok(model) = Model::decode_part(file, bytes, self.model.as_deref()) else {
            self.embed(bytes);
            return Ok(Vec::new());
        };
        budget.take_model(model.work())?;
        let less = model.bytes();
        if self.model.take().is_some() || less.len() < bytes.len() {
            self.embed(&less);
        } else {
            self.embed(bytes);
        }
        // Wrong colours are reported when the body is built.
        let import = colours(self).map(|colours| model.import(1.0, &colours));
        Ok(import
            .ok()
            .and_then(Result::ok)
            .map_or_else(Vec::new, |import| import.notes))
    }

    /// Returns a smaller picture that gives the same voxels; `None` if the file is invalid.
    fn reduced_picture(
        &self,
        file: &str,
        bytes: &[u8],
        budget: &mut Budget,
    ) -> Result<Option<Vec<u8>>, FieldError> {
        if extension_of(file) != "png" {
            return Ok(None);
        }
        budget.take_pixels(bytes.len(), 1)?;
        let across = self.n.unwrap_or(MAX_EXTENT);
        let known = check_across(across).and_then(|()| colours(self));
        let picture = Picture::decode(file, bytes);
        let (Ok(colours), Ok(picture)) = (known, picture) else {
            return Ok(None);
        };
        budget.take_pixels(picture.size().iter().product(), colours.named.len())?;
        Ok(picture.reduced_png(across, &colours))
    }
}
