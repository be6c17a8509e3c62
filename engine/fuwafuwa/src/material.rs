//! Materials of voxels.

use crate::error::{Error, require};
use crate::foundation::hash::{Hash, HashState};
use crate::fracture::strength::{RateToughening, StrengthCriterion};
use crate::soft_body::element_law::Elasticity;
use crate::soft_body::hyperelasticity::StressLaw;
use crate::soft_body::plasticity::Plasticity;
use crate::soft_body::rayleigh::Damping;
use crate::soft_body::viscosity::PronyTerm;

/// Material of a voxel.
#[derive(Copy, Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Material {
    /// Elastic constants: stiffness and lateral expansion, at small strains and at rest.
    pub elasticity: Elasticity,
    /// Relation between stress and large strain; default [`StressLaw::Corotational`].
    pub stress_law: StressLaw,
    /// Viscoelasticity: two terms of a Prony series, default none.
    pub prony: [PronyTerm; 2],
    /// Density [kg/m³]; usually about 100. In 2D it is that of a sheet 1 m deep.
    pub density: f32,
    /// Rayleigh damping: mass damping [1/s] and stiffness damping [s].
    pub damping: Damping,
    /// Coulomb friction coefficient between pieces and between bodies, 0 to 2; usually about 0.4. A contact
    /// between two soft surfaces uses the mean of their coefficients. A contact with a rigid body uses the
    /// [friction of the rigid body](crate::RigidBody::friction) alone.
    ///
    /// Blocks slide and rest as Coulomb's law says. A soft block with little damping may flutter and hop where
    /// friction takes up most of its weight, for example on a slope of 0.7 with a friction of 0.8; see
    /// `fuwafuwa check slope`.
    pub friction: f32,
    /// Rolling resistance of pieces of a single voxel: decay rate of their angular velocity while they touch
    /// something [1/s], 0 to 1000, default 20. Other pieces touch such a crumb as a ball, but it stands for an
    /// angular grain, which does not roll. At the default, the rotation falls to an eighth in 0.1 s. At a higher
    /// rate, a bounce would stop the rotation. With 0, crumbs roll like balls. Larger pieces have corners and do
    /// not use it. A body of several materials uses the mean over its voxels.
    pub rolling_resistance: f32,
    /// Tensile strength of a smooth surface [Pa], default 1000: the true (Cauchy) stress at which a crack starts;
    /// infinite = no crack starts. A player can tear a body with a strength of a fifth of Young's modulus by hand.
    ///
    /// Sources publish the nominal stress, the force per original area. The true stress of an incompressible bar at break is
    /// the nominal one times the stretch; [`LibraryMaterial`](crate::library::LibraryMaterial::material) converts it.
    ///
    /// The tension is the mean over the radius 0.5 (toughness / strength)² [Taylor 2007]. Below a voxel, and above
    /// 8 voxels in 2D or 4 in 3D, the mean is extrapolated, to at least 1/64 and at most 64 voxels. A crack that is
    /// short compared with this radius grows at the strength, too. Elements with all nodes fixed do not count.
    pub strength: f32,
    /// Criterion by which stress in several directions counts against the strength; default
    /// [`StrengthCriterion::GreatestTension`].
    pub strength_criterion: StrengthCriterion,
    /// Scatter of the strength, 0 to 10, default 0.4: at each lattice point of a smooth surface, the strength is
    /// raised by a fixed pseudo-random share of 0 to this value. With 0, a row of equally loaded points fails
    /// at once.
    pub strength_scatter: f32,
    /// Fracture toughness K_Ic [Pa √m] in plane strain, default 150; infinite = cracks that have started do not
    /// grow. A crack grows as soon as its energy release rate exceeds the [fracture
    /// energy](Self::fracture_energy), in the direction that releases most energy [Griffith 1921]. Neither its load
    /// nor its direction depends on the size or the direction of the voxels. In 2D, cracks grow within 4 % of this
    /// toughness, in 3D within 12 % (`fuwafuwa check lefm`).
    ///
    /// Rule of thumb, with toughness in Pa √m and strength in Pa: at toughness = 0.15 strength, a crack that
    /// has started keeps running; at toughness = 0.4 strength, cracks stop near the surface.
    pub toughness: f32,
    /// Growth of the fracture energy with the speed of a crack or of a cutting edge; default none.
    pub rate_toughening: RateToughening,
    /// Yield strain; infinite (default) = purely elastic, like rubber. Strain beyond the yield strain becomes
    /// permanent; volume is preserved.
    ///
    /// 0.05 is clay, which keeps its pressed shape; 0.3 is dough, which yields slowly. Far below 0.01, a body
    /// flows under its own weight. Ignored under [`Law::Endo2004`](crate::Law::Endo2004); must be infinite under a
    /// hyperelastic [`stress_law`](Self::stress_law).
    pub yield_strain: f32,
    /// Plastic limit, 1 to 4: the largest factor by which plastic flow can shrink a width; usually about 2.
    /// An element at the limit deforms only elastically. A higher limit allows thinner sheets, but also
    /// flatter elements.
    pub plastic_limit: f32,
}

