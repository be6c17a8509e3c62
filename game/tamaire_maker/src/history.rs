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
}
