//! Slice views beside the organ.

use super::pictures::RED;
use crate::procedure::Procedure;
use crate::slices::{Cut, Slice};
use egui::{Align2, Color32, FontId, Mesh, Pos2, Rect, Sense, Stroke, Ui, pos2, vec2};
use fuwafuwa::{Vec2, Vec3};
use fuwafuwa_render::{Colour, Palette};

/// Background of a slice.
const DARK: Color32 = Color32::from_rgb(28, 26, 32);
const PALE: Color32 = Color32::from_rgb(226, 222, 214);
const SKIN: Color32 = Color32::from_rgb(250, 240, 226);
const CRACK: Color32 = Color32::from_rgb(255, 70, 60);

/// Margin on each side of a slice for its labels [points].
const ROOM: egui::Vec2 = vec2(26.0, 28.0);

/// Quantity shown by colours.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq)]
pub enum Shown {
    /// Material.
    #[default]
    Materials,
    /// Strain.
    Strain,
}

/// Three orthogonal slices.
pub struct Slices {
    /// Point through which all slices pass [m].
    through: Vec3,
    /// Whether the point `through` follows the tool.
    pub follows: bool,
    /// Quantity shown by colours.
    pub shown: Shown,
    slices: [Slice; 3],
    /// Index of the slice that is updated next, one per frame.
    next: usize,
}

impl Slices {
    /// Creates slices through a point [m].
    pub fn new(through: Vec3) -> Self {
        Self {
            through,
            follows: true,
            shown: Shown::Materials,
            slices: [const {
                Slice {
                    patches: Vec::new(),
                    rim: Vec::new(),
                    cracks: Vec::new(),
                }
            }; 3],
            next: 0,
        }
    }

    /// Updates one of the three slices, in turn.
    pub fn refresh(&mut self, procedure: &Procedure) {
        if self.follows {
            self.through = procedure.tool().position();
        }
        let cut = Cut::ALL[self.next];
        self.slices[self.next] = Slice::of(procedure.organ(), cut, self.through[cut.axis()]);
        self.next = (self.next + 1) % Cut::ALL.len();
    }

    /// Draws the slices below each other. If the user presses on a slice, the other two slices move to the
    /// pressed point.
    pub fn show(&mut self, ui: &mut Ui, procedure: &Procedure, seen: [Vec3; 2], colours: &Palette) {
        let all = ui.available_size();
        let height = (all.y - 2.0 * ui.spacing().item_spacing.y) / 3.0;
        for (number, cut) in Cut::ALL.into_iter().enumerate() {
            let size = vec2(all.x, height);
            let (rect, response) = ui.allocate_exact_size(size, Sense::click_and_drag());
            let page = Page::new(rect, cut, seen);
            if let Some(at) = response.interact_pointer_pos() {
                self.follows = false;
                page.point(at, &mut self.through);
            }
            self.draw(ui, &page, number, procedure, colours);
        }
    }

    fn draw(&self, ui: &Ui, page: &Page, number: usize, procedure: &Procedure, colours: &Palette) {
        let painter = ui.painter().with_clip_rect(page.rect);
        painter.rect_filled(page.rect, 12.0, DARK);
        let slice = &self.slices[number];
        let mut mesh = Mesh::default();
        for patch in &slice.patches {
            let colour = match self.shown {
                Shown::Materials => colours.material(patch.material),
                Shown::Strain => colours.strain(patch.strain),
            };
            let first = mesh.vertices.len() as u32;
            for &corner in &patch.corners {
                mesh.colored_vertex(page.at(corner), screen(colour));
            }
            for k in 2..patch.corners.len() as u32 {
                mesh.add_triangle(first, first + k - 1, first + k);
            }
        }
        painter.add(mesh);
        for (lines, wide, colour) in [(&slice.rim, 1.0, SKIN), (&slice.cracks, 2.0, CRACK)] {
            for line in lines {
                painter.line_segment(line.map(|end| page.at(end)), Stroke::new(wide, colour));
            }
        }
        let cross = page.at(page.cut.on_page(self.through));
        let thin = Stroke::new(1.0, PALE.gamma_multiply(0.35));
        painter.hline(page.rect.x_range(), cross.y, thin);
        painter.vline(cross.x, page.rect.y_range(), thin);
        let tool = page.at(page.cut.on_page(procedure.tool().position()));
        painter.circle_stroke(tool, 6.0, Stroke::new(2.0, RED));
        let text = |at: Pos2, align: Align2, words: String, size: f32| {
            painter.text(at, align, words, FontId::proportional(size), PALE);
        };
        let (rect, name) = (page.rect.shrink(7.0), page.cut.name());
        let place = self.through - procedure.table().corner;
        let place = place_in_words(page.cut, procedure.case().patient_at(place));
        let title = format!("{name}  {place}");
        text(rect.left_bottom(), Align2::LEFT_BOTTOM, title, 16.0);
        let [left, right, upper, lower] = page.cut.letters();
        text(rect.left_center(), Align2::LEFT_CENTER, left.into(), 17.0);
        text(
            rect.right_center(),
            Align2::RIGHT_CENTER,
            right.into(),
            17.0,
        );
        text(rect.center_top(), Align2::CENTER_TOP, upper.into(), 17.0);
        text(
            rect.center_bottom(),
            Align2::CENTER_BOTTOM,
            lower.into(),
            17.0,
        );
    }
}

