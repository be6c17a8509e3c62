//! Storage with reusable slots.

/// Items with stable slots. The slot freed last is reused first.
#[derive(Clone, Debug)]
pub struct Pool<T> {
    /// All slots; `None` for free ones.
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
    /// Stores an item and returns its slot.
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

    /// Frees a slot.
    pub fn free(&mut self, place: u32) {
        self.all[place as usize] = None;
        self.free.push(place);
    }
}
