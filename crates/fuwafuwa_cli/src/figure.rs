//! The figures of the paper, drawn from live data.

use crate::picture::{Colour, Picture, Spot, WHITE};
use anyhow::{Context, Result};
use clap::ValueEnum;
use fuwafuwa::dim::{Dim, add, corner, points_in, scale};
use fuwafuwa::mesh::Element;
use fuwafuwa::pyramid::{Cell, Grading, Pyramid};
use fuwafuwa::sharing::Sharing;
use fuwafuwa::stencil::slot_at;
use fuwafuwa::{Dim2, Mesh, Point, VoxelGrid};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// Voxels across the disc of the figures.
const ACROSS: usize = 32;

/// Which figure to draw.
#[derive(Copy, Clone, Debug, PartialEq, Eq, ValueEnum)]
pub enum Which {
    /// A graded disc: elements by level, and nodes.
    #[value(name = "1")]
    Disc,
    /// The levels of its look-up table side by side.
    #[value(name = "2")]
    Levels,
    /// Both.
    All,
}

/// Draws into a folder; returns the files written.
pub fn write(which: Which, folder: &Path) -> Result<Vec<PathBuf>> {
    std::fs::create_dir_all(folder)
        .with_context(|| format!("cannot make the folder {}", folder.display()))?;
    let disc = Disc::new()?;
    let mut written = Vec::new();
    if which != Which::Levels {
        save(&disc.elements(), &folder.join("figure_1"), &mut written)?;
    }
    if which != Which::Disc {
        save(&disc.levels(), &folder.join("figure_2"), &mut written)?;
    }
    Ok(written)
}

const INK: Colour = [0x6E, 0x4A, 0x3E];
const EDGE: Colour = [0xA8, 0x74, 0x5E];
const HANGING: Colour = [0xC9, 0x3A, 0x3A];
const FAINT: Colour = [0xEE, 0xE6, 0xDE];
const PASSED_ON: Colour = [0xF4, 0xEC, 0xE4];
const PASSED_ON_EDGE: Colour = [0xC9, 0xB4, 0xA4];

/// Warm and light, the finest level strongest.
const LEVELS: [Colour; 5] = [
    [0xF2, 0x9E, 0x86],
    [0xF8, 0xC0, 0x95],
    [0xFB, 0xDF, 0x9F],
    [0xE6, 0xE4, 0xB0],
    [0xC9, 0xDF, 0xC0],
];

/// A disc and all that follows from it.
struct Disc {
    grid: VoxelGrid<Dim2>,
    pyramid: Pyramid<Dim2>,
    mesh: Mesh<Dim2>,
}

/// Where lattice points fall on the paper.
#[derive(Copy, Clone)]
struct Frame {
    corner: Spot,
    /// Pixels a voxel.
    unit: f32,
}

impl Frame {
    fn spot(self, at: Point) -> Spot {
        [0, 1].map(|axis: usize| self.corner[axis] + at[axis] as f32 * self.unit)
    }
}

impl Disc {
    fn new() -> Result<Self> {
        let grid = VoxelGrid::ball(ACROSS, 1.0)?;
        let sharing = Sharing::new(&grid);
        let pyramid = Pyramid::new(&grid, &sharing, Grading::Graded);
        let mesh = Mesh::grade(&grid, &sharing, &pyramid)?;
        Ok(Self {
            grid,
            pyramid,
            mesh,
        })
    }

    /// Figure 1.
    fn elements(&self) -> Picture {
        let mut picture = Picture::new(1000, 1060);
        let frame = Frame {
            corner: [20.0, 10.0],
            unit: 30.0,
        };
        for (_, element) in self.mesh.elements() {
            draw_element(&mut picture, frame, element, 1.8);
        }
        let hanging = self.hanging_nodes();
        for (id, node) in self.mesh.nodes() {
            if hanging.contains(&id) {
                picture.dot(frame.spot(node.at), 5.0, HANGING, Some(WHITE));
            } else {
                picture.dot(frame.spot(node.at), 3.6, INK, None);
            }
        }
        let levels = self.mesh.elements_per_level().len();
        let mut x = 60.0;
        for level in 0..levels {
            picture.rectangle([x, 1001.0], [24.0, 24.0], colour_of(level), EDGE, 1.8);
            picture.text([x + 36.0, 1005.0], 16.0, INK, &format!("level {level}"));
            x += 150.0;
        }
        picture.dot([x + 10.0, 1013.0], 3.6, INK, None);
        picture.text([x + 26.0, 1005.0], 16.0, INK, "node");
        picture.dot([x + 130.0, 1013.0], 5.0, HANGING, None);
        picture.text([x + 146.0, 1005.0], 16.0, INK, "hanging node");
        picture
    }

