//! Files embedded in a scene, so that it is self-contained. A picture is embedded as the voxels of its body, and
//! several models of a file as one, so later changes of the rules for imports do not change the scene.

use super::body::BodyText;
use super::budget::Budget;
use super::error::FieldError;
use super::grid::{check_across, colours, wrong_type};
use crate::import::{
    FilePosition, FileType, ImportError, ImportNote, Model, NoteKind, Picture, PictureOptions,
    Problem, png_of,
};
use fuwafuwa::MAX_EXTENT;
use std::io;

/// Maximum length of a plain PNG file that is embedded whole [bytes]. Larger files are reduced to the voxels of
/// their bodies.
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
        match dim {
            2 if found.is_readable_picture() => self.embed_picture(&file, bytes, budget),
            3 if found == FileType::Vox => self.embed_model(&file, &bytes, budget),
            _ => Err(wrong_type(&file, found, dim.into())),
        }
    }

    /// Embeds a PNG file with one pixel per voxel of the body. Takes the fields that only the import needs. A
    /// small PNG file whose pixels count as they are is embedded whole.
    fn embed_picture(
        &mut self,
        file: &str,
        bytes: Vec<u8>,
        budget: &mut Budget,
    ) -> Result<Vec<ImportNote>, FieldError> {
        let across = self.n.unwrap_or(MAX_EXTENT);
        check_across(across)?;
        let colours = colours(self)?;
        budget.take_picture(Picture::pixels_of(&bytes))?;
        let picture = Picture::decode(file, &bytes).map_err(FieldError::file)?;
        budget.take_pixels(picture.size().iter().product(), colours.named.len())?;
        let fill = self.fill.take().unwrap_or(true);
        let is_plain = self.plain.take().unwrap_or(false);
        if is_plain && bytes.len() <= SMALL && FileType::of(&bytes) == FileType::Png {
            self.embed(&bytes);
            // An empty shape is reported when the body is built.
            let grid = picture.grid(across, 1.0, &colours).ok();
            let pieces = grid.and_then(|grid| NoteKind::of_pieces(&grid));
            let pieces = pieces.map(|kind| ImportNote::new(file, kind));
            return Ok(picture.frames_note().into_iter().chain(pieces).collect());
        }
        let (grid, notes) = if is_plain {
            let grid = picture.grid(across, 1.0, &colours);
            let grid = grid.map_err(FieldError::file)?;
            let pieces = NoteKind::of_pieces(&grid).map(|kind| ImportNote::new(file, kind));
            let notes = picture.frames_note().into_iter().chain(pieces).collect();
            (grid, notes)
        } else {
            let options = PictureOptions {
                across,
                voxel_size: 1.0,
                colours: colours.clone(),
                fill,
            };
            let import = picture.import(&options).map_err(FieldError::file)?;
            (import.grid, import.notes)
        };
        let reduced = png_of(&grid, &colours);
        let missing = || FieldError::new("colours", "expected a colour for each material");
        self.embed(&reduced.ok_or_else(missing)?);
        Ok(notes)
    }

    /// Embeds the visible models of a file, or the part of it that the body is made from, as one model. A file
    /// with one model and no scene is embedded whole, if it is no longer than that. An invalid file is embedded
    /// whole, too; its error is reported when the body is built.
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
        let is_part = self.model.take().is_some();
        if is_part || !model.is_alone() || less.len() < bytes.len() {
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
}
