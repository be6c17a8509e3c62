//! A world as a text file.
//!
//! ```toml
//! dim = 2
//! gravity = [0.0, -9.81, 0.0]     # [m/s²]
//!
//! [[material]]                    # number 1
//! young = 5000.0                  # [Pa]; what is not named is that of `Material::default`
//!
//! [[body]]
//! shape = "ball"
//! n = 64                          # voxels across
//! width = 1.0                     # [m]
//! at = [0.0, 0.2, 0.0]            # its low corner [m]
//!
//! [[obstacle]]
//! half_space = { normal = [0.0, 1.0, 0.0], point = [0.0, 0.0, 0.0] }
//!
//! [[hand]]
//! radius = 0.1                    # [m]
//! path = [[0.0, -0.3, 0.5, 0.0], [1.0, 1.2, 0.5, 0.0]]   # seconds, then where [m]
//! ```

use fuwafuwa::law::{Elasticity, Law};
use fuwafuwa::manipulator::{Drive, Manipulator};
use fuwafuwa::pyramid::Grading;
use fuwafuwa::{
    Blade, Body, BodyError, BuildError, Dim, Material, Settings, Shape, VoxelGrid, World,
};
use serde::{Deserialize, Serialize};
use std::path::Path;

/// A world as it is written down.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Scene {
    /// 2 or 3.
    pub dim: u8,
    /// [m/s²]
    #[serde(default = "usual_gravity")]
    pub gravity: [f32; 3],
    /// Air drag [1/s].
    #[serde(default)]
    pub drag: f32,
    /// Substeps in a tick at most.
    #[serde(default = "usual_substeps")]
    pub most_substeps: u32,
    /// How long to watch it [s].
    #[serde(default = "usual_seconds")]
    pub seconds: f32,
    /// What part of the world to look at: low and high corner [m].
    #[serde(default = "usual_view")]
    pub view: [[f32; 3]; 2],
    /// Materials, number 1 first; one of the usual kind when there is none.
    #[serde(default)]
    pub material: Vec<MaterialText>,
    /// Soft bodies.
    #[serde(default)]
    pub body: Vec<BodyText>,
    /// Rigid shapes.
    #[serde(default)]
    pub obstacle: Vec<ObstacleText>,
    /// Hands.
    #[serde(default)]
    pub hand: Vec<HandText>,
}

/// A material as it is written down: what is not named is that of [`Material::default`].
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MaterialText {
    /// Young's modulus [Pa].
    pub young: Option<f64>,
    /// Poisson ratio.
    pub poisson: Option<f64>,
    /// [kg/m³]
    pub density: Option<f32>,
    /// Damping ratio.
    pub damping: Option<f32>,
    /// Friction between pieces.
    pub friction: Option<f32>,
    /// [Pa]
    pub strength: Option<f32>,
    /// [Pa √m]
    pub toughness: Option<f32>,
    /// Whether it never tears.
    #[serde(default)]
    pub unbreakable: bool,
}

/// A body as it is written down.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BodyText {
    /// What fills its grid.
    pub shape: Form,
    /// Voxels across.
    pub n: usize,
    /// Width of the grid [m].
    #[serde(default = "one")]
    pub width: f32,
    /// For a box: voxels on each axis in terms of `n`, e.g. [3.0, 1.0, 1.0].
    #[serde(default = "unit_proportions")]
    pub proportions: [f32; 3],
    /// Its low corner [m].
    #[serde(default)]
    pub at: [f32; 3],
    /// [m/s]
    #[serde(default)]
    pub velocity: [f32; 3],
    /// Cut along planes this far apart on every axis [m].
    #[serde(default)]
    pub diced: Option<f32>,
    /// Cut into single voxels.
    #[serde(default)]
    pub crumbled: bool,
    /// Elements of single voxels everywhere, for comparison.
    #[serde(default)]
    pub uniform: bool,
    /// The elastic force of the paper instead of the patch-exact one.
    #[serde(default)]
    pub paper_law: bool,
}

/// What fills a grid.
#[derive(Copy, Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Form {
    /// A disc or a ball.
    Ball,
    /// A box.
    Box,
    /// A disc or a ball with a hole of half its width.
    Ring,
}

