//! One soft thing: its voxels, how they hang together, and the state of its nodes.

#[cfg(feature = "serde")]
mod sound;

use crate::breakable::BreakableNodes;
use crate::dim::{Dim, Point, voxel_around};
use crate::grid::VoxelGrid;
use crate::law::{Elasticity, Law, turn_far_from};
use crate::material::{BodyError, Material};
use crate::mesh::{Element, Mesh, Node};
use crate::momentum::{Momentum, RoughMotion};
use crate::piece::Pieces;
use crate::pyramid::{Grading, Pyramid};
use crate::sharing::Sharing;
use crate::solve::{Blocks, Kick, Row};
use crate::threads;
use crate::vector::{as_row, dot, minus, plus, scaled, three};

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
    pub(crate) awake: Vec<u32>,
    pub(crate) awake_is_stale: bool,
    /// Nodes where a crack can start or go on, and how far each is overstrained.
    pub(crate) breakable: BreakableNodes,
    pub(crate) damage: Vec<f32>,
    /// Which faces of an element of level 0 are bare: bit 2 · axis + side; by element id.
    pub(crate) bare: Vec<u8>,
    /// Positions a moment ahead, where damped forces are evaluated.
    pub(crate) ahead: Vec<Row>,
    /// The rigid motion of each piece, as of the last round of damping.
    pub(crate) rigid: Vec<RoughMotion>,
}

