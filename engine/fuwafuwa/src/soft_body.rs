//! Soft body: voxels, connectivity, mesh, and the state of the nodes.

pub mod affine;
pub mod damping;
pub mod element_forces;
pub mod element_law;
pub mod element_state;
pub(crate) mod fast_motion;
pub mod hyperelasticity;
pub mod momentum;
pub mod plasticity;
pub mod rayleigh;
pub mod region_sums;
pub mod view;
pub mod viscosity;

mod access;
mod body_properties;
mod body_state;
mod body_topology;
#[cfg(feature = "serde")]
mod body_validation;
mod caches;
pub(crate) mod cooldowns;
mod derived_caches;
mod integration;
mod piece_removal;
pub(crate) mod piece_response;
mod placement;
mod release;
pub mod skin_point;
mod sleep_flags;
mod stiff_body;

use crate::error::{Error, require};
use crate::foundation::arena::{Arena, BodySlot, SoftBodyHandle};
use crate::foundation::dim::{Dim, DimVector, Point};
use crate::foundation::hash::hash_state;
use crate::foundation::ids::{ElementId, NodeId};
use crate::foundation::threads;
use crate::material::Material;
use crate::soft_body::element_forces::{ElementBatches, Row};
use crate::soft_body::element_law::Law;
use crate::soft_body::momentum::Momentum;
use crate::topology::cell_hierarchy::{CellHierarchy, Grading};
use crate::topology::changes::{Bookmark, Changes};
use crate::topology::connectivity::Connectivity;
use crate::topology::grid::VoxelGrid;
use crate::topology::mesh::{Element, Mesh};
use crate::topology::pieces::Pieces;
use crate::topology::skin::Skin;
use body_properties::BodyProperties;
pub(crate) use body_state::MAX_GRAVITY_SCALE;
use body_state::State;
use body_topology::Topology;
use caches::Cache;
use glam::DVec3;
use glam::Vec3;

/// Arena of the soft bodies of a world.
pub type SoftBodies<D> = Arena<SoftBodyHandle, SoftBody<D>>;

/// Calls `work` for each soft body, on several threads if the bodies have many awake nodes in all. Returns the results
/// in the order of the slots.
pub fn for_each_body<D: Dim, R: Send>(
    bodies: &mut SoftBodies<D>,
    work: impl Fn(BodySlot, &mut SoftBody<D>) -> R + Sync,
) -> Vec<R> {
    threads::map_items(
        bodies.by_slot_mut(),
        |(_, body)| body.cache.awake.len(),
        |(slot, body)| work(slot, body),
    )
}

/// Soft body: voxels, elastic elements and nodes, whole or torn into pieces.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(bound = ""))]
pub struct SoftBody<D: Dim> {
    // Snapshots contain `topology` and `state`. `cache` is rebuilt from both.
    topology: Topology<D>,
    state: State<D>,
    #[cfg_attr(feature = "serde", serde(skip))]
    cache: Cache,
}

hash_state! { [D: Dim] struct SoftBody<D> { topology, state } skip { cache } }

impl<D: Dim> SoftBody<D> {
    /// Creates a body at rest that fills `grid`, with the low corner of the grid at the origin. A voxel of
    /// material number n uses `materials[n - 1]`.
    ///
    /// # Errors
    /// [`Error::MissingMaterial`] if the grid uses a material that is not in `materials`. [`Error::InvalidParameter`]
    /// if a field of a material is out of range.
    pub fn new(grid: VoxelGrid<D>, materials: &[Material]) -> Result<Self, Error> {
        Self::with_options(grid, materials, Law::default(), Grading::default())
    }

