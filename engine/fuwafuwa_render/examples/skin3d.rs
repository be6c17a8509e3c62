//! Measures the CPU time of each part of a 3D picture while a hand tears a ball: `cargo run --release -p
//! fuwafuwa_render --example skin3d -- [body.n=64 …]`.

use fuwafuwa::{Dim3, PieceId, SoftBody, Vec3, World};
use fuwafuwa_render::frame::ElementColour;
use fuwafuwa_render::space::{Camera, Cut, Geometry, Skin};
use fuwafuwa_render::{Ages, Frame, Look, Mark, Palette, Sticker, anchor};
use fuwafuwa_scenes::Scene;
use std::error::Error;
use std::f32::consts::TAU;
use std::time::Instant;

const TICKS: u64 = 150;
/// Number of measurements per tick. Only the shortest time is reported, because other processes can slow down
/// a measurement.
const GOES: usize = 3;
/// Names of the pictures that are measured besides the skin alone.
const PARTS: [&str; 4] = [
    "skin in a room",
    "skin and a face",
    "elements, moving cut",
    "skin and a ghost",
];

fn main() -> Result<(), Box<dyn Error>> {
    let scene = Scene::open("tear-3d", &std::env::args().skip(1).collect::<Vec<_>>())?;
    let mut world = scene.build::<Dim3>()?;
    let palette = Palette::candy();
    let mut skins = vec![Skin::default(); GOES];
    let mut geometries = PARTS.map(|_| vec![Geometry::default(); GOES]);
    let mut ages = Ages::default();
    let mut times: [Vec<(bool, f64)>; PARTS.len() + 1] = Default::default();
    for tick in 0..=TICKS {
        let mut is_new = false;
        let skin = best(&mut skins, |skin| {
            is_new = skin.update(first_body(&world), &palette.materials);
        });
        times[0].push((is_new, skin));
        ages.update(&world, 1.0 / 60.0);
        let stickers = [face(&world)];
        for (part, geometries) in geometries.iter_mut().enumerate() {
            let share = 0.7 + 0.3 * (tick as f32 / 20.0).sin();
            let [low, high] = scene.view.map(Vec3::from);
            let camera = Camera::fit(low, high, [1, 1]);
            let mut frame = Frame::new(camera, &palette);
            match part {
                0 => {}
                1 => frame.stickers = &stickers,
                2 => {
                    let direction = Vec3::Z;
                    frame.camera.cut = Some(Cut { direction, share });
                    frame.look = Look::Elements {
                        colour: ElementColour::Strain,
                        ages: &ages.seconds,
                        nodes: false,
                    };
                }
                _ => frame.ghost = Some(&world),
            }
            let time = best(geometries, |geometry| geometry.gather(&world, &frame));
            times[part + 1].push((is_new, time));
        }
        scene.set_hand_targets(&mut world, tick);
        world.step();
    }
    let skin = &skins[0];
    println!(
        "{} vertices, {} triangles, {} crumbs; elements have {} vertices",
        skin.vertices().len(),
        skin.indices().len() / 3,
        skin.crumbs().len(),
        geometries[2][0].vertex_count()
    );
    for (name, times) in ["skin alone"].iter().chain(&PARTS).zip(&times) {
        println!("{name}: first call {:.1} ms", times[0].1);
        for (state, is_torn) in [("still", false), ("torn", true)] {
            let chosen = times[1..].iter().filter(|(is_new, _)| *is_new == is_torn);
            let mut chosen: Vec<f64> = chosen.map(|(_, time)| *time).collect();
            chosen.sort_by(f64::total_cmp);
            if let (Some(median), Some(worst)) = (chosen.get(chosen.len() / 2), chosen.last()) {
                let count = chosen.len();
                println!("  {state}: {count} ticks, median {median:.2} ms, worst {worst:.2} ms");
            }
        }
    }
    Ok(())
}

/// Returns the time of the fastest repetition [ms].
fn best<T>(goes: &mut [T], mut act: impl FnMut(&mut T)) -> f64 {
    let times = goes.iter_mut().map(|go| {
        let begin = Instant::now();
        act(go);
        1e3 * begin.elapsed().as_secs_f64()
    });
    times.fold(f64::INFINITY, f64::min)
}

fn first_body(world: &World<Dim3>) -> &SoftBody<Dim3> {
    let first = world.soft_bodies().next();
    first.expect("the scene has a body").1
}

/// Returns a sticker (coloured patches on the skin) with as many corners as the painted eyes and mouth of a
/// body in the game.
fn face(world: &World<Dim3>) -> Sticker {
    let body = first_body(world);
    let anchor = anchor(body);
    let mark = |k: u32| {
        let count = if k < 12 { 28 } else { 16 };
        let corners = (0..count).map(|step| {
            let (sin, cos) = (TAU * step as f32 / count as f32).sin_cos();
            [0.07 * (k as f32 - 11.0) + 0.2 * cos, 0.2 * sin]
        });
        Mark {
            outline: corners.collect(),
            colour: [1.0; 4],
            bulge: 0.05,
            lift: 0.0,
        }
    };
    let views = body.piece_views();
    let largest = views.iter().max_by(|a, b| a.mass.total_cmp(&b.mass));
    Sticker {
        body: 0,
        piece: largest.map_or(PieceId(0), |piece| piece.number),
        origin: anchor.position,
        axes: anchor.axes.map(|axis| axis * (0.55 * anchor.scale)),
        marks: (0..22).map(mark).collect(),
    }
}
