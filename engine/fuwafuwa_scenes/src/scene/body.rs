//! Bodies and materials of a scene file.

use super::error::FieldError;
use super::shapes::{BallText, BoxText, CapsuleText, HalfSpaceText};
use base64::Engine;
use base64::prelude::BASE64_STANDARD as BASE64;
use fuwafuwa::inspect::Elasticity;
use fuwafuwa::library::{self, LibraryMaterial};
use fuwafuwa::{
    Damping, Layers, Material, PronyTerm, RateToughening, StrengthCriterion, StressLaw,
};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// A `[[material]]` table. Missing fields take the values of the material `like`, or of [`Material::default`].
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct MaterialText {
    /// Name of a material of the [library](fuwafuwa::library), for example `"ecoflex-00-30"`.
    pub like: Option<String>,
    /// Young's modulus [Pa].
    pub young: Option<f64>,
    /// Poisson's ratio, 0 to 0.49.
    pub poisson: Option<f64>,
    /// Relation between stress and large strain: `"corotational"` (default), `"neo_hookean"`, or
    /// `{ yeoh = [C₂ / C₁, C₃ / C₁] }`.
    pub stress_law: Option<StressLawText>,
    /// Viscoelasticity: up to two terms of a Prony series, each as [ratio to the shear modulus at rest, relaxation
    /// time in s].
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub prony: Vec<[f32; 2]>,
    /// Density [kg/m³].
    pub density: Option<f32>,
    /// Mass damping [1/s]: damps slow vibrations most.
    pub mass_damping: Option<f32>,
    /// Stiffness damping [s]: damps fast vibrations most.
    pub stiffness_damping: Option<f32>,
    /// Damping ratio at 4 Hz by mass damping, from scenes of version 0.2. Excludes `mass_damping` and
    /// `stiffness_damping`.
    pub damping: Option<f32>,
    /// Coulomb friction between pieces.
    pub friction: Option<f32>,
    /// Rolling resistance of crumbs [1/s].
    pub rolling_resistance: Option<f32>,
    /// Tensile strength of a smooth surface [Pa]: true stress, force per stretched area. Without `hydrostatic_strength`
    /// beside it, the greatest tension decides, also if the material `like` has a hydrostatic strength.
    pub strength: Option<f32>,
    /// Hydrostatic strength [Pa]. With it, stress in all directions counts, by the criterion of Drucker and Prager, and
    /// cracks also start inside; otherwise the greatest tension decides.
    pub hydrostatic_strength: Option<f32>,
    /// Scatter of the strength, 0 to 10: largest relative amount by which the strength of a point is raised.
    pub strength_scatter: Option<f32>,
    /// Fracture toughness in plane strain [Pa √m]. If it is missing, the material keeps the fracture energy of the material
    /// `like`, also with another Young's modulus or Poisson's ratio.
    pub toughness: Option<f32>,
    /// Speed of a crack up to which the fracture energy is constant [m/s], and the exponent with which it grows beyond.
    pub rate_toughening: Option<[f32; 2]>,
    /// Yield strain, beyond which the deformation is permanent; purely elastic if missing.
    pub yield_strain: Option<f32>,
    /// Limit of permanent deformation, 1 to 4: largest factor by which a width can shrink permanently.
    pub plastic_limit: Option<f32>,
    /// Whether the material never tears: infinite strength and toughness, and without `hydrostatic_strength` no
    /// hydrostatic strength.
    pub unbreakable: bool,
    /// Colour in pictures: red, green and blue, 0 to 255 (sRGB). By default, the palette of the renderer
    /// decides by the material number. A material that differs from an earlier one only in its colour is a
    /// tint: it does not affect the simulation.
    pub colour: Option<[u8; 3]>,
}

/// Relation between stress and large strain of a material; see [`StressLaw`].
#[derive(Copy, Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum StressLawText {
    /// Stress in proportion to the strain.
    Corotational,
    /// Neo-Hookean law.
    NeoHookean,
    /// Law of Yeoh: C₂ / C₁ and C₃ / C₁.
    Yeoh([f64; 2]),
}

impl From<StressLawText> for StressLaw {
    fn from(text: StressLawText) -> Self {
        match text {
            StressLawText::Corotational => Self::Corotational,
            StressLawText::NeoHookean => Self::NeoHookean,
            StressLawText::Yeoh([second, third]) => Self::Yeoh { second, third },
        }
    }
}

impl From<StressLaw> for StressLawText {
    fn from(law: StressLaw) -> Self {
        match law {
            StressLaw::Corotational => Self::Corotational,
            StressLaw::NeoHookean => Self::NeoHookean,
            StressLaw::Yeoh { second, third } => Self::Yeoh([second, third]),
        }
    }
}

