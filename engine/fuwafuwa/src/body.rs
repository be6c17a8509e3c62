//! One soft thing: its voxels, how they hang together, and the state of its nodes.

mod asleep;
mod blend;
mod cache;
pub(crate) mod cooldowns;
mod derived;
mod motion;
mod placing;
#[cfg(feature = "serde")]
mod sound;
mod state;
mod truth;

use crate::changes::{Bookmark, Changes};
use crate::dim::{Dim, Point};
use crate::grid::VoxelGrid;
use crate::handle::{Arena, BodyId};
use crate::ids::{ElementId, NodeId};
use crate::law::Law;
use crate::material::{BodyError, Material};
use crate::mesh::{Element, Mesh};
use crate::momentum::Momentum;
use crate::piece::Pieces;
use crate::pyramid::{Grading, Pyramid};
use crate::sharing::Sharing;
use crate::solve::{Blocks, Row};
use crate::vector::{as_row, dot, three};
use blend::{Blend, elasticities, plasticities};
use cache::Cache;
pub(crate) use state::MOST_GRAVITY;
use state::State;
use truth::Truth;

/// How far the fastest wave may come in a substep, in terms of a voxel. What swings fastest at rest, a free voxel, bears
/// 2c / Ωs = 0.73 of them in space and 0.84 in the plane at Poisson's ratio 0.3; what is squashed swings faster, and with
/// 0.6 a ball holds that is squashed to 40 % and hit at the speed of its waves.
const COURANT: f64 = 0.6;
/// The share that is used of the lead that a free voxel bears: as much is kept back as of the square of the substep.
const LEAD_USED: f64 = 0.7;

/// The bodies of a world.
pub type Bodies<D> = Arena<BodyId, Body<D>>;

