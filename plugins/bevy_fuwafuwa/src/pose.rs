//! Where a body is as a whole, which way round, and how fast: what a `Transform` can say of it.

use crate::problem::Problem;
use bevy_math::{Mat3, Quat, Vec3};
use bevy_transform::components::Transform;
use fuwafuwa::{Body, Dim, NodeId, Rotation, Shape, VoxelGrid};

/// Rounds in which a rotation is found; from tick to tick one or two are enough.
const ROUNDS: usize = 20;
/// A rotation that differs by less [rad] is found.
const NEAR: f32 = 1e-6;

/// Where the origin of a body is, and how it is turned and scaled.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Pose {
    /// [m]
    pub translation: Vec3,
    pub rotation: Quat,
    pub scale: f32,
}

/// What is found about a body as a whole.
#[derive(Copy, Clone, Debug)]
pub struct Motion {
    pub pose: Pose,
    /// Of the centre of mass [m/s].
    pub linear: Vec3,
    /// About it [rad/s].
    pub angular: Vec3,
}

impl Pose {
    /// What a transform says, if a body can be put so.
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
            return Err(Problem::Pose("have a rotation"));
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

    /// A place of the world [m], as seen from the body.
    pub fn local(&self, at: Vec3) -> Vec3 {
        self.rotation.inverse() * (at - self.translation) / self.scale
    }

    /// Puts a new body of a grid that was scaled here: the middle of the grid is the origin.
    pub fn place<D: Dim>(&self, body: Body<D>) -> Body<D> {
        let middle = middle(body.grid());
        body.moved((-middle).into())
            .rotated(engine_rotation(self.rotation), [0.0; 3])
            .moved(self.translation.into())
    }

    /// A shape that is scaled, but neither turned nor moved.
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

/// The rotation as the engine has it.
pub fn engine_rotation(rotation: Quat) -> Rotation {
    Rotation::from_quaternion(rotation.to_array())
}

/// Where a body is as a whole: the rigid motion from rest that is nearest to that of its largest piece, by mass; the
/// rotation as its own, from the one before [Mueller 2016]. Its velocity is that of all of it.
pub fn motion_of<D: Dim>(body: &Body<D>, before: Pose) -> Motion {
    let (size, middle) = (body.grid().voxel_size(), middle(body.grid()));
    let nodes = || body.mesh().nodes();
    let pieces = body.pieces();
    let mut masses = vec![0.0; pieces.list.len()];
    for (id, _) in nodes() {
        masses[pieces.of_node(id).index()] += body.node_state(id).2;
    }
    // The first of the largest, so that equal halves do not take turns.
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

/// The middle of the box of a grid, from its low corner [m].
fn middle<D: Dim>(grid: &VoxelGrid<D>) -> Vec3 {
    let size = grid.size().map(|k| 0.5 * k as f32 * grid.voxel_size());
    match D::N {
        2 => Vec3::new(size[0], size[1], 0.0),
        _ => size.into(),
    }
}

/// The rotation R that makes tr(Rᵀ A) greatest: turned by the torque of A's columns on R's until there is none.
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
        // More than half a turn is no nearer.
        let by = Quat::from_axis_angle(turn / angle, angle.min(1.5));
        rotation = (by * rotation).normalize();
    }
    rotation
}

/// How fast all of a body moves and turns; not at all where it cannot be told.
fn velocity_of<D: Dim>(body: &Body<D>) -> (Vec3, Vec3) {
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
