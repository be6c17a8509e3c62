//! Camera: mapping between world and screen.

use egui::{Pos2, Rect, Vec2, pos2, vec2};
use fuwafuwa::Vec3;
use fuwafuwa_render::space;
use std::f32::consts::TAU;

/// Margin around the arena [m]. It keeps the whole arena in view while the camera leans.
const MARGIN: f32 = 0.1;
/// Lean of the camera towards the hand that the player moves, as a fraction of the distance from the arena's
/// centre to the hand.
const LEAN: f32 = 0.03;
/// Rate at which the lean approaches its goal [1/s].
const PACE: f32 = 3.0;
/// Decay rate of the camera's shake after a tear [1/s].
const CALM: f32 = 9.0;
/// 3D: initial elevation of the camera above the horizontal [rad].
const RISE: f32 = 0.6;
/// 3D: minimum elevation of the camera [rad]. Below this limit, the hand could be higher than the camera.
const LOWEST: f32 = 0.35;
/// 3D: maximum elevation of the camera [rad].
const HIGHEST: f32 = 1.5;
/// 3D: camera distance, as a fraction of the distance at which the whole arena would be visible. A value
/// below 1 cuts off the arena's corners, which are usually empty.
const CLOSE: f32 = 0.66;
/// 3D: distance of the camera's target below the centre of the arena [m]. The target is low because bodies
/// lie on the floor.
const LOWER: f32 = 0.12;
/// 3D: upper limit of [`LOWER`], as a fraction of the arena's height.
const LOWER_SHARE: f32 = 0.15;
/// Rate at which the camera turns back to its initial orientation when the user resets it [1/s].
const HOME: f32 = 7.0;
/// Maximum distance from the camera to the world point under the pointer [m], larger than any level.
const FAR: f32 = 100.0;
/// Angular frequency of the camera's shake after a tear [rad/s].
const SWING: f32 = 60.0;

/// Camera that frames the arena, leans towards the hand, and shakes when something tears.
#[derive(Clone, Debug, Default)]
pub struct CameraRig {
    lean: Vec2,
    /// Amplitude of the shake [m].
    shake: f32,
    /// Phase of the shake [rad].
    phase: f32,
    /// 3D: azimuth relative to the initial orientation, positive to the right [rad].
    turn: f32,
    /// 3D: elevation relative to the initial orientation [rad].
    rise: f32,
    is_returning: bool,
}

/// Camera for a given part of the screen.
#[derive(Copy, Clone, Debug)]
pub struct View {
    /// Part of the screen [points].
    pub rect: Rect,
    /// World position at the centre of `rect` [m].
    pub centre: [f32; 2],
    /// Scale [points/m]; in 3D at the camera's target.
    pub scale: f32,
    /// Camera of a 3D level; `None` in 2D.
    pub space: Option<space::Camera>,
}

impl CameraRig {
    /// Advances the camera by `seconds`; `hand` is the position of the hand [m]. `still` selects reduced
    /// motion: the camera neither leans nor shakes, and it returns to its initial orientation at once.
    pub fn follow(&mut self, hand: Vec3, arena: [Vec3; 2], seconds: f32, still: bool) {
        if self.is_returning {
            let left = match still {
                true => 0.0,
                false => (1.0 - HOME * seconds).max(0.0),
            };
            // Reduces the azimuth by whole turns, so that the camera turns back the shorter way around.
            self.turn = left * (self.turn - TAU * (self.turn / TAU).round());
            self.rise *= left;
        }
        if still {
            (self.lean, self.shake) = (Vec2::ZERO, 0.0);
            return;
        }
        let away = hand - 0.5 * (arena[0] + arena[1]);
        let wish = LEAN * vec2(away.x, away.y);
        self.lean += (wish - self.lean) * (PACE * seconds).min(1.0);
        self.shake *= (1.0 - CALM * seconds).max(0.0);
        self.phase += SWING * seconds;
    }