    /// Figure 2.
    fn levels(&self) -> Picture {
        const PANEL: f32 = 288.0;
        const PITCH: Spot = [330.0, 360.0];
        let count = self.pyramid.level_count();
        let rows = count.div_ceil(3);
        let mut picture = Picture::new(1028, (PITCH[1] * rows as f32) as u32 + 90);
        for level in 0..count {
            let (column, row) = (level % 3, level / 3);
            let frame = Frame {
                corner: [
                    40.0 + PITCH[0] * column as f32,
                    70.0 + PITCH[1] * row as f32,
                ],
                unit: PANEL / ACROSS as f32,
            };
            let [x, y] = frame.corner;
            picture.text([x, y - 30.0], 16.0, INK, &format!("level {level}"));
            self.draw_level(&mut picture, frame, level as u8);
        }
        let y = PITCH[1] * rows as f32 + 40.0;
        let legend = [
            (40.0, WHITE, FAINT, "no cell"),
            (190.0, PASSED_ON, PASSED_ON_EDGE, "cell without element"),
            (510.0, LEVELS[0], EDGE, "cell with element"),
        ];
        for (x, fill, edge, text) in legend {
            picture.rectangle([x, y], [24.0, 24.0], fill, edge, 1.8);
            picture.text([x + 36.0, y + 4.0], 16.0, INK, text);
        }
        picture
    }

    /// The table of one level: its places, the cells that exist, and the elements they own.
    fn draw_level(&self, picture: &mut Picture, frame: Frame, level: u8) {
        let width = 1 << level;
        let last = (ACROSS as i32 - 1) >> level;
        for at in points_in([0; 3], [last, last, 0]) {
            let size = [width as f32 * frame.unit; 2];
            let low = frame.spot(scale(at, width));
            picture.rectangle(low, size, WHITE, FAINT, 1.0);
        }
        for cell in self.pyramid.cells(level) {
            let outline = outline(cell, Dim2::ALL_CORNERS);
            let spots = outline.iter().map(|&at| frame.spot(at)).collect();
            picture.polygon(spots, PASSED_ON, PASSED_ON_EDGE, 1.0);
        }
        let here = |element: &&Element| element.cell.level == level;
        for element in self
            .mesh
            .elements()
            .map(|(_, element)| element)
            .filter(here)
        {
            draw_element(picture, frame, element, 1.4);
        }
        // The body's outline ties the panels together.
        for voxel in self
            .grid
            .voxels()
            .filter(|&voxel| self.grid.is_solid(voxel))
        {
            for axis in 0..2 {
                for (side, step) in [(0, -1), (1, 1)] {
                    let mut beyond = voxel;
                    beyond[axis] += step;
                    if self.grid.is_solid(beyond) {
                        continue;
                    }
                    let mut from = voxel;
                    from[axis] += side;
                    let mut to = from;
                    to[1 - axis] += 1;
                    picture.line(vec![frame.spot(from), frame.spot(to)], 1.4, INK);
                }
            }
        }
    }

    /// Nodes in the middle of a straight side of some element.
    fn hanging_nodes(&self) -> BTreeSet<u32> {
        let mut hanging = BTreeSet::new();
        for (_, element) in self.mesh.elements() {
            let slots = &self.mesh.stencil(element).slots;
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
}

fn colour_of(level: usize) -> Colour {
    LEVELS[level.min(LEVELS.len() - 1)]
}

fn draw_element(picture: &mut Picture, frame: Frame, element: &Element, width: f32) {
    let outline = outline(element.cell, element.children);
    let spots = outline.iter().map(|&at| frame.spot(at)).collect();
    let fill = colour_of(usize::from(element.cell.level));
    picture.polygon(spots, fill, EDGE, width);
}

/// The lattice points around the children that an element fills, in one round.
///
/// Sides of the children run anticlockwise; one that another child runs the other way is inside.
fn outline(cell: Cell, children: u8) -> Vec<Point> {
    if cell.level == 0 {
        return [0, 1, 3, 2]
            .map(|index| add(cell.at, corner(index)))
            .to_vec();
    }
    let mut sides = BTreeSet::new();
    for child in (0..Dim2::CORNERS).filter(|child| children >> child & 1 == 1) {
        let low = corner(child);
        let round = [0, 1, 3, 2].map(|index| add(low, corner(index)));
        for k in 0..4 {
            let (from, to) = (round[k], round[(k + 1) % 4]);
            if !sides.remove(&(to, from)) {
                sides.insert((from, to));
            }
        }
    }
    let next: BTreeMap<Point, Point> = sides.into_iter().collect();
    let mut round = Vec::new();
    if let Some((&start, _)) = next.iter().next() {
        let mut at = start;
        while let Some(&to) = next.get(&at) {
            round.push(at);
            at = to;
            if at == start {
                break;
            }
        }
    }
    let half = cell.width() / 2;
    round
        .iter()
        .map(|&at| add(cell.first_voxel(), scale(at, half)))
        .collect()
}

fn save(picture: &Picture, stem: &Path, written: &mut Vec<PathBuf>) -> Result<()> {
    for (extension, bytes) in [("svg", picture.svg().into_bytes()), ("png", picture.png()?)] {
        let path = stem.with_extension(extension);
        std::fs::write(&path, bytes).with_context(|| format!("cannot write {}", path.display()))?;
        written.push(path);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_are_written_and_not_empty() {
        let folder = tempfile::tempdir().unwrap();
        let written = write(Which::All, folder.path()).unwrap();
        assert_eq!(written.len(), 4);
        for path in written {
            assert!(std::fs::metadata(&path).unwrap().len() > 1000, "{path:?}");
        }
    }

    #[test]
    fn an_l_has_its_six_corners_in_the_outline() {
        let cell = Cell {
            level: 1,
            at: [0; 3],
        };
        let round = outline(cell, 0b0111);
        assert!(round.contains(&[1, 1, 0]) && !round.contains(&[2, 2, 0]));
        assert_eq!(round.len(), 8, "two of them in the middle of a side");
    }
}
