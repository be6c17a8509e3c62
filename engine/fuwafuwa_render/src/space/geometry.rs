//! A 3D world as vertices: all CPU work before the GPU draws.

use super::boxes::Boxes;
use super::camera::Camera;
use super::room::{RoomVertex, add_planes, plane};
use super::rounded::RoundedInstance;
use super::skin::Skin;
use super::stickers::Stickers;
use crate::frame::{Frame, Look};
use crate::palette::Palette;
use crate::rigid::{MAX_WALLS, is_curtain, is_glass};
use fuwafuwa::inspect::{hands, obstacles};
use fuwafuwa::{Dim3, ElementId, MotionType, Shape, SoftBody, VoxelGrid, World};
use glam::{Mat3, Vec3};
use std::ops::Range;

/// Half extent of the floor, in multiples of the camera distance.
const REACH: f32 = 3.0;
/// Radius of a crumb [voxel widths]. A ball of this radius has the volume of a voxel.
const CRUMB: f32 = 0.62;
/// Radius of the line drawn from a hand down to the floor [m]. `LINE_SHARE` limits it, as a multiple of the
/// camera distance.
const LINE: f32 = 0.004;
const LINE_SHARE: f32 = 0.002;

/// Vertices of a 3D world. Keep the value between frames to reuse its buffers.
#[derive(Clone, Debug, Default)]
pub struct Geometry {
    pub(crate) skins: Vec<Skin>,
    /// Whether the triangles of each skin changed.
    pub(crate) renewed: Vec<bool>,
    /// Skins of the ghost world.
    pub(crate) ghosts: Vec<Skin>,
    pub(crate) renewed_ghosts: Vec<bool>,
    pub(crate) boxes: Boxes,
    pub(crate) stickers: Stickers,
    pub(crate) room: Vec<RoomVertex>,
    /// Outward normal and offset [m] of each half-space.
    pub(crate) walls: Vec<[f32; 4]>,
    /// Instances of bars, hands, props, ghost hands and glass, crumbs, dust, lines below hands, and the basket, in this
    /// order.
    pub(crate) rounded: Vec<RoundedInstance>,
    pub(crate) bars: Range<u32>,
    pub(crate) hands: Range<u32>,
    pub(crate) props: Range<u32>,
    /// Hands of the ghost world, and glass.
    pub(crate) clear: Range<u32>,
    pub(crate) crumbs: Range<u32>,
    pub(crate) dust: Range<u32>,
    pub(crate) lines: Range<u32>,
    pub(crate) basket: Range<u32>,
}

