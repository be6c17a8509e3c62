//! Work distribution over threads, with the feature `parallel` and the thread pool of the caller. No share
//! writes data that another share reads or writes, and results are returned in order. The result is therefore
//! bitwise identical for any number of threads.

use crate::foundation::ids::Id;
use std::ops::Range;

/// Number of rows in a chunk. With fewer rows, the handover to a thread takes longer than the work. Unit tests
/// use small bodies, and should still cover several chunks.
pub const CHUNK_SIZE: usize = if cfg!(test) { 32 } else { 1024 };

/// Number of items in a chunk of items that each take as long as about eight rows.
pub const SEARCHES_PER_CHUNK: usize = CHUNK_SIZE / 8;

/// Smallest number of chunks that are processed on several threads; fewer chunks are processed on one. If another
/// program takes the core of a thread, each region can take as long as a tick, so threads do not help small bodies. A
/// ball with a diameter of 40 voxels has enough nodes for this many chunks.
#[cfg(feature = "parallel")]
const MIN_PARALLEL_CHUNKS: usize = if cfg!(test) { 2 } else { 16 };

/// Calls `work` for each of `shares`, on several threads if there are many shares. Returns the results in the
/// order of `shares`. Each share has about [`CHUNK_SIZE`] rows.
pub fn map<T: Send, R: Send>(
    shares: impl Iterator<Item = T>,
    work: impl Fn(T) -> R + Sync,
) -> Vec<R> {
    map_items(shares, |_| CHUNK_SIZE, work)
}

/// Calls `work` for each of `items`, of which `rows` returns the number of rows, on several threads if there are many
/// rows in all. Returns the results in the order of `items`.
pub fn map_items<T: Send, R: Send>(
    items: impl Iterator<Item = T>,
    rows: impl Fn(&T) -> usize,
    work: impl Fn(T) -> R + Sync,
) -> Vec<R> {
    #[cfg(feature = "parallel")]
    let items = {
        let items: Vec<T> = items.collect();
        let total: usize = items.iter().map(&rows).sum();
        let is_large = items.len() > 1 && total >= MIN_PARALLEL_CHUNKS * CHUNK_SIZE;
        if is_large && pool::has_several_threads() {
            return pool::map(items, work);
        }
        items.into_iter()
    };
    #[cfg(not(feature = "parallel"))]
    let _ = rows;
    items.map(work).collect()
}

/// Calls `work` on a thread of the pool if `rows` is large, otherwise on the calling thread. `rows` is the number of rows
/// that each phase of `work` processes. Outside the pool, each phase would have to enter the pool by itself.
pub fn in_pool<R: Send>(rows: usize, work: impl FnOnce() -> R + Send) -> R {
    #[cfg(feature = "parallel")]
    if rows >= MIN_PARALLEL_CHUNKS * CHUNK_SIZE && pool::has_several_threads() {
        return pool::enter(work);
    }
    #[cfg(not(feature = "parallel"))]
    let _ = rows;
    work()
}

/// Work on the threads of rayon's pool. A region is a call of [`pool::for_each_index`].
#[cfg(feature = "parallel")]
mod pool {
    use rayon::prelude::*;
    use std::cell::{Cell, RefCell};
    use std::sync::atomic::{AtomicU8, Ordering::Relaxed};
    use std::sync::{Arc, Mutex};

    /// Number of times in succession that a thread looks for work in vain before it sleeps, in some 0.1 ms. Several
    /// regions follow each other in a substep, and waking a thread takes as long as a region of a small body.
    const MAX_IDLE_LOOKS: u32 = 200;
    /// Total number of times that a thread looks for work before it returns to what it did before.
    const MAX_LOOKS: u32 = 4000;

    /// State of a thread that sleeps or does other work; of one that shall look for work; and of one that does.
    const ELSEWHERE: u8 = 0;
    const CALLED: u8 = 1;
    const WAITING: u8 = 2;

    thread_local! {
        /// Number of regions of this thread that have not ended.
        static REGIONS: Cell<usize> = const { Cell::new(0) };
        /// States of the threads of the pool, as far as this thread has called them.
        static STATES: RefCell<Vec<Arc<AtomicU8>>> = const { RefCell::new(Vec::new()) };
    }

    /// Returns whether this thread uses a pool with several threads: the pool that it belongs to, or else the global
    /// pool.
    pub fn has_several_threads() -> bool {
        rayon::current_num_threads() > 1
    }

