//! Worlds: the program of a simulation.

use crate::convert::{
    Any, angular_object, name_of, named, rotation, vector, vector_array, vector_pair, velocity,
};
use crate::error::{OrInvalid, file_error, invalid_parameter};
use crate::event::{StepReport, contact_dict, event_dict};
use crate::handle::{
    AnyBody, AnyHandle, GripHandle, JointHandle, KnifeHandle, RigidBodyHandle, SoftBodyHandle,
    selector,
};
use crate::joint::{Joint2, Joint3};
use crate::picture::{PictureOptions, rgb, view_of};
use crate::query::{self, Selection};
use crate::rigid_body::{LayerMasks, RigidBody2, RigidBody3};
use crate::rigid_view::{RigidBodyView2, RigidBodyView3};
use crate::scene::Scene;
use crate::shape::{Shape2, Shape3};
use crate::soft_body::{SoftBody2, SoftBody3, SoftBodyView2, SoftBodyView3};
use fuwafuwa::{
    Blade, BodyHandle, Dim, Dim2, Dim3, Event, Grip, GripDrive, Impulse, Knife, Layers, MotionType,
    PieceId, PieceSize, Ray, ReactionForce, Removed, StiffBodies, World, WorldConfig, snapshot,
};
use fuwafuwa_painter::png_of;
use numpy::IntoPyArray;
use pyo3::exceptions::{PyKeyError, PyTypeError};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict, PyList};
use std::path::PathBuf;

/// Names of the treatments of stiff bodies.
const STIFF_BODIES: [(&str, StiffBodies); 3] = [
    ("exact", StiffBodies::Exact),
    ("mass_scaled", StiffBodies::MassScaled),
    ("softened", StiffBodies::Softened),
];

/// Number of ticks after which a long step lets Python handle signals, such as an interrupt from the keyboard.
const TICKS_BETWEEN_SIGNALS: u64 = 16;

/// Settings of a world, as given from Python; missing ones stay as they are.
struct Settings<'a, 'py> {
    gravity: Option<&'a Any<'py>>,
    drag: Option<f32>,
    max_substeps: Option<u32>,
    stiff_bodies: Option<&'a str>,
    tick: Option<f32>,
    sleep: Option<bool>,
}

impl Settings<'_, '_> {
    fn applied_to<D: Dim>(self, config: WorldConfig<D>) -> PyResult<WorldConfig<D>> {
        let gravity = self
            .gravity
            .map(|gravity| vector::<D>("gravity", gravity))
            .transpose()?;
        let stiff = self
            .stiff_bodies
            .map(|name| named("stiff_bodies", name, &STIFF_BODIES));
        Ok(WorldConfig {
            gravity: gravity.unwrap_or(config.gravity),
            drag: self.drag.unwrap_or(config.drag),
            max_substeps: self.max_substeps.unwrap_or(config.max_substeps),
            stiff_bodies: stiff.transpose()?.unwrap_or(config.stiff_bodies),
            tick: self.tick.unwrap_or(config.tick),
            sleep: self.sleep.unwrap_or(config.sleep),
        })
    }
}

/// Returns the motion type with a name and its parameters.
fn motion_type(
    name: &str,
    mass: Option<f32>,
    stiffness: f32,
    damping: f32,
    max_force: f32,
) -> PyResult<MotionType> {
    match (name, mass) {
        ("fixed", None) => Ok(MotionType::Fixed),
        ("kinematic", None) => Ok(MotionType::Kinematic),
        ("coupled", mass) => {
            let mass = mass.unwrap_or(2.0);
            Ok(MotionType::Coupled {
                mass,
                stiffness,
                damping,
                max_force,
            })
        }
        ("dynamic", Some(mass)) => Ok(MotionType::Dynamic { mass }),
        ("dynamic", None) => Err(PyTypeError::new_err("a dynamic body requires a mass")),
        ("fixed" | "kinematic", Some(_)) => {
            Err(PyTypeError::new_err(format!("a {name} body has no mass")))
        }
        _ => {
            let expected = "one of \"fixed\", \"kinematic\", \"coupled\", \"dynamic\"";
            Err(invalid_parameter("motion", expected, format!("{name:?}")))
        }
    }
}

fn reaction_dict<D: Dim>(
    py: Python<'_>,
    reaction: ReactionForce<D>,
) -> PyResult<Bound<'_, PyDict>> {
    let dict = PyDict::new(py);
    dict.set_item("point", vector_array(py, reaction.point))?;
    dict.set_item("force", vector_array(py, reaction.force))?;
    dict.set_item("torque", angular_object::<D>(py, reaction.torque)?)?;
    Ok(dict)
}