impl Geometry {
    /// Computes the vertices of a world.
    pub fn gather(&mut self, world: &World<Dim3>, frame: &Frame<'_, Camera>) {
        self.gather_room(world, &frame.camera);
        self.rounded.clear();
        self.boxes.clear();
        self.stickers.clear();
        let palette = frame.palette;
        let colours = frame.colours();
        let bars = obstacles(world).filter(|bar| !is_glass(*bar));
        let bars = bars.filter_map(|bar| {
            let (colour, fabric) = match is_curtain(world, bar) {
                true => (palette.curtain, 1.0),
                false => (palette.bar, 0.0),
            };
            RoundedInstance::of(bar.shape(), colour, fabric)
        });
        self.bars = append(&mut self.rounded, bars);
        self.hands = append(&mut self.rounded, balls(world, palette));
        let props = frame.props.iter();
        let props = props.filter_map(|prop| RoundedInstance::of(prop.shape, prop.colour, 0.0));
        self.props = append(&mut self.rounded, props);
        self.renewed_ghosts.clear();
        let ghosts = frame.ghost.map_or(0, |ghost| ghost.soft_bodies().count());
        self.ghosts.resize_with(ghosts, Skin::default);
        if let Some(ghost) = frame.ghost {
            let skins = self.ghosts.iter_mut().zip(ghost.soft_bodies());
            let renewed = skins.enumerate().map(|(place, (skin, (_, body)))| {
                skin.update_tinted(body, frame.numbers(place, body), &colours)
            });
            self.renewed_ghosts.extend(renewed);
        }
        let of_ghost = frame
            .ghost
            .into_iter()
            .flat_map(|ghost| balls(ghost, palette));
        let glass = obstacles(world).filter(|bar| is_glass(*bar));
        let glass = glass.filter_map(|bar| RoundedInstance::of(bar.shape(), palette.glass, 0.0));
        self.clear = append(&mut self.rounded, of_ghost.chain(glass));
        self.skins
            .resize_with(world.soft_bodies().count(), Skin::default);
        self.renewed.clear();
        let first = self.rounded.len() as u32;
        for (place, (_, body)) in world.soft_bodies().enumerate() {
            match frame.look {
                Look::Skin => {
                    let skin = &mut self.skins[place];
                    let numbers = frame.numbers(place, body);
                    self.renewed
                        .push(skin.update_tinted(body, numbers, &colours));
                    let crumbs = skin.crumbs().iter();
                    let crumbs = crumbs.filter_map(|&id| crumb(body, id, numbers, frame));
                    append(&mut self.rounded, crumbs);
                }
                Look::Elements { colour, ages, .. } => {
                    let ages = ages.get(place).map_or(&[][..], Vec::as_slice);
                    let cut = frame.camera.cut;
                    self.boxes.add(place, body, palette, colour, ages, cut);
                }
            }
        }
        self.crumbs = first..self.rounded.len() as u32;
        // In the element view there is no skin to put stickers on.
        if frame.look == Look::Skin {
            let eye = frame.camera.eye();
            for sticker in frame.stickers {
                if let Some((_, body)) = world.soft_bodies().nth(sticker.body) {
                    let skin = &self.skins[sticker.body];
                    self.stickers.add(sticker, skin, body, eye);
                }
            }
        }
        let dust = frame.particles.iter().enumerate();
        let dust = dust.map(|(place, particle)| RoundedInstance {
            colour: particle.colour,
            ..ball(particle.at, particle.radius, place as f32)
        });
        self.dust = append(&mut self.rounded, dust);
        let lines = hands(world).filter_map(|(player, hand)| {
            let below = self.ground_below(hand.position())?;
            let radius = LINE.min(LINE_SHARE * frame.camera.distance);
            let line = Shape::capsule(hand.position(), below, radius);
            RoundedInstance::of(line, palette.hand(player), player as f32)
        });
        let lines: Vec<RoundedInstance> = lines.collect();
        self.lines = append(&mut self.rounded, lines);
        let basket = frame.baskets.iter();
        let basket = basket.filter_map(|basket| {
            let colour = basket.colour.unwrap_or(palette.basket);
            RoundedInstance::of(basket.region, colour, basket.fill)
        });
        self.basket = append(&mut self.rounded, basket);
    }

    /// Returns the number of vertices of bodies.
    pub fn vertex_count(&self) -> usize {
        let skins = self.skins.iter().map(|skin| skin.vertices().len());
        skins.sum::<usize>() + self.boxes.vertices.len()
    }

    fn gather_room(&mut self, world: &World<Dim3>, camera: &Camera) {
        self.walls.clear();
        let fixed = world.rigid_bodies().map(|(_, body)| body);
        let fixed = fixed.filter(|body| body.motion_type() == MotionType::Fixed);
        let planes = fixed.filter_map(|body| plane(&body.shape()));
        self.walls.extend(planes.take(MAX_WALLS));
        self.room.clear();
        let reach = REACH * camera.distance;
        add_planes(&mut self.room, &self.walls, camera.target, reach);
    }

    /// Returns the point of the floor straight below a point [m], or `None` without a floor below it.
    fn ground_below(&self, at: Vec3) -> Option<Vec3> {
        let floors = self.walls.iter().filter(|wall| wall[1] > 0.5);
        let heights = floors.map(|[x, y, z, offset]| (offset - x * at.x - z * at.z) / y);
        let height = heights.fold(f32::MIN, f32::max);
        (f32::MIN < height && height < at.y).then_some(at.with_y(height))
    }
}

/// Returns the instances of a world's hands.
fn balls(world: &World<Dim3>, palette: &Palette) -> impl Iterator<Item = RoundedInstance> {
    hands(world).filter_map(|(player, hand)| {
        RoundedInstance::of(hand.shape(), palette.hand(player), player as f32)
    })
}

/// Appends instances and returns their index range.
fn append(
    all: &mut Vec<RoundedInstance>,
    more: impl IntoIterator<Item = RoundedInstance>,
) -> Range<u32> {
    let first = all.len() as u32;
    all.extend(more);
    first..all.len() as u32
}

