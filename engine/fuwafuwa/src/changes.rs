//! What tears and removals changed in a body, for whoever keeps something that follows from it: contact, pictures, a game.

use crate::ids::{ElementId, NodeId, PieceId};
use std::collections::VecDeque;
use std::sync::atomic::{AtomicU64, Ordering};

/// What changed in a body since somebody looked.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Changes {
    /// Nodes that are gone or new.
    pub nodes: Vec<NodeId>,
    /// Elements that are gone or new, or have other nodes or other bare faces than before.
    pub elements: Vec<ElementId>,
    /// Pieces that came off.
    pub parted: Vec<PieceId>,
    /// Pieces that were removed: their nodes and elements are gone.
    pub removed: Vec<PieceId>,
}

/// Up to where somebody has followed a body; at first, nowhere.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq)]
pub struct Bookmark {
    /// Which history, 0 for none, and how much of it.
    history: u64,
    tears: u64,
}

/// What tears changed in a body, the last ones at least.
#[derive(Debug)]
pub(crate) struct History {
    /// Which one it is: no two of a program are the same, so that no body is taken for another one.
    number: u64,
    /// How many tears there were before the first that is kept.
    forgotten: u64,
    kept: VecDeque<Changes>,
    /// How many ids those name.
    size: usize,
}

impl Changes {
    /// How much there is to look at.
    fn size(&self) -> usize {
        self.nodes.len() + self.elements.len() + self.parted.len() + self.removed.len()
    }
}

impl Default for History {
    fn default() -> Self {
        // Nothing that moves depends on it.
        static COUNT: AtomicU64 = AtomicU64::new(1);
        Self {
            number: COUNT.fetch_add(1, Ordering::Relaxed),
            forgotten: 0,
            kept: VecDeque::new(),
            size: 0,
        }
    }
}

/// A copy goes its own way.
impl Clone for History {
    fn clone(&self) -> Self {
        Self::default()
    }
}

impl History {
    /// Adds a tear. More than `most` ids are not kept: from there on it is quicker to look at everything.
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

    /// Where it is now.
    pub fn end(&self) -> Bookmark {
        Bookmark {
            history: self.number,
            tears: self.forgotten + self.kept.len() as u64,
        }
    }

    /// All that changed since, each id once, ascending; nothing when that is not known.
    pub fn since(&self, bookmark: Bookmark) -> Option<Changes> {
        if bookmark.history != self.number {
            return None;
        }
        let known = bookmark.tears.checked_sub(self.forgotten)?;
        let mut all = Changes::default();
        for changes in self.kept.iter().skip(known as usize) {
            all.nodes.extend(&changes.nodes);
            all.elements.extend(&changes.elements);
            all.parted.extend(&changes.parted);
            all.removed.extend(&changes.removed);
        }
        sort(&mut all.nodes);
        sort(&mut all.elements);
        sort(&mut all.parted);
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
    fn who_follows_hears_of_everything_once() {
        let mut history = History::default();
        assert_eq!(history.since(Bookmark::default()), None);
        let mut own = history.end();
        assert_eq!(history.since(own), Some(changes(&[])));
        history.add(&changes(&[5, 2]), 5);
        history.add(&changes(&[3, 2]), 5);
        assert_eq!(history.since(own), Some(changes(&[2, 3, 5])));
        own = history.end();
        assert_eq!(history.since(own), Some(changes(&[])));
        // Too much: who read the last one goes on, who has not begins anew.
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
