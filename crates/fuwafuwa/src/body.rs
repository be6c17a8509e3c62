//! One soft thing: its voxels, how they hang together, and the state of its nodes.

mod asleep;
mod blend;
pub(crate) mod cooldowns;
mod derived;
mod motion;
#[cfg(feature = "serde")]
mod sound;

use crate::breakable::BreakableNodes;
use crate::dim::{Dim, Point};
use crate::grid::VoxelGrid;
use crate::handle::{Arena, BodyId};
use crate::law::Law;
use crate::material::{BodyError, Material};
use crate::mesh::{Element, Mesh};
use crate::momentum::{Momentum, RoughMotion};
use crate::piece::Pieces;
use crate::pyramid::{Grading, Pyramid};
use crate::sharing::Sharing;
use crate::solve::{Blocks, Row};
use crate::vector::{as_row, dot, three};
use blend::{Blend, elasticities};
use cooldowns::Cooldowns;

/// The bodies of a world.
pub type Bodies<D> = Arena<BodyId, Body<D>>;

/// One soft thing, whole or in pieces.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(bound = ""))]
pub struct Body<D: Dim> {
    pub(crate) grid: VoxelGrid<D>,
    pub(crate) sharing: Sharing<D>,
    pub(crate) pyramid: Pyramid<D>,
    pub(crate) mesh: Mesh<D>,
    pub(crate) blocks: Blocks<D>,
    pub(crate) pieces: Pieces,
    materials: Vec<Material>,
    blend: Blend,
    /// By what its stiffness was lowered so that the substep bears it; 1 = not at all.
    stiffness_scale: f64,
    /// Position [m], velocity [m/s] and mass [kg] of each node, by id.
    pub(crate) position: Vec<Row>,
    pub(crate) velocity: Vec<Row>,
    /// Whether nodes were placed from outside since forces were last computed.
    placed: bool,
    mass: Vec<f32>,
    /// One over the mass [1/kg]; 0 while a node is held or sleeps.
    pub(crate) inverse_mass: Vec<f32>,
    held: Vec<bool>,
    /// The nodes that move, ascending; stale after a remodelling.
    #[cfg_attr(feature = "serde", serde(skip))]
    pub(crate) awake: Vec<u32>,
    #[cfg_attr(feature = "serde", serde(skip))]
    pub(crate) awake_is_stale: bool,
    /// Nodes where a crack can start or go on, and how far each is overstrained.
    #[cfg_attr(feature = "serde", serde(skip))]
    pub(crate) breakable: BreakableNodes,
    pub(crate) damage: Vec<f32>,
    pub(crate) cooldowns: Cooldowns,
    /// Which faces of an element of level 0 are bare: bit 2 · axis + side; by element id.
    #[cfg_attr(feature = "serde", serde(skip))]
    pub(crate) bare: Vec<u8>,
    /// Of those with bare faces, the voxels around that share a node: see [`Sharing::bound`].
    #[cfg_attr(feature = "serde", serde(skip))]
    pub(crate) bound: Vec<u32>,
    /// Positions a moment ahead, where damped forces are evaluated.
    pub(crate) ahead: Vec<Row>,
    /// The rigid motion of each piece, as of the last round of damping.
    pub(crate) rigid: Vec<RoughMotion>,
}

impl<D: Dim> Body<D> {
    /// A body at rest that fills `grid`, its voxels of `materials[number - 1]`, the grid's low
    /// corner at the origin.
    ///
    /// # Errors
    /// [`BodyError`] when a material is missing or has a field out of range.
    pub fn new(grid: VoxelGrid<D>, materials: &[Material]) -> Result<Self, BodyError> {
        Self::with(grid, materials, Law::default(), Grading::default())
    }

