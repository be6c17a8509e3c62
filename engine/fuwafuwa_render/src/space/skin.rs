//! Smooth surface of a 3D body, as vertices.
//!
//! Each update moves all surface points with their voxels. It then smooths them by a few rounds, because
//! contacts deform the unsmoothed voxels below. Both faces of a crack are smoothed alike, so that a closed
//! crack stays closed.

use super::faces::{Faces, NO_NODE, NONE, SkinPoint, SurfaceKind};
use super::rest::Rest;
use crate::palette::Colour;
use bytemuck::{Pod, Zeroable};
use fuwafuwa::inspect::Row;
use fuwafuwa::{Dim3, ElementId, IndexVec, NodeId, PieceId, SoftBody, VoxelGrid};
use glam::{Vec3, Vec4};

/// Fraction of the way that a point moves to the mean of its neighbours in each round: on the original
/// surface, at the mouth of a crack, on torn surfaces. The negative rounds undo the shrinking of the positive
/// ones, so that small torn pieces keep their size [Taubin 1995].
const ROUNDS: [[f32; 3]; 4] = [
    [0.5, 0.5, 0.5],
    [0.5, 0.5, -0.5],
    [0.5, 0.5, 0.5],
    [0.5, 0.5, -0.5],
];

/// Vertex of the skin.
#[repr(C)]
#[derive(Copy, Clone, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct SkinVertex {
    /// Position [m].
    pub at: [f32; 3],
    /// Rest position in the grid [voxels].
    pub rest: [f32; 3],
    /// Outward normal of length 32767; last component: strain ‖F − R‖ of the voxel, 32767 being 1.
    pub normal: [i16; 4],
    /// Red, green, blue of the material; the last component is 255 on torn surfaces.
    pub colour: [u8; 4],
    /// Red, green, blue of the material beyond the nearest border between materials; the last component is
    /// 128 on the border, higher in the material beyond it.
    pub other: [u8; 4],
}

/// Surface of a body.
#[derive(Clone, Debug, Default)]
pub struct Skin {
    rest: Rest,
    faces: Faces,
    /// Position and, as last component, voxel strain of each point.
    places: Vec<Vec4>,
    smoothed: Vec<Vec4>,
    normals: Vec<Vec3>,
    vertices: Vec<SkinVertex>,
}

impl Skin {
    /// Updates the surface to the current state of a body. `palette` has the colours of its materials,
    /// starting at number 1. Returns whether the triangles changed.
    pub fn update(&mut self, body: &SoftBody<Dim3>, palette: &[Colour]) -> bool {
        self.update_tinted(body, body.grid(), palette)
    }

    /// Updates the surface like [`Skin::update`], but colours each voxel by its material number in `numbers`, a
    /// grid of the same size as that of the body.
    pub fn update_tinted(
        &mut self,
        body: &SoftBody<Dim3>,
        numbers: &VoxelGrid<Dim3>,
        palette: &[Colour],
    ) -> bool {
        if !self.rest.fits(body.grid(), numbers) {
            *self = Self {
                rest: Rest::new(body, numbers),
                ..Self::default()
            };
        }
        let is_new = self.faces.update(body, &self.rest, palette);
        self.place(body);
        ROUNDS.iter().for_each(|shares| self.smooth(*shares));
        self.find_normals();
        self.write();
        is_new
    }

    /// Returns the vertices. Some belong to no triangle.
    pub fn vertices(&self) -> &[SkinVertex] {
        &self.vertices
    }

    /// Returns the vertex indices, three per triangle. Some triangles have no area.
    pub fn indices(&self) -> &[u32] {
        &self.faces.indices
    }

    /// Returns the crumbs (elements that are pieces of a single voxel). The skin has no triangles for them.
    pub fn crumbs(&self) -> &[ElementId] {
        &self.faces.crumbs
    }

