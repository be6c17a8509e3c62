//! Work shared out among threads, as far as the feature `parallel` and the caller's pool of them
//! allow. Shares write nothing that another one reads or writes, and their results come in order: on
//! any number of threads the same bits come out.

use crate::ids::NodeId;

/// Items in a share: with fewer, handing them over takes longer than they do. At 9 to 29 ns, as an element takes in a substep,
/// these take 20 to 60 µs. Unit tests have small bodies, and are to see several shares all the same.
pub const SHARE: usize = if cfg!(test) { 32 } else { 2048 };

/// Shares from which on several threads take part: where other programs want the machine too, each
/// meeting of threads can last as long as a tick, and small bodies have nothing to win. So many
/// hold the nodes of a ball of 40 voxels across.
#[cfg(feature = "parallel")]
const LEAST: usize = if cfg!(test) { 2 } else { 8 };

/// Does the work of each share; returns what came of them, in their order.
pub fn map<T: Send, R: Send>(
    shares: impl Iterator<Item = T>,
    work: impl Fn(T) -> R + Sync,
) -> Vec<R> {
    #[cfg(feature = "parallel")]
    let shares = {
        use rayon::prelude::*;
        let shares: Vec<T> = shares.collect();
        if shares.len() >= LEAST && rayon::current_num_threads() > 1 {
            return shares.into_par_iter().map(&work).collect();
        }
        shares.into_iter()
    };
    shares.map(work).collect()
}

/// A list in shares, each with the place of its first item.
pub fn shares<T>(list: &mut [T]) -> impl Iterator<Item = (usize, &mut [T])> {
    let firsts = (0..).step_by(SHARE);
    firsts.zip(list.chunks_mut(SHARE))
}

/// Some nodes and their rows of several lists that go by node id.
pub struct Rows<'a, T, const N: usize> {
    /// Ascending.
    pub nodes: &'a [NodeId],
    /// The id that the first rows belong to.
    pub first: usize,
    /// Those of all ids from there to beyond the last of the nodes.
    pub lists: [&'a mut [T]; N],
}

/// The rows of nodes, whose ids ascend, in shares.
pub fn rows<'a, T, const N: usize>(
    nodes: &'a [NodeId],
    mut lists: [&'a mut [T]; N],
) -> impl Iterator<Item = Rows<'a, T, N>> {
    let mut first = 0;
    nodes.chunks(SHARE).map(move |nodes| {
        let end = nodes[nodes.len() - 1].index() + 1;
        let lists = lists.each_mut().map(|list| {
            let (own, others) = std::mem::take(list).split_at_mut(end - first);
            *list = others;
            own
        });
        let share = Rows {
            nodes,
            first,
            lists,
        };
        first = end;
        share
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_node_is_in_one_share_with_its_rows() {
        let nodes = (0..5 * SHARE as u32).map(|k| NodeId(3 * k + k % 2));
        let nodes: Vec<NodeId> = nodes.collect();
        let count = 20 * SHARE;
        let (mut a, mut b) = (vec![[0.0; 4]; count], vec![[0.0; 4]; count]);
        let shares = rows(&nodes, [&mut a, &mut b]);
        let counts = map(shares, |share| {
            let Rows {
                nodes,
                first,
                lists: [a, b],
            } = share;
            for &id in nodes {
                a[id.index() - first][0] += 1.0;
                b[id.index() - first][1] += id.index() as f32;
            }
            nodes.len()
        });
        assert_eq!(counts, [SHARE; 5]);
        for id in 0..count {
            let is_one = nodes.binary_search(&NodeId(id as u32)).is_ok();
            let expected = if is_one { [1.0, id as f32] } else { [0.0; 2] };
            assert_eq!([a[id][0], b[id][1]], expected);
        }
    }
}