    /// Shakes after a tear: adds `by` to the amplitude [m], up to 0.02 m.
    pub fn shake(&mut self, by: f32) {
        self.shake = (self.shake + by).min(0.02);
    }

    /// 3D: turns the camera around its target, to the right and up [rad]. Any turn stops a return to the
    /// initial orientation.
    pub fn orbit(&mut self, right: f32, up: f32) {
        self.is_returning &= right == 0.0 && up == 0.0;
        self.turn += right;
        self.rise = (self.rise + up).clamp(LOWEST - RISE, HIGHEST - RISE);
    }

    /// 3D: returns to the initial orientation at once.
    pub fn face_front(&mut self) {
        (self.turn, self.rise, self.is_returning) = (0.0, 0.0, false);
    }

    /// 3D: starts a smooth return to the initial orientation.
    pub fn return_to_front(&mut self) {
        self.is_returning = true;
    }

    /// Azimuth (to the right) and elevation, relative to the initial orientation [rad].
    pub fn orbit_angles(&self) -> [f32; 2] {
        [self.turn, self.rise]
    }

    /// Azimuth relative to the initial orientation [rad].
    pub fn azimuth(&self) -> f32 {
        self.turn
    }

    /// 3D: approximate camera position [m], as if the screen had an aspect ratio of 16:10.
    pub fn eye(&self, arena: [Vec3; 2]) -> Vec3 {
        self.space_camera(arena, [16, 10]).eye()
    }

    fn space_camera(&self, arena: [Vec3; 2], size: [u32; 2]) -> space::Camera {
        let fitted = space::Camera::fit(arena[0], arena[1], size);
        let lower = LOWER.min(LOWER_SHARE * (arena[1].y - arena[0].y));
        let swing = self.shake * vec2(self.phase.sin(), (1.3 * self.phase).cos());
        space::Camera {
            target: fitted.target + Vec3::new(self.lean.x, self.lean.y - lower, 0.0),
            distance: CLOSE * fitted.distance,
            azimuth: self.turn,
            elevation: RISE + self.rise,
            shake: Vec3::new(swing.x, swing.y, 0.0),
            ..fitted
        }
    }

    /// Returns the view of a 3D arena, given by its two opposite corners [m].
    pub fn view_of_space(&self, rect: Rect, arena: [Vec3; 2]) -> View {
        let camera = self.space_camera(arena, pixels(rect));
        View {
            rect,
            centre: [camera.target.x, camera.target.y],
            scale: 0.5 * rect.height() / ((0.5 * camera.fov_y).tan() * camera.distance),
            space: Some(camera),
        }
    }

    /// Returns the view of a 2D arena, given by its two opposite corners [m].
    pub fn view_of_plane(&self, rect: Rect, arena: [Vec3; 2]) -> View {
        let size = arena[1] - arena[0];
        let size = vec2(size.x, size.y);
        let size = size + Vec2::splat(2.0 * MARGIN);
        let scale = (rect.width() / size.x).min(rect.height() / size.y);
        let swing = self.shake * vec2(self.phase.sin(), (1.3 * self.phase).cos());
        let middle = 0.5 * (arena[0] + arena[1]);
        let middle = vec2(middle.x, middle.y);
        let centre = middle + self.lean + swing;
        let centre = [centre.x, centre.y];
        View {
            rect,
            centre,
            scale,
            space: None,
        }
    }
}

/// Returns the width and height of `rect`, rounded to whole pixels.
fn pixels(rect: Rect) -> [u32; 2] {
    [rect.width().max(1.0) as u32, rect.height().max(1.0) as u32]
}

impl View {
    /// Returns the screen position of a world point [m].
    pub fn to_screen(&self, at: Vec3) -> Pos2 {
        if let Some(camera) = &self.space {
            // A point behind the camera is placed far off the screen.
            let [x, y] = camera
                .to_pixel(at, pixels(self.rect))
                .unwrap_or([-1.0e5; 2]);
            return self.rect.min + vec2(x, y);
        }
        let middle = self.rect.center();
        pos2(
            middle.x + self.scale * (at.x - self.centre[0]),
            middle.y - self.scale * (at.y - self.centre[1]),
        )
    }