    /// Returns the vertices on a piece, as of the last [`Skin::update`].
    pub(super) fn vertices_of<'a>(
        &'a self,
        body: &'a SoftBody<Dim3>,
        piece: PieceId,
    ) -> impl Iterator<Item = &'a SkinVertex> {
        let corners = self.faces.vertices.all.iter().zip(&self.vertices);
        let own = corners.filter(move |(corner, _)| {
            let point = self.faces.points.all.get(corner.point as usize);
            point.is_some_and(|point| {
                point.node != NO_NODE && body.pieces().of_node(point.node) == piece
            })
        });
        own.map(|(_, vertex)| vertex)
    }

    /// Moves all points with their voxels.
    fn place(&mut self, body: &SoftBody<Dim3>) {
        let (positions, size) = (body.positions(), body.grid().voxel_size());
        self.places.clear();
        self.places
            .extend(self.faces.points.all.iter().map(|point| match point.node {
                NO_NODE => Vec4::ZERO,
                node => carried(point, positions[node].to_array().into(), positions, size),
            }));
    }

    fn smooth(&mut self, shares: [f32; 3]) {
        self.smoothed.clear();
        let places = &self.places;
        self.smoothed.extend(
            places
                .iter()
                .zip(&self.faces.points.all)
                .map(|(&own, point)| {
                    let near = &point.near[..point.near_count.into()];
                    if near.is_empty() {
                        return own;
                    }
                    let share = match point.ground {
                        SurfaceKind::Original => shares[0],
                        SurfaceKind::CrackMouth => shares[1],
                        SurfaceKind::Torn => shares[2],
                    };
                    let sum: Vec4 = near.iter().map(|&k| places[k as usize]).sum();
                    own.lerp(sum / near.len() as f32, share)
                }),
        );
        std::mem::swap(&mut self.places, &mut self.smoothed);
    }

    /// Sums the normals of the faces at each vertex, weighted by area.
    fn find_normals(&mut self) {
        self.normals.clear();
        self.normals
            .resize(self.faces.vertices.all.len(), Vec3::ZERO);
        for face in self
            .faces
            .faces
            .all
            .iter()
            .filter(|face| face.points[0] != NONE)
        {
            let places = face.points.map(|point| self.places[point as usize]);
            let [a, b, c, d] = places.map(Vec4::truncate);
            let normal = (c - a).cross(d - b);
            for vertex in face.vertices {
                self.normals[vertex as usize] += normal;
            }
        }
    }

    fn write(&mut self) {
        self.vertices.clear();
        let corners = self.faces.vertices.all.iter().zip(&self.normals);
        self.vertices.extend(corners.map(|(corner, &normal)| {
            if corner.point == NONE {
                return SkinVertex::default();
            }
            let place = self.places[corner.point as usize];
            let normal = normal.normalize_or_zero().extend(place.w.min(1.0));
            SkinVertex {
                at: place.truncate().into(),
                rest: corner.rest.into(),
                normal: (32767.0 * normal).to_array().map(|k| k as i16),
                colour: corner.colour,
                other: corner.other,
            }
        }));
    }
}

/// Returns the position of a point: its node plus the offset, transformed by the mean deformation of its
/// voxel. The last component is ‖F − R‖ to first order.
#[inline]
fn carried(point: &SkinPoint, node: Vec4, positions: &IndexVec<NodeId, Row>, size: f32) -> Vec4 {
    let [x, y, z] = edges(&point.voxel, positions);
    let by = point.offset;
    let mut place = node + by.x * x + by.y * y + by.z * z;
    let over = 1.0 / (size * size);
    let [xx, yy, zz] = [x, y, z].map(|edge| edge.length_squared() * over - 1.0);
    let [xy, yz, zx] = [x.dot(y), y.dot(z), z.dot(x)].map(|dot| dot * over);
    let squared = xx * xx + yy * yy + zz * zz + 2.0 * (xy * xy + yz * yz + zx * zx);
    place.w = 0.5 * squared.sqrt();
    place
}

