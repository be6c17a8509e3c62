//! Soft bodies outside of a world, and views of soft bodies in a world.

use crate::body_arrays::{self as arrays, FacetArrays};
use crate::convert::{
    Any, coordinates, name_of, named, repr, rotation, vector, vector_array, velocity,
};
use crate::error::{OrInvalid, invalid, invalid_parameter};
use crate::grid::{VoxelGrid2, VoxelGrid3, from_array, from_shape};
use crate::handle::SoftBodyHandle;
use crate::material::Material;
use crate::shape::{Shape2, Shape3};
use crate::world::{World2, World3};
use fuwafuwa::{
    Dim, Dim2, Dim3, DimVector, Grading, Law, Layers, SoftBody, VoxelGrid, World, WorldConfig,
    snapshot,
};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict, PyList};

/// Names of the elastic laws.
const LAWS: [(&str, Law); 2] = [
    ("corotational_vem", Law::CorotationalVem),
    ("endo_2004", Law::Endo2004),
];

/// Names of the gradings.
const GRADINGS: [(&str, Grading); 3] = [
    ("graded", Grading::Graded),
    ("uniform", Grading::Uniform),
    ("coarse", Grading::Coarse),
];

/// Returns the materials of an argument: one, several, or the default one.
fn materials(value: Option<&Any<'_>>) -> PyResult<Vec<fuwafuwa::Material>> {
    let Some(value) = value else {
        return Ok(vec![fuwafuwa::Material::default()]);
    };
    if let Ok(one) = value.extract::<Material>() {
        return Ok(vec![one.0]);
    }
    let several: Vec<Material> = value.extract().map_err(|_: PyErr| {
        let expected = "a Material, or a list of them for numbers 1, 2, …";
        invalid_parameter("materials", expected, repr(value))
    })?;
    Ok(several.into_iter().map(|material| material.0).collect())
}

/// Builds a body. Other threads run meanwhile.
fn built<D: Dim>(
    py: Python<'_>,
    grid: VoxelGrid<D>,
    materials: Option<&Any<'_>>,
    law: &str,
    grading: &str,
) -> PyResult<SoftBody<D>> {
    let materials = self::materials(materials)?;
    let (law, grading) = (
        named("law", law, &LAWS)?,
        named("grading", grading, &GRADINGS)?,
    );
    py.detach(|| SoftBody::with_options(grid, &materials, law, grading))
        .or_invalid()
}

/// Encodes a body as the snapshot of a world with one body.
fn encoded<D: Dim>(body: &SoftBody<D>) -> PyResult<Vec<u8>> {
    let mut world = World::<D>::new(WorldConfig::default()).or_invalid()?;
    world.add_soft_body(body.clone()).or_invalid()?;
    Ok(snapshot::save(&world))
}

fn decoded<D: Dim>(bytes: &[u8]) -> PyResult<SoftBody<D>> {
    let mut world = snapshot::load::<D>(bytes).or_invalid()?;
    let body = world
        .nth_soft_body(0)
        .ok_or_else(|| invalid("damaged pickle: no soft body"))?;
    world.remove(body).or_invalid()
}

