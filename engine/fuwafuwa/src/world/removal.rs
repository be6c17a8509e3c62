//! Removal of pieces, and of everything that left a region.

use super::World;
use crate::contact::broad_phase::{bounds_of, supported_by_pieces};
use crate::contact::solver::Hit;
use crate::error::Error;
use crate::event::Event;
use crate::foundation::arena::{RigidBodyHandle, SoftBodyHandle};
use crate::foundation::dim::Dim;
use crate::foundation::ids::PieceId;
use crate::rigid_body::shape::Shape;
use crate::soft_body::SoftBody;

/// Size threshold for [`World::remove_small_pieces`].
#[derive(Copy, Clone, Debug, PartialEq)]
pub enum PieceSize {
    /// Minimum number of voxels: pieces with fewer voxels are removed.
    Voxels(usize),
    /// Minimum volume of the undeformed piece [m³]: smaller pieces are removed. In 2D, pieces are 1 m deep.
    Volume(f64),
    /// Minimum mass [kg]: lighter pieces are removed.
    Mass(f64),
}

/// Result of a removal. Each removed object is also among the [events](World::events) until the next tick.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Removed {
    /// Removed pieces, ascending by body and number.
    pub pieces: Vec<(SoftBodyHandle, PieceId)>,
    /// Bodies that were removed because all of their pieces were removed; their handles are stale.
    pub soft_bodies: Vec<SoftBodyHandle>,
    /// Removed dynamic rigid bodies.
    pub rigid_bodies: Vec<RigidBodyHandle>,
    /// Total mass of the removed pieces [kg].
    pub mass: f64,
}

impl<D: Dim> World<D> {
    /// Removes a piece of a body with its voxels, elements and nodes. Its contacts end and its joints break.
    /// Everything else keeps its position and state, but sleeping objects in contact with the piece wake. Piece
    /// numbers are never reused. Removing the last piece removes the body, as [`World::remove`] does,
    /// and makes its handle stale.
    ///
    /// ```
    /// use fuwafuwa::{Blade, Dim2, Material, PieceId, SoftBody, Vec2, VoxelGrid, World, WorldConfig};
    ///
    /// let mut world = World::<Dim2>::new(WorldConfig::default())?;
    /// let cake = SoftBody::new(VoxelGrid::cube(16, 1.0)?, &[Material::default()])?;
    /// let cake = world.add_soft_body(cake)?;
    /// let across = Blade::segment(Vec2::new(0.3, -1.0), Vec2::new(0.3, 2.0));
    /// world.cut(cake, &across)?;
    /// assert_eq!(world[cake].pieces().count(), 2);
    /// let removed = world.remove_piece(cake, PieceId(1))?;
    /// assert!((removed.mass + world[cake].total_mass() - 100.0).abs() < 1e-3);
    /// assert_eq!(world[cake].pieces().count(), 1);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::InvalidHandle`] if the body does not exist, [`Error::InvalidParameter`] if it has no such piece.
    #[inline(never)]
    pub fn remove_piece(&mut self, body: SoftBodyHandle, piece: PieceId) -> Result<Removed, Error> {
        match self.bodies.get(body)?.has_piece(piece) {
            true => Ok(self.remove_pieces(&[(body, piece)])),
            false => {
                let expected = "the number of a piece that the body still has";
                Err(Error::parameter("piece", expected, piece.0))
            }
        }
    }

    /// Removes all pieces below a size, as [`World::remove_piece`] does. In a long game, use it to remove
    /// crumbs, which cost computing time.
    ///
    /// ```
    /// use fuwafuwa::{Dim3, Material, PieceSize, SoftBody, VoxelGrid, World, WorldConfig};
    ///
    /// let mut world = World::<Dim3>::new(WorldConfig::default())?;
    /// let ball = SoftBody::new(VoxelGrid::ball(8, 0.4)?, &[Material::default()])?;
    /// let ball = world.add_soft_body(ball)?;
    /// world.soft_body_mut(ball)?.crumble();
    /// assert_eq!(world.remove_small_pieces(PieceSize::Voxels(1))?.pieces, []);
    /// let removed = world.remove_small_pieces(PieceSize::Voxels(2))?;
    /// assert_eq!(removed.soft_bodies, [ball]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] if a volume or a mass is negative or not finite.
    #[inline(never)]
    pub fn remove_small_pieces(&mut self, size: PieceSize) -> Result<Removed, Error> {
        let (PieceSize::Volume(least) | PieceSize::Mass(least)) = size else {
            return Ok(self.remove_pieces_where(|body| smaller_than(body, size)));
        };
        match least >= 0.0 && least.is_finite() {
            true => Ok(self.remove_pieces_where(|body| smaller_than(body, size))),
            false => {
                let expected = "0 or more, and finite";
                Err(Error::parameter("size", expected, least))
            }
        }
    }