/// A `[[body]]` table. It requires exactly one of the fields `shape`, `file`, `voxels` and `state`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct BodyText {
    /// Basic shape that fills the grid.
    pub shape: Option<Form>,
    /// File in place of a shape: a picture (in 2D) or a MagicaVoxel model (in 3D). Its content decides the
    /// type, not its name. The path is relative to the folder of the scene.
    pub file: Option<String>,
    /// Name of the part of a MagicaVoxel file that becomes the body: a model or a group. Default: all visible
    /// models. Removed when the part is embedded.
    pub model: Option<String>,
    /// Content of `file` in base64, once it is embedded. Its pixels count as they are, as with `plain`.
    pub content: Option<String>,
    /// List of voxels in place of a shape.
    pub voxels: Option<VoxelsText>,
    /// Complete state of a body in place of a shape, with cracks, deformation and velocity; see
    /// [`Scene::of_world`].
    ///
    /// [`Scene::of_world`]: super::Scene::of_world
    pub state: Option<String>,
    /// Number of voxels across, required for a shape. For a silhouette, the maximum number on the longer
    /// side; not allowed for a model.
    pub n: Option<usize>,
    /// Whether closed outlines of a drawing are filled, default true; see
    /// [`PictureOptions::fill`](crate::import::PictureOptions::fill).
    pub fill: Option<bool>,
    /// Whether the pixels of a picture count as they are, as for pixel art: the empty margin is kept, outlines
    /// are not filled and strokes are not thickened; see [`Picture::grid`](crate::import::Picture::grid).
    /// Default false.
    pub plain: Option<bool>,
    /// Whether a picture without `colours` keeps its own colours as tints, default false; see
    /// [`Picture::import_tinted`](crate::import::Picture::import_tinted). Each tint becomes a material with the
    /// values of `material`. Not allowed with `plain`. Removed when the picture is embedded.
    pub keep_colours: Option<bool>,
    /// Width of the grid [m]; for a file, length of the longest side of its solid part. Default 1.
    pub width: f32,
    /// Number of voxels on each axis in multiples of `n`, e.g. [3.0, 1.0, 1.0]; only for a box or an empty
    /// grid.
    pub proportions: [f32; 3],
    /// Number of the material, default 1; not allowed for a MagicaVoxel model, nor for a picture with
    /// `colours`.
    pub material: Option<u8>,
    /// Material number for each colour of the file (`"#d04030" = 2`; the nearest colour decides) or palette
    /// index of a model (`"79" = 2`); 0 leaves the voxel empty. Without `colours`, the palette indices of a
    /// model are material numbers.
    pub colours: BTreeMap<String, u8>,
    /// Changes to the grid, applied in order.
    pub part: Vec<PartText>,
    /// Position of the low corner [m].
    pub at: [f32; 3],
    /// Velocity [m/s].
    pub velocity: [f32; 3],
    /// Rotation about the low corner, before the translation: axis times angle [rad]; in 2D only about the
    /// third axis.
    #[serde(alias = "turned")]
    pub rotation_vector: Option<[f32; 3]>,
    /// Factor on gravity for this body; default 1.
    pub gravity_scale: Option<f32>,
    /// Contact layers.
    pub layers: Option<LayersText>,
    /// User-defined number, which the engine ignores.
    pub user_data: Option<u64>,
    /// Distance between the planes along which the body is cut on every axis [m]; not cut if
    /// missing.
    pub diced: Option<f32>,
    /// Whether the body is cut into single voxels.
    pub crumbled: bool,
    /// Whether all elements are single voxels, for comparison with graded elements.
    pub uniform: bool,
    /// Whether the elastic force and the criterion of cracks are those of the paper, for figures, instead of the
    /// corotational virtual element law and the energy release rate.
    pub paper_law: bool,
}

/// Voxels of a grid.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct VoxelsText {
    /// Number of voxels on each axis; 1 on the third axis in 2D.
    pub size: [usize; 3],
    /// Edge length of a voxel [m].
    pub voxel_size: f32,
    /// Run lengths of materials, the first axis fastest: `"12x0 4x1"` is 12 empty voxels, then 4 of material
    /// 1.
    pub runs: String,
    /// Smooth surface, if it is known: the bytes of
    /// [`VoxelGrid::surface_offsets`](fuwafuwa::VoxelGrid::surface_offsets) in base64. By default, the surface is
    /// smoothed from the voxels.
    #[serde(default)]
    pub surface: Option<String>,
}

/// Contact layers as bit masks; see [`fuwafuwa::Layers`].
#[derive(Copy, Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LayersText {
    /// Bit mask of the layers that the body is in.
    #[serde(default = "first_layer")]
    pub memberships: u32,
    /// Bit mask of the layers that the body interacts with.
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
    /// Returns the text of `layers`, or `None` for the default layers.
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

