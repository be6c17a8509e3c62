//! Conversion of a world to a scene.

use super::body::{BodyText, LayersText, MaterialText, VoxelsText};
use super::error::{FieldError, Origin, require};
use super::joint::{JointAnchorText, JointText};
use super::knife::KnifeText;
use super::rigid_body::RigidBodyText;
use super::state;
use super::{MAX_BODIES, MAX_MATERIALS, MAX_RIGID, MAX_TEXT_BYTES, Scene, SceneError};
use base64::Engine;
use base64::prelude::BASE64_STANDARD as BASE64;
use fuwafuwa::{
    Dim, DimVector, Grading, Joint, JointAnchor, Law, Material, RigidBodyHandle, SoftBody,
    SoftBodyHandle, Vec3, Velocity, VoxelGrid, World, WorldConfig, snapshot,
};
use std::fmt::Write;

/// Maximum distance between a joint anchor and its counterpart in the rebuilt scene [m].
const NEAR: f32 = 1e-3;

impl Scene {
    /// Describes the current state of a world: settings, bodies, rigid bodies, joints, knives.
    ///
    /// Where possible, a body is described by fields: a soft body by its voxels, materials, position and
    /// velocity, a rigid body by its shape, motion type, pose and velocity. If fields cannot reproduce a body
    /// bit by bit (a torn or deformed body), its complete state is stored in `state`,
    /// which is not human-readable. A world that was not stepped since it was built therefore gives a scene
    /// that rebuilds it with the same [hash](World::hash), except for rounding of the edges of knives.
    ///
    /// Not included are contacts, events, sleep timers, the number of ticks and the paths of hands. To
    /// continue a world with bit-identical results, save it with [`fuwafuwa::snapshot`].
    ///
    /// ```
    /// use fuwafuwa::{Dim2, WorldConfig, World};
    /// use fuwafuwa_scenes::Scene;
    ///
    /// let scene = Scene::open("drop", &["body.n=12".into()])?;
    /// let world = scene.build::<Dim2>()?;
    /// let text = Scene::of_world(&world)?.text()?;
    /// let again = Scene::read("again", &text, &[])?.build::<Dim2>()?;
    /// assert_eq!(again.hash(), world.hash());
    /// # Ok::<(), fuwafuwa_scenes::SceneError>(())
    /// ```
    ///
    /// # Errors
    /// [`SceneError::Build`] names the cause: more bodies, materials or rigid bodies than a scene may have,
    /// or a joint that the fields of a scene cannot reproduce, because its bodies have moved since it was
    /// attached.
    pub fn of_world<D: Dim>(world: &World<D>) -> Result<Self, SceneError> {
        written(world).map_err(|wrong| Origin::named("world").error(wrong))
    }

    /// Returns the scene as TOML text that [`Scene::read`] accepts.
    ///
    /// # Errors
    /// [`SceneError::Text`] if the text is longer than [`MAX_TEXT_BYTES`].
    pub fn text(&self) -> Result<String, SceneError> {
        let wrong = |reason: String| SceneError::Text {
            name: "scene".into(),
            line: None,
            reason,
        };
        let text = toml::to_string(self).map_err(|error| wrong(error.to_string()))?;
        let found = text.len() as u64;
        match found <= MAX_TEXT_BYTES {
            true => Ok(text),
            false => Err(wrong(format!(
                "expected {MAX_TEXT_BYTES} bytes at most, found {found}; torn or deformed bodies need the most space: save \
                 a snapshot instead"
            ))),
        }
    }
}

