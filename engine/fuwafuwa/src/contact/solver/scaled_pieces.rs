//! Pieces with scaled mass in the contact solver: their responses as a whole; see [`PieceResponse`].

use super::contact_sides::{NodeContact, NodeRow, SphereNodeRows};
use crate::contact::broad_phase::{ContactSphere, mean};
use crate::foundation::arena::BodySlot;
use crate::foundation::dim::Dim;
use crate::foundation::ids::IndexVec;
use crate::math::row::Row;
use crate::soft_body::SoftBodies;
use crate::soft_body::piece_response::PieceResponse;

/// Entry of [`ScaledPieces::of_row`] for nodes of other pieces.
const UNSCALED: u32 = u32::MAX;

/// Copy of the responses of all pieces with scaled mass.
#[derive(Clone, Debug, Default)]
pub struct ScaledPieces {
    responses: Vec<PieceResponse>,
    /// Index of the first response of each body.
    first: IndexVec<BodySlot, u32>,
    /// Index of the response of each node; `UNSCALED` for nodes of other pieces.
    of_row: IndexVec<NodeRow, u32>,
    /// Offset of each node from the centre of its piece [m].
    offsets: IndexVec<NodeRow, Row>,
}

impl ScaledPieces {
    /// Returns whether no piece has a scaled mass.
    #[inline(always)]
    pub fn is_empty(&self) -> bool {
        self.responses.is_empty()
    }

    /// Copies the responses of the bodies. `first_rows` has the row of the first node of each body, and there are
    /// `rows` rows.
    pub fn load<D: Dim>(
        &mut self,
        bodies: &SoftBodies<D>,
        first_rows: &IndexVec<BodySlot, NodeRow>,
        rows: usize,
    ) {
        self.responses.clear();
        if bodies.iter().all(|body| body.responses().is_empty()) {
            return;
        }
        self.first.clear();
        self.of_row.clear();
        self.of_row.resize(rows, UNSCALED);
        self.offsets.resize(rows, Row::ZERO);
        for body in bodies.slots() {
            let first = self.responses.len() as u32;
            self.first.push(first);
            if let Some(body) = body {
                self.responses.extend_from_slice(body.responses());
            }
        }
        for (slot, body) in bodies.by_slot() {
            if body.responses().is_empty() {
                continue;
            }
            for &node in body.awake_nodes() {
                let piece = body.pieces().of_node(node);
                if let Some(response) = body.response(piece) {
                    let row = NodeRow(first_rows[slot].0 + node.0);
                    self.of_row[row] = self.first[slot] + piece.index() as u32;
                    self.offsets[row] = response.offset(body.positions()[node]);
                }
            }
        }
    }

    /// Copies the responses back to the bodies, and applies them to all nodes.
    pub fn store<D: Dim>(&self, bodies: &mut SoftBodies<D>) {
        if self.is_empty() {
            return;
        }
        for (slot, body) in bodies.by_slot_mut() {
            let own = self.responses[self.first[slot] as usize..].iter();
            body.responses_mut()
                .iter_mut()
                .zip(own)
                .for_each(|(old, new)| *old = *new);
            body.apply_responses();
        }
    }

    /// Returns the velocity at a contact of a node that impulses on its piece have caused [m/s].
    #[inline(never)]
    pub fn velocity_of_node<D: Dim>(&self, contact: &NodeContact) -> Row {
        match self.of_row[contact.node] {
            UNSCALED => Row::ZERO,
            piece => self.responses[piece as usize].velocity_at::<D>(contact.mean(&self.offsets)),
        }
    }

    /// Adds an impulse at a contact of a node to its piece.
    #[inline(never)]
    pub fn push_node<D: Dim>(&mut self, contact: &NodeContact, impulse: Row) {
        let piece = self.of_row[contact.node];
        if piece != UNSCALED {
            let offset = contact.mean(&self.offsets);
            self.responses[piece as usize].push::<D>(offset, impulse);
        }
    }

    /// Returns the velocity of the first sphere relative to the second that impulses on their pieces have caused
    /// [m/s].
    #[inline(never)]
    pub fn relative_of_spheres<D: Dim>(&self, spheres: &[SphereNodeRows; 2]) -> Row {
        let [first, second] = spheres.each_ref().map(|rows| match self.of_row[rows[0]] {
            UNSCALED => Row::ZERO,
            piece => {
                self.responses[piece as usize].velocity_at::<D>(mean::<D, _>(&self.offsets, rows))
            }
        });
        first - second
    }

    /// Adds an impulse on the first sphere, and its opposite on the second, to their pieces.
    #[inline(never)]
    pub fn push_spheres<D: Dim>(&mut self, spheres: &[SphereNodeRows; 2], impulse: Row) {
        for (rows, impulse) in [(&spheres[0], impulse), (&spheres[1], -impulse)] {
            let piece = self.of_row[rows[0]];
            if piece != UNSCALED {
                let offset = mean::<D, _>(&self.offsets, rows);
                self.responses[piece as usize].push::<D>(offset, impulse);
            }
        }
    }
}

/// Returns the inverse mass that the pieces of two contact spheres, as a whole, add to a contact [1/kg]: along its
/// normal, and an upper bound over all directions.
pub fn inverse_masses_of_spheres<D: Dim>(
    bodies: &SoftBodies<D>,
    both: [&ContactSphere; 2],
    centres: [Row; 2],
    normal: Row,
) -> (f32, f32) {
    let [a, b] = both.map(|sphere| bodies.at(sphere.body).response(sphere.piece));
    if (both[0].body, both[0].piece) == (both[1].body, both[1].piece) {
        return a.map_or((0.0, 0.0), |response| {
            response.inverse_masses_between(centres[0] - centres[1], normal)
        });
    }
    let of = |response: Option<&PieceResponse>, centre: Row| {
        response.map_or((0.0, 0.0), |response| {
            response.inverse_masses_at(response.offset(centre), normal)
        })
    };
    let (first, second) = (of(a, centres[0]), of(b, centres[1]));
    (first.0 + second.0, first.1 + second.1)
}
