//! What a voxel is made of, and why a body could not be made of it.

use crate::law::{BadElasticity, Elasticity};
use crate::mesh::Defect;
use crate::plasticity::Plasticity;
use std::fmt;

/// What a voxel is made of.
#[derive(Copy, Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Material {
    /// Stiffness and bulging.
    pub elasticity: Elasticity,
    /// Density [kg/m³], in 2D of a sheet 1 m deep; a game body has about 100.
    pub density: f32,
    /// Damping ratio of a body's slowest own swing: 0 rings on for ever, 1 creeps back; about 0.08.
    pub damping: f32,
    /// Coulomb friction between pieces and between bodies, 0 to 2; about 0.4. Of two it is the mean. With what is rigid
    /// it does not count: that brings its [own](crate::Rigid::friction).
    pub friction: f32,
    /// Tension that the weakest place of a smooth surface bears [Pa]; infinite = it never tears. A
    /// fifth of Young's modulus gives a body that can be torn by hand.
    pub strength: f32,
    /// What a crack tip bears: tension times the root of the distance over which it is spread
    /// [Pa √m]. The tip of a crack is as sharp as a voxel is small, so its tension grows with
    /// 1/√voxel and must be compared with toughness/√voxel: that makes a body tear at the same
    /// load whatever its resolution [Griffith 1921]. A fifth of the strength, in these units, is a
    /// body whose cracks run once they have begun; half of it is one that only scuffs.
    pub toughness: f32,
    /// The strain that it bears: what is drawn out, pressed or bent by more keeps the rest as a dent, its volume kept;
    /// infinite = it springs back from anything, as rubber does. About 0.05 is clay, which stays as it is pressed, 0.3 is
    /// dough, which gives way slowly. Far below 0.01 it runs under its own weight. Without meaning under
    /// [`Law::Endo2004`](crate::Law::Endo2004).
    pub yield_strain: f32,
    /// How far it can be kneaded, 1 to 4: to how many times less than its width it is pressed for good; beyond that it
    /// springs. About 2; more makes thin sheets, whose elements are as flat.
    pub plastic_limit: f32,
}

impl Default for Material {
    /// A soft body for a game: Y = 5000 Pa, ν = 0.3, 100 kg/m³. A body 1 m across is torn by a thin
    /// hand that pushes with some 1000 N, and in space cracked by a fall of a few decimetres: what
    /// has to bear more wants more strength.
    fn default() -> Self {
        Self {
            elasticity: Elasticity {
                young: 5000.0,
                poisson: 0.3,
            },
            density: 100.0,
            damping: 0.08,
            friction: 0.4,
            strength: 1000.0,
            toughness: 200.0,
            yield_strain: f32::INFINITY,
            plastic_limit: 2.0,
        }
    }
}

/// Why a body could not be made.
#[derive(Clone, Debug, PartialEq)]
pub enum BodyError {
    /// The grid names a material that was not given.
    MissingMaterial {
        /// Number in the grid, from 1.
        number: u8,
    },
    /// A field of a material is out of range.
    BadMaterial {
        /// Number in the grid, from 1.
        number: usize,
        /// The field.
        field: &'static str,
        /// What it was.
        given: f32,
        /// What was expected.
        expected: &'static str,
    },
    /// The elastic constants of a material are out of range.
    Elasticity {
        /// Number in the grid, from 1.
        number: usize,
        /// What is wrong with them.
        reason: BadElasticity,
    },
    /// The mesh is broken: a fault of this library.
    Mesh(Defect),
}

impl fmt::Display for BodyError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::MissingMaterial { number } => {
                write!(f, "the grid uses material {number}, which was not given")
            }
            Self::BadMaterial {
                number,
                field,
                given,
                expected,
            } => write!(f, "material {number}: {field} = {given} must be {expected}"),
            Self::Elasticity { number, reason } => write!(f, "material {number}: {reason}"),
            Self::Mesh(defect) => write!(f, "the mesh is broken: {defect}"),
        }
    }
}

impl std::error::Error for BodyError {}

impl From<Defect> for BodyError {
    fn from(defect: Defect) -> Self {
        Self::Mesh(defect)
    }
}

