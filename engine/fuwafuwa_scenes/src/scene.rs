//! Scenes: a [`World`] written as a TOML file.
//!
//! ```toml
//! dim = 2
//! gravity = [0.0, -9.81, 0.0]     # [m/s²]
//! tick = 0.0166666667             # [s]; tick, drag, max_substeps, stiff_bodies and sleep default to WorldConfig
//!
//! [[material]]                    # number 1
//! young = 5000.0                  # [Pa]; missing fields take the values of `Material::default`
//!
//! [[material]]                    # number 2
//! young = 50000.0
//! mass_damping = 10.0             # Rayleigh damping: mass term [1/s]
//! stiffness_damping = 0.0001      # and stiffness term [s]
//! colour = [90, 140, 220]         # red, green, blue, 0 to 255; by default from the renderer's palette
//!
//! [[body]]
//! shape = "ball"                  # or box, ring, heart, flower, empty
//! n = 64                          # voxels across
//! width = 1.0                     # [m]
//! at = [0.0, 0.2, 0.0]            # low corner of the body [m]
//!
//! [[body.part]]                   # a hard core; parts apply in their order
//! paint = 2                       # solid voxels in the shape become material 2
//! ball = { centre = [0.5, 0.5, 0.0], radius = 0.2 }   # [m] from the body's low corner
//!
//! [[body.part]]                   # a hole in the core
//! fill = 0                        # all voxels in the shape become empty; fill = 2: solid, of material 2
//! box = { centre = [0.5, 0.5, 0.0], half = [0.05, 0.05, 0.0] }
//!
//! [[body]]
//! file = "cat.png"                # a picture, in 3D a MagicaVoxel model; relative to the folder of the scene
//! n = 48                          # maximum number of voxels on the longer side
//! fill = true                     # closed outlines of a drawing are filled (default)
//! keep_colours = false            # true: a drawing keeps its colours, as tints of its material
//! plain = false                   # true: pixels count as they are, with their margin, as for pixel art
//! colours = { "#d04030" = 1, "#ffffff" = 0 }   # colour = material; models also take palette indices: "79" = 2
//!
//! [[obstacle]]                    # fixed rigid body: half_space, box, capsule or ball
//! half_space = { normal = [0.0, 1.0, 0.0], point = [0.0, 0.0, 0.0] }
//!
//! [[hand]]                        # rigid body that follows a path
//! radius = 0.1                    # [m]; or a box or a capsule
//! layers = { memberships = 2 }    # collision layers, also allowed for obstacles
//! path = [[0.0, -0.3, 0.5, 0.0], [1.0, 1.2, 0.5, 0.0]]   # time [s], then position [m]
//!
//! [[rigid_body]]                  # any rigid body; its shape is given as if it stood at the origin
//! ball = { centre = [0.0, 0.0, 0.0], radius = 0.2 }
//! motion_type = "dynamic"         # or fixed, kinematic, coupled (by a spring)
//! mass = 3.0                      # [kg]
//! at = [0.5, 2.0, 0.0]            # [m]
//! rotation_vector = [0.0, 0.0, 0.5]   # axis times angle [rad]
//! layers = { memberships = 1, filters = 3 }
//!
//! [[rigid_body]]
//! box = { centre = [0.0, 0.0, 0.0], half = [0.5, 0.5, 0.5] }
//! sensor = true                   # no contact forces; reports bodies that enter and exit
//!
//! [[joint]]                       # pin, spring or rope
//! kind = "rope"
//! length = 0.5                    # [m]
//! anchors = [                     # a point on a body, rigid_body, obstacle or hand, or a fixed point [m]
//!     { body = 1, point = [0.5, 1.2, 0.0], radius = 0.1 },
//!     { point = [0.5, 1.7, 0.0] },
//! ]
//!
//! [game]                          # only for levels of the game
//! name = { en = "Over the wall", ja = "かべのむこう" }
//! basket = { centre = [1.2, 0.3, 0.0], half = [0.4, 0.4, 0.0] }   # [m]
//! share = 0.6                     # share of the mass that must rest in the basket
//! alone = true                    # the basket counts only while no hand touches a piece in it
//! bodies = [1]                    # bodies that count, by number; by default all
//! ```
//!
//! Vectors have three components in both dimensions; in 2D the third is 0. Files of version 0.2 remain readable:
//! every key that was renamed since is still accepted under its old name.
//!
//! [`Picture::import`](crate::import::Picture::import) and [`Model::grid`](crate::import::Model::grid) document
//! how pictures and models become voxels. All visible models of a .vox file become one body; `model = "head"`
//! takes only the part with this name in MagicaVoxel. [`Scene::notes`] tells what was left out.

