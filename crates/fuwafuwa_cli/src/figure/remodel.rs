//! How a crack changes the elements: the phases of remodelling, and when a child is generated.
//!
//! A square of 14 voxels is cut upwards along its middle, one node at a time:
//!
//! ```text
//!   ┌───────┬───────┐        A parent on each side loses the child beside the crack: first those
//!   │   2   │   2   │        of level 1, whose children are voxels, then those of level 2, whose
//!   │       ┆       │        children are of level 1.
//!   └───────┃───────┘
//! ```

use crate::painter::{Frame, Painter, Role, Sample, letters};
use crate::stage;
use anyhow::Result;
use fuwafuwa::dim::{Dim, add, scale};
use fuwafuwa::mesh::Element;
use fuwafuwa::pyramid::Cell;
use fuwafuwa::stencil::slot_at;
use fuwafuwa::view::ElementView;
use fuwafuwa::{Body, Dim2, Material, Point, VoxelGrid};
use std::collections::{BTreeMap, BTreeSet};

/// Voxels across the square and the empty rim around it, which seats it like the disc of figure 1.
const ACROSS: i32 = 16;
/// Where the crack runs.
const MIDDLE: i32 = 8;
/// The octants to the right of a lattice point.
const RIGHT: u8 = 0b1010;
/// How far the crack gapes on each side at its mouth, in voxels a voxel of its length.
const GAPE: f32 = 0.16;

/// The square before and after one release.
struct Release {
    before: Body<Dim2>,
    after: Body<Dim2>,
    /// The height of the node that is released.
    height: i32,
}

impl Release {
    /// Releases the node at a height, those below it having been released before.
    fn at(height: i32) -> Result<Self> {
        let solid = 1..ACROSS - 1;
        let size = [ACROSS as usize, ACROSS as usize, 1];
        let grid = VoxelGrid::from_fn(size, 1.0, |at| {
            u8::from(solid.contains(&at[0]) && solid.contains(&at[1]))
        })?;
        let mut before = Body::<Dim2>::new(grid, &[Material::default()])?;
        for y in 1..height {
            before.release(&[([MIDDLE, y, 0], RIGHT)])?;
        }
        let mut after = before.clone();
        after.release(&[([MIDDLE, height, 0], RIGHT)])?;
        gape(&mut before, height);
        gape(&mut after, height);
        Ok(Self {
            before,
            after,
            height,
        })
    }

    /// The same, the new crack open as well.
    fn opened(&self) -> Body<Dim2> {
        let mut body = self.after.clone();
        gape(&mut body, self.height + 1);
        body
    }

    /// Cells that have an element before and another one, or none, afterwards.
    fn parents(&self) -> BTreeSet<Cell> {
        let after = filled(&self.after);
        let changed =
            |(cell, children): (Cell, u8)| (after.get(&cell) != Some(&children)).then_some(cell);
        filled(&self.before)
            .into_iter()
            .filter_map(changed)
            .collect()
    }

    /// Cells that have an element only afterwards.
    fn children(&self) -> BTreeSet<Cell> {
        let before = filled(&self.before);
        let cells = filled(&self.after).into_keys();
        cells.filter(|cell| !before.contains_key(cell)).collect()
    }
}