fn removed_dict(py: Python<'_>, removed: Removed) -> PyResult<Bound<'_, PyDict>> {
    let dict = PyDict::new(py);
    let pieces = removed.pieces.into_iter();
    let pieces: Vec<_> = pieces
        .map(|(body, piece)| (SoftBodyHandle(body), piece.0))
        .collect();
    let soft: Vec<_> = removed
        .soft_bodies
        .into_iter()
        .map(SoftBodyHandle)
        .collect();
    let rigid: Vec<_> = removed
        .rigid_bodies
        .into_iter()
        .map(RigidBodyHandle)
        .collect();
    dict.set_item("pieces", pieces)?;
    dict.set_item("soft_bodies", soft)?;
    dict.set_item("rigid_bodies", rigid)?;
    dict.set_item("mass", removed.mass)?;
    Ok(dict)
}

fn piece_size(
    voxels: Option<usize>,
    volume: Option<f64>,
    mass: Option<f64>,
) -> PyResult<PieceSize> {
    match (voxels, volume, mass) {
        (Some(voxels), None, None) => Ok(PieceSize::Voxels(voxels)),
        (None, Some(volume), None) => Ok(PieceSize::Volume(volume)),
        (None, None, Some(mass)) => Ok(PieceSize::Mass(mass)),
        _ => {
            let text = "remove_small_pieces() takes one of voxels, volume and mass";
            Err(PyTypeError::new_err(text))
        }
    }
}

macro_rules! world_class {
    (
        $class:ident, $soft:ident, $soft_view:ident, $rigid:ident, $rigid_view:ident, $joint:ident, $shape:ident,
        $dim:ty, $dims:literal, $down:literal
    ) => {
        #[doc = concat!("World in ", $dims, "D: soft bodies, rigid bodies, joints, knives and grips. `step` advances its time.")]
        ///
        /// Units are metres, kilograms, seconds, newtons and pascals; y points up. The same calls give the same bits on
        /// every computer. In 2D, bodies are sheets 1 m deep.
        ///
        #[doc = concat!("- gravity [m/s²], default ", $down)]
        /// - drag: decay rate of all velocities [1/s], 0 to 10, default 0
        /// - max_substeps in 1/60 s, 8 to 1024, default 64
        /// - stiff_bodies: treatment of soft bodies that require more substeps: "mass_scaled" (default), "softened" or
        ///   "exact"
        /// - tick: length of a tick [s], 1/240 to 1/30, default 1/60
        /// - sleep: whether bodies at rest fall asleep, default True
        ///
        /// Methods raise `Error` for stale handles and wrong values, and then change nothing. Several threads may step
        /// different worlds at once, because `step` releases the GIL. A second call on a world that steps raises
        /// RuntimeError.
        #[pyclass(weakref, module = "fuwafuwa")]
        #[derive(Clone)]
        pub struct $class {
            /// The world.
            pub world: World<$dim>,
            /// Events of the last call of `step`, without those of its last tick.
            earlier: Vec<Event<$dim>>,
        }

        impl From<World<$dim>> for $class {
            fn from(world: World<$dim>) -> Self {
                Self { world, earlier: Vec::new() }
            }
        }

        #[pymethods]
        impl $class {
            #[new]
            #[pyo3(
                signature = (*, gravity=None, drag=None, max_substeps=None, stiff_bodies=None, tick=None, sleep=None)
            )]
            fn new(
                gravity: Option<&Any<'_>>,
                drag: Option<f32>,
                max_substeps: Option<u32>,
                stiff_bodies: Option<&str>,
                tick: Option<f32>,
                sleep: Option<bool>,
            ) -> PyResult<Self> {
                let settings = Settings { gravity, drag, max_substeps, stiff_bodies, tick, sleep };
                let config = settings.applied_to(WorldConfig::default())?;
                World::new(config).or_invalid().map(Self::from)
            }

            /// Changes settings of the world; the keywords are those of the constructor.
            #[pyo3(
                signature = (*, gravity=None, drag=None, max_substeps=None, stiff_bodies=None, tick=None, sleep=None)
            )]
            fn set_config(
                &mut self,
                gravity: Option<&Any<'_>>,
                drag: Option<f32>,
                max_substeps: Option<u32>,
                stiff_bodies: Option<&str>,
                tick: Option<f32>,
                sleep: Option<bool>,
            ) -> PyResult<()> {
                let settings = Settings { gravity, drag, max_substeps, stiff_bodies, tick, sleep };
                let config = settings.applied_to(*self.world.config())?;
                self.world.set_config(config).or_invalid()
            }

            /// Gravity [m/s²]: float32 array (d,).
            #[getter]
            fn gravity<'py>(&self, py: Python<'py>) -> Any<'py> {
                vector_array(py, self.world.config().gravity).into_any()
            }

            #[setter]
            fn set_gravity(&mut self, gravity: &Any<'_>) -> PyResult<()> {
                let gravity = vector::<$dim>("gravity", gravity)?;
                let config = WorldConfig { gravity, ..*self.world.config() };
                self.world.set_config(config).or_invalid()
            }

            /// Decay rate of all velocities [1/s].
            #[getter]
            fn drag(&self) -> f32 {
                self.world.config().drag
            }

            /// Maximum number of substeps in 1/60 s.
            #[getter]
            fn max_substeps(&self) -> u32 {
                self.world.config().max_substeps
            }

            /// Treatment of soft bodies that require more than `max_substeps`.
            #[getter]
            fn stiff_bodies(&self) -> &'static str {
                name_of(self.world.config().stiff_bodies, &STIFF_BODIES)
            }

            /// Length of a tick [s].
            #[getter]
            fn tick(&self) -> f32 {
                self.world.config().tick
            }

            /// Whether bodies at rest fall asleep.
            #[getter]
            fn sleep(&self) -> bool {
                self.world.config().sleep
            }

            /// Number of ticks since the world was created.
            #[getter]
            fn ticks(&self) -> u64 {
                self.world.ticks()
            }

            /// Time since the world was created [s]: the number of ticks times the present length of a tick.
            #[getter]
            fn time(&self) -> f64 {
                self.world.ticks() as f64 * f64::from(self.world.config().tick)
            }

            /// Number of substeps in the next tick, which the stiffest body determines.
            #[getter]
            fn substeps(&self) -> u32 {
                self.world.substeps()
            }

            /// Advances the world by `n` ticks and returns a report. Other threads run meanwhile. Targets stay the same
            /// during all ticks: a kinematic body reaches its target in the first one. An interrupt from the keyboard ends
            /// the step between two ticks.
            #[pyo3(signature = (n=1))]
            fn step(&mut self, py: Python<'_>, n: u64) -> PyResult<StepReport> {
                let mut report = StepReport::default();
                self.earlier.clear();
                let mut left = n;
                while left > 0 {
                    let ticks = left.min(TICKS_BETWEEN_SIGNALS);
                    left -= ticks;
                    let Self { world, earlier } = self;
                    let counted = &mut report;
                    py.detach(|| {
                        for tick in 1..=ticks {
                            counted.add(world.step());
                            if tick < ticks || left > 0 {
                                earlier.extend_from_slice(world.events());
                            }
                        }
                    });
                    if n > 1 {
                        py.check_signals()?;
                    }
                }
                Ok(report)
            }

            /// Returns the events of the last call of `step`, and of the actions after it: a list of dicts with the key
            /// "type" and the fields of the event.
            ///
            /// Bodies are handles. Pieces are tuples of a SoftBodyHandle and a piece number. Types: node_split,
            /// piece_detached, contact_force, contact_started, contact_ended, sensor_entered, sensor_exited, cut,
            /// joint_broke, grip_ended, fell_asleep, woke_up, piece_removed, soft_body_removed, rigid_body_removed,
            /// overlapped, left_range, quarantined, impact_slowed, stiff_body_scaled. A restored snapshot has the events
            /// of the last tick only.
            fn events<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
                let list = PyList::empty(py);
                for event in self.earlier.iter().chain(self.world.events()) {
                    list.append(event_dict(py, event)?)?;
                }
                Ok(list)
            }

            /// Returns the hash of the state: an integer of 64 bits, equal for equal worlds on every computer.
            fn hash(&self) -> u64 {
                self.world.hash()
            }

            /// Adds a copy of a soft body and returns its handle.
            fn add_soft_body(&mut self, body: $soft) -> PyResult<SoftBodyHandle> {
                self.world.add_soft_body(body.0).or_invalid().map(SoftBodyHandle)
            }

            /// Adds a rigid body and returns its handle.
            fn add_rigid_body(&mut self, body: $rigid) -> PyResult<RigidBodyHandle> {
                self.world.add_rigid_body(body.0).or_invalid().map(RigidBodyHandle)
            }

            /// Adds a joint and returns its handle. Its anchors stay attached to the points of the bodies where they are now.
            fn add_joint(&mut self, joint: $joint) -> PyResult<JointHandle> {
                self.world.add_joint(joint.0).or_invalid().map(JointHandle)
            }

            /// Attaches a knife to a kinematic or coupled rigid body and returns its handle.
            ///
            /// edge: both ends of the cutting edge in local coordinates of the holder [m]; toward: cutting direction in
            /// local coordinates; radius of the edge [m], 0 to 1, 0 = sharp; height of the blade [m], 0 to 10. In 2D, only
            /// the midpoint of the edge is used.
            #[pyo3(signature = (holder, edge, toward, *, radius=0.0, height=0.02))]
            fn add_knife(
                &mut self,
                holder: RigidBodyHandle,
                edge: &Any<'_>,
                toward: &Any<'_>,
                radius: f32,
                height: f32,
            ) -> PyResult<KnifeHandle> {
                let edge = vector_pair::<$dim>("edge", "a pair of points", edge)?;
                let toward = vector::<$dim>("toward", toward)?;
                let knife = Knife { radius, height, ..Knife::new(holder.0, edge, toward) };
                self.world.add_knife(knife).or_invalid().map(KnifeHandle)
            }

            /// Grips the nodes of a soft body inside a shape, and returns the handle of the grip.
            ///
            /// Without force and carrier, the nodes are held where they are. carrier: handle of a rigid body that carries the
            /// nodes. force: force on all nodes together [N].
            #[pyo3(signature = (body, region, *, force=None, carrier=None))]
            fn add_grip(
                &mut self,
                body: SoftBodyHandle,
                region: $shape,
                force: Option<&Any<'_>>,
                carrier: Option<RigidBodyHandle>,
            ) -> PyResult<GripHandle> {
                let drive = match (force, carrier) {
                    (None, None) => GripDrive::Still,
                    (Some(force), None) => GripDrive::Force(vector::<$dim>("force", force)?),
                    (None, Some(carrier)) => GripDrive::Carried(carrier.0),
                    (Some(_), Some(_)) => {
                        let text = "add_grip() takes force or carrier, not both";
                        return Err(PyTypeError::new_err(text));
                    }
                };
                let grip = Grip { body: body.0, region: region.0, drive };
                self.world.add_grip(grip).or_invalid().map(GripHandle)
            }

            /// Sets the force of a grip [N].
            fn set_grip_force(&mut self, grip: GripHandle, force: &Any<'_>) -> PyResult<()> {
                let force = vector::<$dim>("force", force)?;
                self.world.set_grip_force(grip.0, force).or_invalid()
            }

            /// Returns the force with which a grip held or moved its nodes in the last tick: a dict with point [m], force [N]
            /// and torque about the point [N m].
            fn grip_reaction<'py>(
                &self,
                py: Python<'py>,
                grip: GripHandle,
            ) -> PyResult<Bound<'py, PyDict>> {
                reaction_dict(py, self.world.grip(grip.0).or_invalid()?.reaction())
            }

            /// Returns the number of nodes in a grip.
            fn grip_node_count(&self, grip: GripHandle) -> PyResult<usize> {
                Ok(self.world.grip(grip.0).or_invalid()?.node_count())
            }

            /// Returns the definition of a joint as it was added.
            fn joint(&self, joint: JointHandle) -> PyResult<$joint> {
                Ok($joint(self.world.joint(joint.0).or_invalid()?.definition()))
            }

            /// Returns the force of a joint on its first anchor in the last substep [N]: float32 array (d,). The force on the
            /// second anchor is opposite.
            fn joint_reaction<'py>(&self, py: Python<'py>, joint: JointHandle) -> PyResult<Any<'py>> {
                let force = self.world.joint(joint.0).or_invalid()?.reaction();
                Ok(vector_array(py, force).into_any())
            }

            /// Returns the force of the cut material on a knife in the last substep: a dict with point, the position of the
            /// holder [m], force [N] and torque about the point [N m].
            fn knife_reaction<'py>(
                &self,
                py: Python<'py>,
                knife: KnifeHandle,
            ) -> PyResult<Bound<'py, PyDict>> {
                let knife = self.world.knife(knife.0).or_invalid()?;
                let holder = self.world.rigid_body(knife.definition().holder).or_invalid()?;
                let (point, force, torque) = (holder.position(), knife.force(), knife.torque());
                reaction_dict::<$dim>(py, ReactionForce { point, force, torque })
            }

            /// Returns the damping that acts in a soft body: a list of pairs of mass damping [1/s] and stiffness damping [s],
            /// one for each material. The substep limits stiffness damping; more substeps, larger voxels or a softer
            /// material raise the limit. In a body with a mass scale, mass damping is lower and stiffness damping higher.
            fn acting_damping(&self, body: SoftBodyHandle) -> PyResult<Vec<(f32, f32)>> {
                let dampings = self.world.acting_damping(body.0).or_invalid()?;
                Ok(dampings.iter().map(|damping| (damping.mass, damping.stiffness)).collect())
            }

            /// Returns the positions of both anchors of a joint [m]; None if an attached body was removed.
            #[allow(clippy::type_complexity)] // two arrays
            fn joint_anchors<'py>(
                &self,
                py: Python<'py>,
                joint: JointHandle,
            ) -> PyResult<Option<(Any<'py>, Any<'py>)>> {
                let anchors = self.world.joint_anchor_positions(joint.0).or_invalid()?;
                Ok(anchors.map(|[first, second]| {
                    (vector_array(py, first).into_any(), vector_array(py, second).into_any())
                }))
            }

            /// Removes a soft body, a rigid body, a joint, a knife or a grip. Returns the body or the joint as it was, and
            /// None for a knife or a grip.
            fn remove<'py>(&mut self, py: Python<'py>, handle: AnyHandle) -> PyResult<Any<'py>> {
                Ok(match handle {
                    AnyHandle::Soft(handle) => {
                        let body = self.world.remove(handle.0).or_invalid()?;
                        $soft(body).into_pyobject(py)?.into_any()
                    }
                    AnyHandle::Rigid(handle) => {
                        let body = self.world.remove(handle.0).or_invalid()?;
                        $rigid(body).into_pyobject(py)?.into_any()
                    }
                    AnyHandle::Joint(handle) => {
                        let joint = self.world.remove(handle.0).or_invalid()?;
                        $joint(joint).into_pyobject(py)?.into_any()
                    }
                    AnyHandle::Knife(handle) => {
                        self.world.remove(handle.0).or_invalid()?;
                        py.None().into_bound(py)
                    }
                    AnyHandle::Grip(handle) => {
                        self.world.remove(handle.0).or_invalid()?;
                        py.None().into_bound(py)
                    }
                })
            }

            /// Removes a piece of a soft body. Returns a dict with pieces, soft_bodies, rigid_bodies and mass [kg].
            fn remove_piece<'py>(
                &mut self,
                py: Python<'py>,
                body: SoftBodyHandle,
                piece: u32,
            ) -> PyResult<Bound<'py, PyDict>> {
                let removed = self.world.remove_piece(body.0, PieceId(piece)).or_invalid()?;
                removed_dict(py, removed)
            }

            /// Removes all pieces with fewer voxels, less volume [m³] or less mass [kg] than given. Returns a dict with
            /// pieces, soft_bodies, rigid_bodies and mass [kg].
            #[pyo3(signature = (*, voxels=None, volume=None, mass=None))]
            fn remove_small_pieces<'py>(
                &mut self,
                py: Python<'py>,
                voxels: Option<usize>,
                volume: Option<f64>,
                mass: Option<f64>,
            ) -> PyResult<Bound<'py, PyDict>> {
                let size = piece_size(voxels, volume, mass)?;
                removed_dict(py, self.world.remove_small_pieces(size).or_invalid()?)
            }

            /// Removes the pieces and dynamic rigid bodies that are outside of a shape. Returns a dict with pieces,
            /// soft_bodies, rigid_bodies and mass [kg].
            fn remove_outside<'py>(
                &mut self,
                py: Python<'py>,
                region: $shape,
            ) -> PyResult<Bound<'py, PyDict>> {
                removed_dict(py, self.world.remove_outside(&region.0).or_invalid()?)
            }

            /// Handles of all soft bodies.
            #[getter]
            fn soft_bodies(&self) -> Vec<SoftBodyHandle> {
                self.world.soft_bodies().map(|(handle, _)| SoftBodyHandle(handle)).collect()
            }

            /// Handles of all rigid bodies.
            #[getter]
            fn rigid_bodies(&self) -> Vec<RigidBodyHandle> {
                self.world.rigid_bodies().map(|(handle, _)| RigidBodyHandle(handle)).collect()
            }

            /// Handles of all joints.
            #[getter]
            fn joints(&self) -> Vec<JointHandle> {
                self.world.joints().map(|(handle, _)| JointHandle(handle)).collect()
            }

            /// Handles of all knives.
            #[getter]
            fn knives(&self) -> Vec<KnifeHandle> {
                self.world.knives().map(|(handle, _)| KnifeHandle(handle)).collect()
            }

            /// Handles of all grips.
            #[getter]
            fn grips(&self) -> Vec<GripHandle> {
                self.world.grips().map(|(handle, _)| GripHandle(handle)).collect()
            }

            /// Returns a view of a soft body.
            fn soft_body(slf: &Bound<'_, Self>, handle: SoftBodyHandle) -> PyResult<$soft_view> {
                slf.try_borrow()?.world.soft_body(handle.0).or_invalid()?;
                Ok($soft_view::new(slf.clone().unbind(), handle.0))
            }

            /// Returns a view of a rigid body.
            fn rigid_body(slf: &Bound<'_, Self>, handle: RigidBodyHandle) -> PyResult<$rigid_view> {
                slf.try_borrow()?.world.rigid_body(handle.0).or_invalid()?;
                Ok($rigid_view::new(slf.clone().unbind(), handle.0))
            }

            fn __getitem__<'py>(slf: &Bound<'py, Self>, handle: &Any<'py>) -> PyResult<Any<'py>> {
                let py = slf.py();
                let Ok(body) = handle.extract::<AnyBody>() else {
                    return Err(PyKeyError::new_err("expected a SoftBodyHandle or a RigidBodyHandle"));
                };
                Ok(match body {
                    AnyBody::Soft(body) => Self::soft_body(slf, body)?.into_pyobject(py)?.into_any(),
                    AnyBody::Rigid(body) => {
                        Self::rigid_body(slf, body)?.into_pyobject(py)?.into_any()
                    }
                })
            }

            fn __contains__(&self, handle: AnyHandle) -> bool {
                match handle {
                    AnyHandle::Soft(handle) => self.world.soft_body(handle.0).is_ok(),
                    AnyHandle::Rigid(handle) => self.world.rigid_body(handle.0).is_ok(),
                    AnyHandle::Joint(handle) => self.world.joint(handle.0).is_ok(),
                    AnyHandle::Knife(handle) => self.world.knife(handle.0).is_ok(),
                    AnyHandle::Grip(handle) => self.world.grip(handle.0).is_ok(),
                }
            }

            /// Sets the position that a kinematic body reaches in the next tick, or to which a coupled body is pulled [m].
            fn set_target_position(
                &mut self,
                body: RigidBodyHandle,
                position: &Any<'_>,
            ) -> PyResult<()> {
                let position = vector::<$dim>("position", position)?;
                self.world.set_target_position(body.0, position).or_invalid()
            }

            /// Sets the rotation that a kinematic or coupled body reaches in the next tick: an angle [rad] in 2D, a
            /// quaternion x, y, z, w or a rotation vector in 3D.
            fn set_target_rotation(
                &mut self,
                body: RigidBodyHandle,
                rotation: &Any<'_>,
            ) -> PyResult<()> {
                let rotation = self::rotation::<$dim>(Some(rotation))?;
                self.world.set_target_rotation(body.0, rotation).or_invalid()
            }

            /// Sets the position [m] and the rotation of a rigid body immediately.
            #[pyo3(signature = (body, position, rotation=None))]
            fn set_pose(
                &mut self,
                body: RigidBodyHandle,
                position: &Any<'_>,
                rotation: Option<&Any<'_>>,
            ) -> PyResult<()> {
                let position = vector::<$dim>("position", position)?;
                let rotation = match rotation {
                    None => self.world.rigid_body(body.0).or_invalid()?.rotation(),
                    given => self::rotation::<$dim>(given)?,
                };
                self.world.set_pose(body.0, position, rotation).or_invalid()
            }

            /// Translates a body by a vector [m] immediately; obstacles do not stop it.
            fn translate(&mut self, body: AnyBody, by: &Any<'_>) -> PyResult<()> {
                let by = vector::<$dim>("by", by)?;
                self.world.translate(BodyHandle::from(body), by).or_invalid()
            }

            /// Rotates a body and its velocities about a point [m] immediately; obstacles do not stop it.
            fn rotate_about(
                &mut self,
                body: AnyBody,
                rotation: &Any<'_>,
                point: &Any<'_>,
            ) -> PyResult<()> {
                let rotation = self::rotation::<$dim>(Some(rotation))?;
                let point = vector::<$dim>("point", point)?;
                self.world.rotate_about(BodyHandle::from(body), rotation, point).or_invalid()
            }

            /// Returns the velocity of a body: linear [m/s], and angular [rad/s] (a number in 2D, a vector in 3D). For a soft
            /// body, that of the rigid motion with the same momentum.
            fn velocity<'py>(
                &self,
                py: Python<'py>,
                body: AnyBody,
            ) -> PyResult<(Any<'py>, Any<'py>)> {
                let velocity = self.world.velocity(BodyHandle::from(body)).or_invalid()?;
                let angular = angular_object::<$dim>(py, velocity.angular)?;
                Ok((vector_array(py, velocity.linear).into_any(), angular))
            }

            /// Sets the velocity of a soft body or a dynamic rigid body: linear [m/s], and angular [rad/s] (a number in 2D, a
            /// vector in 3D). In a soft body, this ends all vibration.
            #[pyo3(signature = (body, linear=None, angular=None))]
            fn set_velocity(
                &mut self,
                body: AnyBody,
                linear: Option<&Any<'_>>,
                angular: Option<&Any<'_>>,
            ) -> PyResult<()> {
                let velocity = velocity::<$dim>(linear, angular)?;
                self.world.set_velocity(BodyHandle::from(body), velocity).or_invalid()
            }

            /// Adds a velocity to that of a soft body or a dynamic rigid body.
            #[pyo3(signature = (body, linear=None, angular=None))]
            fn add_velocity(
                &mut self,
                body: AnyBody,
                linear: Option<&Any<'_>>,
                angular: Option<&Any<'_>>,
            ) -> PyResult<()> {
                let velocity = velocity::<$dim>(linear, angular)?;
                self.world.add_velocity(BodyHandle::from(body), velocity).or_invalid()
            }

            /// Applies an impulse [N s] at a point [m] of a soft body or a dynamic rigid body. A soft body takes it at the
            /// nodes within `radius` [m] of the point.
            #[pyo3(signature = (body, point, impulse, radius=0.0))]
            fn apply_impulse(
                &mut self,
                body: AnyBody,
                point: &Any<'_>,
                impulse: &Any<'_>,
                radius: f32,
            ) -> PyResult<()> {
                let point = vector::<$dim>("point", point)?;
                let impulse = vector::<$dim>("impulse", impulse)?;
                let impulse = Impulse { point, impulse, radius };
                self.world.apply_impulse(BodyHandle::from(body), impulse).or_invalid()
            }

            /// Changes the motion type of a rigid body: "fixed", "kinematic", "coupled" or "dynamic". mass [kg] is required
            /// for dynamic bodies (default of coupled ones: 2). stiffness [N/m], damping ratio and max_force [N] are those of
            /// coupled bodies.
            #[pyo3(signature = (body, motion, *, mass=None, stiffness=3000.0, damping=0.9, max_force=1000.0))]
            fn set_motion(
                &mut self,
                body: RigidBodyHandle,
                motion: &str,
                mass: Option<f32>,
                stiffness: f32,
                damping: f32,
                max_force: f32,
            ) -> PyResult<()> {
                let motion = motion_type(motion, mass, stiffness, damping, max_force)?;
                self.world.set_motion_type(body.0, motion).or_invalid()
            }

            /// Sets the Coulomb friction coefficient of a rigid body, 0 or more.
            fn set_friction(&mut self, body: RigidBodyHandle, friction: f32) -> PyResult<()> {
                self.world.set_friction(body.0, friction).or_invalid()
            }

            /// Sets the coefficient of restitution of a rigid body, 0 to 1.
            fn set_restitution(&mut self, body: RigidBodyHandle, restitution: f32) -> PyResult<()> {
                self.world.set_restitution(body.0, restitution).or_invalid()
            }

            /// Sets whether a rigid body only reports what enters it.
            fn set_sensor(&mut self, body: RigidBodyHandle, is_sensor: bool) -> PyResult<()> {
                self.world.set_sensor(body.0, is_sensor).or_invalid()
            }

            /// Sets the layers of a body: bit masks of memberships and filters.
            fn set_layers(
                &mut self,
                body: AnyBody,
                memberships: u32,
                filters: u32,
            ) -> PyResult<()> {
                let layers = Layers { memberships, filters };
                self.world.set_layers(BodyHandle::from(body), layers).or_invalid()
            }

            /// Sets the number of the program of a body.
            fn set_user_data(&mut self, body: AnyBody, user_data: u64) -> PyResult<()> {
                self.world.set_user_data(BodyHandle::from(body), user_data).or_invalid()
            }

            /// Sets the factor on gravity of a soft body, -100 to 100, default 1.
            fn set_gravity_scale(&mut self, body: SoftBodyHandle, scale: f32) -> PyResult<()> {
                self.world.set_gravity_scale(body.0, scale).or_invalid()
            }

            /// Wakes a body.
            fn wake_up(&mut self, body: AnyBody) -> PyResult<()> {
                self.world.wake_up(BodyHandle::from(body)).or_invalid()
            }

            /// Puts a body to sleep.
            fn put_to_sleep(&mut self, body: AnyBody) -> PyResult<()> {
                self.world.put_to_sleep(BodyHandle::from(body)).or_invalid()
            }

            /// Returns the contact force and torque on a rigid body, a soft body or a piece in the last tick: a dict with
            /// point [m], force [N] and torque about the point [N m].
            fn reaction<'py>(
                &self,
                py: Python<'py>,
                object: &Any<'_>,
            ) -> PyResult<Bound<'py, PyDict>> {
                let object = selector("object", object)?;
                reaction_dict(py, self.world.reaction(object).or_invalid()?)
            }

            /// Returns the force and torque that hold the fixed nodes of a soft body inside a shape: a dict with point [m],
            /// force [N] and torque about the point [N m].
            fn fixed_node_reaction<'py>(
                &self,
                py: Python<'py>,
                body: SoftBodyHandle,
                region: $shape,
            ) -> PyResult<Bound<'py, PyDict>> {
                let reaction = self.world.fixed_node_reaction(body.0, &region.0);
                reaction_dict(py, reaction.or_invalid()?)
            }

            /// Returns the contacts of a rigid body, a soft body or a piece: a list of dicts, like the events
            /// "contact_force".
            fn contacts_of<'py>(
                &self,
                py: Python<'py>,
                object: &Any<'_>,
            ) -> PyResult<Bound<'py, PyList>> {
                let list = PyList::empty(py);
                for contact in self.world.contacts_of(selector("object", object)?).or_invalid()? {
                    list.append(contact_dict(py, contact)?)?;
                }
                Ok(list)
            }

            /// Returns the first object that a ray hits within `max_distance` [m], or None: a dict with object, element (id),
            /// material, point [m], normal and distance [m].
            ///
            /// The queries have the same filters. exclude: a body, a piece, or a list of them; only: "soft" or "rigid";
            /// layers: bit masks of memberships and filters, which the layers of an object must meet; sensors: whether
            /// sensors count; predicate: function that gets an object (a handle of a rigid body, or a tuple of a handle of
            /// a soft body and a piece number) and returns whether it counts. It may read the world, and it may be called
            /// several times for an object.
            #[pyo3(
                signature = (origin, direction, max_distance=f32::INFINITY, *, exclude=None, only=None, layers=None,
                    sensors=false, predicate=None),
                text_signature = "($self, origin, direction, max_distance=1e999, *, exclude=None, only=None, layers=None, \
                    sensors=False, predicate=None)"
            )]
            #[allow(clippy::too_many_arguments)] // keyword arguments of Python
            fn ray_cast<'py>(
                &self,
                py: Python<'py>,
                origin: &Any<'_>,
                direction: &Any<'_>,
                max_distance: f32,
                exclude: Option<&Any<'_>>,
                only: Option<&str>,
                layers: Option<LayerMasks>,
                sensors: bool,
                predicate: Option<&Any<'_>>,
            ) -> PyResult<Option<Bound<'py, PyDict>>> {
                let origin = vector::<$dim>("origin", origin)?;
                let ray = Ray::new(origin, vector::<$dim>("direction", direction)?);
                query::check_distance(max_distance)?;
                let selection = Selection { exclude, only, layers, sensors, predicate };
                let hit = selection.run(|filter| self.world.ray_cast(ray, max_distance, filter))?;
                hit.map(|hit| query::hit(py, &hit)).transpose()
            }

            /// Returns the point of a surface that is closest to a point, within `max_distance` [m], or None: a dict with
            /// object, element (id), material, point [m], normal and distance [m]. The filters are those of `ray_cast`.
            #[pyo3(
                signature = (point, max_distance=f32::INFINITY, *, exclude=None, only=None, layers=None, sensors=false,
                    predicate=None),
                text_signature = "($self, point, max_distance=1e999, *, exclude=None, only=None, layers=None, \
                    sensors=False, predicate=None)"
            )]
            #[allow(clippy::too_many_arguments)] // keyword arguments of Python
            fn closest_point<'py>(
                &self,
                py: Python<'py>,
                point: &Any<'_>,
                max_distance: f32,
                exclude: Option<&Any<'_>>,
                only: Option<&str>,
                layers: Option<LayerMasks>,
                sensors: bool,
                predicate: Option<&Any<'_>>,
            ) -> PyResult<Option<Bound<'py, PyDict>>> {
                let point = vector::<$dim>("point", point)?;
                query::check_distance(max_distance)?;
                let selection = Selection { exclude, only, layers, sensors, predicate };
                let hit = selection.run(|filter| self.world.closest_point(point, max_distance, filter))?;
                hit.map(|hit| query::hit(py, &hit)).transpose()
            }

            /// Returns the objects that contain a point: a list of dicts with object, element (id) and material. The filters
            /// are those of `ray_cast`.
            #[pyo3(signature = (point, *, exclude=None, only=None, layers=None, sensors=false, predicate=None))]
            #[allow(clippy::too_many_arguments)] // keyword arguments of Python
            fn objects_at<'py>(
                &self,
                py: Python<'py>,
                point: &Any<'_>,
                exclude: Option<&Any<'_>>,
                only: Option<&str>,
                layers: Option<LayerMasks>,
                sensors: bool,
                predicate: Option<&Any<'_>>,
            ) -> PyResult<Bound<'py, PyList>> {
                let point = vector::<$dim>("point", point)?;
                let selection = Selection { exclude, only, layers, sensors, predicate };
                let found = selection.run(|filter| self.world.objects_at(point, filter))?;
                query::overlaps(py, &found)
            }

            /// Returns the objects that overlap a shape: a list of dicts with object, element (id) and material. The filters
            /// are those of `ray_cast`.
            #[pyo3(signature = (shape, *, exclude=None, only=None, layers=None, sensors=false, predicate=None))]
            #[allow(clippy::too_many_arguments)] // keyword arguments of Python
            fn overlaps<'py>(
                &self,
                py: Python<'py>,
                shape: $shape,
                exclude: Option<&Any<'_>>,
                only: Option<&str>,
                layers: Option<LayerMasks>,
                sensors: bool,
                predicate: Option<&Any<'_>>,
            ) -> PyResult<Bound<'py, PyList>> {
                let selection = Selection { exclude, only, layers, sensors, predicate };
                let found = selection.run(|filter| self.world.overlaps(&shape.0, filter))?;
                query::overlaps(py, &found.or_invalid()?)
            }

            /// Returns the state as bytes, for `restore`.
            fn snapshot<'py>(&self, py: Python<'py>) -> Bound<'py, PyBytes> {
                let world = &self.world;
                PyBytes::new(py, &py.detach(|| snapshot::save(world)))
            }

            /// Returns the world of a snapshot. It has the same hash and goes on with the same bits.
            #[staticmethod]
            fn restore(py: Python<'_>, snapshot: &[u8]) -> PyResult<Self> {
                let world = py.detach(|| fuwafuwa::snapshot::load::<$dim>(snapshot));
                world.or_invalid().map(Self::from)
            }

            /// Returns a copy, which shares the mesh with this world until either tears. Handles are valid in both.
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
                let restore = py.get_type::<Self>().getattr("restore")?;
                Ok((restore, (self.snapshot(py),)))
            }

            /// Returns a scene that describes the present state of the world. A world that was not stepped since it was built
            /// is rebuilt with the same hash. Contacts, events, sleep timers and the number of ticks are not included: use
            /// `snapshot` to go on with the same bits.
            fn to_scene(&self) -> PyResult<Scene> {
                Scene::of_world(&self.world)
            }

            /// Low and high corner of the region that a picture shows by default [m]: that of all bodies, with a margin.
            #[getter]
            fn view<'py>(&self, py: Python<'py>) -> (Any<'py>, Any<'py>) {
                let [low, high] = view_of(&self.world);
                (vector_array(py, low).into_any(), vector_array(py, high).into_any())
            }

            /// Returns a picture as an array: uint8 (height, width, 3), red, green and blue, the top row first.
            ///
            /// view: low and high corner of the visible region [m], by default that of all bodies; width [pixels], 16 to
            /// 4096; elements: whether the elements are shown instead of the surface. The height follows from the view
            /// in 2D; in 3D, the picture is a square. Painted without a GPU.
            #[pyo3(signature = (*, view=None, width=480, elements=false))]
            fn rgb<'py>(
                &self,
                py: Python<'py>,
                view: Option<&Any<'_>>,
                width: u32,
                elements: bool,
            ) -> PyResult<Any<'py>> {
                let options = PictureOptions::<$dim>::new(view, width, elements)?;
                let world = &self.world;
                let pixels = py.detach(|| options.paint(world).map(|image| rgb(&image)));
                Ok(pixels.or_invalid()?.into_pyarray(py).into_any())
            }

            /// Returns a picture as a PNG file. The keywords are those of `rgb`.
            #[pyo3(signature = (*, view=None, width=480, elements=false))]
            fn png<'py>(
                &self,
                py: Python<'py>,
                view: Option<&Any<'_>>,
                width: u32,
                elements: bool,
            ) -> PyResult<Bound<'py, PyBytes>> {
                let options = PictureOptions::<$dim>::new(view, width, elements)?;
                let world = &self.world;
                let png = py.detach(|| png_of(&options.paint(world)?)).or_invalid()?;
                Ok(PyBytes::new(py, &png))
            }

            fn _repr_png_<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
                self.png(py, None, 480, false)
            }

            /// Writes a picture into a PNG file. The keywords are those of `rgb`.
            #[pyo3(signature = (path, *, view=None, width=480, elements=false))]
            fn save_png(
                &self,
                py: Python<'_>,
                path: PathBuf,
                view: Option<&Any<'_>>,
                width: u32,
                elements: bool,
            ) -> PyResult<()> {
                let png = self.png(py, view, width, elements)?;
                let written = std::fs::write(&path, png.as_bytes());
                written.map_err(|error| file_error(&path, &error))
            }

            /// Draws the world with matplotlib and returns the axes.
            ///
            /// ax: axes to draw into, by default new ones; color: "material" (default), "strain", "damage" or "piece";
            /// cmap: colour map of strain and damage; vmin and vmax: range of the colours. Raises ImportError without
            /// matplotlib.
            #[pyo3(signature = (ax=None, *, color="material", cmap="viridis", vmin=None, vmax=None))]
            fn plot<'py>(
                slf: &Bound<'py, Self>,
                ax: Option<&Any<'py>>,
                color: &str,
                cmap: &str,
                vmin: Option<f64>,
                vmax: Option<f64>,
            ) -> PyResult<Any<'py>> {
                let plot = slf.py().import("fuwafuwa._plot")?.getattr("plot")?;
                plot.call1((slf, ax, color, cmap, vmin, vmax))
            }

            fn __repr__(&self) -> String {
                let (soft, rigid) = (self.world.soft_bodies().count(), self.world.rigid_bodies().count());
                format!(
                    "<{} at {:.3} s: {soft} soft and {rigid} rigid bodies>",
                    stringify!($class),
                    self.time()
                )
            }
        }
    };
}

