//! Voxel grids, from arrays, shapes and files.

use crate::convert::{Any, described};
use crate::error::{FirstException, OrInvalid, invalid, invalid_parameter};
use crate::file::{File, colours, shown, texts};
use crate::shape::{Shape2, Shape3};
use fuwafuwa::{
    Dim, Dim2, Dim3, DimVector, MAX_EXTENT, MAX_VOXELS, Shape, VOXEL_SIZES, Vec3, VoxelGrid,
};
use fuwafuwa_scan::{Options, Organ, Scan, Segmentation, warnings};
use fuwafuwa_scenes::import::{MAX_FILE_BYTES, Model, Picture, PictureOptions};
use numpy::ndarray::{ArrayD, ArrayViewD, IxDyn, ShapeBuilder};
use numpy::{IntoPyArray, PyReadonlyArrayDyn};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict, PyList, PyTuple};
use std::collections::BTreeMap;
use std::ops::RangeInclusive;

/// Returns the size of an array with one axis for each dimension; 1 on the third axis in 2D.
fn size_of<D: Dim>(shape: &[usize]) -> Option<[usize; 3]> {
    match *shape {
        [x, y] if D::N == 2 => Some([x, y, 1]),
        [x, y, z] if D::N == 3 => Some([x, y, z]),
        _ => None,
    }
}

/// Returns a grid from the values of an array, or `None` if the array has another number of axes.
fn from_values<D: Dim, T: Copy>(
    array: &ArrayViewD<'_, T>,
    voxel_size: f32,
    material: impl Fn(T) -> u8,
) -> Option<PyResult<VoxelGrid<D>>> {
    let size = size_of::<D>(array.shape())?;
    // A view can be much larger than its memory. The engine rejects such a grid by its size alone.
    let materials =
        match size.iter().all(|&extent| extent <= MAX_EXTENT) && array.len() <= MAX_VOXELS {
            // The engine has the first axis fastest.
            true => array.t().iter().map(|&value| material(value)).collect(),
            false => Vec::new(),
        };
    Some(VoxelGrid::from_materials(size, voxel_size, materials).or_invalid())
}

/// Returns a grid from an array with one axis for each dimension.
pub fn from_array<D: Dim>(array: &Any<'_>, voxel_size: f32) -> PyResult<VoxelGrid<D>> {
    let wrong = || {
        let expected = format!("an array of uint8 or bool with {} axes", D::N);
        invalid_parameter("array", expected, described(array))
    };
    if let Ok(numbers) = array.extract::<PyReadonlyArrayDyn<'_, u8>>() {
        return from_values(&numbers.as_array(), voxel_size, |number| number).ok_or_else(wrong)?;
    }
    if let Ok(flags) = array.extract::<PyReadonlyArrayDyn<'_, bool>>() {
        return from_values(&flags.as_array(), voxel_size, u8::from).ok_or_else(wrong)?;
    }
    Err(wrong())
}

/// Returns a grid that covers a shape, and the position of its low corner [m].
pub fn from_shape<D: Dim>(
    shape: &Shape<D>,
    voxel_size: f32,
) -> PyResult<(VoxelGrid<D>, D::Vector)> {
    if !VOXEL_SIZES.contains(&voxel_size) {
        let (low, high) = (VOXEL_SIZES.start(), VOXEL_SIZES.end());
        let (expected, given) = (format!("{low} to {high} m"), format!("{voxel_size:?}"));
        return Err(invalid_parameter("voxel_size", expected, given));
    }
    let [low, high] = shape.bounds();
    if !low.is_finite() || !high.is_finite() {
        let expected = "bounded: a ball, a box or a capsule";
        return Err(invalid_parameter("shape", expected, "a half-space"));
    }
    let [low, high] = [low.to_vec3(), high.to_vec3()];
    let mut size = [1; 3];
    let mut origin = Vec3::ZERO;
    for axis in 0..D::N {
        // Rounding must not add a voxel to a shape whose width is a multiple of the voxel size.
        let voxels = ((high[axis] - low[axis]) / voxel_size - 1e-3)
            .ceil()
            .max(1.0);
        size[axis] = voxels as usize;
        origin[axis] = 0.5 * (low[axis] + high[axis] - voxels * voxel_size);
    }
    let distance = |at: Vec3| shape.distance(D::Vector::from_vec3(origin + at)).0;
    let grid = VoxelGrid::from_distance(size, voxel_size, distance).or_invalid()?;
    Ok((grid, D::Vector::from_vec3(origin)))
}

