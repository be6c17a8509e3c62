//! Boxes around items.

use super::{Item, basket, flat};
use fuwafuwa::{Dim, Dim2, Dim3, MAX_EXTENT, Rotation, Vec3, World};
use fuwafuwa_scenes::Scene;
use fuwafuwa_scenes::scene::{
    BallText, BodyText, BoxText, CapsuleText, FieldText, Form, HandText, JointText, RigidBodyText,
};
use std::cell::RefCell;

/// Maximum number of built bodies whose sizes are kept.
const MAX_KNOWN: usize = 32;

/// Returns the low and the high corner of the box around an item at the start [m]. `None` for half-spaces, for fields that
/// act everywhere without a centre, and for items that the scene does not have.
///
/// A body from a file is built once to know its size.
pub fn bounds(scene: &Scene, item: Item) -> Option<[Vec3; 2]> {
    let found = match item {
        Item::Body(index) => body_bounds(scene, index),
        Item::Obstacle(index) => {
            let text = scene.obstacle.get(index)?;
            let shapes = Shapes {
                boxed: text.boxed.as_ref(),
                capsule: text.capsule.as_ref(),
                ball: text.ball.as_ref(),
            };
            shapes.bounds(Rotation::NONE)
        }
        Item::Hand(index) => hand_bounds(scene.hand.get(index)?),
        Item::RigidBody(index) => rigid_body_bounds(scene.rigid_body.get(index)?),
        Item::Joint(index) => joint_bounds(scene.joint.get(index)?),
        Item::Knife(index) => {
            let edge = scene.knife.get(index)?.edge.map(Vec3::from);
            Some(hull(edge[0], edge[1]))
        }
        Item::Switch(index) => {
            let text = scene.switch.get(index)?;
            Shapes::of_region(text.boxed.as_ref(), text.ball.as_ref()).bounds(Rotation::NONE)
        }
        Item::Field(index) => field_bounds(scene.field.get(index)?),
        Item::Basket(index) => {
            let (centre, half) = basket(scene, index)?;
            Some(around(centre.into(), half.into()))
        }
    };
    let found = found?.map(|corner| flat(scene.dim, corner));
    found
        .iter()
        .all(|corner| corner.is_finite())
        .then_some(found)
}

fn around(centre: Vec3, half: Vec3) -> [Vec3; 2] {
    [centre - half, centre + half]
}

fn hull(a: Vec3, b: Vec3) -> [Vec3; 2] {
    [a.min(b), a.max(b)]
}

/// Returns the half widths of the box around a box with half widths `half` that is rotated.
fn rotated_half(rotation: Rotation, half: Vec3) -> Vec3 {
    let [x, y, z] = rotation.axes().map(Vec3::abs);
    x * half.x + y * half.y + z * half.z
}

/// Shapes of an item, of which it has at most one. Half-spaces have no bounds.
struct Shapes<'a> {
    boxed: Option<&'a BoxText>,
    capsule: Option<&'a CapsuleText>,
    ball: Option<&'a BallText>,
}

impl<'a> Shapes<'a> {
    fn of_region(boxed: Option<&'a BoxText>, ball: Option<&'a BallText>) -> Self {
        Self {
            boxed,
            capsule: None,
            ball,
        }
    }

    /// Returns the box around the shape after a rotation about the origin.
    fn bounds(&self, rotation: Rotation) -> Option<[Vec3; 2]> {
        let turned = |point: [f32; 3]| rotation.apply(Vec3::from(point));
        let boxed = self.boxed.map(|shape| {
            let half = rotated_half(rotation, shape.half.into());
            around(turned(shape.centre), half)
        });
        let capsule = || {
            let shape = self.capsule?;
            let [low, high] = hull(turned(shape.from), turned(shape.to));
            Some([low - shape.radius, high + shape.radius])
        };
        let ball = || {
            let shape = self.ball?;
            Some(around(turned(shape.centre), Vec3::splat(shape.radius)))
        };
        boxed.or_else(capsule).or_else(ball)
    }
}

