//! MagicaVoxel files made chunk by chunk.

pub fn chunk(name: &[u8; 4], contents: &[u8], children: &[u8]) -> Vec<u8> {
    let mut bytes = name.to_vec();
    bytes.extend((contents.len() as u32).to_le_bytes());
    bytes.extend((children.len() as u32).to_le_bytes());
    bytes.extend(contents);
    bytes.extend(children);
    bytes
}

pub fn size(size: [u32; 3]) -> Vec<u8> {
    chunk(b"SIZE", &size.map(u32::to_le_bytes).concat(), &[])
}

/// Encodes a list of voxels with a stated length of `count`.
pub fn voxels(count: usize, voxels: &[[u8; 4]]) -> Vec<u8> {
    let contents = [&(count as u32).to_le_bytes()[..], &voxels.concat()].concat();
    chunk(b"XYZI", &contents, &[])
}

pub fn file(version: u32, chunks: &[Vec<u8>]) -> Vec<u8> {
    let main = chunk(b"MAIN", &[], &chunks.concat());
    [&b"VOX "[..], &version.to_le_bytes(), &main].concat()
}

pub fn model(extent: [u32; 3], list: &[[u8; 4]]) -> Vec<u8> {
    file(150, &[model_chunks(extent, list)])
}

/// Encodes the two chunks of a model.
pub fn model_chunks(extent: [u32; 3], list: &[[u8; 4]]) -> Vec<u8> {
    [size(extent), voxels(list.len(), list)].concat()
}

/// Returns the voxels of a solid box of one colour, with its low corner at `low`.
pub fn solid(low: [u8; 3], extent: [u8; 3], index: u8) -> Vec<[u8; 4]> {
    let [x, y, z] = [0, 1, 2].map(|axis| low[axis]..=low[axis] + (extent[axis] - 1));
    let columns = x.flat_map(|x| y.clone().map(move |y| (x, y)));
    columns
        .flat_map(|(x, y)| z.clone().map(move |z| [x, y, z, index]))
        .collect()
}

fn numbers(numbers: &[i32]) -> Vec<u8> {
    numbers.iter().flat_map(|k| k.to_le_bytes()).collect()
}

fn attributes(pairs: &[(&str, &str)]) -> Vec<u8> {
    let text = |text: &str| [numbers(&[text.len() as i32]), text.into()].concat();
    let mut bytes = numbers(&[pairs.len() as i32]);
    for (key, value) in pairs {
        bytes.extend([text(key), text(value)].concat());
    }
    bytes
}

/// Encodes a node with a motion. Each frame has attributes such as `("_t", "1 2 3")`.
pub fn transform(
    id: i32,
    child: i32,
    layer: i32,
    named: &[(&str, &str)],
    frames: &[&[(&str, &str)]],
) -> Vec<u8> {
    let frames_bytes = frames.iter().flat_map(|frame| attributes(frame));
    let contents = [
        numbers(&[id]),
        attributes(named),
        numbers(&[child, -1, layer, frames.len() as i32]),
        frames_bytes.collect(),
    ];
    chunk(b"nTRN", &contents.concat(), &[])
}

pub fn group(id: i32, named: &[(&str, &str)], children: &[i32]) -> Vec<u8> {
    let count = numbers(&[children.len() as i32]);
    let contents = [numbers(&[id]), attributes(named), count, numbers(children)];
    chunk(b"nGRP", &contents.concat(), &[])
}

pub fn shape(id: i32, named: &[(&str, &str)], models: &[i32]) -> Vec<u8> {
    let listed = models.iter().flat_map(|&model| numbers(&[model, 0]));
    let count = numbers(&[models.len() as i32]);
    let contents = [numbers(&[id]), attributes(named), count, listed.collect()];
    chunk(b"nSHP", &contents.concat(), &[])
}

pub fn layer(id: i32, named: &[(&str, &str)]) -> Vec<u8> {
    let contents = [numbers(&[id]), attributes(named), numbers(&[-1])];
    chunk(b"LAYR", &contents.concat(), &[])
}