/// Returns a grid from a function of Python that gives a signed distance.
fn from_distance<D: Dim>(
    py: Python<'_>,
    size: &[usize],
    voxel_size: f32,
    distance: &Any<'_>,
) -> PyResult<VoxelGrid<D>> {
    let size = size_of::<D>(size).ok_or_else(|| {
        invalid_parameter(
            "size",
            format!("{} whole numbers", D::N),
            format!("{size:?}"),
        )
    })?;
    let exception = FirstException::default();
    let at = |point: Vec3| {
        exception.catch(1.0, || {
            let point = PyTuple::new(py, &point.to_array()[..D::N])?;
            distance.call1((point,))?.extract()
        })
    };
    let grid = VoxelGrid::from_distance(size, voxel_size, at);
    exception.or(grid)?.or_invalid()
}

/// Returns an array of the voxels, with one axis for each dimension.
fn array_of<'py, D: Dim, T: numpy::Element>(
    py: Python<'py>,
    grid: &VoxelGrid<D>,
    value: impl Fn([i32; 3]) -> T,
) -> Any<'py> {
    let shape: Vec<usize> = grid.size()[..D::N]
        .iter()
        .map(|&extent| extent as usize)
        .collect();
    let values: Vec<T> = grid.voxels().map(value).collect();
    let array = ArrayD::from_shape_vec(IxDyn(&shape).f(), values);
    array
        .expect("the grid has a value for each voxel")
        .into_pyarray(py)
        .into_any()
}

