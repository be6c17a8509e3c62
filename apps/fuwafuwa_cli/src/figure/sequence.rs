//! A body being cut: in 2D by a pushing hand, in 3D by a blade.

use super::legend::level_entries;
use crate::report::Progress;
use anyhow::Result;
use fuwafuwa::inspect::Elasticity;
use fuwafuwa::{
    Blade, DEFAULT_TICK, Damping, Dim2, Dim3, Material, RigidBody, Shape, SoftBody, Vec2, Vec3,
    VoxelGrid, World, WorldConfig,
};
use fuwafuwa_painter::solid::{Camera, Scene3d};
use fuwafuwa_painter::worlds::{self, DrawPlane, DrawSpace};
use fuwafuwa_painter::{PaintError, Painter, PaperTransform, Pixmap, Role, Sample, film};

/// Display time of a film frame [1/100 s].
pub const HUNDREDTHS: u16 = 6;
/// Width and height of a frame [px].
const SIZE: u32 = 400;
/// Ticks between two frames.
const PACE: usize = 4;

/// Draws figure 6: a hand tears through a disc. Returns the strip and the frames of the film.
pub fn disc() -> Result<(Painter, Vec<Pixmap>)> {
    const TICKS: usize = 200;
    let material = Material {
        elasticity: Elasticity::new(5000.0, 0.3)?,
        damping: Damping::at(0.5, 4.0),
        strength: 1000.0,
        toughness: 200.0,
        ..Material::default()
    };
    let mut world = World::<Dim2>::new(WorldConfig::default())?;
    let floor = Shape::half_space(Vec2::Y, Vec2::ZERO);
    world.add_rigid_body(RigidBody::fixed(floor).with_friction(0.6))?;
    for (x, lean) in [(-0.13, 1.0), (1.13, -1.0)] {
        let wall = Shape::cuboid(Vec2::new(0.08, 0.2)).translated(Vec2::new(x - 0.05 * lean, 0.2));
        world.add_rigid_body(RigidBody::fixed(wall).with_friction(0.4))?;
    }
    world.add_soft_body(SoftBody::new(VoxelGrid::ball(40, 1.0)?, &[material])?)?;
    let hand = RigidBody::kinematic(Shape::ball(0.055)).at(Vec2::new(0.46, 1.2));
    let hand = world.add_rigid_body(hand)?;

    let progress = Progress::new();
    progress.expect(TICKS as u64);
    let (mut elements, mut skins) = (Vec::new(), Vec::new());
    for tick in 0..TICKS {
        if tick % PACE == 0 {
            elements.push(plane_frame(&world, tick, worlds::plane_elements)?);
            skins.push(plane_frame(&world, tick, worlds::plane_skin)?);
        }
        let way = (tick as f32 / (TICKS as f32 * 0.8)).min(1.0);
        world.set_target_position(hand, Vec2::new(0.46 + 0.05 * way, 1.2 - 1.1 * way))?;
        world.step();
        progress.step();
    }
    let mut strip = film::strip(&moments(&elements, &[0.0, 0.42, 0.57, 0.62, 0.68, 1.0]), 3)?;
    strip.extend(64);
    let mut entries = level_entries(5);
    entries.push((Sample::Line(Role::Crack), "torn"));
    let y = strip.size()[1] as f32 - 50.0;
    strip.legend(y, &entries);
    let beside = |(elements, skin)| film::strip(&[elements, skin], 2)?.pixels();
    let frames = elements.into_iter().zip(skins).map(beside);
    Ok((strip, frames.collect::<Result<_, PaintError>>()?))
}