    /// Returns the horizontal position of a world point [m] in the view, from -1 (left) to 1 (right).
    pub fn across(&self, at: Vec3) -> f32 {
        let half = 0.5 * self.rect.width().max(1.0);
        ((self.to_screen(at).x - self.rect.center().x) / half).clamp(-1.0, 1.0)
    }

    /// Returns the position of the camera [m] and the unit vector from it through a screen position. `None` in 2D.
    pub fn ray(&self, at: Pos2) -> Option<(Vec3, Vec3)> {
        let point = at - self.rect.min;
        let camera = self.space.as_ref()?;
        Some(camera.ray([point.x, point.y], pixels(self.rect)))
    }

    /// Returns the world point [m] at a screen position; in 3D on the horizontal plane at `height` [m].
    pub fn to_world(&self, at: Pos2, height: f32) -> Vec3 {
        if let Some((eye, towards)) = self.ray(at) {
            // Limits the distance to `FAR` if the ray does not hit the plane.
            let reach = (height - eye.y) / towards.y;
            let reach = if reach > 0.0 { reach.min(FAR) } else { FAR };
            return (eye + towards * reach).with_y(height);
        }
        let way = (at - self.rect.center()) / self.scale;
        Vec3::new(self.centre[0] + way.x, self.centre[1] - way.y, 0.0)
    }

    /// Returns the view with everything smaller by the factor `share`, 0 to 1, around the centre of its part of the
    /// screen. In 3D this is exact at the distance of the camera's target.
    pub fn shrunk(mut self, share: f32) -> Self {
        self.scale *= share;
        if let Some(camera) = &mut self.space {
            camera.distance /= share;
        }
        self
    }

    /// Returns the view moved sideways and up or down, so that all that it shows appears displaced by `by`
    /// [points]. In 3D this is exact at the distance of the camera's target.
    pub fn displaced(mut self, by: Vec2) -> Self {
        let way = vec2(by.x, -by.y) / self.scale;
        match &mut self.space {
            None => self.centre = [self.centre[0] - way.x, self.centre[1] - way.y],
            Some(camera) => {
                let (sin, cos) = camera.azimuth.sin_cos();
                let rise = camera.elevation;
                let right = Vec3::new(cos, 0.0, -sin);
                let up = Vec3::new(-sin * rise.sin(), rise.cos(), -cos * rise.sin());
                camera.target -= way.x * right + way.y * up;
            }
        }
        self
    }

    /// Returns the scale at a world point [points/m].
    pub fn scale_at(&self, at: Vec3) -> f32 {
        let Some(camera) = &self.space else {
            return self.scale;
        };
        let away = (at - camera.eye()).length().max(1e-3);
        self.scale * camera.distance / away
    }

    /// Returns a 2D view with the same centre and scale: the plane through the camera's target, seen from the
    /// front.
    pub fn flat(&self) -> Self {
        let space = None;
        Self { space, ..*self }
    }

