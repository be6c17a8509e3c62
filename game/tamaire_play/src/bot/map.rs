//! Ways through a room, around what stands and lies in it.

use fuwafuwa::vector::{length, minus, plus, scaled};
use fuwafuwa::{Dim, Vector};
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// Width of a cell [m] in the plane, and in space, where narrow ones would be too many.
const CELL: [f32; 2] = [0.1, 0.15];
/// The cost of the shortest step, so that costs are whole numbers, which have an order.
const UNIT: f32 = 10.0;

/// What a step costs everywhere in a room.
pub(super) struct Map {
    low: Vector,
    /// Width of a cell [m].
    cell: f32,
    /// Number of cells on each axis; 1 on one that does not count.
    size: [usize; 3],
    /// For each cell: 1 where nothing is in the way.
    costs: Vec<f32>,
}

/// What the cheapest way to a place costs from everywhere.
pub(super) struct Ways<'a> {
    map: &'a Map,
    to: Vector,
    costs: Vec<u32>,
}

impl Map {
    /// The map of a room from its low to its high corner [m] in which a step costs so much.
    pub(super) fn new<D: Dim>([mut low, high]: [Vector; 2], cost: impl Fn(Vector) -> f32) -> Self {
        let cell = CELL[D::N - 2];
        let mut size =
            [0, 1, 2].map(|axis| ((high[axis] - low[axis]) / cell).ceil().max(1.0) as usize);
        // The middle of the only cell on an axis that does not count is at 0.
        size[D::N..].fill(1);
        low[D::N..].fill(-0.5 * cell);
        let costs = Vec::new();
        let mut map = Self {
            low,
            cell,
            size,
            costs,
        };
        map.costs = (0..size.iter().product())
            .map(|cell| cost(map.middle(cell)))
            .collect();
        map
    }

    /// Makes the steps costlier in a cell and those around it.
    pub(super) fn add(&mut self, at: Vector, cost: f32) {
        let cell = self.cell(at);
        self.costs[cell] += cost;
        around(self.size, cell, |next, _| self.costs[next] += cost);
    }

    /// The cheapest ways to a place from everywhere.
    pub(super) fn ways_to(&self, to: Vector) -> Ways<'_> {
        self.ways(to, None)
    }

    /// The next goal on the cheapest way from one place to another.
    pub(super) fn next(&self, from: Vector, to: Vector) -> Vector {
        self.ways(to, Some(self.cell(from))).next(from)
    }

    /// The cheapest ways to a place; where they lead from a single cell, only what is nearer is known.
    fn ways(&self, to: Vector, from: Option<usize>) -> Ways<'_> {
        let mut costs = vec![u32::MAX; self.costs.len()];
        let goal = self.cell(to);
        costs[goal] = 0;
        let mut open = BinaryHeap::from([(Reverse(0), goal)]);
        while let Some((Reverse(cost), cell)) = open.pop() {
            if cost > costs[cell] {
                continue;
            }
            if from == Some(cell) {
                break;
            }
            around(self.size, cell, |next, distance| {
                let step = 0.5 * (self.costs[cell] + self.costs[next]) * distance;
                let cost = cost + (UNIT * step) as u32;
                if cost < costs[next] {
                    costs[next] = cost;
                    open.push((Reverse(cost), next));
                }
            });
        }
        let map = self;
        Ways { map, to, costs }
    }

    fn cell(&self, at: Vector) -> usize {
        let place = |axis: usize| {
            let steps = ((at[axis] - self.low[axis]) / self.cell).max(0.0) as usize;
            steps.min(self.size[axis] - 1)
        };
        number(self.size, [0, 1, 2].map(place))
    }

    fn middle(&self, cell: usize) -> Vector {
        let steps = steps(self.size, cell);
        [0, 1, 2].map(|axis| self.low[axis] + (steps[axis] as f32 + 0.5) * self.cell)
    }

    /// What it costs to go straight.
    fn straight(&self, from: Vector, to: Vector) -> f32 {
        let way = minus(to, from);
        let steps = (length(way) / self.cell).ceil();
        let place = |step: usize| plus(from, scaled(way, (step as f32 + 0.5) / steps.max(1.0)));
        let cost = |step| self.costs[self.cell(place(step))];
        let sum: f32 = (0..steps as usize).map(cost).sum();
        UNIT * sum * length(way) / (self.cell * steps.max(1.0))
    }
}

