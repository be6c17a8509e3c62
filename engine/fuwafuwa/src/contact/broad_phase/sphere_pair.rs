//! Pairs of contact spheres that may touch, and operations on their lists.

use super::contact_sphere::{ContactSphere, SphereId};
use super::known_impulse::Impulse;
use crate::foundation::hash::hash_state;
use crate::foundation::ids::IndexVec;
use crate::foundation::threads::{self, CHUNK_SIZE};

/// Search margin of contacts [voxels]: pairs are listed if their gap may become smaller than this. A contact
/// becomes active before its sides touch if the gap shrinks by at most (MARGIN − CLOSE) / AHEAD = 1/6 voxel
/// in a substep. This speed is a quarter of the wave speed. Faster spheres overlap first and are then pushed
/// out.
pub const MARGIN: f32 = 0.3;

/// Pair of spheres that may touch.
#[derive(Copy, Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct SpherePair {
    /// Spheres in ascending order.
    pub spheres: [SphereId; 2],
    /// Impulses of the contact.
    pub impulse: Impulse,
    /// Whether the spheres touched while neither was behind the surface of the other. If so, and one sphere
    /// is behind the other's surface now, it was forced there and is pushed back out.
    pub met_in_front: bool,
}

hash_state! { struct SpherePair { spheres, impulse, met_in_front } }

/// Replaces `list` by the `found` pairs and some old pairs: those of two unchanged spheres, and those that
/// touched in this tick, because the events of the tick report them. Pairs that were listed before keep their
/// impulses.
pub fn merge(
    list: &mut Vec<SpherePair>,
    found: &[Vec<[SphereId; 2]>],
    is_changed: &IndexVec<SphereId, bool>,
) {
    let stays = |pair: &SpherePair| {
        let mut both = pair.spheres.iter();
        pair.impulse.total > 0.0 || !both.any(|&sphere| is_changed[sphere])
    };
    let mut found = by_first(found, is_changed.len());
    let merged = threads::map(shares(&mut found, list), |(found, old)| {
        for same in found.chunk_by_mut(|a, b| a[0] == b[0]) {
            same.sort_unstable();
        }
        let mut pairs = Vec::with_capacity(old.len().max(found.len()));
        let mut old = old.iter().peekable();
        for &mut spheres in found {
            while let Some(pair) = old.next_if(|pair| pair.spheres < spheres) {
                if stays(pair) {
                    pairs.push(*pair);
                }
            }
            match old.next_if(|pair| pair.spheres == spheres) {
                Some(known) => pairs.push(*known),
                None => pairs.push(SpherePair::new(spheres)),
            }
        }
        pairs.extend(old.filter(|pair| stays(pair)));
        pairs
    });
    *list = merged.concat();
}

/// Replaces each sphere number `old` by `numbers[old]`. Removes pairs that contain a removed sphere.
pub fn renumber(list: &mut Vec<SpherePair>, numbers: &IndexVec<SphereId, SphereId>) {
    list.retain_mut(|pair| {
        let number = |old: SphereId| numbers.get(old.index()).copied().unwrap_or(SphereId::NONE);
        let [a, b] = pair.spheres.map(number);
        pair.spheres = [a.min(b), a.max(b)];
        if a > b {
            pair.impulse.friction_impulse = -pair.impulse.friction_impulse;
        }
        pair.spheres[1] != SphereId::NONE
    });
    list.sort_unstable_by_key(|pair| pair.spheres);
}

/// Splits two lists of pairs into shares for threads. Both lists ascend by the first sphere of a pair, and
/// are split at the same spheres.
fn shares<'a>(
    mut found: &'a mut [[SphereId; 2]],
    mut old: &'a [SpherePair],
) -> impl Iterator<Item = (&'a mut [[SphereId; 2]], &'a [SpherePair])> {
    let mut is_done = false;
    std::iter::from_fn(move || {
        if is_done {
            return None;
        }
        let last = found.get(CHUNK_SIZE).map(|pair| pair[0]);
        is_done = last.is_none();
        let last = last.unwrap_or(SphereId::NONE);
        let end = found.partition_point(|pair| pair[0] <= last);
        let own;
        (own, found) = std::mem::take(&mut found).split_at_mut(end);
        let end = old.partition_point(|pair| pair.spheres[0] <= last);
        let known;
        (known, old) = old.split_at(end);
        Some((own, known))
    })
}

impl SpherePair {
    /// Returns a pair that has not touched yet.
    fn new(spheres: [SphereId; 2]) -> Self {
        Self {
            spheres,
            impulse: Impulse::default(),
            met_in_front: false,
        }
    }

    /// Returns whether the pair must be stored in a file: it has an impulse, or `met_in_front` is set. A
    /// search finds all other pairs again.
    pub fn is_known(&self) -> bool {
        self.impulse.is_known() || self.met_in_front
    }

    pub fn both<'a>(
        &self,
        spheres: &'a IndexVec<SphereId, ContactSphere>,
    ) -> [&'a ContactSphere; 2] {
        self.spheres.map(|sphere| &spheres[sphere])
    }
}

/// Returns the pairs in the order of their first spheres. All sphere numbers are below `count`.
fn by_first(pairs: &[Vec<[SphereId; 2]>], count: usize) -> Vec<[SphereId; 2]> {
    let mut end: IndexVec<SphereId, u32> = vec![0; count].into();
    for pair in pairs.iter().flatten() {
        end[pair[0]] += 1;
    }
    let mut sum = 0;
    for end in &mut end {
        sum += std::mem::replace(end, sum);
    }
    let mut sorted = vec![[SphereId::NONE; 2]; sum as usize];
    for pair in pairs.iter().flatten() {
        let place = &mut end[pair[0]];
        sorted[*place as usize] = *pair;
        *place += 1;
    }
    sorted
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::row::Row;

    #[test]
    fn renumber_keeps_impulses_and_drops_removed_spheres() {
        let pair = |spheres: [u32; 2], normal_impulse| SpherePair {
            spheres: spheres.map(SphereId),
            impulse: Impulse {
                normal_impulse,
                friction_impulse: Row::from_array([normal_impulse; 4]),
                total: 0.0,
                sum: Row::ZERO,
                speed: 0.0,
            },
            met_in_front: true,
        };
        let mut pairs = vec![pair([0, 1], 1.0), pair([0, 2], 2.0), pair([1, 3], 3.0)];
        // Sphere 0 gets number 1, sphere 1 is removed, and sphere 2 gets number 0.
        let numbers = vec![SphereId(1), SphereId::NONE, SphereId(0)];
        renumber(&mut pairs, &numbers.into());
        assert_eq!(pairs.len(), 1);
        let kept = pairs[0];
        assert_eq!(kept.spheres, [0, 1].map(SphereId));
        assert_eq!(kept.impulse.normal_impulse, 2.0);
        assert_eq!(
            kept.impulse.friction_impulse,
            Row::from_array([-2.0; 4]),
            "the order of the spheres is swapped"
        );
    }
}
