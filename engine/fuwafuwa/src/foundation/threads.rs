//! Work distribution over threads, with the feature `parallel` and the thread pool of the caller. No chunk
//! writes data that another chunk reads or writes, and results are returned in order. The result is therefore
//! bitwise identical for any number of threads.

use crate::foundation::ids::NodeId;
use std::ops::Range;

/// Number of items in a chunk. With fewer items, the handover to a thread takes longer than the work. Unit
/// tests use small bodies, and should still cover several chunks.
pub const CHUNK_SIZE: usize = if cfg!(test) { 32 } else { 2048 };

/// Smallest number of chunks that are processed on several threads; fewer chunks are processed on one. If
/// other programs use the machine, each synchronisation of threads can take as long as a tick, so threads do
/// not help small bodies. A ball with a diameter of 40 voxels has enough nodes for this many chunks.
#[cfg(feature = "parallel")]
const MIN_PARALLEL_CHUNKS: usize = if cfg!(test) { 2 } else { 8 };

/// Calls `work` for each of `shares`, on several threads if there are many shares. Returns the results in the
/// order of `shares`.
pub fn map<T: Send, R: Send>(
    shares: impl Iterator<Item = T>,
    work: impl Fn(T) -> R + Sync,
) -> Vec<R> {
    #[cfg(feature = "parallel")]
    let shares = {
        use rayon::prelude::*;
        let shares: Vec<T> = shares.collect();
        if shares.len() >= MIN_PARALLEL_CHUNKS && rayon::current_num_threads() > 1 {
            return shares.into_par_iter().map(&work).collect();
        }
        shares.into_iter()
    };
    shares.map(work).collect()
}

/// Splits a list into chunks, each with the index of its first item.
pub fn chunks<T>(list: &mut [T]) -> impl Iterator<Item = (usize, &mut [T])> {
    let firsts = (0..).step_by(CHUNK_SIZE);
    firsts.zip(list.chunks_mut(CHUNK_SIZE))
}

/// Chunk of nodes, with the corresponding parts of `N` lists that hold one row for each node id.
pub struct RowChunk<'a, T, const N: usize> {
    /// Nodes, ascending.
    pub nodes: &'a [NodeId],
    /// Node id of the first row in each list.
    pub first: usize,
    /// Part of each list: the rows of all node ids from `first` to the last node of the chunk.
    pub lists: [&'a mut [T]; N],
}

/// Splits nodes with ascending ids into chunks. Gives each chunk the parts of `lists` that belong to its
/// nodes; the lists hold one row for each node id.
pub fn rows<'a, T, const N: usize>(
    nodes: &'a [NodeId],
    mut lists: [&'a mut [T]; N],
) -> impl Iterator<Item = RowChunk<'a, T, N>> {
    let mut first = 0;
    nodes.chunks(CHUNK_SIZE).map(move |nodes| {
        let end = nodes[nodes.len() - 1].index() + 1;
        let lists = lists.each_mut().map(|list| {
            let (own, others) = std::mem::take(list).split_at_mut(end - first);
            *list = others;
            own
        });
        let share = RowChunk {
            nodes,
            first,
            lists,
        };
        first = end;
        share
    })
}

/// Run of nodes with consecutive ids.
#[derive(Clone, Debug, PartialEq)]
pub struct Run {
    /// Ids of the nodes.
    pub ids: Range<usize>,
    /// Rows of the nodes in the lists of their [`RowChunk`].
    pub rows: Range<usize>,
}

/// Splits the nodes of a [`RowChunk`] into runs. A part of a list by a run takes one bounds check for the run, not one
/// for each node. `first` is the node id of the first row of the chunk.
#[inline(always)]
pub fn runs(nodes: &[NodeId], first: usize) -> impl Iterator<Item = Run> {
    let runs = nodes.chunk_by(|a, b| b.0 == a.0 + 1);
    runs.map(move |run| {
        let start = run[0].index();
        let row = start - first;
        Run {
            ids: start..start + run.len(),
            rows: row..row + run.len(),
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_are_broken_by_missing_ids_only() {
        let runs = |ids: &[u32]| {
            let nodes: Vec<NodeId> = ids.iter().map(|&id| NodeId(id)).collect();
            let lists = [&mut [0u8; 100][..]];
            let chunks = rows(&nodes, lists).map(|chunk| {
                let runs = super::runs(chunk.nodes, chunk.first).map(|run| (run.ids, run.rows));
                runs.collect::<Vec<_>>()
            });
            chunks.collect::<Vec<_>>()
        };
        assert!(runs(&[]).is_empty());
        assert_eq!(runs(&[7]), [[(7..8, 7..8)]]);
        assert_eq!(runs(&[0, 1, 4, 5, 6]), [[(0..2, 0..2), (4..7, 4..7)]]);
        // The second chunk of 32 nodes begins within a run, and its rows begin after those of the first.
        let ids: Vec<u32> = (10..50).collect();
        assert_eq!(runs(&ids), [[(10..42, 10..42)], [(42..50, 0..8)]]);
    }

    #[test]
    fn rows_assign_every_node_to_one_chunk() {
        let nodes = (0..5 * CHUNK_SIZE as u32).map(|k| NodeId(3 * k + k % 2));
        let nodes: Vec<NodeId> = nodes.collect();
        let count = 20 * CHUNK_SIZE;
        let (mut a, mut b) = (vec![[0.0; 4]; count], vec![[0.0; 4]; count]);
        let shares = rows(&nodes, [&mut a, &mut b]);
        let counts = map(shares, |share| {
            let RowChunk {
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
        assert_eq!(counts, [CHUNK_SIZE; 5]);
        for id in 0..count {
            let is_one = nodes.binary_search(&NodeId(id as u32)).is_ok();
            let expected = if is_one { [1.0, id as f32] } else { [0.0; 2] };
            assert_eq!([a[id][0], b[id][1]], expected);
        }
    }
}