/// Figure 3: what remodelling does, phase by phase.
pub fn phases() -> Result<Painter> {
    const PANEL: f32 = 348.0;
    let release = Release::at(2)?;
    let (parents, children) = (release.parents(), release.children());
    let nodes_before: BTreeSet<Point> = points(&release.before);
    let nodes_after: BTreeSet<Point> = points(&release.after);
    let made: BTreeMap<Point, [f32; 3]> = views(&release.before, &parents)
        .into_iter()
        .flat_map(|(element, view)| slots_of(element, &view))
        .filter(|(at, _)| !nodes_before.contains(at))
        .collect();

    let mut painter = Painter::new(1160, 890);
    let frame = |k: usize| {
        let (column, row) = ((k % 3) as f32, (k / 3) as f32);
        Frame {
            origin: [22.0 + 374.0 * column, 430.0 + 426.0 * row],
            unit: PANEL / ACROSS as f32,
        }
    };
    let opened = release.opened();
    let titles = [
        [
            "a shared node is released",
            "parents: their elements must change",
        ],
        ["1a  mid nodes are made", "all that the parents can have"],
        [
            "1b  children are generated",
            "small ones beside the crack first",
        ],
        ["2c  mid nodes are deleted", "where no child has a corner"],
        [
            "2d  parents are rebuilt",
            "around the children they gave up",
        ],
    ];
    for (k, [title, detail]) in titles.iter().enumerate() {
        let [x, y] = frame(k).origin;
        let left = x + PANEL / ACROSS as f32;
        painter.text([left, y - 391.0], 16.0, Role::Ink, title);
        painter.text([left, y - 363.0], 12.5, Role::Faded, detail);
    }
    for k in 0..4 {
        draw(&mut painter, frame(k), &release.before);
    }
    draw(&mut painter, frame(4), &opened);
    for k in 0..4 {
        mark(
            &mut painter,
            frame(k),
            &release.before,
            &parents,
            Role::Marked,
        );
    }
    for k in 2..4 {
        for (_, view) in views(&release.after, &children) {
            stage::plane_element(&mut painter, frame(k), &view, 1.2);
        }
        mark(
            &mut painter,
            frame(k),
            &release.after,
            &children,
            Role::Added,
        );
    }
    mark(&mut painter, frame(4), &opened, &parents, Role::Marked);
    mark(&mut painter, frame(4), &opened, &children, Role::Added);
    for k in 0..5 {
        let body = if k < 4 { &release.before } else { &opened };
        draw_nodes(&mut painter, frame(k), body);
    }
    let tip = [MIDDLE as f32, release.height as f32, 0.0];
    painter.bright_dot(frame(0).spot(tip), 6.0, Role::Removed);
    for k in 1..4 {
        for (at, &place) in &made {
            let spot = frame(k).spot(place);
            if k == 3 && !nodes_after.contains(at) {
                painter.cross(spot, 4.6, Role::Removed);
            } else {
                painter.bright_dot(spot, 4.6, Role::Added);
            }
        }
    }
    for (id, node) in opened.mesh().nodes() {
        if made.contains_key(&node.at) {
            painter.bright_dot(frame(4).spot(opened.node_state(id).0), 4.6, Role::Added);
        }
    }
    let [x, y] = frame(5).origin;
    let entries: [(Sample, &str); 8] = [
        (Sample::Area(Role::Level(0), Role::Edge), "level 0"),
        (Sample::Area(Role::Level(1), Role::Edge), "level 1"),
        (Sample::Area(Role::Level(2), Role::Edge), "level 2"),
        (Sample::Area(Role::Paper, Role::Marked), "parent"),
        (Sample::Area(Role::Paper, Role::Added), "child"),
        (Sample::Dot(Role::Removed), "node that is released"),
        (Sample::Dot(Role::Added), "mid node made"),
        (Sample::Cross(Role::Removed), "mid node deleted"),
    ];
    for (k, entry) in entries.iter().enumerate() {
        let at = [x + 50.0, y - 322.0 + 38.0 * k as f32];
        painter.entries(at, std::slice::from_ref(entry));
    }
    Ok(painter)
}

