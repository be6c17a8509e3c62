//! Picture of a drawing on paper: its cells with smooth rims, and the grain of a crayon.

use egui::{Color32, ColorImage, Context, TextureHandle, TextureOptions};
use tamaire_maker::drawing::Drawing;

/// Number of pixels along a cell.
const FINE: usize = 8;
/// Darkening of the grain, 0 to 1.
const GRAIN: f32 = 0.10;

/// Picture of a drawing, which is brought up to date where the drawing has changed.
#[derive(Clone, Default)]
pub(super) struct Picture {
    cells: Vec<u8>,
    colours: Vec<[u8; 3]>,
    texture: Option<TextureHandle>,
}

impl Picture {
    /// Returns the texture of a drawing on paper. `colours` are those of the crayons, number 1 first.
    pub(super) fn of(
        &mut self,
        ctx: &Context,
        drawing: &Drawing,
        colours: Vec<[u8; 3]>,
    ) -> TextureHandle {
        let [width, height, _] = drawing.size();
        let cells = drawing.cells();
        let painted = |low: [usize; 2], high: [usize; 2]| paint(drawing, &colours, low, high);
        let is_same = self.colours == colours && self.cells.len() == cells.len();
        match (&mut self.texture, is_same) {
            (Some(texture), true) => {
                if let Some((low, high)) = changed(&self.cells, cells, [width, height]) {
                    let image = painted(low, high);
                    // The picture begins with the uppermost cells.
                    let corner = [low[0] * FINE, (height - high[1]) * FINE];
                    texture.set_partial(corner, image, TextureOptions::LINEAR);
                }
            }
            (texture, _) => {
                let image = painted([0, 0], [width, height]);
                *texture = Some(ctx.load_texture("paper", image, TextureOptions::LINEAR));
            }
        }
        self.cells.clear();
        self.cells.extend_from_slice(cells);
        self.colours = colours;
        let texture = self.texture.as_ref();
        texture.expect("the texture was just made").clone()
    }
}

/// Returns the box around the cells that differ, two cells wider on each side: its low corner, and the corner after its
/// high one.
fn changed(
    before: &[u8],
    after: &[u8],
    [width, height]: [usize; 2],
) -> Option<([usize; 2], [usize; 2])> {
    let mut found: Option<([usize; 2], [usize; 2])> = None;
    for (at, _) in (before.iter().zip(after).enumerate()).filter(|(_, (a, b))| a != b) {
        let [x, y] = [at % width, at / width];
        let (low, high) = found.get_or_insert(([x, y], [x, y]));
        *low = [low[0].min(x), low[1].min(y)];
        *high = [high[0].max(x), high[1].max(y)];
    }
    found.map(|(low, high)| {
        let low = low.map(|k| k.saturating_sub(2));
        (low, [(high[0] + 3).min(width), (high[1] + 3).min(height)])
    })
}

/// Paints the cells of a box.
fn paint(drawing: &Drawing, colours: &[[u8; 3]], low: [usize; 2], high: [usize; 2]) -> ColorImage {
    let size = [0, 1].map(|axis| (high[axis] - low[axis]) * FINE);
    let mut pixels = Vec::with_capacity(size[0] * size[1]);
    for row in 0..size[1] {
        let y = high[1] * FINE - 1 - row;
        for x in low[0] * FINE..high[0] * FINE {
            pixels.push(pixel(drawing, colours, x, y));
        }
    }
    ColorImage::new(size, pixels)
}

/// Returns the colour of a pixel: that of the crayon with the largest share among the sixteen nearest cells. Near the rim it
/// is translucent.
fn pixel(drawing: &Drawing, colours: &[[u8; 3]], x: usize, y: usize) -> Color32 {
    let place = |k: usize| (k as f32 + 0.5) / FINE as f32 - 0.5;
    let [(column, across), (row, up)] = [place(x), place(y)].map(|at| {
        let before = at.floor();
        (before as i32, spline(at - before))
    });
    let mut near = [(0u8, 0.0f32); 16];
    for (index, near) in near.iter_mut().enumerate() {
        let [i, j] = [index % 4, index / 4];
        let cell = drawing.cell([column + i as i32 - 1, row + j as i32 - 1, 0]);
        *near = (cell, across[i] * up[j]);
    }
    let (first, _) = near[0];
    if first == 0 && near.iter().all(|(cell, _)| *cell == 0) {
        return Color32::TRANSPARENT;
    }
    let share = |crayon: u8| -> f32 {
        let same = near.iter().filter(|(cell, _)| *cell == crayon);
        same.map(|(_, share)| share).sum()
    };
    let solid = near.iter().filter(|(cell, _)| *cell != 0);
    let Some(&(crayon, _)) = solid.max_by(|a, b| share(a.0).total_cmp(&share(b.0))) else {
        return Color32::TRANSPARENT;
    };
    // Sharper than the plain shares, but not stepped.
    let cover = (4.0 * (0.5 - share(0)) + 0.5).clamp(0.0, 1.0);
    let colour = colours.get(usize::from(crayon) - 1).copied();
    let [red, green, blue] = colour.unwrap_or([128; 3]);
    let dark = 1.0 - GRAIN * grain(x, y);
    let [red, green, blue] = [red, green, blue].map(|k| (f32::from(k) * dark) as u8);
    Color32::from_rgb(red, green, blue).gamma_multiply(cover)
}

/// Returns the shares of four cells in a row at a distance from the middle of the second one, 0 to 1 [cells]: a cubic
/// B-spline.
fn spline(at: f32) -> [f32; 4] {
    let left = 1.0 - at;
    [
        left.powi(3) / 6.0,
        (4.0 - 6.0 * at * at + 3.0 * at.powi(3)) / 6.0,
        (4.0 - 6.0 * left * left + 3.0 * left.powi(3)) / 6.0,
        at.powi(3) / 6.0,
    ]
}

/// Returns the grain of the paper at a pixel, 0 to 1.
fn grain(x: usize, y: usize) -> f32 {
    let mut mixed = (x as u32).wrapping_mul(0x9e37_79b1) ^ (y as u32).wrapping_mul(0x85eb_ca77);
    mixed ^= mixed >> 15;
    mixed = mixed.wrapping_mul(0x2c1b_3c6d);
    mixed ^= mixed >> 12;
    (mixed & 0xff) as f32 / 255.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use fuwafuwa::Vec3;
    use tamaire_maker::drawing::Brush;

    #[test]
    fn changed_part_of_the_picture_equals_the_whole_one() {
        let mut drawing = Drawing::paper();
        let colours = [[200, 10, 10], [10, 200, 10]];
        drawing.stroke(
            Vec3::new(9.0, 9.0, 0.0),
            Vec3::new(40.0, 30.0, 0.0),
            3.0,
            Brush::Draw(1),
        );
        let before = drawing.cells().to_vec();
        drawing.stroke(
            Vec3::new(30.0, 9.0, 0.0),
            Vec3::new(30.0, 40.0, 0.0),
            2.0,
            Brush::Draw(2),
        );
        let (low, high) = changed(&before, drawing.cells(), [64, 64]).unwrap();
        let part = paint(&drawing, &colours, low, high);
        let whole = paint(&drawing, &colours, [0, 0], [64, 64]);
        let corner = [low[0] * FINE, (64 - high[1]) * FINE];
        for row in 0..part.size[1] {
            for column in 0..part.size[0] {
                let expected = whole[(corner[0] + column, corner[1] + row)];
                assert_eq!(part[(column, row)], expected);
            }
        }
        assert!(changed(drawing.cells(), drawing.cells(), [64, 64]).is_none());
    }
}
