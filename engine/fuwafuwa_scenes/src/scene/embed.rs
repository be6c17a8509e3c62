//! Files embedded in a scene, so that it is self-contained. A picture is embedded as the voxels of its body, and
//! several models of a file as one, so later changes of the rules for imports do not change the scene.

use super::MAX_MATERIALS;
use super::body::{BodyText, MaterialText};
use super::budget::Budget;
use super::error::{FieldError, expected_number, require};
use super::grid::{check_across, colours, wrong_type};
use crate::import::{
    Colours, FilePosition, FileType, ImportError, ImportNote, Model, NoteKind, Picture,
    PictureOptions, Problem, png_of,
};
use fuwafuwa::MAX_EXTENT;
use std::io;

/// Maximum length of a plain PNG file that is embedded whole [bytes]. Larger files are reduced to the voxels of
/// their bodies.
const SMALL: usize = 1 << 16;

/// Function that reads a picture or a model named in a scene. It decides where files are searched.
pub type Fetch<'a> = &'a dyn Fn(&str) -> io::Result<Vec<u8>>;

impl BodyText {
    /// Embeds the file of the body in a scene of `dim` dimensions. Adds the tints of a picture to the
    /// materials of the scene. Returns the notes of its import.
    pub(super) fn embed_file(
        &mut self,
        dim: u8,
        fetch: Fetch,
        budget: &mut Budget,
        materials: &mut Vec<MaterialText>,
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
            2 if found.is_readable_picture() => self.embed_picture(&file, bytes, budget, materials),
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
        materials: &mut Vec<MaterialText>,
    ) -> Result<Vec<ImportNote>, FieldError> {
        let across = self.n.unwrap_or(MAX_EXTENT);
        check_across(across)?;
        let mut colours = colours(self)?;
        budget.take_picture(Picture::pixels_of(&bytes))?;
        let picture = Picture::decode(file, &bytes).map_err(FieldError::file)?;
        budget.take_pixels(picture.size().iter().product(), colours.named.len())?;
        let fill = self.fill.take().unwrap_or(true);
        let is_plain = self.plain.take().unwrap_or(false);
        let keeps_colours = self.keep_colours.take().unwrap_or(false);
        let expected =
            "not allowed together with plain, nor with colours, which name the materials";
        let good = !keeps_colours || !is_plain && colours.named.is_empty();
        require(good, "keep_colours", expected)?;
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
            let import = if keeps_colours {
                let (import, tints) = picture.import_tinted(&options).map_err(FieldError::file)?;
                colours = self.with_tints(&tints, materials)?;
                import
            } else {
                picture.import(&options).map_err(FieldError::file)?
            };
            (import.grid, import.notes)
        };
        let reduced = png_of(&grid, &colours);
        let missing = || FieldError::new("colours", "expected a colour for each material");
        self.embed(&reduced.ok_or_else(missing)?);
        Ok(notes)
    }

    /// Adds a material for each tint, with the values of the body's material. Names their colours in the body.
    /// Returns the colours of the tints, numbered from 1.
    fn with_tints(
        &mut self,
        tints: &[[u8; 3]],
        materials: &mut Vec<MaterialText>,
    ) -> Result<Colours, FieldError> {
        let mut colours = Colours::default();
        if tints.is_empty() {
            return Ok(colours);
        }
        let number = self.material.take().unwrap_or(1);
        let (count, own) = (materials.len(), usize::from(number).wrapping_sub(1));
        let missing = || FieldError::new("material", expected_number(count, number));
        let like = materials.get(own).cloned().ok_or_else(missing)?;
        let all = count + tints.len();
        let expected = format!(
            "expected {MAX_MATERIALS} materials at most together with the tints of the picture, found {all}"
        );
        require(all <= MAX_MATERIALS, "keep_colours", expected)?;
        for (index, &tint) in (1..).zip(tints) {
            materials.push(MaterialText {
                colour: Some(tint),
                ..like.clone()
            });
            let [red, green, blue] = tint;
            let key = format!("#{red:02x}{green:02x}{blue:02x}");
            self.colours.insert(key, materials.len() as u8);
            colours.named.insert(tint, index);
        }
        Ok(colours)
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
