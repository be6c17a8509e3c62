//! Which contact spheres may touch each other.
//!
//! They are looked for along the way that each is going to take: a straight *path*, from which it may stray
//! a little, and which holds the shorter the faster things are. Only those that have strayed further, woke or came to the surface
//! are looked for again; so no pair can be missed, whatever moves as long as it is finite. A search
//! for all leaves neighbours in one piece out: which of those are lips of a crack is known without it.
//!
//! ```text
//!    ●──────────┤        two paths make a pair when their spheres, widened by what they may stray,
//!      ╲                 come close enough at the same time
//!    ●──╲───────┤
//! ```

use super::bins::Bins;
use super::neighbours::Neighbours;
use super::pair::{SpherePair, merge};
use super::path::{Path, STRAY, Span, Start, Traveller, widened};
use super::sphere::{ContactSphere, SphereId};
use super::spheres::Spheres;
use crate::body::Bodies;
use crate::dim::Dim;
use crate::ids::Table;
use crate::lanes::on_widest_lanes;
use crate::solve::Row;
use crate::threads::{self, SHARE};
use crate::vector::{dot, length, minus, plus, scaled};

/// The share of spheres whose paths may be long, and half the length of the longest of the rest, as a share of the reach:
/// where more is faster, paths end sooner. Short ones are looked for bin by bin, long ones look around for themselves. A 16th
/// takes `tear-3d` 3 % longer, a 64th does not; half the length takes it and `diced` up to 8 % longer, twice up to 9.
const LONG_SHARE: usize = 32;
const LONGEST_SHORT: f32 = 0.125;
/// Paths hold for so long at the most [s]: what falls has strayed by 5 cm then. Half and twice as much take the same.
const LONGEST_TIME: f32 = 0.1;
/// Looking for all pairs is quicker than for those of this share of what is awake one by one; and sorting a sphere into bins
/// takes as long as comparing so many. 2 to 16, and 3 to 48, take the same; with MANY 1 most ticks of `diced` take 10 % more.
const MANY: usize = 4;
const COMPARED: usize = 12;

/// The place among the loose of a sphere that the bins find.
const BINNED: u32 = u32::MAX;

/// Spheres whose pairs one thread looks for at a time: fewer than are in a share, for each looks through bins of others.
const LOOKS: usize = SHARE / 8;

/// The pairs of spheres that may touch while their paths hold.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct SpherePairs {
    /// Ascending.
    pub list: Vec<SpherePair>,
    #[cfg_attr(feature = "serde", serde(skip))]
    paths: Table<SphereId, Path>,
    /// Where they begin.
    #[cfg_attr(feature = "serde", serde(skip))]
    starts: Table<SphereId, Start>,
    /// Where the middles of all paths are; nothing while all must be looked for.
    #[cfg_attr(feature = "serde", serde(skip))]
    bins: Option<Bins>,
    /// When they are there [s].
    #[cfg_attr(feature = "serde", serde(skip))]
    binned_at: f32,
    /// The spheres in the order of the bins.
    #[cfg_attr(feature = "serde", serde(skip))]
    binned: Vec<Traveller>,
    /// The mean velocity of what moves, as seen from which paths are short or long [m/s], and half the
    /// length of the longest of the short ones [m].
    #[cfg_attr(feature = "serde", serde(skip))]
    frame: Row,
    #[cfg_attr(feature = "serde", serde(skip))]
    short: f32,
    /// Spheres that bins do not find: with long paths, or with other ones than when they were sorted.
    #[cfg_attr(feature = "serde", serde(skip))]
    loose: Vec<Traveller>,
    /// The place of each sphere among them, or [`BINNED`].
    #[cfg_attr(feature = "serde", serde(skip))]
    loose_at: Table<SphereId, u32>,
    /// Whether the list is that of the last tick still.
    #[cfg_attr(feature = "serde", serde(skip))]
    is_new_tick: bool,
    /// Spheres to be looked for again, beside those that stray.
    #[cfg_attr(feature = "serde", serde(skip))]
    pub changed: Vec<SphereId>,
    /// Since all were looked for, and from then to the end of all paths [s].
    #[cfg_attr(feature = "serde", serde(skip))]
    elapsed: f32,
    #[cfg_attr(feature = "serde", serde(skip))]
    duration: f32,
    /// How close the largest spheres are looked for, and how far the smallest may stray [m].
    #[cfg_attr(feature = "serde", serde(skip))]
    reach: f32,
    #[cfg_attr(feature = "serde", serde(skip))]
    least_stray: f32,
    /// How far anything may still come before one may have strayed [m], and the greatest speed along
    /// a path [m/s].
    #[cfg_attr(feature = "serde", serde(skip))]
    spare: f32,
    #[cfg_attr(feature = "serde", serde(skip))]
    pace: f32,
}

