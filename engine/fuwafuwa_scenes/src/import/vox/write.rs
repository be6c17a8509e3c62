//! Writing of files.

use super::assembly::Solid;
use super::palette::{self, Palette};
use super::{MAX_VOXELS_ACROSS, VERSIONS};

/// Part of a model that fits into a model of the format.
struct Block {
    /// Low corner and size on the axes of the file [voxels].
    low: [usize; 3],
    size: [usize; 3],
    voxels: Vec<[u8; 4]>,
}

/// Returns a file with a model. A model that is longer than the format allows is written in several blocks,
/// with a scene that puts them together.
pub(super) fn file(solid: &Solid, palette: &Palette) -> Vec<u8> {
    let blocks = blocks(solid);
    let mut children = Vec::new();
    for block in &blocks {
        let size = block.size.map(|extent| (extent as u32).to_le_bytes());
        let count = (block.voxels.len() as u32).to_le_bytes();
        children.extend(chunk(b"SIZE", size.as_flattened(), &[]));
        let voxels = [&count, block.voxels.as_flattened()].concat();
        children.extend(chunk(b"XYZI", &voxels, &[]));
    }
    if blocks.len() > 1 {
        children.extend(scene(&blocks));
    }
    if *palette != palette::DEFAULT {
        let colours = palette.iter();
        let colours = colours.flat_map(|&[red, green, blue]| [red, green, blue, u8::MAX]);
        children.extend(chunk(b"RGBA", &colours.collect::<Vec<_>>(), &[]));
    }
    let version = VERSIONS.start().to_le_bytes();
    [b"VOX ", &version[..], &chunk(b"MAIN", &[], &children)].concat()
}

fn chunk(name: &[u8; 4], contents: &[u8], children: &[u8]) -> Vec<u8> {
    let lengths = [contents.len() as u32, children.len() as u32].map(u32::to_le_bytes);
    [name, lengths.as_flattened(), contents, children].concat()
}

/// Divides a model into blocks of at most [`MAX_VOXELS_ACROSS`] voxels on an axis, without the empty ones.
fn blocks(solid: &Solid) -> Vec<Block> {
    const MOST: usize = MAX_VOXELS_ACROSS as usize;
    let [width, height, depth] = solid.size;
    let extents = [width, depth, height];
    let counts = extents.map(|extent| extent.div_ceil(MOST));
    let mut blocks: Vec<Block> = (0..counts.into_iter().product())
        .map(|at| {
            let cell = [
                at % counts[0],
                at / counts[0] % counts[1],
                at / counts[0] / counts[1],
            ];
            let low = cell.map(|k| k * MOST);
            Block {
                low,
                size: [0, 1, 2].map(|axis| MOST.min(extents[axis] - low[axis])),
                voxels: Vec::new(),
            }
        })
        .collect();
    for (at, &index) in solid
        .voxels
        .iter()
        .enumerate()
        .filter(|(_, index)| **index != 0)
    {
        let (x, y, z) = (at % width, at / width % height, at / width / height);
        // Converts the position to the axes of the file, on which z points up.
        let place = [x, depth - 1 - z, y];
        let [column, row, layer] = place.map(|k| k / MOST);
        let [x, y, z] = place.map(|k| (k % MOST) as u8);
        let block = (layer * counts[1] + row) * counts[0] + column;
        blocks[block].voxels.push([x, y, z, index]);
    }
    blocks.retain(|block| !block.voxels.is_empty());
    blocks
}

/// Returns the nodes of a scene that puts blocks together: a root, a group, and two nodes for each block.
fn scene(blocks: &[Block]) -> Vec<u8> {
    let transform = |id: i32, translation: [usize; 3]| {
        let [x, y, z] = translation;
        let translation = [text("_t"), text(&format!("{x} {y} {z}"))].concat();
        let fields = [numbers(&[id, 0, id + 1, -1, -1, 1, 1]), translation].concat();
        chunk(b"nTRN", &fields, &[])
    };
    let id = |index: usize| 2 + 2 * index as i32;
    let children: Vec<i32> = (0..blocks.len()).map(id).collect();
    let count = blocks.len() as i32;
    let group = [numbers(&[1, 0, count]), numbers(&children)].concat();
    let mut nodes = [transform(0, [0; 3]), chunk(b"nGRP", &group, &[])].concat();
    for (index, block) in blocks.iter().enumerate() {
        // The motion of a model is that of its pivot.
        let pivot = [0, 1, 2].map(|axis| block.low[axis] + block.size[axis] / 2);
        nodes.extend(transform(id(index), pivot));
        let shape = numbers(&[id(index) + 1, 0, 1, index as i32, 0]);
        nodes.extend(chunk(b"nSHP", &shape, &[]));
    }
    nodes
}

fn numbers(numbers: &[i32]) -> Vec<u8> {
    numbers
        .iter()
        .flat_map(|number| number.to_le_bytes())
        .collect()
}

fn text(text: &str) -> Vec<u8> {
    [&(text.len() as u32).to_le_bytes(), text.as_bytes()].concat()
}