/// What the materials of its voxels come to in a body as a whole.
#[derive(Copy, Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
struct Blend {
    /// Damping ratio of the slowest swing, the mean over the voxels.
    damping: f64,
    /// Its ω = π √(Y/ρ) / width [1/s].
    slow: f64,
    /// Friction, the mean over the voxels.
    friction: f32,
    /// The least strength of a material that is in use [Pa].
    least_strength: f32,
    /// The fastest pressure wave of a material that is in use [m/s].
    fastest_wave: f64,
    /// The fastest swing, that of a single voxel which grows and shrinks [1/s].
    fastest_swing: f64,
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
            bare: Vec::new(),
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
        let voxels: Vec<Point> = body.grid.voxels().collect();
        body.expose(&voxels);
        if grading != Grading::Coarse {
            body.find_breakable(&all);
        }
        Ok(body)
    }

    /// The same body, moved `by` [m]. What is then no place is quarantined in its first tick.
    pub fn moved(mut self, by: [f32; 3]) -> Self {
        for row in self.position.iter_mut().chain(&mut self.ahead) {
            for axis in 0..D::N {
                row[axis] += by[axis];
            }
        }
        self
    }

    /// The same body, every node moving at `velocity` [m/s].
    pub fn thrown(mut self, velocity: [f32; 3]) -> Self {
        for row in &mut self.velocity {
            row[..D::N].copy_from_slice(&velocity[..D::N]);
        }
        self
    }

    /// Moves a free body on by `duration` seconds under `gravity` [m/s²], without contact or
    /// damping: symplectic Euler, stable while `duration` ≤ 0.6 s / c (s the voxel, c the wave).
    pub fn advance(&mut self, duration: f32, gravity: [f32; 3]) {
        self.push(duration, gravity);
        self.drift(duration, 0.0);
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
    pub fn momentum(&self) -> Momentum {
        let ids: Vec<u32> = self.mesh.nodes().map(|(id, _)| id).collect();
        Momentum::of(self.states(&ids), [0.0; 3])
    }

    /// Energy of motion [J].
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

    /// Friction of its skin.
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

    /// Adds elastic forces and gravity over `duration` [s] to the velocities.
    pub(crate) fn push(&mut self, duration: f32, gravity: [f32; 3]) {
        self.refresh_awake();
        if std::mem::take(&mut self.placed) {
            let all: Vec<u32> = self.mesh.elements().map(|(id, _)| id).collect();
            self.settle(&all);
        }
        self.blocks.evaluate(&self.ahead);
        let mut gravity = as_row(gravity);
        gravity[D::N..].fill(0.0);
        let kick = Kick {
            nodes: &self.awake,
            inverse_mass: &self.inverse_mass,
            duration,
            gravity,
        };
        self.blocks.kick(&kick, &mut self.velocity);
    }

    /// Turns elements that are far from how their nodes lie, because they are new or their nodes were
    /// placed: [`Blocks`] follows what turns step by step, and stands still half a turn off. In the plane
    /// it finds the rotation at once.
    pub(crate) fn settle(&mut self, elements: &[u32]) {
        if D::N == 2 {
            return;
        }
        for &id in elements {
            let element = self.mesh.element(id).expect("only live elements settle");
            let wide = |rows: [[f32; 3]; 3]| rows.map(|row| row.map(f64::from));
            let (rotation, deformation) = (self.blocks.rotation(id), self.deformation(element).1);
            if let Some(turned) = turn_far_from(&wide(rotation), &wide(deformation)) {
                self.blocks.set_rotation(id, turned.map(|part| part as f32));
            }
        }
    }

    /// Moves every awake node by its velocity, and looks `lead` seconds ahead for the next forces,
    /// as seen from the rigid motion of its piece: what only turns must not be braked.
    /// No node moves by more than a voxel: faster ones would turn elements inside out, and the
    /// forces would grow from substep to substep. Returns how far the fastest has come [m].
    pub(crate) fn drift(&mut self, duration: f32, lead: f32) -> f32 {
        let top_speed = self.grid.voxel_size() / duration;
        // Pieces born since the last round of damping have no motion yet.
        self.rigid
            .resize(self.pieces.list.len(), RoughMotion::default());
        let (rigid, pieces) = (&self.rigid, &self.pieces);
        let lists = [&mut self.position, &mut self.velocity, &mut self.ahead];
        let rows = threads::rows(&self.awake, lists.map(Vec::as_mut_slice));
        let fastest = threads::map(rows, |rows| {
            let [positions, velocities, ahead] = rows.lists;
            let mut fastest = 0.0f32;
            for &id in rows.nodes {
                let node = id as usize - rows.first;
                let mut velocity = velocities[node];
                let squared = dot(velocity, velocity);
                // Not `max`, which would have every node wait for the one before.
                if squared > fastest {
                    fastest = squared;
                }
                if squared > top_speed * top_speed {
                    velocity = scaled(velocity, top_speed / squared.sqrt());
                    velocities[node] = velocity;
                }
                let position = plus(positions[node], scaled(velocity, duration));
                positions[node] = position;
                let whole = rigid[pieces.of_node(id) as usize].at::<D>(position);
                ahead[node] = plus(position, scaled(minus(velocity, whole), lead));
            }
            fastest
        });
        let fastest = fastest.into_iter().fold(0.0, f32::max);
        fastest.sqrt().min(top_speed) * duration
    }

    /// Wakes or puts to sleep all pieces whose number is marked.
    pub(crate) fn set_asleep(&mut self, marked: &[bool], asleep: bool) {
        for (id, element) in self.mesh.elements() {
            if !marked[self.pieces.of_element(id) as usize] {
                continue;
            }
            self.blocks.set_asleep(id, asleep);
            for &node in &element.nodes {
                let node = node as usize;
                if asleep {
                    self.velocity[node] = [0.0; 4];
                    self.ahead[node] = self.position[node];
                }
                let free = !asleep && !self.held[node];
                self.inverse_mass[node] = if free { 1.0 / self.mass[node] } else { 0.0 };
            }
        }
        for (piece, _) in self
            .pieces
            .list
            .iter_mut()
            .zip(marked)
            .filter(|(_, marked)| **marked)
        {
            piece.asleep = asleep;
            piece.still = 0.0;
        }
        self.awake_is_stale = true;
    }

    /// The lattice point and the position [m] of every node, by id; no position where there is none.
    pub(crate) fn places(&self) -> Vec<(Point, Row)> {
        let place = |(id, &row): (usize, &Row)| match self.mesh.is_alive(id as u32) {
            true => (self.mesh.node(id as u32).at, row),
            false => ([0; 3], [f32::NAN; 4]),
        };
        self.position.iter().enumerate().map(place).collect()
    }

    /// Puts pieces with a node that is not finite, or faster than `top_speed` [m/s], back to where
    /// they were and to sleep for good; returns their numbers.
    pub(crate) fn quarantine(&mut self, before: &[(Point, Row)], top_speed: f32) -> Vec<u32> {
        let mut marked = vec![false; self.pieces.list.len()];
        for &id in &self.awake {
            let velocity = self.velocity[id as usize];
            let speed = dot(velocity, velocity);
            let sane = speed <= top_speed * top_speed && is_finite(self.position[id as usize]);
            marked[self.pieces.of_node(id) as usize] |= !sane;
        }
        if !marked.contains(&true) {
            return Vec::new();
        }
        let nodes: Vec<(u32, Node)> = self.mesh.nodes().collect();
        let nodes = nodes.into_iter();
        for (id, node) in nodes.filter(|&(id, _)| marked[self.pieces.of_node(id) as usize]) {
            self.position[id as usize] = self.place_before(id, node.at, before);
        }
        self.set_asleep(&marked, true);
        let numbers = (0..marked.len() as u32).filter(|&piece| marked[piece as usize]);
        let numbers: Vec<u32> = numbers.collect();
        for &piece in &numbers {
            self.pieces.list[piece as usize].quarantined = true;
        }
        numbers
    }

    /// Where a node was. One that is new, or whose id was another's, is put beside the nearest of its
    /// elements that was anywhere, and to its place at rest when none was: across a crack, what is
    /// near in the lattice may be far away.
    fn place_before(&self, id: u32, at: Point, before: &[(Point, Row)]) -> Row {
        let was = |id: u32, at: Point| {
            let known = before.get(id as usize);
            known.filter(|(point, row)| *point == at && is_finite(*row))
        };
        let carriers = self.mesh.carriers_of(id);
        let beside = carriers.flat_map(|(element, _)| element.nodes.iter());
        let beside = beside.filter_map(|&other| was(other, self.mesh.node(other).at));
        let apart = |point: Point| [0, 1, 2].map(|axis: usize| at[axis] - point[axis]);
        let squared = |(point, _): &&(Point, Row)| apart(*point).map(|k| k * k).iter().sum::<i32>();
        let nearest = || beside.min_by_key(squared);
        let (point, row) = was(id, at).or_else(nearest).copied().unwrap_or_default();
        let [x, y, z] = apart(point).map(|k| k as f32 * self.grid.voxel_size());
        plus(row, [x, y, z, 0.0])
    }

    /// Brings the list of moving nodes up to date.
    pub(crate) fn refresh_awake(&mut self) {
        if !self.awake_is_stale {
            return;
        }
        self.awake_is_stale = false;
        let mut awake = std::mem::take(&mut self.awake);
        awake.clear();
        let nodes = self.mesh.nodes().map(|(id, _)| id);
        awake.extend(nodes.filter(|&id| !self.pieces.sleeps(id)));
        self.awake = awake;
    }

    pub(crate) fn make_room(&mut self) {
        let capacity = self.mesh.node_capacity();
        self.position.resize(capacity, [0.0; 4]);
        self.ahead.resize(capacity, [0.0; 4]);
        self.velocity.resize(capacity, [0.0; 4]);
        self.mass.resize(capacity, 0.0);
        self.inverse_mass.resize(capacity, 0.0);
        self.held.resize(capacity, false);
        self.damage.resize(capacity, 0.0);
        self.bare.resize(self.mesh.element_capacity(), 0);
        self.pieces.make_room(&self.mesh);
    }

    /// A new node is held when every node it comes from was.
    pub(crate) fn inherit_hold(&mut self, node: u32, from: &[(u32, f64)]) {
        self.held[node as usize] = from.iter().all(|&(old, _)| self.held[old as usize]);
    }

    pub(crate) fn states<'a>(
        &'a self,
        nodes: &'a [u32],
    ) -> impl Iterator<Item = (Row, Row, f32)> + 'a {
        let state = |id: usize| (self.position[id], self.velocity[id], self.mass[id]);
        nodes.iter().map(move |&id| state(id as usize))
    }

    /// Adds up the masses of nodes from the elements that carry them.
    pub(crate) fn weigh(&mut self, nodes: &[u32]) {
        let half = f64::from(self.grid.voxel_size()) * 0.5;
        for &id in nodes {
            let mut mass = 0.0;
            for (element, place) in self.mesh.carriers_of(id) {
                let density = f64::from(self.material(element).density);
                let child = half * f64::from(element.cell.width());
                let volume = (0..D::N).fold(1.0, |volume, _| volume * child);
                mass += density * volume * self.mesh.stencil(element).volumes[place];
            }
            let node = id as usize;
            self.mass[node] = mass as f32;
            let free = !self.held[node] && !self.pieces.sleeps(id);
            self.inverse_mass[node] = if free { 1.0 / self.mass[node] } else { 0.0 };
        }
    }

    /// Notes which faces of the elements of level 0 on these voxels are bare.
    pub(crate) fn expose(&mut self, voxels: &[Point]) {
        for &voxel in voxels.iter().filter(|&&voxel| self.grid.is_solid(voxel)) {
            let owner = self.mesh.owner(voxel).expect("a solid voxel has an owner");
            let element = self.mesh.element(owner).expect("owners are alive");
            if element.cell.level > 0 {
                continue;
            }
            let mut bare = 0;
            for axis in 0..D::N {
                for side in 0..2 {
                    if !self.is_face_closed(voxel, axis, side) {
                        bare |= 1 << (2 * axis + side);
                    }
                }
            }
            self.bare[owner as usize] = bare;
        }
    }

    /// Looks again which of `nodes` are breakable nodes.
    pub(crate) fn find_breakable(&mut self, nodes: &[u32]) {
        let Self {
            grid,
            sharing,
            mesh,
            materials,
            ..
        } = self;
        self.breakable.look(nodes, grid, sharing, mesh, materials);
    }

    fn is_face_closed(&self, voxel: Point, axis: usize, side: usize) -> bool {
        let mut at = voxel;
        at[axis] += side as i32;
        // Seen from the low corner of the face, the voxel stands on the high side of every axis
        // but, where the face is its own high one, of this one.
        let octant = D::CORNERS - 1 - (side << axis);
        debug_assert_eq!(voxel_around::<D>(at, octant), voxel);
        self.sharing.is_closed(at, octant, axis)
    }
}