fn written<D: Dim>(world: &World<D>) -> Result<Scene, FieldError> {
    let settings = *world.config();
    let mut scene = Scene {
        dim: D::N as u8,
        gravity: settings.gravity.to_vec3().to_array(),
        drag: settings.drag,
        max_substeps: settings.max_substeps,
        stiff_bodies: Some(settings.stiff_bodies),
        tick: settings.tick,
        sleep: settings.sleep,
        seconds: super::usual_seconds(),
        view: view_of(world),
        material: Vec::new(),
        body: Vec::new(),
        obstacle: Vec::new(),
        hand: Vec::new(),
        rigid_body: Vec::new(),
        joint: Vec::new(),
        knife: Vec::new(),
        switch: Vec::new(),
        field: Vec::new(),
        game: None,
        origin: Origin::default(),
    };
    let found = world.soft_bodies().count();
    let expected = format!("expected {MAX_BODIES} bodies at most, found {found}");
    require(found <= MAX_BODIES, "body", expected)?;
    let found = world.rigid_bodies().count();
    let expected = format!("expected {MAX_RIGID} at most, found {found}");
    require(found <= MAX_RIGID, "rigid_body", expected)?;
    let mut materials: Vec<Material> = Vec::new();
    for (index, (_, body)) in world.soft_bodies().enumerate() {
        let text = body_text(body, settings, &mut materials);
        scene
            .body
            .push(text.map_err(|wrong| wrong.inside("body", index))?);
    }
    scene.material = materials.iter().map(MaterialText::of).collect();
    if scene.material.is_empty() {
        scene.material = super::usual_materials();
    }
    for (index, (_, body)) in world.rigid_bodies().enumerate() {
        let unsaid = || FieldError::new("state", "the state cannot be serialised");
        let text = RigidBodyText::of(body).ok_or_else(unsaid);
        scene
            .rigid_body
            .push(text.map_err(|wrong| wrong.inside("rigid_body", index))?);
    }
    write_joints(world, &mut scene)?;
    // A knife on a removed rigid body does not cut.
    let knives = world.knives();
    let knives = knives.filter_map(|(_, knife)| KnifeText::of(world, knife));
    scene.knife.extend(knives);
    Ok(scene)
}

/// Returns the text of a body: its fields if they reproduce it exactly, otherwise its state.
fn body_text<D: Dim>(
    body: &SoftBody<D>,
    settings: WorldConfig<D>,
    materials: &mut Vec<Material>,
) -> Result<BodyText, FieldError> {
    let of_world = |body: SoftBody<D>| {
        let mut world = World::new(settings).ok()?;
        world.add_soft_body(body).ok()?;
        Some(snapshot::save(&world))
    };
    let words = by_fields(body).filter(|(_, made)| {
        let (made, own) = (of_world(made.clone()), of_world(body.clone()));
        made.is_some() && made == own
    });
    if let Some((mut text, made)) = words {
        let numbers = numbers_in(materials, body.materials());
        let found = materials.len();
        let expected = format!("expected {MAX_MATERIALS} materials at most, found {found}");
        require(found <= MAX_MATERIALS, "material", expected)?;
        let grid = made.grid();
        let number = |voxel| match grid.material(voxel) {
            0 => 0,
            own => numbers[usize::from(own) - 1],
        };
        if let Some(voxels) = &mut text.voxels {
            voxels.runs = runs(grid.voxels().map(number));
        }
        return Ok(text);
    }
    let unsaid = || FieldError::new("state", "the state cannot be serialised");
    let state = state::of_body(body, settings).ok_or_else(unsaid)?;
    Ok(BodyText {
        state: Some(state),
        ..BodyText::default()
    })
}

/// Describes a body by fields and builds the body that they describe. Returns `None` for bodies that fields
/// cannot describe.
fn by_fields<D: Dim>(body: &SoftBody<D>) -> Option<(BodyText, SoftBody<D>)> {
    let (grid, grading) = (body.grid(), body.grading());
    if grading == Grading::Coarse || grid.remaining_count() < grid.solid_count() {
        return None;
    }
    let size = grid.size().map(|extent| extent as usize);
    let materials = grid.voxels().map(|voxel| grid.material(voxel));
    let whole = VoxelGrid::from_materials(size, grid.voxel_size(), materials.collect());
    let whole = match grid.surface_offsets() {
        Some(offsets) => whole.ok()?.with_surface_offsets(offsets.to_vec()),
        None => whole,
    };
    let made = SoftBody::with_options(whole.ok()?, body.materials(), body.law(), grading).ok()?;
    if !made.mesh().is_same_as(body.mesh()) {
        return None;
    }
    let at = translation_between(&made, body)?;
    let (first, _) = body.mesh().nodes().next()?;
    let velocity = body.node_state(first).1;
    let moving = Velocity::linear(velocity);
    let made = made.translated(at).with_velocity(moving);
    let text = BodyText {
        voxels: Some(VoxelsText {
            size,
            voxel_size: grid.voxel_size(),
            runs: String::new(),
            surface: grid.surface_offsets().map(|offsets| {
                let bytes = offsets.iter().map(|offset| offset.cast_unsigned());
                BASE64.encode(bytes.collect::<Vec<u8>>())
            }),
        }),
        at: at.to_vec3().to_array(),
        velocity: velocity.to_vec3().to_array(),
        gravity_scale: (body.gravity_scale() != 1.0).then_some(body.gravity_scale()),
        layers: LayersText::of(body.layers()),
        user_data: (body.user_data() != 0).then_some(body.user_data()),
        uniform: grading == Grading::Uniform,
        paper_law: body.law() == Law::Endo2004,
        ..BodyText::default()
    };
    Some((text, with_properties_of(made, body)?))
}