mod body;
mod budget;
mod build;
mod change;
mod embed;
mod error;
mod game;
mod grid;
mod joint;
mod knife;
mod machinery;
mod materials;
mod rigid_body;
mod shapes;
mod state;
mod write;

pub use body::{BodyText, Form, LayersText, MaterialText, PartText, VoxelsText, extension_of};
pub use embed::Fetch;
pub use error::{SceneError, shortened};
pub use game::{
    AssistText, BasketText, GameText, JointsText, LocalizedText, MAX_TOLD_BODIES, RouteText,
    WishText,
};
pub use joint::{JointAnchorText, JointKindText, JointText};
pub use knife::KnifeText;
pub use machinery::{FieldText, Machinery, SwitchText, SwitchedBy};
pub use rigid_body::{MotionTypeText, RigidBodyText};
pub(crate) use shapes::set_hand_targets;
pub use shapes::{
    AxisText, BallText, BoxText, CapsuleText, HalfSpaceText, HandText, ObstacleText, RepeatText,
    point_at,
};

use crate::import::ImportNote;
use budget::Budget;
use error::{FieldError, Origin, expected_number, require, vector_of};
use fuwafuwa::{
    DEFAULT_TICK, Dim, MIN_TICK, Material, Shape, StiffBodies, VoxelGrid, World, WorldConfig,
};
use joint::SceneHandles;
use materials::SceneMaterials;
use serde::{Deserialize, Serialize};

/// Maximum size of a scene file [bytes].
pub const MAX_TEXT_BYTES: u64 = 1 << 20;

/// Maximum number of materials in a scene: a material number is a byte, and 0 means empty.
pub const MAX_MATERIALS: usize = 255;

/// Maximum number of bodies in a scene.
pub const MAX_BODIES: usize = 1024;

/// Maximum number of entries in each of the lists `obstacle`, `hand`, `rigid_body`, `joint` and `knife`. It bounds the time
/// of a step, because moving nodes are tested against every rigid body.
pub const MAX_RIGID: usize = 256;

/// Maximum number of voxels, solid or empty, in all grids of a scene together. It equals that of the largest
/// MagicaVoxel model.
pub const MAX_VOXELS: usize = 1 << 24;

/// Maximum viewing time of a scene [s]: one day.
pub const MAX_SECONDS: f32 = 86_400.0;

/// Description of a world, as read from a scene file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Scene {
    /// Number of dimensions, 2 or 3.
    pub dim: u8,
    /// Gravity [m/s²], default (0, −9.81, 0).
    #[serde(default = "usual_gravity")]
    pub gravity: [f32; 3],
    /// Air drag [1/s], default 0.
    #[serde(default)]
    pub drag: f32,
    /// Maximum number of substeps in 1/60 s, default 64.
    #[serde(default = "usual_substeps", alias = "most_substeps")]
    pub max_substeps: u32,
    /// Treatment of soft bodies that require more than `max_substeps`: `"exact"`, `"mass_scaled"` or
    /// `"softened"`. If the key is missing, programs choose: the command line runs scenes that are no level
    /// of the game with `"exact"`, everything else uses the default of `WorldConfig`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stiff_bodies: Option<StiffBodies>,
    /// Length of a tick [s], default 1/60.
    #[serde(default = "usual_tick", skip_serializing_if = "is_usual_tick")]
    pub tick: f32,
    /// Whether bodies at rest fall asleep, default true.
    #[serde(default = "usual_sleep", skip_serializing_if = "is_usual_sleep")]
    pub sleep: bool,
    /// Viewing time [s], default 3.
    #[serde(default = "usual_seconds")]
    pub seconds: f32,
    /// Visible part of the world: its low and its high corner [m].
    #[serde(default = "usual_view")]
    pub view: [[f32; 3]; 2],
    /// Materials, number 1 first; the default is one material with default values.
    #[serde(default = "usual_materials")]
    pub material: Vec<MaterialText>,
    /// Soft bodies.
    #[serde(default)]
    pub body: Vec<BodyText>,
    /// Fixed rigid bodies.
    #[serde(default)]
    pub obstacle: Vec<ObstacleText>,
    /// Rigid bodies that follow a path.
    #[serde(default)]
    pub hand: Vec<HandText>,
    /// Rigid bodies of any kind.
    #[serde(default, alias = "rigid", skip_serializing_if = "Vec::is_empty")]
    pub rigid_body: Vec<RigidBodyText>,
    /// Joints between bodies.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub joint: Vec<JointText>,
    /// Knives on hands and moving obstacles.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub knife: Vec<KnifeText>,
    /// Regions that move obstacles and open joints when something is in them.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub switch: Vec<SwitchText>,
    /// Fields of acceleration.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub field: Vec<FieldText>,
    /// Rules of the game, if the scene is a level.
    pub game: Option<GameText>,
    #[serde(skip)]
    origin: Origin,
}

