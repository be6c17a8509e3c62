//! Rigid bodies, hands and the basket as rectangles into which a shader draws their shapes.

use crate::frame::{Basket, Particle};
use crate::palette::{Colour, Palette};
use bytemuck::{Pod, Zeroable};
use fuwafuwa::inspect::{hands, obstacles};
use fuwafuwa::{Dim, Dim2, Layers, RigidBodyRef, Shape, World};
use glam::Vec2;

/// Maximum number of half-spaces drawn, limited by the size of uniform buffers on small devices.
pub const MAX_WALLS: usize = 16;

/// Shape with a colour, as an instance for the shader.
#[repr(C)]
#[derive(Copy, Clone, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct RigidInstance {
    /// Start of a capsule, or the centre [m].
    pub from: Vec2,
    /// End of a capsule, or half extents of a box [m].
    pub to: Vec2,
    /// Radius [m], or the rotation angle of a box [rad].
    pub radius: f32,
    /// 0 = capsule, 1 = box, 2 = ball.
    pub form: f32,
    /// Player number of a hand, or fill level of a basket. Of a bar: 0 if it is wood, 1 if it is glass, 2 if it is a
    /// curtain.
    pub number: f32,
    /// Red, green, blue.
    pub colour: Colour,
}

/// Round dot.
#[repr(C)]
#[derive(Copy, Clone, Debug, PartialEq, Pod, Zeroable)]
pub struct DotInstance {
    /// Centre [m].
    pub at: Vec2,
    /// Radius [m].
    pub radius: f32,
    /// Red, green, blue, opacity.
    pub colour: [f32; 4],
}

/// Rigid shapes and particles of a picture.
#[derive(Clone, Debug, Default)]
pub struct RigidShapes {
    /// Outward normal and offset [m] of each half-space.
    pub walls: Vec<[f32; 4]>,
    /// Bars (fixed and dynamic rigid bodies, except sensors), then hands, then the basket.
    pub shapes: Vec<RigidInstance>,
    /// Number of bars in `shapes`.
    pub bar_count: u32,
    /// Number of hands in `shapes`.
    pub hand_count: u32,
    /// Particles.
    pub dots: Vec<DotInstance>,
}

impl RigidShapes {
    /// Replaces the contents with the current shapes.
    pub fn gather(
        &mut self,
        world: &World<Dim2>,
        palette: &Palette,
        baskets: &[Basket<Dim2>],
        particles: &[Particle],
    ) {
        self.walls.clear();
        self.shapes.clear();
        self.dots.clear();
        for obstacle in obstacles(world) {
            let shape = obstacle.shape();
            if let Shape::HalfSpace { normal, offset } = shape {
                self.walls.push([normal.x, normal.y, offset, 0.0]);
            }
            let (colour, fabric) = match obstacle {
                _ if is_glass(obstacle) => (palette.glass, 1.0),
                _ if is_curtain(world, obstacle) => (palette.curtain, 2.0),
                _ => (palette.bar, 0.0),
            };
            self.shapes.extend(instance(shape, colour, fabric));
        }
        self.walls.truncate(MAX_WALLS);
        self.bar_count = self.shapes.len() as u32;
        for (player, hand) in hands(world) {
            let hand = instance(hand.shape(), palette.hand(player), player as f32);
            self.shapes.extend(hand);
        }
        self.hand_count = self.shapes.len() as u32 - self.bar_count;
        for basket in baskets {
            let colour = basket.colour.unwrap_or(palette.basket);
            self.shapes
                .extend(instance(basket.region, colour, basket.fill));
        }
        self.dots
            .extend(particles.iter().map(|particle| DotInstance {
                at: particle.at.truncate(),
                radius: particle.radius,
                colour: particle.colour,
            }));
    }
}

/// Returns whether a rigid body is drawn as glass: bodies with the default layers pass through it.
pub fn is_glass<D: Dim>(body: RigidBodyRef<'_, D>) -> bool {
    !body.layers().meet(Layers::default())
}

/// Returns whether a rigid body is drawn as a curtain: hands pass through it.
pub fn is_curtain<D: Dim>(world: &World<D>, body: RigidBodyRef<'_, D>) -> bool {
    let hand = hands(world).next();
    hand.is_some_and(|(_, hand)| body.layers().filters & hand.layers().memberships == 0)
}

/// Returns the rectangle instance of a bounded shape, or `None` for a half-space.
fn instance(shape: Shape<Dim2>, colour: Colour, number: f32) -> Option<RigidInstance> {
    let (from, to, radius, form) = match shape {
        Shape::HalfSpace { .. } => return None,
        Shape::Capsule { from, to, radius } => (from, to, radius, 0.0),
        Shape::Box { centre, half } => (centre, half, 0.0, 1.0),
        Shape::OrientedBox {
            centre,
            half,
            rotation,
        } => (centre, half, rotation.scaled_axis().z, 1.0),
        Shape::Ball { centre, radius } => (centre, centre, radius, 2.0),
    };
    Some(RigidInstance {
        from,
        to,
        radius,
        form,
        number,
        colour,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use fuwafuwa::{RigidBody, Rotation, WorldConfig};
    use glam::Vec3;

    #[test]
    fn gather_sorts_walls_bars_hands_and_basket() {
        let mut world = World::<Dim2>::new(WorldConfig::default()).unwrap();
        let floor = Shape::half_space(Vec2::Y, Vec2::new(0.0, -2.0));
        let bar = Shape::capsule(Vec2::ZERO, Vec2::X, 0.1);
        let hand = RigidBody::coupled(Shape::ball(0.2)).with_layers(Layers {
            memberships: 2,
            ..Layers::default()
        });
        let fence = Layers {
            memberships: 1,
            filters: 2,
        };
        let curtain = Layers {
            memberships: 1,
            filters: 1,
        };
        let fallen = RigidBody::dynamic(Shape::cuboid(Vec2::new(0.3, 0.2)), 1.0);
        for body in [
            RigidBody::fixed(floor),
            RigidBody::fixed(bar),
            hand.at(Vec2::new(0.0, 3.0)),
            hand.at(Vec2::new(1.0, 3.0)),
            RigidBody::fixed(bar).with_layers(fence),
            RigidBody::fixed(bar).with_layers(curtain),
            fallen.rotated(Rotation::in_plane(0.5)),
        ] {
            world.add_rigid_body(body).unwrap();
        }
        let region = Shape::cuboid(Vec2::splat(0.25)).translated(Vec2::splat(0.5));
        let basket = Basket {
            region,
            fill: 0.5,
            colour: None,
        };
        let dot = Particle {
            at: Vec3::new(1.0, 2.0, 0.0),
            radius: 0.01,
            colour: [1.0; 4],
        };
        let mut rigid = RigidShapes::default();
        for _ in 0..2 {
            rigid.gather(&world, &Palette::candy(), &[basket], &[dot]);
        }
        assert_eq!(rigid.walls, [[0.0, 1.0, -2.0, 0.0]]);
        assert_eq!(
            (rigid.bar_count, rigid.hand_count, rigid.shapes.len()),
            (4, 2, 7)
        );
        let fabrics: Vec<f32> = rigid.shapes[..4].iter().map(|bar| bar.number).collect();
        assert_eq!(fabrics, [0.0, 1.0, 2.0, 0.0]);
        assert!((rigid.shapes[3].radius - 0.5).abs() < 1e-5);
        assert_ne!(rigid.shapes[4].colour, rigid.shapes[5].colour);
        assert_eq!((rigid.shapes[6].number, rigid.dots.len()), (0.5, 1));
    }
}
