//! Sets that share nothing and are only ever joined: which of some things hang together.

/// Sets of numbers from 0 on, every number in one of them.
#[derive(Clone, Debug, Default)]
pub struct DisjointSets {
    /// Each points to a lower number of its set, the lowest to itself.
    lower: Vec<usize>,
}

impl DisjointSets {
    /// So many numbers, each in a set of its own.
    pub fn new(count: usize) -> Self {
        let lower = (0..count).collect();
        Self { lower }
    }

    /// How many numbers there are.
    pub fn count(&self) -> usize {
        self.lower.len()
    }

    /// One number more, in a set of its own; returns it.
    pub fn add(&mut self) -> usize {
        self.lower.push(self.lower.len());
        self.lower.len() - 1
    }

    /// The lowest number in the set of one: two have the same when they are in one set.
    pub fn lowest(&mut self, mut number: usize) -> usize {
        while self.lower[number] != number {
            self.lower[number] = self.lower[self.lower[number]];
            number = self.lower[number];
        }
        number
    }

    /// Some things, one a number, sorted by set: in the order of their lowest numbers, and ascending.
    pub fn sort<T: Copy>(&mut self, things: &[T]) -> Vec<Vec<T>> {
        let mut sets: Vec<Vec<T>> = Vec::new();
        let mut set_of = vec![0; self.count()];
        for (number, &thing) in things.iter().enumerate() {
            let lowest = self.lowest(number);
            if lowest == number {
                set_of[number] = sets.len();
                sets.push(Vec::new());
            }
            sets[set_of[lowest]].push(thing);
        }
        sets
    }

    /// Makes one set of those of two numbers.
    pub fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.lowest(a), self.lowest(b));
        self.lower[a.max(b)] = a.min(b);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sets_that_were_joined_have_one_lowest_number() {
        let mut sets = DisjointSets::new(5);
        assert_eq!(sets.add(), 5);
        for (a, b) in [(4, 3), (1, 5), (3, 5)] {
            sets.join(a, b);
        }
        let lowest: Vec<usize> = (0..6).map(|number| sets.lowest(number)).collect();
        assert_eq!(lowest, [0, 1, 2, 1, 1, 1]);
        let sorted = sets.sort(&['a', 'b', 'c', 'd', 'e', 'f']);
        assert_eq!(sorted, [&['a'][..], &['b', 'd', 'e', 'f'], &['c']]);
    }
}