    /// As [`Body::new`], with a law and a grading of choice ([`Grading::Coarse`] neither tears nor can be cut).
    ///
    /// # Errors
    /// As [`Body::new`].
    #[inline(never)]
    pub fn with(
        grid: VoxelGrid<D>,
        materials: &[Material],
        law: Law,
        grading: Grading,
    ) -> Result<Self, BodyError> {
        let numbers = grid.voxels().map(|voxel| grid.material(voxel));
        let number = numbers.max().unwrap_or(0);
        if number as usize > materials.len() {
            return Err(BodyError::MissingMaterial { number });
        }
        for (index, material) in materials.iter().enumerate() {
            material.check(index + 1)?;
        }
        let sharing = Sharing::new(&grid);
        let pyramid = Pyramid::new(&grid, &sharing, grading);
        let mesh = Mesh::grade(&grid, &sharing, &pyramid)?;
        let mut body = Self {
            blocks: Blocks::new(law, &elasticities(materials, 1.0), grid.voxel_size()),
            pieces: Pieces::new(&mesh),
            blend: Blend::of(&grid, materials),
            materials: materials.to_vec(),
            stiffness_scale: 1.0,
            position: Vec::new(),
            velocity: Vec::new(),
            placed: false,
            mass: Vec::new(),
            inverse_mass: Vec::new(),
            held: Vec::new(),
            awake: Vec::new(),
            awake_is_stale: true,
            breakable: BreakableNodes::default(),
            damage: Vec::new(),
            cooldowns: Cooldowns::default(),
            bare: Vec::new(),
            bound: Vec::new(),
            ahead: Vec::new(),
            rigid: Vec::new(),
            grid,
            sharing,
            pyramid,
            mesh,
        };
        body.make_room();
        for (id, node) in body.mesh.nodes() {
            let at = node.at.map(|k| k as f32 * body.grid.voxel_size());
            body.position[id as usize] = as_row(at);
        }
        body.ahead.clone_from(&body.position);
        let elements: Vec<u32> = body.mesh.elements().map(|(id, _)| id).collect();
        body.blocks.update(&body.mesh, &body.grid, &[], &elements);
        let all: Vec<u32> = body.mesh.nodes().map(|(id, _)| id).collect();
        body.weigh(&all);
        body.rebuild();
        Ok(body)
    }

    /// Works out what follows from the rest: bare faces, breakable nodes, and who is awake.
    pub(crate) fn rebuild(&mut self) {
        self.make_room();
        let voxels: Vec<Point> = self.grid.voxels().collect();
        self.expose(&voxels);
        if self.pyramid.grading() != Grading::Coarse {
            let nodes: Vec<u32> = self.mesh.nodes().map(|(id, _)| id).collect();
            self.find_breakable(&nodes);
        }
        self.awake_is_stale = true;
        self.refresh_awake();
    }

    /// The same body, moved `by` [m]. What is then no place is quarantined in its first tick.
    #[inline(never)]
    pub fn moved(mut self, by: [f32; 3]) -> Self {
        for row in self.position.iter_mut().chain(&mut self.ahead) {
            for axis in 0..D::N {
                row[axis] += by[axis];
            }
        }
        self
    }

    /// The same body, every node moving at `velocity` [m/s].
    #[inline(never)]
    pub fn thrown(mut self, velocity: [f32; 3]) -> Self {
        for row in &mut self.velocity {
            row[..D::N].copy_from_slice(&velocity[..D::N]);
        }
        self
    }

    /// Holds a node: from now on it keeps the velocity it is given, whatever pulls at it.
    ///
    /// # Panics
    /// When the id was never used.
    pub fn hold(&mut self, id: u32) {
        self.held[id as usize] = true;
        self.inverse_mass[id as usize] = 0.0;
    }

    /// Ends what [`Body::hold`] began.
    ///
    /// # Panics
    /// When the id was never used.
    pub fn let_go(&mut self, id: u32) {
        self.held[id as usize] = false;
        if !self.pieces.sleeps(id) {
            self.inverse_mass[id as usize] = 1.0 / self.mass[id as usize];
        }
    }

    /// The voxels it was made from.
    pub fn grid(&self) -> &VoxelGrid<D> {
        &self.grid
    }

    /// What is connected.
    pub fn sharing(&self) -> &Sharing<D> {
        &self.sharing
    }

    /// Its elements and nodes.
    pub fn mesh(&self) -> &Mesh<D> {
        &self.mesh
    }

    /// Its pieces.
    pub fn pieces(&self) -> &Pieces {
        &self.pieces
    }

    /// Its materials, number 1 first.
    pub fn materials(&self) -> &[Material] {
        &self.materials
    }

    /// The material of an element of its own.
    ///
    /// # Panics
    /// When the element is of another body.
    pub fn material(&self, element: &Element) -> &Material {
        let voxel = self.mesh.first_voxel(element);
        &self.materials[self.grid.material(voxel) as usize - 1]
    }

    /// Position [m], velocity [m/s] and mass [kg] of a node.
    ///
    /// # Panics
    /// When the id was never used.
    pub fn node_state(&self, id: u32) -> ([f32; 3], [f32; 3], f32) {
        let id = id as usize;
        (
            three(self.position[id]),
            three(self.velocity[id]),
            self.mass[id],
        )
    }