/// Basic shape of a body.
#[derive(Copy, Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Form {
    /// A disc or a ball.
    Ball,
    /// A box.
    Box,
    /// A ring (2D) or a torus (3D) with a hole of half its width.
    Ring,
    /// A heart with its point down.
    Heart,
    /// A flower with five petals.
    Flower,
    /// An empty grid, to be filled by parts.
    Empty,
}

/// A change to all voxels with their centres in a shape. It requires one of `fill` and `paint`, and one shape,
/// in metres from the low corner of the body.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PartText {
    /// Number of the material that fills the shape; 0 makes it empty.
    pub fill: Option<u8>,
    /// Number of the material for the solid voxels in the shape; empty voxels stay empty.
    pub paint: Option<u8>,
    /// Half-space below a plane.
    pub half_space: Option<HalfSpaceText>,
    /// Axis-aligned box.
    #[serde(rename = "box")]
    pub boxed: Option<BoxText>,
    /// Capsule.
    pub capsule: Option<CapsuleText>,
    /// Ball.
    pub ball: Option<BallText>,
}

/// Returns the extension of a file name in lower case, e.g. `png`; empty if the name has none.
pub fn extension_of(name: &str) -> String {
    let name = name.rsplit(['/', '\\']).next().unwrap_or(name);
    let ending = name.rsplit_once('.').map(|(_, ending)| ending);
    ending.unwrap_or_default().to_ascii_lowercase()
}

impl MaterialText {
    pub(super) fn material(&self) -> Material {
        let named = self.like.as_deref().and_then(library::find);
        let usual = named.map_or_else(Material::default, LibraryMaterial::material);
        // An unbreakable material gets infinite toughness, too: with infinite strength alone, a crack could
        // enter from a weaker neighbour.
        let borne = |given: Option<f32>, usual| match self.unbreakable {
            true => f32::INFINITY,
            false => given.unwrap_or(usual),
        };
        let elasticity = Elasticity {
            young: self.young.unwrap_or(usual.elasticity.young),
            poisson: self.poisson.unwrap_or(usual.elasticity.poisson),
        };
        // The material `like` has a published fracture energy, from which its toughness follows.
        let toughness = match named.is_some() && elasticity != usual.elasticity {
            true => {
                let Elasticity { young, poisson } = elasticity;
                let energy = f64::from(usual.fracture_energy());
                (energy * young / (1.0 - poisson * poisson)).sqrt() as f32
            }
            false => usual.toughness,
        };
        // The hydrostatic strength of the material `like` belongs to its own tensile strength.
        let strength_criterion = match self.hydrostatic_strength {
            Some(hydrostatic) => StrengthCriterion::DruckerPrager { hydrostatic },
            None if self.unbreakable || self.strength.is_some() => {
                StrengthCriterion::GreatestTension
            }
            None => usual.strength_criterion,
        };
        Material {
            elasticity,
            stress_law: self.stress_law.map_or(usual.stress_law, StressLaw::from),
            prony: match self.prony.is_empty() {
                true => usual.prony,
                false => [0, 1].map(|term: usize| {
                    let given = self.prony.get(term);
                    given.map_or(PronyTerm::NONE, |&[ratio, time]| PronyTerm { ratio, time })
                }),
            },
            density: self.density.unwrap_or(usual.density),
            damping: match self.damping {
                Some(ratio) => Damping::at(ratio, 4.0),
                None => Damping {
                    mass: self.mass_damping.unwrap_or(usual.damping.mass),
                    stiffness: self.stiffness_damping.unwrap_or(usual.damping.stiffness),
                },
            },
            friction: self.friction.unwrap_or(usual.friction),
            rolling_resistance: self.rolling_resistance.unwrap_or(usual.rolling_resistance),
            strength: borne(self.strength, usual.strength),
            strength_criterion,
            strength_scatter: self.strength_scatter.unwrap_or(usual.strength_scatter),
            rate_toughening: match self.rate_toughening {
                Some([speed, exponent]) => RateToughening { speed, exponent },
                None => usual.rate_toughening,
            },
            toughness: borne(self.toughness, toughness),
            yield_strain: self.yield_strain.unwrap_or(usual.yield_strain),
            plastic_limit: self.plastic_limit.unwrap_or(usual.plastic_limit),
        }
    }

    /// Returns a material as a `[[material]]` table with all its values.
    ///
    /// # Errors
    /// An error of the TOML writer.
    pub fn table_of(material: &Material) -> Result<String, toml::ser::Error> {
        let mut table = Self::of(material);
        // Written inline, because a nested table would need the path of the list.
        let law = table.stress_law.take().map(toml::Value::try_from);
        let law = law
            .transpose()?
            .map_or(String::new(), |law| format!("stress_law = {law}\n"));
        Ok(format!("[[material]]\n{}{law}", toml::to_string(&table)?))
    }