/// A rigid shape as it is written down: exactly one of the fields but `friction`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ObstacleText {
    /// Everything below a plane.
    pub half_space: Option<HalfSpaceText>,
    /// Middle and half widths [m].
    #[serde(rename = "box")]
    pub boxed: Option<BoxText>,
    /// A bar with round ends.
    pub capsule: Option<CapsuleText>,
    /// A ball.
    pub ball: Option<BallText>,
    /// Coulomb friction.
    #[serde(default = "usual_friction")]
    pub friction: f32,
}

/// A plane, and what is below it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[allow(missing_docs)]
pub struct HalfSpaceText {
    pub normal: [f32; 3],
    pub point: [f32; 3],
}

/// An upright box.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[allow(missing_docs)]
pub struct BoxText {
    pub centre: [f32; 3],
    pub half: [f32; 3],
}

/// A bar with round ends.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[allow(missing_docs)]
pub struct CapsuleText {
    pub from: [f32; 3],
    pub to: [f32; 3],
    pub radius: f32,
}

/// A ball.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[allow(missing_docs)]
pub struct BallText {
    pub centre: [f32; 3],
    pub radius: f32,
}

/// A hand as it is written down.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct HandText {
    /// [m]
    pub radius: f32,
    /// Whether it goes where it is sent, whatever is in the way.
    #[serde(default)]
    pub kinematic: bool,
    /// Where its goal is when: seconds, then a place [m]; straight in between.
    pub path: Vec<[f32; 4]>,
}

/// Why a scene could not be read or built.
#[derive(Debug, thiserror::Error)]
pub enum SceneError {
    /// There is no such scene or file.
    #[error("there is no scene or file {name:?}; the scenes are {known}")]
    Unknown {
        /// What was asked for.
        name: String,
        /// What there is.
        known: String,
    },
    /// The file cannot be read.
    #[error("{path}: {source}")]
    File {
        /// The file.
        path: String,
        /// Why.
        source: std::io::Error,
    },
    /// The text is not that of a scene.
    #[error("{name}: {reason}")]
    Text {
        /// The scene or file.
        name: String,
        /// Line, field, and what was expected.
        reason: String,
    },
    /// What it describes cannot be.
    #[error("{name}: {part}: {reason}")]
    Build {
        /// The scene or file.
        name: String,
        /// Which entry, counted from 1.
        part: String,
        /// What is wrong with it.
        reason: String,
    },
}

/// The scenes that come along.
pub const NAMED: [(&str, &str); 9] = [
    ("drop", include_str!("../scenes/drop.toml")),
    ("drop-3d", include_str!("../scenes/drop-3d.toml")),
    ("squeeze", include_str!("../scenes/squeeze.toml")),
    ("tear", include_str!("../scenes/tear.toml")),
    ("tear-3d", include_str!("../scenes/tear-3d.toml")),
    ("diced", include_str!("../scenes/diced.toml")),
    ("pile", include_str!("../scenes/pile.toml")),
    ("pile-3d", include_str!("../scenes/pile-3d.toml")),
    ("stack", include_str!("../scenes/stack.toml")),
];

impl Scene {
    /// The scene of a name, or in a file; `changes` replace values in it, e.g. `material.young=9000`.
    ///
    /// # Errors
    /// [`SceneError`] says what is wrong and where.
    pub fn open(name: &str, changes: &[String]) -> Result<Self, SceneError> {
        if let Some((_, text)) = NAMED.iter().find(|(known, _)| *known == name) {
            return Self::read(name, text, changes);
        }
        if !Path::new(name).exists() {
            let known: Vec<&str> = NAMED.iter().map(|(known, _)| *known).collect();
            return Err(SceneError::Unknown {
                name: name.into(),
                known: known.join(", "),
            });
        }
        let text = std::fs::read_to_string(name).map_err(|source| SceneError::File {
            path: name.into(),
            source,
        })?;
        Self::read(name, &text, changes)
    }

    /// The scene that a text describes.
    ///
    /// # Errors
    /// [`SceneError::Text`] names line and field.
    pub fn read(name: &str, text: &str, changes: &[String]) -> Result<Self, SceneError> {
        let wrong = |reason: String| SceneError::Text {
            name: name.into(),
            reason,
        };
        // Read once as it stands, so that errors name its lines.
        let scene: Self = toml::from_str(text).map_err(|error| wrong(error.to_string()))?;
        let scene = if changes.is_empty() {
            scene
        } else {
            let table = toml::Table::try_from(&scene).map_err(|error| wrong(error.to_string()))?;
            let mut table = toml::Value::Table(table);
            for change in changes {
                replace(&mut table, change).map_err(wrong)?;
            }
            table
                .try_into()
                .map_err(|error: toml::de::Error| wrong(error.to_string()))?
        };
        if !(2..=3).contains(&scene.dim) {
            return Err(wrong(format!("dim = {} must be 2 or 3", scene.dim)));
        }
        Ok(scene)
    }

