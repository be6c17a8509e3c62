//! Places on the skin that follow it, for faces and whatever else is painted on a body.

use super::faces::Ground;
use super::skin::{Skin, edges};
use fuwafuwa::dim::{neighbourhood, voxel_around};
use fuwafuwa::vector::{cross, dot, length, minus, plus, scaled, three};
use fuwafuwa::{Body, Dim3, Point, Vector, VoxelGrid};

/// How far around a spot voxels say where outwards is [voxels].
const REACH: i32 = 3;

/// A place on the original surface of a body, chosen once: see [`Skin::spot`].
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Spot {
    /// The lattice point that it hangs on.
    at: Point,
    /// The voxel at it that decides with which lip of a crack it goes, as an octant.
    octant: usize,
    /// Along the surface at rest, of length 1.
    right: Vector,
    up: Vector,
}

/// Where a [`Spot`] is now.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct SkinAnchor {
    /// [m]
    pub position: Vector,
    /// Outwards, of length 1.
    pub normal: Vector,
    /// What was to the right at rest, seen from outside: along the skin, and as much longer than 1
    /// as the skin is stretched.
    pub right: Vector,
    /// What was up at rest, likewise.
    pub up: Vector,
    /// Its piece.
    pub piece: u32,
}

impl Skin {
    /// The spot of the original surface that is seen from the middle of the grid in a direction; none
    /// before the first look at a body.
    pub fn spot(&self, body: &Body<Dim3>, towards: Vector) -> Option<Spot> {
        let (grid, towards) = (body.grid(), unit(towards));
        let middle = scaled(grid.size().map(|side| side as f32), 0.5);
        let cosine = |at: Point| dot(unit(minus(at.map(|k| k as f32), middle)), towards);
        let (at, octant) = self
            .rest()
            .spots()
            .max_by(|a, b| cosine(a.0).total_cmp(&cosine(b.0)))?;
        let normal = outwards(grid, at);
        let upright = match normal[1].abs() < 0.9 {
            true => [0.0, 1.0, 0.0],
            false => [0.0, 0.0, -1.0],
        };
        let right = unit(cross(upright, normal));
        let up = cross(normal, right);
        Some(Spot {
            at,
            octant,
            right,
            up,
        })
    }

    /// Where a spot of a body is, as of the last look at it; none when its voxel has become a crumb.
    pub fn anchor(&self, body: &Body<Dim3>, spot: &Spot) -> Option<SkinAnchor> {
        let (mesh, faces) = (body.mesh(), self.faces());
        let owner = mesh.owner(voxel_around::<Dim3>(spot.at, spot.octant))?;
        let node = *mesh.element(owner)?.nodes.get(7 - spot.octant)?;
        let place = faces.point_of(node)?;
        let point = &faces.points[place];
        let normal = self.normal_of(point.vertex(Ground::Skin)?);
        // How voxels around it are deformed, as a mean: a single one trembles.
        let near = point.near[..point.near_count.into()].iter();
        let around = near.chain([&place]).map(|&near| faces.points[near].voxel);
        let is_there = |&id: &u32| (id as usize) < body.positions().len();
        let around = around.filter(|voxel| voxel.iter().all(is_there));
        let (mut axes, mut count) = ([[0.0; 3]; 3], 0.0);
        for voxel in around {
            let sides = edges(&voxel, body.positions());
            (0..3).for_each(|k| axes[k] = plus(axes[k], three(sides[k])));
            count += body.grid().voxel_size();
        }
        let along = |rest: Vector| {
            let now = (0..3).fold([0.0; 3], |sum, k| {
                plus(sum, scaled(axes[k], rest[k] / count))
            });
            minus(now, scaled(normal, dot(now, normal)))
        };
        Some(SkinAnchor {
            position: self.position_of(place),
            normal,
            right: along(spot.right),
            up: along(spot.up),
            piece: body.pieces().of_node(node),
        })
    }
}

/// Away from the solid voxels around a lattice point.
fn outwards(grid: &VoxelGrid<Dim3>, at: Point) -> Vector {
    let corner = at.map(|k| k as f32);
    let near = neighbourhood::<Dim3>(at, REACH).filter(|&voxel| grid.is_solid(voxel));
    let away = near.map(|voxel| minus(corner, voxel.map(|k| k as f32 + 0.5)));
    let close = away.filter(|by| length(*by) < REACH as f32);
    unit(close.fold([0.0; 3], plus))
}

fn unit(v: Vector) -> Vector {
    scaled(v, 1.0 / length(v).max(1e-12))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Theme;
    use fuwafuwa::{Blade, Material, Settings, World};

    #[test]
    fn a_spot_follows_its_skin_through_turns_squashes_and_cuts() {
        let mut world = World::<Dim3>::new(Settings::default()).unwrap();
        let grid = VoxelGrid::ball(24, 1.0).unwrap();
        world.add_body(Body::new(grid, &[Material::default()]).unwrap());
        let (from, across, along) = ([0.5, -0.2, -0.2], [0.0, 1.4, 0.0], [0.0, 0.0, 1.4]);
        world.cut(
            0,
            &Blade {
                from,
                across,
                along,
            },
        );
        let theme = Theme::candy();
        let mut skin = Skin::default();
        assert_eq!(skin.spot(&world.bodies()[0], [0.3, 0.0, 1.0]), None);
        skin.follow(&world.bodies()[0], &theme.materials);
        let body = world.body_mut(0);
        let spot = skin.spot(body, [0.3, 0.0, 1.0]).unwrap();
        let rest = skin.anchor(body, &spot).unwrap();
        let radial = unit(minus(rest.position, [0.5; 3]));
        assert!(dot(radial, rest.normal) > 0.99 && dot(radial, unit([0.3, 0.0, 1.0])) > 0.99);
        assert!(
            dot(cross(rest.right, rest.up), rest.normal) > 0.95,
            "{rest:?}"
        );
        assert!(rest.up[1] > 0.95, "{rest:?}");

        // Half as high, turned by a right angle about the vertical, and away; its other half farther.
        let ids: Vec<u32> = body.mesh().nodes().map(|(id, _)| id).collect();
        for id in ids {
            let [x, y, z] = body.node_state(id).0;
            let far = if body.pieces().of_node(id) == rest.piece {
                3.0
            } else {
                50.0
            };
            body.set_node_state(id, [z + far, 0.5 * y, -x], [0.0; 3]);
        }
        skin.follow(body, &theme.materials);
        let now = skin.anchor(body, &spot).unwrap();
        let [x, y, z] = rest.position;
        assert!(
            length(minus(now.position, [z + 3.0, 0.5 * y, -x])) < 0.01,
            "{now:?}"
        );
        assert!(now.normal[0] > 0.9 && now.right[2] < -0.9, "{now:?}");
        assert!((length(now.up) / length(rest.up) - 0.5).abs() < 0.02);
        assert_eq!(now.piece, rest.piece);
    }
}