    /// Returns the text of a material with all its values, so that later changes of the defaults do not
    /// affect it.
    pub(super) fn of(material: &Material) -> Self {
        let Elasticity { young, poisson } = material.elasticity;
        let unbreakable = material.strength == f32::INFINITY && material.toughness == f32::INFINITY;
        let finite = |borne: f32| (!unbreakable).then_some(borne);
        Self {
            like: None,
            young: Some(young),
            poisson: Some(poisson),
            stress_law: (material.stress_law != StressLaw::Corotational)
                .then_some(material.stress_law.into()),
            prony: prony_text(material),
            density: Some(material.density),
            mass_damping: Some(material.damping.mass),
            stiffness_damping: Some(material.damping.stiffness),
            damping: None,
            friction: Some(material.friction),
            rolling_resistance: (material.rolling_resistance
                != Material::default().rolling_resistance)
                .then_some(material.rolling_resistance),
            strength: finite(material.strength),
            hydrostatic_strength: match material.strength_criterion {
                StrengthCriterion::GreatestTension => None,
                StrengthCriterion::DruckerPrager { hydrostatic } => Some(hydrostatic),
            },
            rate_toughening: (material.rate_toughening != RateToughening::NONE).then_some([
                material.rate_toughening.speed,
                material.rate_toughening.exponent,
            ]),
            strength_scatter: (material.strength_scatter != Material::default().strength_scatter)
                .then_some(material.strength_scatter),
            toughness: finite(material.toughness),
            yield_strain: (material.yield_strain < f32::INFINITY).then_some(material.yield_strain),
            plastic_limit: (material.plastic_limit != Material::default().plastic_limit)
                .then_some(material.plastic_limit),
            unbreakable,
            colour: None,
        }
    }

    /// Checks the ranges of the material's fields.
    pub(super) fn check(&self) -> Result<(), FieldError> {
        let is_doubled = self.damping.is_some()
            && (self.mass_damping.is_some() || self.stiffness_damping.is_some());
        if is_doubled {
            let reason = "excludes `mass_damping` and `stiffness_damping`";
            return Err(FieldError::new("damping", reason.to_owned()));
        }
        if let Some(name) = &self.like
            && library::find(name).is_none()
        {
            return Err(FieldError::new("like", unknown_material(name)));
        }
        if self.prony.len() > 2 {
            let reason = format!("expected at most 2 terms, found {}", self.prony.len());
            return Err(FieldError::new("prony", reason));
        }
        let checked = self.material().check();
        checked.map_err(|error| FieldError::engine("young", error))
    }
}

/// Returns the reason why a name is not one of the library, with the names that resemble it.
fn unknown_material(name: &str) -> String {
    let list = library::similar_names(name).join(", ");
    let name: String = name.chars().take(40).collect();
    format!("expected a material of the library ({list}), found {name:?}")
}

/// Returns the terms of the Prony series of a material, up to the last one that has an effect.
fn prony_text(material: &Material) -> Vec<[f32; 2]> {
    let terms = material
        .prony
        .map(|PronyTerm { ratio, time }| [ratio, time]);
    let last = terms.iter().rposition(|[ratio, _]| *ratio != 0.0);
    terms[..last.map_or(0, |last| last + 1)].to_vec()
}

impl BodyText {
    /// Decodes the embedded content of the file.
    pub(super) fn file_bytes(&self) -> Result<Vec<u8>, FieldError> {
        let wrong = |reason: String| FieldError::new("content", reason);
        let missing = || wrong("expected the content of the file".into());
        let text = self.content.as_ref().ok_or_else(missing)?;
        let bytes = BASE64.decode(text);
        bytes.map_err(|error| wrong(format!("expected base64: {error}")))
    }

    /// Returns whether the content of the body's file is missing.
    pub fn lacks_content(&self) -> bool {
        self.file.is_some() && self.content.is_none()
    }

    /// Embeds `bytes` as the content of the file.
    pub(super) fn embed(&mut self, bytes: &[u8]) {
        self.content = Some(BASE64.encode(bytes));
    }
}

impl Default for BodyText {
    fn default() -> Self {
        Self {
            shape: None,
            file: None,
            model: None,
            content: None,
            voxels: None,
            state: None,
            n: None,
            fill: None,
            plain: None,
            keep_colours: None,
            width: 1.0,
            proportions: [1.0; 3],
            material: None,
            colours: BTreeMap::new(),
            part: Vec::new(),
            at: [0.0; 3],
            velocity: [0.0; 3],
            rotation_vector: None,
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