/// Returns `made` with the gravity scale, layers and user data of `body`.
fn with_properties_of<D: Dim>(made: SoftBody<D>, body: &SoftBody<D>) -> Option<SoftBody<D>> {
    let mut world = World::new(WorldConfig::default()).ok()?;
    let id = world.add_soft_body(made).ok()?;
    world.set_gravity_scale(id, body.gravity_scale()).ok()?;
    world.set_layers(id, body.layers()).ok()?;
    world.set_user_data(id, body.user_data()).ok()?;
    world.remove(id).ok()
}

/// Returns the translation [m] that moves every node of `made` exactly to its position in `body`, rounding
/// included; `None` if there is none.
fn translation_between<D: Dim>(made: &SoftBody<D>, body: &SoftBody<D>) -> Option<D::Vector> {
    let mut at = D::Vector::ZERO;
    let mut ids = made.mesh().nodes().map(|(id, _)| id);
    if !ids.all(|id| id.index() < body.positions().len()) {
        return None;
    }
    let both = || {
        let ids = made.mesh().nodes().map(|(id, _)| id);
        ids.map(|id| (made.positions()[id], body.positions()[id]))
    };
    for axis in 0..D::N {
        let fits = |by: f32| both().all(|(from, to)| from[axis] + by == to[axis]);
        // At the node nearest to 0, the addition of the translation was rounded least. There the difference
        // of the positions is exact up to the last bit.
        let lowest = both().min_by(|a, b| a.0[axis].abs().total_cmp(&b.0[axis].abs()));
        let (from, to) = lowest?;
        let by = to[axis] - from[axis];
        let near = [by, by.next_up(), by.next_down()];
        at[axis] = near.into_iter().find(|&by| fits(by))?;
    }
    Some(at)
}

/// Returns the numbers of a body's materials in the list of the scene, and adds new materials to the list.
fn numbers_in(all: &mut Vec<Material>, own: &[Material]) -> Vec<u8> {
    if all.is_empty() {
        all.extend(own);
    }
    let mut numbers = Vec::new();
    for (index, material) in own.iter().enumerate() {
        // If the list of the scene and that of the body begin with the same materials, the numbers do not
        // change.
        let same = all.get(index) == Some(material);
        let known = all.iter().position(|known| known == material);
        let place = if same { Some(index) } else { known };
        let place = place.unwrap_or_else(|| {
            all.push(*material);
            all.len() - 1
        });
        numbers.push(u8::try_from(place + 1).unwrap_or(u8::MAX));
    }
    numbers
}

fn runs(materials: impl Iterator<Item = u8>) -> String {
    let all: Vec<u8> = materials.collect();
    let mut runs = String::new();
    for run in all.chunk_by(|a, b| a == b) {
        let space = if runs.is_empty() { "" } else { " " };
        // Ignores the result, because writing to a string cannot fail.
        let _ = write!(runs, "{space}{}x{}", run.len(), run[0]);
    }
    runs
}