macro_rules! grid_class {
    ($class:ident, $shape:ident, $dim:ty, $dims:literal, $axes:literal) => {
        #[doc = concat!("Grid of voxels in ", $dims, "D: a material number for each voxel, 0 = empty.")]
        ///
        #[doc = concat!("Arrays have the axes [", $axes, "], as positions have these coordinates: index 0 is the low end of")]
        /// each axis, and y points up. An image, whose rows run downwards, becomes such an array by `image[::-1].T`.
        /// The low corner of a grid is at the origin of its body.
        #[pyclass(frozen, from_py_object, module = "fuwafuwa")]
        #[derive(Clone, Debug)]
        pub struct $class {
            /// The grid.
            pub grid: VoxelGrid<$dim>,
            notes: Vec<String>,
        }

        impl From<VoxelGrid<$dim>> for $class {
            fn from(grid: VoxelGrid<$dim>) -> Self {
                Self { grid, notes: Vec::new() }
            }
        }

        #[pymethods]
        impl $class {
            /// Returns a grid from an array of material numbers (uint8, or bool for material 1) and the edge length of
            #[doc = concat!("a voxel [m]. The axes are [", $axes, "].")]
            #[new]
            fn new(array: &Any<'_>, voxel_size: f32) -> PyResult<Self> {
                from_array(array, voxel_size).map(Self::from)
            }

            /// Returns a ball (in 2D a disc) with a diameter [m], `n` voxels across.
            #[staticmethod]
            #[pyo3(signature = (n, diameter=1.0))]
            fn ball(n: usize, diameter: f32) -> PyResult<Self> {
                VoxelGrid::ball(n, diameter).or_invalid().map(Self::from)
            }

            /// Returns a cube (in 2D a square) with a width [m], `n` voxels wide.
            #[staticmethod]
            #[pyo3(signature = (n, width=1.0))]
            fn cube(n: usize, width: f32) -> PyResult<Self> {
                VoxelGrid::cube(n, width).or_invalid().map(Self::from)
            }

            /// Returns a ring (in 3D a torus) with an outer diameter [m], `n` voxels across.
            #[staticmethod]
            #[pyo3(signature = (n, diameter=1.0))]
            fn ring(n: usize, diameter: f32) -> PyResult<Self> {
                VoxelGrid::ring(n, diameter).or_invalid().map(Self::from)
            }

            /// Returns a heart with a width [m], `n` voxels wide.
            #[staticmethod]
            #[pyo3(signature = (n, width=1.0))]
            fn heart(n: usize, width: f32) -> PyResult<Self> {
                VoxelGrid::heart(n, width).or_invalid().map(Self::from)
            }

            /// Returns a flower with a width [m], `n` voxels wide.
            #[staticmethod]
            #[pyo3(signature = (n, width=1.0))]
            fn flower(n: usize, width: f32) -> PyResult<Self> {
                VoxelGrid::flower(n, width).or_invalid().map(Self::from)
            }

            /// Returns a grid of material 1 that covers a bounded shape and knows its surface, from the shape and the edge
            /// length of a voxel [m]. The position of the shape
            #[doc = concat!("is lost: `SoftBody", $dims, ".from_shape` keeps it.")]
            #[staticmethod]
            fn from_shape(shape: $shape, voxel_size: f32) -> PyResult<Self> {
                Ok(from_shape(&shape.0, voxel_size)?.0.into())
            }

            /// Returns a grid of material 1 from its size [voxels] and a function that returns the signed distance of a
            /// point from the surface [m], negative inside. Points are tuples [m], measured from the low corner of the
            /// grid. The function is called several times for each voxel at the surface. The grid knows its surface to
            /// 1/64 voxel.
            #[staticmethod]
            fn from_distance(
                py: Python<'_>,
                size: Vec<usize>,
                voxel_size: f32,
                distance: &Any<'_>,
            ) -> PyResult<Self> {
                from_distance(py, &size, voxel_size, distance).map(Self::from)
            }

            #[doc = concat!("Material numbers: uint8 array [", $axes, "], a copy. Voxels of removed pieces keep their numbers.")]
            #[getter]
            fn array<'py>(&self, py: Python<'py>) -> Any<'py> {
                array_of(py, &self.grid, |voxel| self.grid.material(voxel))
            }

            #[doc = concat!("Whether each voxel is solid and was not removed with its piece: bool array [", $axes, "], a copy.")]
            #[getter]
            fn present<'py>(&self, py: Python<'py>) -> Any<'py> {
                array_of(py, &self.grid, |voxel| self.grid.is_present(voxel))
            }

            /// Number of voxels on each axis.
            #[getter]
            fn size<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
                PyTuple::new(py, &self.grid.size()[..<$dim as Dim>::N])
            }

            /// Edge length of a voxel [m].
            #[getter]
            fn voxel_size(&self) -> f32 {
                self.grid.voxel_size()
            }

            /// Number of solid voxels.
            #[getter]
            fn solid_count(&self) -> usize {
                self.grid.solid_count()
            }

            /// Whether the grid knows its smooth surface. Grids from arrays do not; contacts then use the smoothed surface
            /// of the voxels.
            #[getter]
            fn has_surface(&self) -> bool {
                self.grid.has_surface()
            }

            /// Notes of the importer on what was left out or may surprise; they are also shown as warnings.
            #[getter]
            fn notes(&self) -> Vec<String> {
                self.notes.clone()
            }

            /// Returns the grid with all lengths multiplied by a factor, and the same voxels.
            fn scaled(&self, factor: f32) -> PyResult<Self> {
                let grid = self.grid.clone().scaled(factor).or_invalid()?;
                Ok(Self { grid, notes: self.notes.clone() })
            }

            /// Returns the grid with other material numbers, from an array of the same shape. If the same voxels are
            /// solid, the grid keeps its surface.
            fn with_materials(&self, array: &Any<'_>) -> PyResult<Self> {
                let other = from_array::<$dim>(array, self.grid.voxel_size())?;
                if other.size() != self.grid.size() {
                    let expected = format!("an array of shape {:?}", &self.grid.size()[..<$dim as Dim>::N]);
                    return Err(invalid_parameter("array", expected, described(array)));
                }
                let grid = self.grid.clone().with_materials(|voxel, _| other.material(voxel));
                Ok(Self { grid: grid.or_invalid()?, notes: self.notes.clone() })
            }

            fn __repr__(&self) -> String {
                let (size, voxel_size) = (&self.grid.size()[..<$dim as Dim>::N], self.grid.voxel_size());
                format!("<{} of {size:?} voxels of {voxel_size} m>", stringify!($class))
            }

            fn __eq__(&self, other: &Self) -> bool {
                let known = |grid: &VoxelGrid<$dim>| {
                    let materials: Vec<_> = grid.voxels().map(|at| (grid.material(at), grid.is_present(at))).collect();
                    (materials, grid.surface_offsets().map(<[i8]>::to_vec))
                };
                self.grid.size() == other.grid.size()
                    && self.grid.voxel_size() == other.grid.voxel_size()
                    && known(&self.grid) == known(&other.grid)
            }

            #[allow(clippy::type_complexity)] // the tuple that pickle expects
            fn __reduce__<'py>(
                &self,
                py: Python<'py>,
            ) -> PyResult<(Any<'py>, (Any<'py>, f32, Option<Vec<i8>>, Vec<String>))> {
                if self.grid.remaining_count() != self.grid.solid_count() {
                    return Err(invalid("a grid with removed voxels cannot be pickled; pickle its body"));
                }
                let decode = py.get_type::<Self>().getattr("_decode")?;
                let surface = self.grid.surface_offsets().map(<[i8]>::to_vec);
                Ok((decode, (self.array(py), self.grid.voxel_size(), surface, self.notes.clone())))
            }

            #[staticmethod]
            fn _decode(
                array: &Any<'_>,
                voxel_size: f32,
                surface: Option<Vec<i8>>,
                notes: Vec<String>,
            ) -> PyResult<Self> {
                let mut grid = from_array::<$dim>(array, voxel_size)?;
                if let Some(surface) = surface {
                    grid = grid.with_surface_offsets(surface).or_invalid()?;
                }
                Ok(Self { grid, notes })
            }
        }
    };
}