fn hand_bounds(text: &HandText) -> Option<[Vec3; 2]> {
    let place = Vec3::from(text.target(0.0));
    let shape = match text.radius {
        Some(radius) => around(Vec3::ZERO, Vec3::splat(radius)),
        None => {
            let shapes = Shapes {
                boxed: text.boxed.as_ref(),
                capsule: text.capsule.as_ref(),
                ball: None,
            };
            shapes.bounds(Rotation::NONE)?
        }
    };
    Some(shape.map(|corner| corner + place))
}

/// Returns the rotation of a rigid body at the start.
pub(super) fn rotation_of(text: &RigidBodyText) -> Rotation {
    match text.rotation_vector {
        Some(vector) => rotation_about(vector),
        None => text.rotation.unwrap_or(Rotation::NONE),
    }
}

/// Returns the rotation with a rotation vector, axis times angle [rad].
pub(super) fn rotation_about(vector: [f32; 3]) -> Rotation {
    let vector = Vec3::from(vector);
    Rotation::about(vector, vector.length())
}

fn rigid_body_bounds(text: &RigidBodyText) -> Option<[Vec3; 2]> {
    let shapes = Shapes {
        boxed: text.boxed.as_ref(),
        capsule: text.capsule.as_ref(),
        ball: text.ball.as_ref(),
    };
    let shape = shapes.bounds(rotation_of(text))?;
    Some(shape.map(|corner| corner + Vec3::from(text.at)))
}

fn joint_bounds(text: &JointText) -> Option<[Vec3; 2]> {
    let points = text.anchors.iter().map(|anchor| Vec3::from(anchor.point));
    points.map(|point| [point, point]).reduce(union)
}

/// Returns the box around two boxes.
pub fn union([low, high]: [Vec3; 2], [other_low, other_high]: [Vec3; 2]) -> [Vec3; 2] {
    [low.min(other_low), high.max(other_high)]
}

fn field_bounds(text: &FieldText) -> Option<[Vec3; 2]> {
    let region = Shapes::of_region(text.boxed.as_ref(), text.ball.as_ref());
    let pull = || Some(around(text.centre?.into(), Vec3::splat(text.reach?)));
    region.bounds(Rotation::NONE).or_else(pull)
}

/// Size of the grid of a body.
#[derive(Copy, Clone, Debug)]
pub(super) struct GridSize {
    /// Widths on each axis [m].
    pub(super) widths: Vec3,
    /// Edge length of a voxel [m].
    pub(super) voxel: f32,
}

fn body_bounds(scene: &Scene, index: usize) -> Option<[Vec3; 2]> {
    let text = scene.body.get(index)?;
    if text.state.is_some() {
        return known(scene, text).map(|(bounds, _)| bounds);
    }
    let half = flat(scene.dim, grid_size(scene, text).widths) * 0.5;
    let rotation = text.rotation_vector.map_or(Rotation::NONE, rotation_about);
    let centre = Vec3::from(text.at) + rotation.apply(half);
    Some(around(centre, rotated_half(rotation, half)))
}

/// Returns the size of the grid of a body that is not given by its state.
pub(super) fn grid_size(scene: &Scene, text: &BodyText) -> GridSize {
    if let Some(voxels) = &text.voxels {
        let widths = Vec3::from(voxels.size.map(|count| count.min(MAX_EXTENT) as f32));
        return GridSize {
            widths: widths * voxels.voxel_size,
            voxel: voxels.voxel_size,
        };
    }
    let found = text.file.as_ref().and_then(|_| known(scene, text));
    if let Some(([low, high], voxel)) = found {
        // The known size is that of a body 1 m wide.
        return GridSize {
            widths: (high - low) * text.width,
            voxel: voxel * text.width,
        };
    }
    let n = text.n.unwrap_or(1).clamp(1, MAX_EXTENT);
    let voxel = text.width / n as f32;
    let counts = match text.shape {
        Some(Form::Box | Form::Empty) => text.proportions.map(|k| {
            let count = (k * n as f32).round();
            count.clamp(1.0, MAX_EXTENT as f32)
        }),
        Some(Form::Ring) if scene.dim == 3 => [n, n, n.div_ceil(4)].map(|count| count as f32),
        _ => [n as f32; 3],
    };
    GridSize {
        widths: Vec3::from(counts) * voxel,
        voxel,
    }
}

