//! Figure 3: the phases of remodelling after a release, one panel each.

use super::square::{ACROSS, MIDDLE, Release, draw, draw_nodes, mark, points, position_of, views};
use anyhow::Result;
use fuwafuwa::inspect::{Element, add, closure, scale, slot_at};
use fuwafuwa::{Dim, Dim2, ElementView, Point, Vec3};
use fuwafuwa_painter::worlds;
use fuwafuwa_painter::{Painter, PaperTransform, Role, Sample};
use std::collections::{BTreeMap, BTreeSet};

/// Draws figure 3: remodelling, phase by phase.
pub fn phases() -> Result<Painter> {
    const PANEL: f32 = 348.0;
    let release = Release::at(2)?;
    let (parents, children) = (release.parents(), release.children());
    let nodes_before: BTreeSet<Point> = points(&release.before);
    let nodes_after: BTreeSet<Point> = points(&release.after);
    let made: BTreeMap<Point, Vec3> = views(&release.before, &parents)
        .into_iter()
        .flat_map(|(element, view)| slots_of(element, &view))
        .filter(|(at, _)| !nodes_before.contains(at))
        .collect();

    let mut painter = Painter::new(1160, 890);
    let frame = |k: usize| {
        let (column, row) = ((k % 3) as f32, (k / 3) as f32);
        PaperTransform {
            origin: [22.0 + 374.0 * column, 430.0 + 426.0 * row],
            unit: PANEL / ACROSS as f32,
        }
    };
    let opened = release.opened()?;
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
            worlds::plane_element(&mut painter, frame(k), &view, 1.2);
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
    let tip = position_of([MIDDLE, release.height, 0]);
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

/// Returns the lattice points and positions of the slots of an element's children. A slot is included with or
/// without a node.
fn slots_of(element: &Element, view: &ElementView) -> Vec<(Point, Vec3)> {
    let (low, half) = (element.cell.first_voxel(), element.cell.width() / 2);
    let place = |slot: usize| (add(low, scale(slot_at(slot), half)), view.slots[slot]);
    let filled = closure::<Dim2>(view.children);
    let slots = (0..Dim2::SLOTS).filter(|slot| filled >> slot & 1 == 1);
    slots.map(place).collect()
}