grid_class!(VoxelGrid2, Shape2, Dim2, "2", "x, y");
grid_class!(VoxelGrid3, Shape3, Dim3, "3", "x, y, z");

#[pymethods]
impl VoxelGrid2 {
    /// Returns the silhouette of a picture: PNG, JPEG, WebP, GIF or BMP, from a path or bytes.
    ///
    /// Opaque pixels of a sprite, or the ink of a drawing and what it encloses, are solid; the top row is the highest.
    /// The empty margin is trimmed. across: largest number of voxels on the longer side; voxel_size [m]; fill: whether
    /// closed outlines of a drawing are filled; colours: a dict from (red, green, blue) to material numbers (0 = empty),
    /// by which each pixel gets the material of the nearest colour.
    #[staticmethod]
    #[pyo3(signature = (source, *, across=64, voxel_size=0.015625, colours=None, fill=true))]
    fn picture(
        py: Python<'_>,
        source: &Any<'_>,
        across: usize,
        voxel_size: f32,
        colours: Option<&Bound<'_, PyDict>>,
        fill: bool,
    ) -> PyResult<Self> {
        let File { name, bytes } = File::read(source, MAX_FILE_BYTES)?;
        let colours = self::colours(colours)?;
        let options = PictureOptions {
            across,
            voxel_size,
            colours,
            fill,
        };
        let import = py
            .detach(|| Picture::decode(&name, &bytes)?.import(&options))
            .or_invalid()?;
        let notes = shown(py, texts(&import.notes))?;
        Ok(Self {
            grid: import.grid,
            notes,
        })
    }

    /// Returns one voxel for each pixel of a picture, as for pixel art. The empty margin is kept, and outlines are not
    /// filled. The arguments are those of `picture`.
    #[staticmethod]
    #[pyo3(signature = (source, *, across=64, voxel_size=0.015625, colours=None))]
    fn pixels(
        py: Python<'_>,
        source: &Any<'_>,
        across: usize,
        voxel_size: f32,
        colours: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<Self> {
        let File { name, bytes } = File::read(source, MAX_FILE_BYTES)?;
        let colours = self::colours(colours)?;
        let grid = || Picture::decode(&name, &bytes)?.grid(across, voxel_size, &colours);
        py.detach(grid).or_invalid().map(Self::from)
    }
}

#[pymethods]
impl VoxelGrid3 {
    /// Returns the model in a MagicaVoxel file (.vox), from a path or bytes.
    ///
    /// The z axis of MagicaVoxel becomes y. voxel_size [m]; colours: a dict from palette indices (1 to 255) or
    /// (red, green, blue) to material numbers (0 = empty); by default the palette index is the material
    /// number. part: name of an object in the file.
    #[staticmethod]
    #[pyo3(signature = (source, *, voxel_size=0.015625, colours=None, part=None))]
    fn vox(
        py: Python<'_>,
        source: &Any<'_>,
        voxel_size: f32,
        colours: Option<&Bound<'_, PyDict>>,
        part: Option<&str>,
    ) -> PyResult<Self> {
        let File { name, bytes } = File::read(source, MAX_FILE_BYTES)?;
        let colours = self::colours(colours)?;
        let import = || Model::decode_part(&name, &bytes, part)?.import(voxel_size, &colours);
        let import = py.detach(import).or_invalid()?;
        let notes = shown(py, texts(&import.notes))?;
        Ok(Self {
            grid: import.grid,
            notes,
        })
    }

