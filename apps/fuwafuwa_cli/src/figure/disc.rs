//! Figures of a body at rest: a graded disc, its look-up table from cells to elements, and a ball cut open.

use super::legend::level_entries;
use anyhow::Result;
use fuwafuwa::inspect::{CellHierarchy, Mesh, add, corner, points_in, scale, slot_at};
use fuwafuwa::{Dim, Dim2, Dim3, Grading, Material, NodeId, Point, SoftBody, Vec3, VoxelGrid};
use fuwafuwa_painter::solid::{Camera, Scene3d};
use fuwafuwa_painter::worlds;
use fuwafuwa_painter::{Painter, PaperTransform, Role, Sample};
use std::collections::BTreeSet;

/// Voxels across the disc.
const ACROSS: usize = 32;
/// Voxels across the ball.
const BALL: usize = 32;

/// Draws figure 1: a graded disc, its elements by level and their nodes.
pub fn elements() -> Result<Painter> {
    let body = disc()?;
    let mut painter = Painter::new(1000, 1050);
    // The body is 1 m across; an empty voxel surrounds the disc.
    let frame = PaperTransform {
        origin: [20.0, 970.0],
        unit: 960.0,
    };
    for view in body.element_views() {
        worlds::plane_element(&mut painter, frame, &view, 1.7);
    }
    let hanging = hanging_nodes(body.mesh());
    for (id, _) in body.mesh().nodes() {
        let spot = frame.spot(body.node_state(id).0);
        if hanging.contains(&id) {
            painter.bright_dot(spot, 4.6, Role::MidNode);
        } else {
            painter.dot(spot, 3.4, Role::Node);
        }
    }
    let levels = body.mesh().elements_per_level().len();
    let mut entries = level_entries(levels as u8);
    entries.push((Sample::Dot(Role::Node), "node"));
    entries.push((Sample::Dot(Role::MidNode), "mid node"));
    painter.legend(998.0, &entries);
    Ok(painter)
}

/// Draws figure 2: the levels of the disc's look-up table side by side.
pub fn table() -> Result<Painter> {
    const PANEL: f32 = 288.0;
    const PITCH: [f32; 2] = [330.0, 356.0];
    let body = disc()?;
    let pyramid = CellHierarchy::new(body.grid(), body.connectivity(), Grading::Graded);
    let count = pyramid.level_count();
    let rows = count.div_ceil(3);
    let mut painter = Painter::new(1028, (PITCH[1] * rows as f32) as u32 + 96);
    for level in 0..count {
        let (column, row) = ((level % 3) as f32, (level / 3) as f32);
        let low = [40.0 + PITCH[0] * column, 74.0 + PITCH[1] * row];
        let frame = PaperTransform {
            origin: [low[0], low[1] + PANEL],
            unit: PANEL,
        };
        let cells = pyramid.cells(level as u8).count();
        let owners = body.mesh().elements_per_level();
        let owners = owners.get(level).copied().unwrap_or(0);
        painter.text(
            [low[0], low[1] - 32.0],
            16.0,
            Role::Ink,
            &format!("level {level}"),
        );
        let plural = if cells == 1 { "" } else { "s" };
        let counts = format!("{cells} cell{plural}, {owners} elements");
        painter.text([low[0] + 92.0, low[1] - 30.0], 13.0, Role::Faded, &counts);
        draw_level(&mut painter, frame, &body, &pyramid, level as u8);
    }
    let y = PITCH[1] * rows as f32 + 40.0;
    let entries = [
        (Sample::Area(Role::Paper, Role::Guide), "no cell"),
        (
            Sample::Area(Role::EmptyCell, Role::Faded),
            "cell without an element",
        ),
        (
            Sample::Area(Role::Level(1), Role::Edge),
            "cell with an element",
        ),
        (Sample::Line(Role::Ink), "outline of the body"),
    ];
    painter.legend(y, &entries);
    Ok(painter)
}

