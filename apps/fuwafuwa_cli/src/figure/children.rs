//! Figures 4 and 5: conditions for generating a child element, and the resulting changes.

use super::square::{MIDDLE, Release, draw, draw_nodes, mark, points, position_of, views};
use anyhow::Result;
use fuwafuwa::Point;
use fuwafuwa::inspect::{Cell, add};
use fuwafuwa_painter::worlds;
use fuwafuwa_painter::{Painter, PaperTransform, Role, Sample};

/// Draws figure 4: the conditions for generating a child element.
pub fn conditions() -> Result<Painter> {
    let mut painter = Painter::new(1120, 736);
    let voxel = Release::at(1)?;
    let parent = Cell {
        level: 1,
        at: [MIDDLE / 2 - 1, 1, 0],
    };
    let detail = "a corner of the child has lost part of its connection";
    let frame = parent_panel(&mut painter, 0, "a", detail, &voxel, parent);
    let child = [MIDDLE - 1, 2, 0];
    square(&mut painter, frame, child, 1);
    draw_nodes(&mut painter, frame, &voxel.before);
    for at in [child, add(child, [1, 0, 0]), add(child, [1, 1, 0])] {
        let front = voxel.after.connectivity().is_open(at);
        let role = if front { Role::Removed } else { Role::Added };
        painter.bright_dot(frame.spot(position_of(at)), 6.5, role);
    }
    released(&mut painter, frame, voxel.height);

    let coarse = Release::at(2)?;
    let parent = Cell {
        level: 2,
        at: [MIDDLE / 4 - 1, 1, 0],
    };
    let detail = "the child touches an element two levels below the parent";
    let frame = parent_panel(&mut painter, 1, "b", detail, &coarse, parent);
    square(&mut painter, frame, [MIDDLE - 2, 4, 0], 2);
    let near = Cell {
        level: 0,
        at: [MIDDLE - 1, 3, 0],
    };
    for (_, view) in views(&coarse.after, &[near].into()) {
        worlds::plane_element(&mut painter, frame, &view, 1.2);
        painter.ring(worlds::outline(frame, &view), 4.0, Role::Removed);
    }
    draw_nodes(&mut painter, frame, &coarse.before);
    released(&mut painter, frame, coarse.height);

    let entries = [
        (Sample::Area(Role::Paper, Role::Marked), "parent"),
        (
            Sample::Area(Role::TornSurface, Role::Added),
            "child in question",
        ),
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

/// Draws the title of a panel of figure 4, the body before a release, and the outline of the parent.
fn parent_panel(
    painter: &mut Painter,
    column: usize,
    name: &str,
    detail: &str,
    release: &Release,
    parent: Cell,
) -> PaperTransform {
    let frame = frame_of(column, 0);
    let text = format!("{name}  parent of level {}", parent.level);
    title(painter, frame, &text, detail);
    draw(painter, frame, &release.before);
    mark(
        painter,
        frame,
        &release.before,
        &[parent].into(),
        Role::Marked,
    );
    frame
}

/// Draws figure 5: new children and rebuilt parents, before and after a release.
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

        let (frame, after) = (frame_of(1, row), release.opened()?);
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
            painter.cross(frame.spot(position_of(*at)), 5.0, Role::Removed);
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

/// Returns the coordinate frame of a panel of figures 4 and 5, which show the lower part of the square.
fn frame_of(column: usize, row: usize) -> PaperTransform {
    PaperTransform {
        origin: [6.0 + 560.0 * column as f32, 612.0 + 590.0 * row as f32],
        unit: 34.0,
    }
}

fn title(painter: &mut Painter, frame: PaperTransform, text: &str, detail: &str) {
    let [x, y] = [
        frame.origin[0] + frame.unit,
        frame.origin[1] - 15.0 * frame.unit,
    ];
    painter.text([x, y - 64.0], 17.0, Role::Ink, text);
    painter.text([x, y - 32.0], 13.0, Role::Faded, detail);
}

fn released(painter: &mut Painter, frame: PaperTransform, height: i32) {
    let at = position_of([MIDDLE, height, 0]);
    painter.cross(frame.spot(at), 6.5, Role::Removed);
}

/// Draws a child that does not exist yet.
fn square(painter: &mut Painter, frame: PaperTransform, low: Point, width: i32) {
    let corners = [[0, 0, 0], [width, 0, 0], [width, width, 0], [0, width, 0]];
    let spots = corners.map(|by| frame.spot(position_of(add(low, by))));
    painter.polygon(spots.to_vec(), Role::TornSurface, Role::Added, 4.0);
}