impl Material {
    /// Checks every field; `number` says in the error which material it is.
    ///
    /// # Errors
    /// [`BodyError`] names the first field that is out of range.
    pub fn check(&self, number: usize) -> Result<(), BodyError> {
        let Elasticity { young, poisson } = self.elasticity;
        Elasticity::new(young, poisson)
            .map_err(|reason| BodyError::Elasticity { number, reason })?;
        let within = |field, given: f32, low: f32, high: f32, expected| {
            let bad = BodyError::BadMaterial {
                number,
                field,
                given,
                expected,
            };
            (given >= low && given <= high).then_some(()).ok_or(bad)
        };
        let (tiny, huge) = (f32::MIN_POSITIVE, f32::MAX);
        within("density", self.density, tiny, huge, "positive and finite")?;
        within("damping", self.damping, 0.0, 1.0, "0 to 1")?;
        within("friction", self.friction, 0.0, 2.0, "0 to 2")?;
        let infinite = f32::INFINITY;
        within("strength", self.strength, tiny, infinite, "positive")?;
        within("toughness", self.toughness, tiny, infinite, "positive")?;
        within(
            "yield_strain",
            self.yield_strain,
            tiny,
            infinite,
            "positive",
        )?;
        within("plastic_limit", self.plastic_limit, 1.0, 4.0, "1 to 4")
    }

    /// Soft clay, for a game: what it is pressed into it stays.
    ///
    /// ```
    /// use fuwafuwa::{Body, Dim2, Material, Rigid, Settings, Shape, VoxelGrid, World};
    ///
    /// let mut world = World::<Dim2>::new(Settings::default())?;
    /// world.add_rigid(Rigid::fixed(Shape::half_space([0.0, 1.0, 0.0], [0.0; 3]), 0.5))?;
    /// let block = Body::new(VoxelGrid::cube(12, 1.0)?, &[Material::clay()])?;
    /// let block = world.add_body(block);
    /// let hand = world.add_rigid(Rigid::hand([0.5, 1.2, 0.0], 0.2))?;
    /// for height in [0.6, 1.6] {
    ///     world.set_goal(hand, [0.5, height, 0.0])?;
    ///     (0..60).for_each(|_| _ = world.step());
    /// }
    /// let body = &world.bodies()[block];
    /// let most = body.mesh().elements().filter_map(|(id, _)| body.plastic_strain(id));
    /// assert!(most.fold(0.0, f32::max) > 0.1);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn clay() -> Self {
        Self {
            density: 400.0,
            damping: 0.5,
            friction: 0.6,
            strength: f32::INFINITY,
            toughness: f32::INFINITY,
            yield_strain: 0.05,
            ..Self::default()
        }
    }

    /// When it keeps its dents, if it does.
    pub(crate) fn plasticity(&self) -> Option<Plasticity> {
        (self.yield_strain < f32::INFINITY).then(|| Plasticity {
            yield_strain: f64::from(self.yield_strain),
            limit: f64::from(self.plastic_limit),
        })
    }

    /// The energy that a square metre of crack takes: toughness² / Y [J/m²] [Irwin 1957].
    pub fn fracture_energy(&self) -> f32 {
        (f64::from(self.toughness) * f64::from(self.toughness) / self.elasticity.young) as f32
    }

    /// Speed of a pressure wave [m/s].
    pub fn wave_speed(&self) -> f64 {
        let stiffness = self.elasticity.lame() + 2.0 * self.elasticity.shear_modulus();
        (stiffness / f64::from(self.density)).sqrt()
    }

    /// How fast a voxel by itself swings as it grows and shrinks, times its width [m/s].
    ///
    /// Let all its nodes be (1 + ε) times as far from its middle, in N dimensions: it holds the
    /// energy ½ N² (λ + 2µ/N) ε² in a unit of volume, and moves with ½ ρ N s²/4 ε'², because its
    /// mass is in its corners; so Ω² = 4 N (λ + 2µ/N) / ρs².
    pub(crate) fn voxel_swing(&self, dimensions: usize) -> f64 {
        let axes = dimensions as f64;
        let stiffness = axes * self.elasticity.lame() + 2.0 * self.elasticity.shear_modulus();
        2.0 * (stiffness / f64::from(self.density)).sqrt()
    }
}
