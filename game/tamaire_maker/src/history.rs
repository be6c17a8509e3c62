//! Undo and redo.

/// A value and those that it had before and after.
#[derive(Clone, Debug)]
pub struct History<T> {
    past: Vec<T>,
    present: T,
    future: Vec<T>,
}

impl<T: PartialEq> History<T> {
    /// Begins with a value.
    pub fn new(present: T) -> Self {
        Self {
            past: Vec::new(),
            present,
            future: Vec::new(),
        }
    }

    /// Returns the present value.
    pub fn present(&self) -> &T {
        &self.present
    }

    /// Makes `next` the present value, and forgets those that were undone. Does nothing if it is equal to the present
    /// value.
    pub fn commit(&mut self, next: T) {
        if next != self.present {
            self.past.push(std::mem::replace(&mut self.present, next));
            self.future.clear();
        }
    }

    /// Replaces the present value. The values before and after stay.
    pub fn amend(&mut self, next: T) {
        self.present = next;
    }

    /// Forgets the oldest values before the present one until the others together have a size of at most `most`. `size`
    /// returns the size of a value.
    pub fn forget_beyond(&mut self, most: usize, size: impl Fn(&T) -> usize) {
        let mut all = 0_usize;
        let newest = self.past.iter().rev();
        let kept = newest.take_while(|value| {
            all = all.saturating_add(size(value));
            all <= most
        });
        let kept = kept.count();
        self.past.drain(..self.past.len() - kept);
    }

    /// Whether there is a value to go back to.
    pub fn can_undo(&self) -> bool {
        !self.past.is_empty()
    }

    /// Whether there is an undone value.
    pub fn can_redo(&self) -> bool {
        !self.future.is_empty()
    }

    /// Goes back to the value before. Returns whether there is one.
    pub fn undo(&mut self) -> bool {
        let Some(before) = self.past.pop() else {
            return false;
        };
        self.future
            .push(std::mem::replace(&mut self.present, before));
        true
    }

    /// Returns to the value that was undone last. Returns whether there is one.
    pub fn redo(&mut self) -> bool {
        let Some(after) = self.future.pop() else {
            return false;
        };
        self.past.push(std::mem::replace(&mut self.present, after));
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn undo_and_redo_visit_every_value() {
        let mut history = History::new(0);
        assert!(!history.undo() && !history.redo());
        (1..=3).for_each(|k| history.commit(k));
        history.commit(3);
        for expected in [2, 1, 0] {
            assert!(history.undo());
            assert_eq!(*history.present(), expected);
        }
        assert!(!history.can_undo() && history.redo());
        history.commit(7);
        assert!(!history.can_redo() && history.undo());
        assert_eq!(*history.present(), 1);
    }

    #[test]
    fn amended_value_is_no_step_and_keeps_redo() {
        let mut history = History::new(0);
        (1..=2).for_each(|k| history.commit(k));
        assert!(history.undo());
        history.amend(9);
        assert_eq!(*history.present(), 9);
        assert!(history.redo() && *history.present() == 2);
        assert!(history.undo() && *history.present() == 9);
        assert!(history.undo() && *history.present() == 0);
    }

    #[test]
    fn oldest_values_are_forgotten_beyond_a_size() {
        let mut history = History::new(0);
        (1..=9).for_each(|k| history.commit(k));
        history.forget_beyond(15, |&k| k);
        let undone = (0..9).take_while(|_| history.undo()).count();
        assert_eq!((undone, *history.present()), (2, 7));
    }
}
