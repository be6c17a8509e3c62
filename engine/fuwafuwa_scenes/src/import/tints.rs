//! Tints: the few colours that a drawn body keeps.

use super::picture::covered;
use fuwafuwa::{Dim2, VoxelGrid};

/// Maximum number of tints of a picture.
pub(super) const MAX_TINTS: usize = 6;
/// Weight of an ink pixel; enclosed paper has 1. Keeps thin lines visible.
pub(super) const INK_WEIGHT: u8 = 3;
/// A tint needs at least 1 / `LEAST_SHARE` of the total weight.
const LEAST_SHARE: u64 = 200;
/// Squared distance of colours up to which they are shades of one tint.
const SHADES: u32 = 20_000;
/// Squared distance from a tint up to which no further tint begins.
const APART: u32 = 30_000;
/// Squared distance up to which two tints are one.
const SAME: u32 = 2_000;
/// Number of pixels per voxel that each round of sharpening blurred edges requires.
const SHARPENED: [usize; 2] = [3, 6];
/// Minimum difference of brightness across an edge that is sharpened, as in [`brightness`].
const EDGE: u32 = 400;
/// Maximum brightness and range of the channels of a pen. Brighter or more coloured ink is a crayon.
const PEN: (u32, u8) = (1050, 50);
/// Colour of light skin that is mixed into each tint, and its share in percent. Pure colours would look harsh
/// beside the other bodies.
const SKIN: ([u8; 3], u32) = ([255, 226, 206], 16);

/// Colour of a pixel, and its weight.
#[derive(Copy, Clone, Debug, PartialEq)]
pub(super) struct Sample {
    pub colour: [u8; 3],
    pub weight: u8,
}

/// Colours of the pixels of a shape, row by row from the top; `None` where the picture shows no colour.
pub(super) struct Samples {
    pub size: [usize; 2],
    pub pixels: Vec<Option<Sample>>,
}

/// A grid in which each material number is a tint, number 1 first.
pub(super) struct Tinted {
    pub grid: VoxelGrid<Dim2>,
    /// Red, green and blue of each tint.
    pub tints: Vec<[u8; 3]>,
}

/// Returns the tints of a shape whose solid voxels have the samples' colours. Returns `None` for a shape in the
/// one dark colour of a pen.
pub(super) fn tinted(grid: &VoxelGrid<Dim2>, samples: Samples) -> Option<Tinted> {
    let samples = samples.sharpened(grid);
    let found = frequent_colours(&samples);
    let [columns, rows, _] = grid.size().map(|extent| extent as usize);
    let votes = samples.votes(&found, [columns, rows]);
    let mut numbers = Vec::with_capacity(columns * rows);
    for (at, voxel) in grid.voxels().enumerate() {
        let votes = &votes[at * found.len()..(at + 1) * found.len()];
        numbers.push(match grid.is_solid(voxel) {
            true => Some(most(votes)),
            false => None,
        });
    }
    spread(&mut numbers, columns);
    let (numbers, tints) = ordered(&numbers, &found);
    if tints.iter().all(|&tint| is_pen(tint)) && tints.len() < 2 {
        return None;
    }
    let size = [columns, rows, 1];
    let grid = VoxelGrid::from_materials(size, grid.voxel_size(), numbers).ok()?;
    let tints = tints.into_iter().map(softened).collect();
    Some(Tinted { grid, tints })
}

/// Squared distance of two colours, weighted by how well the eye tells the channels apart.
fn distance(a: [u8; 3], b: [u8; 3]) -> u32 {
    let squares = [0, 1, 2].map(|k| u32::from(a[k].abs_diff(b[k])).pow(2));
    2 * squares[0] + 4 * squares[1] + 3 * squares[2]
}

/// Returns the brightness of a colour, 0 to 2295.
fn brightness([red, green, blue]: [u8; 3]) -> u32 {
    3 * u32::from(red) + 5 * u32::from(green) + u32::from(blue)
}

fn is_pen(colour: [u8; 3]) -> bool {
    let high = colour.into_iter().max().unwrap_or(0);
    let low = colour.into_iter().min().unwrap_or(0);
    brightness(colour) < PEN.0 && high - low < PEN.1
}

fn softened(colour: [u8; 3]) -> [u8; 3] {
    let (skin, share) = SKIN;
    [0, 1, 2].map(|k| {
        let (own, skin) = (u32::from(colour[k]), u32::from(skin[k]));
        ((own * (100 - share) + skin * share + 50) / 100) as u8
    })
}

impl Samples {
    /// Returns the samples with each pixel of a blurred edge moved to the nearer side of the edge, so that
    /// mixed colours along edges are no tints.
    fn sharpened(mut self, grid: &VoxelGrid<Dim2>) -> Self {
        let longest = grid.size().into_iter().max().unwrap_or(1).max(1) as usize;
        let detail = self.size[0].max(self.size[1]) / longest;
        for _ in SHARPENED.into_iter().filter(|&limit| detail >= limit) {
            let pixels = 0..self.pixels.len();
            self.pixels = pixels.map(|at| self.sharp(at)).collect();
        }
        self
    }

    fn sharp(&self, at: usize) -> Option<Sample> {
        let own = self.pixels[at]?;
        let [width, height] = self.size;
        let (column, row) = (at % width, at / width);
        let (mut dark, mut bright) = (own, own);
        for row in row.saturating_sub(1)..(row + 2).min(height) {
            for column in column.saturating_sub(1)..(column + 2).min(width) {
                let Some(near) = self.pixels[row * width + column] else {
                    continue;
                };
                if brightness(near.colour) < brightness(dark.colour) {
                    dark = near;
                }
                if brightness(near.colour) > brightness(bright.colour) {
                    bright = near;
                }
            }
        }
        let [low, own_brightness, high] = [dark, own, bright].map(|k| brightness(k.colour));
        Some(match () {
            () if high - low < EDGE => own,
            () if own_brightness - low <= high - own_brightness => dark,
            () => bright,
        })
    }

