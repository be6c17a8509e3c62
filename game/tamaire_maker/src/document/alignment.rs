//! Alignment of two lists.

/// Maximum product of the lengths of two lists for which a longest common subsequence is searched. Longer lists are
/// paired in order, after their equal beginnings and ends.
const MAX_TABLE: usize = 1 << 20;

/// Step from an old list to a new one. The steps that are no deletions are in the order of the new list.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub(super) enum Step {
    /// Old and new entry are equal.
    Keep(usize),
    /// Old entry that becomes the new one.
    Change(usize, usize),
    /// Old entry that is not in the new list.
    Delete(usize),
    /// New entry that is not in the old list.
    Insert(usize),
}

/// Returns the steps from an old list to a new one. Entries of a longest common subsequence are kept; the others are
/// paired in order between the kept ones.
pub(super) fn steps<T: PartialEq>(old: &[T], new: &[T]) -> Vec<Step> {
    let mut steps = Vec::with_capacity(old.len().max(new.len()));
    let (mut from, mut to) = (0, 0);
    let end = (old.len(), new.len());
    for (kept, same) in common(old, new).into_iter().chain([end]) {
        pair(&mut steps, from..kept, to..same);
        if (kept, same) != end {
            steps.push(Step::Keep(kept));
        }
        (from, to) = (kept + 1, same + 1);
    }
    steps
}

/// Adds the steps between two kept entries.
fn pair(steps: &mut Vec<Step>, old: std::ops::Range<usize>, new: std::ops::Range<usize>) {
    let both = old.len().min(new.len());
    let (later_old, later_new) = (old.start + both, new.start + both);
    let pairs = old.clone().zip(new.clone());
    steps.extend(pairs.map(|(old, new)| Step::Change(old, new)));
    steps.extend((later_old..old.end).map(Step::Delete));
    steps.extend((later_new..new.end).map(Step::Insert));
}

/// Returns the pairs of indices of a longest common subsequence.
fn common<T: PartialEq>(old: &[T], new: &[T]) -> Vec<(usize, usize)> {
    let both = || old.iter().zip(new);
    let start = both().take_while(|(old, new)| old == new).count();
    let ends = old[start..].iter().rev().zip(new[start..].iter().rev());
    let end = ends.take_while(|(old, new)| old == new).count();
    let (old_end, new_end) = (old.len() - end, new.len() - end);
    let middle = subsequence(&old[start..old_end], &new[start..new_end]);
    let middle = middle.into_iter().map(|(a, b)| (a + start, b + start));
    let first = (0..start).map(|index| (index, index));
    let last = (0..end).map(|index| (old_end + index, new_end + index));
    first.chain(middle).chain(last).collect()
}

fn subsequence<T: PartialEq>(old: &[T], new: &[T]) -> Vec<(usize, usize)> {
    let width = new.len() + 1;
    if old.len().saturating_mul(new.len()) > MAX_TABLE {
        return Vec::new();
    }
    // Length of a longest common subsequence of the entries from each pair of indices on.
    let mut lengths = vec![0_u32; (old.len() + 1) * width];
    for a in (0..old.len()).rev() {
        for b in (0..new.len()).rev() {
            lengths[a * width + b] = match old[a] == new[b] {
                true => lengths[(a + 1) * width + b + 1] + 1,
                false => lengths[(a + 1) * width + b].max(lengths[a * width + b + 1]),
            };
        }
    }
    let (mut a, mut b, mut pairs) = (0, 0, Vec::new());
    while a < old.len() && b < new.len() {
        if old[a] == new[b] {
            pairs.push((a, b));
            (a, b) = (a + 1, b + 1);
        } else if lengths[(a + 1) * width + b] >= lengths[a * width + b + 1] {
            a += 1;
        } else {
            b += 1;
        }
    }
    pairs
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_keep_equal_entries_and_pair_the_others_between_them() {
        use Step::{Change, Delete, Insert, Keep};
        let of = |old: &str, new: &str| steps(old.as_bytes(), new.as_bytes());
        assert_eq!(of("abc", "abc"), [Keep(0), Keep(1), Keep(2)]);
        assert_eq!(of("abc", "ac"), [Keep(0), Delete(1), Keep(2)]);
        assert_eq!(of("ac", "abc"), [Keep(0), Insert(1), Keep(1)]);
        assert_eq!(
            of("abcd", "axcyz"),
            [Keep(0), Change(1, 1), Keep(2), Change(3, 3), Insert(4)]
        );
        assert_eq!(of("", "ab"), [Insert(0), Insert(1)]);
        assert_eq!(of("ab", ""), [Delete(0), Delete(1)]);
    }

    #[test]
    fn steps_give_the_new_list_for_random_lists() {
        let mut random = fastrand::Rng::with_seed(5);
        for _ in 0..2000 {
            let mut list =
                || -> Vec<u8> { (0..random.usize(..9)).map(|_| random.u8(..4)).collect() };
            let (old, new) = (list(), list());
            let mut gone = Vec::new();
            let mut made = Vec::new();
            for step in steps(&old, &new) {
                match step {
                    Step::Keep(a) => {
                        gone.push(a);
                        made.push(old[a]);
                    }
                    Step::Change(a, b) => {
                        gone.push(a);
                        made.push(new[b]);
                    }
                    Step::Delete(a) => gone.push(a),
                    Step::Insert(b) => made.push(new[b]),
                }
            }
            assert_eq!(made, new);
            assert!(
                gone.into_iter().eq(0..old.len()),
                "every old entry is used once"
            );
        }
    }
}