    /// Height of the visible region [m].
    pub fn height(&self) -> f32 {
        self.rect.height() / self.scale
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn view_2d_inverts_screen_position() {
        let arena = [Vec3::new(-1.6, -1.0, 0.0), Vec3::new(1.6, 1.0, 0.0)];
        let mut camera = CameraRig::default();
        camera.shake(0.01);
        camera.follow(Vec3::new(1.0, 0.5, 0.0), arena, 0.05, false);
        let view = camera.view_of_plane(
            Rect::from_min_size(pos2(10.0, 20.0), vec2(800.0, 600.0)),
            arena,
        );
        let position = view.to_world(view.to_screen(Vec3::new(0.7, -0.3, 0.0)), 0.0);
        assert!((position.x - 0.7).abs() < 1e-4 && (position.y + 0.3).abs() < 1e-4);
        camera.follow(Vec3::new(1.0, 0.5, 0.0), arena, 0.05, true);
        assert_eq!(camera.view_of_plane(view.rect, arena).centre, [0.0, 0.0]);
    }

    #[test]
    fn displaced_view_shows_everything_displaced() {
        let arena = [Vec3::new(-1.6, 0.0, -1.0), Vec3::new(1.6, 1.6, 1.0)];
        let rect = Rect::from_min_size(pos2(10.0, 20.0), vec2(800.0, 600.0));
        let mut camera = CameraRig::default();
        let by = vec2(-90.0, 40.0);
        let view = camera.view_of_plane(rect, arena);
        let at = Vec3::new(0.7, 0.4, 0.0);
        let way = view.displaced(by).to_screen(at) - view.to_screen(at);
        assert!((way - by).length() < 1e-2, "{way:?}");
        for turn in [0.0, 0.8] {
            camera.orbit(turn, 0.2);
            let view = camera.view_of_space(rect, arena);
            let target = view.space.unwrap().target;
            let way = view.displaced(by).to_screen(target) - view.to_screen(target);
            let aside = target + Vec3::new(turn.cos(), 0.0, -turn.sin()) * 0.1;
            let away = |view: View| (view.to_screen(aside) - view.to_screen(target)).length();
            let share = away(view.shrunk(0.5)) / away(view);
            assert!((share - 0.5).abs() < 0.02, "{share}");
            // The displaced target is seen at an angle, but at the same depth.
            assert!((way - by).length() < 0.01 * by.length(), "{turn}: {way:?}");
        }
    }

    #[test]
    fn camera_returns_the_shorter_way_until_turned() {
        let mut camera = CameraRig::default();
        let follow = |camera: &mut CameraRig, ticks: usize| {
            (0..ticks).for_each(|_| camera.follow(Vec3::ZERO, [Vec3::ZERO; 2], 0.02, false));
        };
        camera.orbit(TAU + 1.0, 0.3);
        camera.return_to_front();
        follow(&mut camera, 1);
        let [right, up] = camera.orbit_angles();
        assert!((0.5..1.0).contains(&right) && (0.1..0.3).contains(&up));
        camera.orbit(0.2, 0.0);
        follow(&mut camera, 60);
        assert!(
            camera.azimuth() > 0.7,
            "the player has turned the camera: {}",
            camera.azimuth()
        );
        camera.return_to_front();
        camera.orbit(0.0, 0.0);
        follow(&mut camera, 120);
        assert!(camera.azimuth().hypot(camera.rise) < 1e-3);
    }

    #[test]
    fn view_3d_inverts_screen_position_at_height() {
        let arena = [Vec3::new(-1.6, 0.0, -1.0), Vec3::new(1.6, 1.6, 1.0)];
        let mut camera = CameraRig::default();
        camera.orbit(0.7, 9.0);
        let rect = Rect::from_min_size(pos2(10.0, 20.0), vec2(800.0, 600.0));
        for rise in [0.0, -0.6, -9.0] {
            camera.orbit(0.0, rise);
            let view = camera.view_of_space(rect, arena);
            let at = Vec3::new(0.7, 0.4, -0.3);
            let position = view.to_world(view.to_screen(at), at.y);
            assert!(position.distance(at) < 1e-2, "{position:?}");
        }
        // At the camera's lowest elevation, rays at the upper edge of the screen are nearly horizontal. Their
        // points must lie beyond the arena, and left and right must not be swapped.
        camera.face_front();
        camera.orbit(0.0, -9.0);
        let view = camera.view_of_space(rect, arena);
        for height in [0.4, 1.4] {
            let [left, right] = [200.0, 700.0].map(|x| view.to_world(pos2(x, 25.0), height));
            assert!(left.x < right.x && left.z < -1.0, "{left:?} {right:?}");
            assert_eq!((left.y, right.y), (height, height));
        }
        assert_eq!(camera.azimuth(), 0.0);
    }
}