fn ball(centre: Vec3, radius: f32, number: f32) -> RoundedInstance {
    RoundedInstance {
        centre,
        radius,
        number,
        ..RoundedInstance::default()
    }
}

/// Returns the instance of a crumb: a ball deformed like its voxel.
fn crumb(
    body: &SoftBody<Dim3>,
    id: ElementId,
    numbers: &VoxelGrid<Dim3>,
    frame: &Frame<'_, Camera>,
) -> Option<RoundedInstance> {
    let element = body.mesh().element(id)?;
    let place = |k: usize| body.positions()[element.nodes[k]].xyz();
    let sum = |side: [usize; 4]| side.map(place).iter().sum::<Vec3>();
    let (low, high) = (sum([0, 1, 2, 3]), sum([4, 5, 6, 7]));
    let along = |low: [usize; 4], high: [usize; 4]| 0.25 * (sum(high) - sum(low));
    let [red, green, blue] = frame.colour(numbers.material(element.cell.at));
    Some(RoundedInstance {
        centre: 0.125 * (low + high),
        radius: CRUMB,
        axes: Mat3::from_cols(
            along([0, 2, 4, 6], [1, 3, 5, 7]),
            along([0, 1, 4, 5], [2, 3, 6, 7]),
            along([0, 1, 2, 3], [4, 5, 6, 7]),
        ),
        half: Vec3::ZERO,
        colour: [red, green, blue, 1.0],
        number: id.0 as f32,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use fuwafuwa::{Material, RigidBody, VoxelGrid, WorldConfig};

    #[test]
    fn gather_places_room_bars_hands_crumbs_and_lines() {
        let mut world = World::<Dim3>::new(WorldConfig::default()).unwrap();
        let floor = Shape::half_space(Vec3::Y, Vec3::new(0.0, -0.5, 0.0));
        let bar = Shape::capsule(Vec3::ZERO, Vec3::X, 0.1);
        let hand = RigidBody::coupled(Shape::ball(0.2));
        for body in [
            RigidBody::fixed(floor),
            RigidBody::fixed(bar),
            hand.at(Vec3::new(0.0, 3.0, 1.0)),
        ] {
            world.add_rigid_body(body).unwrap();
        }
        let grid = VoxelGrid::from_fn([5, 2, 2], 0.5, |[x, ..]| u8::from(x != 2)).unwrap();
        world
            .add_soft_body(SoftBody::new(grid, &[Material::default()]).unwrap())
            .unwrap();
        let grid = VoxelGrid::from_fn([1, 1, 1], 0.5, |_| 1).unwrap();
        let crumb = SoftBody::new(grid, &[Material::default()]).unwrap();
        world
            .add_soft_body(crumb.translated(2.0 * Vec3::Y))
            .unwrap();
        let palette = Palette::candy();
        let mut frame = Frame::new(Camera::fit(Vec3::NEG_ONE, Vec3::ONE, [1, 1]), &palette);
        let mut geometry = Geometry::default();
        for is_first in [true, false] {
            geometry.gather(&world, &frame);
            assert_eq!(geometry.renewed, [is_first; 2]);
        }
        assert_eq!(
            (
                geometry.bars.len(),
                geometry.hands.len(),
                geometry.crumbs.len()
            ),
            (1, 1, 1)
        );
        assert_eq!((geometry.room.len(), geometry.boxes.vertices.len()), (6, 0));
        let crumb = geometry.rounded[geometry.crumbs.start as usize];
        assert_eq!(crumb.centre.to_array(), [0.25, 2.25, 0.25]);
        assert_eq!(crumb.axes.y_axis, 0.5 * Vec3::Y);
        let line = geometry.rounded[geometry.lines.start as usize];
        assert_eq!(
            (line.centre.to_array(), line.half.x),
            ([0.0, 1.25, 1.0], 1.75)
        );
        frame.look = Look::Elements {
            colour: crate::frame::ElementColour::Level,
            ages: &[],
            nodes: false,
        };
        geometry.gather(&world, &frame);
        assert!(geometry.boxes.vertices.len() > 6 * 4 && geometry.crumbs.is_empty());
    }
}