/// Scenes built into this crate: name and text.
pub const NAMED: [(&str, &str); 12] = [
    ("drop", include_str!("../scenes/drop.toml")),
    ("drop-3d", include_str!("../scenes/drop-3d.toml")),
    ("squeeze", include_str!("../scenes/squeeze.toml")),
    ("tear", include_str!("../scenes/tear.toml")),
    ("tear-3d", include_str!("../scenes/tear-3d.toml")),
    ("diced", include_str!("../scenes/diced.toml")),
    ("pile", include_str!("../scenes/pile.toml")),
    ("pile-3d", include_str!("../scenes/pile-3d.toml")),
    ("stack", include_str!("../scenes/stack.toml")),
    ("core", include_str!("../scenes/core.toml")),
    ("ring-3d", include_str!("../scenes/ring-3d.toml")),
    ("heap-3d", include_str!("../scenes/heap-3d.toml")),
];

impl Scene {
    /// Opens a built-in scene by name; `changes` replace values in it, e.g. `material.young=9000`.
    ///
    /// # Errors
    /// [`SceneError`] if the name is unknown or a change is invalid; it names the field.
    pub fn open(name: &str, changes: &[String]) -> Result<Self, SceneError> {
        if let Some((_, text)) = NAMED.iter().find(|(known, _)| *known == name) {
            return Self::read(name, text, changes);
        }
        let known: Vec<&str> = NAMED.iter().map(|(known, _)| *known).collect();
        Err(SceneError::Unknown {
            name: name.into(),
            known: known.join(", "),
        })
    }

    /// Parses the text of a scene and applies `changes` to it; `name` names the scene in errors.
    ///
    /// # Errors
    /// [`SceneError`] names line and field.
    pub fn read(name: &str, text: &str, changes: &[String]) -> Result<Self, SceneError> {
        // Parses the text without the changes first, so that errors name lines of the text.
        let scene = toml::from_str(text);
        let mut scene: Self = scene.map_err(|error| SceneError::of_text(name, text, &error))?;
        scene.origin = Origin::of(name, text);
        if !changes.is_empty() {
            scene = scene.changed(name, changes)?;
        }
        scene
            .check_dim()
            .map_err(|wrong| scene.origin.error(wrong))?;
        Ok(scene)
    }

    fn changed(&self, name: &str, changes: &[String]) -> Result<Self, SceneError> {
        // Changed values have no line in the text, so errors name the changes instead.
        let name = format!("{name} with {}", changes.join(", "));
        let wrong = |reason: String| SceneError::Text {
            name: name.clone(),
            line: None,
            reason,
        };
        let table = toml::Table::try_from(self).map_err(|error| wrong(error.to_string()))?;
        let mut table = toml::Value::Table(table);
        for change in changes {
            change::replace(&mut table, change).map_err(wrong)?;
        }
        let changed = table.try_into();
        let mut changed: Self = changed.map_err(|error| SceneError::of_text(&name, "", &error))?;
        changed.origin = Origin::named(&name);
        Ok(changed)
    }

    /// Builds the world that the scene describes.
    ///
    /// # Errors
    /// [`SceneError::Build`] names the field, what was expected and what was found.
    pub fn build<D: Dim>(&self) -> Result<World<D>, SceneError> {
        self.build_within(MAX_VOXELS)
    }

    /// Builds the world, with at most `most_solid` solid voxels in all bodies together. Their grids may have
    /// eight times as many voxels, solid or empty, but not more than [`MAX_VOXELS`].
    ///
    /// # Errors
    /// Same errors as [`Scene::build`].
    pub fn build_within<D: Dim>(&self, most_solid: usize) -> Result<World<D>, SceneError> {
        self.try_build(most_solid)
            .map_err(|wrong| self.origin.error(wrong))
    }

