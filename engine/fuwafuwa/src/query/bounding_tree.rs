//! Bounding-volume hierarchy for queries.

use crate::rigid_body::solid::Bounds;
use glam::Vec3;
use std::ops::Range;

/// Maximum number of boxes in a leaf. Smaller leaves make queries faster and construction slower.
const LEAF: usize = 4;

/// Margin of a box around its content, as a share of its widest side: ten times the tolerance 10⁻⁴ of the
/// intersection tests.
const MARGIN: f32 = 1e-3;
/// Additional margin of a box, as a share of its largest absolute coordinate: about eight rounding errors of
/// single precision.
const ROUNDING: f32 = 1e-6;

/// Limit for refitting. If the summed widths of all nodes exceed this multiple of their sum at construction,
/// the tree should be rebuilt. Rotation alone increases the widths of a box by up to √3.
const MAX_GROWTH: f32 = 2.0;

/// Empty box: its lower corner is above its upper corner.
const EMPTY: Bounds = [Vec3::INFINITY, Vec3::NEG_INFINITY];

/// Bounding-volume hierarchy over a list of boxes, which are identified by their index in the list.
///
/// The shape of the tree does not affect the results of a search. The cost of a box never exceeds the cost of
/// a box inside it, not even by rounding, and every item is checked against its own box.
#[derive(Clone, Debug, Default)]
pub struct Tree {
    /// Nodes of the tree; a parent precedes its children.
    nodes: Vec<TreeNode>,
    /// Boxes of the list, sorted so that each leaf holds a contiguous range.
    items: Vec<TreeItem>,
    /// Sum of the widths of all nodes along all axes when the tree was built [m].
    built_width: f32,
}

#[derive(Clone, Debug)]
struct TreeNode {
    bounds: Bounds,
    /// Range of `Tree::items` that a leaf holds; empty for an inner node.
    leaf: Range<u32>,
    /// Indices of both children in `Tree::nodes`; unused in a leaf.
    children: [u32; 2],
}

#[derive(Clone, Debug)]
struct TreeItem {
    bounds: Bounds,
    /// Index of the box in the list from which the tree was built.
    index: u32,
}

impl Tree {
    /// Builds the hierarchy over boxes.
    pub fn new(boxes: &[Bounds]) -> Self {
        let items = boxes.iter().zip(0..);
        let items = items.map(|(&bounds, index)| TreeItem { bounds, index });
        let mut tree = Self {
            nodes: Vec::new(),
            items: items.collect(),
            built_width: 0.0,
        };
        if !boxes.is_empty() {
            tree.grow(0..boxes.len());
        }
        tree.built_width = tree.width();
        tree
    }

    /// Adds a node over a range of `items`, and below it all its descendants. Returns the index of the node.
    fn grow(&mut self, range: Range<usize>) -> u32 {
        let items = &mut self.items[range.clone()];
        let bounds = around_items(items);
        let node = self.nodes.len() as u32;
        self.nodes.push(TreeNode {
            bounds,
            leaf: 0..0,
            children: [0; 2],
        });
        if range.len() <= LEAF {
            self.nodes[node as usize].leaf = range.start as u32..range.end as u32;
            return node;
        }
        let extent = |axis: usize| bounds[1][axis] - bounds[0][axis];
        let axis = (0..3).fold(0, |widest, axis| {
            if extent(axis) > extent(widest) {
                axis
            } else {
                widest
            }
        });
        let middle = |item: &TreeItem| {
            let [low, high] = item.bounds;
            low[axis] + high[axis]
        };
        let half = range.len() / 2;
        items.select_nth_unstable_by(half, |a, b| {
            let order = middle(a).total_cmp(&middle(b));
            order.then(a.index.cmp(&b.index))
        });
        let half = range.start + half;
        let children = [range.start..half, half..range.end].map(|part| self.grow(part));
        self.nodes[node as usize].children = children;
        node
    }

