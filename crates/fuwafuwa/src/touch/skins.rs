//! The skins of all bodies, and which of them may touch each other.
//!
//! The list of pairs is kept for each skin on its own. A skin has an *anchor*, the place where its
//! pairs were found, and may stray from it by the slack; since every other skin keeps to its own
//! anchor as well, no pair can be missed until one of the two has strayed. Only those that have
//! look for their pairs anew [Verlet 1967].

use super::Impulse;
use super::bins::Bins;
use super::captives::Captive;
use super::skin::{Site, Skin, skin_of, skins_of};
use crate::body::Body;
use crate::dim::{Dim, Point};
use crate::solve::Row;
use crate::threads::{self, SHARE};
use crate::vector::{dot, minus, plus, scaled};

/// Contacts are looked for out to this many voxels, so that none comes as a surprise.
pub const MARGIN: f32 = 0.3;
/// How far a skin may stray from its anchor, in voxels: more makes longer lists, less more lists.
const SLACK: f32 = 0.3;
/// The share of its slack that a skin may have used up when others look for new pairs, unless all
/// must look again after the next substep anyway.
const SPARE: f32 = 0.5;

/// Skins whose pairs one thread looks for at a time.
const LOOKS: usize = SHARE / 8;

/// The place of a skin that is no more.
const GONE: u32 = u32::MAX;

/// Two skins that may touch.
#[derive(Copy, Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct SkinPair {
    /// Places among the skins, ascending.
    pub skins: [u32; 2],
    /// What passed between them.
    pub impulse: Impulse,
    /// Whether they met face to face: if one is behind the other now, it was forced there.
    pub met_in_front: bool,
}

/// All skins, and which are close to each other.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Skins {
    /// By body and element.
    pub list: Vec<Skin>,
    sites: Vec<Site>,
    /// Close to each other, ascending.
    pub pairs: Vec<SkinPair>,
    /// Where the middles of the skins are [m]. Those that are in no pair are looked at only when
    /// one of them may have strayed.
    pub centres: Vec<Row>,
    /// Of those in pairs: how far they came in the last substep, squared [m²], and how fast they
    /// would go on if nothing touched them [m/s].
    pub moved: Vec<f32>,
    pub velocities: Vec<Row>,
    /// One over the mass that a push on a skin meets [1/kg].
    pub inverse_mass: Vec<f32>,
    /// Those inside another piece, ascending, and by skin the body and number of that piece.
    pub captives: Vec<Captive>,
    pub(super) captors: Vec<Option<(u32, u32)>>,
    captives_are_good: bool,
    /// Places of those awake, ascending, and of those that are in pairs or captives or exits.
    pub(super) awake: Vec<u32>,
    close: Vec<u32>,
    /// Who is in `close`.
    is_close: Vec<bool>,
    /// Where each was when its pairs were found, as seen from a frame that has come as far as all
    /// skins have on the average, while none sleeps: falling together changes no pair.
    anchors: Vec<Row>,
    frame: Row,
    /// How far anything may still come before one may have strayed, and how far the fastest came in
    /// the last substep [m].
    spare: f32,
    pace: f32,
    is_good: bool,
    rest_is_good: bool,
    /// What was torn since: body and element.
    #[cfg_attr(feature = "serde", serde(skip))]
    torn: Vec<(u32, u32)>,
}

impl Skins {
    /// Elements of a body are gone or new, or have other nodes or other bare faces.
    pub fn tear(&mut self, body: u32, elements: &[u32]) {
        self.torn.extend(elements.iter().map(|&id| (body, id)));
    }

    /// The meshes have changed, nobody knows where.
    pub fn expire(&mut self) {
        self.is_good = false;
    }

    /// Bodies may be anything and anywhere: nothing is carried over but impulses.
    pub fn doubt(&mut self) {
        self.is_good = false;
        self.list.iter_mut().for_each(|skin| skin.nodes = [GONE; 8]);
    }

    /// Somebody woke or fell asleep.
    pub fn expire_rest(&mut self) {
        self.rest_is_good = false;
    }

    /// A new tick: somebody may have been forced into another piece.
    pub fn start_tick(&mut self) {
        self.captives_are_good = false;
    }