impl HashState for Material {
    /// Laws that are younger than the others are hashed only if they differ from the default, so that the hashes of
    /// worlds without them are those of earlier versions.
    fn hash_state(&self, hash: &mut Hash) {
        let Self {
            elasticity,
            stress_law,
            prony,
            density,
            damping,
            friction,
            rolling_resistance,
            strength,
            strength_criterion,
            strength_scatter,
            toughness,
            rate_toughening,
            yield_strain,
            plastic_limit,
        } = self;
        elasticity.hash_state(hash);
        density.hash_state(hash);
        damping.hash_state(hash);
        for number in [
            friction,
            rolling_resistance,
            strength,
            strength_scatter,
            toughness,
            yield_strain,
            plastic_limit,
        ] {
            number.hash_state(hash);
        }
        if *stress_law != StressLaw::Corotational {
            stress_law.hash_state(hash);
        }
        if *strength_criterion != StrengthCriterion::GreatestTension {
            strength_criterion.hash_state(hash);
        }
        if *rate_toughening != RateToughening::NONE {
            rate_toughening.hash_state(hash);
        }
        if *prony != [PronyTerm::NONE; 2] {
            prony.iter().for_each(|term| term.hash_state(hash));
        }
    }
}

impl Default for Material {
    /// Soft body for a game: Young's modulus 5000 Pa, Poisson's ratio 0.3, density 100 kg/m³. A thin rigid
    /// body that pushes with some 1000 N tears a body 1 m across. In 3D, a fall of a few decimetres cracks
    /// the body. Raise the strength for higher loads.
    fn default() -> Self {
        Self {
            elasticity: Elasticity {
                young: 5000.0,
                poisson: 0.3,
            },
            stress_law: StressLaw::Corotational,
            prony: [PronyTerm::NONE; 2],
            density: 100.0,
            damping: Damping::default(),
            friction: 0.4,
            rolling_resistance: 20.0,
            strength: 1000.0,
            strength_criterion: StrengthCriterion::GreatestTension,
            strength_scatter: 0.4,
            toughness: 150.0,
            rate_toughening: RateToughening::NONE,
            yield_strain: f32::INFINITY,
            plastic_limit: 2.0,
        }
    }
}

impl Material {
    /// Checks every field.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] names the first field that is out of range.
    pub fn check(&self) -> Result<(), Error> {
        let Elasticity { young, poisson } = self.elasticity;
        Elasticity::new(young, poisson)?;
        self.stress_law.check()?;
        self.prony.into_iter().try_for_each(PronyTerm::check)?;
        let within = |field, given: f32, low: f32, high: f32, expected| {
            require(given >= low && given <= high, field, expected, given)
        };
        let (tiny, huge) = (f32::MIN_POSITIVE, f32::MAX);
        within("density", self.density, tiny, huge, "positive and finite")?;
        self.damping.check()?;
        within("friction", self.friction, 0.0, 2.0, "0 to 2")?;
        let rolling = self.rolling_resistance;
        within("rolling_resistance", rolling, 0.0, 1000.0, "0 to 1000")?;
        let infinite = f32::INFINITY;
        within("strength", self.strength, tiny, infinite, "positive")?;
        within(
            "strength_scatter",
            self.strength_scatter,
            0.0,
            10.0,
            "0 to 10",
        )?;
        self.strength_criterion.check(self.strength)?;
        within("toughness", self.toughness, tiny, infinite, "positive")?;
        self.rate_toughening.check()?;
        within(
            "yield_strain",
            self.yield_strain,
            tiny,
            infinite,
            "positive",
        )?;
        within("plastic_limit", self.plastic_limit, 1.0, 4.0, "1 to 4")?;
        let is_valid = self.yield_strain == infinite || self.stress_law == StressLaw::Corotational;
        let expected = "infinite under a hyperelastic stress law";
        require(is_valid, "yield_strain", expected, self.yield_strain)
    }