/// Describes joints by their original anchors or, if the scene would not reproduce them so, by their current
/// anchors. Fails if the scene reproduces neither.
fn write_joints<D: Dim>(world: &World<D>, scene: &mut Scene) -> Result<(), FieldError> {
    if world.joints().next().is_none() {
        return Ok(());
    }
    for (index, (id, joint)) in world.joints().enumerate() {
        let inside = |wrong: FieldError| wrong.inside("joint", index);
        let gone = || {
            FieldError::new(
                "anchors",
                "expected two existing bodies, but one was removed",
            )
        };
        let places = world.joint_anchor_positions(id).ok().flatten();
        let places = places.ok_or_else(|| inside(gone()))?;
        let joint = joint.definition();
        let original = joint.anchors.map(|anchor| anchor_text(world, anchor, None));
        let [first, second] = joint.anchors;
        let now = [(first, places[0]), (second, places[1])];
        let now = now.map(|(anchor, place)| anchor_text(world, anchor, Some(place)));
        let fits = [original, now].into_iter().find_map(|[first, second]| {
            let text = JointText::of(&joint, [first?, second?]);
            reproduces_joint(scene, &text, places, &joint).then_some(text)
        });
        let moved = "the bodies have moved since the joint was attached, and the scene cannot reproduce it: save a snapshot instead";
        let text = fits.ok_or_else(|| inside(FieldError::new("anchors", moved)))?;
        scene.joint.push(text);
    }
    Ok(())
}

/// Returns whether the scene reproduces the joint: the same joint kind, with anchors at the same positions.
fn reproduces_joint<D: Dim>(
    scene: &Scene,
    text: &JointText,
    places: [D::Vector; 2],
    joint: &Joint<D>,
) -> bool {
    let mut scene = scene.clone();
    scene.joint = vec![text.clone()];
    let Some((made, found)) = only_joint::<D>(&scene) else {
        return false;
    };
    let is_near = (0..2).all(|end| {
        let apart = found[end] - places[end];
        (0..D::N).all(|axis| apart[axis].abs() <= NEAR)
    });
    is_near && made.kind == joint.kind
}

/// Returns the joint of a scene with one joint, and the positions of its anchors [m].
fn only_joint<D: Dim>(scene: &Scene) -> Option<(Joint<D>, [D::Vector; 2])> {
    let world = scene.build::<D>().ok()?;
    let (id, joint) = world.joints().next()?;
    let places = world.joint_anchor_positions(id).ok()??;
    Some((joint.definition(), places))
}

/// Returns the text of a joint anchor, at its original position or at `other` [m].
fn anchor_text<D: Dim>(
    world: &World<D>,
    anchor: JointAnchor<D>,
    other: Option<D::Vector>,
) -> Option<JointAnchorText> {
    let number_of_soft = |body: SoftBodyHandle| {
        let rank = world.soft_bodies().position(|(id, _)| id == body);
        rank.map(|rank| rank + 1)
    };
    let number_of_rigid = |body: RigidBodyHandle| {
        let rank = world.rigid_bodies().position(|(id, _)| id == body);
        rank.map(|rank| rank + 1)
    };
    let numbers = |point: D::Vector| other.unwrap_or(point).to_vec3().to_array();
    Some(match anchor {
        JointAnchor::Point(point) => JointAnchorText {
            point: numbers(point),
            ..JointAnchorText::default()
        },
        JointAnchor::RigidBody { body, point } => JointAnchorText {
            rigid_body: Some(number_of_rigid(body)?),
            point: numbers(point),
            ..JointAnchorText::default()
        },
        JointAnchor::SoftBody {
            body,
            point,
            radius,
        } => JointAnchorText {
            body: Some(number_of_soft(body)?),
            point: numbers(point),
            radius: Some(radius),
            ..JointAnchorText::default()
        },
    })
}

/// Returns the low and the high corner of a box around all nodes and dynamic rigid bodies, with a margin of
/// 0.5 m.
fn view_of<D: Dim>(world: &World<D>) -> [[f32; 3]; 2] {
    let nodes = world.soft_bodies().flat_map(|(_, body)| {
        let ids = body.mesh().nodes().map(|(id, _)| id);
        ids.map(|id| body.node_state(id).0)
    });
    let bodies = world.rigid_bodies().map(|(_, body)| body);
    let middles = bodies
        .filter(|body| body.is_dynamic())
        .map(|body| body.position());
    let (mut low, mut high) = (Vec3::splat(f32::MAX), Vec3::splat(f32::MIN));
    for at in nodes.chain(middles) {
        let (at, margin) = (at.to_vec3(), Vec3::splat(0.5));
        (low, high) = (low.min(at - margin), high.max(at + margin));
    }
    let [low, high] = [low, high].map(|corner| corner.to_array());
    match low.iter().chain(&high).all(|k| k.abs() < f32::MAX) {
        true => [low, high],
        false => super::usual_view(),
    }
}
