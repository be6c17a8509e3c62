//! Surface of a 3D body: the smooth skin that the game also draws, followed by a small box for each crumb
//! (piece of a single voxel).
//!
//! ```text
//!   vertices   │ skin ············ │ crumbs: 8 each │      The slots of the skin are stable; the crumbs shift when
//!   triangles  │ skin: 2 a face ·· │ crumbs: 12 each│      it grows, in a tick in which a node was split.
//! ```
//!
//! Each bare face of the body has two triangles, also on crumbs.

use super::{Surface, Vertex};
use crate::colours::SoftColours;
use crate::convert::bevy_vector;
use bevy_math::Vec3;
use fuwafuwa::inspect::face_corners;
use fuwafuwa::{Dim3, ElementId, SoftBody};
use fuwafuwa_render::space::Skin;
use fuwafuwa_render::space::skin::SkinVertex;

/// Size of a drawn crumb relative to its voxel. Together with rounded shading, the smaller box looks like a
/// grain.
const CRUMB: f32 = 0.85;
/// Threshold of the fourth component of `SkinVertex::other`, 0 to 255. A vertex above this threshold is drawn
/// in the colour of the material beyond the nearest border.
const BORDER: u8 = 128;

/// Surface of a 3D body.
#[derive(Default)]
pub struct SpaceSurface {
    skin: Skin,
    crumbs: Vec<Crumb>,
}

struct Crumb {
    material: u8,
    corners: [Vertex; 8],
}

impl Surface<Dim3> for SpaceSurface {
    fn follow(&mut self, body: &SoftBody<Dim3>, colours: &SoftColours) -> bool {
        let count = self.crumbs.len();
        let is_new = self.skin.update(body, &colours.materials);
        self.crumbs.clear();
        let crumbs = self.skin.crumbs().iter();
        self.crumbs
            .extend(crumbs.filter_map(|&id| Crumb::of(body, id)));
        is_new || self.crumbs.len() != count
    }

    fn vertices(&self) -> impl Iterator<Item = Option<Vertex>> {
        let skin = self.skin.vertices().iter().map(|corner| {
            let [x, y, z, _] = corner.normal;
            let normal = Vec3::new(x.into(), y.into(), z.into()) / 32767.0;
            let position = Vec3::from(corner.at);
            is_used(corner).then_some(Vertex { position, normal })
        });
        let crumbs = self.crumbs.iter().flat_map(|crumb| crumb.corners);
        skin.chain(crumbs.map(Some))
    }

    fn colours(&self, colours: &SoftColours) -> impl Iterator<Item = [f32; 4]> {
        let fresh = colours.fresh.map(super::linear);
        let skin = self.skin.vertices().iter().map(move |corner| {
            let nearest = if corner.other[3] > BORDER {
                corner.other
            } else {
                corner.colour
            };
            let own = [0, 1, 2].map(|k| super::linear(f32::from(nearest[k]) / 255.0));
            let share = 0.5 * f32::from(corner.colour[3]) / 255.0;
            let [red, green, blue] = [0, 1, 2].map(|k| own[k] + (fresh[k] - own[k]) * share);
            [red, green, blue, 1.0]
        });
        let crumbs = self.crumbs.iter();
        let crumbs = crumbs.flat_map(|crumb| [super::light_of(colours, crumb.material, true); 8]);
        skin.chain(crumbs)
    }

    fn indices(&self) -> impl Iterator<Item = u32> {
        let first = self.skin.vertices().len() as u32;
        let count = self.crumbs.len() as u32;
        let crumbs = (0..count).flat_map(move |crumb| {
            let faces = (0..6).flat_map(|face| {
                let [a, b, c, d] = face_corners::<Dim3>(face);
                [a, b, c, a, c, d]
            });
            faces.map(move |corner| first + 8 * crumb + corner as u32)
        });
        self.skin.indices().iter().copied().chain(crumbs)
    }
}

impl Crumb {
    fn of(body: &SoftBody<Dim3>, id: ElementId) -> Option<Self> {
        let element = body.mesh().element(id)?;
        let place = |corner: usize| bevy_vector(body.node_state(element.nodes[corner]).0);
        let places: [Vec3; 8] = std::array::from_fn(place);
        let middle = places.iter().sum::<Vec3>() / 8.0;
        let corners = places.map(|at| Vertex {
            position: middle.lerp(at, CRUMB),
            normal: (at - middle).normalize_or(Vec3::Y),
        });
        let material = body.grid().material(element.cell.at);
        Some(Self { material, corners })
    }
}

/// Returns whether a vertex slot is in use: the skin fills unused slots with zeros.
fn is_used(corner: &SkinVertex) -> bool {
    *corner != SkinVertex::default()
}