/// Draws figure 6 in 3D: a blade cuts through a ball on the floor, and the halves separate. The strip shows
/// the skin above and a section through the elements below; the film shows the skin.
pub fn ball() -> Result<(Painter, Vec<Pixmap>)> {
    const TICKS: usize = 108;
    const ACROSS: usize = 24;
    let material = Material {
        elasticity: Elasticity::new(12_000.0, 0.3)?,
        damping: Damping::at(0.4, 4.0),
        strength: f32::INFINITY,
        ..Material::default()
    };
    let mut world = World::<Dim3>::new(WorldConfig::default())?;
    let floor = Shape::half_space(Vec3::Y, Vec3::ZERO);
    world.add_rigid_body(RigidBody::fixed(floor).with_friction(1.0))?;
    let low = -1.0 / ACROSS as f32;
    let body = SoftBody::new(VoxelGrid::ball(ACROSS, 1.0)?, &[material])?;
    let ball = world.add_soft_body(body.translated(Vec3::new(0.0, low, 0.0)))?;
    let progress = Progress::new();
    progress.expect(TICKS as u64);
    let (mut skins, mut sections) = (Vec::new(), Vec::new());
    for tick in 0..TICKS {
        if tick % PACE == 0 {
            let way = tick as f32 / TICKS as f32;
            let depth = 1.2 * ((way - 0.1) / 0.6).clamp(0.0, 1.0);
            let corner = Vec3::new(0.51, 1.0, -0.5);
            let downwards = Vec3::new(0.0, -depth, 0.0);
            let blade = Blade::parallelogram(corner, downwards, 2.0 * Vec3::Z);
            world.cut(ball, &blade)?;
            skins.push(space_frame(&world, tick, worlds::space_skin)?);
            sections.push(space_frame(&world, tick, draw_section)?);
        }
        world.step();
        progress.step();
    }
    let at = [0.0, 0.42, 0.74, 1.0];
    let mut both = moments(&skins, &at);
    both.extend(moments(&sections, &at));
    let mut strip = film::strip(&both, at.len())?;
    strip.extend(64);
    let mut entries = vec![
        (Sample::Area(Role::Skin, Role::Skin), "skin"),
        (Sample::Area(Role::TornSurface, Role::TornSurface), "cut"),
    ];
    entries.extend(level_entries(3));
    let y = strip.size()[1] as f32 - 50.0;
    strip.legend(y, &entries);
    Ok((strip, skins))
}

/// Draws the elements in the rear half of the body, according to the rest shape.
fn draw_section(solid: &mut Scene3d, body: &SoftBody<Dim3>) {
    let middle = body.grid().size()[2] / 2;
    worlds::space_elements(solid, body, |view| {
        let element = body.mesh().element(view.id);
        element.is_some_and(|element| element.cell.first_voxel()[2] < middle)
    });
}

fn plane_frame(world: &World<Dim2>, tick: usize, draw: DrawPlane) -> Result<Pixmap> {
    const UNIT: f32 = 285.0;
    let mut painter = Painter::new(SIZE, SIZE);
    let frame = PaperTransform {
        origin: [0.5 * (SIZE as f32 - UNIT), SIZE as f32 - 34.0],
        unit: UNIT,
    };
    worlds::plane(&mut painter, frame, world, draw);
    write_time(&mut painter, tick);
    Ok(painter.pixels()?)
}

fn space_frame(world: &World<Dim3>, tick: usize, draw: DrawSpace) -> Result<Pixmap> {
    let mut solid = Scene3d::new(Camera {
        eye: Vec3::new(1.5, 2.0, 3.7),
        target: Vec3::new(0.5, 0.42, 0.5),
        across: 2.3,
    });
    worlds::space(&mut solid, world, draw);
    let mut painter = Painter::new(SIZE, SIZE);
    painter.image([0.0; 2], solid.pixels(SIZE, SIZE)?);
    write_time(&mut painter, tick);
    Ok(painter.pixels()?)
}

fn write_time(painter: &mut Painter, tick: usize) {
    let seconds = format!("{:.1} s", tick as f32 * DEFAULT_TICK);
    painter.text([16.0, 16.0], 14.0, Role::Ink, &seconds);
}

/// Selects frames by their positions `at` in the film, 0 (first) to 1 (last).
fn moments(frames: &[Pixmap], at: &[f32]) -> Vec<Pixmap> {
    let last = (frames.len() - 1) as f32;
    at.iter()
        .map(|way| frames[(way * last).round() as usize].clone())
        .collect()
}