    /// Places a node at `position` [m] with `velocity` [m/s]. Returns false, and changes nothing,
    /// when a number is not finite.
    ///
    /// # Panics
    /// When the id was never used.
    pub fn set_node_state(&mut self, id: u32, position: [f32; 3], velocity: [f32; 3]) -> bool {
        let finite = position.iter().chain(&velocity).all(|k| k.is_finite());
        if finite {
            self.position[id as usize][..D::N].copy_from_slice(&position[..D::N]);
            self.velocity[id as usize][..D::N].copy_from_slice(&velocity[..D::N]);
            self.ahead[id as usize] = self.position[id as usize];
            self.placed = true;
        }
        finite
    }

    /// The elastic force [N] on a node, as of the start of the last step.
    ///
    /// # Panics
    /// When the id was never used.
    pub fn force_on(&self, id: u32) -> [f32; 3] {
        three(self.blocks.force_on(id))
    }

    /// Linear and angular momentum of everything, about the origin.
    #[inline(never)]
    pub fn momentum(&self) -> Momentum {
        let ids: Vec<u32> = self.mesh.nodes().map(|(id, _)| id).collect();
        Momentum::of(self.states(&ids), [0.0; 3])
    }

    /// Energy of motion [J].
    #[inline(never)]
    pub fn kinetic_energy(&self) -> f64 {
        let states = self.mesh.nodes().map(|(id, _)| {
            let velocity = self.velocity[id as usize].map(f64::from);
            0.5 * f64::from(self.mass[id as usize]) * dot(velocity, velocity)
        });
        states.sum()
    }

    /// How many elements that are awake were inside out when forces were last computed; under
    /// [`Law::Endo2004`], which does not look, none.
    pub fn inverted_count(&self) -> u32 {
        self.blocks.inverted_count()
    }

    /// Mass [kg].
    #[inline(never)]
    pub fn total_mass(&self) -> f64 {
        let ids = self.mesh.nodes();
        ids.map(|(id, _)| f64::from(self.mass[id as usize])).sum()
    }

    /// How it is damped in substeps of `duration` [s]: the lead of its elastic forces [s], and the
    /// rate [1/s] at which each piece relaxes towards its rigid motion.
    ///
    /// A lead of τ damps its slowest swing by τω/2; the fast swing Ω of a single voxel bears
    /// Ω²h (h + 2τ) < 4, that is τ < (4/Ω² − h²) / 2h, of which a part is kept back.
    pub(crate) fn damping(&self, duration: f32) -> (f32, f32) {
        let ratio = self.blend.damping;
        let slow = self.blend.slow * self.stiffness_scale.sqrt();
        let fast = self.blend.fastest_swing * self.stiffness_scale.sqrt();
        let step = f64::from(duration);
        let most = 0.7 * (4.0 / (fast * fast) - step * step) / (2.0 * step);
        let lead = (2.0 * ratio / slow).min(most).max(0.0);
        let rate = 2.0 * slow * (ratio - 0.5 * lead * slow).max(0.0);
        (lead as f32, rate as f32)
    }

    /// Friction of its surface.
    pub(crate) fn friction(&self) -> f32 {
        self.blend.friction
    }

    /// Whether the strength of a material in it is finite: else nothing tears.
    pub(crate) fn can_tear(&self) -> bool {
        self.blend.least_strength < f32::INFINITY
    }

    /// The longest substep that its stiffest material bears [s]: 0.6 s / c.
    pub fn longest_substep(&self) -> f64 {
        let fastest = self.blend.fastest_wave * self.stiffness_scale.sqrt();
        0.6 * f64::from(self.grid.voxel_size()) / fastest
    }

    /// The factor by which its Young's modulus was lowered so that its substep bears it.
    pub fn stiffness_scale(&self) -> f64 {
        self.stiffness_scale
    }

    /// Lowers the stiffness so far that a substep of `duration` [s] is stable, and no further.
    pub(crate) fn scale_stiffness_for(&mut self, duration: f64) {
        let size = f64::from(self.grid.voxel_size());
        let ratio = 0.6 * size / self.blend.fastest_wave / duration;
        let stiffness_scale = (ratio * ratio).min(1.0);
        if stiffness_scale == self.stiffness_scale {
            return;
        }
        self.stiffness_scale = stiffness_scale;
        let elasticities = elasticities(&self.materials, stiffness_scale);
        self.blocks.set_elasticities(&elasticities);
    }

    /// Speed of the fastest pressure wave in it [m/s], softened or not.
    pub(crate) fn fastest_wave(&self) -> f64 {
        self.blend.fastest_wave
    }

    pub(crate) fn states<'a>(
        &'a self,
        nodes: &'a [u32],
    ) -> impl Iterator<Item = (Row, Row, f32)> + 'a {
        let state = |id: usize| (self.position[id], self.velocity[id], self.mass[id]);
        nodes.iter().map(move |&id| state(id as usize))
    }
}