    fn try_build<D: Dim>(&self, most_solid: usize) -> Result<World<D>, FieldError> {
        self.check_dim()?;
        let expected = format!("expected {}, found {}", D::N, self.dim);
        require(usize::from(self.dim) == D::N, "dim", expected)?;
        let gravity = vector_of::<D>("gravity", self.gravity)?;
        let good = (0.0..=MAX_SECONDS).contains(&self.seconds);
        let expected = format!("expected 0 to {MAX_SECONDS} s, found {}", self.seconds);
        require(good, "seconds", expected)?;
        let [low, high] = self.view;
        let finite = low.iter().chain(&high).all(|k| k.is_finite());
        let good = finite && (0..D::N).all(|axis| low[axis] < high[axis]);
        let expected =
            format!("expected a low corner below a high one, found {low:?} and {high:?}");
        require(good, "view", expected)?;

        let settings = WorldConfig {
            gravity,
            drag: self.drag,
            max_substeps: self.max_substeps,
            stiff_bodies: self.stiff_bodies.unwrap_or_default(),
            tick: self.tick,
            // A field does not act on a sleeping body.
            sleep: self.sleep && self.field.is_empty(),
        };
        let world = World::new(settings);
        let mut world = world.map_err(|error| FieldError::engine("gravity", error))?;
        let count = self.material.len();
        let expected = format!("expected {MAX_MATERIALS} at most, found {count}");
        require(count <= MAX_MATERIALS, "material", expected)?;
        for (index, text) in self.material.iter().enumerate() {
            let checked = text.check();
            checked.map_err(|wrong| wrong.inside("material", index))?;
        }
        let materials = SceneMaterials::of(&self.material);
        let count = self.body.len();
        let expected = format!("expected {MAX_BODIES} bodies at most, found {count}");
        require(count <= MAX_BODIES, "body", expected)?;
        let counts = [
            ("obstacle", self.obstacle.len()),
            ("hand", self.hand.len()),
            ("rigid_body", self.rigid_body.len()),
            ("joint", self.joint.len()),
            ("knife", self.knife.len()),
            ("switch", self.switch.len()),
            ("field", self.field.len()),
        ];
        for (field, count) in counts {
            let expected = format!("expected {MAX_RIGID} at most, found {count}");
            require(count <= MAX_RIGID, field, expected)?;
        }
        let mut budget = Budget::of_scene(most_solid);
        for (index, text) in self.body.iter().enumerate() {
            let added = text.add_to(&mut world, &materials, &mut budget);
            added.map_err(|wrong| wrong.inside("body", index))?;
        }
        for (index, text) in self.switch.iter().enumerate() {
            let checked = text.check::<D>(self.body.len());
            checked.map_err(|wrong| wrong.inside("switch", index))?;
        }
        for (index, text) in self.field.iter().enumerate() {
            let checked = text.field::<D>();
            checked.map_err(|wrong| wrong.inside("field", index))?;
        }
        self.check_numbers()?;
        for (index, text) in self.obstacle.iter().enumerate() {
            let added = text.add_to(&mut world);
            added.map_err(|wrong| wrong.inside("obstacle", index))?;
        }
        for (index, text) in self.hand.iter().enumerate() {
            let player = text.follows.map(|leader| {
                let before = self.hand.iter().take(leader - 1);
                before.filter(|hand| hand.follows.is_none()).count()
            });
            let added = text.add_to(player, &mut world);
            added.map_err(|wrong| wrong.inside("hand", index))?;
        }
        for (index, text) in self.rigid_body.iter().enumerate() {
            let added = text.add_to(&mut world);
            added.map_err(|wrong| wrong.inside("rigid_body", index))?;
        }
        // The world was empty before the build, so its rigid bodies are in the order of the lists: obstacles,
        // hands, rigid bodies.
        let mut rigids = world.rigid_bodies().map(|(id, _)| id);
        let known = SceneHandles {
            bodies: world.soft_bodies().map(|(id, _)| id).collect(),
            obstacles: rigids.by_ref().take(self.obstacle.len()).collect(),
            hands: rigids.by_ref().take(self.hand.len()).collect(),
            rigid_bodies: rigids.collect(),
        };
        for (index, text) in self.joint.iter().enumerate() {
            let added = text.add_to(&mut world, &known);
            added.map_err(|wrong| wrong.inside("joint", index))?;
        }
        for (index, text) in self.knife.iter().enumerate() {
            let added = text.add_to(&mut world, &known);
            added.map_err(|wrong| wrong.inside("knife", index))?;
        }
        Ok(world)
    }