    /// Soft clay for a game: keeps the shape into which it is pressed.
    ///
    /// ```
    /// use fuwafuwa::{Dim2, Material, RigidBody, Shape, SoftBody, Vec2, VoxelGrid, World, WorldConfig};
    ///
    /// let mut world = World::<Dim2>::new(WorldConfig::default())?;
    /// world.add_rigid_body(RigidBody::fixed(Shape::half_space(Vec2::Y, Vec2::ZERO)))?;
    /// let block = SoftBody::new(VoxelGrid::cube(12, 1.0)?, &[Material::clay()])?;
    /// let block = world.add_soft_body(block)?;
    /// let hand = RigidBody::coupled(Shape::ball(0.2)).at(Vec2::new(0.5, 1.2));
    /// let hand = world.add_rigid_body(hand)?;
    /// for height in [0.6, 1.6] {
    ///     world.set_target_position(hand, Vec2::new(0.5, height))?;
    ///     (0..60).for_each(|_| _ = world.step());
    /// }
    /// let body = &world[block];
    /// let most = body.mesh().elements().filter_map(|(id, _)| body.plastic_strain(id));
    /// assert!(most.fold(0.0, f32::max) > 0.1);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn clay() -> Self {
        Self {
            density: 400.0,
            damping: Damping {
                mass: 12.0,
                stiffness: 1e-3,
            },
            friction: 0.6,
            strength: f32::INFINITY,
            toughness: f32::INFINITY,
            yield_strain: 0.05,
            ..Self::default()
        }
    }

    /// Returns the yield strain and the plastic limit; `None` if the material is purely elastic.
    pub(crate) fn plasticity(&self) -> Option<Plasticity> {
        (self.yield_strain < f32::INFINITY).then(|| Plasticity {
            yield_strain: f64::from(self.yield_strain),
            limit: f64::from(self.plastic_limit),
        })
    }

    /// Returns whether cracks can start away from surfaces.
    pub(crate) fn cracks_inside(&self) -> bool {
        self.strength_criterion != StrengthCriterion::GreatestTension
    }

    /// Returns whether the material is viscoelastic.
    pub(crate) fn is_viscous(&self) -> bool {
        self.prony.iter().any(|term| term.ratio > 0.0)
    }

    /// Fracture energy per area of crack in plane strain: toughness² (1 − ν²) / Y [J/m²] [Irwin 1957].
    pub fn fracture_energy(&self) -> f32 {
        let Elasticity { young, poisson } = self.elasticity;
        let toughness = f64::from(self.toughness);
        (toughness * toughness * (1.0 - poisson * poisson) / young) as f32
    }

    /// Shear modulus at the time `time` [s] after a sudden shear, divided by the shear modulus at rest:
    /// 1 + Σ gᵢ exp(−t/τᵢ), with the terms of the [Prony series](Self::prony).
    pub fn relaxation(&self, time: f64) -> f64 {
        let terms = self
            .prony
            .iter()
            .map(|term| f64::from(term.ratio) * libm::exp(-time.max(0.0) / f64::from(term.time)));
        1.0 + terms.sum::<f64>()
    }

    /// Fracture energy per area [J/m²] of a crack that grows at `speed` [m/s]: the
    /// [fracture energy](Self::fracture_energy), raised by the [rate toughening](Self::rate_toughening).
    pub fn fracture_energy_at(&self, speed: f32) -> f32 {
        self.fracture_energy() * self.rate_toughening.factor(speed)
    }

    /// Speed of a fast pressure wave [m/s]: √((λ + 2µ + 4/3 µ Σg) / ρ), with Lamé's parameters λ and µ at rest, the ratios g of
    /// the [Prony series](Self::prony), of which only shear takes part, and the density ρ.
    pub fn wave_speed(&self) -> f64 {
        let shear = self.elasticity.shear_modulus();
        let relaxing = shear * (self.relaxation(0.0) - 1.0);
        let stiffness = self.elasticity.lame() + 2.0 * shear + 4.0 / 3.0 * relaxing;
        (stiffness / f64::from(self.density)).sqrt()
    }

    /// Returns Ω s [m/s]: the angular frequency Ω of the breathing mode of a single free voxel, times the
    /// width s of the voxel.
    ///
    /// In the breathing mode, the distance of every node from the centre of the voxel grows by the factor 1 +
    /// ε. In N dimensions, the elastic energy per volume is ½ N² (λ + 2µ/N) ε², with Lamé's parameters λ and
    /// µ. The kinetic energy per volume is ½ ρ N s²/4 ε'², because the mass, of density ρ, sits in the
    /// corners. Therefore Ω² = 4 N (λ + 2µ/N) / ρs². Here µ is that of fast motion, which is an upper bound: the mode has
    /// little shear in 2D and none in 3D.
    pub(crate) fn breathing_speed(&self, dimensions: usize) -> f64 {
        let axes = dimensions as f64;
        let shear = self.elasticity.shear_modulus() * self.relaxation(0.0);
        let stiffness = axes * self.elasticity.lame() + 2.0 * shear;
        2.0 * (stiffness / f64::from(self.density)).sqrt()
    }
}