    /// Something has moved, nothing further than by `distance` [m].
    pub fn pass(&mut self, distance: f32) {
        self.spare -= distance;
        self.pace = distance;
    }

    /// Follows the bodies: where the skins are now, and which pairs are close; `size` [m] is that
    /// of the largest voxels.
    pub fn follow<D: Dim>(&mut self, bodies: &[Body<D>], size: f32) {
        let is_listed = self.is_good && self.torn.is_empty();
        let is_same = is_listed && self.rest_is_good;
        let mut strayed = Vec::new();
        if !is_listed {
            strayed = self.find(bodies);
        }
        strayed.resize(self.list.len(), false);
        if !is_same {
            for (skin, strayed) in self.list.iter_mut().zip(&mut strayed) {
                let asleep = skin.sleeps(bodies);
                // Nobody looks after how far a sleeper has strayed: it starts with nothing.
                *strayed |= skin.asleep != asleep;
                skin.asleep = asleep;
            }
            self.note_rest(bodies);
        }
        let is_spent = !is_same || self.spare <= 0.0;
        let finds_captives = !self.captives_are_good;
        if is_spent || finds_captives {
            self.move_all(bodies);
        } else {
            self.move_close(bodies);
        }
        if is_spent {
            if self.find_strayed(&mut strayed, size) || !is_same {
                self.find_pairs::<D>(&mut strayed, size);
            }
            (self.is_good, self.rest_is_good) = (true, true);
        }
        if finds_captives {
            self.find_captives(bodies);
            self.captives_are_good = true;
        }
        if is_spent || finds_captives {
            self.note_close();
        }
        for &place in &self.close {
            let skin = &self.list[place as usize];
            let velocity = &bodies[skin.body as usize].velocity;
            self.velocities[place as usize] = skin.mean::<D>(velocity);
        }
    }

    /// The skins of all bodies, ascending, each with its voxel: found anew, or if the others are good
    /// those of what was torn.
    fn listed<D: Dim>(&mut self, bodies: &[Body<D>]) -> Vec<(Skin, Point)> {
        let mut torn = std::mem::take(&mut self.torn);
        if !self.is_good {
            return bodies.iter().enumerate().flat_map(skins_of).collect();
        }
        torn.sort_unstable();
        torn.dedup();
        let mut next = torn.iter().copied().peekable();
        let mut is_torn = |skin: &Skin| {
            let own = (skin.body, skin.element);
            while next.next_if(|&torn| torn < own).is_some() {}
            next.peek() == Some(&own)
        };
        let whole = self.list.iter().zip(&self.sites);
        let whole = whole.filter(|(skin, _)| !is_torn(skin));
        let whole = whole.map(|(skin, site)| (skin.followed(bodies), site.voxel()));
        let mut listed: Vec<(Skin, Point)> = whole.collect();
        let found = |&(body, id): &(u32, u32)| skin_of(body, &bodies[body as usize], id);
        listed.extend(torn.iter().filter_map(found));
        // Two ascending runs.
        listed.sort_by_key(|(skin, _)| skin.key());
        listed
    }