/// One soft thing, whole or in pieces.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(bound = ""))]
pub struct Body<D: Dim> {
    // Snapshots have truth and state.
    pub(crate) truth: Truth<D>,
    pub(crate) state: State<D>,
    #[cfg_attr(feature = "serde", serde(skip))]
    pub(crate) cache: Cache,
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
        let mut blocks = Blocks::new(law, &elasticities(materials, 1.0), grid.voxel_size());
        blocks.set_plasticities(&plasticities(materials));
        let mut body = Self {
            truth: Truth {
                pieces: Pieces::new(&mesh),
                materials: materials.to_vec(),
                stiffness_scale: 1.0,
                grid,
                sharing,
                pyramid,
                mesh,
            },
            state: State::new(blocks),
            cache: Cache::default(),
        };
        body.make_room();
        for (id, node) in body.truth.mesh.nodes() {
            let at = node.at.map(|k| k as f32 * body.truth.grid.voxel_size());
            body.state.position[id] = as_row(at);
        }
        body.state.ahead.clone_from(&body.state.position);
        let elements: Vec<ElementId> = body.truth.mesh.elements().map(|(id, _)| id).collect();
        body.state
            .blocks
            .update(&body.truth.mesh, &body.truth.grid, &[], &elements, |_| {
                false
            });
        let all: Vec<NodeId> = body.truth.mesh.nodes().map(|(id, _)| id).collect();
        body.weigh(&all);
        body.rebuild();
        Ok(body)
    }

    /// Works out the cache from truth and state, and how stiff the elements are.
    pub(crate) fn rebuild(&mut self) {
        let Truth {
            grid,
            materials,
            stiffness_scale,
            ..
        } = &self.truth;
        self.cache.blend = Blend::of(grid, materials);
        let elasticities = elasticities(materials, *stiffness_scale);
        self.state.blocks.set_elasticities(&elasticities);
        self.make_room();
        let voxels: Vec<Point> = self.truth.grid.voxels().collect();
        self.expose(&voxels);
        if self.truth.pyramid.grading() != Grading::Coarse {
            let nodes: Vec<NodeId> = self.truth.mesh.nodes().map(|(id, _)| id).collect();
            self.find_breakable(&nodes);
        }
        self.cache.awake_is_stale = true;
        self.refresh_awake();
    }

    /// What changed since the bookmark was put where it is, and puts it to the end; nothing when that is not known,
    /// for a new reader, another body, or after a while: then everything is to be looked at.
    pub fn changes_since(&self, bookmark: &mut Bookmark) -> Option<Changes> {
        let changes = self.cache.history.since(*bookmark);
        *bookmark = self.bookmark();
        changes
    }

    /// At the end of what changed so far.
    pub fn bookmark(&self) -> Bookmark {
        self.cache.history.end()
    }

    /// Holds a node: from now on it keeps the velocity it is given, whatever pulls at it.
    ///
    /// # Panics
    /// When the id was never used.
    pub fn hold(&mut self, id: NodeId) {
        self.state.held[id] = true;
        self.state.inverse_mass[id] = 0.0;
    }

    /// Ends what [`Body::hold`] began.
    ///
    /// # Panics
    /// When the id was never used.
    pub fn let_go(&mut self, id: NodeId) {
        self.state.held[id] = false;
        if !self.truth.pieces.sleeps(id) {
            self.state.inverse_mass[id] = 1.0 / self.state.mass[id];
        }
    }

    /// The voxels it was made from.
    pub fn grid(&self) -> &VoxelGrid<D> {
        &self.truth.grid
    }

    /// What is connected.
    pub fn sharing(&self) -> &Sharing<D> {
        &self.truth.sharing
    }

    /// Its elements and nodes.
    pub fn mesh(&self) -> &Mesh<D> {
        &self.truth.mesh
    }

    /// By which law its elements answer.
    pub fn law(&self) -> Law {
        self.state.blocks.law()
    }

    /// How fine its elements are.
    pub fn grading(&self) -> Grading {
        self.truth.pyramid.grading()
    }

    /// Its pieces.
    pub fn pieces(&self) -> &Pieces {
        &self.truth.pieces
    }

    /// Its materials, number 1 first.
    pub fn materials(&self) -> &[Material] {
        &self.truth.materials
    }

    /// The material of an element of its own.
    ///
    /// # Panics
    /// When the element is of another body.
    pub fn material(&self, element: &Element) -> &Material {
        let voxel = self.truth.mesh.first_voxel(element);
        &self.truth.materials[self.truth.grid.material(voxel) as usize - 1]
    }

    /// Position [m], velocity [m/s] and mass [kg] of a node.
    ///
    /// # Panics
    /// When the id was never used.
    pub fn node_state(&self, id: NodeId) -> ([f32; 3], [f32; 3], f32) {
        (
            three(self.state.position[id]),
            three(self.state.velocity[id]),
            self.state.mass[id],
        )
    }

    /// Places a node at `position` [m] with `velocity` [m/s]. Returns false, and changes nothing,
    /// when a number is not finite.
    ///
    /// # Panics
    /// When the id was never used.
    pub fn set_node_state(&mut self, id: NodeId, position: [f32; 3], velocity: [f32; 3]) -> bool {
        let finite = position.iter().chain(&velocity).all(|k| k.is_finite());
        if finite {
            self.state.position[id][..D::N].copy_from_slice(&position[..D::N]);
            self.state.velocity[id][..D::N].copy_from_slice(&velocity[..D::N]);
            self.state.ahead[id] = self.state.position[id];
            self.state.placed = true;
        }
        finite
    }

    /// The elastic force [N] on a node, as of the start of the last step.
    ///
    /// # Panics
    /// When the id was never used.
    pub fn force_on(&self, id: NodeId) -> [f32; 3] {
        three(self.state.blocks.force_on(id))
    }

    /// Linear and angular momentum of everything, about the origin.
    #[inline(never)]
    pub fn momentum(&self) -> Momentum {
        let ids: Vec<NodeId> = self.truth.mesh.nodes().map(|(id, _)| id).collect();
        Momentum::of(self.states(&ids), [0.0; 3])
    }

    /// Energy of motion [J].
    #[inline(never)]
    pub fn kinetic_energy(&self) -> f64 {
        let states = self.truth.mesh.nodes().map(|(id, _)| {
            let velocity = self.state.velocity[id].map(f64::from);
            0.5 * f64::from(self.state.mass[id]) * dot(velocity, velocity)
        });
        states.sum()
    }

    /// How many elements that are awake were inside out when forces were last computed; under
    /// [`Law::Endo2004`], which does not look, none.
    pub fn inverted_count(&self) -> u32 {
        self.state.blocks.inverted_count()
    }

    /// Mass [kg].
    #[inline(never)]
    pub fn total_mass(&self) -> f64 {
        let ids = self.truth.mesh.nodes();
        ids.map(|(id, _)| f64::from(self.state.mass[id])).sum()
    }

    /// How it is damped in substeps of `duration` [s]: the lead of its elastic forces [s], and the
    /// rate [1/s] at which each piece relaxes towards its rigid motion.
    ///
    /// A lead of τ damps its slowest swing by τω/2; the fast swing Ω of a single voxel bears
    /// Ω²h (h + 2τ) < 4, that is τ < (4/Ω² − h²) / 2h, of which a part is kept back.
    pub(crate) fn damping(&self, duration: f32) -> (f32, f32) {
        let ratio = self.cache.blend.damping;
        let slow = self.cache.blend.slow * self.truth.stiffness_scale.sqrt();
        let fast = self.cache.blend.fastest_swing * self.truth.stiffness_scale.sqrt();
        let step = f64::from(duration);
        let most = LEAD_USED * (4.0 / (fast * fast) - step * step) / (2.0 * step);
        let lead = (2.0 * ratio / slow).min(most).max(0.0);
        let rate = 2.0 * slow * (ratio - 0.5 * lead * slow).max(0.0);
        (lead as f32, rate as f32)
    }

    /// Friction of its surface.
    pub(crate) fn friction(&self) -> f32 {
        self.cache.blend.friction
    }

    /// Whether the strength of a material in it is finite: else nothing tears.
    pub(crate) fn can_tear(&self) -> bool {
        self.cache.blend.least_strength < f32::INFINITY
    }

    /// The longest substep that its stiffest material bears [s]: 0.6 s / c (s the voxel, c the wave).
    pub fn longest_substep(&self) -> f64 {
        let fastest = self.cache.blend.fastest_wave * self.truth.stiffness_scale.sqrt();
        COURANT * f64::from(self.truth.grid.voxel_size()) / fastest
    }

    /// The factor by which its Young's modulus was lowered so that its substep bears it.
    pub fn stiffness_scale(&self) -> f64 {
        self.truth.stiffness_scale
    }

    /// Lowers the stiffness so far that a substep of `duration` [s] is stable, and no further.
    pub(crate) fn scale_stiffness_for(&mut self, duration: f64) {
        let size = f64::from(self.truth.grid.voxel_size());
        let ratio = COURANT * size / self.cache.blend.fastest_wave / duration;
        let stiffness_scale = (ratio * ratio).min(1.0);
        if stiffness_scale == self.truth.stiffness_scale {
            return;
        }
        self.truth.stiffness_scale = stiffness_scale;
        let elasticities = elasticities(&self.truth.materials, stiffness_scale);
        self.state.blocks.set_elasticities(&elasticities);
    }

    /// Speed of the fastest pressure wave in it [m/s], softened or not.
    pub(crate) fn fastest_wave(&self) -> f64 {
        self.cache.blend.fastest_wave
    }

    pub(crate) fn states<'a>(
        &'a self,
        nodes: &'a [NodeId],
    ) -> impl Iterator<Item = (Row, Row, f32)> + 'a {
        let state = move |&id: &NodeId| {
            (
                self.state.position[id],
                self.state.velocity[id],
                self.state.mass[id],
            )
        };
        nodes.iter().map(state)
    }
}
