//! Changes of a body by cracks and removals. Contact, rendering and games update their derived data from
//! these changes.

use crate::foundation::ids::{ElementId, NodeId, PieceId};
use std::collections::VecDeque;
use std::sync::atomic::{AtomicU64, Ordering};

/// Changes of a body since a bookmark, as lists of ids.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Changes {
    /// Nodes that were added or removed.
    pub nodes: Vec<NodeId>,
    /// Elements that were added or removed, or whose nodes or exposed faces changed.
    pub elements: Vec<ElementId>,
    /// New pieces that were detached from older pieces.
    pub detached: Vec<PieceId>,
    /// Pieces that were removed, with their nodes and elements.
    pub removed: Vec<PieceId>,
}

/// Position in the history of changes of a body, up to which a reader has processed the changes. The default
/// belongs to no history: a reader that starts with it must read the whole body once.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq)]
pub struct Bookmark {
    /// Number of the history, see [`History::number`]; 0 = no history.
    history: u64,
    /// Number of entries of the history, counted from its start, that the reader has processed.
    tears: u64,
}

/// History of a body: its most recent changes.
#[derive(Debug)]
pub(crate) struct History {
    /// Number of the history, unique within the program. A bookmark of another body is recognised by it.
    number: u64,
    /// Number of entries that were dropped, all older than those in `kept`.
    forgotten: u64,
    kept: VecDeque<Changes>,
    /// Number of ids in all entries of `kept`, which [`History::add`] limits.
    size: usize,
}

impl Changes {
    /// Returns the total number of node, element and piece ids.
    fn size(&self) -> usize {
        self.nodes.len() + self.elements.len() + self.detached.len() + self.removed.len()
    }
}

impl Default for History {
    fn default() -> Self {
        // A global counter does not make simulations differ, because they do not depend on the number of a
        // history.
        static COUNT: AtomicU64 = AtomicU64::new(1);
        Self {
            number: COUNT.fetch_add(1, Ordering::Relaxed),
            forgotten: 0,
            kept: VecDeque::new(),
            size: 0,
        }
    }
}

/// A clone starts a new, empty history: bookmarks of the original are not valid for the clone.
impl Clone for History {
    fn clone(&self) -> Self {
        Self::default()
    }
}

impl History {
    /// Appends an entry. While the history contains more than `most` ids, drops the oldest entry: reading the
    /// whole body is then faster than reading the history.
    pub fn add(&mut self, changes: &Changes, most: usize) {
        self.kept.push_back(changes.clone());
        self.size += changes.size();
        while self.size > most {
            let Some(first) = self.kept.pop_front() else {
                break;
            };
            self.size -= first.size();
            self.forgotten += 1;
        }
    }

    /// Returns a bookmark at the present end of the history.
    pub fn end(&self) -> Bookmark {
        Bookmark {
            history: self.number,
            tears: self.forgotten + self.kept.len() as u64,
        }
    }

    /// Returns all changes since `bookmark`, each id once, ascending. Returns `None` if some of these changes
    /// were dropped, or if the bookmark belongs to another history.
    pub fn since(&self, bookmark: Bookmark) -> Option<Changes> {
        if bookmark.history != self.number {
            return None;
        }
        let known = bookmark.tears.checked_sub(self.forgotten)?;
        let mut all = Changes::default();
        for changes in self.kept.iter().skip(known as usize) {
            all.nodes.extend(&changes.nodes);
            all.elements.extend(&changes.elements);
            all.detached.extend(&changes.detached);
            all.removed.extend(&changes.removed);
        }
        sort(&mut all.nodes);
        sort(&mut all.elements);
        sort(&mut all.detached);
        sort(&mut all.removed);
        Some(all)
    }
}

fn sort<T: Ord>(ids: &mut Vec<T>) {
    ids.sort_unstable();
    ids.dedup();
}

#[cfg(test)]
mod tests {
    use super::*;

    fn changes(elements: &[u32]) -> Changes {
        Changes {
            elements: elements.iter().copied().map(ElementId).collect(),
            ..Changes::default()
        }
    }

    #[test]
    fn history_reports_each_change_once() {
        let mut history = History::default();
        assert_eq!(history.since(Bookmark::default()), None);
        let mut own = history.end();
        assert_eq!(history.since(own), Some(changes(&[])));
        history.add(&changes(&[5, 2]), 5);
        history.add(&changes(&[3, 2]), 5);
        assert_eq!(history.since(own), Some(changes(&[2, 3, 5])));
        own = history.end();
        assert_eq!(history.since(own), Some(changes(&[])));
        // The history drops an entry here. A reader that has processed this entry can continue; a reader that
        // has not must read the whole body.
        let late = own;
        history.add(&changes(&[1, 4]), 3);
        assert_eq!(history.since(late), Some(changes(&[1, 4])));
        history.add(&changes(&[6, 7, 8]), 3);
        assert_eq!(history.since(late), None);
        history.add(&changes(&[1, 2, 3, 4]), 3);
        assert_eq!(history.since(late), None);
        assert_eq!(history.since(history.end()), Some(changes(&[])));
        assert_eq!(history.clone().since(late), None);
        assert_eq!(history.clone().since(history.end()), None);
    }
}
