//! Union-find: disjoint sets that can be merged but not split.

/// Disjoint sets of the numbers 0, 1, 2, …
#[derive(Clone, Debug, Default)]
pub struct DisjointSets {
    /// For each number, a lower number of its set; for the lowest number of a set, the number itself.
    lower: Vec<usize>,
}

impl DisjointSets {
    /// Creates the numbers below `count`, each in a set of its own.
    pub fn new(count: usize) -> Self {
        let lower = (0..count).collect();
        Self { lower }
    }

    /// Returns how many numbers there are in all sets together.
    pub fn count(&self) -> usize {
        self.lower.len()
    }

    /// Adds the next number, in a set of its own, and returns the number.
    pub fn add(&mut self) -> usize {
        self.lower.push(self.lower.len());
        self.lower.len() - 1
    }

    /// Returns the lowest number of the set that contains `number`. The result identifies the set, because it
    /// is equal for all numbers of a set.
    pub fn lowest(&mut self, mut number: usize) -> usize {
        while self.lower[number] != number {
            self.lower[number] = self.lower[self.lower[number]];
            number = self.lower[number];
        }
        number
    }

    /// Groups `things` by set, where `things[n]` belongs to the number n. The groups are ordered by the
    /// lowest number of their set, and the things within a group by their numbers.
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

    /// Merges the sets of two numbers.
    pub fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.lowest(a), self.lowest(b));
        self.lower[a.max(b)] = a.min(b);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn disjoint_sets_share_lowest_number_after_join() {
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
