//! Construction of a body's voxel grid from its table in a scene.

use super::body::{BodyText, Form, PartText, VoxelsText};
use super::budget::Budget;
use super::error::{FieldError, require, shortened};
use super::shapes::ShapeChoice;
use crate::import::{Colours, FilePosition, FileType, Model, Picture, in_file, unexpected};
use base64::Engine;
use base64::prelude::BASE64_STANDARD as BASE64;
use fuwafuwa::MAX_EXTENT;
use fuwafuwa::inspect::points_in;
use fuwafuwa::{Dim, Dim2, Dim3, DimVector, Error, Shape, VoxelGrid};

/// Maximum number of colours that a body can name: the size of a palette.
const MAX_COLOURS: usize = 255;

/// Builds the voxel grid of a body, if the budget of the scene suffices for it.
pub(super) fn of<D: Dim>(text: &BodyText, budget: &mut Budget) -> Result<VoxelGrid<D>, FieldError> {
    let good = text.width > 0.0 && text.width.is_finite();
    let expected = format!("expected a positive number of metres, found {}", text.width);
    require(good, "width", expected)?;
    let expected = "only for a picture whose content is not embedded yet";
    require(text.fill.is_none(), "fill", expected)?;
    require(text.plain.is_none(), "plain", expected)?;
    require(text.keep_colours.is_none(), "keep_colours", expected)?;
    let expected = "only a .vox file has parts with names";
    require(
        text.model.is_none() || text.file.is_some(),
        "model",
        expected,
    )?;
    let mut voxels = match (text.shape, &text.file, &text.voxels) {
        (Some(form), None, None) => of_form::<D>(text, form, budget)?,
        (None, Some(file), None) => of_file::<D>(text, file, budget)?,
        (None, None, Some(voxels)) => {
            of_voxels::<D>(voxels, budget).map_err(|wrong| wrong.under("voxels"))?
        }
        _ => {
            let expected = "expected either a shape, a file, voxels or a state";
            return Err(FieldError::new("shape", expected));
        }
    };
    let count = voxels.materials.len();
    budget.check_voxels(count)?;
    budget.take_distances(text.part.len(), count)?;
    for (index, part) in text.part.iter().enumerate() {
        let part = Part::<D>::of(part).map_err(|wrong| wrong.inside("part", index))?;
        voxels.change(&part);
    }
    budget.take_voxels(count, voxels.solid_count())?;
    let grid = VoxelGrid::from_materials(voxels.size, voxels.voxel_size, voxels.materials);
    let grid = grid.map_err(|error| FieldError::new("part", error))?;
    match voxels.surface {
        Some(offsets) => { grid.with_surface_offsets(offsets) }
            .map_err(|error| FieldError::new("voxels.surface", error)),
        None => Ok(grid),
    }
}

/// Voxels of a grid before its parts change them.
struct Voxels {
    size: [usize; 3],
    voxel_size: f32,
    materials: Vec<u8>,
    /// Offsets of the smooth surface, if it is known.
    surface: Option<Vec<i8>>,
}

impl Voxels {
    /// Returns the voxels of a grid. `material` maps the material numbers of the grid to those of the scene.
    fn of<D: Dim>(grid: &VoxelGrid<D>, voxel_size: f32, material: impl Fn(u8) -> u8) -> Self {
        let materials = grid.voxels().map(|voxel| material(grid.material(voxel)));
        Self {
            size: grid.size().map(|extent| extent as usize),
            voxel_size,
            materials: materials.collect(),
            surface: grid.surface_offsets().map(<[i8]>::to_vec),
        }
    }

    fn solid_count(&self) -> usize {
        let solid = self.materials.iter().filter(|&&material| material != 0);
        solid.count()
    }

    fn change<D: Dim>(&mut self, part: &Part<D>) {
        let high = self.size.map(|extent| extent as i32 - 1);
        for (voxel, material) in points_in([0; 3], high).zip(&mut self.materials) {
            let is_meant = *material != 0 || part.fills;
            let centre = VoxelGrid::<D>::centre(voxel, self.voxel_size);
            let centre = D::Vector::from_vec3(centre);
            if is_meant && part.shape.distance(centre).0 < 0.0 {
                // The known surface is that of another shape.
                if (*material == 0) != (part.material == 0) {
                    self.surface = None;
                }
                *material = part.material;
            }
        }
    }
}

/// A checked part of a body.
struct Part<D: Dim> {
    shape: Shape<D>,
    material: u8,
    fills: bool,
}

