//! One soft object: what it is made of, how it hangs together, and how it moves.

use crate::dim::{Dim, Point, neighbourhood};
use crate::grid::VoxelGrid;
use crate::law::{Elasticity, Law};
use crate::mesh::{Defect, Inheritance, Mesh, Remodelled};
use crate::momentum::{Momentum, RigidMotion, centre_of};
use crate::pyramid::Pyramid;
use crate::sharing::Sharing;
use crate::solve::{Blocks, Row};

/// What a voxel is made of.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Material {
    /// Stiffness and bulging.
    pub elasticity: Elasticity,
    /// Density [kg/m³], in 2D of a sheet 1 m deep; a game body has about 100.
    pub density: f32,
}

/// One soft object.
#[derive(Clone, Debug)]
pub struct Body<D: Dim> {
    grid: VoxelGrid<D>,
    sharing: Sharing<D>,
    pyramid: Pyramid<D>,
    mesh: Mesh<D>,
    blocks: Blocks<D>,
    materials: Vec<Material>,
    /// Position [m], velocity [m/s] and mass [kg] of each node, by id.
    position: Vec<Row>,
    velocity: Vec<Row>,
    mass: Vec<f32>,
}

/// Why a body could not be made.
#[derive(Clone, Debug, PartialEq)]
pub enum BodyError {
    /// The grid names a material that was not given.
    MissingMaterial {
        /// Number in the grid, from 1.
        number: u8,
    },
    /// A density is not positive and finite.
    BadDensity(f32),
    /// The mesh is broken: a fault of this library.
    Mesh(Defect),
}

impl std::fmt::Display for BodyError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::MissingMaterial { number } => {
                write!(f, "the grid uses material {number}, which was not given")
            }
            Self::BadDensity(density) => {
                write!(f, "the density {density} kg/m³ is not positive and finite")
            }
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

impl<D: Dim> Body<D> {
    /// A body at rest that fills `grid`, its voxels of `materials[number - 1]`, the grid's low
    /// corner at the origin.
    ///
    /// # Errors
    /// [`BodyError`] when a material is missing or has no proper density.
    pub fn new(grid: VoxelGrid<D>, materials: &[Material], law: Law) -> Result<Self, BodyError> {
        let number = grid
            .voxels()
            .map(|voxel| grid.material(voxel))
            .max()
            .unwrap_or(0);
        if number as usize > materials.len() {
            return Err(BodyError::MissingMaterial { number });
        }
        let is_bad =
            |material: &&Material| !(material.density.is_finite() && material.density > 0.0);
        if let Some(material) = materials.iter().find(is_bad) {
            return Err(BodyError::BadDensity(material.density));
        }
        let sharing = Sharing::new(&grid);
        let pyramid = Pyramid::new(&grid, &sharing);
        let mesh = Mesh::grade(&grid, &sharing, &pyramid)?;
        let elasticities = materials
            .iter()
            .map(|material| material.elasticity)
            .collect();
        let mut body = Self {
            blocks: Blocks::new(law, elasticities, grid.voxel_size()),
            position: Vec::new(),
            velocity: Vec::new(),
            mass: Vec::new(),
            materials: materials.to_vec(),
            grid,
            sharing,
            pyramid,
            mesh,
        };
        body.make_room();
        for (id, node) in body.mesh.nodes() {
            let at = node.at.map(|k| k as f32 * body.grid.voxel_size());
            body.position[id as usize] = [at[0], at[1], at[2], 0.0];
        }
        let everything: Vec<u32> = body.mesh.elements().map(|(id, _)| id).collect();
        body.blocks.update(&body.mesh, &body.grid, &[], &everything);
        let all: Vec<u32> = body.mesh.nodes().map(|(id, _)| id).collect();
        body.weigh(&all);
        Ok(body)
    }

    /// Moves the body on by `duration` seconds under `gravity` [m/s²], without contact or damping:
    /// symplectic Euler, stable while `duration` ≤ 0.6 s / c (s the voxel, c the pressure wave).
    pub fn advance(&mut self, duration: f32, gravity: [f32; 3]) {
        self.blocks.evaluate(&self.position);
        for (id, _) in self.mesh.nodes() {
            let node = id as usize;
            let force = self.blocks.force_on(id);
            for axis in 0..D::N {
                let acceleration = force[axis] / self.mass[node] + gravity[axis];
                self.velocity[node][axis] += duration * acceleration;
                self.position[node][axis] += duration * self.velocity[node][axis];
            }
        }
    }