/// Figure 4: when a child is generated.
pub fn conditions() -> Result<Painter> {
    let mut painter = Painter::new(1120, 736);
    let voxel = Release::at(1)?;
    let frame = frame_of(0, 0);
    title(
        &mut painter,
        frame,
        "a  parent of level 1",
        "a corner of the child has lost part of its connection",
    );
    draw(&mut painter, frame, &voxel.before);
    let parent = Cell {
        level: 1,
        at: [MIDDLE / 2 - 1, 1, 0],
    };
    mark(
        &mut painter,
        frame,
        &voxel.before,
        &[parent].into(),
        Role::Marked,
    );
    let child = [MIDDLE - 1, 2, 0];
    square(&mut painter, frame, child, 1);
    draw_nodes(&mut painter, frame, &voxel.before);
    let inner = scale(add(parent.at, [0; 3]), 2);
    for at in [child, add(child, [1, 0, 0]), add(child, [1, 1, 0])] {
        debug_assert_ne!(
            at,
            add(inner, [1, 1, 0]),
            "the parent's middle does not count"
        );
        let front = voxel.after.sharing().is_front(at);
        let role = if front { Role::Removed } else { Role::Added };
        painter.bright_dot(frame.spot(at.map(|k| k as f32)), 6.5, role);
    }
    released(&mut painter, frame, voxel.height);

    let coarse = Release::at(2)?;
    let frame = frame_of(1, 0);
    title(
        &mut painter,
        frame,
        "b  parent of level 2",
        "the child touches an element two levels below the parent",
    );
    draw(&mut painter, frame, &coarse.before);
    let parent = Cell {
        level: 2,
        at: [MIDDLE / 4 - 1, 1, 0],
    };
    mark(
        &mut painter,
        frame,
        &coarse.before,
        &[parent].into(),
        Role::Marked,
    );
    square(&mut painter, frame, [MIDDLE - 2, 4, 0], 2);
    let near = Cell {
        level: 0,
        at: [MIDDLE - 1, 3, 0],
    };
    for (_, view) in views(&coarse.after, &[near].into()) {
        stage::plane_element(&mut painter, frame, &view, 1.2);
        painter.ring(stage::outline(frame, &view), 4.0, Role::Removed);
    }
    draw_nodes(&mut painter, frame, &coarse.before);
    released(&mut painter, frame, coarse.height);

    let entries = [
        (Sample::Area(Role::Paper, Role::Marked), "parent"),
        (Sample::Area(Role::Fresh, Role::Added), "child in question"),
        (Sample::Cross(Role::Removed), "node that is released"),
    ];
    painter.legend(638.0, &entries);
    let entries = [
        (Sample::Dot(Role::Added), "corner that is connected"),
        (Sample::Dot(Role::Removed), "corner that is not"),
        (
            Sample::Area(Role::Level(0), Role::Removed),
            "element two levels below",
        ),
    ];
    painter.legend(682.0, &entries);
    Ok(painter)
}

/// Figure 5: children generated and parents rebuilt, before and after a release.
pub fn children() -> Result<Painter> {
    let mut painter = Painter::new(1120, 1260);
    for (row, height) in [1, 2].into_iter().enumerate() {
        let release = Release::at(height)?;
        let (parents, children) = (release.parents(), release.children());
        let frame = frame_of(0, row);
        let name = ["a", "b"][row];
        title(
            &mut painter,
            frame,
            &format!("{name}  before"),
            "parents outlined",
        );
        draw(&mut painter, frame, &release.before);
        mark(&mut painter, frame, &release.before, &parents, Role::Marked);
        draw_nodes(&mut painter, frame, &release.before);
        released(&mut painter, frame, height);

        let (frame, after) = (frame_of(1, row), release.opened());
        let detail = "new children in blue, rebuilt parents in black";
        title(&mut painter, frame, &format!("{name}  after"), detail);
        draw(&mut painter, frame, &after);
        mark(&mut painter, frame, &after, &parents, Role::Marked);
        mark(&mut painter, frame, &after, &children, Role::Added);
        draw_nodes(&mut painter, frame, &after);
        let (old, new) = (points(&release.before), points(&after));
        for (id, node) in after.mesh().nodes() {
            let spot = frame.spot(after.node_state(id).0);
            if !old.contains(&node.at) {
                painter.bright_dot(spot, 5.0, Role::Added);
            } else if node.at == [MIDDLE, height, 0] {
                painter.bright_dot(spot, 5.0, Role::Removed);
            }
        }
        for at in old.difference(&new) {
            painter.cross(frame.spot(at.map(|k| k as f32)), 5.0, Role::Removed);
        }
    }
    let entries = [
        (Sample::Area(Role::Paper, Role::Marked), "parent"),
        (Sample::Area(Role::Paper, Role::Added), "new child"),
        (Sample::Cross(Role::Removed), "node that is released"),
        (Sample::Dot(Role::Removed), "its two halves"),
        (Sample::Dot(Role::Added), "new node"),
    ];
    painter.legend(1206.0, &entries);
    Ok(painter)
}