impl<D: Dim> Part<D> {
    fn of(text: &PartText) -> Result<Self, FieldError> {
        let (material, fills) = match (text.fill, text.paint) {
            (Some(material), None) => (material, true),
            (None, Some(material)) => (material, false),
            _ => return Err(FieldError::new("fill", "expected either fill or paint")),
        };
        let shapes = ShapeChoice {
            half_space: text.half_space.as_ref(),
            boxed: text.boxed.as_ref(),
            capsule: text.capsule.as_ref(),
            ball: text.ball.as_ref(),
        };
        Ok(Self {
            shape: shapes.only()?,
            material,
            fills,
        })
    }
}

fn of_form<D: Dim>(text: &BodyText, form: Form, budget: &Budget) -> Result<Voxels, FieldError> {
    let expected = "only a file has colours; expected material, or parts that paint";
    require(text.colours.is_empty(), "colours", expected)?;
    let missing = || FieldError::new("n", "expected the number of voxels across");
    let n = text.n.ok_or_else(missing)?;
    check_across(n)?;
    let any_form = matches!(form, Form::Box | Form::Empty);
    let good = any_form || text.proportions == [1.0; 3];
    require(
        good,
        "proportions",
        "allowed only for shape = \"box\" or \"empty\"",
    )?;
    let mut extent = match any_form {
        true => text.proportions.map(|k| (k * n as f32).round() as usize),
        false => [n; 3],
    };
    extent[D::N..].fill(1);
    // Checks the budget only for allowed extents: larger extents are rejected below, where the grid is
    // created.
    if extent.iter().all(|&k| k <= MAX_EXTENT) {
        budget.check_voxels(extent.iter().product())?;
    }
    let grid = match form {
        Form::Ball => VoxelGrid::<D>::ball(n, text.width),
        Form::Ring => VoxelGrid::ring(n, text.width),
        Form::Heart => VoxelGrid::heart(n, text.width),
        Form::Flower => VoxelGrid::flower(n, text.width),
        Form::Box | Form::Empty => VoxelGrid::from_fn(extent, text.width / n as f32, |_| 1),
    };
    let grid = grid.map_err(|error| match error {
        Error::InvalidParameter { ref field, .. } if field == "voxel_size" => {
            FieldError::new("width", error)
        }
        _ if any_form => FieldError::new("proportions", error),
        _ => FieldError::new("n", error),
    })?;
    let material = text.material.unwrap_or(1);
    Ok(Voxels::of(&grid, grid.voxel_size(), |solid| match form {
        Form::Empty => 0,
        _ => solid * material,
    }))
}

fn of_voxels<D: Dim>(text: &VoxelsText, budget: &Budget) -> Result<Voxels, FieldError> {
    let good = text.size.iter().all(|k| (1..=MAX_EXTENT).contains(k));
    let found = format!(
        "expected 1 to {MAX_EXTENT} on each axis, found {:?}",
        text.size
    );
    require(good, "size", found)?;
    let good = text.size[D::N..].iter().all(|&k| k == 1);
    require(good, "size", "expected 1 on the third axis in 2D")?;
    let count = text.size.iter().product();
    budget.check_voxels(count)?;
    let mut materials: Vec<u8> = Vec::with_capacity(count);
    for run in text.runs.split_ascii_whitespace() {
        let both = run.split_once('x');
        let both = both.and_then(|(length, material)| {
            Some((length.parse::<usize>().ok()?, material.parse::<u8>().ok()?))
        });
        let Some((length, material)) = both else {
            let found = shortened(run, 40);
            let reason = format!("expected runs such as 12x1, found {found:?}");
            return Err(FieldError::new("runs", reason));
        };
        let left = count - materials.len();
        let reason = format!("expected {count} voxels, found more");
        require(length <= left, "runs", reason)?;
        materials.resize(materials.len() + length, material);
    }
    let found = materials.len();
    let reason = format!("expected {count} voxels, found {found}");
    require(found == count, "runs", reason)?;
    let surface = text.surface.as_ref().map(|text| BASE64.decode(text));
    let surface = surface.transpose();
    let surface =
        surface.map_err(|error| FieldError::new("surface", format!("expected base64: {error}")))?;
    let offsets = |bytes: Vec<u8>| bytes.into_iter().map(u8::cast_signed).collect();
    Ok(Voxels {
        size: text.size,
        voxel_size: text.voxel_size,
        materials,
        surface: surface.map(offsets),
    })
}

