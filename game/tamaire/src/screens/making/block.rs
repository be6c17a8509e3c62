//! Block of voxels: the drawing in 3D.

use super::super::widgets::focus_first;
use super::pen;
use super::tools;
use crate::game::{DrawingTool, Game};
use app_shell::widgets::{focus_ring, is_on};
use egui::{
    Color32, Id, Mesh, PointerButton, Pos2, Rect, Role, Sense, Shape, Stroke, Ui, Vec2, WidgetInfo,
    vec2,
};
use fuwafuwa::Vec3;
use tamaire_maker::drawing::{Drawing, Face};

/// Turn by a drag [rad/point].
const DRAG: f32 = 0.01;
/// Largest elevation of the eye [rad].
const HIGHEST: f32 = 1.4;
/// Width of the sheet in widths of the block.
const ROOM: f32 = 1.75;
/// Distance of the eye from the middle of the block, in widths of the block.
const FAR: f32 = 4.0;
/// Direction of the light, and the share of light from all sides.
const LIGHT: ([f32; 3], f32) = ([-0.45, 0.8, 0.4], 0.62);

/// View of the block from far away.
struct Eye {
    middle: Pos2,
    /// Scale [points/cell].
    scale: f32,
    centre: Vec3,
    right: Vec3,
    up: Vec3,
    /// Direction to the eye.
    toward: Vec3,
    /// Distance of the eye from the middle [cells].
    distance: f32,
}

impl Eye {
    fn new(block: &Drawing, rect: Rect, [azimuth, elevation]: [f32; 2]) -> Self {
        let size = Vec3::from(block.size().map(|count| count as f32));
        let (sin, cos) = azimuth.sin_cos();
        let (rise, level) = elevation.sin_cos();
        Self {
            middle: rect.center(),
            scale: rect.width() / (ROOM * size.x),
            centre: 0.5 * size,
            right: Vec3::new(cos, 0.0, -sin),
            up: Vec3::new(-sin * rise, level, -cos * rise),
            toward: Vec3::new(sin * level, rise, cos * level),
            distance: FAR * size.x,
        }
    }

    fn to_screen(&self, at: Vec3) -> Pos2 {
        let away = at - self.centre;
        self.middle + self.scale * vec2(away.dot(self.right), -away.dot(self.up))
    }

    /// Returns origin and direction of the ray through a point of the screen.
    fn ray(&self, at: Pos2) -> (Vec3, Vec3) {
        let by = (at - self.middle) / self.scale;
        let plane = self.centre + by.x * self.right - by.y * self.up;
        (plane + self.distance * self.toward, -self.toward)
    }
}

pub(super) fn show(game: &mut Game, ui: &mut Ui, rect: Rect) {
    let name = game.making().block;
    let sheet = ui.interact(rect, Id::unique("block"), Sense::click_and_drag());
    sheet.widget_info(|| WidgetInfo::labeled(Role::Button, true, name));
    focus_first(ui, &sheet);
    let eye = Eye::new(&game.maker.block, rect, game.maker.angles);
    if !turn(game, ui, &eye, &sheet) {
        let moves = pen::moves(game, ui, rect, &sheet);
        for (at, pressure) in moves.points {
            draw_at(game, &eye, at, pressure);
        }
        if moves.is_up {
            game.maker.lift_pen();
        }
    }
    game.maker.is_sheet_on = is_on(ui, &sheet);
    draw(game, ui, rect);
    pen::draw_cursor(game, ui, rect);
    focus_ring(ui, &sheet, rect, 14.0, &game.theme());
}

/// Turns the block with a drag of the secondary button, of two fingers, or beside the block. Returns whether it turns.
fn turn(game: &mut Game, ui: &Ui, eye: &Eye, sheet: &egui::Response) -> bool {
    let id = Id::unique("the block turns");
    let (fingers, origin, delta, secondary) = ui.input(|input| {
        let fingers = input.multi_touch().map(|touch| touch.translation_delta);
        let pointer = &input.pointer;
        let secondary = pointer.button_down(PointerButton::Secondary);
        (fingers, pointer.press_origin(), pointer.delta(), secondary)
    });
    if let Some(by) = fingers {
        game.maker.lift_pen();
        orbit(game, by);
        return true;
    }
    if !sheet.is_pointer_button_down_on() {
        ui.data_mut(|data| data.remove_temp::<bool>(id));
        return false;
    }
    let turns = ui.data(|data| data.get_temp(id)).unwrap_or_else(|| {
        let is_beside = origin.is_some_and(|at| point_on(game, eye, at).is_none());
        secondary || is_beside
    });
    ui.data_mut(|data| data.insert_temp(id, turns));
    if turns {
        orbit(game, delta);
    }
    turns
}

fn orbit(game: &mut Game, by: Vec2) {
    let [azimuth, elevation] = &mut game.maker.angles;
    *azimuth -= DRAG * by.x;
    *elevation = (*elevation + DRAG * by.y).clamp(-HIGHEST, HIGHEST);
}

/// Returns the point of the block at a point of the screen [cells].
fn point_on(game: &Game, eye: &Eye, at: Pos2) -> Option<Vec3> {
    let maker = &game.maker;
    let block = maker.before_stroke.as_ref().unwrap_or(&maker.block);
    let (origin, direction) = eye.ray(at);
    let hit = match block.is_empty() {
        true => block.floor_hit(origin, direction),
        false => block.hit(origin, direction),
    };
    hit.map(|hit| hit.point)
}