    /// The world that it describes.
    ///
    /// # Errors
    /// [`SceneError::Build`] names the entry and what is wrong with it.
    pub fn build<D: Dim>(&self) -> Result<World<D>, SceneError> {
        let bad = |part: String, reason: String| SceneError::Build {
            name: "scene".into(),
            part,
            reason,
        };
        if usize::from(self.dim) != D::N {
            return Err(bad("dim".into(), format!("{} is not {}", self.dim, D::N)));
        }
        let settings = Settings {
            gravity: self.gravity,
            drag: self.drag,
            most_substeps: self.most_substeps,
        };
        let world = World::new(settings);
        let mut world = world.map_err(|reason| bad("settings".into(), reason.to_string()))?;
        let materials = self.materials();
        for (index, text) in self.body.iter().enumerate() {
            let part = || format!("body {}", index + 1);
            let body = text
                .build(&materials)
                .map_err(|reason| bad(part(), reason))?;
            world.add_body(body);
        }
        for (index, text) in self.obstacle.iter().enumerate() {
            let part = || format!("obstacle {}", index + 1);
            let shape = text.shape().map_err(|reason| bad(part(), reason))?;
            let added = world.add_obstacle(shape, text.friction);
            added.map_err(|reason| bad(part(), reason.to_string()))?;
        }
        for (index, text) in self.hand.iter().enumerate() {
            let part = || format!("hand {}", index + 1);
            let drive = if text.kinematic {
                Drive::Kinematic
            } else {
                Drive::default()
            };
            let hand = Manipulator::new(text.goal(0.0), text.radius).driven(drive);
            let added = world.add_manipulator(hand);
            added.map_err(|reason| bad(part(), reason.to_string()))?;
        }
        Ok(world)
    }

    /// Its materials, number 1 first.
    pub fn materials(&self) -> Vec<Material> {
        if self.material.is_empty() {
            return vec![Material::default()];
        }
        self.material.iter().map(MaterialText::material).collect()
    }

    /// Where its hands are to be at the end of a tick [m].
    pub fn goals(&self, tick: u64) -> Vec<[f32; 3]> {
        let seconds = (tick + 1) as f32 / 60.0;
        self.hand.iter().map(|hand| hand.goal(seconds)).collect()
    }

    /// How many ticks to watch it.
    pub fn ticks(&self) -> u64 {
        (self.seconds.max(0.0) * 60.0) as u64
    }
}

impl MaterialText {
    fn material(&self) -> Material {
        let usual = Material::default();
        Material {
            elasticity: Elasticity {
                young: self.young.unwrap_or(usual.elasticity.young),
                poisson: self.poisson.unwrap_or(usual.elasticity.poisson),
            },
            density: self.density.unwrap_or(usual.density),
            damping: self.damping.unwrap_or(usual.damping),
            friction: self.friction.unwrap_or(usual.friction),
            strength: match self.unbreakable {
                true => f32::INFINITY,
                false => self.strength.unwrap_or(usual.strength),
            },
            toughness: self.toughness.unwrap_or(usual.toughness),
        }
    }
}

impl BodyText {
    fn build<D: Dim>(&self, materials: &[Material]) -> Result<Body<D>, String> {
        let grid = self.grid::<D>().map_err(|reason| reason.to_string())?;
        let law = if self.paper_law {
            Law::Endo2004
        } else {
            Law::PatchExact
        };
        let grading = if self.uniform {
            Grading::Uniform
        } else {
            Grading::Graded
        };
        let finite = self.at.iter().chain(&self.velocity).all(|k| k.is_finite());
        if !finite {
            return Err("at and velocity must be finite".into());
        }
        let body = Body::with(grid, materials, law, grading);
        let mut body = body.map_err(|reason: BodyError| reason.to_string())?;
        if self.crumbled {
            body.crumble().map_err(|reason| reason.to_string())?;
        }
        if let Some(spacing) = self.diced {
            let least = body.grid().voxel_size();
            if spacing.is_nan() || spacing < least {
                return Err(format!(
                    "diced = {spacing} m must be at least a voxel, {least} m"
                ));
            }
            for blade in grid_of_blades(&body, spacing) {
                body.cut(&blade).map_err(|reason| reason.to_string())?;
            }
        }
        Ok(body.moved(self.at).thrown(self.velocity))
    }

