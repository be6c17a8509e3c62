//! Position, rotation and velocity of a body as a whole, as a `Transform` expresses them.

use crate::component::Velocity;
use crate::convert::{bevy_vector, engine_rotation, engine_vector};
use crate::problem::Problem;
use bevy_math::{Mat3, Quat, Vec3};
use bevy_transform::components::Transform;
use fuwafuwa::{Dim, DimVector, NodeId, Shape, SoftBody, VoxelGrid};

/// Maximum number of iterations that determine the rotation of a body. If the rotation changed little since
/// the last tick, one or two suffice.
const ROUNDS: usize = 20;
/// Convergence tolerance of the rotation [rad].
const NEAR: f32 = 1e-6;

/// Position of the origin of a body, its rotation and scale.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Pose {
    /// Translation [m].
    pub translation: Vec3,
    pub rotation: Quat,
    pub scale: f32,
}

/// Pose and velocity of a body as a whole.
#[derive(Copy, Clone, Debug)]
pub struct Motion {
    pub pose: Pose,
    pub velocity: Velocity,
}

impl Pose {
    /// Converts a transform to a pose. Returns the reason if the transform is invalid for a body.
    pub fn of(transform: &Transform) -> Result<Self, Problem> {
        let Transform {
            translation,
            rotation,
            scale,
        } = *transform;
        if !translation.is_finite() {
            return Err(Problem::InvalidTransform("have a finite translation"));
        }
        if !rotation.is_finite() || rotation.length_squared() < 1e-6 {
            return Err(Problem::InvalidTransform(
                "have a finite, non-zero rotation",
            ));
        }
        let is_even = scale == Vec3::splat(scale.x);
        if !is_even || !scale.x.is_finite() || scale.x <= 0.0 {
            return Err(Problem::InvalidTransform(
                "scale by the same factor on all axes, positive and finite",
            ));
        }
        Ok(Self {
            translation,
            rotation: rotation.normalize(),
            scale: scale.x,
        })
    }

    pub fn transform(&self) -> Transform {
        Transform {
            translation: self.translation,
            rotation: self.rotation,
            scale: Vec3::splat(self.scale),
        }
    }

    /// Converts a point from world space [m] to the frame of the body.
    pub fn local(&self, at: Vec3) -> Vec3 {
        self.rotation.inverse() * (at - self.translation) / self.scale
    }

    /// Moves a new body to this pose, so that the middle of its grid is at the translation. The grid must
    /// already be scaled.
    pub fn place<D: Dim>(&self, body: SoftBody<D>) -> SoftBody<D> {
        let middle = middle(body.grid());
        body.translated(engine_vector(-middle))
            .rotated_about(engine_rotation(self.rotation), D::Vector::ZERO)
            .translated(engine_vector(self.translation))
    }

    /// Scales a shape by the scale of the pose, without rotation or translation.
    pub fn scaled<D: Dim>(&self, shape: Shape<D>) -> Shape<D> {
        let scale = self.scale;
        match shape {
            Shape::HalfSpace { normal, offset } => Shape::HalfSpace {
                normal,
                offset: offset * scale,
            },
            Shape::Ball { centre, radius } => Shape::Ball {
                centre: centre * scale,
                radius: radius * scale,
            },
            Shape::Capsule { from, to, radius } => Shape::Capsule {
                from: from * scale,
                to: to * scale,
                radius: radius * scale,
            },
            Shape::Box { centre, half } => Shape::Box {
                centre: centre * scale,
                half: half * scale,
            },
            Shape::OrientedBox {
                centre,
                half,
                rotation,
            } => Shape::OrientedBox {
                centre: centre * scale,
                half: half * scale,
                rotation,
            },
        }
    }
}

