//! Bodies and materials as they are written down.

use super::error::{Wrong, require};
use super::rigid::{BallText, BoxText, CapsuleText, HalfSpaceText};
use base64::Engine;
use base64::prelude::BASE64_STANDARD as BASE64;
use fuwafuwa::law::Elasticity;
use fuwafuwa::{BodyError, Layers, Material};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

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
    /// The strain beyond which it keeps a dent; none when left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub yield_strain: Option<f32>,
    /// To how many times less than its width it is pressed for good.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub plastic_limit: Option<f32>,
    /// Whether it never tears.
    #[serde(default)]
    pub unbreakable: bool,
}

/// A body as it is written down. It needs a `shape`, a `file`, `voxels` or a `state`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BodyText {
    /// What fills its grid.
    pub shape: Option<Form>,
    /// In place of a shape: a silhouette (.png, in 2D) or a model of MagicaVoxel (.vox, in 3D). A path
    /// is taken from the folder of the scene.
    pub file: Option<String>,
    /// The bytes of that file in base64, once they travel with the scene.
    pub content: Option<String>,
    /// In place of a shape: its voxels, one by one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub voxels: Option<VoxelsText>,
    /// In place of a shape: all of it as it was, however torn, deformed and thrown; see [`Scene::of_world`].
    ///
    /// [`Scene::of_world`]: super::Scene::of_world
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub state: Option<String>,
    /// Voxels across; of a silhouette at most so many, of a model it is not asked.
    pub n: Option<usize>,
    /// Width of the grid [m]; with a file, of its longest side.
    #[serde(default = "one")]
    pub width: f32,
    /// Of a box or an empty grid: voxels on each axis in terms of `n`, e.g. [3.0, 1.0, 1.0].
    #[serde(default = "unit_proportions")]
    pub proportions: [f32; 3],
    /// The number of its material, 1 when left out; not for models and where `colours` are named.
    pub material: Option<u8>,
    /// The number of the material of each colour of the file (`"#d04030" = 2`, the nearest counts) or
    /// palette index of a model (`"79" = 2`); 0 leaves it out. Without it a model's palette indices
    /// are numbers of materials.
    #[serde(default)]
    pub colours: BTreeMap<String, u8>,
    /// Changes to the grid, in their order.
    #[serde(default)]
    pub part: Vec<PartText>,
    /// Its low corner [m].
    #[serde(default)]
    pub at: [f32; 3],
    /// [m/s]
    #[serde(default)]
    pub velocity: [f32; 3],
    /// Turned about its low corner, before it is moved there: axis times angle [rad]; in the plane about the third alone.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub turned: Option<[f32; 3]>,
    /// How many times as strongly as on others gravity pulls on it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gravity_scale: Option<f32>,
    /// Whom it touches.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub layers: Option<LayersText>,
    /// A number of the user's.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub user_data: Option<u64>,
    /// Cut along planes this far apart on every axis [m].
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

/// The voxels of a grid as they are written down.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct VoxelsText {
    /// Voxels on each axis; 1 on the third in 2D.
    pub size: [usize; 3],
    /// Edge length of a voxel [m].
    pub voxel_size: f32,
    /// Runs of materials, the first axis running fastest: `"12x0 4x1"` are twelve voxels that are empty and four of material 1.
    pub runs: String,
}

/// Layers as they are written down: see [`fuwafuwa::Layers`].
#[derive(Copy, Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LayersText {
    /// Those that it is in, bit by bit.
    #[serde(default = "first_layer")]
    pub memberships: u32,
    /// Those that it meets, bit by bit.
    #[serde(default = "all_layers")]
    pub filters: u32,
}

impl From<LayersText> for Layers {
    fn from(text: LayersText) -> Self {
        Self {
            memberships: text.memberships,
            filters: text.filters,
        }
    }
}

impl LayersText {
    /// What is to be said of layers, if they are not the usual ones.
    pub(super) fn of(layers: Layers) -> Option<Self> {
        (layers != Layers::default()).then_some(Self {
            memberships: layers.memberships,
            filters: layers.filters,
        })
    }
}

fn first_layer() -> u32 {
    Layers::default().memberships
}

fn all_layers() -> u32 {
    Layers::default().filters
}

/// What fills a grid.
#[derive(Copy, Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Form {
    /// A disc or a ball.
    Ball,
    /// A box.
    Box,
    /// A ring, in 3D a torus, with a hole of half its width.
    Ring,
    /// A heart, its point down.
    Heart,
    /// A flower of five petals.
    Flower,
    /// Nothing: parts fill it.
    Empty,
}

