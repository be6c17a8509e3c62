//! Events, contacts and the report of a step.

use crate::convert::{angular_object, vector_array};
use crate::handle::{
    GripHandle, JointHandle, KnifeHandle, RigidBodyHandle, SoftBodyHandle, object,
};
use fuwafuwa::{Contact, Dim, Event, ObjectRef, PieceId};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

/// Dict that is filled by chained calls.
struct Fields<'py>(Bound<'py, PyDict>);

impl<'py> Fields<'py> {
    fn new(py: Python<'py>, kind: &str) -> PyResult<Self> {
        Self(PyDict::new(py)).with("type", kind)
    }

    fn with(self, name: &str, value: impl IntoPyObject<'py>) -> PyResult<Self> {
        self.0.set_item(name, value)?;
        Ok(self)
    }

    fn piece(self, body: fuwafuwa::SoftBodyHandle, piece: PieceId) -> PyResult<Self> {
        self.with("body", SoftBodyHandle(body))?
            .with("piece", piece.0)
    }
}

fn pair(py: Python<'_>, pair: [ObjectRef; 2]) -> PyResult<Bound<'_, PyTuple>> {
    let [first, second] = pair;
    PyTuple::new(py, [object(py, first)?, object(py, second)?])
}

fn with_contact<'py, D: Dim>(
    py: Python<'py>,
    fields: Fields<'py>,
    contact: &Contact<D>,
) -> PyResult<Fields<'py>> {
    fields
        .with("pair", pair(py, contact.pair)?)?
        .with("point", vector_array(py, contact.point))?
        .with("normal", vector_array(py, contact.normal))?
        .with("speed", contact.speed)?
        .with("impulse", contact.impulse)?
        .with("force", vector_array(py, contact.force))?
        .with("torque", angular_object::<D>(py, contact.torque)?)
}

/// Returns a contact as a dict.
pub fn contact_dict<'py, D: Dim>(
    py: Python<'py>,
    contact: &Contact<D>,
) -> PyResult<Bound<'py, PyDict>> {
    Ok(with_contact(py, Fields(PyDict::new(py)), contact)?.0)
}

/// Returns an event as a dict with the key `type`.
pub fn event_dict<'py, D: Dim>(py: Python<'py>, event: &Event<D>) -> PyResult<Bound<'py, PyDict>> {
    let new = |kind| Fields::new(py, kind);
    let fields = match *event {
        Event::NodeSplit {
            body,
            point,
            energy,
        } => new("node_split")?
            .with("body", SoftBodyHandle(body))?
            .with("point", vector_array(py, point))?
            .with("energy", energy)?,
        Event::PieceDetached { body, piece } => new("piece_detached")?.piece(body, piece)?,
        Event::ContactForce(contact) => with_contact(py, new("contact_force")?, &contact)?,
        Event::ContactStarted(contact) => with_contact(py, new("contact_started")?, &contact)?,
        Event::ContactEnded { pair: objects } => {
            new("contact_ended")?.with("pair", pair(py, objects)?)?
        }
        Event::SensorEntered {
            sensor,
            object: entered,
        } => new("sensor_entered")?
            .with("sensor", RigidBodyHandle(sensor))?
            .with("object", object(py, entered)?)?,
        Event::SensorExited {
            sensor,
            object: exited,
        } => new("sensor_exited")?
            .with("sensor", RigidBodyHandle(sensor))?
            .with("object", object(py, exited)?)?,
        Event::Cut {
            knife,
            body,
            point,
            area,
            work,
        } => new("cut")?
            .with("knife", KnifeHandle(knife))?
            .with("body", SoftBodyHandle(body))?
            .with("point", vector_array(py, point))?
            .with("area", area)?
            .with("work", work)?,
        Event::JointBroke { joint } => new("joint_broke")?.with("joint", JointHandle(joint))?,
        Event::GripEnded { grip } => new("grip_ended")?.with("grip", GripHandle(grip))?,
        Event::FellAsleep { body, piece } => new("fell_asleep")?.piece(body, piece)?,
        Event::WokeUp { body, piece } => new("woke_up")?.piece(body, piece)?,
        Event::PieceRemoved { body, piece } => new("piece_removed")?.piece(body, piece)?,
        Event::SoftBodyRemoved { body } => {
            new("soft_body_removed")?.with("body", SoftBodyHandle(body))?
        }
        Event::RigidBodyRemoved { body } => {
            new("rigid_body_removed")?.with("body", RigidBodyHandle(body))?
        }
        Event::Overlapped {
            pair: objects,
            depth,
        } => new("overlapped")?
            .with("pair", pair(py, objects)?)?
            .with("depth", depth)?,
        Event::LeftRange { object: left } => {
            new("left_range")?.with("object", object(py, left)?)?
        }
        Event::Quarantined { body, piece } => new("quarantined")?.piece(body, piece)?,
        Event::ImpactSlowed { body, piece, share } => new("impact_slowed")?
            .piece(body, piece)?
            .with("share", share)?,
        Event::StiffBodyScaled {
            body,
            mass_scale,
            stiffness_scale,
        } => new("stiff_body_scaled")?
            .with("body", SoftBodyHandle(body))?
            .with("mass_scale", mass_scale)?
            .with("stiffness_scale", stiffness_scale)?,
        _ => new("unknown")?.with("text", format!("{event:?}"))?,
    };
    Ok(fields.0)
}

/// Report of `step`: sums over its ticks, except where a field says otherwise.
#[pyclass(frozen, get_all, eq, module = "fuwafuwa")]
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub struct StepReport {
    /// Number of ticks.
    ticks: u64,
    /// Number of substeps.
    substeps: u64,
    /// Number of nodes that were split.
    nodes_split: u64,
    /// Number of pieces that were detached.
    pieces_detached: u64,
    /// Number of elements that are turned inside out at the end of the last tick.
    inverted: u32,
    /// Number of pieces in impacts that were too fast for the substeps, counted once in each tick.
    slowed_impacts: u64,
    /// Number of nodes, summed over the substeps, whose speed was limited to a voxel per substep.
    speed_limited: u64,
    /// Number of pieces that became non-finite or too fast and were frozen permanently.
    quarantined: u64,
    /// Number of soft bodies with less stiffness damping than their materials specify, in the last tick.
    damping_limited: u32,
    /// Number of soft bodies whose mass or stiffness is scaled, in the last tick.
    scaled_bodies: u32,
    /// Largest scale of a soft body in the last tick; 1 if no body is scaled.
    largest_scale: f32,
}

impl StepReport {
    /// Adds the report of a tick.
    pub fn add(&mut self, tick: fuwafuwa::StepReport) {
        self.ticks += 1;
        self.substeps += u64::from(tick.substeps);
        self.nodes_split += u64::from(tick.nodes_split);
        self.pieces_detached += u64::from(tick.pieces_detached);
        self.inverted = tick.inverted;
        self.slowed_impacts += u64::from(tick.slowed_impacts);
        self.speed_limited += u64::from(tick.speed_limited);
        self.quarantined += u64::from(tick.quarantined);
        self.damping_limited = tick.damping_limited;
        self.scaled_bodies = tick.scaled_bodies;
        self.largest_scale = tick.largest_scale;
    }
}

#[pymethods]
impl StepReport {
    fn __repr__(&self) -> String {
        let text = format!("{self:?}");
        text.replace(" { ", "(")
            .replace(" }", ")")
            .replace(": ", "=")
    }
}
