//! Map of a level's room: its cells and the objects in it.

use fuwafuwa::inspect::obstacles;
use fuwafuwa::{Dim, DimVector, Shape, Vec3};
use tamaire_play::{AnyRound, Level, Round};

/// Number of cells along the longer side of a room.
const CELLS: f32 = 64.0;

/// Grid of square cells over the room of a level.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Grid {
    /// Horizontal and vertical axis of the map: x and y in 2D; x and z in 3D, which is seen from above.
    pub axes: [usize; 2],
    /// Minimum coordinates of the room along `axes` [m].
    pub low: [f32; 2],
    /// Maximum coordinates of the room along `axes` [m].
    pub high: [f32; 2],
    /// Width of a cell [m].
    pub cell: f32,
    /// Number of cells along each of `axes`.
    pub counts: [usize; 2],
}

/// Object in a room, drawn as a line on its map.
#[derive(Clone, Debug, PartialEq)]
pub struct Stroke {
    /// Kind of the object.
    pub of: ObjectKind,
    /// Points of the line [m].
    pub points: Vec<[f32; 2]>,
    /// Width of the line [m]; 0 for a hairline.
    pub width: f32,
}

/// Kind of an object on a map.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum ObjectKind {
    /// Fixed rigid body.
    Obstacle,
    /// Basket.
    Basket,
    /// Soft body in its initial state.
    Body,
}

impl Grid {
    /// Returns the grid of a level.
    pub fn of(level: &Level) -> Self {
        let axes = if level.scene().dim == 2 {
            [0, 1]
        } else {
            [0, 2]
        };
        let [low, high] = level.arena().map(|corner| axes.map(|axis| corner[axis]));
        let sides = [0, 1].map(|k| (high[k] - low[k]).max(0.01));
        let cell = sides[0].max(sides[1]) / CELLS;
        Self {
            axes,
            low,
            high,
            cell,
            counts: sides.map(|side| ((side / cell).ceil() as usize).max(1)),
        }
    }

    /// Returns the index of the cell that contains a position, or of the nearest cell if the position is
    /// outside.
    pub fn cell_at(&self, position: Vec3) -> usize {
        let [column, row] = [0, 1].map(|k| {
            let cells = (position[self.axes[k]] - self.low[k]) / self.cell;
            (cells.max(0.0) as usize).min(self.counts[k] - 1)
        });
        row * self.counts[0] + column
    }
}

/// Returns the objects in the room of a level at the start of a round.
pub fn strokes(level: Level) -> Vec<Stroke> {
    let grid = Grid::of(&level);
    match AnyRound::new(level.into()) {
        AnyRound::Plane(round) => of_round(grid, &round),
        AnyRound::Space(round) => of_round(grid, &round),
    }
}

fn of_round<D: Dim>(grid: Grid, round: &Round<D>) -> Vec<Stroke> {
    let world = round.world();
    let obstacles =
        obstacles(world).filter_map(|body| of_shape(grid, body.shape(), ObjectKind::Obstacle));
    let bodies = world.soft_bodies().flat_map(|(_, body)| match D::N {
        2 => {
            let outlines = body.outlines().into_iter();
            outlines.map(|outline| flat(grid, outline.points)).collect()
        }
        _ => {
            let nodes = body.mesh().nodes();
            let positions = nodes.map(|(id, _)| body.positions()[id].xyz());
            vec![hull(flat(grid, positions))]
        }
    });
    let bodies = bodies.map(|points| closed(ObjectKind::Body, points));
    let baskets = round.baskets().iter();
    let baskets = baskets.filter_map(|basket| of_shape(grid, basket.region, ObjectKind::Basket));
    obstacles.chain(bodies).chain(baskets).collect()
}