fn of_file<D: Dim>(text: &BodyText, file: &str, budget: &mut Budget) -> Result<Voxels, FieldError> {
    let good = text.proportions == [1.0; 3];
    require(
        good,
        "proportions",
        "not allowed for a file, which has its own proportions",
    )?;
    let colours = colours(text)?;
    let named = !text.colours.is_empty();
    let name = shortened(file, 200);
    let bytes = text.file_bytes()?;
    match (FileType::of(&bytes), D::N) {
        (found, Dim2::N) if found.is_readable_picture() => {
            let expected = "only a .vox file has parts with names";
            require(text.model.is_none(), "model", expected)?;
            let across = text.n.unwrap_or(MAX_EXTENT);
            check_across(across)?;
            let both = named && text.material.is_some();
            require(
                !both,
                "material",
                "not allowed together with colours, which name the materials",
            )?;
            budget.take_picture(Picture::pixels_of(&bytes))?;
            let picture = Picture::decode(&name, &bytes).map_err(FieldError::file)?;
            let pixels: usize = picture.size().iter().product();
            budget.take_pixels(pixels, colours.named.len())?;
            let grid = picture
                .grid(across, 1.0, &colours)
                .map_err(FieldError::file)?;
            let material = text.material.unwrap_or(1);
            Ok(Voxels::of(&grid, voxel_size(text, &grid), |solid| {
                if named { solid } else { solid * material }
            }))
        }
        (FileType::Vox, Dim3::N) => {
            let expected =
                "not allowed for a model, which has a fixed number of voxels; expected only width";
            require(text.n.is_none(), "n", expected)?;
            let expected = "the palette indices of a model are its materials, see colours";
            require(text.material.is_none(), "material", expected)?;
            let model = Model::decode_part(&name, &bytes, text.model.as_deref());
            let model = model.map_err(FieldError::file)?;
            budget.take_model(model.work())?;
            let grid = model.grid(1.0, &colours).map_err(FieldError::file)?;
            budget.check_model(grid.solid_count())?;
            Ok(Voxels::of(&grid, voxel_size(text, &grid), |solid| solid))
        }
        (found, dim) => Err(wrong_type(&name, found, dim)),
    }
}

/// Returns the error of a file whose type does not suit a scene of `dim` dimensions.
pub(super) fn wrong_type(file: &str, found: FileType, dim: usize) -> FieldError {
    let expected = match dim {
        2 => "a picture (PNG, JPEG, WebP, GIF or BMP) for dim = 2",
        _ => "a MagicaVoxel model for dim = 3",
    };
    let problem = unexpected(FilePosition::File, expected, found);
    FieldError::file(in_file::<()>(&shortened(file, 200), Err(problem)).unwrap_err())
}

pub(super) fn check_across(n: usize) -> Result<(), FieldError> {
    let expected = format!("expected 1 to {MAX_EXTENT} voxels across, found {n}");
    require((1..=MAX_EXTENT).contains(&n), "n", expected)
}

/// Returns the edge length of a voxel [m] for which the longest side is `text.width`.
fn voxel_size<D: Dim>(text: &BodyText, grid: &VoxelGrid<D>) -> f32 {
    let longest = grid.size().into_iter().max().unwrap_or(1);
    text.width / longest as f32
}

/// Parses the colours of a body, such as `"79" = 1` and `"#d04030" = 2`.
pub(super) fn colours(text: &BodyText) -> Result<Colours, FieldError> {
    let found = text.colours.len();
    let expected = format!("expected {MAX_COLOURS} at most, found {found}");
    require(found <= MAX_COLOURS, "colours", expected)?;
    let mut colours = Colours::default();
    for (key, &material) in &text.colours {
        let is_hex = |hex: &&str| hex.len() == 6 && hex.bytes().all(|k| k.is_ascii_hexdigit());
        let red_green_blue = key.strip_prefix('#').filter(is_hex);
        let number = red_green_blue.and_then(|hex| u32::from_str_radix(hex, 16).ok());
        if let Some(number) = number {
            let [_, red, green, blue] = number.to_be_bytes();
            colours.named.insert([red, green, blue], material);
        } else if let Some(index) = key.parse().ok().filter(|&index| index > 0) {
            colours.indices.insert(index, material);
        } else {
            let reason = format!(
                "expected a colour such as \"#d04030\" or a palette index from 1 to 255, found {key:?}"
            );
            return Err(FieldError::new("colours", reason));
        }
    }
    Ok(colours)
}
