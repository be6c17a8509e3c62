//! Ways through a room in the plane, around what stands and lies in it.

use fuwafuwa::Vector;
use fuwafuwa::vector::{length, minus, plus, scaled};
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// Width of a cell [m].
const CELL: f32 = 0.1;
/// The cost of the shortest step, so that costs are whole numbers, which have an order.
const UNIT: f32 = 10.0;

/// What a step costs everywhere in a room.
pub(super) struct Map {
    low: Vector,
    size: [usize; 2],
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
    pub(super) fn new([low, high]: [Vector; 2], cost: impl Fn(Vector) -> f32) -> Self {
        let size = [0, 1].map(|axis| ((high[axis] - low[axis]) / CELL).ceil().max(1.0) as usize);
        let costs = Vec::new();
        let mut map = Self { low, size, costs };
        map.costs = (0..size[0] * size[1])
            .map(|cell| cost(map.middle(cell)))
            .collect();
        map
    }

    /// Makes the steps costlier in a cell and those around it.
    pub(super) fn add(&mut self, at: Vector, cost: f32) {
        let cell = self.cell(at);
        self.costs[cell] += cost;
        for (next, _) in around(self.size, cell) {
            self.costs[next] += cost;
        }
    }

    /// The cheapest ways to a place.
    pub(super) fn ways_to(&self, to: Vector) -> Ways<'_> {
        let mut costs = vec![u32::MAX; self.costs.len()];
        let goal = self.cell(to);
        costs[goal] = 0;
        let mut open = BinaryHeap::from([(Reverse(0), goal)]);
        while let Some((Reverse(cost), cell)) = open.pop() {
            if cost > costs[cell] {
                continue;
            }
            for (next, distance) in around(self.size, cell) {
                let step = 0.5 * (self.costs[cell] + self.costs[next]) * distance;
                let cost = cost + (UNIT * step) as u32;
                if cost < costs[next] {
                    costs[next] = cost;
                    open.push((Reverse(cost), next));
                }
            }
        }
        let map = self;
        Ways { map, to, costs }
    }

    fn cell(&self, at: Vector) -> usize {
        let place = |axis: usize| {
            let steps = ((at[axis] - self.low[axis]) / CELL).max(0.0) as usize;
            steps.min(self.size[axis] - 1)
        };
        place(0) + place(1) * self.size[0]
    }

    fn middle(&self, cell: usize) -> Vector {
        let steps = [cell % self.size[0], cell / self.size[0]];
        let place = |axis: usize| self.low[axis] + (steps[axis] as f32 + 0.5) * CELL;
        [place(0), place(1), 0.5 * self.low[2]]
    }

    /// What it costs to go straight.
    fn straight(&self, from: Vector, to: Vector) -> f32 {
        let way = minus(to, from);
        let steps = (length(way) / CELL).ceil();
        let place = |step: usize| plus(from, scaled(way, (step as f32 + 0.5) / steps.max(1.0)));
        let cost = |step| self.costs[self.cell(place(step))];
        let sum: f32 = (0..steps as usize).map(cost).sum();
        UNIT * sum * length(way) / (CELL * steps.max(1.0))
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
            let nearer = around(self.map.size, cell).map(|(next, _)| next);
            cell = nearer.min_by_key(|&next| self.costs[next]).unwrap_or(cell);
            let spent = (self.costs[start] - self.costs[cell]) as f32;
            let place = self.map.middle(cell);
            let is_first = best.is_none();
            if is_first || self.map.straight(from, place) <= spent * 1.1 + UNIT {
                best = Some(place);
            }
        }
        best.unwrap_or(self.to)
    }
}

/// The cells next to one, and how far each is [cells].
fn around([width, height]: [usize; 2], cell: usize) -> impl Iterator<Item = (usize, f32)> {
    let (x, y) = (cell % width, cell / width);
    let columns = x.saturating_sub(1)..=(x + 1).min(width - 1);
    let cells = columns.flat_map(move |column| {
        let rows = y.saturating_sub(1)..=(y + 1).min(height - 1);
        rows.map(move |row| (column, row))
    });
    cells.filter(move |&at| at != (x, y)).map(move |at| {
        let is_slanted = at.0 != x && at.1 != y;
        (at.0 + at.1 * width, if is_slanted { 1.414 } else { 1.0 })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_way_leads_around_a_wall_and_straight_where_nothing_is() {
        let arena = [[-1.0, -1.0, 0.0], [1.0, 1.0, 0.0]];
        // A wall across the middle with a gap at the top.
        let wall = |at: Vector| at[0].abs() < 0.1 && at[1] < 0.7;
        let map = Map::new(arena, |at| if wall(at) { 1000.0 } else { 1.0 });
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
}