/// The frames of figures 4 and 5, which show the lower part of the square.
fn frame_of(column: usize, row: usize) -> Frame {
    Frame {
        origin: [6.0 + 560.0 * column as f32, 612.0 + 590.0 * row as f32],
        unit: 34.0,
    }
}

fn title(painter: &mut Painter, frame: Frame, text: &str, detail: &str) {
    let [x, y] = [
        frame.origin[0] + frame.unit,
        frame.origin[1] - 15.0 * frame.unit,
    ];
    painter.text([x, y - 64.0], 17.0, Role::Ink, text);
    painter.text([x, y - 32.0], 13.0, Role::Faded, detail);
    debug_assert!(letters::width(13.0, detail) < 14.5 * frame.unit, "{detail}");
}

fn released(painter: &mut Painter, frame: Frame, height: i32) {
    let at = [MIDDLE as f32, height as f32, 0.0];
    painter.cross(frame.spot(at), 6.5, Role::Removed);
}

fn draw(painter: &mut Painter, frame: Frame, body: &Body<Dim2>) {
    for view in body.element_views() {
        stage::plane_element(painter, frame, &view, 1.2);
    }
}

fn draw_nodes(painter: &mut Painter, frame: Frame, body: &Body<Dim2>) {
    for (id, _) in body.mesh().nodes() {
        let spot = frame.spot(body.node_state(id).0);
        painter.dot(spot, 0.1 * frame.unit, Role::Node);
    }
}

/// A child that is not there yet.
fn square(painter: &mut Painter, frame: Frame, low: Point, width: i32) {
    let corners = [[0, 0, 0], [width, 0, 0], [width, width, 0], [0, width, 0]];
    let spots = corners.map(|by| frame.spot(add(low, by).map(|k| k as f32)));
    painter.polygon(spots.to_vec(), Role::Fresh, Role::Added, 4.0);
}

/// Outlines the elements of some cells.
fn mark(
    painter: &mut Painter,
    frame: Frame,
    body: &Body<Dim2>,
    cells: &BTreeSet<Cell>,
    role: Role,
) {
    for (_, view) in views(body, cells) {
        painter.ring(stage::outline(frame, &view), 4.0, role);
    }
}

/// The elements of some cells, each with its view.
fn views<'a>(body: &'a Body<Dim2>, cells: &BTreeSet<Cell>) -> Vec<(&'a Element, ElementView)> {
    let pairs = body.mesh().elements().zip(body.element_views());
    let wanted = pairs.filter(|((_, element), _)| cells.contains(&element.cell));
    wanted.map(|((_, element), view)| (element, view)).collect()
}

/// The lattice points of all slots of an element, and where they are.
fn slots_of(element: &Element, view: &ElementView) -> Vec<(Point, [f32; 3])> {
    let (low, half) = (element.cell.first_voxel(), element.cell.width() / 2);
    let place = |slot: usize| (add(low, scale(slot_at(slot), half)), view.slots[slot]);
    stage::slots(view.level, view.children)
        .into_iter()
        .map(place)
        .collect()
}

/// The cells that have elements, and the children these fill.
fn filled(body: &Body<Dim2>) -> BTreeMap<Cell, u8> {
    let mut filled = BTreeMap::new();
    for (_, element) in body.mesh().elements() {
        *filled.entry(element.cell).or_insert(0) |= element.children;
    }
    filled
}

fn points(body: &Body<Dim2>) -> BTreeSet<Point> {
    body.mesh().nodes().map(|(_, node)| node.at).collect()
}

/// Opens the crack below a height like a wedge, so that it can be seen.
fn gape(body: &mut Body<Dim2>, height: i32) {
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
        let rest = node.at.map(|k| k as f32);
        body.set_node_state(id, [rest[0] + side * open, rest[1], 0.0], [0.0; 3]);
    }
}
