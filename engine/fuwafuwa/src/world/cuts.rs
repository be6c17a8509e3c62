//! Knives: put in, taken out, looked at, and their phases of a substep.

use super::{Refused, World};
use crate::contact::Hit;
use crate::dim::Dim;
use crate::event::{Event, StepReport};
use crate::handle::{Gone, KnifeId};
use crate::knife::{Knife, Knives};

impl<D: Dim> World<D> {
    /// Gives something rigid that follows a goal an edge that cuts.
    ///
    /// # Errors
    /// [`Refused`] when it is not there or does not follow a goal, or when a number is out of range.
    #[inline(never)]
    pub fn add_knife(&mut self, mut knife: Knife) -> Result<KnifeId, Refused> {
        self.rigids.get(knife.holder)?;
        let refused = |(field, expected)| Refused::Argument { field, expected };
        knife.check::<D>(&self.rigids).map_err(refused)?;
        // It may have been in another world.
        knife.forget();
        Ok(self.knives.insert(knife))
    }

    /// Takes a knife out of the world; what holds it stays.
    ///
    /// # Errors
    /// [`Gone`] when there is no such knife.
    #[inline(never)]
    pub fn remove_knife(&mut self, knife: KnifeId) -> Result<Knife, Gone> {
        self.knives.remove(knife)
    }

    /// The edges that cut. One whose holder was taken out cuts nothing.
    pub fn knives(&self) -> &Knives {
        &self.knives
    }

    /// Opens what edges went through.
    #[inline(never)]
    pub(super) fn cut_along_edges(&mut self, report: &mut StepReport) {
        let round = self.settings.round();
        for (id, knife) in self.knives.entries_mut() {
            let Ok(holder) = self.rigids.get(knife.holder) else {
                continue;
            };
            for cut in knife.pass(&self.bodies, holder, round) {
                let body = self.bodies.get_mut(cut.body).expect("it was looked at");
                let (released, changes) = body
                    .open(&cut.faces)
                    .expect("a release leaves the mesh whole");
                if released.is_empty() {
                    continue;
                }
                report.released += released.len() as u32;
                report.parted += changes.parted.len() as u32;
                let [area, work] = knife.take_sums();
                self.events.push(Event::Cut {
                    knife: id,
                    body: cut.body,
                    at: cut.at,
                    area,
                    work,
                });
                self.events.extend(Event::parted(cut.body, &changes.parted));
                self.nearby.tear(cut.body.slot(), body, &changes);
            }
        }
    }

    /// Lets edges hold what they are in. Returns the sleepers that they wake.
    #[inline(never)]
    pub(super) fn hold_edges(&mut self, duration: f32) -> Vec<Hit> {
        let mut woken = Vec::new();
        let round = self.settings.round();
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
