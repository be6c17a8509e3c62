//! Pairs of contact spheres that may touch.
//!
//! Spheres are searched along their predicted motion: a straight *path*, from which a sphere may deviate by a
//! slack. At higher speeds, the paths are valid for a shorter time. The pairs of a sphere are searched again
//! only if the sphere exceeds its slack, wakes, falls asleep, or changes in a tear. Therefore no pair is
//! missed at any finite speed. A full search skips neighbours within a piece; pairs of spheres on opposite
//! crack faces are listed separately.
//!
//! ```text
//!    ●──────────┤        two paths make a pair if their spheres, enlarged by their slack,
//!      ╲                 come close enough at the same time
//!    ●──╲───────┤
//! ```

use super::bins::Bins;
use super::contact_sphere::{ContactSphere, SphereId};
use super::contact_spheres::{Followed, Spheres};
use super::piece_neighbours::Neighbours;
use super::slack::{SlackTest, smaller};
use super::sphere_pair::{SpherePair, merge};
use super::swept_path::{Path, SLACK, Span, Start, SweptSphere, widened};
use crate::foundation::dim::Dim;
use crate::foundation::hash::{Hash, HashState, hash_all};
use crate::foundation::ids::IndexVec;
use crate::foundation::threads::{self, CHUNK_SIZE, SEARCHES_PER_CHUNK};
use crate::math::lanes::on_widest_lanes;
use crate::soft_body::SoftBodies;
use crate::soft_body::element_forces::Row;

/// Divisor: at most 1 / `LONG_SHARE` of the spheres may have long paths. If more spheres are fast, the
/// duration of all paths is shortened. Pairs of short paths are found bin by bin, while the surroundings of
/// each long path are searched separately.
const LONG_SHARE: usize = 32;
/// Maximum for half the length of a short path, as a share of the search distance.
const MAX_SHORT_SWEEP: f32 = 0.125;
/// Maximum duration of the paths [s]. In this time, gravity takes a falling sphere 5 cm off its path.
const MAX_PATH_TIME: f32 = 0.1;
/// A full search is faster than separate searches if more than 1 / `MANY` of the awake spheres must be
/// searched.
const MANY: usize = 4;
/// Number of comparisons of two spheres that take as long as sorting one sphere into the bins.
const COMPARED: usize = 12;

/// Entry in `loose_at` of a sphere that is found through the bins, and so has no index among the loose
/// spheres.
const BINNED: u32 = u32::MAX;

/// Pairs of spheres that may touch before their paths end.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct SpherePairs {
    /// Pairs, ascending. Only pairs with an impulse or with `met_in_front` are part of the hashed state:
    /// which other pairs are listed depends on the last search.
    #[cfg_attr(feature = "serde", serde(serialize_with = "serialize_known"))]
    pub list: Vec<SpherePair>,
    #[cfg_attr(feature = "serde", serde(skip))]
    paths: IndexVec<SphereId, Path>,
    /// Starting points of the paths.
    #[cfg_attr(feature = "serde", serde(skip))]
    starts: IndexVec<SphereId, Start>,
    /// Bins of the midpoints of all paths; `None` if a full search is due.
    #[cfg_attr(feature = "serde", serde(skip))]
    bins: Option<Bins>,
    /// Time of the midpoints of the paths in the bins, counted from the last full search [s].
    #[cfg_attr(feature = "serde", serde(skip))]
    binned_at: f32,
    /// Swept spheres, in the order of the points in `bins`.
    #[cfg_attr(feature = "serde", serde(skip))]
    binned: Vec<SweptSphere>,
    /// Mean velocity of all spheres [m/s], or 0 if any sphere sleeps. Lengths of paths are measured relative
    /// to this velocity.
    #[cfg_attr(feature = "serde", serde(skip))]
    frame: Row,
    /// Half the length of the longest short path [m].
    #[cfg_attr(feature = "serde", serde(skip))]
    max_short_sweep: f32,
    /// Spheres that are not found through the bins: those with long paths, or with paths newer than the bins.
    #[cfg_attr(feature = "serde", serde(skip))]
    loose: Vec<SweptSphere>,
    /// Index of each sphere in `loose`, or [`BINNED`].
    #[cfg_attr(feature = "serde", serde(skip))]
    loose_at: IndexVec<SphereId, u32>,
    /// Whether a tick has begun since the last update.
    #[cfg_attr(feature = "serde", serde(skip))]
    is_new_tick: bool,
    /// Spheres to search again, in addition to those that exceed their slack.
    #[cfg_attr(feature = "serde", serde(skip))]
    pub changed: Vec<SphereId>,
    /// Time since the last full search [s].
    #[cfg_attr(feature = "serde", serde(skip))]
    elapsed: f32,
    /// Duration of the substep [s]: paths last as long at least, so that no fast sphere outruns its path.
    #[cfg_attr(feature = "serde", serde(skip))]
    substep: f32,
    /// Time from the last full search to the end of all paths [s].
    #[cfg_attr(feature = "serde", serde(skip))]
    duration: f32,
    /// Distance between the centres below which two of the largest spheres make a pair [m].
    #[cfg_attr(feature = "serde", serde(skip))]
    reach: f32,
    /// Slack of the smallest spheres [m].
    #[cfg_attr(feature = "serde", serde(skip))]
    min_slack: f32,
    /// Distance that every sphere can still deviate from its path without exceeding its slack [m].
    #[cfg_attr(feature = "serde", serde(skip))]
    spare: f32,
    /// Highest speed along any path [m/s].
    #[cfg_attr(feature = "serde", serde(skip))]
    max_speed: f32,
}