impl SpherePairs {
    /// What passed in the last tick is settled. Where spheres are listed anew, all pairs will be looked for.
    pub fn start_tick(&mut self, is_listed_anew: bool) {
        if is_listed_anew {
            self.bins = None;
            self.starts.clear();
        }
        self.is_new_tick = true;
        for pair in &mut self.list {
            (pair.impulse.total, pair.impulse.speed) = (0.0, 0.0);
        }
    }

    /// So much time has passed [s], in which no node came further than by `distance` [m].
    pub fn pass(&mut self, duration: f32, distance: f32) {
        self.elapsed += duration;
        self.spare -= distance + self.pace * duration;
    }

    /// Follows the spheres, and brings the list up to date. Returns whether it changed, or is that of a new
    /// tick.
    pub fn follow<D: Dim>(&mut self, spheres: &mut Spheres, bodies: &Bodies<D>) -> bool {
        let is_new_tick = std::mem::take(&mut self.is_new_tick);
        if spheres.awake.is_empty() {
            self.list.clear();
            self.bins = None;
            return is_new_tick;
        }
        if self.bins.is_none() || self.elapsed > self.duration {
            spheres.move_all(bodies);
            self.find_all(spheres, bodies);
            return true;
        }
        if self.spare > 0.0 && self.changed.is_empty() && !is_new_tick {
            spheres.move_close(bodies);
        } else {
            spheres.move_all(bodies);
            self.find_strayed(spheres);
        }
        let mut changed = std::mem::take(&mut self.changed);
        if changed.is_empty() {
            return is_new_tick;
        }
        changed.sort_unstable();
        changed.dedup();
        if MANY * changed.len() > spheres.awake.len() {
            self.find_all(spheres, bodies);
        } else {
            self.find_again(&changed, spheres, bodies);
        }
        true
    }

    /// Adds those that have strayed from their paths to the changed ones; notes what the others have
    /// to spare.
    fn find_strayed(&mut self, spheres: &Spheres) {
        let mut spare = f32::INFINITY;
        for &sphere in &spheres.awake {
            let Some(path) = self.paths.get(sphere.index()) else {
                continue;
            };
            let strayed = minus(spheres.centres[sphere], path.at(self.elapsed));
            let (strayed, most) = (dot(strayed, strayed), most_stray(spheres, sphere));
            if strayed > most * most {
                self.changed.push(sphere);
            } else {
                let left = most - strayed.sqrt();
                spare = if left < spare { left } else { spare };
            }
        }
        self.spare = spare;
    }

    /// For so many spheres.
    fn make_room(&mut self, count: usize) {
        self.paths.resize(count, Path::default());
        self.starts.resize(count, Start::UNKNOWN);
    }

    /// Lays the path of a sphere anew from where it is.
    fn lay<D: Dim>(&mut self, sphere: SphereId, spheres: &Spheres, bodies: &Bodies<D>) {
        let now = spheres.centres[sphere];
        let start = &mut self.starts[sphere];
        let (mut velocity, mut laid) = ([0.0; 4], Start::UNKNOWN);
        if !spheres.list[sphere].asleep {
            velocity = start.expected(now, self.elapsed, spheres.velocity(sphere, bodies));
            laid = Start {
                at: now,
                time: self.elapsed,
            };
        }
        *start = laid;
        let from = minus(now, scaled(velocity, self.elapsed));
        self.paths[sphere] = Path { from, velocity };
        let speed = length(velocity);
        self.pace = if speed > self.pace { speed } else { self.pace };
    }