impl Ways<'_> {
    /// The place furthest along the way from `from` to which one can go straight.
    pub(super) fn next(&self, from: Vector) -> Vector {
        let start = self.map.cell(from);
        let straight = self.map.straight(from, self.to);
        if straight <= self.costs[start] as f32 * 1.1 + UNIT {
            return self.to;
        }
        let (mut cell, mut best) = (start, None);
        while self.costs[cell] > 0 {
            cell = self.cheapest_around(cell);
            let spent = (self.costs[start] - self.costs[cell]) as f32;
            let place = self.map.middle(cell);
            let is_first = best.is_none();
            if is_first || self.map.straight(from, place) <= spent * 1.1 + UNIT {
                best = Some(place);
            }
        }
        best.unwrap_or(self.to)
    }

    /// The first of the cheapest cells next to one.
    fn cheapest_around(&self, cell: usize) -> usize {
        let (mut cheapest, mut least) = (cell, u32::MAX);
        around(self.map.size, cell, |next, _| {
            if self.costs[next] < least {
                (cheapest, least) = (next, self.costs[next]);
            }
        });
        cheapest
    }
}

/// The number of the cell so many steps from the low corner.
fn number(size: [usize; 3], [x, y, z]: [usize; 3]) -> usize {
    x + size[0] * (y + size[1] * z)
}

/// How many steps from the low corner a cell is.
fn steps(size: [usize; 3], cell: usize) -> [usize; 3] {
    let row = cell / size[0];
    [cell % size[0], row % size[1], row / size[1]]
}

/// Visits the cells next to one, and says how far each is [cells].
fn around(size: [usize; 3], cell: usize, mut visit: impl FnMut(usize, f32)) {
    const FAR: [f32; 4] = [0.0, 1.0, 1.414, 1.732];
    let at = steps(size, cell);
    let near = |axis: usize| at[axis].saturating_sub(1)..=(at[axis] + 1).min(size[axis] - 1);
    for x in near(0) {
        for y in near(1) {
            for z in near(2) {
                let next = number(size, [x, y, z]);
                let moved = [x != at[0], y != at[1], z != at[2]];
                if next != cell {
                    visit(next, FAR[moved.map(usize::from).iter().sum::<usize>()]);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fuwafuwa::{Dim2, Dim3};

    #[test]
    fn a_way_leads_around_a_wall_and_straight_where_nothing_is() {
        let arena = [[-1.0, -1.0, 0.0], [1.0, 1.0, 0.0]];
        // A wall across the middle with a gap at the top.
        let wall = |at: Vector| at[0].abs() < 0.1 && at[1] < 0.7;
        let map = Map::new::<Dim2>(arena, |at| if wall(at) { 1000.0 } else { 1.0 });
        let ways = map.ways_to([0.8, 0.0, 0.0]);
        assert_eq!(ways.next([0.3, -0.8, 0.0]), [0.8, 0.0, 0.0]);
        let mut at = [-0.8, 0.0, 0.0];
        let mut highest = at[1];
        for _ in 0..5 {
            at = ways.next(at);
            assert!(!wall(at), "{at:?}");
            highest = at[1].max(highest);
        }
        assert_eq!(at, [0.8, 0.0, 0.0]);
        assert!(highest > 0.7);
    }

    #[test]
    fn in_space_a_way_leads_over_a_wall() {
        let arena = [[-1.0, 0.0, -1.0], [1.0, 1.5, 1.0]];
        let wall = |at: Vector| at[0].abs() < 0.15 && at[1] < 0.8;
        let map = Map::new::<Dim3>(arena, |at| if wall(at) { 1000.0 } else { 1.0 });
        let to = [0.8, 0.2, 0.0];
        let ways = map.ways_to(to);
        let mut at = [-0.8, 0.2, 0.3];
        let mut highest = at[1];
        for _ in 0..6 {
            at = ways.next(at);
            assert!(!wall(at), "{at:?}");
            highest = at[1].max(highest);
        }
        assert_eq!(at, to);
        assert!(highest > 0.8);
    }
}
