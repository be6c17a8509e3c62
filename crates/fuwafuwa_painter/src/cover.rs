//! How much of each pixel a shape covers, and soft edges of that: what [`crate::soft`] paints by.

use crate::Spot;
use tiny_skia::{
    FillRule, LineCap, LineJoin, Paint, PathBuilder, Pixmap, Shader, Stroke, Transform,
};

/// A rectangle of pixels, which may reach beyond the paper.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub struct Region {
    /// Its first column and row on the paper.
    pub low: [i32; 2],
    /// Its width and height [px], at least 1.
    pub size: [usize; 2],
}

/// For each pixel of a region how much of it is covered, 0 to 1.
#[derive(Clone, Debug)]
pub struct Cover {
    /// The pixels.
    pub region: Region,
    /// Row by row.
    pub share: Vec<f32>,
}

impl Region {
    /// The pixels within `margin` of some lines, as far as they are within `margin` of the paper.
    pub fn around(lines: &[Vec<Spot>], margin: f32, paper: [u32; 2]) -> Option<Self> {
        let (mut low, mut high) = ([f32::MAX; 2], [f32::MIN; 2]);
        for spot in lines.iter().flatten() {
            for axis in 0..2 {
                low[axis] = low[axis].min(spot[axis] - margin);
                high[axis] = high[axis].max(spot[axis] + margin);
            }
        }
        for axis in 0..2 {
            low[axis] = low[axis].max(-margin).floor();
            high[axis] = high[axis].min(paper[axis] as f32 + margin).ceil();
        }
        // Also false when a spot is no number.
        let has_pixels = (0..2).all(|axis| high[axis] - low[axis] >= 1.0);
        has_pixels.then(|| Self {
            low: low.map(|k| k as i32),
            size: [0, 1].map(|axis: usize| (high[axis] - low[axis]) as usize),
        })
    }

    /// The part of it on the paper.
    pub fn on(self, paper: [u32; 2]) -> Option<Self> {
        let low = self.low.map(|k| k.max(0));
        let high = [0, 1]
            .map(|axis: usize| (self.low[axis] + self.size[axis] as i32).min(paper[axis] as i32));
        let has_pixels = (0..2).all(|axis| low[axis] < high[axis]);
        has_pixels.then(|| Self {
            low,
            size: [0, 1].map(|axis: usize| (high[axis] - low[axis]) as usize),
        })
    }

    /// What closed lines cover, the wider ones anticlockwise and holes clockwise in y upwards.
    pub fn filled(self, rings: &[Vec<Spot>]) -> Cover {
        self.painted(|pixels, paint, place| {
            if let Some(path) = path_of(rings, true) {
                pixels.fill_path(&path, paint, FillRule::Winding, place, None);
            }
        })
    }

    /// What open lines of a width [px] cover.
    pub fn stroked(self, lines: &[Vec<Spot>], width: f32) -> Cover {
        let stroke = Stroke {
            width,
            line_cap: LineCap::Round,
            line_join: LineJoin::Round,
            ..Stroke::default()
        };
        self.painted(|pixels, paint, place| {
            if let Some(path) = path_of(lines, false) {
                pixels.stroke_path(&path, paint, &stroke, place, None);
            }
        })
    }

    fn painted(self, draw: impl Fn(&mut Pixmap, &Paint, Transform)) -> Cover {
        let [width, height] = self.size;
        let mut share = vec![0.0; width * height];
        if let Some(mut pixels) = Pixmap::new(width as u32, height as u32) {
            let paint = Paint {
                shader: Shader::SolidColor(tiny_skia::Color::WHITE),
                ..Paint::default()
            };
            let [x, y] = self.low.map(|k| -k as f32);
            draw(&mut pixels, &paint, Transform::from_translate(x, y));
            for (share, pixel) in share.iter_mut().zip(pixels.pixels()) {
                *share = f32::from(pixel.alpha()) / 255.0;
            }
        }
        Cover {
            region: self,
            share,
        }
    }
}