/// Draws to the point of the block at a point of the screen.
fn draw_at(game: &mut Game, eye: &Eye, at: Pos2, pressure: f32) {
    if game.maker.before_stroke.is_none() {
        game.maker.before_stroke = Some(game.maker.block.without_history());
    }
    match point_on(game, eye, at) {
        Some(point) => {
            game.maker.draw_to(point, pressure);
        }
        // The stroke goes on where the pen meets the block again.
        None => game.maker.pen = None,
    }
}

/// Draws the block and the floor below it.
fn draw(game: &Game, ui: &Ui, rect: Rect) {
    let (theme, painter) = (game.theme(), ui.painter().with_clip_rect(rect));
    painter.rect_filled(rect, 10.0, Color32::WHITE);
    let block = &game.maker.block;
    let eye = Eye::new(block, rect, game.maker.angles);
    let [x, y, z] = block.size().map(|count| count as f32);
    let line = Stroke::new(1.0, theme.faint.gamma_multiply(0.4));
    for share in 0..=4 {
        let share = share as f32 / 4.0;
        for ends in [
            [Vec3::new(share * x, 0.0, 0.0), Vec3::new(share * x, 0.0, z)],
            [Vec3::new(0.0, 0.0, share * z), Vec3::new(x, 0.0, share * z)],
        ] {
            painter.line_segment(ends.map(|end| eye.to_screen(end)), line);
        }
    }
    for corner in [[0.0, 0.0], [x, 0.0], [0.0, z], [x, z]] {
        let ends = [0.0, y].map(|y| eye.to_screen(Vec3::new(corner[0], y, corner[1])));
        painter.line_segment(ends, line);
    }
    let mut faces: Vec<Seen> = block
        .visible_faces()
        .filter_map(|face| Seen::of(&eye, face))
        .collect();
    faces.sort_by(|a, b| a.depth.total_cmp(&b.depth));
    let light = Vec3::from(LIGHT.0).normalize();
    let mut mesh = Mesh::default();
    mesh.reserve_triangles(2 * faces.len());
    mesh.reserve_vertices(4 * faces.len());
    for face in &faces {
        // Faces that are turned away from the light differ, too.
        let lit = 0.5 * (1.0 + face.normal.dot(light));
        let bright = LIGHT.1 + (1.0 - LIGHT.1) * lit;
        let colour = shaded(tools::crayon_colour(game, face.crayon), bright);
        let first = mesh.vertices.len() as u32;
        for corner in face.corners {
            mesh.colored_vertex(eye.to_screen(corner), colour);
        }
        mesh.add_triangle(first, first + 1, first + 2);
        mesh.add_triangle(first, first + 2, first + 3);
    }
    painter.add(Shape::mesh(mesh));
    if let Some(at) = ui.input(|input| input.pointer.hover_pos())
        && rect.contains(at)
        && let Some(point) = point_on(game, &eye, at)
    {
        let ink = match game.maker.tool {
            DrawingTool::Eraser => theme.ink,
            _ => theme.accent,
        };
        let radius = eye.scale * game.maker.radius();
        painter.circle_stroke(eye.to_screen(point), radius, Stroke::new(2.0, ink));
    }
}

/// Face that is turned to the eye.
struct Seen {
    corners: [Vec3; 4],
    normal: Vec3,
    /// Nearness to the eye [cells].
    depth: f32,
    crayon: u8,
}

impl Seen {
    fn of(eye: &Eye, face: Face) -> Option<Self> {
        let (axis, side) = (face.axis, f32::from(u8::from(face.is_high)));
        let mut normal = Vec3::ZERO;
        normal[axis] = 2.0 * side - 1.0;
        if normal.dot(eye.toward) <= 0.0 {
            return None;
        }
        let low = Vec3::from(face.cell.map(|k| k as f32));
        let [one, other] = [(axis + 1) % 3, (axis + 2) % 3];
        let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|[a, b]| {
            let mut corner = low;
            corner[axis] += side;
            corner[one] += a;
            corner[other] += b;
            corner
        });
        let middle = 0.5 * (corners[0] + corners[2]);
        Some(Self {
            corners,
            normal,
            depth: middle.dot(eye.toward),
            crayon: face.crayon,
        })
    }
}

fn shaded(colour: Color32, bright: f32) -> Color32 {
    let [red, green, blue] = [colour.r(), colour.g(), colour.b()];
    let [red, green, blue] = [red, green, blue].map(|k| (f32::from(k) * bright).min(255.0) as u8);
    Color32::from_rgb(red, green, blue)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ray_through_a_projected_point_passes_that_point() {
        let block = Drawing::block();
        let rect = Rect::from_min_size(Pos2::new(40.0, 30.0), Vec2::splat(500.0));
        for angles in [[0.0, 0.0], [0.7, 0.5], [-2.0, 1.3], [3.0, -0.9]] {
            let eye = Eye::new(&block, rect, angles);
            let point = Vec3::new(3.0, 21.0, 17.0);
            let (origin, direction) = eye.ray(eye.to_screen(point));
            let along = (point - origin).dot(direction);
            let nearest = origin + along * direction;
            assert!((nearest - point).length() < 1e-2, "{angles:?}");
        }
    }
}