macro_rules! soft_body_class {
    ($class:ident, $view:ident, $world:ident, $grid:ident, $shape:ident, $dim:ty, $dims:literal, $axes:literal) => {
        #[doc = concat!("Soft body in ", $dims, "D outside of a world, for `World", $dims, ".add_soft_body`.")]
        ///
        #[doc = concat!("grid: a VoxelGrid", $dims, "; materials: a Material for all voxels, or a list of materials for the")]
        /// numbers 1, 2, …; law: "corotational_vem" or "endo_2004"; grading: "graded" (elements small at the surface and
        /// large inside), "uniform" (elements of one voxel), or "coarse" (for counting only: does not tear).
        ///
        /// A world takes a copy, so one body can be added many times. All arrays are copies. Node i of an array is the
        /// same node in all arrays that were read at one moment, likewise for elements and pieces.
        #[pyclass(from_py_object, module = "fuwafuwa")]
        #[derive(Clone, Debug)]
        pub struct $class(pub SoftBody<$dim>);

        impl $class {
            fn read<R>(
                this: &Bound<'_, Self>,
                work: impl FnOnce(&SoftBody<$dim>) -> PyResult<R>,
            ) -> PyResult<R> {
                work(&this.try_borrow()?.0)
            }

            fn write<R>(
                this: &Bound<'_, Self>,
                work: impl FnOnce(&mut SoftBody<$dim>) -> PyResult<R>,
            ) -> PyResult<R> {
                work(&mut this.try_borrow_mut()?.0)
            }
        }

        #[pymethods]
        impl $class {
            #[new]
            #[pyo3(signature = (grid, materials=None, *, law="corotational_vem", grading="graded"))]
            fn new(
                py: Python<'_>,
                grid: $grid,
                materials: Option<&Any<'_>>,
                law: &str,
                grading: &str,
            ) -> PyResult<Self> {
                built(py, grid.grid, materials, law, grading).map(Self)
            }

            /// Returns a body from an array of material numbers (uint8, or bool for material 1) and the edge length of a
            #[doc = concat!("voxel [m]. The axes are [", $axes, "].")]
            #[staticmethod]
            #[pyo3(signature = (array, voxel_size, materials=None, *, law="corotational_vem", grading="graded"))]
            fn from_array(
                py: Python<'_>,
                array: &Any<'_>,
                voxel_size: f32,
                materials: Option<&Any<'_>>,
                law: &str,
                grading: &str,
            ) -> PyResult<Self> {
                built(py, from_array::<$dim>(array, voxel_size)?, materials, law, grading).map(Self)
            }

            /// Returns a body of voxels that covers a bounded shape, at the position of the shape. voxel_size [m].
            #[staticmethod]
            #[pyo3(signature = (shape, voxel_size, materials=None, *, law="corotational_vem", grading="graded"))]
            fn from_shape(
                py: Python<'_>,
                shape: $shape,
                voxel_size: f32,
                materials: Option<&Any<'_>>,
                law: &str,
                grading: &str,
            ) -> PyResult<Self> {
                let (grid, origin) = from_shape(&shape.0, voxel_size)?;
                let body = built(py, grid, materials, law, grading)?;
                Ok(Self(body.translated(origin)))
            }

            /// Returns a ball (in 2D a disc) with a diameter [m], `n` voxels across. Its low corner is at the origin.
            #[staticmethod]
            #[pyo3(signature = (n, diameter=1.0, materials=None, *, law="corotational_vem", grading="graded"))]
            fn ball(
                py: Python<'_>,
                n: usize,
                diameter: f32,
                materials: Option<&Any<'_>>,
                law: &str,
                grading: &str,
            ) -> PyResult<Self> {
                let grid = VoxelGrid::ball(n, diameter).or_invalid()?;
                built(py, grid, materials, law, grading).map(Self)
            }

            /// Returns a cube (in 2D a square) with a width [m], `n` voxels wide. Its low corner is at the origin.
            #[staticmethod]
            #[pyo3(signature = (n, width=1.0, materials=None, *, law="corotational_vem", grading="graded"))]
            fn cube(
                py: Python<'_>,
                n: usize,
                width: f32,
                materials: Option<&Any<'_>>,
                law: &str,
                grading: &str,
            ) -> PyResult<Self> {
                let grid = VoxelGrid::cube(n, width).or_invalid()?;
                built(py, grid, materials, law, grading).map(Self)
            }

            /// Returns a copy, translated by a vector [m].
            fn translated(&self, by: &Any<'_>) -> PyResult<Self> {
                Ok(Self(self.0.clone().translated(vector::<$dim>("by", by)?)))
            }

            /// Returns a copy, rotated about a point [m] (default the centre of mass). The rotation is an angle [rad] in
            /// 2D, and a quaternion x, y, z, w or a rotation vector in 3D.
            #[pyo3(signature = (rotation, about=None))]
            fn rotated(&self, rotation: &Any<'_>, about: Option<&Any<'_>>) -> PyResult<Self> {
                let turned = self::rotation::<$dim>(Some(rotation))?;
                let body = self.0.clone();
                Ok(Self(match about {
                    None => body.rotated(turned),
                    Some(point) => body.rotated_about(turned, vector::<$dim>("about", point)?),
                }))
            }

            /// Returns a copy with the velocity of a rigid motion: linear [m/s], and angular [rad/s] about the centre of
            /// mass (a number in 2D, a vector in 3D).
            #[pyo3(signature = (linear=None, angular=None))]
            fn with_velocity(
                &self,
                linear: Option<&Any<'_>>,
                angular: Option<&Any<'_>>,
            ) -> PyResult<Self> {
                let motion = velocity::<$dim>(linear, angular)?;
                Ok(Self(self.0.clone().with_velocity(motion)))
            }

            /// Returns a copy with other layers: bit masks of memberships and filters.
            fn with_layers(&self, memberships: u32, filters: u32) -> Self {
                let layers = Layers { memberships, filters };
                Self(self.0.clone().with_layers(layers))
            }

            /// Returns a copy with another number of the program.
            fn with_user_data(&self, user_data: u64) -> Self {
                Self(self.0.clone().with_user_data(user_data))
            }

            /// Returns a copy.
            fn copy(&self) -> Self {
                self.clone()
            }

            fn __copy__(&self) -> Self {
                self.clone()
            }

            fn __deepcopy__(&self, _memo: &Any<'_>) -> Self {
                self.clone()
            }

            fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Any<'py>, (Bound<'py, PyBytes>,))> {
                let decode = py.get_type::<Self>().getattr("_decode")?;
                Ok((decode, (PyBytes::new(py, &encoded(&self.0)?),)))
            }

            #[staticmethod]
            fn _decode(state: &[u8]) -> PyResult<Self> {
                decoded(state).map(Self)
            }
        }

        #[doc = concat!("View of a soft body in a World", $dims, ": `world[handle]` or `world.soft_body(handle)`.")]
        ///
        /// Each access reads the present state of the world and raises `Error` if the body was removed. All arrays are
        /// copies, which stay as they are when the world steps. Node i of an array is the same node in all arrays that
        /// were read at one moment; when the body tears, nodes and elements come and go.
        #[pyclass(frozen, module = "fuwafuwa")]
        pub struct $view {
            world: Py<$world>,
            handle: fuwafuwa::SoftBodyHandle,
        }

        impl $view {
            /// Creates a view of a soft body.
            pub fn new(world: Py<$world>, handle: fuwafuwa::SoftBodyHandle) -> Self {
                Self { world, handle }
            }

            fn read<R>(
                this: &Bound<'_, Self>,
                work: impl FnOnce(&SoftBody<$dim>) -> PyResult<R>,
            ) -> PyResult<R> {
                let view = this.get();
                let world = view.world.bind(this.py()).try_borrow()?;
                work(world.world.soft_body(view.handle).or_invalid()?)
            }

            fn write<R>(
                this: &Bound<'_, Self>,
                work: impl FnOnce(&mut SoftBody<$dim>) -> PyResult<R>,
            ) -> PyResult<R> {
                let view = this.get();
                let mut world = view.world.bind(this.py()).try_borrow_mut()?;
                work(world.world.soft_body_mut(view.handle).or_invalid()?)
            }
        }

        #[pymethods]
        impl $view {
            /// Handle of the body.
            #[getter]
            fn handle(&self) -> SoftBodyHandle {
                SoftBodyHandle(self.handle)
            }

            /// World of the body.
            #[getter]
            fn world(&self, py: Python<'_>) -> Py<$world> {
                self.world.clone_ref(py)
            }

            /// Returns a copy of the body, outside of the world.
            fn copy(slf: &Bound<'_, Self>) -> PyResult<$class> {
                Self::read(slf, |body| Ok($class(body.clone())))
            }
        }

        body_methods!($class, $grid, $shape, $dim);
        body_methods!($view, $grid, $shape, $dim);
    };
}

