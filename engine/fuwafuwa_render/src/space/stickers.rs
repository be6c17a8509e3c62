//! Computes the vertices of stickers, such as a painted pair of eyes and a mouth. Every mark (coloured patch)
//! of a sticker bulges from the deformed skin like a cushion.
//!
//! ```text
//!        out            The skin is treated as a height field over the plane of the sticker. It is
//!      ╭──┼──╮          computed again in each call, so stickers need no knowledge of cracks and
//!    ╭╯   ┼   ╰╮        lie on the outermost current surface.
//!   ╱    from   ╲
//! ```

use super::skin::{Skin, SkinVertex};
use crate::frame::{Mark, Sticker};
use crate::palette::bytes;
use fuwafuwa::{Dim3, SoftBody};
use glam::{Mat3, Vec2, Vec3, Vec4};

/// Half extent of the height field [mark units, see [`Mark::outline`]]. `SIDE` is its number of samples per
/// side.
const REACH: f32 = 1.2;
const SIDE: usize = 25;
/// Radius over which a height is averaged, in mark units and in voxels; the larger one applies.
const NEAR: [f32; 2] = [0.12, 1.1];
/// Depth below the outermost skin at a sample from which skin counts as hidden in a fold and is ignored [mark
/// units].
const FOLD: f32 = 0.3;
/// Offset of the sticker from the skin towards the eye of the observer [mark units], so that no bump of the
/// skin shows through.
const CLOSER: f32 = 0.06;
/// Rings of vertices of a mark, as fractions of the distance from its centre to its edge.
const RINGS: [f32; 5] = [1.0, 0.94, 0.8, 0.55, 0.25];

/// Stickers as vertices. Keep the value between frames to reuse its buffers.
#[derive(Clone, Debug, Default)]
pub struct Stickers {
    /// Vertices. Their rest position is unused, and the last component of the colour is the opacity.
    pub vertices: Vec<SkinVertex>,
    /// Vertex indices, three per triangle.
    pub indices: Vec<u32>,
}

impl Stickers {
    /// Removes all stickers.
    pub fn clear(&mut self) {
        self.vertices.clear();
        self.indices.clear();
    }

    /// Adds a sticker, seen from the point `eye` [m].
    pub fn add(&mut self, sticker: &Sticker, skin: &Skin, body: &SoftBody<Dim3>, eye: Vec3) {
        let Some(heights) = Heights::new(sticker, skin, body) else {
            return;
        };
        for mark in &sticker.marks {
            self.add_mark(mark, &heights, sticker, eye);
        }
    }

    fn add_mark(&mut self, mark: &Mark, heights: &Heights, sticker: &Sticker, eye: Vec3) {
        let outline: Vec<Vec2> = mark.outline.iter().map(|&at| at.into()).collect();
        let count = outline.len();
        let middle = outline.iter().sum::<Vec2>() / count as f32;
        let [right, up, out] = sticker.axes;
        let axes = Mat3::from_cols(right, up, out);
        let place =
            |at: Vec2, height: f32| sticker.origin + axes * at.extend(heights.at(at) + height);
        let mut places: Vec<Vec3> = Vec::new();
        for ring in RINGS {
            let height = mark.lift + mark.bulge * (1.0 - ring * ring).sqrt();
            let corners = outline.iter();
            places.extend(corners.map(|&at| place(middle.lerp(at, ring), height)));
        }
        places.push(place(middle, mark.lift + mark.bulge));
        let mut triangles: Vec<[usize; 3]> = Vec::new();
        for k in 0..count {
            let next = (k + 1) % count;
            for ring in 0..RINGS.len() - 1 {
                let (outer, inner) = (ring * count, (ring + 1) * count);
                triangles.push([outer + k, outer + next, inner + next]);
                triangles.push([outer + k, inner + next, inner + k]);
            }
            let last = (RINGS.len() - 1) * count;
            triangles.push([last + k, last + next, places.len() - 1]);
        }
        let mut normals = vec![Vec3::ZERO; places.len()];
        for corners in &triangles {
            let [a, b, c] = corners.map(|corner| places[corner]);
            let normal = (b - a).cross(c - a);
            for &corner in corners {
                normals[corner] += normal;
            }
        }
        let first = self.vertices.len();
        let [red, green, blue, alpha] = mark.colour;
        let colour = bytes([red, green, blue], alpha);
        let closer = CLOSER * axes.z_axis.length();
        self.vertices
            .extend(places.iter().zip(normals).map(|(&at, normal)| {
                let normal = normal.normalize_or_zero().extend(0.0);
                SkinVertex {
                    at: at.move_towards(eye, closer).into(),
                    normal: (32767.0 * normal).to_array().map(|k| k as i16),
                    colour,
                    ..SkinVertex::default()
                }
            }));
        let corners = triangles.into_iter().flatten();
        self.indices
            .extend(corners.map(|corner| (first + corner) as u32));
    }
}

/// Height field of the skin over the plane of a sticker [mark units].
struct Heights([f32; SIDE * SIDE]);

