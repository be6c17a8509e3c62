//! Body of figures 3 to 5: a square of 14 voxels that is cut upwards along its middle, one node at a time:
//!
//! ```text
//!   ┌───────┬───────┐        A parent on each side loses the child beside the crack: first parents
//!   │   2   │   2   │        of level 1, whose children are voxels, then parents of level 2, whose
//!   │       ┆       │        children are of level 1.
//!   └───────┃───────┘
//! ```

use anyhow::Result;
use fuwafuwa::inspect::{Cell, Element};
use fuwafuwa::{Dim, Dim2, ElementView, Material, Point, SoftBody, Vec2, VoxelGrid};
use fuwafuwa_painter::worlds;
use fuwafuwa_painter::{Painter, PaperTransform, Role};
use std::collections::{BTreeMap, BTreeSet};

/// Voxels across the square and its empty rim together. The rim centres the square in the grid, as in figure
/// 1.
pub const ACROSS: i32 = 16;
/// Position of the crack along x [voxels].
pub const MIDDLE: i32 = 8;
/// Bit mask of the voxels to the right of a lattice point.
const RIGHT: u8 = 0b1010;
/// Displacement of each side of the crack at its mouth, relative to the length of the crack.
const GAPE: f32 = 0.16;

/// The square of figures 3 to 5, before and after the release of one node.
pub struct Release {
    /// Body before the release.
    pub before: SoftBody<Dim2>,
    /// Body after the release.
    pub after: SoftBody<Dim2>,
    /// Height of the released node [voxels].
    pub height: i32,
}

impl Release {
    /// Creates the square with all nodes of the crack below `height` released, then releases the node at
    /// `height`.
    pub fn at(height: i32) -> Result<Self> {
        let solid = 1..ACROSS - 1;
        let size = [ACROSS as usize, ACROSS as usize, 1];
        let grid = VoxelGrid::from_fn(size, 1.0, |at| {
            u8::from(solid.contains(&at[0]) && solid.contains(&at[1]))
        })?;
        let mut before = SoftBody::<Dim2>::new(grid, &[Material::default()])?;
        for y in 1..height {
            before.release(&[([MIDDLE, y, 0], RIGHT)]);
        }
        let mut after = before.clone();
        after.release(&[([MIDDLE, height, 0], RIGHT)]);
        open_crack(&mut before, height)?;
        open_crack(&mut after, height)?;
        Ok(Self {
            before,
            after,
            height,
        })
    }

    /// Returns the body after the release, with the crack opened up to its new tip.
    pub fn opened(&self) -> Result<SoftBody<Dim2>> {
        let mut body = self.after.clone();
        open_crack(&mut body, self.height + 1)?;
        Ok(body)
    }

    /// Returns the cells with elements that change or disappear in the release.
    pub fn parents(&self) -> BTreeSet<Cell> {
        let after = filled(&self.after);
        let changed =
            |(cell, children): (Cell, u8)| (after.get(&cell) != Some(&children)).then_some(cell);
        filled(&self.before)
            .into_iter()
            .filter_map(changed)
            .collect()
    }

    /// Returns the cells that have an element only after the release.
    pub fn children(&self) -> BTreeSet<Cell> {
        let before = filled(&self.before);
        let cells = filled(&self.after).into_keys();
        cells.filter(|cell| !before.contains_key(cell)).collect()
    }
}

/// Draws the elements.
pub fn draw(painter: &mut Painter, frame: PaperTransform, body: &SoftBody<Dim2>) {
    for view in body.element_views() {
        worlds::plane_element(painter, frame, &view, 1.2);
    }
}

/// Draws a dot at each node.
pub fn draw_nodes(painter: &mut Painter, frame: PaperTransform, body: &SoftBody<Dim2>) {
    for (id, _) in body.mesh().nodes() {
        let spot = frame.spot(body.node_state(id).0);
        painter.dot(spot, 0.1 * frame.unit, Role::Node);
    }
}

/// Outlines the elements in some cells.
pub fn mark(
    painter: &mut Painter,
    frame: PaperTransform,
    body: &SoftBody<Dim2>,
    cells: &BTreeSet<Cell>,
    role: Role,
) {
    for (_, view) in views(body, cells) {
        painter.ring(worlds::outline(frame, &view), 4.0, role);
    }
}

/// Returns the elements in some cells, each with its shape.
pub fn views<'a>(
    body: &'a SoftBody<Dim2>,
    cells: &BTreeSet<Cell>,
) -> Vec<(&'a Element, ElementView)> {
    let pairs = body.mesh().elements().zip(body.element_views());
    let wanted = pairs.filter(|((_, element), _)| cells.contains(&element.cell));
    wanted.map(|((_, element), view)| (element, view)).collect()
}

/// Returns all cells that have elements, with the mask of the children that these elements fill.
fn filled(body: &SoftBody<Dim2>) -> BTreeMap<Cell, u8> {
    let mut filled = BTreeMap::new();
    for (_, element) in body.mesh().elements() {
        *filled.entry(element.cell).or_insert(0) |= element.children;
    }
    filled
}

/// Returns the lattice points of the nodes.
pub fn points(body: &SoftBody<Dim2>) -> BTreeSet<Point> {
    body.mesh().nodes().map(|(_, node)| node.at).collect()
}

/// Returns the position of a lattice point at rest, in voxels.
pub fn position_of(at: Point) -> Vec2 {
    Vec2::new(at[0] as f32, at[1] as f32)
}

/// Opens the crack below `height` like a wedge, so that the crack becomes visible.
fn open_crack(body: &mut SoftBody<Dim2>, height: i32) -> Result<()> {
    let nodes: Vec<_> = body.mesh().nodes().collect();
    for (id, node) in nodes {
        let is_right = (0..Dim2::CORNERS)
            .all(|octant| node.group >> octant & 1 == 0 || RIGHT >> octant & 1 == 1);
        let side = match node.at[0] - MIDDLE {
            0 if is_right => 1.0,
            0 => -1.0,
            beside => beside.signum() as f32,
        };
        let away = (node.at[0] - MIDDLE).abs() as f32 / MIDDLE as f32;
        let open = GAPE * (height - node.at[1]).max(0) as f32 * (1.0 - away).max(0.0);
        let position = position_of(node.at) + Vec2::new(side * open, 0.0);
        body.set_node_state(id, position, Vec2::ZERO)?;
    }
    Ok(())
}