/// Methods of a body outside of a world and of a view.
macro_rules! body_methods {
    ($class:ident, $grid:ident, $shape:ident, $dim:ty) => {
        #[pymethods]
        impl $class {
            /// Number of nodes n.
            #[getter]
            fn node_count(slf: &Bound<'_, Self>) -> PyResult<usize> {
                Self::read(slf, |body| Ok(body.mesh().node_count()))
            }

            /// Number of elements m.
            #[getter]
            fn element_count(slf: &Bound<'_, Self>) -> PyResult<usize> {
                Self::read(slf, |body| Ok(body.mesh().element_count()))
            }

            /// Number of pieces that were not removed.
            #[getter]
            fn piece_count(slf: &Bound<'_, Self>) -> PyResult<usize> {
                Self::read(slf, |body| {
                    let pieces = body.pieces().list.iter();
                    Ok(pieces.filter(|piece| !piece.removed).count())
                })
            }

            /// Mass [kg].
            #[getter]
            fn mass(slf: &Bound<'_, Self>) -> PyResult<f64> {
                Self::read(slf, |body| Ok(body.total_mass()))
            }

            /// Centre of mass [m]: float32 array (d,).
            #[getter]
            fn centre_of_mass<'py>(slf: &Bound<'py, Self>) -> PyResult<Any<'py>> {
                let py = slf.py();
                Self::read(slf, |body| {
                    Ok(vector_array(py, body.centre_of_mass()).into_any())
                })
            }

            /// Kinetic energy [J].
            #[getter]
            fn kinetic_energy(slf: &Bound<'_, Self>) -> PyResult<f64> {
                Self::read(slf, |body| Ok(body.kinetic_energy()))
            }

            /// Linear momentum [N s] and angular momentum about the origin [N m s], both as tuples of 3 numbers.
            #[getter]
            #[allow(clippy::type_complexity)] // two vectors
            fn momentum(slf: &Bound<'_, Self>) -> PyResult<((f64, f64, f64), (f64, f64, f64))> {
                Self::read(slf, |body| {
                    let momentum = body.momentum();
                    Ok((momentum.linear.into(), momentum.angular.into()))
                })
            }

            /// Returns the kinetic, elastic and gravitational energy of each piece [J], for a gravity [m/s²]: float64
            /// array (pieces, 3).
            fn energies<'py>(slf: &Bound<'py, Self>, gravity: &Any<'_>) -> PyResult<Any<'py>> {
                let gravity = vector::<$dim>("gravity", gravity)?;
                Self::read(slf, |body| Ok(arrays::energies(slf.py(), body, gravity)))
            }

            /// Voxels of the body.
            #[getter]
            fn grid(slf: &Bound<'_, Self>) -> PyResult<$grid> {
                Self::read(slf, |body| Ok(body.grid().clone().into()))
            }

            /// Materials, for the numbers 1, 2, ….
            #[getter]
            fn materials(slf: &Bound<'_, Self>) -> PyResult<Vec<Material>> {
                Self::read(slf, |body| {
                    Ok(body
                        .materials()
                        .iter()
                        .map(|&material| Material(material))
                        .collect())
                })
            }

            /// Elastic law: "corotational_vem" or "endo_2004".
            #[getter]
            fn law(slf: &Bound<'_, Self>) -> PyResult<&'static str> {
                Self::read(slf, |body| Ok(name_of(body.law(), &LAWS)))
            }

            /// Grading of the elements: "graded", "uniform" or "coarse".
            #[getter]
            fn grading(slf: &Bound<'_, Self>) -> PyResult<&'static str> {
                Self::read(slf, |body| Ok(name_of(body.grading(), &GRADINGS)))
            }

            /// Bit masks of the layers: memberships and filters.
            #[getter]
            fn layers(slf: &Bound<'_, Self>) -> PyResult<(u32, u32)> {
                Self::read(slf, |body| {
                    Ok((body.layers().memberships, body.layers().filters))
                })
            }

            /// Number of the program.
            #[getter]
            fn user_data(slf: &Bound<'_, Self>) -> PyResult<u64> {
                Self::read(slf, |body| Ok(body.user_data()))
            }

            /// Factor by which gravity is multiplied for this body, see `set_gravity_scale` of the world.
            #[getter]
            fn gravity_scale(slf: &Bound<'_, Self>) -> PyResult<f32> {
                Self::read(slf, |body| Ok(body.gravity_scale()))
            }

            /// Factor s by which the inertia of deformation was raised to keep the substep stable, 1 = unchanged: vibrations
            /// are √s times slower. It acts with the setting stiff_bodies="mass_scaled".
            #[getter]
            fn mass_scale(slf: &Bound<'_, Self>) -> PyResult<f64> {
                Self::read(slf, |body| Ok(body.mass_scale()))
            }

            /// Factor by which Young's modulus was lowered to keep the substep stable, 1 = unchanged. It acts with the
            /// setting stiff_bodies="softened".
            #[getter]
            fn stiffness_scale(slf: &Bound<'_, Self>) -> PyResult<f64> {
                Self::read(slf, |body| Ok(body.stiffness_scale()))
            }

            /// Number of awake elements that are turned inside out.
            #[getter]
            fn inverted_count(slf: &Bound<'_, Self>) -> PyResult<u32> {
                Self::read(slf, |body| Ok(body.inverted_count()))
            }

            /// Largest absolute coordinate at which the body may be added to a world or moved by hand [m]: 8192 voxels.
            #[getter]
            fn range(slf: &Bound<'_, Self>) -> PyResult<f32> {
                Self::read(slf, |body| Ok(body.range()))
            }

            /// Ids of the nodes: uint32 array (n,), ascending. Ids are reused after a node is removed.
            #[getter]
            fn node_ids<'py>(slf: &Bound<'py, Self>) -> PyResult<Any<'py>> {
                Self::read(slf, |body| Ok(arrays::of_nodes(slf.py(), body, |id| id.0)))
            }

            /// Positions of the nodes [m]: float32 array (n, d), a copy.
            #[getter]
            fn positions<'py>(slf: &Bound<'py, Self>) -> PyResult<Any<'py>> {
                let position = |body: &SoftBody<$dim>| {
                    arrays::vectors_of_nodes(slf.py(), body, |id| body.node_state(id).0)
                };
                Self::read(slf, |body| Ok(position(body)))
            }

            /// Velocities of the nodes [m/s]: float32 array (n, d), a copy.
            #[getter]
            fn velocities<'py>(slf: &Bound<'py, Self>) -> PyResult<Any<'py>> {
                let velocity = |body: &SoftBody<$dim>| {
                    arrays::vectors_of_nodes(slf.py(), body, |id| body.node_state(id).1)
                };
                Self::read(slf, |body| Ok(velocity(body)))
            }

            /// Elastic forces on the nodes in the last substep in which the body was awake [N]: float32 array (n, d), a copy.
            #[getter]
            fn forces<'py>(slf: &Bound<'py, Self>) -> PyResult<Any<'py>> {
                let force = |body: &SoftBody<$dim>| {
                    arrays::vectors_of_nodes(slf.py(), body, |id| body.force_on(id))
                };
                Self::read(slf, |body| Ok(force(body)))
            }

            /// Masses of the nodes [kg]: float32 array (n,), a copy.
            #[getter]
            fn node_masses<'py>(slf: &Bound<'py, Self>) -> PyResult<Any<'py>> {
                Self::read(slf, |body| {
                    Ok(arrays::of_nodes(slf.py(), body, |id| body.node_state(id).2))
                })
            }

            /// Positions of the nodes in the undeformed body, whose low corner is at the origin [m]: float32 array (n, d).
            #[getter]
            fn rest_positions<'py>(slf: &Bound<'py, Self>) -> PyResult<Any<'py>> {
                Self::read(slf, |body| Ok(arrays::rest_positions(slf.py(), body)))
            }

            /// Positions of the nodes on the smooth surface [m]: float32 array (n, d). Inner nodes have their own position.
            #[getter]
            fn surface_positions<'py>(slf: &Bound<'py, Self>) -> PyResult<Any<'py>> {
                let position = |body: &SoftBody<$dim>| {
                    let at = |id| <$dim as Dim>::Vector::from_vec3(body.skin_position(id));
                    arrays::vectors_of_nodes(slf.py(), body, at)
                };
                Self::read(slf, |body| Ok(position(body)))
            }

            /// Damage of the nodes: float32 array (n,), a copy. 0 is intact. A node splits as soon as its damage is 1 or more,
            /// unless a node nearby has just split: then it waits for some milliseconds. Damage grows in steps of up to 6.25,
            /// so that waiting nodes have a damage above 1, seldom above 20. Nodes that are no longer overloaded heal.
            #[getter]
            fn damage<'py>(slf: &Bound<'py, Self>) -> PyResult<Any<'py>> {
                Self::read(slf, |body| {
                    Ok(arrays::of_nodes(slf.py(), body, |id| body.damage(id)))
                })
            }

            /// Whether each node is fixed: bool array (n,), a copy.
            #[getter]
            fn fixed<'py>(slf: &Bound<'py, Self>) -> PyResult<Any<'py>> {
                Self::read(slf, |body| {
                    Ok(arrays::of_nodes(slf.py(), body, |id| body.is_fixed(id)))
                })
            }

            /// Piece number of each node: uint32 array (n,), a copy.
            #[getter]
            fn node_pieces<'py>(slf: &Bound<'py, Self>) -> PyResult<Any<'py>> {
                Self::read(slf, |body| {
                    Ok(arrays::of_nodes(slf.py(), body, |id| {
                        body.pieces().of_node(id).0
                    }))
                })
            }

            /// Ids of the elements: uint32 array (m,), ascending. Ids are reused after an element is removed.
            #[getter]
            fn element_ids<'py>(slf: &Bound<'py, Self>) -> PyResult<Any<'py>> {
                Self::read(slf, |body| {
                    Ok(arrays::of_elements(slf.py(), body, |id, _| id.0))
                })
            }

            /// Nodes of the elements: int32 array (m, 3**d) of rows of `positions`, -1 where an element has no node.
            ///
            /// Columns are the points of a 3 × 3 (× 3) lattice over the cell of the element, x fastest: in 2D, columns 0,
            /// 2, 6 and 8 are the corners, 1, 3, 5 and 7 the middles of the edges. Elements of level 0 have nodes at
            /// all corners only. Larger elements may fill only a part of their cell.
            #[getter]
            fn elements<'py>(slf: &Bound<'py, Self>) -> PyResult<Any<'py>> {
                Self::read(slf, |body| Ok(arrays::elements(slf.py(), body)))
            }

            /// Levels of the elements: uint8 array (m,). The cell of an element is 2**level voxels wide.
            #[getter]
            fn levels<'py>(slf: &Bound<'py, Self>) -> PyResult<Any<'py>> {
                Self::read(slf, |body| {
                    Ok(arrays::of_elements(slf.py(), body, |_, element| {
                        element.cell.level
                    }))
                })
            }

            /// Material numbers of the elements: uint8 array (m,).
            #[getter]
            fn element_materials<'py>(slf: &Bound<'py, Self>) -> PyResult<Any<'py>> {
                Self::read(slf, |body| {
                    Ok(arrays::of_elements(slf.py(), body, |_, element| {
                        body.grid().material(body.mesh().first_voxel(element))
                    }))
                })
            }

            /// Piece numbers of the elements: uint32 array (m,).
            #[getter]
            fn element_pieces<'py>(slf: &Bound<'py, Self>) -> PyResult<Any<'py>> {
                Self::read(slf, |body| {
                    Ok(arrays::of_elements(slf.py(), body, |id, _| {
                        body.pieces().of_element(id).0
                    }))
                })
            }

            /// Elastic strain ‖F − R‖ of the elements: float32 array (m,). 0.1 is a stretch by a tenth.
            #[getter]
            fn strain<'py>(slf: &Bound<'py, Self>) -> PyResult<Any<'py>> {
                Self::read(slf, |body| {
                    Ok(arrays::of_elements(slf.py(), body, |id, _| {
                        body.strain(id).unwrap_or(0.0)
                    }))
                })
            }

            /// Plastic strain of the elements: float32 array (m,). 0 without permanent deformation.
            #[getter]
            fn plastic_strain<'py>(slf: &Bound<'py, Self>) -> PyResult<Any<'py>> {
                let strain = |body: &SoftBody<$dim>| {
                    arrays::of_elements(slf.py(), body, |id, _| {
                        body.plastic_strain(id).unwrap_or(0.0)
                    })
                };
                Self::read(slf, |body| Ok(strain(body)))
            }

            /// Elastic Biot strain of the elements along the axes of the undeformed body, the symmetric part of RᵀF - 1: float64
            /// array (m, d, d). 0.1 is a stretch by a tenth. F is without the plastic part, and R is its rotation.
            #[getter]
            fn biot_strain<'py>(slf: &Bound<'py, Self>) -> PyResult<Any<'py>> {
                Self::read(slf, |body| {
                    let rows = |state: &fuwafuwa::ElementState| state.strain.map(Into::into);
                    Ok(arrays::matrices(slf.py(), body, rows))
                })
            }

            /// Deformation gradients F of the elements: float64 array (m, d, d).
            #[getter]
            fn deformation<'py>(slf: &Bound<'py, Self>) -> PyResult<Any<'py>> {
                Self::read(slf, |body| {
                    let rows = |state: &fuwafuwa::ElementState| state.deformation.map(Into::into);
                    Ok(arrays::matrices(slf.py(), body, rows))
                })
            }

            /// Cauchy stress of the elements along the axes of the world [Pa]: float64 array (m, d, d).
            #[getter]
            fn stress<'py>(slf: &Bound<'py, Self>) -> PyResult<Any<'py>> {
                Self::read(slf, |body| {
                    let rows = |state: &fuwafuwa::ElementState| state.stress.map(Into::into);
                    Ok(arrays::matrices(slf.py(), body, rows))
                })
            }

            /// Elastic energy of the elements [J]: float64 array (m,). In 2D for 1 m of depth.
            #[getter]
            fn elastic_energy<'py>(slf: &Bound<'py, Self>) -> PyResult<Any<'py>> {
                Self::read(slf, |body| {
                    Ok(arrays::of_elements(slf.py(), body, |id, _| {
                        body.element_state(id).map_or(0.0, |state| state.energy)
                    }))
                })
            }

            /// Returns the blocks that the elements fill: corners [m] as float32 array (k, 2**d, d), the first axis fastest,
            /// and the row of the element of each block as int32 array (k,). In 2D, corners 0, 1, 3, 2 go around a block.
            fn cells<'py>(slf: &Bound<'py, Self>) -> PyResult<(Any<'py>, Any<'py>)> {
                Self::read(slf, |body| Ok(arrays::cells(slf.py(), body)))
            }

            /// Returns the exposed faces: int32 array (f, 2**(d-1)) of rows of nodes, counterclockwise as seen from
            /// outside, int32 array (f,) of rows of elements, and bool array (f,): whether the face was torn.
            fn facets<'py>(slf: &Bound<'py, Self>) -> PyResult<FacetArrays<'py>> {
                Self::read(slf, |body| Ok(arrays::facets(slf.py(), body)))
            }

            /// Returns the closed lines around all pieces of a 2D body and around their holes: a list of dicts with the
            /// keys piece, nodes (rows), points [m] (p, 2) and torn (p,). Empty in 3D.
            fn outlines<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyList>> {
                Self::read(slf, |body| arrays::outlines(slf.py(), body))
            }

            /// Returns the pieces: a dict of arrays whose row is the piece number. mass [kg]; centre of mass [m], velocity
            /// [m/s], and low and high corner of the bounding box [m], all (pieces, d); element_count; asleep; quarantined;
            /// removed. Removed pieces keep their row, with mass 0.
            fn pieces<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyDict>> {
                Self::read(slf, |body| arrays::pieces(slf.py(), body))
            }

            /// Returns the rows of the nodes inside a shape or on its surface: int32 array.
            fn nodes_in<'py>(slf: &Bound<'py, Self>, region: $shape) -> PyResult<Any<'py>> {
                Self::read(slf, |body| {
                    Ok(arrays::rows_of_nodes(
                        slf.py(),
                        body,
                        body.nodes_in(&region.0),
                    ))
                })
            }

            /// Returns the mass of the nodes inside a shape [kg].
            fn mass_inside(slf: &Bound<'_, Self>, region: $shape) -> PyResult<f32> {
                Self::read(slf, |body| Ok(body.mass_inside(&region.0)))
            }

            /// Returns sums over the part of the body inside a shape or on its surface: a dict with nodes, their number; mass
            /// [kg]; centre of mass [m]; momentum [kg m/s]; elastic_force [N], the force of the rest of the body on this part
            /// in the last substep; elastic_energy [J] of the elements whose centre is inside (in 2D for 1 m of depth).
            fn sums_inside<'py>(
                slf: &Bound<'py, Self>,
                region: $shape,
            ) -> PyResult<Bound<'py, PyDict>> {
                Self::read(slf, |body| arrays::sums(slf.py(), body, &region.0))
            }

            /// Fixes nodes at their positions. nodes: n bools, or rows.
            fn fix_nodes(slf: &Bound<'_, Self>, nodes: &Any<'_>) -> PyResult<()> {
                let nodes = Self::read(slf, |body| arrays::chosen_nodes(body, nodes))?;
                Self::write(slf, |body| {
                    nodes.into_iter().for_each(|node| body.fix_node(node));
                    Ok(())
                })
            }

            /// Frees fixed nodes. nodes: n bools, or rows.
            fn free_nodes(slf: &Bound<'_, Self>, nodes: &Any<'_>) -> PyResult<()> {
                let nodes = Self::read(slf, |body| arrays::chosen_nodes(body, nodes))?;
                Self::write(slf, |body| {
                    nodes.into_iter().for_each(|node| body.free_node(node));
                    Ok(())
                })
            }

            /// Sets the positions [m] and velocities [m/s] of all nodes from arrays (n, d) of float32 or float64. Positions must
            /// be within `range`.
            #[pyo3(signature = (positions=None, velocities=None))]
            fn set_node_states(
                slf: &Bound<'_, Self>,
                positions: Option<&Any<'_>>,
                velocities: Option<&Any<'_>>,
            ) -> PyResult<()> {
                let states =
                    Self::read(slf, |body| arrays::node_states(body, positions, velocities))?;
                Self::write(slf, |body| arrays::set_node_states(body, states))
            }

            fn __repr__(slf: &Bound<'_, Self>) -> PyResult<String> {
                let name = stringify!($class);
                let described = Self::read(slf, |body| {
                    let (nodes, elements) = (body.mesh().node_count(), body.mesh().element_count());
                    let centre = coordinates(body.centre_of_mass());
                    Ok(format!(
                        "<{name} of {nodes} nodes and {elements} elements at {centre:?}>"
                    ))
                });
                Ok(described.unwrap_or_else(|error| format!("<{name}: {error}>")))
            }
        }
    };
}

soft_body_class!(
    SoftBody2,
    SoftBodyView2,
    World2,
    VoxelGrid2,
    Shape2,
    Dim2,
    "2",
    "x, y"
);
soft_body_class!(
    SoftBody3,
    SoftBodyView3,
    World3,
    VoxelGrid3,
    Shape3,
    Dim3,
    "3",
    "x, y, z"
);
