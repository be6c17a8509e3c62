//! Ink on paper: which pixels of a drawing are drawn. A photo of a drawing has shadows, noise and coloured
//! paper with faint lines, so each pixel is compared with the paper around it.

use super::mask::Mask;

/// Number of tiles along the longer side of a picture in which the colour of the paper is estimated.
const TILES: usize = 24;
/// Minimum side of a tile [pixels].
const LEAST_TILE: usize = 16;
/// Share of the pixels of a tile that are darker than its paper.
const DARKER: f64 = 0.85;
/// Minimum brightness of a tile of paper, in units of the paper's trend. A darker tile is full of ink.
const LEAST_BRIGHT: f32 = 0.6;
/// Minimum brightness of paper, 0 to 255. A picture without such paper is taken as drawn on white paper.
const LEAST_PAPER: f32 = 96.0;
/// Share of the pixels that are darker than the ink that limits depend on. The darkest pixels alone may be
/// noise.
const DARKEST: f64 = 0.0005;
/// Darkness above which a pixel is drawn, in units of the darkness of the ink.
const DRAWN: f32 = 0.5;
/// Minimum darkness of ink, in units of the paper's brightness. It is above the noise of a photo.
const LEAST_DARK: f32 = 0.15;

/// Ink of a drawing, and the colours of all pixels as if the paper were white.
pub(super) struct Drawing {
    /// Pixels of ink: clearly darker or more coloured than the paper around them.
    pub ink: Mask,
    /// Red, green and blue, row by row from the top.
    pub colours: Vec<[u8; 3]>,
}

impl Drawing {
    /// Finds the ink of a drawing on paper. Transparent pixels are blended with white paper.
    pub fn on_paper(size: [usize; 2], pixels: &[[u8; 4]]) -> Self {
        let mut colours: Vec<[u8; 3]> = pixels.iter().map(|&pixel| on_white(pixel)).collect();
        let paper = Paper::of(size, &colours);
        let [width, _] = size;
        let darkness_of = |(at, pixel): (usize, &mut [u8; 3])| {
            let (column, row) = (at % width, at / width);
            let darkness = darkness(*pixel, paper.colour(column, row));
            *pixel = on_white_paper(*pixel, paper.light(column, row));
            darkness
        };
        let darkness: Vec<u8> = colours.iter_mut().enumerate().map(darkness_of).collect();
        let limit = limit(&darkness);
        let on = darkness.iter().map(|&dark| dark > limit).collect();
        Self {
            ink: Mask { size, on },
            colours,
        }
    }

    /// Returns a drawing with known ink. Transparent pixels are blended with white paper.
    pub fn without_paper(ink: Mask, pixels: &[[u8; 4]]) -> Self {
        let colours = pixels.iter().map(|&pixel| on_white(pixel)).collect();
        Self { ink, colours }
    }
}

/// Returns the colour that a pixel would have on white paper in full light.
fn on_white_paper(pixel: [u8; 3], paper: [f32; 3]) -> [u8; 3] {
    [0, 1, 2].map(|k| (255.0 * f32::from(pixel[k]) / paper[k].max(1.0)).min(255.0) as u8)
}

fn on_white([red, green, blue, alpha]: [u8; 4]) -> [u8; 3] {
    let alpha = u32::from(alpha);
    [red, green, blue]
        .map(|channel| ((u32::from(channel) * alpha + 255 * (255 - alpha)) / 255) as u8)
}

/// Returns how much darker a pixel is than its paper in the channel where the difference is largest, in units
/// of 1/255 of the paper's brightness.
fn darkness(pixel: [u8; 3], paper: [f32; 3]) -> u8 {
    let darkness = |k: usize| (paper[k] - f32::from(pixel[k])) / paper[k].max(LEAST_PAPER);
    let most = darkness(0).max(darkness(1)).max(darkness(2));
    (most.clamp(0.0, 1.0) * 255.0) as u8
}