world_class!(
    World2,
    SoftBody2,
    SoftBodyView2,
    RigidBody2,
    RigidBodyView2,
    Joint2,
    Shape2,
    Dim2,
    "2",
    "(0, -9.81)"
);
world_class!(
    World3,
    SoftBody3,
    SoftBodyView3,
    RigidBody3,
    RigidBodyView3,
    Joint3,
    Shape3,
    Dim3,
    "3",
    "(0, -9.81, 0)"
);

#[pymethods]
impl World2 {
    /// Cuts a soft body along a segment between two points [m]. Returns the number of nodes that were split.
    fn cut(&mut self, body: SoftBodyHandle, start: &Any<'_>, end: &Any<'_>) -> PyResult<usize> {
        let blade = Blade::segment(vector::<Dim2>("start", start)?, vector::<Dim2>("end", end)?);
        self.world.cut(body.0, &blade).or_invalid()
    }
}

#[pymethods]
impl World3 {
    /// Cuts a soft body along a parallelogram, which a corner [m] and two edge vectors [m] span. Returns the number of
    /// nodes that were split.
    fn cut(
        &mut self,
        body: SoftBodyHandle,
        corner: &Any<'_>,
        first: &Any<'_>,
        second: &Any<'_>,
    ) -> PyResult<usize> {
        let corner = vector::<Dim3>("corner", corner)?;
        let (first, second) = (
            vector::<Dim3>("first", first)?,
            vector::<Dim3>("second", second)?,
        );
        let blade = Blade::parallelogram(corner, first, second);
        self.world.cut(body.0, &blade).or_invalid()
    }
}
