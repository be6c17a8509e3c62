//! Comparison of a disc that is cut into many pieces, which touch each other.

use fuwafuwa::{Blade, Dim2, Vec2, World};
use rapier2d::prelude::{SoftBodyHandle, Vector};

use crate::side::{EngineResult, fall};
use crate::world::{Falling, plane};
use crate::{Drop, Effort, Error, Result, WIDTH, disc, ours};

/// Cuts a disc into squares and lets the pieces fall, alternating the engines frame by frame. Returns the
/// results of fuwafuwa and of Rapier. The cuts follow first the vertical and then the horizontal lines of a
/// lattice. Each piece is `pitch` voxels wide, or less at the rim. Contacts between pieces have the same
/// settings as contacts with the floor.
///
/// # Errors
/// [`Error`] if the scene is invalid.
pub fn compare_tear(scene: &Drop, pitch: usize, effort: Effort) -> Result<[EngineResult; 2]> {
    for (field, holds, expected) in [
        ("dim", scene.dim == 2, "2"),
        ("pitch", pitch > 0, "at least 1"),
    ] {
        if !holds {
            return Err(Error::Scene { field, expected });
        }
    }
    let mut theirs = disc(scene, effort)?;
    cut_to_pieces(&mut theirs, scene, pitch, 0.0);
    let mut ours = ours::world::<Dim2>(scene, None)?;
    let whole = ours::body(&ours).piece_views()[0];
    let middle = 0.5 * (whole.low.x + whole.high.x);
    cut_to_pieces(&mut ours, scene, pitch, middle);
    Ok(fall([Box::new(ours), Box::new(theirs)], scene.frames))
}

/// Cuts a disc with its centre at the height `middle` [m]. The cuts lie on boundaries between voxels, so that
/// no triangle is cut and no piece has a frayed rim.
fn cut_to_pieces(world: &mut impl Cut, scene: &Drop, pitch: usize, middle: f32) {
    let lowest = world.span().lowest;
    let voxel = WIDTH / scene.n as f32;
    let far = 2.0 * WIDTH;
    let lines = || {
        (1..scene.n)
            .filter(|k| k % pitch == 0)
            .map(|k| k as f32 * voxel)
    };
    for x in lines().map(|x| middle - 0.5 * WIDTH + x) {
        world.cut_all([Vec2::new(x, -far), Vec2::new(x, far)]);
    }
    for y in lines().map(|y| lowest + y) {
        world.cut_all([Vec2::new(middle - far, y), Vec2::new(middle + far, y)]);
    }
}

/// World with soft bodies that can be cut.
trait Cut: Falling {
    /// Cuts all soft bodies along a segment.
    fn cut_all(&mut self, blade: [Vec2; 2]);
}

impl Cut for World<Dim2> {
    fn cut_all(&mut self, [from, to]: [Vec2; 2]) {
        let body = self.nth_soft_body(0).expect("world with a body");
        self.cut(body, &Blade::segment(from, to))
            .expect("the handle is valid");
    }
}

impl Cut for plane::World {
    /// Cuts each piece separately: a call of Rapier cuts only one piece.
    fn cut_all(&mut self, blade: [Vec2; 2]) {
        let blade = blade.map(|point| Vector::new(point.x, point.y));
        let bodies = self.rapier.soft_bodies();
        let pieces: Vec<SoftBodyHandle> = bodies.map(|(handle, _)| handle).collect();
        for piece in pieces {
            self.rapier.cut_soft_body(piece, &blade);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cut_disc_has_the_expected_number_of_pieces() {
        let scene = Drop {
            height: 0.05,
            frames: 10,
            ..Drop::diced(8)
        };
        // The disc has 32 voxels, in rows of 4, 6, 6, 6, 6 and 4. Pitch 1 separates all voxels. Pitch 4 cuts
        // once in each direction through the middle and gives four quarters.
        for (pitch, pieces) in [(1, 32), (4, 4)] {
            for side in compare_tear(&scene, pitch, Effort::default()).expect("the scene is valid")
            {
                assert_eq!(side.pieces, pieces);
                assert!(side.finite && side.milliseconds.len() == 10);
            }
        }
    }
}
