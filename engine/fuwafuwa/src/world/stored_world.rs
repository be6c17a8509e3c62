//! Fields of a [`World`] in a snapshot, and the checks after reading them.

use super::contact_events::SettlingContact;
use super::grips::{GripState, Grips};
use super::{Nearby, Overlaps, World, WorldConfig};
use crate::contact::joint::{JointState, Joints};
use crate::contact::solver::Contacts;
use crate::error::Error;
use crate::event::{Contact, Event};
use crate::foundation::arena::RigidBodyHandle;
use crate::foundation::dim::Dim;
use crate::fracture::knife::{KnifeState, Knives};
use crate::object_ref::ObjectRef;
use crate::query::query_cache::QueryCache;
use crate::rigid_body::{RigidBodies, RigidState};
use crate::soft_body::{SoftBodies, SoftBody};

/// Largest tick counter accepted from a snapshot. At 60 ticks a second, a world reaches it after some 6·10⁸
/// years.
const MAX_TICKS: u64 = 1 << 60;

/// Fields of a [`World`] as read from a snapshot, in the same order as in `World`, not yet checked.
#[derive(serde::Deserialize)]
#[serde(bound = "")]
pub(crate) struct StoredWorld<D: Dim> {
    config: WorldConfig<D>,
    bodies: SoftBodies<D>,
    rigids: RigidBodies,
    joints: Joints,
    knives: Knives,
    grips: Grips,
    ticks: u64,
    nearby: Nearby,
    events: Vec<Event<D>>,
    touching: Vec<Contact<D>>,
    settling: Vec<SettlingContact<D>>,
    inside: Vec<(RigidBodyHandle, ObjectRef)>,
    overlaps: Overlaps,
}

impl<D: Dim> TryFrom<StoredWorld<D>> for World<D> {
    type Error = Error;

    /// Checks the fields from a snapshot, and rebuilds the fields that a snapshot does not contain.
    ///
    /// # Errors
    /// [`Error::InvalidSnapshot`] with the violated condition.
    fn try_from(stored: StoredWorld<D>) -> Result<Self, Error> {
        stored.check()?;
        let mut world = Self {
            config: stored.config,
            bodies: stored.bodies,
            rigids: stored.rigids,
            joints: stored.joints,
            knives: stored.knives,
            grips: stored.grips,
            ticks: stored.ticks,
            nearby: stored.nearby,
            events: stored.events,
            touching: stored.touching,
            settling: stored.settling,
            inside: stored.inside,
            overlaps: stored.overlaps,
            contacts: Contacts::default(),
            query_cache: QueryCache::default(),
            slowed: Default::default(),
        };
        world.bodies.iter_mut().for_each(SoftBody::restore);
        world.nearby.keep_known(&world.bodies, &world.rigids);
        world.touching.sort_by_key(|contact| contact.pair);
        world.touching.dedup_by_key(|contact| contact.pair);
        world.settling.sort_by_key(|settling| settling.pair);
        world.settling.dedup_by_key(|settling| settling.pair);
        world.inside.sort_unstable();
        world.inside.dedup();
        world.overlaps.pairs.sort_unstable();
        world.overlaps.pairs.dedup();
        Ok(world)
    }
}

impl<D: Dim> StoredWorld<D> {
    fn check(&self) -> Result<(), Error> {
        let checks = [
            (
                "its configuration is out of range",
                self.config.check().is_ok(),
            ),
            (
                "a rigid body in it is invalid",
                self.rigids.iter().all(RigidState::is_sound::<D>),
            ),
            (
                "a joint in it is invalid",
                self.joints.iter().all(JointState::is_sound::<D>),
            ),
            (
                "a knife in it is invalid",
                self.knives.iter().all(KnifeState::is_sound::<D>),
            ),
            (
                "a grip in it is invalid",
                self.grips.iter().all(GripState::is_sound::<D>),
            ),
            (
                "its tick counter is above the limit",
                self.ticks <= MAX_TICKS,
            ),
        ];
        let invalid = |reason: String| Error::InvalidSnapshot { reason };
        if let Some((reason, _)) = checks.into_iter().find(|(_, is_valid)| !is_valid) {
            return Err(invalid(reason.to_owned()));
        }
        for (id, body) in self.bodies.entries() {
            let slot = id.slot().index();
            let checked = body.check();
            checked.map_err(|violation| invalid(format!("soft body {slot}: {violation}")))?;
        }
        Ok(())
    }
}