    /// Returns the largest connected object in a medical scan: NIfTI-1 or NIfTI-2 (.nii, .nii.gz), from a path or
    /// bytes. This is not a medical device.
    ///
    /// One of three arguments decides the materials:
    ///
    /// - labels: a dict from integer labels to material numbers
    /// - thresholds: a list of (low, high, material number) of intensities; the first match decides
    /// - neither of both: `source` is a list of probability maps, one for each material
    ///
    /// resolution: number of voxels along the longest side, 8 to 256; fill_holes: whether enclosed holes are filled.
    /// Lengths are those of the patient in metres. x points to the patient's right, y to the head, z to the back.
    #[staticmethod]
    #[pyo3(signature = (source, *, labels=None, thresholds=None, resolution=64, fill_holes=false))]
    fn nifti(
        py: Python<'_>,
        source: &Any<'_>,
        labels: Option<BTreeMap<i32, u8>>,
        thresholds: Option<Vec<(f32, f32, u8)>>,
        resolution: usize,
        fill_holes: bool,
    ) -> PyResult<Self> {
        let limit = fuwafuwa_scan::MAX_FILE_BYTES;
        let files: Vec<File> = match source.cast::<PyList>() {
            Ok(list) => list
                .iter()
                .map(|one| File::read(&one, limit))
                .collect::<PyResult<_>>()?,
            Err(_) => vec![File::read(source, limit)?],
        };
        let segmentation = match (labels, thresholds) {
            (Some(_), Some(_)) => {
                let text = "nifti() takes labels or thresholds, not both";
                return Err(PyTypeError::new_err(text));
            }
            (Some(labels), None) => Segmentation::Labels(labels),
            (None, Some(thresholds)) => {
                let ranges = thresholds
                    .iter()
                    .map(|&(low, high, number)| (low..=high, number));
                let ranges: Vec<(RangeInclusive<f32>, u8)> = ranges.collect();
                Segmentation::thresholds(&ranges)
            }
            (None, None) => Segmentation::Maps,
        };
        let options = Options {
            resolution,
            fills_holes: fill_holes,
        };
        let imported = py.detach(|| -> Result<_, String> {
            let decode = |file: &File| {
                let scan = Scan::decode(&file.name, &file.bytes, |_| {});
                scan.map_err(|error| error.to_string())
            };
            let scans = files
                .iter()
                .map(decode)
                .collect::<Result<Vec<Scan>, String>>()?;
            let all: Vec<&Scan> = scans.iter().collect();
            let organ = Organ::of(&all, &segmentation, &options, |_| {});
            let organ = organ.map_err(|error| error.to_string())?;
            let names = files.iter().map(|file| file.name.as_str());
            let named: Vec<(&str, &Scan)> = names.zip(&scans).collect();
            Ok((organ.grid, warnings(&named, &segmentation)))
        });
        let (grid, notes) = imported.map_err(invalid)?;
        let notes = shown(py, notes)?;
        Ok(Self { grid, notes })
    }

    /// Returns the model as a MagicaVoxel file. colours: a list of (red, green, blue), for material number 1 first.
    #[pyo3(signature = (colours=None))]
    fn to_vox<'py>(
        &self,
        py: Python<'py>,
        colours: Option<Vec<[u8; 3]>>,
    ) -> PyResult<Bound<'py, PyBytes>> {
        let colours = colours.unwrap_or_default();
        let model = Model::of("grid", &self.grid, &colours).or_invalid()?;
        Ok(PyBytes::new(py, &model.bytes()))
    }
}