    /// Returns the weighted area of each tint in each voxel, voxels in the order of a grid.
    fn votes(&self, tints: &[[u8; 3]], [columns, rows]: [usize; 2]) -> Vec<u64> {
        let [width, height] = self.size;
        let nearest = self.pixels.iter().map(|sample| {
            let sample = (*sample)?;
            let all = 0..tints.len();
            let tint = all.min_by_key(|&tint| distance(tints[tint], sample.colour))?;
            Some((tint, u64::from(sample.weight)))
        });
        let nearest: Vec<Option<(usize, u64)>> = nearest.collect();
        let mut votes = vec![0; columns * rows * tints.len()];
        for y in 0..rows {
            for x in 0..columns {
                let own = &mut votes[(y * columns + x) * tints.len()..];
                for (row, high) in covered(height, rows, rows - 1 - y) {
                    for (column, wide) in covered(width, columns, x) {
                        if let Some((tint, weight)) = nearest[row * width + column] {
                            own[tint] += high * wide * weight;
                        }
                    }
                }
            }
        }
        votes
    }
}

/// Pixels of similar colours: their weight, and the weighted sums of their channels.
#[derive(Copy, Clone, Default)]
struct Bin {
    weight: u64,
    sums: [u64; 3],
}

impl Bin {
    fn add(&mut self, other: &Self) {
        self.weight += other.weight;
        (0..3).for_each(|k| self.sums[k] += other.sums[k]);
    }

    fn mean(&self) -> [u8; 3] {
        self.sums.map(|sum| (sum / self.weight.max(1)) as u8)
    }
}

/// Returns the most frequent colours, each the mean of its shades, most frequent first.
fn frequent_colours(samples: &Samples) -> Vec<[u8; 3]> {
    let mut bins = vec![Bin::default(); 1 << 12];
    for sample in samples.pixels.iter().flatten() {
        let [red, green, blue] = sample.colour.map(|channel| usize::from(channel >> 4));
        let weight = u64::from(sample.weight);
        bins[red << 8 | green << 4 | blue].add(&Bin {
            weight,
            sums: sample.colour.map(|channel| u64::from(channel) * weight),
        });
    }
    let filled = bins.into_iter().filter(|bin| bin.weight > 0);
    let mut bins: Vec<(Bin, [u8; 3])> = filled.map(|bin| (bin, bin.mean())).collect();
    let all: u64 = bins.iter().map(|(bin, _)| bin.weight).sum();
    let mut tints = Vec::new();
    while tints.len() < MAX_TINTS {
        let shades = |&(_, of): &(Bin, [u8; 3])| {
            let mut sum = Bin::default();
            let near = bins
                .iter()
                .filter(|&&(_, mean)| distance(mean, of) <= SHADES);
            near.for_each(|(bin, _)| sum.add(bin));
            sum
        };
        let best =
            bins.iter().map(shades).reduce(
                |best, sum| {
                    if sum.weight > best.weight { sum } else { best }
                },
            );
        let Some(best) = best.filter(|best| best.weight * LEAST_SHARE >= all) else {
            break;
        };
        let tint = best.mean();
        // Pixels of a colour this close vote for the tint found before.
        if tints.iter().all(|&known| distance(known, tint) > SAME) {
            tints.push(tint);
        }
        bins.retain(|&(_, mean)| distance(mean, tint) > APART);
    }
    tints
}

/// Returns the index of the largest number of votes, the first of equal ones; `None` without votes.
fn most(votes: &[u64]) -> Option<usize> {
    let all = 0..votes.len();
    let most = all.min_by_key(|&tint| std::cmp::Reverse(votes[tint]))?;
    (votes[most] > 0).then_some(most)
}

/// Gives each solid voxel without a tint the most frequent tint around it. `numbers` has `None` for empty voxels
/// and `Some(None)` for solid ones without a tint.
fn spread(numbers: &mut [Option<Option<usize>>], columns: usize) {
    loop {
        let before = numbers.to_vec();
        for at in 0..before.len() {
            if before[at] != Some(None) {
                continue;
            }
            let (column, row) = (at % columns, at / columns);
            let mut counts = [0; MAX_TINTS];
            for row in row.saturating_sub(1)..(row + 2).min(before.len() / columns) {
                for column in column.saturating_sub(1)..(column + 2).min(columns) {
                    if let Some(Some(tint)) = before[row * columns + column] {
                        counts[tint] += 1;
                    }
                }
            }
            numbers[at] = Some(most(&counts));
        }
        if before == numbers {
            return;
        }
    }
}

/// Returns the material number of each voxel, and the tints that voxels have, most frequent first.
fn ordered(numbers: &[Option<Option<usize>>], found: &[[u8; 3]]) -> (Vec<u8>, Vec<[u8; 3]>) {
    let mut counts = vec![0; found.len()];
    // A solid voxel far from every colour has the most frequent tint.
    let solid = || numbers.iter().flatten();
    solid().flatten().for_each(|&tint| counts[tint] += 1);
    let mut order: Vec<usize> = (0..found.len()).filter(|&tint| counts[tint] > 0).collect();
    order.sort_by_key(|&tint| std::cmp::Reverse(counts[tint]));
    let number = |tint: usize| order.iter().position(|&known| known == tint);
    let numbers = numbers.iter().map(|voxel| match voxel {
        None => 0,
        Some(tint) => 1 + tint.and_then(number).unwrap_or(0) as u8,
    });
    let numbers = numbers.collect();
    (numbers, order.into_iter().map(|tint| found[tint]).collect())
}
