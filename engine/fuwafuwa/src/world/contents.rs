//! Contents of a world: insertion, removal, access and wake-up.

use super::{World, WorldConfig};
use crate::contact::broad_phase::{bounds_of, sleeping_in, supported_by_body, supported_by_rigid};
use crate::contact::solver::Hit;
use crate::error::Error;
use crate::event::Event;
use crate::foundation::arena::{RigidBodyHandle, RigidSlot, SoftBodyHandle};
use crate::foundation::dim::{Dim, DimVector};
use crate::foundation::hash::{Hash, HashState};
use crate::fracture::blade::{Blade, CutReport};
use crate::math::rotation::Rotation;
use crate::rigid_body::solid::Bounds;
use crate::rigid_body::{RigidBody, RigidBodyRef, RigidState};
use crate::soft_body::SoftBody;
use crate::soft_body::rayleigh::Damping;
use std::ops::Index;

impl<D: Dim> World<D> {
    /// Adds a soft body. [`WorldConfig::stiff_bodies`] says what happens to a body that requires more than the
    /// maximum number of substeps. A body inside another object is pushed out of it, see
    /// [`Event::Overlapped`].
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] if a node is not finite or out of the [range](SoftBody::range) of the body.
    #[inline(never)]
    pub fn add_soft_body(&mut self, mut body: SoftBody<D>) -> Result<SoftBodyHandle, Error> {
        body.check_range(|at| at)?;
        body.scale_for(&self.config);
        body.announce_scale();
        let id = self.bodies.insert(body);
        // The body may have fallen asleep in another world.
        self.wake_body(id);
        self.overlaps.place(id.into());
        Ok(id)
    }

    /// Returns the Rayleigh damping that acts in a soft body, for each of its materials: that of the material,
    /// with the stiffness damping limited to the largest that the substep allows. A
    /// [mass scale](SoftBody::mass_scale) s makes vibrations √s times slower. Their damping ratio stays the same:
    /// the mass damping is divided by √s, and the stiffness damping multiplied. At least a tenth of a substep of
    /// stiffness damping then acts.
    ///
    /// The limit is 0.7 (4/Ω² − h²) / 2h, with the substep h = tick / [`substeps`](World::substeps) and the
    /// angular frequency Ω of the breathing mode of a single voxel. In N dimensions, Ω² = 4 (N λ + 2µ) / ρs²,
    /// divided by the mass scale, with Lamé's parameters λ and µ, the density ρ and the voxel size s. More
    /// substeps, larger voxels or a softer material raise the limit.
    ///
    /// # Errors
    /// [`Error::InvalidHandle`] if the handle is stale.
    pub fn acting_damping(&self, body: SoftBodyHandle) -> Result<Vec<Damping>, Error> {
        let duration = self.config.tick / self.substeps() as f32;
        Ok(self.bodies.get(body)?.acting_damping(duration).collect())
    }

    /// Adds a rigid body.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] if a parameter is out of range.
    #[inline(never)]
    pub fn add_rigid_body(&mut self, body: RigidBody<D>) -> Result<RigidBodyHandle, Error> {
        let rigid = RigidState::from(&body);
        rigid.check()?;
        let id = self.rigids.insert(rigid);
        self.overlaps.place(id.into());
        Ok(id)
    }

    /// Sets the target position [m] of a kinematic or coupled rigid body. The target moves there at a
    /// constant velocity during the next tick. A kinematic body follows exactly, a coupled one as far as its
    /// spring and contacts allow.
    ///
    /// # Errors
    /// [`Error`] if the handle is stale, the body is fixed or dynamic, or the target is not finite or
    /// beyond ±1e6 m. The target then stays unchanged.
    pub fn set_target_position(
        &mut self,
        rigid: RigidBodyHandle,
        position: D::Vector,
    ) -> Result<(), Error> {
        self.rigids
            .get_mut(rigid)?
            .set_target_position(position.to_vec3())
    }

    /// Sets the target rotation of a kinematic or coupled rigid body, which reaches it at the end of the next
    /// tick. In 2D only the part of the rotation about the third axis is used.
    ///
    /// # Errors
    /// [`Error`] if the handle is stale, or the body is fixed or dynamic. The target then stays unchanged.
    pub fn set_target_rotation(
        &mut self,
        rigid: RigidBodyHandle,
        rotation: Rotation,
    ) -> Result<(), Error> {
        self.rigids
            .get_mut(rigid)?
            .set_target_rotation::<D>(rotation)
    }

    /// Cuts a body along a blade immediately, regardless of the strength of its material, and returns the
    /// number of split nodes. [`World::events`] lists the splits and the detached pieces until the next tick.
    ///
    /// # Errors
    /// [`Error::InvalidHandle`] if the handle is stale.
    #[inline(never)]
    pub fn cut(&mut self, body: SoftBodyHandle, blade: &Blade<D>) -> Result<usize, Error> {
        self.bodies.get(body)?;
        self.wake_body(body);
        let CutReport {
            split_nodes,
            detached,
        } = self.bodies.get_mut(body)?.cut(blade);
        let energy = 0.0;
        let positions = split_nodes.iter();
        let releases = positions.map(|&point| Event::NodeSplit {
            body,
            point,
            energy,
        });
        self.events.extend(releases);
        self.events.extend(Event::pieces_detached(body, &detached));
        Ok(split_nodes.len())
    }

    /// Returns a body mutably, for changes such as fixing nodes, translating or cutting. The whole body
    /// wakes, and its change history restarts, so that bookmarks become invalid. Do not assign another body
    /// to the reference, because the stiffness of that body would not be adapted to the substeps of the
    /// world. Remove the old body and add the new one instead.
    ///
    /// # Errors
    /// [`Error::InvalidHandle`] if the handle is stale.
    #[inline(never)]
    pub fn soft_body_mut(&mut self, id: SoftBodyHandle) -> Result<&mut SoftBody<D>, Error> {
        self.bodies.get(id)?;
        self.wake_body(id);
        let body = self.bodies.get_mut(id)?;
        // The caller's changes are not recorded, so the history restarts and bookmarks become invalid.
        body.forget_history();
        self.overlaps.place(id.into());
        Ok(body)
    }

    /// Removes a soft body, see [`World::remove`].
    #[inline(never)]
    pub(crate) fn remove_soft_body(&mut self, body: SoftBodyHandle) -> Result<SoftBody<D>, Error> {
        let removed = self.bodies.remove(body)?;
        self.nearby.remove_body(body.slot());
        let supported = supported_by_body(&removed, &self.bodies);
        self.wake_supported(supported, bounds_of(&removed, |_| true));
        Ok(removed)
    }

    /// Removes a rigid body, see [`World::remove`].
    #[inline(never)]
    pub(crate) fn remove_rigid_body(
        &mut self,
        rigid: RigidBodyHandle,
    ) -> Result<RigidBody<D>, Error> {
        let removed = self.rigids.remove(rigid)?;
        self.nearby.remove_rigid(rigid.slot());
        let supported = supported_by_rigid(&removed, &self.bodies);
        self.wake_supported(supported, vec![removed.shape().bounds()]);
        Ok(removed.definition())
    }

    /// Returns the configuration.
    pub fn config(&self) -> &WorldConfig<D> {
        &self.config
    }

    /// Returns a soft body; `world[body]` does the same and panics if the handle is stale.
    ///
    /// # Errors
    /// [`Error::InvalidHandle`] if the handle is stale.
    pub fn soft_body(&self, body: SoftBodyHandle) -> Result<&SoftBody<D>, Error> {
        self.bodies.get(body)
    }

    /// Returns a rigid body.
    ///
    /// # Errors
    /// [`Error::InvalidHandle`] if the handle is stale.
    pub fn rigid_body(&self, body: RigidBodyHandle) -> Result<RigidBodyRef<'_, D>, Error> {
        self.rigids.get(body).map(RigidBodyRef::new)
    }

    /// Iterates over the handles and soft bodies, in the order of their arena slots.
    pub fn soft_bodies(&self) -> impl Iterator<Item = (SoftBodyHandle, &SoftBody<D>)> + Clone {
        self.bodies.entries()
    }

    /// Iterates over the handles and rigid bodies, in the order of their arena slots.
    pub fn rigid_bodies(
        &self,
    ) -> impl Iterator<Item = (RigidBodyHandle, RigidBodyRef<'_, D>)> + Clone {
        let rigids = self.rigids.entries();
        rigids.map(|(id, rigid)| (id, RigidBodyRef::new(rigid)))
    }

    /// Returns the handle of soft body number `n`, counted from 0 in the order of [`World::soft_bodies`].
    pub fn nth_soft_body(&self, n: usize) -> Option<SoftBodyHandle> {
        self.bodies.ids().nth(n)
    }

    /// Returns the handle of the kinematic or coupled rigid body number `n`, counted from 0 in the order of
    /// [`World::rigid_bodies`].
    pub fn nth_target_follower(&self, n: usize) -> Option<RigidBodyHandle> {
        let followers = self
            .rigids
            .entries()
            .filter(|(_, rigid)| rigid.follows_target());
        followers.map(|(id, _)| id).nth(n)
    }

    /// Returns the events of the last tick, and of method calls on the world since that tick.
    pub fn events(&self) -> &[Event<D>] {
        &self.events
    }

    /// Returns the number of ticks since the world was created.
    pub fn ticks(&self) -> u64 {
        self.ticks
    }

    /// Returns a hash of the whole state, which is everything that a snapshot contains. Worlds with equal
    /// hashes are bit-identical, except for hash collisions, and evolve identically.
    #[inline(never)]
    pub fn hash(&self) -> u64 {
        let mut hash = Hash::NONE;
        self.hash_state(&mut hash);
        hash.number()
    }

    /// Wakes the pieces in `supported`, given in ascending order, and the dynamic rigid bodies with bounding
    /// boxes that overlap one of the boxes in `was`. Repeats this for objects in contact with the woken ones,
    /// until no further rigid body wakes. The AABB test is conservative, so it may wake rigid bodies that
    /// were only close.
    pub(super) fn wake_supported(&mut self, supported: Vec<Hit>, was: Vec<Bounds>) {
        let (mut pieces, mut places) = (supported, was);
        loop {
            for (slot, body) in self.bodies.by_slot() {
                let is_one = |piece| pieces.binary_search(&(slot, piece)).is_ok();
                if pieces.iter().any(|&(own, _)| own == slot) {
                    places.extend(bounds_of(body, is_one));
                }
            }
            self.wake(&pieces);
            let woken = sleeping_in::<D>(&places, &self.rigids);
            if woken.is_empty() {
                return;
            }
            self.wake_rigids(&woken);
            let woken = woken.iter().map(|&slot| self.rigids.at(slot));
            places = woken.clone().map(|rigid| rigid.shape().bounds()).collect();
            let supported = woken.map(|rigid| supported_by_rigid(rigid, &self.bodies));
            pieces = supported.flatten().collect();
            pieces.sort_unstable();
        }
    }

    /// Wakes all dynamic rigid bodies.
    pub(super) fn wake_all_rigids(&mut self) {
        let sleepers = self.rigids.by_slot().filter(|(_, rigid)| rigid.is_asleep());
        let sleepers: Vec<RigidSlot> = sleepers.map(|(slot, _)| slot).collect();
        self.wake_rigids(&sleepers);
        // Soft pieces that rest on the woken rigid bodies wake, too, because they may lose their support.
        for slot in sleepers {
            let supported = supported_by_rigid(self.rigids.at(slot), &self.bodies);
            self.wake(&supported);
        }
    }

    /// Wakes all pieces of a body.
    pub(super) fn wake_body(&mut self, body: SoftBodyHandle) {
        let pieces = self.bodies[body].pieces().list.ids();
        let pieces: Vec<Hit> = pieces.map(|piece| (body.slot(), piece)).collect();
        self.wake(&pieces);
    }
}

impl<D: Dim> Index<SoftBodyHandle> for World<D> {
    type Output = SoftBody<D>;

    /// Returns a soft body; [`World::soft_body`] returns an error instead of panicking.
    ///
    /// # Panics
    /// If the handle is stale.
    fn index(&self, body: SoftBodyHandle) -> &SoftBody<D> {
        &self.bodies[body]
    }
}