/// Returns the outline of a shape. Half-spaces are left out, because walls and floors coincide with the
/// border of the map.
fn of_shape<D: Dim>(grid: Grid, shape: Shape<D>, of: ObjectKind) -> Option<Stroke> {
    let on_map = |at: D::Vector| grid.axes.map(|axis| at[axis]);
    match shape {
        Shape::HalfSpace { .. } => None,
        Shape::Box { centre, half } => {
            let ([x, y], [width, height]) = (on_map(centre), on_map(half));
            let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
            let corners = corners.map(|[a, b]| [x + a * width, y + b * height]);
            Some(closed(of, corners.into()))
        }
        Shape::OrientedBox {
            centre,
            half,
            rotation,
        } => {
            let corner = |number: usize| {
                let sign = |axis: usize| if number >> axis & 1 == 1 { 1.0 } else { -1.0 };
                let own = Vec3::from([0, 1, 2].map(sign)) * half.to_vec3();
                centre.to_vec3() + rotation.apply(own)
            };
            let corners = (0..1 << D::N).map(corner);
            Some(closed(of, hull(flat(grid, corners))))
        }
        Shape::Capsule { from, to, radius } => Some(Stroke {
            of,
            points: vec![on_map(from), on_map(to)],
            width: 2.0 * radius,
        }),
        Shape::Ball { centre, radius } => Some(Stroke {
            of,
            points: vec![on_map(centre), on_map(centre)],
            width: 2.0 * radius,
        }),
    }
}

fn flat(grid: Grid, points: impl IntoIterator<Item = Vec3>) -> Vec<[f32; 2]> {
    let points = points.into_iter();
    points.map(|at| grid.axes.map(|axis| at[axis])).collect()
}

fn closed(of: ObjectKind, mut points: Vec<[f32; 2]>) -> Stroke {
    points.extend(points.first().copied());
    Stroke {
        of,
        points,
        width: 0.0,
    }
}

/// Returns the convex hull of points: along the lower side in the direction of +x, and back along the upper
/// side [Andrew 1979].
fn hull(mut points: Vec<[f32; 2]>) -> Vec<[f32; 2]> {
    points.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    let there = half_hull(points.iter().copied());
    let back = half_hull(points.iter().rev().copied());
    [there, back].concat()
}

fn half_hull(points: impl Iterator<Item = [f32; 2]>) -> Vec<[f32; 2]> {
    let mut line: Vec<[f32; 2]> = Vec::new();
    for at in points {
        while let [.., a, b] = line[..] {
            let turn = (b[0] - a[0]) * (at[1] - a[1]) - (b[1] - a[1]) * (at[0] - a[0]);
            if turn > 0.0 {
                break;
            }
            line.pop();
        }
        line.push(at);
    }
    line.pop();
    line
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn map_has_a_cell_for_every_position_and_a_stroke_for_every_kind() {
        for name in ["classic", "hoop"] {
            let level = Level::open(name).unwrap();
            let grid = Grid::of(&level);
            let [low, high] = level.arena();
            let last = grid.counts[0] * grid.counts[1] - 1;
            assert_eq!(
                (grid.cell_at(low), grid.cell_at(Vec3::splat(9.0))),
                (0, last)
            );
            assert_eq!(grid.cell_at(Vec3::NAN), 0);
            assert!(grid.cell_at(high) <= last && last < usize::from(u16::MAX));
            let strokes = strokes(level);
            for thing in [ObjectKind::Obstacle, ObjectKind::Basket, ObjectKind::Body] {
                let of_it = strokes.iter().find(|stroke| stroke.of == thing);
                assert!(of_it.unwrap().points.len() >= 2, "{name} {thing:?}");
            }
        }
    }

    #[test]
    fn hull_of_a_square_is_its_corners() {
        let points = vec![
            [0.0, 0.0],
            [1.0, 1.0],
            [0.5, 0.5],
            [1.0, 0.0],
            [0.0, 1.0],
            [0.5, 0.0],
        ];
        assert_eq!(
            hull(points),
            [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]
        );
    }
}