    /// Replaces the boxes by new ones, given in the same order, and keeps the hierarchy. Returns false if the
    /// nodes have become so wide that searches would be slow; the caller should then build a new tree.
    pub fn refit(&mut self, boxes: &[Bounds]) -> bool {
        for item in &mut self.items {
            item.bounds = boxes[item.index as usize];
        }
        for node in (0..self.nodes.len()).rev() {
            let TreeNode { leaf, children, .. } = &self.nodes[node];
            let bounds = match leaf.is_empty() {
                true => {
                    let [a, b] = children.map(|child| self.nodes[child as usize].bounds);
                    around(a, b)
                }
                false => around_items(&self.items[leaf.start as usize..leaf.end as usize]),
            };
            self.nodes[node].bounds = bounds;
        }
        let width = self.width();
        width <= MAX_GROWTH * self.built_width
    }

    /// Returns the sum of the widths of all nodes along all axes [m].
    fn width(&self) -> f32 {
        let widths = |node: &TreeNode| {
            let [low, high] = node.bounds;
            (0..3).map(|axis| high[axis] - low[axis]).sum::<f32>()
        };
        self.nodes.iter().map(widths).sum()
    }

    /// Visits the items whose boxes have a finite cost of at most `limit`. `visit` receives the index of an
    /// item and the cost of its box, and returns the cost of the item itself. After each visit, the limit
    /// falls to the returned cost if it is lower. `cost` must not be larger for a box than for a box inside
    /// it.
    pub fn search(
        &self,
        mut limit: f32,
        cost: impl Fn(&Bounds) -> f32,
        mut visit: impl FnMut(usize, f32) -> f32,
    ) {
        // Boxes with a NaN cost are skipped, because comparisons with NaN are false.
        let counts = |cost: f32, limit: f32| cost <= limit && cost < f32::INFINITY;
        let Some(root) = self.nodes.first() else {
            return;
        };
        let mut stack = vec![(0, cost(&root.bounds))];
        while let Some((node, at_least)) = stack.pop() {
            if !counts(at_least, limit) {
                continue;
            }
            let TreeNode { leaf, children, .. } = &self.nodes[node as usize];
            for item in &self.items[leaf.start as usize..leaf.end as usize] {
                let own = cost(&item.bounds);
                if counts(own, limit) {
                    limit = limit.min(visit(item.index as usize, own));
                }
            }
            if leaf.is_empty() {
                let [a, b] =
                    children.map(|child| (child, cost(&self.nodes[child as usize].bounds)));
                // Pushes the cheaper child last onto the stack, so that it is visited first.
                let ordered = if b.1 < a.1 { [a, b] } else { [b, a] };
                stack.extend(ordered.into_iter().filter(|child| counts(child.1, limit)));
            }
        }
    }
}

fn around_items(items: &[TreeItem]) -> Bounds {
    let bounds = items.iter().map(|item| item.bounds);
    bounds.reduce(around).unwrap_or(EMPTY)
}

/// Returns the smallest box that contains two boxes.
pub fn around([a, b]: Bounds, [c, d]: Bounds) -> Bounds {
    let low = [0, 1, 2].map(|axis: usize| a[axis].min(c[axis]));
    let high = [0, 1, 2].map(|axis: usize| b[axis].max(d[axis]));
    [low.into(), high.into()]
}

/// Returns the smallest box that contains all points, enlarged by a margin against rounding.
pub fn around_all(points: impl IntoIterator<Item = Vec3>) -> Bounds {
    let points = points.into_iter();
    with_margin(points.fold(EMPTY, |bounds, at| around(bounds, [at, at])))
}

/// Returns a box enlarged by a margin against rounding.
pub fn with_margin([low, high]: Bounds) -> Bounds {
    if low[0] > high[0] {
        return EMPTY;
    }
    let widths = high - low;
    let largest = low.abs().max(high.abs()).max_element();
    let margin = MARGIN * widths.max_element().max(0.0) + ROUNDING * largest;
    [low - Vec3::splat(margin), high + Vec3::splat(margin)]
}

/// Returns whether two boxes overlap.
pub fn overlap([a, b]: &Bounds, [c, d]: &Bounds) -> bool {
    (0..3).all(|axis| a[axis] <= d[axis] && c[axis] <= b[axis])
}

/// Returns the distance of a point from a box [m]; 0 inside.
pub fn distance_from([low, high]: &Bounds, at: Vec3) -> f32 {
    let beyond = |axis: usize| (low[axis] - at[axis]).max(at[axis] - high[axis]).max(0.0);
    Vec3::from([0, 1, 2].map(beyond)).length()
}