/// Box around a body that was built, and the edge length of its voxels.
type Built = ([Vec3; 2], f32);

/// Body that was built lately.
struct Known {
    dim: u8,
    /// Number of materials of the scene for which the body was built.
    materials: usize,
    /// Text of the body with the fields that decide its size, see [`sizing`].
    text: BodyText,
    /// `None` if the body cannot be built with the materials.
    built: Option<Built>,
}

impl Known {
    /// Returns whether a body of a scene has the same size. A body that could not be built may become valid with other
    /// materials.
    fn is(&self, scene: &Scene, text: &BodyText) -> bool {
        let known = &self.text;
        self.dim == scene.dim
            && (self.built.is_some() || self.materials == scene.material.len())
            && match text.state {
                Some(_) => known == text,
                None => {
                    known.state.is_none()
                        && (known.n, known.material) == (text.n, text.material)
                        && known.file == text.file
                        && known.colours == text.colours
                        && known.content == text.content
                }
            }
    }
}

thread_local! {
    static KNOWN: RefCell<Vec<Known>> = const { RefCell::new(Vec::new()) };
}

/// Returns the text of a body without the fields that do not decide its size: for a body from a file, the result has a width
/// of 1 m and the origin as its low corner. [`Known::is`] compares the fields that are left.
fn sizing(text: &BodyText) -> BodyText {
    match text.state {
        Some(_) => text.clone(),
        None => BodyText {
            file: text.file.clone(),
            content: text.content.clone(),
            n: text.n,
            material: text.material,
            colours: text.colours.clone(),
            ..BodyText::default()
        },
    }
}

/// Returns the box around the nodes of a body with a state, or the box of the grid of a body from a file, for a width of
/// 1 m and the origin as its low corner. Builds the body if it was not built lately. The text, which can have megabytes, is
/// copied only then.
fn known(scene: &Scene, text: &BodyText) -> Option<Built> {
    let find = |known: &RefCell<Vec<Known>>| {
        let known = known.borrow();
        let found = known.iter().find(|known| known.is(scene, text));
        found.map(|known| known.built)
    };
    if let Some(built) = KNOWN.with(find) {
        return built;
    }
    let text = sizing(text);
    let built = match scene.dim {
        2 => built::<Dim2>(scene, &text),
        _ => built::<Dim3>(scene, &text),
    };
    KNOWN.with_borrow_mut(|known| {
        if known.len() >= MAX_KNOWN {
            known.remove(0);
        }
        known.push(Known {
            dim: scene.dim,
            materials: scene.material.len(),
            text,
            built,
        });
    });
    built
}

/// Builds a world with a single body of a scene; `None` if the body cannot be built with the materials.
pub(super) fn built_alone<D: Dim>(scene: &Scene, text: &BodyText) -> Option<World<D>> {
    let mut alone = Scene::read("body", &format!("dim = {}", D::N), &[]).ok()?;
    alone.material = scene.material.clone();
    alone.body.push(text.clone());
    alone.build().ok()
}

fn built<D: Dim>(scene: &Scene, text: &BodyText) -> Option<Built> {
    let world = built_alone::<D>(scene, text)?;
    let (_, body) = world.soft_bodies().next()?;
    let voxel = body.grid().voxel_size();
    if text.state.is_none() {
        let size = Vec3::from(body.grid().size().map(|count| count as f32));
        return Some(([Vec3::ZERO, size * voxel], voxel));
    }
    let nodes = body
        .mesh()
        .nodes()
        .map(|(id, _)| body.positions()[id].xyz());
    let hull = nodes
        .map(|place| [place, place])
        .reduce(|[low, high], [place, _]| [low.min(place), high.max(place)]);
    Some((hull?, voxel))
}
