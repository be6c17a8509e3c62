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
use fuwafuwa::inspect::{hands, moving_obstacles, obstacles};
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
/// Shares of a basket, 0 to 1. A bar that hides less than the first share is opaque; one that hides at least the second
/// share has the opacity `THIN`.
const HIDDEN: [f32; 2] = [0.25, 0.5];
/// Opacity of a bar that hides a basket, 0 to 1.
const THIN: f32 = 0.42;
/// Distance at which a line of sight has met a bar, as a multiple of its length, and the maximum number of its steps.
const NEAR: f32 = 1e-3;
const SIGHT_STEPS: usize = 24;

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
    /// Instances of bars, hands, props, glass, parts of the ghost, crumbs, dust, lines below hands, and the basket, in this
    /// order. Bars that hide a basket come last among the bars.
    pub(crate) rounded: Vec<RoundedInstance>,
    pub(crate) bars: Range<u32>,
    /// Bars that hide a basket, which are translucent.
    pub(crate) thin_bars: Range<u32>,
    pub(crate) hands: Range<u32>,
    pub(crate) props: Range<u32>,
    pub(crate) glass: Range<u32>,
    /// Hands and moving obstacles of the ghost world.
    pub(crate) ghost_parts: Range<u32>,
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
        let (glass, bars): (Vec<_>, Vec<_>) = obstacles(world).partition(|bar| is_glass(*bar));
        let bars = bars.into_iter().filter_map(|bar| {
            let (colour, fabric) = match is_curtain(world, bar) {
                true => (palette.curtain, 1.0),
                false => (palette.bar, 0.0),
            };
            let mut instance = RoundedInstance::of(bar.shape(), colour, fabric)?;
            let hidden = { frame.baskets.iter() }
                .map(|basket| hidden_share(&bar.shape(), &basket.region, frame.camera.eye()));
            instance.colour[3] = opacity(hidden.fold(0.0, f32::max));
            Some(instance)
        });
        let (thin, bars): (Vec<_>, Vec<_>) = bars.partition(|bar| bar.colour[3] < 1.0);
        self.bars = append(&mut self.rounded, bars);
        self.thin_bars = append(&mut self.rounded, thin);
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
        let glass = glass.into_iter();
        let glass = glass.filter_map(|bar| RoundedInstance::of(bar.shape(), palette.glass, 0.0));
        self.glass = append(&mut self.rounded, glass);
        let of_ghost = { frame.ghost.into_iter() }.flat_map(|ghost| {
            let parts = moving_obstacles(ghost);
            let parts =
                parts.filter_map(|part| RoundedInstance::of(part.shape(), palette.bar, 0.0));
            balls(ghost, palette).chain(parts)
        });
        self.ghost_parts = append(&mut self.rounded, of_ghost);
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

/// Returns the opacity of a bar that hides a share of a basket.
fn opacity(hidden: f32) -> f32 {
    let most = ((hidden - HIDDEN[0]) / (HIDDEN[1] - HIDDEN[0])).clamp(0.0, 1.0);
    1.0 - (1.0 - THIN) * most
}

/// Returns the share of a basket, 0 to 1, that a bar hides from the eye.
fn hidden_share(bar: &Shape<Dim3>, basket: &Shape<Dim3>, eye: Vec3) -> f32 {
    let [low, high] = basket.bounds();
    let hides = |place: &usize| {
        let step = Vec3::new(
            (place % 3) as f32,
            (place / 3 % 3) as f32,
            (place / 9) as f32,
        );
        let at = low + (high - low) * (step + 0.5) / 3.0;
        let (reach, mut along) = (eye.distance(at), 0.0);
        // Each step along the line of sight is as long as the distance to the bar, so that none passes through it.
        for _ in 0..SIGHT_STEPS {
            if reach <= along {
                return false;
            }
            let away = bar.distance(eye.lerp(at, along / reach)).0;
            if away < NEAR * reach {
                return true;
            }
            along += away;
        }
        false
    };
    let samples = 27;
    (0..samples).filter(hides).count() as f32 / samples as f32
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
    fn bars_that_hide_a_basket_are_translucent() {
        let mut world = World::<Dim3>::new(WorldConfig::default()).unwrap();
        let cube = |half: f32| Shape::cuboid(Vec3::splat(half));
        let lid = Shape::cuboid(Vec3::new(0.5, 0.1, 0.5)).translated(Vec3::Y);
        let floor = Shape::cuboid(Vec3::new(2.0, 0.1, 2.0)).translated(Vec3::NEG_Y);
        for shape in [lid, floor] {
            world.add_rigid_body(RigidBody::fixed(shape)).unwrap();
        }
        let palette = Palette::candy();
        let mut camera = Camera::fit(Vec3::splat(-2.0), Vec3::splat(2.0), [1, 1]);
        let basket = crate::frame::Basket {
            region: cube(0.3),
            fill: 0.0,
            colour: None,
        };
        // From above the lid hides the basket, and from the front nothing does.
        for (elevation, thin) in [(1.5, 1), (0.0, 0)] {
            camera.elevation = elevation;
            let frame = Frame {
                baskets: vec![basket],
                ..Frame::new(camera, &palette)
            };
            let mut geometry = Geometry::default();
            geometry.gather(&world, &frame);
            assert_eq!(
                [geometry.bars.len(), geometry.thin_bars.len()],
                [2 - thin, thin]
            );
        }
        let eye = 5.0 * Vec3::Y;
        assert_eq!(hidden_share(&lid, &cube(0.3), eye), 1.0);
        let half = lid.translated(0.5 * Vec3::X);
        assert_eq!(hidden_share(&half, &cube(0.3), eye), 2.0 / 3.0);
        assert_eq!(opacity(0.0), 1.0);
        assert!((opacity(1.0) - THIN).abs() < 1e-6);
    }

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