/// Returns the distance along a ray to the point where it enters a box, in multiples of the length of
/// `direction`. Returns 0 if the ray starts inside, and infinity if it misses the box.
pub fn entry([low, high]: &Bounds, from: Vec3, direction: Vec3) -> f32 {
    let (mut first, mut last) = (0.0f32, f32::INFINITY);
    for axis in 0..3 {
        if direction[axis] == 0.0 {
            if from[axis] < low[axis] || from[axis] > high[axis] {
                return f32::INFINITY;
            }
            continue;
        }
        let [one, other] = [low, high].map(|corner| (corner[axis] - from[axis]) / direction[axis]);
        first = first.max(one.min(other));
        last = last.min(one.max(other));
    }
    if first <= last { first } else { f32::INFINITY }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scattered(count: usize) -> Vec<Bounds> {
        let places = (0..count).map(|k| {
            let at = |step: usize| (k * step % 101) as f32;
            Vec3::new(at(37), at(53), at(71))
        });
        places.map(|at| [at, at]).collect()
    }

    /// Returns the distance from `goal` to the nearest box, and the number of items that the search visited.
    fn nearest(tree: &Tree, boxes: &[Bounds], goal: Vec3) -> (f32, usize) {
        let (mut best, mut visited) = (f32::INFINITY, 0);
        tree.search(
            f32::INFINITY,
            |bounds| distance_from(bounds, goal),
            |index, _| {
                visited += 1;
                best = best.min(distance_from(&boxes[index], goal));
                best
            },
        );
        (best, visited)
    }

    #[test]
    fn search_finds_the_nearest_box_in_few_visits() {
        let boxes = scattered(500);
        let tree = Tree::new(&boxes);
        for goal in [[0.0; 3], [50.0, 20.0, 90.0], [-7.0, 300.0, 3.0]].map(Vec3::from) {
            let (best, visited) = nearest(&tree, &boxes, goal);
            let all = boxes.iter().map(|bounds| distance_from(bounds, goal));
            assert_eq!(best, all.fold(f32::INFINITY, f32::min));
            assert!(visited < 100, "{visited}");
        }
        Tree::new(&[]).search(
            1.0,
            |_| 0.0,
            |_, _| panic!("an empty tree has no boxes to visit"),
        );
    }

    #[test]
    fn refit_finds_the_nearest_box_after_moves() {
        let boxes = scattered(500);
        let mut tree = Tree::new(&boxes);
        let shifted = boxes
            .iter()
            .map(|bounds| bounds.map(|at| Vec3::splat(2.0) - at));
        let shifted: Vec<Bounds> = shifted.map(|[a, b]| around([a, a], [b, b])).collect();
        assert!(tree.refit(&shifted));
        for goal in [[0.0; 3], [-50.0, -20.0, -90.0]].map(Vec3::from) {
            let (best, visited) = nearest(&tree, &shifted, goal);
            let all = shifted.iter().map(|bounds| distance_from(bounds, goal));
            assert_eq!(best, all.fold(f32::INFINITY, f32::min));
            assert!(visited < 100, "{visited}");
        }
        // Boxes in another order make the refitted nodes wide, but searches must stay correct.
        let shuffled: Vec<Bounds> = (0..500).map(|k| boxes[k * 7 % 500]).collect();
        assert!(!tree.refit(&shuffled));
        let (best, _) = nearest(&tree, &shuffled, Vec3::ZERO);
        let all = shuffled
            .iter()
            .map(|bounds| distance_from(bounds, Vec3::ZERO));
        assert_eq!(best, all.fold(f32::INFINITY, f32::min));
    }

    #[test]
    fn entry_returns_distance_or_infinity() {
        let bounds = [Vec3::new(1.0, -1.0, 0.0), Vec3::new(2.0, 1.0, 0.0)];
        assert_eq!(entry(&bounds, Vec3::ZERO, Vec3::X), 1.0);
        assert_eq!(entry(&bounds, Vec3::new(1.5, 0.0, 0.0), Vec3::Y), 0.0);
        assert_eq!(entry(&bounds, Vec3::ZERO, Vec3::NEG_X), f32::INFINITY);
        assert_eq!(
            entry(&bounds, Vec3::new(0.0, 2.0, 0.0), Vec3::X),
            f32::INFINITY
        );
    }
}