    fn grid<D: Dim>(&self) -> Result<VoxelGrid<D>, BuildError> {
        let size = self.width / self.n.max(1) as f32;
        match self.shape {
            Form::Ball => VoxelGrid::ball(self.n, self.width),
            Form::Box => {
                let mut extent = self
                    .proportions
                    .map(|k| (k * self.n as f32).round() as usize);
                extent[D::N..].fill(1);
                VoxelGrid::from_fn(extent, size, |_| 1)
            }
            Form::Ring => {
                let ball = VoxelGrid::<D>::ball(self.n, self.width)?;
                let extent = ball.size().map(|k| k as usize);
                let middle = self.n as f32 * 0.5;
                VoxelGrid::from_fn(extent, size, |at| {
                    let squared: f32 = at[..D::N]
                        .iter()
                        .map(|&k| (k as f32 + 0.5 - middle) * (k as f32 + 0.5 - middle))
                        .sum();
                    u8::from(ball.is_solid(at) && squared > 0.25 * middle * middle)
                })
            }
        }
    }
}

/// Planes a distance apart on every axis, through the whole body.
fn grid_of_blades<D: Dim>(body: &Body<D>, spacing: f32) -> Vec<Blade> {
    let size = body
        .grid()
        .size()
        .map(|k| k as f32 * body.grid().voxel_size());
    let long = size.map(|k| 1.2 * k + 1.0);
    let mut blades = Vec::new();
    for axis in 0..D::N {
        let (first, second) = ((axis + 1) % 3, (axis + 2) % 3);
        let mut place = spacing;
        while place < size[axis] {
            let mut blade = Blade {
                from: [0.0; 3],
                across: [0.0; 3],
                along: [0.0; 3],
            };
            blade.from[axis] = place;
            blade.from[first] = -0.5;
            blade.from[second] = -0.5;
            blade.across[first] = long[first];
            blade.along[second] = long[second];
            blades.push(blade);
            place += spacing;
        }
    }
    blades
}

impl ObstacleText {
    fn shape(&self) -> Result<Shape, String> {
        let half_space = self
            .half_space
            .as_ref()
            .map(|text| Shape::half_space(text.normal, text.point));
        let boxed = self.boxed.as_ref().map(|text| Shape::Box {
            centre: text.centre,
            half: text.half,
        });
        let capsule = self.capsule.as_ref().map(|text| Shape::Capsule {
            from: text.from,
            to: text.to,
            radius: text.radius,
        });
        let ball = self.ball.as_ref().map(|text| Shape::Ball {
            centre: text.centre,
            radius: text.radius,
        });
        let shapes: Vec<Shape> = [half_space, boxed, capsule, ball]
            .into_iter()
            .flatten()
            .collect();
        match shapes[..] {
            [shape] => Ok(shape),
            _ => Err("exactly one of half_space, box, capsule and ball is needed".into()),
        }
    }
}

impl HandText {
    /// Where the goal is at a time [s].
    pub fn goal(&self, seconds: f32) -> [f32; 3] {
        let place = |point: &[f32; 4]| [point[1], point[2], point[3]];
        let after = self.path.iter().position(|point| point[0] >= seconds);
        match after {
            None => self.path.last().map_or([0.0; 3], place),
            Some(0) => place(&self.path[0]),
            Some(next) => {
                let (from, to) = (&self.path[next - 1], &self.path[next]);
                let share = (seconds - from[0]) / (to[0] - from[0]).max(1e-6);
                let (from, to) = (place(from), place(to));
                [0, 1, 2].map(|axis: usize| from[axis] + share * (to[axis] - from[axis]))
            }
        }
    }
}

/// Replaces a value: `material.young=9000`; a list without a number means all of its entries.
fn replace(value: &mut toml::Value, change: &str) -> Result<(), String> {
    let (path, new) = change
        .split_once('=')
        .ok_or_else(|| format!("{change:?} must be field=value"))?;
    let read: toml::Table = toml::from_str(&format!("value = {new}"))
        .map_err(|_| format!("{new:?} in {change:?} is not a value"))?;
    let new = &read["value"];
    let fields: Vec<&str> = path.split('.').collect();
    put(value, &fields, new).map_err(|reason| format!("{change:?}: {reason}"))
}