impl Cover {
    /// A blur of about a width [px]: three means in a row are nearly a bell.
    pub fn blurred(&self, width: f32) -> Self {
        let mut soft = self.clone();
        let reach = width.round().max(0.0) as usize;
        let [columns, rows] = self.region.size;
        for _ in 0..3 {
            for row in 0..rows {
                blur(&mut soft.share, row * columns, 1, columns, reach);
            }
            for column in 0..columns {
                blur(&mut soft.share, column, columns, rows, reach);
            }
        }
        soft
    }

    /// With a sharp but smooth edge where it was a half.
    pub fn steeper(mut self) -> Self {
        for share in &mut self.share {
            *share = (4.0 * (*share - 0.5) + 0.5).clamp(0.0, 1.0);
        }
        self
    }

    /// How it changes from pixel to pixel to the right and downwards.
    pub fn slope(&self, x: usize, y: usize) -> [f32; 2] {
        let [columns, rows] = self.region.size;
        let at = |x: usize, y: usize| self.share[y * columns + x];
        let (left, right) = (x.saturating_sub(1), (x + 1).min(columns - 1));
        let (up, down) = (y.saturating_sub(1), (y + 1).min(rows - 1));
        let along = (at(right, y) - at(left, y)) / (right - left).max(1) as f32;
        let across = (at(x, down) - at(x, up)) / (down - up).max(1) as f32;
        [along, across]
    }
}

/// The mean over `reach` numbers to both sides of each of `count` numbers that are `step` apart.
fn blur(numbers: &mut [f32], start: usize, step: usize, count: usize, reach: usize) {
    let old: Vec<f32> = (0..count).map(|k| numbers[start + k * step]).collect();
    let mut sum: f32 = old.iter().take(reach).sum();
    for k in 0..count {
        if k + reach < count {
            sum += old[k + reach];
        }
        if k > reach {
            sum -= old[k - reach - 1];
        }
        numbers[start + k * step] = sum / (2 * reach + 1) as f32;
    }
}

fn path_of(lines: &[Vec<Spot>], closed: bool) -> Option<tiny_skia::Path> {
    let mut builder = PathBuilder::new();
    for line in lines {
        for (k, &[x, y]) in line.iter().enumerate() {
            match k {
                0 => builder.move_to(x, y),
                _ => builder.line_to(x, y),
            }
        }
        if closed {
            builder.close();
        }
    }
    builder.finish()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_blur_keeps_what_there_is_and_spreads_it() {
        let region = Region {
            low: [-20, -20],
            size: [60, 60],
        };
        let sharp = region.filled(&[crate::rectangle([0.0; 2], [20.0; 2])]);
        let soft = sharp.blurred(3.0);
        let sum = |cover: &Cover| cover.share.iter().sum::<f32>();
        assert!((sum(&sharp) - 400.0).abs() < 0.1 && (sum(&soft) - 400.0).abs() < 0.5);
        let at = |cover: &Cover, x: usize| cover.share[30 * 60 + x];
        assert!(at(&sharp, 19) == 0.0 && at(&soft, 19) > 0.3 && at(&soft, 30) > 0.99);
        assert!(soft.slope(20, 30)[0] > 0.05);
    }

    #[test]
    fn what_is_far_off_the_paper_has_no_region() {
        let far = crate::rectangle([500.0, 0.0], [20.0; 2]);
        assert_eq!(Region::around(&[far], 5.0, [100, 100]), None);
        let lost = vec![vec![[f32::NAN; 2]; 3]];
        assert_eq!(Region::around(&lost, 5.0, [100, 100]), None);
        let wall = vec![vec![[-1e5, 50.0], [1e5, 50.0], [0.0, 1e5]]];
        let region = Region::around(&wall, 5.0, [100, 100]).unwrap();
        assert_eq!((region.low, region.size), ([-5, 45], [110, 60]));
    }
}