impl HashState for SpherePairs {
    fn hash_state(&self, hash: &mut Hash) {
        let Self {
            list,
            paths: _,
            starts: _,
            bins: _,
            binned_at: _,
            binned: _,
            frame: _,
            max_short_sweep: _,
            loose: _,
            loose_at: _,
            is_new_tick: _,
            changed: _,
            elapsed: _,
            substep: _,
            duration: _,
            reach: _,
            min_slack: _,
            spare: _,
            max_speed: _,
        } = self;
        hash_all(list.iter().filter(|pair| pair.is_known()), hash);
    }
}

#[cfg(feature = "serde")]
fn serialize_known<S: serde::Serializer>(list: &[SpherePair], to: S) -> Result<S::Ok, S::Error> {
    let known = list.iter().filter(|pair| pair.is_known());
    serde::Serialize::serialize(&known.collect::<Vec<_>>(), to)
}

impl SpherePairs {
    /// Starts a tick: clears the impulse sums of the last tick. Requests a full search if the list of spheres
    /// was rebuilt.
    pub fn start_tick(&mut self, is_listed_anew: bool) {
        if is_listed_anew {
            self.bins = None;
            self.starts.clear();
        }
        self.is_new_tick = true;
        for pair in &mut self.list {
            pair.impulse.start_tick();
        }
    }

    /// Advances the time by a substep of `duration` [s], and subtracts from `spare` the largest possible
    /// deviation from a path in this substep. No node moved farther than `distance` [m] in the substep.
    pub fn pass(&mut self, duration: f32, distance: f32) {
        self.elapsed += duration;
        self.spare -= distance + self.max_speed * duration;
    }