    /// Lists the skins of all bodies anew. Those that were there before keep their anchors and their
    /// pairs; marks the others as strayed.
    fn find<D: Dim>(&mut self, bodies: &[Body<D>]) -> Vec<bool> {
        let listed = self.listed(bodies);
        let old = std::mem::take(&mut self.list);
        let sites = std::mem::take(&mut self.sites);
        let anchors = std::mem::take(&mut self.anchors);
        let centres = std::mem::take(&mut self.centres);
        self.close.clear();
        // Where each of the old ones is now.
        let mut moved_to = vec![GONE; old.len()];
        let mut strayed = Vec::with_capacity(old.len());
        self.list.reserve(listed.len());
        self.sites.reserve(listed.len());
        self.anchors.reserve(listed.len());
        self.centres.reserve(listed.len());
        let mut old = old.iter().enumerate().peekable();
        for (mut skin, voxel) in listed {
            let body = &bodies[skin.body as usize];
            while old.next_if(|(_, old)| old.key() < skin.key()).is_some() {}
            let known = old.next_if(|(_, old)| old.key() == skin.key());
            // Who falls asleep may have been put elsewhere: a quarantined piece is.
            let same =
                known.filter(|(_, old)| old.nodes == skin.nodes && old.asleep == skin.asleep);
            if let Some((before, old)) = known {
                moved_to[before] = self.list.len() as u32;
                skin.asleep = old.asleep;
            }
            let (centre, anchor, site) = match same {
                Some((before, _)) => (centres[before], anchors[before], sites[before]),
                None => {
                    let centre = skin.mean::<D>(&body.position);
                    let site = Site::new(skin.body, voxel, &body.sharing);
                    (centre, minus(centre, self.frame), site)
                }
            };
            strayed.push(same.is_none());
            self.centres.push(centre);
            self.anchors.push(anchor);
            self.sites.push(site);
            self.list.push(skin);
        }
        self.is_close.clear();
        self.is_close.resize(self.list.len(), false);
        self.pairs.retain_mut(|pair| {
            pair.skins = pair.skins.map(|skin| moved_to[skin as usize]);
            !pair.skins.contains(&GONE)
        });
        self.captors.clear();
        self.captors.resize(self.list.len(), None);
        self.captives.retain_mut(|captive| {
            for skin in [&mut captive.skin, &mut captive.exit] {
                *skin = moved_to[*skin as usize];
            }
            let stays = captive.skin != GONE && captive.exit != GONE;
            // Where the exit went with a part that came off, the rest is a stranger until the next tick.
            if stays {
                let exit = &self.list[captive.exit as usize];
                self.captors[captive.skin as usize] = Some((exit.body, exit.piece));
            }
            stays
        });
        strayed
    }

    /// Notes who is awake, and what a push meets.
    fn note_rest<D: Dim>(&mut self, bodies: &[Body<D>]) {
        let places = 0..self.list.len() as u32;
        let list = &self.list;
        self.awake.clear();
        self.awake
            .extend(places.filter(|&place| !list[place as usize].asleep));
        self.close.retain(|&place| !list[place as usize].asleep);
        self.velocities.clear();
        self.velocities.resize(list.len(), [0.0; 4]);
        self.moved.clear();
        self.moved.resize(list.len(), 0.0);
        self.inverse_mass.clear();
        self.inverse_mass
            .extend(list.iter().map(|skin| skin.inverse_mass(bodies)));
    }

    /// Moves those that are in pairs along with the bodies.
    fn move_close<D: Dim>(&mut self, bodies: &[Body<D>]) {
        for at in 0..self.close.len() {
            let place = self.close[at] as usize;
            let skin = &self.list[place];
            let centre = skin.mean::<D>(&bodies[skin.body as usize].position);
            self.note_move(place, centre);
        }
    }

    fn note_move(&mut self, place: usize, centre: Row) {
        let moved = minus(centre, self.centres[place]);
        self.moved[place] = dot(moved, moved);
        self.centres[place] = centre;
    }

    /// Moves all skins along with the bodies.
    fn move_all<D: Dim>(&mut self, bodies: &[Body<D>]) {
        let mut sum = [0.0; 4];
        for at in 0..self.awake.len() {
            let place = self.awake[at] as usize;
            let skin = &self.list[place];
            let centre = skin.mean::<D>(&bodies[skin.body as usize].position);
            sum = plus(sum, minus(centre, self.anchors[place]));
            if self.is_close[place] {
                self.note_move(place, centre);
            } else {
                self.centres[place] = centre;
            }
        }
        if self.awake.len() == self.list.len() && !self.awake.is_empty() {
            let frame = scaled(sum, 1.0 / self.awake.len() as f32);
            // What is no place is quarantined after the tick, but nothing would bring the frame back.
            if frame.iter().all(|along| along.is_finite()) {
                self.frame = frame;
            }
        }
    }

    /// Where any have strayed too far, marks them and those that soon will have; returns whether any
    /// are marked. Notes what the others have to spare.
    fn find_strayed(&mut self, strayed: &mut [bool], size: f32) -> bool {
        let strays = self.awake.iter().map(|&place| {
            let place = place as usize;
            let moved = minus(minus(self.centres[place], self.anchors[place]), self.frame);
            dot(moved, moved)
        });
        let furthest = strays.clone().fold(0.0, f32::max);
        let slack = SLACK * size;
        if furthest <= slack * slack {
            self.spare = slack - furthest.sqrt();
            return strayed.contains(&true);
        }
        let kept = (1.0 - SPARE) * slack;
        let spare = if self.pace < kept { kept } else { 0.0 };
        let bearable = slack - spare;
        for (&place, stray) in self.awake.iter().zip(strays) {
            strayed[place as usize] |= stray > bearable * bearable;
        }
        self.spare = spare;
        true
    }

