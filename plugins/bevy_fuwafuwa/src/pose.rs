//! Position, rotation and velocity of a body as a whole, as a `Transform` expresses them.

use crate::problem::Problem;
use bevy_math::{Mat3, Quat, Vec3};
use bevy_transform::components::Transform;
use fuwafuwa::{Dim, NodeId, Rotation, Shape, SoftBody, VoxelGrid};

/// Maximum number of iterations for the rotation. If it changed little since the last tick, one or two
/// suffice.
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
    /// Velocity of the centre of mass [m/s].
    pub linear: Vec3,
    /// Angular velocity about the centre of mass [rad/s].
    pub angular: Vec3,
}

impl Pose {
    /// Converts a transform, or returns the reason why it is invalid for a body.
    pub fn of(transform: &Transform) -> Result<Self, Problem> {
        let Transform {
            translation,
            rotation,
            scale,
        } = *transform;
        if !translation.is_finite() {
            return Err(Problem::Pose("have a finite translation"));
        }
        if !rotation.is_finite() || rotation.length_squared() < 1e-6 {
            return Err(Problem::Pose("have a finite, non-zero rotation"));
        }
        let is_even = scale == Vec3::splat(scale.x);
        if !is_even || !scale.x.is_finite() || scale.x <= 0.0 {
            return Err(Problem::Pose(
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
        body.translated((-middle).into())
            .rotated_about(engine_rotation(self.rotation), [0.0; 3])
            .translated(self.translation.into())
    }

    /// Scales a shape, without rotation or translation.
    pub fn form(&self, shape: Shape) -> Shape {
        let scaled = |vector: [f32; 3]| vector.map(|k| k * self.scale);
        match shape {
            Shape::HalfSpace { normal, offset } => Shape::HalfSpace {
                normal,
                offset: offset * self.scale,
            },
            Shape::Ball { centre, radius } => Shape::Ball {
                centre: scaled(centre),
                radius: radius * self.scale,
            },
            Shape::Capsule { from, to, radius } => Shape::Capsule {
                from: scaled(from),
                to: scaled(to),
                radius: radius * self.scale,
            },
            Shape::Box { centre, half } => Shape::Box {
                centre: scaled(centre),
                half: scaled(half),
            },
            Shape::OrientedBox {
                centre,
                half,
                rotation,
            } => Shape::OrientedBox {
                centre: scaled(centre),
                half: scaled(half),
                rotation,
            },
        }
    }
}

/// Converts a rotation to the type of the engine.
pub fn engine_rotation(rotation: Quat) -> Rotation {
    Rotation::from_quaternion(rotation.to_array())
}

/// Converts a velocity to the type of the engine.
pub fn engine_velocity(linear: Vec3, angular: Vec3) -> fuwafuwa::Velocity {
    fuwafuwa::Velocity {
        linear: linear.into(),
        angular: angular.into(),
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
    // The first of the largest pieces, so that the result does not alternate between two equal halves.
    let most = masses.iter().fold(0.0f32, |most, &mass| most.max(mass));
    let largest = masses.iter().position(|&mass| mass == most).unwrap_or(0);

    let own = || nodes().filter(|(id, _)| pieces.of_node(*id).index() == largest);
    let state = |id: NodeId| {
        let (at, _, mass) = body.node_state(id);
        (Vec3::from(at), mass)
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
    let (linear, angular) = velocity_of(body);
    Motion {
        pose: Pose {
            translation: centre - rotation * rest_centre,
            rotation,
            scale: before.scale,
        },
        linear,
        angular,
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
        // Limits the step to about a quarter turn, so that it does not overshoot.
        let by = Quat::from_axis_angle(turn / angle, angle.min(1.5));
        rotation = (by * rotation).normalize();
    }
    rotation
}

/// Returns the velocity and angular velocity of a whole body; zero where the result is not finite.
fn velocity_of<D: Dim>(body: &SoftBody<D>) -> (Vec3, Vec3) {
    let centre = Vec3::from(body.centre_of_mass());
    let (mut mass, mut linear, mut spin) = (0.0, Vec3::ZERO, Vec3::ZERO);
    let mut inertia = Mat3::ZERO;
    for (id, _) in body.mesh().nodes() {
        let (at, velocity, own) = body.node_state(id);
        let (lever, velocity) = (Vec3::from(at) - centre, Vec3::from(velocity));
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
    (known(linear / mass), known(angular))
}