    /// Updates the spheres and the list of pairs for a substep of `substep` [s]. Returns whether the list changed
    /// or a new tick began.
    pub fn follow<D: Dim>(
        &mut self,
        spheres: &mut Spheres,
        bodies: &SoftBodies<D>,
        substep: f32,
    ) -> bool {
        self.substep = substep;
        let is_new_tick = std::mem::take(&mut self.is_new_tick);
        if spheres.awake.is_empty() {
            self.list.clear();
            self.bins = None;
            return is_new_tick;
        }
        if self.bins.is_none() || self.elapsed >= self.duration {
            spheres.follow(Followed::Awake, bodies, substep);
            self.find_all(spheres, bodies);
            return true;
        }
        if self.spare > 0.0 && self.changed.is_empty() && !is_new_tick {
            spheres.follow(Followed::Close, bodies, substep);
        } else {
            spheres.follow(Followed::Awake, bodies, substep);
            self.find_beyond_slack(spheres);
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

    /// Adds spheres that have exceeded their slack to `changed`, and updates `spare` for the other spheres.
    fn find_beyond_slack(&mut self, spheres: &Spheres) {
        let (paths, elapsed) = (&self.paths, self.elapsed);
        let tests = threads::map(spheres.awake.chunks(CHUNK_SIZE), |share| {
            SlackTest::of_points(share, |sphere: SphereId| {
                let path = paths.get(sphere.index())?;
                let deviation = spheres.centres[sphere] - path.at(elapsed);
                Some((deviation, slack_of(spheres, sphere)))
            })
        });
        self.spare = f32::INFINITY;
        for test in tests {
            self.changed.extend(test.exceeded);
            self.spare = smaller(self.spare, test.spare);
        }
    }

    /// Resizes the tables for `count` spheres.
    fn make_room(&mut self, count: usize) {
        self.paths.resize(count, Path::default());
        self.starts.resize(count, Start::UNKNOWN);
    }

    /// Starts a new path of a sphere at its present position.
    fn start_path<D: Dim>(&mut self, sphere: SphereId, spheres: &Spheres, bodies: &SoftBodies<D>) {
        let now = spheres.centres[sphere];
        let start = &mut self.starts[sphere];
        let (mut velocity, mut laid) = (Row::ZERO, Start::UNKNOWN);
        if !spheres.list[sphere].asleep {
            velocity = start.expected(now, self.elapsed, spheres.velocity(sphere, bodies));
            laid = Start {
                at: now,
                time: self.elapsed,
            };
        }
        *start = laid;
        let from = now - velocity * self.elapsed;
        self.paths[sphere] = Path { from, velocity };
        let speed = velocity.length();
        self.max_speed = if speed > self.max_speed {
            speed
        } else {
            self.max_speed
        };
    }

    /// Returns the swept sphere of a sphere: the sphere with its path.
    fn swept_sphere(&self, sphere: SphereId, spheres: &Spheres) -> SweptSphere {
        let ContactSphere { radius, asleep, .. } = spheres.list[sphere];
        SweptSphere {
            path: self.paths[sphere],
            sweep: self.speed(sphere) * self.span().half,
            radius,
            sphere,
            asleep,
        }
    }

    /// Starts a new path for each sphere and searches all pairs.
    fn find_all<D: Dim>(&mut self, spheres: &Spheres, bodies: &SoftBodies<D>) {
        let count = spheres.list.len();
        self.changed.clear();
        self.make_room(count);
        self.starts
            .iter_mut()
            .for_each(|start| start.time -= self.elapsed);
        (self.elapsed, self.max_speed) = (0.0, 0.0);
        let all = spheres.list.ids();
        all.for_each(|sphere| self.start_path(sphere, spheres, bodies));
        self.measure(spheres);
        let bins = self.bin::<D>(spheres);
        let neighbours = Neighbours::of(&self.binned, spheres, bodies);
        let mut found = self.short_pairs::<D>(&bins, &neighbours);
        found.extend(self.long_pairs::<D>(&bins, &neighbours, spheres));
        found.extend(self.crack_face_pairs(spheres));
        self.bins = Some(bins);
        merge(&mut self.list, &found, &vec![true; count].into());
    }

    /// Sorts all spheres into bins, by the midpoint of the remaining path.
    fn bin<D: Dim>(&mut self, spheres: &Spheres) -> Bins {
        self.binned_at = self.remaining().middle;
        let middles = self.paths.iter().map(|path| path.at(self.binned_at));
        let middles: Vec<Row> = middles.collect();
        let bins = Bins::new::<D>(&middles, self.reach + 2.0 * self.max_short_sweep);
        let numbers = bins.numbers().iter().copied().map(SphereId);
        let binned = numbers.map(|sphere| self.swept_sphere(sphere, spheres));
        self.binned = binned.collect();
        self.loose.clear();
        self.loose_at.clear();
        self.loose_at.resize(middles.len(), BINNED);
        for swept in &self.binned {
            if swept.sweep > self.max_short_sweep {
                self.loose_at[swept.sphere] = self.loose.len() as u32;
                self.loose.push(*swept);
            }
        }
        bins
    }

    /// Computes the search distance, the slack, the duration of all paths, and the maximum length of a short
    /// path.
    fn measure(&mut self, spheres: &Spheres) {
        let radii = spheres.list.iter().map(|sphere| sphere.radius);
        let (smallest, largest) = radii.fold((f32::MAX, 0.0f32), |(low, high), radius| {
            (low.min(radius), high.max(radius))
        });
        self.min_slack = 2.0 * SLACK * smallest;
        self.spare = self.min_slack;
        self.reach = widened(2.0 * largest);
        self.set_frame(spheres);
        let speeds = { spheres.awake.iter() }.map(|&sphere| self.speed(sphere));
        let usual_speed = usual(speeds.filter(|speed| speed.is_finite()).collect());
        let longest = MAX_SHORT_SWEEP * self.reach;
        self.duration = match usual_speed * MAX_PATH_TIME > 2.0 * longest {
            true => 2.0 * longest / usual_speed,
            false => MAX_PATH_TIME,
        };
        self.duration = self.duration.max(self.substep);
        self.max_short_sweep = usual_speed * self.span().half;
    }

    /// Returns the speed of a sphere's path relative to `frame` [m/s], the mean velocity of all spheres.
    fn speed(&self, sphere: SphereId) -> f32 {
        (self.paths[sphere].velocity - self.frame).length()
    }

    /// Returns whether a sphere is found through the bins: its path is short and has not changed since the bins
    /// were built.
    #[inline(always)]
    fn is_binned(&self, swept: &SweptSphere) -> bool {
        self.loose_at[swept.sphere] == BINNED
    }

    /// Returns the pairs of spheres that both have short paths, except neighbours in a piece.
    fn short_pairs<D: Dim>(&self, bins: &Bins, neighbours: &Neighbours) -> Vec<Vec<[SphereId; 2]>> {
        let (span, reach) = (self.span(), self.reach + 2.0 * self.max_short_sweep);
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

    /// Returns the pairs of spheres on opposite crack faces that come close.
    fn crack_face_pairs(&self, spheres: &Spheres) -> Vec<Vec<[SphereId; 2]>> {
        // Index of each sphere in bin order.
        let mut order: IndexVec<SphereId, u32> = vec![0; self.binned.len()].into();
        for (swept, at) in self.binned.iter().zip(0..) {
            order[swept.sphere] = at;
        }
        let span = self.span();
        threads::map(spheres.crack_face_pairs.chunks(CHUNK_SIZE), |share| {
            let mut found = Vec::new();
            for &faces in share {
                let [a, b] = faces.map(|sphere| &self.binned[order[sphere] as usize]);
                if a.meets(b, span) {
                    found.push(pair(a, b));
                }
            }
            found
        })
    }

    /// Returns the pairs in which at least one sphere has a long path, except neighbours in a piece.
    fn long_pairs<D: Dim>(
        &self,
        bins: &Bins,
        neighbours: &Neighbours,
        spheres: &Spheres,
    ) -> Vec<Vec<[SphereId; 2]>> {
        let span = self.span();
        let middles = self.loose.iter().map(|long| long.path.at(span.middle));
        let middles: Vec<Row> = middles.collect();
        let long = Bins::new::<D>(&middles, self.reach + 2.0 * self.max_short_sweep);
        // Of two long paths, only the longer one searches the other, so that each pair is found once.
        let rank = |long: &SweptSphere| (long.sweep, long.sphere);
        threads::map(self.loose.chunks(SEARCHES_PER_CHUNK), |share| {
            let (mut found, mut near) = (Vec::new(), Vec::new());
            on_widest_lanes!(simd => for own in share {
                let at = own.path.at(span.middle);
                let site = neighbours.site(own.sphere, spheres);
                let reach = self.reach + own.sweep + self.max_short_sweep;
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

    /// Searches again the pairs of the spheres `changed`, given in ascending order. Pairs of two unchanged
    /// spheres stay.
    fn find_again<D: Dim>(
        &mut self,
        changed: &[SphereId],
        spheres: &Spheres,
        bodies: &SoftBodies<D>,
    ) {
        let count = spheres.list.len();
        self.make_room(count);
        self.loose_at.resize(count, BINNED);
        let mut is_changed: IndexVec<SphereId, bool> = vec![false; count].into();
        for &sphere in changed {
            self.start_path(sphere, spheres, bodies);
            is_changed[sphere] = true;
        }
        if changed.len() * (self.loose.len() + changed.len()) > COMPARED * count {
            self.bins = Some(self.bin::<D>(spheres));
            // If too many spheres are still loose after the new sort into bins, they are fast. A full search
            // then shortens all paths.
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
        let bins = self
            .bins
            .as_ref()
            .expect("a full search has built the bins");
        let this = &*self;
        let found = threads::map(changed.chunks(SEARCHES_PER_CHUNK), |share| {
            let (mut found, mut near) = (Vec::new(), Vec::new());
            on_widest_lanes!(simd => for &sphere in share {
                let own = &this.swept_sphere(sphere, spheres);
                let is_first = |other: &SweptSphere| match is_changed[other.sphere] {
                    true => other.sphere > sphere,
                    false => true,
                };
                // The bins are older than this search, and their spheres have since moved by about the motion
                // of `frame`. Shifts the search position back by this motion.
                let shift = this.frame * (span.middle - this.binned_at);
                let at = own.path.at(span.middle) - shift;
                let reach = this.reach + this.max_short_sweep + own.sweep;
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
        // New paths begin with their full slack; `find_beyond_slack` has computed `spare` for the old paths.
        self.spare = self.spare.min(self.min_slack);
    }

    /// Moves a sphere with a new path from the bins to the loose spheres.
    fn loosen(&mut self, sphere: SphereId, spheres: &Spheres) {
        let swept = self.swept_sphere(sphere, spheres);
        let at = &mut self.loose_at[sphere];
        match self.loose.get_mut(*at as usize) {
            Some(own) => *own = swept,
            None => {
                *at = self.loose.len() as u32;
                self.loose.push(swept);
            }
        }
    }

    /// Returns the time from now to the end of the paths.
    fn remaining(&self) -> Span {
        Span {
            middle: 0.5 * (self.elapsed + self.duration),
            half: 0.5 * (self.duration - self.elapsed).max(0.0),
        }
    }

    /// Returns the time from the last full search to the end of the paths.
    fn span(&self) -> Span {
        let half = 0.5 * self.duration;
        Span { middle: half, half }
    }

    /// Sets `frame` to the mean velocity of all spheres, or to 0 if any sphere sleeps and so rests in the
    /// world.
    fn set_frame(&mut self, spheres: &Spheres) {
        self.frame = Row::ZERO;
        if spheres.awake.len() < spheres.list.len() {
            return;
        }
        let sum = self.paths.iter().map(|path| path.velocity).sum::<Row>();
        let mean = sum * (1.0 / self.paths.len() as f32);
        // If a velocity is not finite, `frame` stays 0 until the piece is quarantined after the tick.
        if mean.is_finite() {
            self.frame = mean;
        }
    }
}

/// Returns the ids of two spheres in ascending order.
#[inline(always)]
fn pair(a: &SweptSphere, b: &SweptSphere) -> [SphereId; 2] {
    [a.sphere.min(b.sphere), a.sphere.max(b.sphere)]
}

/// Returns the slack of a sphere [m].
#[inline(always)]
fn slack_of(spheres: &Spheres, sphere: SphereId) -> f32 {
    SLACK * 2.0 * spheres.list[sphere].radius
}

/// Returns the speed that at most a share of 1 / `LONG_SHARE` of the spheres exceeds.
fn usual(mut speeds: Vec<f32>) -> f32 {
    if speeds.is_empty() {
        return 0.0;
    }
    let place = speeds.len() - 1 - speeds.len() / LONG_SHARE;
    *speeds.select_nth_unstable_by(place, f32::total_cmp).1
}

#[cfg(test)]
mod tests;
