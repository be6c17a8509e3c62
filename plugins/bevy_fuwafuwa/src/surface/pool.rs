//! Places that are given back and used again.

/// Things at places that they keep; a place that was given back is the next one to be taken.
#[derive(Clone, Debug)]
pub struct Pool<T> {
    /// All places; nothing at those that nobody has.
    pub all: Vec<Option<T>>,
    free: Vec<u32>,
}

impl<T> Default for Pool<T> {
    fn default() -> Self {
        let (all, free) = (Vec::new(), Vec::new());
        Self { all, free }
    }
}

impl<T> Pool<T> {
    /// Takes a place for something.
    pub fn take(&mut self, thing: T) -> u32 {
        match self.free.pop() {
            Some(place) => {
                self.all[place as usize] = Some(thing);
                place
            }
            None => {
                self.all.push(Some(thing));
                self.all.len() as u32 - 1
            }
        }
    }

    /// Gives a place back.
    pub fn give_back(&mut self, place: u32) {
        self.all[place as usize] = None;
        self.free.push(place);
    }
}
