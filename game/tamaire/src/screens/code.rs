//! QR code of a link.

use crate::qr::Code;
use egui::{Color32, Mesh, Rect, Role, Sense, Ui, WidgetInfo, pos2, vec2};

/// Width of the quiet zone around a code [modules] [ISO/IEC 18004].
const QUIET: usize = 4;

/// Draws the code, at most `most` points wide. Each module is a whole number of pixels wide, so that all have the same size.
pub(super) fn draw(ui: &mut Ui, code: &Code, most: f32) {
    let per_point = ui.ctx().pixels_per_point();
    let module = pixels(ui, code, most) / per_point;
    let side = modules(code) * module;
    let (rect, response) = ui.allocate_exact_size(vec2(side, side), Sense::hover());
    response.widget_info(|| WidgetInfo::labeled(Role::Image, true, &code.address));
    let corner = (rect.min.to_vec2() * per_point).round() / per_point;
    let mut mesh = Mesh::default();
    mesh.add_colored_rect(rect, Color32::WHITE);
    let dark = { code.dark.iter().enumerate() }.filter(|&(_, &is_dark)| is_dark);
    for (index, _) in dark {
        let [x, y] = [index % code.side, index / code.side].map(|at| (at + QUIET) as f32 * module);
        let at = pos2(x, y) + corner;
        mesh.add_colored_rect(
            Rect::from_min_size(at, vec2(module, module)),
            Color32::BLACK,
        );
    }
    ui.painter().add(mesh);
}

/// Returns the number of modules on a side, including the quiet zone.
fn modules(code: &Code) -> f32 {
    (code.side + 2 * QUIET) as f32
}

/// Returns the width of a module in whole pixels, for a side of at most `most` points.
pub(super) fn pixels(ui: &Ui, code: &Code, most: f32) -> f32 {
    (most * ui.ctx().pixels_per_point() / modules(code)).floor()
}
