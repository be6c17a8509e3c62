//! Files embedded in a scene, so that it is self-contained. A picture is embedded as the voxels of its body,
//! so later changes of the rules for pictures do not change the scene.

use super::body::BodyText;
use super::budget::Budget;
use super::error::FieldError;
use super::grid::{check_across, colours, wrong_type};
use crate::import::{
    FilePosition, FileType, ImportError, ImportNote, Model, Picture, PictureOptions, Problem,
    png_of,
};
use fuwafuwa::MAX_EXTENT;
use std::io;

/// Maximum size of a file that is embedded whole, if its body allows that [bytes]. Larger files are reduced to
/// the voxels of their bodies.
const SMALL: usize = 1 << 16;

/// Function that reads a picture or a model named in a scene. It decides where files are searched.
pub type Fetch<'a> = &'a dyn Fn(&str) -> io::Result<Vec<u8>>;

impl BodyText {
    /// Embeds the file of the body in a scene of `dim` dimensions. Returns the notes of its import.
    pub(super) fn embed_file(
        &mut self,
        dim: u8,
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
        budget.take_pixels(bytes.len(), 1)?;
        let found = FileType::of(&bytes);
        let (content, notes) = match dim {
            2 if found.is_readable_picture() => self.voxels_of_picture(&file, bytes, budget)?,
            3 if found == FileType::Vox => (reduced_model(&file, bytes), Vec::new()),
            _ => return Err(wrong_type(&file, found, dim.into())),
        };
        self.embed(&content);
        Ok(notes)
    }

    /// Returns a PNG file with one pixel per voxel of the body, and the notes of the import. Takes the fields
    /// that only the import needs. A small PNG file whose pixels count as they are is returned whole.
    fn voxels_of_picture(
        &mut self,
        file: &str,
        bytes: Vec<u8>,
        budget: &mut Budget,
    ) -> Result<(Vec<u8>, Vec<ImportNote>), FieldError> {
        let across = self.n.unwrap_or(MAX_EXTENT);
        check_across(across)?;
        let colours = colours(self)?;
        let picture = Picture::decode(file, &bytes).map_err(FieldError::file)?;
        budget.take_pixels(picture.size().iter().product(), colours.named.len())?;
        let fill = self.fill.take().unwrap_or(true);
        let (grid, notes) = match self.plain.take() {
            Some(true) if bytes.len() <= SMALL && FileType::of(&bytes) == FileType::Png => {
                return Ok((bytes, Vec::new()));
            }
            Some(true) => (picture.grid(across, 1.0, &colours), Vec::new()),
            _ => {
                let options = PictureOptions {
                    across,
                    voxel_size: 1.0,
                    colours: colours.clone(),
                    fill,
                };
                let import = picture.import(&options).map_err(FieldError::file)?;
                (Ok(import.grid), import.notes)
            }
        };
        let grid = grid.map_err(FieldError::file)?;
        let reduced = png_of(&grid, &colours);
        let unexpected = || FieldError::new("file", "expected a colour for each material");
        Ok((reduced.ok_or_else(unexpected)?, notes))
    }
}

/// Returns a smaller file with the same model. An invalid file is returned as it is, and its error is reported
/// when the body is built.
fn reduced_model(file: &str, bytes: Vec<u8>) -> Vec<u8> {
    match bytes.len() > SMALL {
        true => Model::decode(file, &bytes).map_or(bytes, |model| model.bytes()),
        false => bytes,
    }
}