    /// A sphere on its path.
    fn traveller(&self, sphere: SphereId, spheres: &Spheres) -> Traveller {
        let ContactSphere { radius, asleep, .. } = spheres.list[sphere];
        Traveller {
            path: self.paths[sphere],
            sweep: self.speed(sphere) * self.span().half,
            radius,
            sphere,
            asleep,
        }
    }

    /// Looks for all pairs.
    fn find_all<D: Dim>(&mut self, spheres: &Spheres, bodies: &Bodies<D>) {
        let count = spheres.list.len();
        self.changed.clear();
        self.make_room(count);
        self.starts
            .iter_mut()
            .for_each(|start| start.time -= self.elapsed);
        (self.elapsed, self.pace) = (0.0, 0.0);
        let all = spheres.list.ids();
        all.for_each(|sphere| self.lay(sphere, spheres, bodies));
        self.measure(spheres);
        let bins = self.bin::<D>(spheres);
        let neighbours = Neighbours::of(&self.binned, spheres, bodies);
        let mut found = self.short_pairs::<D>(&bins, &neighbours);
        found.extend(self.long_pairs::<D>(&bins, &neighbours, spheres));
        found.extend(self.lips(spheres));
        self.bins = Some(bins);
        merge(&mut self.list, &found, &vec![true; count].into());
    }

    /// Sorts all into bins, by the middle of what is left of their paths.
    fn bin<D: Dim>(&mut self, spheres: &Spheres) -> Bins {
        self.binned_at = self.remaining().middle;
        let middles = self.paths.iter().map(|path| path.at(self.binned_at));
        let middles: Vec<Row> = middles.collect();
        let bins = Bins::new::<D>(&middles, self.reach + 2.0 * self.short);
        let numbers = bins.numbers().iter().copied().map(SphereId);
        let binned = numbers.map(|sphere| self.traveller(sphere, spheres));
        self.binned = binned.collect();
        self.loose.clear();
        self.loose_at.clear();
        self.loose_at.resize(middles.len(), BINNED);
        for traveller in &self.binned {
            if traveller.sweep > self.short {
                self.loose_at[traveller.sphere] = self.loose.len() as u32;
                self.loose.push(*traveller);
            }
        }
        bins
    }

    /// Works out how far is looked: how close spheres may come, how far they may stray, for how long their
    /// paths hold, and how long the short ones are.
    fn measure(&mut self, spheres: &Spheres) {
        let radii = spheres.list.iter().map(|sphere| sphere.radius);
        let (smallest, largest) = radii.fold((f32::MAX, 0.0f32), |(low, high), radius| {
            (low.min(radius), high.max(radius))
        });
        self.least_stray = 2.0 * STRAY * smallest;
        self.spare = self.least_stray;
        self.reach = widened(2.0 * largest);
        self.set_frame(spheres);
        let speeds = { spheres.awake.iter() }.map(|&sphere| self.speed(sphere));
        let most = usual(speeds.filter(|speed| speed.is_finite()).collect());
        let longest = LONGEST_SHORT * self.reach;
        self.duration = match most * LONGEST_TIME > 2.0 * longest {
            true => 2.0 * longest / most,
            false => LONGEST_TIME,
        };
        self.short = most * self.span().half;
    }

    /// How fast a path goes, as seen from the frame [m/s].
    fn speed(&self, sphere: SphereId) -> f32 {
        length(minus(self.paths[sphere].velocity, self.frame))
    }

    /// Whether the bins find it: its path is short, and the one that it had when it was sorted.
    #[inline(always)]
    fn is_binned(&self, traveller: &Traveller) -> bool {
        self.loose_at[traveller.sphere] == BINNED
    }