    /// Removes everything that is outside `region`: pieces without a node in the region, as
    /// [`World::remove_piece`] does, and dynamic rigid bodies that do not overlap the region. Fixed,
    /// kinematic and coupled rigid bodies stay. To remove objects that fall for ever, use the half-space
    /// above a plane that is below the lowest floor:
    ///
    /// ```
    /// use fuwafuwa::{Dim3, RigidBody, Shape, Vec3, World, WorldConfig};
    ///
    /// let mut world = World::<Dim3>::new(WorldConfig::default())?;
    /// let ball = world.add_rigid_body(RigidBody::dynamic(Shape::ball(0.1), 1.0))?;
    /// // The solid side of this half-space is above the plane, because its normal points down.
    /// let above = Shape::half_space(Vec3::NEG_Y, Vec3::new(0.0, -2.0, 0.0));
    /// let mut removed = world.remove_outside(&above)?;
    /// while removed.rigid_bodies.is_empty() && world.ticks() < 60 {
    ///     world.step();
    ///     removed = world.remove_outside(&above)?;
    /// }
    /// assert_eq!(removed.rigid_bodies, [ball]);
    /// assert_eq!(world.rigid_bodies().count(), 0);
    /// # Ok::<(), fuwafuwa::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] if the region is not a valid [shape](Shape::check).
    #[inline(never)]
    pub fn remove_outside(&mut self, region: &Shape<D>) -> Result<Removed, Error> {
        region.check().map_err(|error| error.of("region"))?;
        let region = region.solid();
        let mut removed = self.remove_pieces_where(|body| {
            let mut outside: Vec<bool> = vec![true; body.pieces().list.len()];
            for (id, _) in body.mesh().nodes() {
                let at = body.positions()[id].xyz();
                // Comparisons with NaN are false, so a non-finite position is outside of every region.
                let is_inside = region.distance(at).0 <= 0.0;
                outside[body.pieces().of_node(id).index()] &= !is_inside;
            }
            outside
        });
        let dynamic = self
            .rigids
            .entries()
            .filter(|(_, rigid)| rigid.is_dynamic());
        let outside = dynamic.filter(|(_, rigid)| rigid.shape().gap(&region).0 > 0.0);
        removed.rigid_bodies = outside.map(|(id, _)| id).collect();
        for &body in &removed.rigid_bodies {
            if self.remove_rigid_body(body).is_ok() {
                self.events.push(Event::RigidBodyRemoved { body });
            }
        }
        Ok(removed)
    }

    /// Removes the pieces that `marks` selects. For each body, `marks` returns a flag per piece number: true
    /// if the piece is to be removed.
    fn remove_pieces_where(&mut self, marks: impl Fn(&SoftBody<D>) -> Vec<bool>) -> Removed {
        let mut pieces = Vec::new();
        for (id, body) in self.bodies.entries() {
            let marked = body.pieces().list.ids().zip(marks(body));
            let marked = marked.filter(|&(piece, is_marked)| is_marked && body.has_piece(piece));
            pieces.extend(marked.map(|(piece, _)| (id, piece)));
        }
        self.remove_pieces(&pieces)
    }

    /// Removes pieces, given in ascending order, and wakes the sleeping objects in contact with them. All
    /// pieces must exist.
    fn remove_pieces(&mut self, pieces: &[(SoftBodyHandle, PieceId)]) -> Removed {
        let mut removed = Removed::default();
        if pieces.is_empty() {
            return removed;
        }
        let hits = pieces.iter().map(|&(body, piece)| (body.slot(), piece));
        let supported = supported_by_pieces(&hits.collect::<Vec<Hit>>(), &self.bodies);
        let mut was = Vec::new();
        for own in pieces.chunk_by(|a, b| a.0 == b.0) {
            let id = own[0].0;
            let is_one = |piece| own.binary_search(&(id, piece)).is_ok();
            was.extend(bounds_of(&self.bodies[id], is_one));
            let of_it = own.iter().map(|&(_, piece)| piece);
            self.remove_pieces_of(id, &of_it.collect::<Vec<PieceId>>(), &mut removed);
        }
        self.wake_supported(supported, was);
        removed
    }

    /// Removes pieces of a body, and the body itself if no piece remains. Adds them to `removed`.
    fn remove_pieces_of(&mut self, id: SoftBodyHandle, pieces: &[PieceId], removed: &mut Removed) {
        let body = self.bodies.at_mut(id.slot());
        let whole = body.total_mass();
        let events = pieces
            .iter()
            .map(|&piece| Event::PieceRemoved { body: id, piece });
        self.events.extend(events);
        removed
            .pieces
            .extend(pieces.iter().map(|&piece| (id, piece)));
        if pieces.len() == body.pieces().count() {
            removed.mass += whole;
            if self.bodies.remove(id).is_ok() {
                self.nearby.remove_body(id.slot());
                self.events.push(Event::SoftBodyRemoved { body: id });
                removed.soft_bodies.push(id);
            }
            return;
        }
        let changes = body.remove_pieces(pieces);
        removed.mass += whole - body.total_mass();
        let nearby = &mut self.nearby;
        nearby.remove_elements(id.slot(), body, &changes.elements);
    }
}

/// Returns a flag for each piece number: whether the piece is smaller than `size`.
fn smaller_than<D: Dim>(body: &SoftBody<D>, size: PieceSize) -> Vec<bool> {
    let (mesh, pieces) = (body.mesh(), body.pieces());
    let mut found = vec![0.0; pieces.list.len()];
    if let PieceSize::Mass(_) = size {
        for (id, _) in mesh.nodes() {
            found[pieces.of_node(id).index()] += f64::from(body.masses()[id]);
        }
    } else {
        for (id, element) in mesh.elements() {
            found[pieces.of_element(id).index()] += mesh.voxels(element).count() as f64;
        }
    }
    let width = f64::from(body.grid().voxel_size());
    let voxel = (0..D::N).fold(1.0, |volume, _| volume * width);
    let least = match size {
        PieceSize::Voxels(count) => count as f64,
        PieceSize::Volume(volume) => volume / voxel,
        PieceSize::Mass(mass) => mass,
    };
    found.into_iter().map(|size| size < least).collect()
}