    /// Creates a body like [`SoftBody::new`], with a chosen law of elastic forces and a chosen grading of the
    /// elements. A body of [`Grading::Coarse`] can be neither torn nor cut.
    ///
    /// # Errors
    /// See [`SoftBody::new`].
    #[inline(never)]
    pub fn with_options(
        grid: VoxelGrid<D>,
        materials: &[Material],
        law: Law,
        grading: Grading,
    ) -> Result<Self, Error> {
        let numbers = grid.voxels().map(|voxel| grid.material(voxel));
        let number = numbers.max().unwrap_or(0);
        if number as usize > materials.len() {
            let given = materials.len();
            return Err(Error::MissingMaterial { number, given });
        }
        for (index, material) in materials.iter().enumerate() {
            let of_material = |error: Error| error.of(format_args!("material {}", index + 1));
            material.check().map_err(of_material)?;
        }
        let connectivity = Connectivity::new(&grid);
        let hierarchy = CellHierarchy::new(&grid, &connectivity, grading);
        let mesh = Mesh::grade(&grid, &connectivity, &hierarchy).expect(
            "a cell hierarchy matches the grid and the connectivity from which it was made",
        );
        let batches = ElementBatches::new(law, materials, grid.voxel_size());
        let mut body = Self {
            topology: Topology {
                pieces: Pieces::new(&mesh),
                materials: materials.to_vec(),
                stiffness_scale: 1.0,
                mass_scale: 1.0,
                grid: grid.into(),
                connectivity: connectivity.into(),
                hierarchy: hierarchy.into(),
                mesh: mesh.into(),
            },
            state: State::new(batches),
            cache: Cache::default(),
        };
        body.make_room();
        for (id, node) in body.topology.mesh.nodes() {
            let at = node.at.map(|k| k as f32 * body.topology.grid.voxel_size());
            body.state.position[id] = Row::from(Vec3::from(at));
        }
        body.state.ahead.clone_from(&body.state.position);
        let elements: Vec<ElementId> = body.topology.mesh.elements().map(|(id, _)| id).collect();
        body.state.batches.update(
            &body.topology.mesh,
            &body.topology.grid,
            &[],
            &elements,
            |_| false,
        );
        let all: Vec<NodeId> = body.topology.mesh.nodes().map(|(id, _)| id).collect();
        body.weigh(&all);
        body.rebuild();
        Ok(body)
    }

    /// Recomputes the cache and the elastic moduli of the elements from the topology and the state.
    pub(crate) fn rebuild(&mut self) {
        let Topology {
            grid,
            materials,
            stiffness_scale,
            ..
        } = &self.topology;
        self.cache.properties = BodyProperties::of(grid, materials);
        self.state
            .batches
            .set_materials(materials, *stiffness_scale);
        self.make_room();
        let voxels: Vec<Point> = self.topology.grid.voxels().collect();
        self.expose(&voxels);
        let nodes: Vec<NodeId> = self.topology.mesh.nodes().map(|(id, _)| id).collect();
        self.cache.skin = Skin::of(&self.topology.grid).into();
        self.update_skin_points(&nodes);
        self.update_mass_damping(&nodes);
        if self.topology.hierarchy.grading() != Grading::Coarse {
            self.find_breakable(&nodes);
        }
        self.cache.awake_is_stale = true;
        self.refresh_awake();
    }

    /// Returns the changes since `bookmark`, and moves the bookmark to the present.
    ///
    /// Returns `None` if the changes are not known. This is so if the bookmark is a default one, belongs to
    /// another body or is too old. The caller must then read the whole body again.
    pub fn changes_since(&self, bookmark: &mut Bookmark) -> Option<Changes> {
        let changes = self.cache.history.since(*bookmark);
        *bookmark = self.bookmark();
        changes
    }

    /// Returns a bookmark at the present end of the body's history of changes.
    pub fn bookmark(&self) -> Bookmark {
        self.cache.history.end()
    }

    /// Fixes a node: forces no longer change its velocity. A node at rest therefore stays in place.
    ///
    /// # Panics
    /// If the id was never used.
    pub fn fix_node(&mut self, id: NodeId) {
        self.state.fixed[id] = true;
        self.state.inverse_mass[id] = 0.0;
    }

    /// Frees a node that [`SoftBody::fix_node`] fixed.
    ///
    /// # Panics
    /// If the id was never used.
    pub fn free_node(&mut self, id: NodeId) {
        self.state.fixed[id] = false;
        if !self.topology.pieces.sleeps(id) {
            self.state.inverse_mass[id] = self.inverse_mass_of(id);
        }
    }

    /// Returns whether a node is fixed, by [`SoftBody::fix_node`] or by a [grip](crate::Grip).
    ///
    /// # Panics
    /// If the id was never used.
    pub fn is_fixed(&self, id: NodeId) -> bool {
        self.state.fixed[id]
    }

    /// Voxel grid from which the body was made.
    pub fn grid(&self) -> &VoxelGrid<D> {
        &self.topology.grid
    }

    /// Connectivity of the voxels.
    pub fn connectivity(&self) -> &Connectivity<D> {
        &self.topology.connectivity
    }

    /// Returns whether both are copies of one body, and neither was torn, cut or reduced since. Such copies share the
    /// memory of their topology.
    pub fn shares_topology_with(&self, other: &Self) -> bool {
        self.topology.mesh.is_same(&other.topology.mesh)
    }