/// Returns the mean edges of a voxel along its axes [m].
#[inline]
fn edges(voxel: &[NodeId; 8], positions: &IndexVec<NodeId, Row>) -> [Vec4; 3] {
    let corners = voxel.map(|id| Vec4::from(positions[id].to_array()));
    [1, 2, 4].map(|side| {
        let low = [0, 1, 2, 3].map(|k| (k & (side - 1)) | (k & !(side - 1)) << 1);
        0.25 * low
            .map(|k| corners[k + side] - corners[k])
            .iter()
            .sum::<Vec4>()
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::palette::Palette;
    use fuwafuwa::{Blade, Material, VoxelGrid, World, WorldConfig};

    fn ball(n: usize) -> World<Dim3> {
        let mut world = World::new(WorldConfig::default()).unwrap();
        let grid = VoxelGrid::ball(n, 1.0).unwrap();
        world
            .add_soft_body(SoftBody::new(grid, &[Material::default()]).unwrap())
            .unwrap();
        world
    }

    fn skin(world: &World<Dim3>) -> Skin {
        let mut skin = Skin::default();
        skin.update(first_body(world), &Palette::candy().materials);
        skin
    }

    fn first_body(world: &World<Dim3>) -> &SoftBody<Dim3> {
        world.soft_bodies().next().unwrap().1
    }

    fn cut(world: &mut World<Dim3>, x: f32) {
        let edges = [Vec3::new(0.0, 1.4, 0.1), Vec3::new(0.0, -0.1, 1.4)];
        let blade = Blade::parallelogram(Vec3::new(x, -0.2, -0.2), edges[0], edges[1]);
        world.cut(world.nth_soft_body(0).unwrap(), &blade).unwrap();
    }

    impl Skin {
        fn corners(&self) -> impl Iterator<Item = [SkinVertex; 3]> + '_ {
            let triangles = self.indices().chunks(3).filter(|t| t[0] != t[1]);
            triangles.map(|t| [0, 1, 2].map(|k| self.vertices[t[k] as usize]))
        }

        /// Returns the volume enclosed by the triangles [m³].
        fn volume(&self) -> f32 {
            let sixfold = |corners: [SkinVertex; 3]| {
                let [a, b, c] = corners.map(|corner| Vec3::from(corner.at));
                a.dot(b.cross(c))
            };
            self.corners().map(sixfold).sum::<f32>() / 6.0
        }
    }

    #[test]
    fn skin_of_a_ball_is_a_sphere() {
        let world = ball(32);
        let count = first_body(&world).grid().solid_count() as f32;
        let round = (0.75 * count / std::f32::consts::PI).cbrt() / 32.0;
        for vertex in skin(&world).vertices() {
            let away = Vec3::from(vertex.at) - 0.5;
            let radius = away.length();
            assert!((radius - round).abs() < 0.3 / 32.0, "{radius}, not {round}");
            let normal = Vec4::from(vertex.normal.map(f32::from)).truncate() / 32767.0;
            assert!(normal.dot(away) / radius > 0.995, "{normal:?} at {away:?}");
            assert_eq!((vertex.colour[3], vertex.normal[3] < 30), (0, true));
        }
    }

    #[test]
    fn skin_of_a_stretched_ball_is_an_ellipsoid_with_strain() {
        let mut world = ball(32);
        let whole = skin(&world).volume();
        let soft = world.nth_soft_body(0).unwrap();
        let body = world.soft_body_mut(soft).unwrap();
        let ids: Vec<_> = body.mesh().nodes().map(|(id, _)| id).collect();
        for id in ids {
            let at = body.node_state(id).0 * Vec3::new(1.5, 1.0, 1.0);
            body.set_node_state(id, at, Vec3::ZERO).unwrap();
        }
        let skin = skin(&world);
        assert!((skin.volume() / whole - 1.5).abs() < 0.01);
        // ‖F − R‖ is 0.5 here. Its first-order approximation ½ ‖FᵀF − 1‖ is 0.625.
        let strains = skin
            .vertices()
            .iter()
            .map(|vertex| f32::from(vertex.normal[3]) / 32767.0);
        strains.for_each(|strain| assert!((strain - 0.625).abs() < 1e-3, "{strain}"));
    }

    #[test]
    fn closed_cut_preserves_volume_and_marks_torn_faces() {
        let mut world = ball(24);
        let whole = skin(&world).volume();
        cut(&mut world, 0.47);
        let halves = skin(&world);
        let gap = (halves.volume() / whole - 1.0).abs();
        assert!(gap < 5e-3, "{gap}");
        let torn = halves
            .corners()
            .flatten()
            .filter(|corner| corner.colour[3] == 255);
        let mut count = 0;
        for corner in torn {
            assert!((corner.at[0] - 0.47).abs() < 1.5 / 24.0, "{corner:?}");
            count += 1;
        }
        assert!(count > 2000, "{count}");
    }

    #[test]
    fn update_matches_a_new_skin_after_each_cut() {
        let mut world = ball(16);
        let mut kept = skin(&world);
        let candy = Palette::candy().materials;
        // Rest positions are equal to the last bit; current positions depend on the voxel chosen at each
        // point.
        let sorted = |skin: &Skin| {
            let rest = |corner: SkinVertex| (corner.rest.map(f32::to_bits), corner.colour);
            let mut triangles: Vec<_> = skin.corners().map(|corners| corners.map(rest)).collect();
            triangles.sort_unstable();
            triangles
        };
        for x in [0.2, 0.8, 0.3, 0.55, 0.4, 0.48] {
            cut(&mut world, x);
            assert!(kept.update(first_body(&world), &candy));
            let new = skin(&world);
            assert_eq!(sorted(&kept), sorted(&new));
            assert!((kept.volume() / new.volume() - 1.0).abs() < 1e-4);
            world.step();
            kept.update(first_body(&world), &candy);
        }
        let safe = Palette::colour_safe().materials;
        assert!(kept.update(first_body(&world), &safe));
        assert!(!kept.update(first_body(&world), &safe));
        // The same skin then follows two other balls: one with a different grid, and an untorn one with an
        // equal grid.
        for n in [16, 20] {
            let other = ball(n);
            kept.update(first_body(&other), &candy);
            assert_eq!(sorted(&kept), sorted(&skin(&other)));
        }
    }

    #[test]
    fn isolated_voxel_is_a_crumb() {
        let mut world = World::<Dim3>::new(WorldConfig::default()).unwrap();
        let grid = VoxelGrid::from_fn([3, 1, 1], 1.0, |[x, ..]| u8::from(x != 1)).unwrap();
        world
            .add_soft_body(SoftBody::new(grid, &[Material::default()]).unwrap())
            .unwrap();
        let skin = skin(&world);
        assert_eq!((skin.crumbs().len(), skin.indices().len()), (2, 0));
    }
}