    /// Anchors the strayed where they are and finds their pairs; those of the others stay.
    fn find_pairs<D: Dim>(&mut self, strayed: &mut [bool], size: f32) {
        let count = strayed.iter().filter(|strayed| **strayed).count();
        // It is quicker to look for all pairs than for those of each of many.
        let all = 2 * count > strayed.len();
        if all {
            strayed.fill(true);
        }
        let places = || (0..strayed.len()).filter(|&place| strayed[place]);
        for place in places() {
            self.anchors[place] = minus(self.centres[place], self.frame);
        }
        let reach = (1.0 + MARGIN + 2.0 * SLACK) * size;
        let bins = Bins::new::<D>(&self.anchors, reach);
        let found = if all {
            threads::map(bins.shares(), |share| {
                let mut found = Vec::new();
                bins.pairs::<D>(share, reach, |a, b| self.meet(a, b, &mut found));
                found
            })
        } else {
            let places: Vec<u32> = places().map(|place| place as u32).collect();
            threads::map(places.chunks(LOOKS), |places| {
                let mut found = Vec::new();
                for &place in places {
                    bins.near::<D>(self.anchors[place as usize], reach, |other| {
                        if !strayed[other as usize] || other > place {
                            self.meet(place, other, &mut found);
                        }
                    });
                }
                found
            })
        };
        self.merge(&found, strayed);
    }

    /// Adds two skins that are close to each other to those found, if they may touch.
    #[inline(always)]
    fn meet(&self, a: u32, b: u32, found: &mut Vec<[u32; 2]>) {
        let [first, second] = [a, b].map(|skin| &self.sites[skin as usize]);
        let sleeps = |skin: u32| self.list[skin as usize].asleep;
        if !(first.is_bound_to(second) || sleeps(a) && sleeps(b)) {
            found.push([a.min(b), a.max(b)]);
        }
    }

    /// Notes which skins matter to contact in the next substeps.
    fn note_close(&mut self) {
        self.is_close.fill(false);
        let pairs = self.pairs.iter().flat_map(|pair| pair.skins);
        let captives = self.captives.iter();
        let captives = captives.flat_map(|captive| [captive.skin, captive.exit]);
        for place in pairs.chain(captives) {
            self.is_close[place as usize] = true;
        }
        let is_close = |place: &u32| self.is_close[*place as usize];
        self.close.clear();
        self.close
            .extend(self.awake.iter().copied().filter(is_close));
    }

    /// Makes the new list of pairs from those just found and the old ones of which neither has
    /// strayed. Pairs that were known keep their impulses.
    fn merge(&mut self, found: &[Vec<[u32; 2]>], strayed: &[bool]) {
        let list = &self.list;
        let stays = |pair: &SkinPair| {
            let [a, b] = pair.skins.map(|skin| skin as usize);
            !(strayed[a] || strayed[b] || list[a].asleep && list[b].asleep)
        };
        let mut found = by_first(found, list.len());
        let merged = threads::map(shares(&mut found, &self.pairs), |(found, old)| {
            for same in found.chunk_by_mut(|a, b| a[0] == b[0]) {
                same.sort_unstable();
            }
            let mut pairs = Vec::with_capacity(old.len().max(found.len()));
            let mut old = old.iter().peekable();
            for &mut skins in found {
                while let Some(pair) = old.next_if(|pair| pair.skins < skins) {
                    if stays(pair) {
                        pairs.push(*pair);
                    }
                }
                let known = old.next_if(|pair| pair.skins == skins);
                pairs.push(SkinPair {
                    skins,
                    impulse: known.map_or(Impulse::default(), |pair| pair.impulse),
                    met_in_front: known.is_some_and(|pair| pair.met_in_front),
                });
            }
            pairs.extend(old.filter(|pair| stays(pair)));
            pairs
        });
        self.pairs = merged.concat();
    }
}

