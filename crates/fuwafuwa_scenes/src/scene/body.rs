//! Bodies and materials as they are written down.

use super::error::{Wrong, require};
use super::rigid::{BallText, BoxText, CapsuleText, HalfSpaceText};
use base64::Engine;
use base64::prelude::BASE64_STANDARD as BASE64;
use fuwafuwa::law::Elasticity;
use fuwafuwa::{BodyError, Material};
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
    /// Whether it never tears.
    #[serde(default)]
    pub unbreakable: bool,
}

/// A body as it is written down. It needs a `shape` or a `file`.
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

fn one() -> f32 {
    1.0
}

fn unit_proportions() -> [f32; 3] {
    [1.0; 3]
}
