//! Which part of the world is seen where on the screen.

use egui::{Pos2, Rect, Vec2, pos2, vec2};
use fuwafuwa::Vector;

/// So much is seen around the arena [m]: room for the lean, so that nothing of the arena goes out of sight.
const MARGIN: f32 = 0.1;
/// The camera leans this share of the way from the middle of the arena towards the hand.
const LEAN: f32 = 0.03;
/// How fast it leans [1/s].
const PACE: f32 = 3.0;
/// How fast a shake dies [1/s], and how fast it swings [rad/s].
const CALM: f32 = 9.0;
const SWING: f32 = 60.0;

/// Looks at the arena, leans towards the hand, and shakes when something tears.
#[derive(Clone, Debug, Default)]
pub struct Camera {
    lean: Vec2,
    /// How far it swings [m], and where in the swing it is [rad].
    shake: f32,
    phase: f32,
}

/// The camera on a part of the screen.
#[derive(Copy, Clone, Debug)]
pub struct View {
    /// The part of the screen.
    pub rect: Rect,
    /// What is in its middle [m].
    pub centre: [f32; 2],
    /// Points on the screen for each metre.
    pub scale: f32,
}

impl Camera {
    /// Lets `seconds` pass while the hand is at a place [m]; `still` = with reduced motion.
    pub fn follow(&mut self, hand: Vector, arena: [Vector; 2], seconds: f32, still: bool) {
        if still {
            *self = Self::default();
            return;
        }
        let middle = |axis: usize| 0.5 * (arena[0][axis] + arena[1][axis]);
        let wish = LEAN * vec2(hand[0] - middle(0), hand[1] - middle(1));
        self.lean += (wish - self.lean) * (PACE * seconds).min(1.0);
        self.shake *= (1.0 - CALM * seconds).max(0.0);
        self.phase += SWING * seconds;
    }

    /// Something tore: shake, by so much at most [m].
    pub fn shake(&mut self, by: f32) {
        self.shake = (self.shake + by).min(0.02);
    }

    /// What it sees on a part of the screen that is to hold the arena.
    pub fn view(&self, rect: Rect, arena: [Vector; 2]) -> View {
        let size = vec2(arena[1][0] - arena[0][0], arena[1][1] - arena[0][1]);
        let size = size + Vec2::splat(2.0 * MARGIN);
        let scale = (rect.width() / size.x).min(rect.height() / size.y);
        let swing = self.shake * vec2(self.phase.sin(), (1.3 * self.phase).cos());
        let middle = 0.5 * vec2(arena[0][0] + arena[1][0], arena[0][1] + arena[1][1]);
        let centre = middle + self.lean + swing;
        let centre = [centre.x, centre.y];
        View {
            rect,
            centre,
            scale,
        }
    }
}

impl View {
    /// Where a place of the world [m] is on the screen.
    pub fn on_screen(&self, at: Vector) -> Pos2 {
        let middle = self.rect.center();
        pos2(
            middle.x + self.scale * (at[0] - self.centre[0]),
            middle.y - self.scale * (at[1] - self.centre[1]),
        )
    }

    /// Which place of the world [m] is seen at a point of the screen.
    pub fn in_world(&self, at: Pos2) -> Vector {
        let way = (at - self.rect.center()) / self.scale;
        [self.centre[0] + way.x, self.centre[1] - way.y, 0.0]
    }

    /// Height of what is seen [m].
    pub fn height(&self) -> f32 {
        self.rect.height() / self.scale
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_place_is_found_again_from_where_it_is_seen() {
        let arena = [[-1.6, -1.0, 0.0], [1.6, 1.0, 0.0]];
        let mut camera = Camera::default();
        camera.shake(0.01);
        camera.follow([1.0, 0.5, 0.0], arena, 0.05, false);
        let view = camera.view(
            Rect::from_min_size(pos2(10.0, 20.0), vec2(800.0, 600.0)),
            arena,
        );
        let place = view.in_world(view.on_screen([0.7, -0.3, 0.0]));
        assert!((place[0] - 0.7).abs() < 1e-4 && (place[1] + 0.3).abs() < 1e-4);
        camera.follow([1.0, 0.5, 0.0], arena, 0.05, true);
        assert_eq!(camera.view(view.rect, arena).centre, [0.0, 0.0]);
    }
}