    /// Returns an error if a switch or a hand has a number that is not in its list.
    fn check_numbers(&self) -> Result<(), FieldError> {
        let count = self.switch.len();
        let obstacles = self.obstacle.iter().map(|text| text.switch).enumerate();
        let joints = self.joint.iter().map(|text| text.switch).enumerate();
        let obstacles = obstacles.map(|text| ("obstacle", text));
        let joints = joints.map(|text| ("joint", text));
        for (list, (index, switch)) in obstacles.chain(joints) {
            let expected = match (count, switch) {
                (_, None) => continue,
                (0, _) => "expected a [[switch]] in the scene".to_string(),
                (_, Some(number)) => expected_number(count, number),
            };
            let good = switch.is_some_and(|number| (1..=count).contains(&number));
            require(good, "switch", expected).map_err(|wrong| wrong.inside(list, index))?;
        }
        for (index, text) in self.hand.iter().enumerate() {
            let Some(leader) = text.follows else {
                continue;
            };
            let leads = leader
                .checked_sub(1)
                .and_then(|leader| self.hand.get(leader));
            let good = leads.is_some_and(|leader| leader.follows.is_none());
            let expected =
                format!("expected the number of a hand that follows no other one, found {leader}");
            require(good, "follows", expected).map_err(|wrong| wrong.inside("hand", index))?;
        }
        Ok(())
    }

    /// Returns the target regions, if the scene is a level of the game with baskets, in the order of
    /// [`GameText::all_baskets`].
    ///
    /// # Errors
    /// [`SceneError::Build`] names the field of `[game]` and what is wrong with it.
    pub fn baskets<D: Dim>(&self) -> Result<Vec<Shape<D>>, SceneError> {
        let Some(game) = &self.game else {
            return Ok(Vec::new());
        };
        let joints = self.joint.iter();
        let joints =
            joints.filter(|joint| joint.breaking_force.is_some() || joint.switch.is_some());
        let baskets = game.check::<D>(self.body.len(), joints.count());
        baskets.map_err(|wrong| self.origin.error(wrong.under("game")))
    }

    /// Embeds the files that the scene's bodies are made from, so that the scene is self-contained. A body
    /// with a file cannot be built before its file is embedded.
    ///
    /// [`Scene::notes`] then returns what was left out or may surprise.
    ///
    /// # Errors
    /// [`SceneError`] names the body whose file could not be read or imported.
    pub fn embed_files(&mut self, fetch: Fetch) -> Result<(), SceneError> {
        let mut budget = Budget::of_scene(MAX_VOXELS);
        // Skips bodies beyond the limit: the build rejects the scene because of them.
        for (index, body) in self.body.iter_mut().enumerate().take(MAX_BODIES) {
            let embedded = body.embed_file(self.dim, fetch, &mut budget, &mut self.material);
            let notes = embedded.map_err(|wrong| self.origin.error(wrong.inside("body", index)))?;
            self.origin.notes.extend(notes);
        }
        Ok(())
    }

    /// Returns notes on the files that [`Scene::embed_files`] embedded: what was left out of them or may
    /// surprise. Programs show them where the user looks. Two scenes can be equal although their notes differ.
    pub fn notes(&self) -> &[ImportNote] {
        &self.origin.notes
    }

    /// Returns the materials, number 1 first.
    pub fn materials(&self) -> Vec<Material> {
        self.material.iter().map(MaterialText::material).collect()
    }

    /// Returns the colour of each material, number 1 first: red, green and blue, 0 to 255 (sRGB). `None`
    /// leaves the colour to the renderer.
    pub fn colours(&self) -> Vec<Option<[u8; 3]>> {
        self.material.iter().map(|text| text.colour).collect()
    }