/// Describes the position of a slice through a point of the patient, RAS+ [mm]. For example, `R 12 mm` is 12
/// mm to the right of the origin.
fn place_in_words(cut: Cut, [right, front, up]: [f64; 3]) -> String {
    let (along, [less, more]) = match cut {
        Cut::Axial => (up, ["I", "S"]),
        Cut::Coronal => (front, ["P", "A"]),
        Cut::Sagittal => (right, ["L", "R"]),
    };
    let side = if along < 0.0 { less } else { more };
    format!("{side} {:.0} mm", along.abs())
}

fn screen(colour: Colour) -> Color32 {
    let [red, green, blue] = colour.map(|k| (255.0 * k + 0.5) as u8);
    Color32::from_rgb(red, green, blue)
}

/// Mapping from page coordinates of a slice to the screen.
struct Page {
    rect: Rect,
    cut: Cut,
    /// Point of the section plane at the centre of `rect`, in the coordinates of the plane [m].
    middle: Vec2,
    /// Scale [points/m].
    scale: f32,
}

impl Page {
    fn new(rect: Rect, cut: Cut, [low, high]: [Vec3; 2]) -> Self {
        let [a, b] = [cut.on_page(low), cut.on_page(high)];
        let size = (b - a).abs();
        let room = rect.shrink2(ROOM);
        Self {
            rect,
            cut,
            middle: 0.5 * (a + b),
            scale: (room.width() / size.x).min(room.height() / size.y),
        }
    }

    fn at(&self, page: Vec2) -> Pos2 {
        let way = self.scale * (page - self.middle);
        let centre = self.rect.center();
        pos2(centre.x + way.x, centre.y - way.y)
    }

    /// Sets two coordinates of `place` to those of the screen position `at`. The coordinate perpendicular to
    /// the slice is kept.
    fn point(&self, at: Pos2, place: &mut Vec3) {
        let way = (at - self.rect.center()) / self.scale;
        let [u, v] = [self.middle.x + way.x, self.middle.y - way.y];
        match self.cut {
            Cut::Axial => (place.x, place.z) = (u, -v),
            Cut::Coronal => (place.x, place.y) = (u, v),
            Cut::Sagittal => (place.z, place.y) = (u, v),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn point_inverts_the_page_mapping() {
        let seen = [Vec3::new(-0.05, 0.0, -0.07), Vec3::new(0.05, 0.12, 0.07)];
        let rect = Rect::from_min_size(pos2(20.0, 30.0), vec2(300.0, 200.0));
        for cut in Cut::ALL {
            let page = Page::new(rect, cut, seen);
            let before = Vec3::new(0.01, 0.02, 0.03);
            let mut place = before;
            let at = Vec3::new(0.011, 0.05, -0.02);
            page.point(page.at(cut.on_page(at)), &mut place);
            let mut expected = at;
            expected[cut.axis()] = before[cut.axis()];
            assert!(place.abs_diff_eq(expected, 1e-5), "{cut:?} {place:?}");
        }
        assert_eq!(place_in_words(Cut::Sagittal, [-12.4, 1.0, 2.0]), "L 12 mm");
        assert_eq!(place_in_words(Cut::Coronal, [0.0, 3.0, 0.0]), "A 3 mm");
    }
}