    /// Calls `work` on a thread of the pool.
    pub fn enter<R: Send>(work: impl FnOnce() -> R + Send) -> R {
        rayon::scope(|_| work())
    }

    /// Calls `work` for each item. Returns the results in the order of `items`.
    pub fn map<T: Send, R: Send>(items: Vec<T>, work: impl Fn(T) -> R + Sync) -> Vec<R> {
        /// Item to process, and then the result of the work.
        struct Slot<T, R> {
            item: Option<T>,
            result: Option<R>,
        }
        let slot = |item| {
            Mutex::new(Slot {
                item: Some(item),
                result: None,
            })
        };
        let slots: Vec<_> = items.into_iter().map(slot).collect();
        for_each_index(slots.len(), &|index| {
            let mut slot = slots[index].lock().expect("each slot is locked once");
            slot.result = slot.item.take().map(&work);
        });
        let results = slots.into_iter().map(|slot| {
            let slot = slot.into_inner().expect("a panic would have ended the map");
            slot.result.expect("each item has been processed")
        });
        results.collect()
    }

    /// Calls `work` for each index below `count`. `work` is a trait object, so that rayon's code is compiled once.
    /// Compiled for each kind of work, it was a quarter of the engine's machine code.
    fn for_each_index(count: usize, work: &(dyn Fn(usize) + Sync)) {
        call_others();
        let _region = Region::new();
        (0..count).into_par_iter().for_each(work);
    }

    /// Counts a region in [`REGIONS`] until it is dropped.
    struct Region;

    impl Region {
        fn new() -> Self {
            REGIONS.set(REGIONS.get() + 1);
            Self
        }
    }

    impl Drop for Region {
        fn drop(&mut self) {
            REGIONS.set(REGIONS.get() - 1);
        }
    }

    /// Makes the other threads of the pool look for work.
    ///
    /// A thread that looks for work executes any work of the pool, also that of other worlds. A thread that waits for the
    /// results of its own region is awake anyway, and must not be held up.
    fn call_others() {
        STATES.with_borrow_mut(|states| {
            let own = rayon::current_thread_index();
            states.resize_with(rayon::current_num_threads(), Arc::default);
            let mut is_any_called = false;
            for (index, state) in states.iter().enumerate() {
                let is_other = Some(index) != own;
                let is_called = is_other
                    && state
                        .compare_exchange(ELSEWHERE, CALLED, Relaxed, Relaxed)
                        .is_ok();
                is_any_called |= is_called;
            }
            if !is_any_called {
                return;
            }
            let states = states.clone();
            rayon::spawn_broadcast(move |thread| {
                let state = &states[thread.index()];
                if state
                    .compare_exchange(CALLED, WAITING, Relaxed, Relaxed)
                    .is_ok()
                {
                    if REGIONS.get() == 0 {
                        look_for_work();
                    }
                    state.store(ELSEWHERE, Relaxed);
                }
            });
        });
    }

    /// Executes work of the pool until [`MAX_IDLE_LOOKS`] or [`MAX_LOOKS`] is reached.
    fn look_for_work() {
        let mut idle_looks = 0;
        for _ in 0..MAX_LOOKS {
            match rayon::yield_now() {
                Some(rayon::Yield::Executed) => idle_looks = 0,
                _ => {
                    idle_looks += 1;
                    std::thread::yield_now();
                }
            }
            if idle_looks == MAX_IDLE_LOOKS {
                return;
            }
        }
    }
}

/// Splits a list into chunks of `size` items, each with the index of its first item.
pub fn chunks<T>(list: &mut [T], size: usize) -> impl Iterator<Item = (usize, &mut [T])> {
    (0..).step_by(size).zip(list.chunks_mut(size))
}

/// Chunk of ids, with the corresponding parts of `N` lists that hold one row for each id.
pub struct RowChunk<'a, I, T, const N: usize> {
    /// Ids, ascending.
    pub ids: &'a [I],
    /// Id of the first row in each list.
    pub first: usize,
    /// Part of each list: the rows of all ids from `first` to the last id of the chunk.
    pub lists: [&'a mut [T]; N],
}