fn elasticities(materials: &[Material], stiffness_scale: f64) -> Vec<Elasticity> {
    let soft = |material: &Material| Elasticity {
        young: material.elasticity.young * stiffness_scale,
        ..material.elasticity
    };
    materials.iter().map(soft).collect()
}

impl Blend {
    fn of<D: Dim>(grid: &VoxelGrid<D>, materials: &[Material]) -> Self {
        let mut counts = vec![0.0; materials.len()];
        for number in grid.voxels().map(|voxel| grid.material(voxel)) {
            if number > 0 {
                counts[number as usize - 1] += 1.0;
            }
        }
        let total: f64 = counts.iter().sum();
        let used = || {
            counts
                .iter()
                .zip(materials)
                .filter(|(count, _)| **count > 0.0)
        };
        let mean = |of: &dyn Fn(&Material) -> f64| {
            used()
                .map(|(count, material)| count * of(material))
                .sum::<f64>()
                / total
        };
        let young = mean(&|material| material.elasticity.young);
        let density = mean(&|material| f64::from(material.density));
        let width = f64::from(grid.voxel_size()) * root(total, D::N);
        let strengths = used().map(|(_, material)| material.strength);
        let waves = used().map(|(_, material)| material.wave_speed());
        let swings = used().map(|(_, material)| material.voxel_swing(D::N));
        Self {
            damping: mean(&|material| f64::from(material.damping)),
            slow: std::f64::consts::PI * (young / density).sqrt() / width,
            friction: mean(&|material| f64::from(material.friction)) as f32,
            least_strength: strengths.fold(f32::INFINITY, f32::min),
            fastest_wave: waves.fold(0.0, f64::max),
            fastest_swing: swings.fold(0.0, f64::max) / f64::from(grid.voxel_size()),
        }
    }
}

/// The square or cube root, by Newton's iteration: it may not come from the platform.
fn root(of: f64, order: usize) -> f64 {
    let mut root = of.max(1.0);
    for _ in 0..60 {
        let power = (1..order).fold(1.0, |power, _| power * root);
        root -= (power * root - of) / (order as f64 * power);
    }
    root
}

fn is_finite(row: Row) -> bool {
    row.iter().all(|k| k.is_finite())
}