    /// The pairs of which both have short paths, but for neighbours in a piece.
    fn short_pairs<D: Dim>(&self, bins: &Bins, neighbours: &Neighbours) -> Vec<Vec<[SphereId; 2]>> {
        let (span, reach) = (self.span(), self.reach + 2.0 * self.short);
        threads::map(bins.shares(), |share| {
            let mut found = Vec::new();
            on_widest_lanes!(simd => bins.pairs::<D, _>(
                simd,
                share,
                reach,
                |places| neighbours.are_asleep(places),
                #[inline(always)]
                |own, first| neighbours.of_eight(simd, neighbours.at(own), first),
                |a, b| {
                    let [a, b] = [a, b].map(|at| &self.binned[at]);
                    if a.meets(b, span) && self.is_binned(a) && self.is_binned(b) {
                        found.push(pair(a, b));
                    }
                },
            ));
            found
        })
    }

    /// The pairs of lips of a crack.
    fn lips(&self, spheres: &Spheres) -> Vec<Vec<[SphereId; 2]>> {
        // The place of each sphere in the order of the bins.
        let mut order: Table<SphereId, u32> = vec![0; self.binned.len()].into();
        for (traveller, at) in self.binned.iter().zip(0..) {
            order[traveller.sphere] = at;
        }
        let span = self.span();
        threads::map(spheres.lips.chunks(SHARE), |share| {
            let mut found = Vec::new();
            for &lips in share {
                let [a, b] = lips.map(|sphere| &self.binned[order[sphere] as usize]);
                if a.meets(b, span) {
                    found.push(pair(a, b));
                }
            }
            found
        })
    }

    /// The pairs of those with long paths, but for neighbours in a piece.
    fn long_pairs<D: Dim>(
        &self,
        bins: &Bins,
        neighbours: &Neighbours,
        spheres: &Spheres,
    ) -> Vec<Vec<[SphereId; 2]>> {
        let span = self.span();
        let middles = self.loose.iter().map(|long| long.path.at(span.middle));
        let middles: Vec<Row> = middles.collect();
        let long = Bins::new::<D>(&middles, self.reach + 2.0 * self.short);
        // Of two long paths the longer one looks for the other.
        let rank = |long: &Traveller| (long.sweep, long.sphere);
        threads::map(self.loose.chunks(LOOKS), |share| {
            let (mut found, mut near) = (Vec::new(), Vec::new());
            on_widest_lanes!(simd => for own in share {
                let at = own.path.at(span.middle);
                let site = neighbours.site(own.sphere, spheres);
                let reach = self.reach + own.sweep + self.short;
                bins.near::<D, _>(
                    simd,
                    at,
                    reach,
                    #[inline(always)]
                    |first| neighbours.of_eight(simd, site, first),
                    &mut near,
                );
                for &at in &near {
                    let other = &self.binned[at as usize];
                    if own.meets(other, span) && self.is_binned(other) {
                        found.push(pair(own, other));
                    }
                }
                let reach = self.reach + 2.0 * own.sweep;
                long.near::<D, _>(simd, at, reach, |_| 0, &mut near);
                for &at in &near {
                    let other = &self.loose[long.numbers()[at as usize] as usize];
                    let first = rank(other) < rank(own);
                    let is_neighbour = || site.is_neighbour(&neighbours.site(other.sphere, spheres));
                    if first && own.meets(other, span) && !is_neighbour() {
                        found.push(pair(own, other));
                    }
                }
            });
            found
        })
    }

