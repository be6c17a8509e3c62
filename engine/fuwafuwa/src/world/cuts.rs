//! Knives of a world: insertion, removal, access and simulation.

use super::World;
use crate::contact::solver::Hit;
use crate::error::Error;
use crate::event::{Event, StepReport};
use crate::foundation::arena::KnifeHandle;
use crate::foundation::dim::{Dim, DimVector};
use crate::fracture::knife::{Knife, KnifeRef, KnifeState};

impl<D: Dim> World<D> {
    /// Attaches a knife to a kinematic or coupled rigid body.
    ///
    /// # Errors
    /// [`Error`] if the handle of the rigid body is stale, the body is fixed or dynamic, or a parameter is
    /// out of range.
    #[inline(never)]
    pub fn add_knife(&mut self, knife: Knife<D>) -> Result<KnifeHandle, Error> {
        let knife = KnifeState::from(&knife);
        knife.check::<D>(&self.rigids)?;
        Ok(self.knives.insert(knife))
    }

    /// Removes a knife, see [`World::remove`].
    #[inline(never)]
    pub(crate) fn remove_knife(&mut self, knife: KnifeHandle) -> Result<Knife<D>, Error> {
        Ok(self.knives.remove(knife)?.definition())
    }

    /// Returns a knife. A knife on a removed rigid body does not cut.
    ///
    /// # Errors
    /// [`Error::InvalidHandle`] if the handle is stale.
    pub fn knife(&self, knife: KnifeHandle) -> Result<KnifeRef<'_, D>, Error> {
        self.knives.get(knife).map(KnifeRef::new)
    }

    /// Iterates over the handles and knives, in the order of their arena slots.
    pub fn knives(&self) -> impl Iterator<Item = (KnifeHandle, KnifeRef<'_, D>)> + Clone {
        let knives = self.knives.entries();
        knives.map(|(id, knife)| (id, KnifeRef::new(knife)))
    }

    /// Separates the voxels between which cutting edges have passed since the last call, and reports the
    /// cuts.
    #[inline(never)]
    pub(super) fn cut_along_edges(&mut self, report: &mut StepReport) {
        let round = self.config.fracture_interval();
        for (id, knife) in self.knives.entries_mut() {
            let Ok(holder) = self.rigids.get(knife.holder) else {
                continue;
            };
            for cut in knife.end_sweep(&self.bodies, holder, round) {
                let body = self
                    .bodies
                    .get_mut(cut.body)
                    .expect("the cut names a live body");
                let (released, changes) = body.open(&cut.faces);
                if released.is_empty() {
                    continue;
                }
                report.nodes_split += released.len() as u32;
                report.pieces_detached += changes.detached.len() as u32;
                let [area, work] = knife.take_sums();
                self.events.push(Event::Cut {
                    knife: id,
                    body: cut.body,
                    point: D::Vector::from_vec3(cut.at),
                    area,
                    work,
                });
                self.events
                    .extend(Event::pieces_detached(cut.body, &changes.detached));
                self.nearby.tear(cut.body.slot(), body, &changes);
            }
        }
    }

    /// Solves the contacts between cutting edges and soft bodies. Returns the sleeping pieces that the edges
    /// hit; the caller must wake them.
    #[inline(never)]
    pub(super) fn solve_knife_contacts(&mut self, duration: f32) -> Vec<Hit> {
        let mut woken = Vec::new();
        let round = self.config.fracture_interval();
        for knife in self.knives.iter_mut() {
            let Ok(holder) = self.rigids.get(knife.holder) else {
                knife.forget();
                continue;
            };
            knife.follow(&self.bodies, holder, round);
            woken.extend(knife.solve(&mut self.bodies, &mut self.rigids, duration));
        }
        woken
    }
}