/// Returns the darkness above which a pixel is drawn. It follows from the darkest pixels, so that the faint
/// lines of squared paper do not count beside a dark pen, and a faint pencil counts on plain paper.
fn limit(darkness: &[u8]) -> u8 {
    let counts = histogram(darkness.iter().copied());
    let mut left = (darkness.len() as f64 * DARKEST) as usize;
    let mut darkest = u8::MAX;
    for (dark, &count) in (0..=u8::MAX).zip(&counts).rev() {
        darkest = dark;
        if count > left {
            break;
        }
        left -= count;
    }
    let most = DRAWN * 255.0;
    (DRAWN * f32::from(darkest)).clamp(LEAST_DARK * 255.0, most) as u8
}

fn histogram(values: impl Iterator<Item = u8>) -> [usize; 256] {
    let mut counts = [0; 256];
    values.for_each(|value| counts[usize::from(value)] += 1);
    counts
}

/// Estimated colour of the paper: a smooth function of the position, given at the centres of tiles.
struct Paper {
    /// Side of a tile [pixels].
    tile: usize,
    /// Number of tiles along both axes.
    tiles: [usize; 2],
    /// Red, green and blue in each tile, row by row.
    colours: Vec<[f32; 3]>,
    /// Red, green and blue of the paper's trend in each tile. Unlike `colours`, it does not follow large areas
    /// of crayon.
    trends: Vec<[f32; 3]>,
}

impl Paper {
    fn of(size: [usize; 2], pixels: &[[u8; 3]]) -> Self {
        let tile = size[0].max(size[1]).div_ceil(TILES).max(LEAST_TILE);
        let tiles = size.map(|side| side.div_ceil(tile));
        let mut colours = vec![[0.0; 3]; tiles[0] * tiles[1]];
        let mut trends = colours.clone();
        for channel in 0..3 {
            let mut bright = vec![[0usize; 256]; colours.len()];
            for (at, pixel) in pixels.iter().enumerate() {
                let (column, row) = (at % size[0] / tile, at / size[0] / tile);
                bright[row * tiles[0] + column][usize::from(pixel[channel])] += 1;
            }
            let bright: Vec<f32> = bright.iter().map(percentile).collect();
            let trend = Trend::of(tiles, &bright);
            for (at, (colour, bright)) in colours.iter_mut().zip(bright).enumerate() {
                let trend = trend
                    .at(place(tiles, at % tiles[0], at / tiles[0]))
                    .clamp(0.0, 255.0);
                let is_paper = bright >= LEAST_BRIGHT * trend;
                colour[channel] = if is_paper { bright } else { trend };
                trends[at][channel] = trend;
            }
        }
        for colour in colours.iter_mut().chain(&mut trends) {
            let [red, green, blue] = *colour;
            if red.max(green).max(blue) < LEAST_PAPER {
                *colour = [255.0; 3];
            }
        }
        Self {
            tile,
            tiles,
            colours,
            trends,
        }
    }

    /// Returns the colour of the paper at a pixel, interpolated between the centres of the nearest tiles.
    fn colour(&self, column: usize, row: usize) -> [f32; 3] {
        self.interpolated(&self.colours, column, row)
    }

    /// Returns the trend of the paper's colour at a pixel: the light that falls on the paper there.
    fn light(&self, column: usize, row: usize) -> [f32; 3] {
        self.interpolated(&self.trends, column, row)
    }

    fn interpolated(&self, tiles: &[[f32; 3]], column: usize, row: usize) -> [f32; 3] {
        let ([left, right], x) = self.near(0, column);
        let ([top, bottom], y) = self.near(1, row);
        let of = |column: usize, row: usize| tiles[row * self.tiles[0] + column];
        let corners = [
            of(left, top),
            of(right, top),
            of(left, bottom),
            of(right, bottom),
        ];
        [0, 1, 2].map(|k| {
            let [a, b, c, d] = corners.map(|colour| colour[k]);
            (a * (1.0 - x) + b * x) * (1.0 - y) + (c * (1.0 - x) + d * x) * y
        })
    }