    /// Returns for each body the grid whose material numbers select the colours of its voxels, for renderers. In
    /// the world itself, a tint has the number of the material from which it differs only in its colour. `None`
    /// for a body with a `state`, and for one without tints, unless it is given by `voxels` of several materials, so
    /// that the lines of a drawing stay sharp.
    ///
    /// # Errors
    /// Same errors as [`Scene::build`].
    pub fn tint_grids<D: Dim>(&self) -> Result<Vec<Option<VoxelGrid<D>>>, SceneError> {
        let materials = SceneMaterials::of(&self.material);
        let mut budget = Budget::of_scene(MAX_VOXELS);
        let bodies = self.body.iter().enumerate().map(|(index, body)| {
            let is_drawn = body.voxels.is_some();
            if !(materials.has_tints() || is_drawn) || body.state.is_some() {
                return Ok(None);
            }
            let grid = grid::of::<D>(body, &mut budget);
            let grid = grid.map_err(|wrong| self.origin.error(wrong.inside("body", index)))?;
            let is_coloured = |grid: &VoxelGrid<D>| {
                materials.are_tints_in(grid) || is_drawn && has_several_materials(grid)
            };
            Ok(Some(grid).filter(is_coloured))
        });
        bodies.collect()
    }

    /// Returns the target position of each hand at the end of a tick [m].
    pub fn hand_targets(&self, tick: u64) -> Vec<[f32; 3]> {
        let seconds = match is_usual_tick(&self.tick) {
            true => (tick + 1) as f32 / 60.0,
            false => (tick + 1) as f32 * self.tick,
        };
        let target = |hand: &HandText| match hand.follows {
            None => hand.target(seconds),
            Some(leader) => {
                let Some(leader) = leader
                    .checked_sub(1)
                    .and_then(|leader| self.hand.get(leader))
                else {
                    return hand.target(0.0);
                };
                let [now, start] = [seconds, 0.0].map(|seconds| leader.target(seconds));
                hand.following([0, 1, 2].map(|axis: usize| now[axis] - start[axis]))
            }
        };
        self.hand.iter().map(target).collect()
    }

    /// Sets the targets of the world's hands to their positions at the end of a tick.
    pub fn set_hand_targets<D: Dim>(&self, world: &mut World<D>, tick: u64) {
        set_hand_targets(world, &self.hand_targets(tick));
    }

    /// Returns the viewing time in ticks.
    pub fn ticks(&self) -> u64 {
        let seconds = self.seconds.clamp(0.0, MAX_SECONDS);
        match is_usual_tick(&self.tick) {
            true => (seconds * 60.0) as u64,
            false => (seconds / self.tick.max(MIN_TICK)) as u64,
        }
    }

    fn check_dim(&self) -> Result<(), FieldError> {
        let expected = format!("expected 2 or 3, found {}", self.dim);
        require((2..=3).contains(&self.dim), "dim", expected)
    }
}

fn has_several_materials<D: Dim>(grid: &VoxelGrid<D>) -> bool {
    let numbers = grid.voxels().map(|voxel| grid.material(voxel));
    let mut solid = numbers.filter(|&number| number != 0);
    let first = solid.next();
    solid.any(|number| Some(number) != first)
}

fn usual_gravity() -> [f32; 3] {
    [0.0, -9.81, 0.0]
}

fn usual_substeps() -> u32 {
    64
}

fn usual_tick() -> f32 {
    DEFAULT_TICK
}

fn usual_sleep() -> bool {
    true
}

fn is_usual_sleep(sleep: &bool) -> bool {
    *sleep
}

fn is_usual_tick(tick: &f32) -> bool {
    *tick == DEFAULT_TICK
}

fn usual_seconds() -> f32 {
    3.0
}

fn usual_view() -> [[f32; 3]; 2] {
    [[-0.6, -0.1, -0.6], [1.6, 1.6, 1.6]]
}

fn usual_materials() -> Vec<MaterialText> {
    vec![MaterialText::default()]
}

#[cfg(test)]
mod tests {
    use super::*;
    use fuwafuwa::{Dim2, Dim3};

    #[test]
    fn named_scenes_step_without_quarantine() {
        for (name, _) in NAMED {
            // The scenes are tested here, not the engine, so small bodies suffice.
            let small = ["body.n=12".to_string(), "body.diced=0.3".to_string()];
            let changes = if name == "diced" {
                &small[..]
            } else {
                &small[..1]
            };
            let scene = Scene::open(name, changes).unwrap();
            if scene.dim == 2 {
                let mut world = scene.build::<Dim2>().unwrap();
                assert_eq!(world.step().quarantined, 0, "{name}");
            } else {
                let mut world = scene.build::<Dim3>().unwrap();
                assert_eq!(world.step().quarantined, 0, "{name}");
            }
        }
    }
}