/// Splits strictly ascending ids into chunks. Gives each chunk the parts of `lists` that belong to its ids; the lists hold one
/// row for each id.
pub fn rows<'a, I: Id, T, const N: usize>(
    ids: &'a [I],
    mut lists: [&'a mut [T]; N],
) -> impl Iterator<Item = RowChunk<'a, I, T, N>> {
    debug_assert!(ids.is_sorted_by(|a, b| a.index() < b.index()));
    let mut first = 0;
    ids.chunks(CHUNK_SIZE).map(move |ids| {
        let end = ids[ids.len() - 1].index() + 1;
        let lists = lists.each_mut().map(|list| {
            let (own, others) = std::mem::take(list).split_at_mut(end - first);
            *list = others;
            own
        });
        let share = RowChunk { ids, first, lists };
        first = end;
        share
    })
}

/// Run of consecutive ids.
#[derive(Clone, Debug, PartialEq)]
pub struct Run {
    /// Ids.
    pub ids: Range<usize>,
    /// Rows of the ids in the lists of their [`RowChunk`].
    pub rows: Range<usize>,
}

/// Splits the ids of a [`RowChunk`] into runs. A part of a list by a run takes one bounds check for the run, not one
/// for each id. `first` is the id of the first row of the chunk.
#[inline(always)]
pub fn runs<I: Id>(ids: &[I], first: usize) -> impl Iterator<Item = Run> {
    let runs = ids.chunk_by(|a, b| b.index() == a.index() + 1);
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
    use crate::foundation::ids::NodeId;

    #[test]
    fn runs_are_broken_by_missing_ids_only() {
        let runs = |ids: &[u32]| {
            let nodes: Vec<NodeId> = ids.iter().map(|&id| NodeId(id)).collect();
            let lists = [&mut [0u8; 100][..]];
            let chunks = rows(&nodes, lists).map(|chunk| {
                let runs = super::runs(chunk.ids, chunk.first).map(|run| (run.ids, run.rows));
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
                ids,
                first,
                lists: [a, b],
            } = share;
            for &id in ids {
                a[id.index() - first][0] += 1.0;
                b[id.index() - first][1] += id.index() as f32;
            }
            ids.len()
        });
        assert_eq!(counts, [CHUNK_SIZE; 5]);
        for id in 0..count {
            let is_one = nodes.binary_search(&NodeId(id as u32)).is_ok();
            let expected = if is_one { [1.0, id as f32] } else { [0.0; 2] };
            assert_eq!([a[id][0], b[id][1]], expected);
        }
    }

    #[cfg(feature = "parallel")]
    fn pool_of(threads: usize) -> rayon::ThreadPool {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        pool.build().unwrap()
    }

    #[test]
    #[cfg(feature = "parallel")]
    fn results_are_in_order_and_from_several_threads() {
        let thread_of = |item: usize| {
            std::thread::sleep(std::time::Duration::from_millis(1));
            (item, rayon::current_thread_index())
        };
        let results = pool_of(3).install(|| {
            let rows = |_: &usize| CHUNK_SIZE;
            [map(0..40, thread_of), map_items(0..40, rows, thread_of)]
        });
        for results in results {
            assert!(results.iter().map(|(item, _)| *item).eq(0..40));
            assert!(results.iter().any(|(_, thread)| *thread != results[0].1));
        }
    }

    #[test]
    #[cfg(feature = "parallel")]
    fn small_work_stays_on_the_calling_thread() {
        let here = std::thread::current().id();
        let thread = |_: usize| std::thread::current().id();
        assert_eq!(in_pool(1, || thread(0)), here);
        let is_here = |results: Vec<_>| results.iter().all(|thread| *thread == here);
        assert!(is_here(map(0..MIN_PARALLEL_CHUNKS - 1, thread)));
        assert!(is_here(map_items(0..40, |_| 1, thread)));
        let rows = MIN_PARALLEL_CHUNKS * CHUNK_SIZE;
        assert!(is_here(map_items(0..1, |_| rows, thread)));
    }

    /// Threads that wait for work execute that of the other tasks, too, and must still return to their own.
    #[test]
    #[cfg(feature = "parallel")]
    fn tasks_that_share_a_pool_all_end() {
        for threads in [2, 4] {
            let pool = pool_of(threads);
            let sums = pool.install(|| {
                use rayon::prelude::*;
                let task = |first: usize| {
                    let sum = |_| {
                        map(first..first + 20, |item| item * item)
                            .iter()
                            .sum::<usize>()
                    };
                    (0..200).map(sum).sum::<usize>()
                };
                (0..8usize).into_par_iter().map(task).collect::<Vec<_>>()
            });
            let expected =
                |first: usize| 200 * (first..first + 20).map(|item| item * item).sum::<usize>();
            assert!(sums.into_iter().eq((0..8).map(expected)));
        }
    }
}