/// Returns pose and velocity of a body. The pose is the rigid motion from rest that best fits the nodes of
/// the largest piece, weighted by mass. The rotation is found iteratively, starting from `before` [Mueller
/// 2016]. The velocity is that of the whole body, all pieces together.
pub fn motion_of<D: Dim>(body: &SoftBody<D>, before: Pose) -> Motion {
    let (size, middle) = (body.grid().voxel_size(), middle(body.grid()));
    let nodes = || body.mesh().nodes();
    let pieces = body.pieces();
    let mut masses = vec![0.0; pieces.list.len()];
    for (id, _) in nodes() {
        masses[pieces.of_node(id).index()] += body.node_state(id).2;
    }
    // Selects the first of several pieces with the largest mass, so that the result does not alternate
    // between two equal halves.
    let most = masses.iter().fold(0.0f32, |most, &mass| most.max(mass));
    let largest = masses.iter().position(|&mass| mass == most).unwrap_or(0);

    let own = || nodes().filter(|(id, _)| pieces.of_node(*id).index() == largest);
    let state = |id: NodeId| {
        let (at, _, mass) = body.node_state(id);
        (bevy_vector(at), mass)
    };
    let rest = |at: [i32; 3]| Vec3::from(at.map(|k| k as f32 * size)) - middle;
    let (mut centre, mut rest_centre) = (Vec3::ZERO, Vec3::ZERO);
    for (id, node) in own() {
        let (at, mass) = state(id);
        centre += mass / most * at;
        rest_centre += mass / most * rest(node.at);
    }
    let mut moment = Mat3::ZERO;
    for (id, node) in own() {
        let (at, mass) = state(id);
        let (lever, arm) = (at - centre, rest(node.at) - rest_centre);
        moment += Mat3::from_cols(lever * arm.x, lever * arm.y, lever * arm.z) * mass;
    }
    let rotation = nearest_rotation(moment, before.rotation);
    Motion {
        pose: Pose {
            translation: centre - rotation * rest_centre,
            rotation,
            scale: before.scale,
        },
        velocity: velocity_of(body),
    }
}

/// Returns the middle of the grid, relative to its low corner [m].
fn middle<D: Dim>(grid: &VoxelGrid<D>) -> Vec3 {
    let size = grid.size().map(|k| 0.5 * k as f32 * grid.voxel_size());
    match D::N {
        2 => Vec3::new(size[0], size[1], 0.0),
        _ => size.into(),
    }
}

/// Returns the rotation R that maximises tr(Rᵀ A), with A = `moment`. Each iteration rotates R by the torque
/// with which the columns of A pull on the columns of R, until the torque vanishes.
fn nearest_rotation(moment: Mat3, before: Quat) -> Quat {
    let mut rotation = before;
    for _ in 0..ROUNDS {
        let own = Mat3::from_quat(rotation);
        let torque = own.x_axis.cross(moment.x_axis)
            + own.y_axis.cross(moment.y_axis)
            + own.z_axis.cross(moment.z_axis);
        let hold = own.x_axis.dot(moment.x_axis)
            + own.y_axis.dot(moment.y_axis)
            + own.z_axis.dot(moment.z_axis);
        let turn = torque / hold.abs().max(f32::MIN_POSITIVE);
        let angle = turn.length();
        if !angle.is_finite() || angle < NEAR {
            break;
        }
        // Limits the rotation of one iteration to about a quarter turn, so that the iteration does not
        // overshoot.
        let by = Quat::from_axis_angle(turn / angle, angle.min(1.5));
        rotation = (by * rotation).normalize();
    }
    rotation
}

/// Returns the velocity of a whole body. A linear or angular velocity that is not finite is replaced by zero.
fn velocity_of<D: Dim>(body: &SoftBody<D>) -> Velocity {
    let centre = bevy_vector(body.centre_of_mass());
    let (mut mass, mut linear, mut spin) = (0.0, Vec3::ZERO, Vec3::ZERO);
    let mut inertia = Mat3::ZERO;
    for (id, _) in body.mesh().nodes() {
        let (at, velocity, own) = body.node_state(id);
        let (lever, velocity) = (bevy_vector(at) - centre, bevy_vector(velocity));
        mass += own;
        linear += own * velocity;
        spin += own * lever.cross(velocity);
        let outer = Mat3::from_cols(lever * lever.x, lever * lever.y, lever * lever.z);
        inertia += own * (lever.length_squared() * Mat3::IDENTITY - outer);
    }
    let angular = match D::N {
        2 => Vec3::Z * (spin.z / inertia.z_axis.z),
        _ => inertia.inverse() * spin,
    };
    let known = |vector: Vec3| {
        if vector.is_finite() {
            vector
        } else {
            Vec3::ZERO
        }
    };
    Velocity {
        linear: known(linear / mass),
        angular: known(angular),
    }
}