    /// Releases the sharing of nodes at lattice points `at`, each between the octants of its mask
    /// and the rest, and remodels around them. Positions and velocities pass over: linear
    /// and angular momentum are kept.
    ///
    /// # Errors
    /// A [`Defect`] when the mesh breaks: a fault of this library.
    pub fn release(&mut self, at: &[(Point, u8)]) -> Result<(), Defect> {
        let mut changed: Vec<Point> = Vec::new();
        for &(point, side) in at {
            if self.sharing.release(point, side) {
                changed.push(point);
            }
        }
        if changed.is_empty() {
            return Ok(());
        }
        let near = |points: &[Point]| -> Vec<Point> {
            points
                .iter()
                .flat_map(|&point| neighbourhood::<D>(point, 1))
                .collect()
        };
        let spread = self.sharing.normalise(near(&changed));
        changed.extend(spread);
        let born = self
            .pyramid
            .refine(&self.grid, &self.sharing, near(&changed).into_iter());
        let remodelled =
            self.mesh
                .remodel(&self.grid, &self.sharing, &self.pyramid, &changed, &born)?;
        let touched = self.touched_by(&remodelled);
        let is_new = |id: &u32| remodelled.inherited.iter().any(|new| new.node == *id);
        let old: Vec<u32> = touched.iter().filter(|id| !is_new(id)).copied().collect();
        let old: Vec<u32> = old.iter().chain(&remodelled.abandoned).copied().collect();
        let centre = centre_of(self.states(&old).map(|(x, _, mass)| (x, mass)));
        let before = Momentum::of(self.states(&old), centre);

        self.inherit(&remodelled.inherited);
        let Remodelled {
            removed, seated, ..
        } = &remodelled;
        self.blocks.update(&self.mesh, &self.grid, removed, seated);
        self.weigh(&touched);
        self.restore_momentum(&touched, before, centre);
        Ok(())
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

    /// Position [m], velocity [m/s] and mass [kg] of a node.
    ///
    /// # Panics
    /// When the id was never used.
    pub fn node_state(&self, id: u32) -> ([f32; 3], [f32; 3], f32) {
        let id = id as usize;
        let three = |row: Row| [row[0], row[1], row[2]];
        (
            three(self.position[id]),
            three(self.velocity[id]),
            self.mass[id],
        )
    }

    /// The elastic force [N] on a node, as of the start of the last step.
    ///
    /// # Panics
    /// When the id was never used.
    pub fn force_on(&self, id: u32) -> [f32; 3] {
        let force = self.blocks.force_on(id);
        [force[0], force[1], force[2]]
    }

    /// Places a node at `position` [m] with `velocity` [m/s]; what is not finite is refused.
    pub fn set_node_state(&mut self, id: u32, position: [f32; 3], velocity: [f32; 3]) -> bool {
        let finite = position.iter().chain(&velocity).all(|k| k.is_finite());
        if finite {
            self.position[id as usize][..D::N].copy_from_slice(&position[..D::N]);
            self.velocity[id as usize][..D::N].copy_from_slice(&velocity[..D::N]);
        }
        finite
    }

    fn make_room(&mut self) {
        let capacity = self.mesh.node_capacity();
        self.position.resize(capacity, [0.0; 4]);
        self.velocity.resize(capacity, [0.0; 4]);
        self.mass.resize(capacity, 0.0);
    }

    /// New nodes take over the weighted state of old ones, all read before any is written.
    fn inherit(&mut self, inherited: &[Inheritance]) {
        let mean = |rows: &[Row], from: &[(u32, f64)]| {
            let mut sum = [0.0f64; 4];
            for &(old, weight) in from {
                for axis in 0..D::N {
                    sum[axis] += weight * f64::from(rows[old as usize][axis]);
                }
            }
            sum.map(|component| component as f32)
        };
        let states: Vec<(Row, Row)> = inherited
            .iter()
            .map(|new| {
                (
                    mean(&self.position, &new.from),
                    mean(&self.velocity, &new.from),
                )
            })
            .collect();
        self.make_room();
        for (new, (position, velocity)) in inherited.iter().zip(states) {
            self.position[new.node as usize] = position;
            self.velocity[new.node as usize] = velocity;
        }
    }

    /// The nodes of all elements that a remodelling made or changed, ascending.
    fn touched_by(&self, remodelled: &Remodelled) -> Vec<u32> {
        let elements = remodelled
            .seated
            .iter()
            .filter_map(|&id| self.mesh.element(id));
        let mut nodes: Vec<u32> = elements
            .flat_map(|element| element.nodes.iter().copied())
            .collect();
        nodes.sort_unstable();
        nodes.dedup();
        nodes
    }

    fn states<'a>(&'a self, nodes: &'a [u32]) -> impl Iterator<Item = (Row, Row, f32)> + 'a {
        let state = |id: usize| (self.position[id], self.velocity[id], self.mass[id]);
        nodes.iter().map(move |&id| state(id as usize))
    }

    /// Adds the rigid motion that gives the nodes the momentum `before` about `centre` again.
    /// Interpolation keeps linear momentum, but the spin inside an element is lost when new nodes
    /// stand between its corners, and their masses move to new places.
    fn restore_momentum(&mut self, nodes: &[u32], before: Momentum, centre: [f64; 3]) {
        if nodes.is_empty() {
            return;
        }
        let missing = before.less(Momentum::of(self.states(nodes), centre));
        let places = self.states(nodes).map(|(x, _, mass)| (x, mass));
        let motion = RigidMotion::with_momentum(places, centre, missing);
        for &id in nodes {
            let change = motion.at(self.position[id as usize]);
            for axis in 0..D::N {
                self.velocity[id as usize][axis] += change[axis] as f32;
            }
        }
    }

    /// Adds up the masses of nodes from the elements that carry them.
    fn weigh(&mut self, nodes: &[u32]) {
        let half = f64::from(self.grid.voxel_size()) * 0.5;
        for &id in nodes {
            let mut mass = 0.0;
            for (element, place) in self.mesh.carriers_of(id) {
                let material = self.grid.material(self.mesh.first_voxel(element));
                let density = f64::from(self.materials[material as usize - 1].density);
                let child = half * f64::from(element.cell.width());
                let volume = (0..D::N).fold(1.0, |volume, _| volume * child);
                mass += density * volume * self.mesh.stencil(element).volumes[place];
            }
            self.mass[id as usize] = mass as f32;
        }
    }
}
