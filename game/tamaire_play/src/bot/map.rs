//! Path finding for a bot's hand in a room, around obstacles and pieces.

use fuwafuwa::{Dim, Vec3};
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// Width of a path-finding cell in 2D and in 3D [m]. In 3D, cells of 0.1 m would be too many.
const CELL: [f32; 2] = [0.1, 0.15];
/// Integer cost of a step through a free cell. Costs are integers, because Rust's heap cannot order
/// floating-point numbers.
const UNIT: f32 = 10.0;

/// Grid over a room with the cost of a step through each cell.
pub(super) struct Map {
    low: Vec3,
    /// Width of a cell [m].
    cell: f32,
    /// Number of cells on each axis. An unused axis has 1 cell.
    size: [usize; 3],
    /// Cost of a step through each cell, relative to a free cell.
    costs: Vec<f32>,
}

/// Minimum cost of the way from each cell to a fixed target position.
pub(super) struct CostField<'a> {
    map: &'a Map,
    to: Vec3,
    costs: Vec<u32>,
}

impl Map {
    /// Builds the map of a room from its low to its high corner [m]. `cost` is evaluated at the centre of
    /// each cell.
    pub(super) fn new<D: Dim>([mut low, high]: [Vec3; 2], cost: impl Fn(Vec3) -> f32) -> Self {
        let cell = CELL[D::N - 2];
        let cells = ((high - low) / cell).ceil().max(Vec3::ONE);
        let mut size = cells.to_array().map(|cells| cells as usize);
        // The only cell on an unused axis must have its centre at 0.
        size[D::N..].fill(1);
        if D::N == 2 {
            low.z = -0.5 * cell;
        }
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

    /// Adds `cost` to the cell at a position and to the neighbours of the cell.
    pub(super) fn add(&mut self, at: Vec3, cost: f32) {
        let cell = self.cell(at);
        self.costs[cell] += cost;
        around(self.size, cell, |next, _| self.costs[next] += cost);
    }

    /// Returns the minimum costs of the ways from all cells to a position.
    pub(super) fn ways_to(&self, to: Vec3) -> CostField<'_> {
        self.ways(to, None)
    }

    /// Returns the next target on the cheapest path from one position to another.
    pub(super) fn next(&self, from: Vec3, to: Vec3) -> Vec3 {
        self.ways(to, Some(self.cell(from))).next(from)
    }

    /// Runs Dijkstra's algorithm from the target `to`. Stops at the cell `from`, if given. Then only costs
    /// below that cell's cost are final.
    fn ways(&self, to: Vec3, from: Option<usize>) -> CostField<'_> {
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
        CostField { map, to, costs }
    }

    fn cell(&self, at: Vec3) -> usize {
        let steps = ((at - self.low) / self.cell).max(Vec3::ZERO);
        let place = |axis: usize| (steps[axis] as usize).min(self.size[axis] - 1);
        number(self.size, [0, 1, 2].map(place))
    }

    fn middle(&self, cell: usize) -> Vec3 {
        let steps = Vec3::from(steps(self.size, cell).map(|step| step as f32));
        self.low + (steps + 0.5) * self.cell
    }

    /// Returns the cost of moving on the straight line.
    fn straight(&self, from: Vec3, to: Vec3) -> f32 {
        let way = to - from;
        let steps = (way.length() / self.cell).ceil();
        let place = |step: usize| from + way * ((step as f32 + 0.5) / steps.max(1.0));
        let cost = |step| self.costs[self.cell(place(step))];
        let sum: f32 = (0..steps as usize).map(cost).sum();
        UNIT * sum * way.length() / (self.cell * steps.max(1.0))
    }
}

impl CostField<'_> {
    /// Returns the furthest position on the cheapest path that a straight line from `from` can reach without
    /// extra cost.
    pub(super) fn next(&self, from: Vec3) -> Vec3 {
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

    /// Returns the neighbour of a cell with the lowest cost; of several equal ones, the first.
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

/// Returns the index of the cell with the coordinates `x`, `y` and `z`.
fn number(size: [usize; 3], [x, y, z]: [usize; 3]) -> usize {
    x + size[0] * (y + size[1] * z)
}

/// Returns the coordinates of the cell with an index.
fn steps(size: [usize; 3], cell: usize) -> [usize; 3] {
    let row = cell / size[0];
    [cell % size[0], row % size[1], row / size[1]]
}

/// Calls `visit` with each neighbour of a cell and its distance [cells].
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
    fn path_leads_around_a_wall_and_straight_through_free_space() {
        let arena = [Vec3::new(-1.0, -1.0, 0.0), Vec3::new(1.0, 1.0, 0.0)];
        // The test room has a wall across its centre, with a gap at the top.
        let wall = |at: Vec3| at.x.abs() < 0.1 && at.y < 0.7;
        let map = Map::new::<Dim2>(arena, |at| if wall(at) { 1000.0 } else { 1.0 });
        let to = Vec3::new(0.8, 0.0, 0.0);
        let ways = map.ways_to(to);
        assert_eq!(ways.next(Vec3::new(0.3, -0.8, 0.0)), to);
        let mut at = Vec3::new(-0.8, 0.0, 0.0);
        let mut highest = at.y;
        for _ in 0..5 {
            at = ways.next(at);
            assert!(!wall(at), "{at:?}");
            highest = at.y.max(highest);
        }
        assert_eq!(at, to);
        assert!(highest > 0.7);
    }

    #[test]
    fn path_in_3d_leads_over_a_wall() {
        let arena = [Vec3::new(-1.0, 0.0, -1.0), Vec3::new(1.0, 1.5, 1.0)];
        let wall = |at: Vec3| at.x.abs() < 0.15 && at.y < 0.8;
        let map = Map::new::<Dim3>(arena, |at| if wall(at) { 1000.0 } else { 1.0 });
        let to = Vec3::new(0.8, 0.2, 0.0);
        let ways = map.ways_to(to);
        let mut at = Vec3::new(-0.8, 0.2, 0.3);
        let mut highest = at.y;
        for _ in 0..6 {
            at = ways.next(at);
            assert!(!wall(at), "{at:?}");
            highest = at.y.max(highest);
        }
        assert_eq!(at, to);
        assert!(highest > 0.8);
    }
}