    /// Elements and nodes.
    pub fn mesh(&self) -> &Mesh<D> {
        &self.topology.mesh
    }

    /// Law of the elastic forces.
    pub fn law(&self) -> Law {
        self.state.batches.law()
    }

    /// Grading of the elements.
    pub fn grading(&self) -> Grading {
        self.topology.hierarchy.grading()
    }

    /// Pieces of the body.
    pub fn pieces(&self) -> &Pieces {
        &self.topology.pieces
    }

    /// Materials of the body. Material number n of the grid is at index n − 1.
    pub fn materials(&self) -> &[Material] {
        &self.topology.materials
    }

    /// Material of an element of this body.
    ///
    /// # Panics
    /// If the element belongs to another body.
    pub fn material(&self, element: &Element) -> &Material {
        let voxel = self.topology.mesh.first_voxel(element);
        &self.topology.materials[self.topology.grid.material(voxel) as usize - 1]
    }

    /// Position [m], velocity [m/s] and mass [kg] of a node.
    ///
    /// # Panics
    /// If the id was never used.
    pub fn node_state(&self, id: NodeId) -> (D::Vector, D::Vector, f32) {
        (
            D::Vector::from_vec3(self.state.position[id].xyz()),
            D::Vector::from_vec3(self.state.velocity[id].xyz()),
            self.state.mass[id],
        )
    }

    /// Sets the position [m] and velocity [m/s] of a node.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] if a component is not finite. The node then stays unchanged.
    ///
    /// # Panics
    /// If the id was never used.
    pub fn set_node_state(
        &mut self,
        id: NodeId,
        position: D::Vector,
        velocity: D::Vector,
    ) -> Result<(), Error> {
        require(position.is_finite(), "position", "finite", position)?;
        require(velocity.is_finite(), "velocity", "finite", velocity)?;
        self.state.position[id] = Row::from(position.to_vec3());
        self.state.velocity[id] = Row::from(velocity.to_vec3());
        self.state.ahead[id] = self.state.position[id];
        self.state.placed = true;
        Ok(())
    }

    /// Elastic force [N] on a node in the last substep in which the body was awake.
    ///
    /// # Panics
    /// If the id was never used.
    pub fn force_on(&self, id: NodeId) -> D::Vector {
        D::Vector::from_vec3(self.state.batches.force_on(id).xyz())
    }

    /// Linear and angular momentum of the whole body about the origin [kg m/s, kg m²/s].
    #[inline(never)]
    pub fn momentum(&self) -> Momentum {
        let ids: Vec<NodeId> = self.topology.mesh.nodes().map(|(id, _)| id).collect();
        Momentum::of(self.states(&ids), DVec3::ZERO)
    }

    /// Kinetic energy of the whole body [J].
    #[inline(never)]
    pub fn kinetic_energy(&self) -> f64 {
        let states = self.topology.mesh.nodes().map(|(id, _)| {
            let velocity = self.state.velocity[id].xyz().as_dvec3();
            0.5 * f64::from(self.state.mass[id]) * velocity.dot(velocity)
        });
        states.sum()
    }

    /// Number of awake elements with negative volume, that is, turned inside out, when forces were last
    /// computed. Always 0 under [`Law::Endo2004`], which does not check for inversion.
    pub fn inverted_count(&self) -> u32 {
        self.state.batches.inverted_count()
    }

    /// Mass of the whole body [kg].
    #[inline(never)]
    pub fn total_mass(&self) -> f64 {
        let ids = self.topology.mesh.nodes();
        ids.map(|(id, _)| f64::from(self.state.mass[id])).sum()
    }

    /// Friction coefficient of the body: the mean over its voxels.
    pub(crate) fn friction(&self) -> f32 {
        self.cache.properties.friction
    }

    /// Rolling resistance of the crumbs of the body [1/s]: the mean over its voxels.
    pub(crate) fn rolling_resistance(&self) -> f32 {
        self.cache.properties.rolling_resistance
    }

    /// Returns whether the fracture energy of a material in use grows with the speed of a crack.
    pub(crate) fn has_rate_toughening(&self) -> bool {
        self.cache.properties.has_rate_toughening
    }

    /// Returns whether any material in use has a finite strength; otherwise the body cannot tear.
    pub(crate) fn can_tear(&self) -> bool {
        self.cache.properties.least_strength < f32::INFINITY
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
