//! Connected components and holes in a box of voxels. Voxels are connected through faces.

use std::collections::VecDeque;

/// Empties all connected components except the largest. Of equally large components, the first one stays.
pub fn keep_largest(size: [usize; 3], materials: &mut [u8]) {
    let mut is_seen = vec![false; materials.len()];
    let mut largest = (0, 0);
    for seed in 0..materials.len() {
        if materials[seed] != 0 && !is_seen[seed] {
            let count = flood(size, &[seed], |at| materials[at] != 0, &mut is_seen);
            if count > largest.0 {
                largest = (count, seed);
            }
        }
    }
    let (count, seed) = largest;
    if count > 0 {
        let mut is_kept = vec![false; materials.len()];
        flood(size, &[seed], |at| materials[at] != 0, &mut is_kept);
        for (material, is_kept) in materials.iter_mut().zip(is_kept) {
            *material *= u8::from(is_kept);
        }
    }
}

/// Fills enclosed empty voxels with the nearest material, counted in steps through faces. A voxel is enclosed
/// if no empty path leads from it to the border of the box.
pub fn fill_holes(size: [usize; 3], materials: &mut [u8]) {
    let is_border = |at: &usize| {
        let place = place(size, *at);
        (0..3).any(|axis| place[axis] == 0 || place[axis] + 1 == size[axis])
    };
    let border = (0..materials.len()).filter(|at| materials[*at] == 0 && is_border(at));
    let mut is_outside = vec![false; materials.len()];
    let border: Vec<usize> = border.collect();
    flood(size, &border, |at| materials[at] == 0, &mut is_outside);
    let solid = (0..materials.len()).filter(|&at| materials[at] != 0);
    let mut front: VecDeque<usize> = solid.collect();
    while let Some(at) = front.pop_front() {
        for next in neighbours(size, at) {
            if materials[next] == 0 && !is_outside[next] {
                materials[next] = materials[at];
                front.push_back(next);
            }
        }
    }
}

/// Returns the lowest and the highest solid voxel on each axis.
pub fn solid_box(size: [usize; 3], materials: &[u8]) -> Option<[[usize; 3]; 2]> {
    let solid = (0..materials.len()).filter(|&at| materials[at] != 0);
    solid.map(|at| place(size, at)).fold(None, |found, place| {
        let [low, high] = found.unwrap_or([place; 2]);
        let axes = [0, 1, 2];
        Some([
            axes.map(|axis: usize| low[axis].min(place[axis])),
            axes.map(|axis: usize| high[axis].max(place[axis])),
        ])
    })
}

/// Marks the seeds and all voxels that are connected to them through voxels for which `belongs` holds.
/// Returns the number of marked voxels.
fn flood(
    size: [usize; 3],
    seeds: &[usize],
    belongs: impl Fn(usize) -> bool,
    is_marked: &mut [bool],
) -> usize {
    let mut stack = seeds.to_vec();
    for &seed in seeds {
        is_marked[seed] = true;
    }
    let mut count = 0;
    while let Some(at) = stack.pop() {
        count += 1;
        for next in neighbours(size, at) {
            if belongs(next) && !is_marked[next] {
                is_marked[next] = true;
                stack.push(next);
            }
        }
    }
    count
}

fn place([width, height, _]: [usize; 3], at: usize) -> [usize; 3] {
    [at % width, at / width % height, at / width / height]
}

fn neighbours(size: [usize; 3], at: usize) -> impl Iterator<Item = usize> {
    let place = place(size, at);
    let stride = [1, size[0], size[0] * size[1]];
    (0..3).flat_map(move |axis| {
        let below = (place[axis] > 0).then(|| at - stride[axis]);
        let above = (place[axis] + 1 < size[axis]).then(|| at + stride[axis]);
        below.into_iter().chain(above)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Checks that `change` turns the layer of voxels `before` into `after`. Each digit is a material.
    fn check(change: fn([usize; 3], &mut [u8]), before: &[&str], after: &[&str]) {
        let size = [before[0].len(), before.len(), 1];
        let digits = |rows: &[&str]| rows.concat().bytes().map(|k| k - b'0').collect::<Vec<_>>();
        let mut materials = digits(before);
        change(size, &mut materials);
        assert_eq!(materials, digits(after));
    }

    #[test]
    fn keep_largest_ignores_materials() {
        let before = ["11001", "12000", "00110", "01110"];
        let after = ["00000", "00000", "00110", "01110"];
        check(keep_largest, &before, &after);
        check(keep_largest, &["100", "020"], &["100", "000"]);
        check(keep_largest, &["000"], &["000"]);
    }

    #[test]
    fn fill_holes_leaves_open_bay_empty() {
        // A single layer has no enclosed voxels, so it lies between two full layers.
        let full = "11111".repeat(4);
        let middle = ["11111", "10021", "11111", "10101"].concat();
        let text = [full.clone(), middle, full].concat();
        let mut materials: Vec<u8> = text.bytes().map(|k| k - b'0').collect();
        fill_holes([5, 4, 3], &mut materials);
        assert_eq!(materials[20..30], [1, 1, 1, 1, 1, 1, 1, 1, 2, 1]);
        assert_eq!(materials[35..], {
            let mut bay = vec![1, 0, 1, 0, 1];
            bay.extend([1; 20]);
            bay
        });
    }

    #[test]
    fn solid_box_encloses_solid_voxels() {
        assert_eq!(solid_box([2, 1, 1], &[0, 0]), None);
        let materials = [0, 0, 3, 0, 2, 0, 0, 0];
        assert_eq!(
            solid_box([4, 2, 1], &materials),
            Some([[0, 0, 0], [2, 1, 0]])
        );
    }
}