    /// Returns the two tiles between whose centres a pixel lies on an axis, and its place between them.
    fn near(&self, axis: usize, pixel: usize) -> ([usize; 2], f32) {
        let last = self.tiles[axis] - 1;
        let place = (pixel as f32 + 0.5) / self.tile as f32 - 0.5;
        let place = place.clamp(0.0, last as f32);
        let low = place as usize;
        ([low, (low + 1).min(last)], place - low as f32)
    }
}

/// Returns the brightness of the paper in a tile, from the number of its pixels of each brightness.
fn percentile(counts: &[usize; 256]) -> f32 {
    let all: usize = counts.iter().sum();
    let mut left = (all as f64 * DARKER) as usize;
    for (bright, &count) in counts.iter().enumerate() {
        if count > left {
            return bright as f32;
        }
        left -= count;
    }
    255.0
}

/// Returns the position of a tile, −1 to 1 on both axes.
fn place(tiles: [usize; 2], column: usize, row: usize) -> [f64; 2] {
    let on = |axis: usize, at: usize| match tiles[axis] {
        1 => 0.0,
        tiles => 2.0 * at as f64 / (tiles - 1) as f64 - 1.0,
    };
    [on(0, column), on(1, row)]
}

/// Number of coefficients of a trend.
const TERMS: usize = 6;

/// A quadratic function of the position that follows the brightest tiles, because ink only darkens.
struct Trend([f64; TERMS]);

impl Trend {
    /// Number of rounds in which the weights of the tiles are improved.
    const ROUNDS: usize = 12;
    /// Weight of a tile that is darker than the trend; a brighter one has weight 1.
    const DARK_WEIGHT: f64 = 0.03;
    /// Weight of keeping the coefficients of the slope and the curvature small.
    const FLAT: f64 = 1e-3;

    fn of(tiles: [usize; 2], bright: &[f32]) -> Self {
        let brightest = bright.iter().copied().fold(0.0, f32::max);
        let mut trend = Self([f64::from(brightest), 0.0, 0.0, 0.0, 0.0, 0.0]);
        for _ in 0..Self::ROUNDS {
            let mut matrix = [[0.0; TERMS + 1]; TERMS];
            for (at, &bright) in bright.iter().enumerate() {
                let place = place(tiles, at % tiles[0], at / tiles[0]);
                let weight = match bright < trend.at(place) {
                    true => Self::DARK_WEIGHT,
                    false => 1.0,
                };
                let terms = terms(place);
                for (row, a) in matrix.iter_mut().zip(terms) {
                    for (entry, b) in row.iter_mut().zip(terms) {
                        *entry += weight * a * b;
                    }
                    row[TERMS] += weight * a * f64::from(bright);
                }
            }
            for (k, row) in matrix.iter_mut().enumerate().skip(1) {
                row[k] += Self::FLAT * bright.len() as f64;
            }
            trend = Self(solved(matrix));
        }
        trend
    }

    fn at(&self, place: [f64; 2]) -> f32 {
        let terms = terms(place);
        (0..TERMS).map(|k| self.0[k] * terms[k]).sum::<f64>() as f32
    }
}

fn terms([x, y]: [f64; 2]) -> [f64; TERMS] {
    [1.0, x, y, x * x, x * y, y * y]
}

/// Solves a system of linear equations with a positive definite matrix; the right side is the last column.
fn solved(mut matrix: [[f64; TERMS + 1]; TERMS]) -> [f64; TERMS] {
    for pivot in 0..TERMS {
        let own = matrix[pivot];
        for (row, entries) in matrix.iter_mut().enumerate() {
            let factor = entries[pivot] / own[pivot];
            if row != pivot {
                (0..=TERMS).for_each(|k| entries[k] -= factor * own[k]);
            }
        }
    }
    let mut solution = [0.0; TERMS];
    for (k, value) in solution.iter_mut().enumerate() {
        *value = matrix[k][TERMS] / matrix[k][k];
    }
    solution
}
