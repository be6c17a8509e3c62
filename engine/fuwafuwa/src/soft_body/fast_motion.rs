//! Motion by more than a voxel per substep.
//!
//! The velocity of a piece has no limit below that of the quarantine. Two things would go wrong, and are limited
//! here. Nodes faster than a voxel per substep relative to their piece would turn elements inside out: their speed
//! is reduced, and the piece keeps its momentum. Nodes that approach an object by more than a voxel per substep
//! would flatten the piece at once: the piece has a [`Pace`] while the impact lasts. Turns have a limit, too,
//! because nodes move along straight lines.

use super::SoftBody;
use crate::foundation::dim::{Dim, inner};
use crate::foundation::ids::{IndexVec, NodeId, PieceId};
use crate::math::row::Row;
use crate::soft_body::damping::motions;
use crate::soft_body::momentum::RigidMotion;

/// Maximum turn of a piece per substep [rad]. Nodes move along straight lines, so a turn of this size makes the piece
/// wider by 3 %, and the elastic forces pull it back.
const MAX_TURN: f32 = 0.25;

/// Motion of a piece in an impact that is too fast for the substep. The piece moves by a share of its velocity
/// relative to what it hits, and its forces act for the same share of the substep. No velocity is lost, so
/// momentum is exact.
#[derive(Copy, Clone, Debug, PartialEq)]
pub(crate) struct Pace {
    /// Share of the relative velocity by which the piece moves, above 0 to 1.
    pub share: f32,
    /// Velocity of the rigid body that the piece hits [m/s]; 0 if the piece hits another piece.
    pub frame: Row,
}

impl Default for Pace {
    fn default() -> Self {
        Self {
            share: 1.0,
            frame: Row::ZERO,
        }
    }
}

impl Pace {
    /// Returns the velocity at which a node with `velocity` is moved [m/s].
    #[inline(always)]
    pub fn of(&self, velocity: Row) -> Row {
        self.frame + (velocity - self.frame) * self.share
    }
}

impl<D: Dim> SoftBody<D> {
    /// Returns the highest speed of an awake node [m/s], or 0 if no node moved at half of `limit` [m/s] in the last
    /// substep. Forces rarely double a speed in one substep; if they do, the next substep limits it.
    pub(crate) fn fastest_node(&self, limit: f32) -> f32 {
        if 2.0 * self.cache.fastest <= limit {
            return 0.0;
        }
        let velocities = self.cache.awake.iter().map(|&id| self.state.velocity[id]);
        let squares = velocities.map(|velocity| inner::<D>(velocity, velocity));
        squares
            .fold(
                0.0f32,
                |most, square| if square > most { square } else { most },
            )
            .sqrt()
    }

    /// Returns the nodes of all pieces in fast impacts, with their velocities.
    pub(crate) fn velocities_of_slowed(&self) -> Vec<(NodeId, Row)> {
        if self.cache.paces.is_empty() {
            return Vec::new();
        }
        let awake = self.cache.awake.iter();
        let slowed = awake.filter(|&&id| self.pace_share(self.topology.pieces.of_node(id)) < 1.0);
        slowed.map(|&id| (id, self.state.velocity[id])).collect()
    }

    /// Returns the share of their relative velocity by which the nodes of a piece move, 1 without a fast
    /// impact.
    #[inline(always)]
    pub(crate) fn pace_share(&self, piece: PieceId) -> f32 {
        self.cache
            .paces
            .get(piece.index())
            .map_or(1.0, |pace| pace.share)
    }

    /// Returns whether a node is fast enough for an impact of more than a voxel per substep. Then contacts of all
    /// near nodes are active, because other contacts may push a node at such a speed.
    #[inline(always)]
    pub(crate) fn is_fast(&self) -> bool {
        !self.cache.paces.is_empty()
    }

    /// Marks the body as fast.
    pub(crate) fn mark_fast(&mut self) {
        let count = self.topology.pieces.list.len();
        self.cache.paces.resize(count, Pace::default());
    }

    /// Ends all fast impacts.
    pub(crate) fn clear_paces(&mut self) {
        self.cache.paces.clear();
    }

    /// Sets the pace of a piece, unless the piece already has a smaller share.
    pub(crate) fn slow_down(&mut self, piece: PieceId, pace: Pace) {
        self.mark_fast();
        let own = &mut self.cache.paces[piece.index()];
        if pace.share < own.share {
            *own = pace;
        }
    }

    /// Limits the speed of nodes relative to the rigid motion of their piece to `limit` [m/s], a voxel per
    /// substep. The momentum of each piece stays the same, unless it has fixed nodes or turns by more than
    /// [`MAX_TURN`] per substep. Returns the number of nodes that were too fast.
    pub(crate) fn limit_deformation(&mut self, limit: f32) -> u32 {
        let max_spin = MAX_TURN * limit / self.topology.grid.voxel_size();
        let rigid = motions(self)
            .iter()
            .map(|motion| {
                let rigid = motion.rigid();
                let spin = rigid.velocity().angular.length();
                rigid.times(1.0, f64::from((max_spin / spin.max(max_spin)).min(1.0)))
            })
            .collect::<Vec<RigidMotion>>();
        self.cache.rigid = rigid
            .iter()
            .map(RigidMotion::roughly)
            .collect::<Vec<_>>()
            .into();
        let mut limited: IndexVec<PieceId, u32> = vec![0; rigid.len()].into();
        // Nodes at rest on the hit object move at the closing speed relative to the piece.
        let limits = rigid.iter().enumerate().map(|(piece, rigid)| {
            let pace = self.cache.paces.get(piece).filter(|pace| pace.share < 1.0);
            let whole = Row::from(rigid.velocity().linear);
            limit + pace.map_or(0.0, |pace| (whole - pace.frame).length())
        });
        let limits: IndexVec<PieceId, f32> = limits.collect();
        let awake = std::mem::take(&mut self.cache.awake);
        let is_free = |body: &Self, id: NodeId| body.state.inverse_mass[id] != 0.0;
        for &id in &awake {
            let piece = self.topology.pieces.of_node(id);
            if !is_free(self, id) {
                continue;
            }
            let limit = limits[piece];
            let whole = self.cache.rigid[piece].at::<D>(self.state.position[id]);
            let own = self.state.velocity[id] - whole;
            let squared = inner::<D>(own, own);
            if squared > limit * limit {
                self.state.velocity[id] = whole + own * (limit / squared.sqrt());
                limited[piece] += 1;
            }
        }
        self.cache.awake = awake;
        let count = limited.iter().sum();
        if count > 0 {
            let now: Vec<RigidMotion> = motions(self).iter().map(|motion| motion.rigid()).collect();
            for &id in &self.cache.awake {
                let piece = self.topology.pieces.of_node(id);
                if limited[piece] > 0 && is_free(self, id) {
                    let at = self.state.position[id];
                    let lost = rigid[piece.index()].at(at) - now[piece.index()].at(at);
                    self.state.velocity[id] += Row::from(lost.as_vec3());
                }
            }
        }
        count
    }
}
