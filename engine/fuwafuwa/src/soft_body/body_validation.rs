//! Validation of bodies read from snapshots. The checksum of a snapshot detects damaged bytes, but not
//! invalid values.

use super::SoftBody;
use super::body_state::{MAX_GRAVITY_SCALE, State};
use super::body_topology::Topology;
use crate::foundation::dim::Dim;
use crate::foundation::ids::{ElementId, IndexVec, NodeId, PieceId};
use crate::soft_body::element_forces::Row;
use crate::topology::cell_hierarchy::CellHierarchy;
use crate::topology::mesh::{InvariantViolation, Mesh};
use crate::topology::pieces::Pieces;

impl<D: Dim> SoftBody<D> {
    /// Checks that cells, elements, nodes and pieces follow from the voxels and their connectivity, and that
    /// every node has a valid state.
    ///
    /// # Errors
    /// The first [`InvariantViolation`] found.
    pub(crate) fn check(&self) -> Result<(), InvariantViolation> {
        self.topology.check()?;
        ensure(
            self.state.has_room(self.topology.mesh.node_capacity()),
            "states",
        )?;
        ensure(
            self.state.batches.is_sound(&self.topology.mesh),
            "states of elements",
        )?;
        let gravity_scale = self.state.gravity_scale;
        ensure(gravity_scale.abs() <= MAX_GRAVITY_SCALE, "gravity scale")?;
        let points = self.state.cooldowns.points();
        let is_known = { points }.all(|at| self.topology.connectivity.contains(at));
        ensure(is_known, "cooldown points")?;
        let points = self.state.tip_deviations.valid_points();
        let is_known = points
            .is_some_and(|mut points| points.all(|at| self.topology.connectivity.contains(at)));
        ensure(is_known, "deviations of crack tips")?;
        ensure(self.state.stiffening.is_valid(), "stiffening")?;
        for (id, node) in self.topology.mesh.nodes() {
            let defect = |what: &str| {
                Err(InvariantViolation::of(format!(
                    "the node at {:?} {what}",
                    node.at
                )))
            };
            if !self.has_valid_state(id) {
                return defect("has a position or velocity that is not finite or leaves the plane");
            }
            if !self.has_valid_mass(id) {
                return defect("has a mass that does not match its elements");
            }
        }
        Ok(())
    }

    /// Recomputes the batches and the cache, which snapshots do not contain. The body must have passed
    /// [`SoftBody::check`].
    pub(crate) fn restore(&mut self) {
        let Topology {
            mesh,
            grid,
            materials,
            stiffness_scale,
            pieces,
            ..
        } = &self.topology;
        let asleep = |id: ElementId| pieces.list[pieces.of_element(id)].asleep;
        let batches = &mut self.state.batches;
        batches.restore(mesh, grid, materials, *stiffness_scale, asleep);
        self.rebuild();
    }

    /// Returns whether the position, velocity and extrapolated position of a node are finite, and in 2D have
    /// third coordinate 0, and whether its damage is not NaN.
    fn has_valid_state(&self, id: NodeId) -> bool {
        let state = &self.state;
        let rows = [&state.position, &state.velocity, &state.ahead].map(|rows| rows[id]);
        let is_flat = |row: &Row| row[D::N..].iter().all(|&k| k == 0.0);
        rows.iter().all(|row| is_flat(row) && row.is_finite()) && !state.damage[id].is_nan()
    }

    /// Returns whether the mass and the inverse mass of a node are exactly those that follow from the
    /// elements that carry the node.
    fn has_valid_mass(&self, id: NodeId) -> bool {
        self.state.mass[id] == self.mass_of(id)
            && self.state.inverse_mass[id] == self.inverse_mass_of(id)
    }
}

impl<D: Dim> Topology<D> {
    fn check(&self) -> Result<(), InvariantViolation> {
        ensure(self.grid.is_valid(), "voxels")?;
        let numbers = self.grid.voxels().map(|voxel| self.grid.material(voxel));
        let number = usize::from(numbers.max().unwrap_or(0));
        let are_good = { self.materials.iter() }.all(|material| material.check().is_ok())
            && self.stiffness_scale > 0.0
            && self.stiffness_scale <= 1.0
            && self.mass_scale >= 1.0
            && self.mass_scale.is_finite();
        ensure(number <= self.materials.len() && are_good, "materials")?;
        ensure(self.connectivity.is_valid(&self.grid), "groups")?;
        let grading = self.hierarchy.grading();
        let cells = CellHierarchy::new(&self.grid, &self.connectivity, grading);
        ensure(*self.hierarchy == cells, "cells")?;
        let fresh = Mesh::grade(&self.grid, &self.connectivity, &cells)?;
        self.mesh.check_against(&fresh, &self.connectivity)?;
        self.mesh.validate(&self.grid, &self.connectivity)?;
        ensure(self.pieces.is_sound(&self.mesh), "pieces")
    }
}

impl<D: Dim> State<D> {
    /// Returns whether the list of each quantity has exactly `nodes` entries.
    fn has_room(&self, nodes: usize) -> bool {
        let rows = [&self.position, &self.velocity, &self.ahead].map(|rows| rows.len());
        let numbers = [&self.mass, &self.inverse_mass, &self.damage].map(|numbers| numbers.len());
        let mut lengths = rows.into_iter().chain(numbers).chain([self.fixed.len()]);
        lengths.all(|length| length == nodes)
    }
}

fn ensure(good: bool, what: &str) -> Result<(), InvariantViolation> {
    match good {
        true => Ok(()),
        false => Err(InvariantViolation::of(format!("invalid {what}"))),
    }
}

impl Pieces {
    /// Returns whether these pieces are the connected parts of the mesh. Their numbers may be in any order.
    fn is_sound<D: Dim>(&self, mesh: &Mesh<D>) -> bool {
        let fresh = Self::new(mesh);
        let mut numbers: IndexVec<PieceId, _> = vec![None; fresh.list.len()].into();
        let mut taken = vec![false; self.list.len()];
        self.has_room(mesh)
            && mesh.elements().all(|(id, element)| {
                let own = self.of_element(id);
                let number = &mut numbers[fresh.of_element(id)];
                let mut is_new = || {
                    let taken = taken.get_mut(own.index());
                    taken.is_some_and(|taken| !std::mem::replace(taken, true))
                };
                (*number == Some(own) || number.is_none() && is_new()) && {
                    *number = Some(own);
                    element.nodes.iter().all(|&node| self.of_node(node) == own)
                }
            })
    }
}
