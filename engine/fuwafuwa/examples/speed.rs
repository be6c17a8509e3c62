//! Times a free ball that spins and vibrates, whole and torn. Prints nanoseconds per element and substep, for
//! forces and motion together.
//!
//! `cargo run --release -p fuwafuwa --example speed`
#![allow(clippy::disallowed_types, clippy::disallowed_methods)] // a benchmark needs the clock

use fuwafuwa::{Dim, Dim2, Dim3, Material, SoftBody, Vector, VoxelGrid};
use std::error::Error;
use std::time::Instant;

fn main() -> Result<(), Box<dyn Error>> {
    measure("2D ball, n = 128", ball::<Dim2>(128)?);
    measure("2D ball, n = 128, torn", torn::<Dim2>(128, 200)?);
    measure("3D ball, n = 32", ball::<Dim3>(32)?);
    measure("3D ball, n = 32, torn", torn::<Dim3>(32, 100)?);
    measure("3D ball, n = 32, in tatters", torn::<Dim3>(32, 600)?);
    measure("3D ball, n = 64", ball::<Dim3>(64)?);
    measure("3D ball, n = 64, torn", torn::<Dim3>(64, 300)?);
    Ok(())
}

fn ball<D: Dim>(n: usize) -> Result<SoftBody<D>, Box<dyn Error>> {
    Ok(SoftBody::new(
        VoxelGrid::ball(n, 1.0)?,
        &[Material::default()],
    )?)
}

/// A ball with `cracks` cracks, each normal to an axis, a few voxels wide and opened point by point.
fn torn<D: Dim>(n: usize, cracks: usize) -> Result<SoftBody<D>, Box<dyn Error>> {
    let mut body = ball::<D>(n)?;
    let mut seed = 1u64;
    let mut random = |end: usize| {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        ((seed >> 33) % end as u64) as i32
    };
    for _ in 0..cracks {
        let axis = random(D::N) as usize;
        let middle = [0; 3].map(|_: i32| random(n + 1));
        let radius = 2 + random(n / 6);
        // Octants on the lower side of the crack.
        let side = (0..D::CORNERS).filter(|octant| octant >> axis & 1 == 0);
        let side: u8 = side.map(|octant| 1 << octant).sum();
        let reach = |other: usize| {
            if other < D::N && other != axis {
                radius
            } else {
                0
            }
        };
        for dx in -reach(0)..=reach(0) {
            for dy in -reach(1)..=reach(1) {
                let line = -reach(2)..=reach(2);
                let points = line.map(|dz| [middle[0] + dx, middle[1] + dy, middle[2] + dz]);
                let points = points.map(|[x, y, z]| ([x, y, if D::N == 2 { 0 } else { z }], side));
                body.release(&points.collect::<Vec<_>>())?;
            }
        }
    }
    Ok(body)
}

fn measure<D: Dim>(name: &str, mut body: SoftBody<D>) {
    // Without strain the result would be too good: bodies in a game are strained.
    let nodes: Vec<_> = body.mesh().nodes().map(|(id, _)| id).collect();
    for &id in &nodes {
        let (at, ..) = body.node_state(id);
        let velocity = Vector::new(3.0 * (at.y - 0.5), -3.0 * (at.x - 0.5), 0.5 * (at.z - 0.5));
        body.set_node_state(id, at, velocity);
    }
    let elements = body.mesh().element_count();
    let mut times: Vec<f64> = (0..300)
        .map(|_| {
            let start = Instant::now();
            body.advance(1.0 / 3840.0, Vector::new(0.0, -9.81, 0.0));
            start.elapsed().as_nanos() as f64 / elements as f64
        })
        .collect();
    times.sort_by(f64::total_cmp);
    println!(
        "{name}: {elements} elements, {} nodes, {} pieces, median {:.1} ns, best {:.1} ns",
        nodes.len(),
        body.piece_views().len(),
        times[times.len() / 2],
        times[0]
    );
}