/// Draws figure 1 in 3D: a ball with the front quarter removed, elements coloured by level.
pub fn opened_ball() -> Result<Painter> {
    let (width, height) = (900, 880);
    let body = SoftBody::<Dim3>::new(VoxelGrid::ball(BALL, 1.0)?, &[Material::default()])?;
    let mut solid = Scene3d::new(Camera {
        eye: Vec3::new(2.6, 2.05, 2.9),
        target: Vec3::new(0.5, 0.43, 0.5),
        across: 1.36,
    });
    solid.floor(0.5 / BALL as f32);
    worlds::space_elements(&mut solid, &body, |view| {
        let middle = view.slots.iter().sum::<Vec3>() / view.slots.len() as f32;
        middle.z <= 0.5 || middle.x <= 0.5 && middle.y <= 0.5
    });
    let mut painter = Painter::new(width, height);
    painter.image([0.0; 2], solid.pixels(width, height)?);
    let counts = body.mesh().elements_per_level();
    let names: Vec<String> = counts
        .iter()
        .enumerate()
        .map(|(level, count)| format!("level {level}: {count}"))
        .collect();
    let entries: Vec<(Sample, &str)> = names
        .iter()
        .enumerate()
        .map(|(level, name)| {
            let sample = Sample::Area(Role::Level(level as u8), Role::Edge);
            (sample, name.as_str())
        })
        .collect();
    painter.legend(height as f32 - 58.0, &entries);
    Ok(painter)
}

fn disc() -> Result<SoftBody<Dim2>> {
    let grid = VoxelGrid::ball(ACROSS, 1.0)?;
    Ok(SoftBody::new(grid, &[Material::default()])?)
}

/// Draws one level of the table: all cell positions, the existing cells, and their elements.
fn draw_level(
    painter: &mut Painter,
    frame: PaperTransform,
    body: &SoftBody<Dim2>,
    pyramid: &CellHierarchy<Dim2>,
    level: u8,
) {
    let spot = |at: Point| frame.spot(Vec3::from(at.map(|k| k as f32)) / ACROSS as f32);
    let square = |at: Point, width: i32| {
        [0, 1, 3, 2].map(|index| spot(scale(add(at, corner(index)), width)))
    };
    let width = 1 << level;
    let last = (ACROSS as i32 - 1) >> level;
    for at in points_in([0; 3], [last, last, 0]) {
        painter.ring(square(at, width).to_vec(), 1.0, Role::Guide);
    }
    for cell in pyramid.cells(level) {
        painter.polygon(
            square(cell.at, width).to_vec(),
            Role::EmptyCell,
            Role::Faded,
            0.8,
        );
    }
    for view in body.element_views().filter(|view| view.level == level) {
        worlds::plane_element(painter, frame, &view, 1.3);
    }
    // Draws the outline of the body, so that the panels of the levels can be compared.
    for line in body.outlines() {
        let spots = line.points.iter().map(|&at| frame.spot(at)).collect();
        painter.ring(spots, 1.4, Role::Ink);
    }
}

/// Returns the hanging nodes: nodes in the middle of a side of an element. Only the finer elements beside it
/// have them as corners.
fn hanging_nodes(mesh: &Mesh<Dim2>) -> BTreeSet<NodeId> {
    let mut hanging = BTreeSet::new();
    for (_, element) in mesh.elements() {
        let slots = &mesh.element_class(element).slots;
        for (&node, &slot) in element.nodes.iter().zip(slots) {
            let at = slot_at(usize::from(slot));
            let touching = (0..Dim2::CORNERS)
                .filter(|&child| element.children >> child & 1 == 1)
                .filter(|&child| {
                    let step = |axis: usize| at[axis] - corner(child)[axis];
                    (0..2).all(|axis| (0..=1).contains(&step(axis)))
                });
            if touching.count() == 2 {
                hanging.insert(node);
            }
        }
    }
    hanging
}