    /// Looks again for the pairs of some, given in ascending order; those of the others stay.
    fn find_again<D: Dim>(&mut self, changed: &[SphereId], spheres: &Spheres, bodies: &Bodies<D>) {
        let count = spheres.list.len();
        self.make_room(count);
        self.loose_at.resize(count, BINNED);
        let mut is_changed: Table<SphereId, bool> = vec![false; count].into();
        for &sphere in changed {
            self.lay(sphere, spheres, bodies);
            is_changed[sphere] = true;
        }
        if changed.len() * (self.loose.len() + changed.len()) > COMPARED * count {
            self.bins = Some(self.bin::<D>(spheres));
            // Where too many are fast, paths have to end sooner.
            if changed.len() * self.loose.len() > COMPARED * count {
                self.find_all(spheres, bodies);
                return;
            }
        } else {
            changed
                .iter()
                .for_each(|&sphere| self.loosen(sphere, spheres));
        }
        let span = self.remaining();
        let bins = self.bins.as_ref().expect("all were looked for before");
        let this = &*self;
        let found = threads::map(changed.chunks(LOOKS), |share| {
            let (mut found, mut near) = (Vec::new(), Vec::new());
            on_widest_lanes!(simd => for &sphere in share {
                let own = &this.traveller(sphere, spheres);
                let is_first = |other: &Traveller| match is_changed[other.sphere] {
                    true => other.sphere > sphere,
                    false => true,
                };
                // In the frame, where the others hardly move.
                let shift = scaled(this.frame, span.middle - this.binned_at);
                let at = minus(own.path.at(span.middle), shift);
                let reach = this.reach + this.short + own.sweep;
                bins.near::<D, _>(simd, at, reach, |_| 0, &mut near);
                for &at in &near {
                    let other = &this.binned[at as usize];
                    let is_other = is_first(other) && this.is_binned(other);
                    if is_other && own.meets(other, span) && !spheres.holds(sphere, other.sphere) {
                        found.push(pair(own, other));
                    }
                }
                for other in &this.loose {
                    let is_met = own.meets(other, span) && is_first(other);
                    if is_met && !spheres.holds(sphere, other.sphere) {
                        found.push(pair(own, other));
                    }
                }
            });
            found
        });
        merge(&mut self.list, &found, &is_changed);
        // `find_strayed` found out about the others.
        self.spare = self.spare.min(self.least_stray);
    }

    /// Takes a sphere out of the bins, for it has another path now.
    fn loosen(&mut self, sphere: SphereId, spheres: &Spheres) {
        let traveller = self.traveller(sphere, spheres);
        let at = &mut self.loose_at[sphere];
        match self.loose.get_mut(*at as usize) {
            Some(own) => *own = traveller,
            None => {
                *at = self.loose.len() as u32;
                self.loose.push(traveller);
            }
        }
    }

    /// From now to the end of all paths.
    fn remaining(&self) -> Span {
        Span {
            middle: 0.5 * (self.elapsed + self.duration),
            half: 0.5 * (self.duration - self.elapsed).max(0.0),
        }
    }

    /// From when all were looked for to the end of all paths.
    fn span(&self) -> Span {
        let half = 0.5 * self.duration;
        Span { middle: half, half }
    }

    /// What all have in common does not count, while none sleeps.
    fn set_frame(&mut self, spheres: &Spheres) {
        self.frame = [0.0; 4];
        if spheres.awake.len() < spheres.list.len() {
            return;
        }
        let sum = { self.paths.iter() }.fold([0.0; 4], |sum, path| plus(sum, path.velocity));
        let mean = scaled(sum, 1.0 / self.paths.len() as f32);
        // What is no velocity is quarantined after the tick.
        if mean.iter().all(|along| along.is_finite()) {
            self.frame = mean;
        }
    }
}

/// Two, ascending.
#[inline(always)]
fn pair(a: &Traveller, b: &Traveller) -> [SphereId; 2] {
    [a.sphere.min(b.sphere), a.sphere.max(b.sphere)]
}

/// How far a sphere may stray from its path [m].
#[inline(always)]
fn most_stray(spheres: &Spheres, sphere: SphereId) -> f32 {
    STRAY * 2.0 * spheres.list[sphere].radius
}

/// What all of these but a few stay below, or are.
fn usual(mut speeds: Vec<f32>) -> f32 {
    if speeds.is_empty() {
        return 0.0;
    }
    let place = speeds.len() - 1 - speeds.len() / LONG_SHARE;
    *speeds.select_nth_unstable_by(place, f32::total_cmp).1
}

#[cfg(test)]
mod tests;
