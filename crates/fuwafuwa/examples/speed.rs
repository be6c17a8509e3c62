//! Times a free ball that spins and swings: nanoseconds an element and substep, forces and motion together.
//!
//! `cargo run --release -p fuwafuwa --example speed`
#![allow(clippy::disallowed_types, clippy::disallowed_methods)] // a benchmark needs the clock

use fuwafuwa::{Body, Dim, Dim2, Dim3, Material, VoxelGrid};
use std::time::Instant;

fn measure<D: Dim>(n: usize) -> Result<(), Box<dyn std::error::Error>> {
    let mut body = Body::<D>::new(VoxelGrid::ball(n, 1.0)?, &[Material::default()])?;
    // A body without strain would be kinder than any in a game.
    let nodes: Vec<u32> = body.mesh().nodes().map(|(id, _)| id).collect();
    for id in nodes {
        let ([x, y, z], ..) = body.node_state(id);
        let velocity = [3.0 * (y - 0.5), -3.0 * (x - 0.5), 0.5 * (z - 0.5)];
        body.set_node_state(id, [x, y, z], velocity);
    }
    let elements = body.mesh().element_count();
    let mut times: Vec<f64> = (0..300)
        .map(|_| {
            let start = Instant::now();
            body.advance(1.0 / 3840.0, [0.0, -9.81, 0.0]);
            start.elapsed().as_nanos() as f64 / elements as f64
        })
        .collect();
    times.sort_by(f64::total_cmp);
    println!(
        "{}D ball n = {n}: {elements} elements, median {:.1} ns, best {:.1} ns an element and substep",
        D::N,
        times[times.len() / 2],
        times[0]
    );
    Ok(())
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    measure::<Dim2>(128)?;
    measure::<Dim3>(32)?;
    measure::<Dim3>(64)
}