fn put(value: &mut toml::Value, fields: &[&str], new: &toml::Value) -> Result<(), String> {
    let Some((field, rest)) = fields.split_first() else {
        *value = match (&*value, new) {
            // 9000 where 9000.0 is meant.
            (toml::Value::Float(_), toml::Value::Integer(whole)) => {
                toml::Value::Float(*whole as f64)
            }
            _ => new.clone(),
        };
        return Ok(());
    };
    match value {
        toml::Value::Array(entries) => match field.parse::<usize>() {
            Ok(number) => {
                let count = entries.len();
                let entry = number
                    .checked_sub(1)
                    .and_then(|index| entries.get_mut(index));
                let entry =
                    entry.ok_or(format!("there are {count} entries, no number {number}"))?;
                put(entry, rest, new)
            }
            Err(_) => entries
                .iter_mut()
                .try_for_each(|entry| put(entry, fields, new)),
        },
        toml::Value::Table(table) => {
            let absent = toml::Value::Array(Vec::new());
            put(table.entry(*field).or_insert(absent), rest, new)
        }
        _ => Err(format!("{field} is not a field of a single value")),
    }
}

fn usual_gravity() -> [f32; 3] {
    [0.0, -9.81, 0.0]
}

fn usual_substeps() -> u32 {
    64
}

fn usual_seconds() -> f32 {
    3.0
}

fn usual_view() -> [[f32; 3]; 2] {
    [[-0.6, -0.1, -0.6], [1.6, 1.6, 1.6]]
}

fn usual_friction() -> f32 {
    0.2
}

fn one() -> f32 {
    1.0
}

fn unit_proportions() -> [f32; 3] {
    [1.0; 3]
}

#[cfg(test)]
mod tests {
    use super::*;
    use fuwafuwa::{Dim2, Dim3};

    #[test]
    fn every_named_scene_runs() {
        for (name, _) in NAMED {
            let scene = Scene::open(name, &[]).unwrap();
            // Smaller bodies: the scenes are tested here, not the engine.
            let small = ["body.n=12".to_string(), "body.diced=0.3".to_string()];
            let changes = if name == "diced" {
                &small[..]
            } else {
                &small[..1]
            };
            let scene = Scene::open(name, changes).unwrap_or(scene);
            if scene.dim == 2 {
                let mut world = scene.build::<Dim2>().unwrap();
                assert_eq!(world.step().quarantined, 0, "{name}");
            } else {
                let mut world = scene.build::<Dim3>().unwrap();
                assert_eq!(world.step().quarantined, 0, "{name}");
            }
        }
    }

    fn reason(text: &str, changes: &[&str]) -> String {
        let changes: Vec<String> = changes.iter().map(|&change| change.into()).collect();
        let scene = Scene::read("test", text, &changes);
        let built = scene.and_then(|scene| scene.build::<Dim2>().map(|_| ()));
        built.map_or_else(|error| error.to_string(), |()| "fine".into())
    }

    #[test]
    fn errors_name_place_and_cause() {
        let good = "dim = 2\n[[body]]\nshape = \"ball\"\nn = 12\n";
        assert_eq!(reason(good, &[]), "fine");
        assert_eq!(reason(good, &["body.n=8", "material.young=9000"]), "fine");
        let misspelt = good.replace("shape", "shpae");
        assert!(
            reason(&misspelt, &[]).contains("line 3"),
            "{}",
            reason(&misspelt, &[])
        );
        assert!(reason("dim = 7", &[]).contains("2 or 3"));
        assert!(reason(good, &["body.n=0"]).contains("body 1"));
        assert!(reason(good, &["body.n"]).contains("field=value"));
        assert!(reason(good, &["body.3.n=4"]).contains("no number 3"));
        let soft = format!("{good}[[material]]\nyoung = -1.0\n");
        assert!(reason(&soft, &[]).contains("material 1"));
        let odd = format!("{good}[[obstacle]]\nfriction = 0.1\n");
        assert!(reason(&odd, &[]).contains("exactly one"));
        assert!(
            Scene::open("nowhere", &[])
                .unwrap_err()
                .to_string()
                .contains("drop")
        );
    }
}