/// Both lists of pairs, which ascend by their first skins, cut at the same skins.
fn shares<'a>(
    mut found: &'a mut [[u32; 2]],
    mut old: &'a [SkinPair],
) -> impl Iterator<Item = (&'a mut [[u32; 2]], &'a [SkinPair])> {
    let mut is_done = false;
    std::iter::from_fn(move || {
        if is_done {
            return None;
        }
        let next = found.get(SHARE).map(|pair| pair[0] + 1);
        is_done = next.is_none();
        let next = next.unwrap_or(u32::MAX);
        let end = found.partition_point(|pair| pair[0] < next);
        let own;
        (own, found) = std::mem::take(&mut found).split_at_mut(end);
        let end = old.partition_point(|pair| pair.skins[0] < next);
        let known;
        (known, old) = old.split_at(end);
        Some((own, known))
    })
}

impl SkinPair {
    /// Its skins among all of them.
    pub fn both<'a>(&self, skins: &'a [Skin]) -> [&'a Skin; 2] {
        self.skins.map(|skin| &skins[skin as usize])
    }
}

/// Pairs of numbers below `count`, ascending by the first.
fn by_first(pairs: &[Vec<[u32; 2]>], count: usize) -> Vec<[u32; 2]> {
    let mut end = vec![0u32; count];
    for pair in pairs.iter().flatten() {
        end[pair[0] as usize] += 1;
    }
    let mut sum = 0;
    for end in &mut end {
        sum += std::mem::replace(end, sum);
    }
    let mut sorted = vec![[0; 2]; sum as usize];
    for pair in pairs.iter().flatten() {
        let place = &mut end[pair[0] as usize];
        sorted[*place as usize] = *pair;
        *place += 1;
    }
    sorted
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dim::{Dim2, Dim3};
    use crate::grid::VoxelGrid;
    use crate::material::Material;

    /// Crumbs fly about, fall asleep and wake; the list of pairs against all that there are.
    fn check<D: Dim>(n: usize) {
        let grid = VoxelGrid::<D>::ball(n, 1.0).unwrap();
        let mut body = Body::new(grid, &[Material::default()]).unwrap();
        body.crumble().unwrap();
        let (size, pieces) = (body.grid.voxel_size(), body.pieces.list.len());
        let mut seed = 7u32;
        let mut random = || {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (seed >> 8) as f32 / (1 << 24) as f32 - 0.5
        };
        let fall = [0.0, 0.3 * size, 0.0, 0.0];
        let mut steps = vec![[0.0; 4]; pieces];
        for step in &mut steps {
            (0..D::N).for_each(|axis| step[axis] = 0.2 * size * random());
        }
        let mut skins = Skins::default();
        let mut changes = 0;
        for round in 0..60 {
            if round % 10 == 9 {
                let marked: Vec<bool> = (0..pieces).map(|_| random() > 0.2).collect();
                body.set_asleep(&marked, round % 20 == 9);
                skins.expire_rest();
            }
            for node in 0..body.position.len() {
                let piece = body.pieces.of_node(node as u32);
                if !body.pieces.list[piece as usize].asleep {
                    let step = minus(steps[piece as usize], fall);
                    body.position[node] = plus(body.position[node], step);
                }
            }
            let before = skins.pairs.len();
            skins.pass(0.5 * size);
            skins.follow(std::slice::from_ref(&body), size);
            changes += usize::from(before != skins.pairs.len());
            assert!(skins.pairs.is_sorted_by(|a, b| a.skins < b.skins));
            for (b, second) in skins.list.iter().enumerate() {
                for (a, first) in skins.list[..b].iter().enumerate() {
                    let apart = minus(skins.centres[a], skins.centres[b]);
                    let is_close =
                        dot(apart, apart) < (1.0 + MARGIN) * size * (1.0 + MARGIN) * size;
                    let key = [a as u32, b as u32];
                    let found = skins.pairs.binary_search_by(|pair| pair.skins.cmp(&key));
                    let both_sleep = first.asleep && second.asleep;
                    assert!(found.is_ok() || !is_close || both_sleep, "round {round}");
                    assert!(found.is_err() || !both_sleep, "round {round}");
                }
            }
        }
        assert!(
            changes > 10,
            "{changes} new lists: they must have been needed"
        );
    }

    /// A body is torn at random; who is bound to whom against the nodes they have.
    fn check_bound<D: Dim>(n: usize) {
        let grid = VoxelGrid::<D>::ball(n, 1.0).unwrap();
        let mut body = Body::new(grid, &[Material::default()]).unwrap();
        let size = body.grid.voxel_size();
        let mut seed = 5u32;
        let mut random = |below: usize| {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (seed >> 8) as usize % below
        };
        let mut skins = Skins::default();
        for _ in 0..60 {
            skins.follow(std::slice::from_ref(&body), size);
            let anew = skins_of((0, &body)).map(|(skin, _)| skin);
            assert_eq!(skins.list, anew.collect::<Vec<_>>());
            for b in 0..skins.list.len() {
                for a in 0..b {
                    let [own, other] = [a, b].map(|skin| &skins.list[skin].nodes[..D::CORNERS]);
                    let shares = own.iter().any(|node| other.contains(node));
                    assert_eq!(skins.sites[a].is_bound_to(&skins.sites[b]), shares);
                }
            }
            let count = 1 + random(12);
            let sides = (0..count).map(|_| {
                let mut at = [0; 3];
                (0..D::N).for_each(|axis| at[axis] = random(n + 1) as i32);
                (at, 1 + random((1 << D::CORNERS) - 2) as u8)
            });
            let torn = body.tear(&sides.collect::<Vec<_>>()).unwrap();
            skins.tear(0, &torn.elements);
        }
        assert!(body.pieces.list.len() > 10);
    }

    #[test]
    fn skins_and_their_neighbours_are_known_after_every_tear() {
        check_bound::<Dim2>(14);
        check_bound::<Dim3>(8);
    }

    /// Crumbs come along, and the frame with them, but for one that falls asleep; then another one
    /// goes to it.
    #[test]
    fn who_falls_asleep_is_met() {
        let grid = VoxelGrid::<Dim2>::ball(14, 1.0).unwrap();
        let mut body = Body::new(grid, &[Material::default()]).unwrap();
        body.crumble().unwrap();
        let size = body.grid.voxel_size();
        let mut skins = Skins::default();
        skins.follow(std::slice::from_ref(&body), size);
        let all = skins.list.clone();
        // Moves skins along the first axis, each as far as a rule says [voxels].
        let shift = |body: &mut Body<Dim2>, way: &dyn Fn(usize) -> f32| {
            for (place, skin) in all.iter().enumerate() {
                for &node in &skin.nodes[..Dim2::CORNERS] {
                    body.position[node as usize][0] += way(place) * size;
                }
            }
        };
        // Just out of reach of each other, the rest far away.
        let before = skins.centres.clone();
        shift(&mut body, &|place| {
            let goal = if place == 1 {
                1.95
            } else {
                10.0 * place as f32
            };
            goal - before[place][0] / size
        });
        for distance in [1000.0 * size, 0.0] {
            skins.pass(distance);
            skins.follow(std::slice::from_ref(&body), size);
        }
        assert!(skins.pairs.is_empty());
        shift(&mut body, &|place| if place == 0 { 0.29 } else { -0.29 });
        skins.pass(0.29 * size);
        skins.start_tick();
        skins.follow(std::slice::from_ref(&body), size);
        let pieces = 0..body.pieces.list.len() as u32;
        let marked: Vec<bool> = pieces.map(|piece| piece == all[0].piece).collect();
        body.set_asleep(&marked, true);
        skins.expire_rest();
        skins.follow(std::slice::from_ref(&body), size);
        shift(&mut body, &|place| if place == 1 { -0.29 } else { 0.0 });
        skins.pass(0.29 * size);
        skins.follow(std::slice::from_ref(&body), size);
        let pairs: Vec<[u32; 2]> = skins.pairs.iter().map(|pair| pair.skins).collect();
        assert_eq!(pairs, [[0, 1]]);
    }

    #[test]
    fn no_pair_is_missed() {
        check::<Dim2>(14);
        check::<Dim3>(6);
    }
}