impl Heights {
    /// Computes the height field. Returns `None` if the piece has no skin in reach.
    fn new(sticker: &Sticker, skin: &Skin, body: &SoftBody<Dim3>) -> Option<Self> {
        let axes = sticker.axes;
        let square = Vec3::from(axes.map(Vec3::length_squared));
        if square.min_element() == 0.0 {
            return None;
        }
        let voxel = body.grid().voxel_size() / square.z.sqrt();
        let near = NEAR[0].max(NEAR[1] * voxel);
        let mut seen: Vec<Vec3> = Vec::new();
        for vertex in skin.vertices_of(body, sticker.piece) {
            let by = Vec3::from(vertex.at) - sticker.origin;
            let at = Vec3::from(axes.map(|axis| by.dot(axis))) / square;
            let normal = Vec4::from(vertex.normal.map(f32::from)).truncate();
            let is_in_reach = at.x.abs().max(at.y.abs()) < REACH + 2.0 * near;
            if is_in_reach && at.z > 0.0 && normal.dot(axes[2]) > 0.0 {
                seen.push(at);
            }
        }
        // Outside the skin, the height field continues at its lowest height.
        let lowest = seen.iter().map(|at| at.z).reduce(f32::min)?;
        let reach = 2.0 * near;
        let mut tops = [lowest; SIDE * SIDE];
        for by in &seen {
            around(*by, reach, |place, _| tops[place] = tops[place].max(by.z));
        }
        let (mut sums, mut weights) = ([lowest * 1e-6; SIDE * SIDE], [1e-6; SIDE * SIDE]);
        for by in &seen {
            around(*by, reach, |place, share| {
                if by.z > tops[place] - FOLD {
                    sums[place] += share * by.z;
                    weights[place] += share;
                }
            });
        }
        Some(Self(std::array::from_fn(|k| sums[k] / weights[k])))
    }

    /// Returns the interpolated height at a point of the plane.
    fn at(&self, place: Vec2) -> f32 {
        let last = SIDE as f32 - 1.0;
        let place = 0.5 * last * (place / REACH + 1.0);
        let place = place.clamp(Vec2::ZERO, Vec2::splat(last - 1e-3));
        let (left, low) = (place.x as usize, place.y as usize);
        let [right, up] = place.fract().to_array();
        let row = |low: usize| {
            let first = low * SIDE + left;
            self.0[first] + right * (self.0[first + 1] - self.0[first])
        };
        row(low) + up * (row(low + 1) - row(low))
    }
}

/// Calls `act` with the index and the weight (0 to 1) of each sample within `reach` of a point.
fn around(place: Vec3, reach: f32, mut act: impl FnMut(usize, f32)) {
    let step = 2.0 * REACH / (SIDE - 1) as f32;
    let range = |k: usize| {
        let first = ((place[k] + REACH - reach) / step).ceil().max(0.0) as usize;
        let last = ((place[k] + REACH + reach) / step).floor();
        first..(last + 1.0).clamp(0.0, SIDE as f32) as usize
    };
    for y in range(1) {
        for x in range(0) {
            let at = step * Vec2::new(x as f32, y as f32) - REACH;
            let share = 1.0 - at.distance_squared(place.truncate()) / (reach * reach);
            if share > 0.0 {
                act(y * SIDE + x, share * share * share);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Palette;
    use fuwafuwa::{Blade, Material, PieceId, VoxelGrid, World, WorldConfig};

    #[test]
    fn sticker_lies_on_the_skin_and_on_torn_faces() {
        let mut world = World::<Dim3>::new(WorldConfig::default()).unwrap();
        let grid = VoxelGrid::ball(32, 1.0).unwrap();
        let soft = world
            .add_soft_body(SoftBody::new(grid, &[Material::default()]).unwrap())
            .unwrap();
        let outline = [[-0.6, -0.6], [0.6, -0.6], [0.6, 0.6], [-0.6, 0.6]].to_vec();
        let mark = Mark {
            outline,
            colour: [1.0; 4],
            bulge: 0.0,
            lift: 0.0,
        };
        let mut sticker = Sticker {
            body: 0,
            piece: PieceId(0),
            origin: Vec3::splat(0.5),
            axes: Vec3::AXES.map(|axis| 0.25 * axis),
            marks: vec![mark],
        };
        let mut skin = Skin::default();
        let mut stuck = |world: &World<Dim3>, sticker: &Sticker| {
            let body = &world[soft];
            skin.update(body, &Palette::candy().materials);
            let mut stickers = Stickers::default();
            stickers.add(sticker, &skin, body, Vec3::new(0.5, 0.5, 9.0));
            stickers
        };
        let whole = stuck(&world, &sticker);
        assert_eq!(whole.vertices.len(), 21);
        for vertex in &whole.vertices {
            let away = Vec3::from(vertex.at).distance(Vec3::splat(0.5));
            // The sticker lies on the skin, offset towards the eye of the observer by at most `CLOSER`.
            assert!((0.485..0.53).contains(&away), "{away}");
            assert!(vertex.normal[2] > 20000, "{vertex:?}");
        }
        // After a slice is cut off, the sticker lies on the torn surface of the remaining body.
        let corner = Vec3::new(-0.2, -0.2, 0.75);
        let blade = Blade::parallelogram(corner, 1.4 * Vec3::X, 1.4 * Vec3::Y);
        world.cut(soft, &blade).unwrap();
        let body = &world[soft];
        let nodes = body.mesh().nodes();
        let inside = nodes.min_by(|a, b| {
            let away = |id| body.node_state(id).0.distance(Vec3::splat(0.5));
            away(a.0).total_cmp(&away(b.0))
        });
        sticker.piece = body.pieces().of_node(inside.unwrap().0);
        for vertex in stuck(&world, &sticker).vertices {
            assert!((0.73..0.81).contains(&vertex.at[2]), "{vertex:?}");
        }
        // A sticker on a piece that does not exist has no triangles.
        sticker.piece = PieceId(99);
        assert!(stuck(&world, &sticker).indices.is_empty());
    }
}
