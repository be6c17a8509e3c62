//! A disc in many pieces that touch.

use std::time::Instant;

use rapier2d::prelude::{SoftBodyHandle, Vector};

use crate::world::{Falling, plane};
use crate::{Drop, Error, Result, WIDTH, disc};

/// A disc that is cut into squares and then falls.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tear {
    /// The disc and its fall.
    pub drop: Drop,
    /// Voxels along the edge of a piece. 3 makes some 390 pieces of a disc of 64 voxels, 1 one piece of each voxel.
    pub pitch: usize,
}

impl Default for Tear {
    /// The stiff disc of 64 voxels in pieces of 3 × 3, from 0.1 m for 2 s: they burst apart and come to rest.
    fn default() -> Self {
        let drop = Drop {
            n: 64,
            height: 0.1,
            frames: 120,
            ..Drop::default()
        };
        Self { drop, pitch: 3 }
    }
}

/// How tearing and falling went.
#[derive(Clone, Debug)]
pub struct Torn {
    /// Time that each call took that cut something [ms].
    pub cut_milliseconds: Vec<f64>,
    /// Time that each frame took after the cuts [ms].
    pub milliseconds: Vec<f64>,
    /// Pieces after the cuts.
    pub pieces: usize,
    /// Whether every node stayed at a finite place.
    pub finite: bool,
}

/// Cuts a disc along the vertical and then along the horizontal lines of a square lattice, each piece that a line
/// crosses with a call of its own, and lets the pieces fall. They touch each other as they touch the floor.
///
/// # Errors
/// [`Error`] when the scene makes no sense.
pub fn tear_disc(scene: &Tear) -> Result<Torn> {
    if scene.pitch == 0 {
        return Err(Error::Scene {
            field: "pitch",
            expected: "at least 1",
        });
    }
    let mut world = disc(&scene.drop)?;
    let mut cut_milliseconds = Vec::new();
    for blade in blades(scene, world.span().lowest) {
        cut_all(&mut world, blade, &mut cut_milliseconds);
    }
    let pieces = world.rapier.soft_bodies.len();
    let mut finite = true;
    let milliseconds = (0..scene.drop.frames)
        .map(|_| {
            let time = world.timed_step();
            finite &= world.span().finite;
            time
        })
        .collect();
    Ok(Torn {
        cut_milliseconds,
        milliseconds,
        pieces,
        finite,
    })
}

/// The ends of each line. They lie on borders between voxels, so that no triangle is cut and no piece has a frayed rim.
fn blades(scene: &Tear, lowest: f32) -> Vec<[Vector; 2]> {
    let voxel = WIDTH / scene.drop.n as f32;
    let along = || {
        (1..scene.drop.n)
            .filter(|k| k % scene.pitch == 0)
            .map(|k| k as f32 * voxel)
    };
    let far = 2.0 * WIDTH;
    let upright = along()
        .map(|x| x - 0.5 * WIDTH)
        .map(|x| [Vector::new(x, -far), Vector::new(x, far)]);
    let level = along()
        .map(|y| y + lowest)
        .map(|y| [Vector::new(-far, y), Vector::new(far, y)]);
    upright.chain(level).collect()
}

fn cut_all(world: &mut plane::World, blade: [Vector; 2], milliseconds: &mut Vec<f64>) {
    let pieces: Vec<SoftBodyHandle> = world
        .rapier
        .soft_bodies()
        .map(|(handle, _)| handle)
        .collect();
    for piece in pieces {
        let start = Instant::now();
        if world.rapier.cut_soft_body(piece, &blade).is_some() {
            milliseconds.push(start.elapsed().as_secs_f64() * 1e3);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_disc_falls_in_as_many_pieces_as_the_lines_make() {
        let drop = Drop {
            n: 8,
            height: 0.05,
            frames: 10,
            ..Drop::default()
        };
        // 32 voxels: rows of 4, 6, 6, 6, 6 and 4, which no line of pitch 1 leaves together.
        let torn = tear_disc(&Tear { drop, pitch: 1 }).expect("the scene makes sense");
        assert_eq!(torn.pieces, 32);
        assert!(torn.finite);
        // One line each way through the middle makes four quarters.
        let quarters = tear_disc(&Tear { drop, pitch: 4 }).expect("the scene makes sense");
        assert_eq!(quarters.pieces, 4);
    }
}