/// A change to the voxels whose centres lie in a shape: either `fill` or `paint`, and one of the
/// shapes, in metres from the low corner of the body.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PartText {
    /// The number of the material that fills the shape; 0 empties it.
    pub fill: Option<u8>,
    /// The number of the material that what is solid in the shape becomes.
    pub paint: Option<u8>,
    /// Everything below a plane.
    pub half_space: Option<HalfSpaceText>,
    /// Middle and half widths [m].
    #[serde(rename = "box")]
    pub boxed: Option<BoxText>,
    /// A bar with round ends.
    pub capsule: Option<CapsuleText>,
    /// A ball.
    pub ball: Option<BallText>,
}

/// What the name of a file ends in, as in `png`: in small letters, and empty where it has no ending.
pub fn ending_of(name: &str) -> String {
    let name = name.rsplit(['/', '\\']).next().unwrap_or(name);
    let ending = name.rsplit_once('.').map(|(_, ending)| ending);
    ending.unwrap_or_default().to_ascii_lowercase()
}

impl MaterialText {
    pub(super) fn material(&self) -> Material {
        let usual = Material::default();
        // Infinite strength alone would let a crack in from a weaker neighbour.
        let borne = |given: Option<f32>, usual| match self.unbreakable {
            true => f32::INFINITY,
            false => given.unwrap_or(usual),
        };
        Material {
            elasticity: Elasticity {
                young: self.young.unwrap_or(usual.elasticity.young),
                poisson: self.poisson.unwrap_or(usual.elasticity.poisson),
            },
            density: self.density.unwrap_or(usual.density),
            damping: self.damping.unwrap_or(usual.damping),
            friction: self.friction.unwrap_or(usual.friction),
            strength: borne(self.strength, usual.strength),
            toughness: borne(self.toughness, usual.toughness),
            yield_strain: self.yield_strain.unwrap_or(usual.yield_strain),
            plastic_limit: self.plastic_limit.unwrap_or(usual.plastic_limit),
        }
    }

    /// What is to be said of a material: every number, so that it stays what it is.
    pub(super) fn of(material: &Material) -> Self {
        let Elasticity { young, poisson } = material.elasticity;
        let unbreakable = material.strength == f32::INFINITY && material.toughness == f32::INFINITY;
        let finite = |borne: f32| (!unbreakable).then_some(borne);
        Self {
            young: Some(young),
            poisson: Some(poisson),
            density: Some(material.density),
            damping: Some(material.damping),
            friction: Some(material.friction),
            strength: finite(material.strength),
            toughness: finite(material.toughness),
            yield_strain: (material.yield_strain < f32::INFINITY).then_some(material.yield_strain),
            plastic_limit: (material.plastic_limit != Material::default().plastic_limit)
                .then_some(material.plastic_limit),
            unbreakable,
        }
    }

    /// Checks the material of this text.
    pub(super) fn check(&self) -> Result<(), Wrong> {
        let material = self.material();
        let Elasticity { young, poisson } = material.elasticity;
        let good = young > 0.0 && young.is_finite();
        let expected = format!("expected a positive number of pascals, found {young}");
        require(good, "young", expected)?;
        let expected = format!("expected 0 to 0.45, found {poisson}");
        require((0.0..=0.45).contains(&poisson), "poisson", expected)?;
        material.check(0).map_err(|error| match error {
            BodyError::BadMaterial {
                field,
                given,
                expected,
                ..
            } => Wrong::new(field, format!("expected {expected}, found {given}")),
            error => Wrong::new("young", error),
        })
    }
}

impl BodyText {
    /// The bytes of its file.
    pub(super) fn file_bytes(&self) -> Result<Vec<u8>, Wrong> {
        let wrong = |reason: String| Wrong::new("content", reason);
        let missing = || wrong("expected the content of the file".into());
        let text = self.content.as_ref().ok_or_else(missing)?;
        let bytes = BASE64.decode(text);
        bytes.map_err(|error| wrong(format!("expected base64: {error}")))
    }

    /// Whether the file that it is made from is not there.
    pub fn lacks_content(&self) -> bool {
        self.file.is_some() && self.content.is_none()
    }

    /// Takes the bytes of its file along.
    pub(super) fn embed(&mut self, bytes: &[u8]) {
        self.content = Some(BASE64.encode(bytes));
    }
}

impl Default for BodyText {
    fn default() -> Self {
        Self {
            shape: None,
            file: None,
            content: None,
            voxels: None,
            state: None,
            n: None,
            width: one(),
            proportions: unit_proportions(),
            material: None,
            colours: BTreeMap::new(),
            part: Vec::new(),
            at: [0.0; 3],
            velocity: [0.0; 3],
            turned: None,
            gravity_scale: None,
            layers: None,
            user_data: None,
            diced: None,
            crumbled: false,
            uniform: false,
            paper_law: false,
        }
    }
}

fn one() -> f32 {
    1.0
}

fn unit_proportions() -> [f32; 3] {
    [1.0; 3]
}
