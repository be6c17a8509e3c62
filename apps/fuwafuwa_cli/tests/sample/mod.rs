//! A small scan for tests.

/// Returns a NIfTI-1 file with a cube of 9³ voxels of 2 mm, surrounded by empty voxels.
pub fn cube() -> Vec<u8> {
    let mut bytes = vec![0; 352 + 13 * 13 * 13];
    bytes[..4].copy_from_slice(&348_i32.to_le_bytes());
    for (index, number) in [3, 13, 13, 13, 1, 1, 1, 1].into_iter().enumerate() {
        bytes[40 + 2 * index..][..2].copy_from_slice(&i16::to_le_bytes(number));
    }
    bytes[70] = 2;
    bytes[72] = 8;
    bytes[108..112].copy_from_slice(&352_f32.to_le_bytes());
    for axis in 0..3 {
        bytes[80 + 4 * axis..][..4].copy_from_slice(&2_f32.to_le_bytes());
    }
    bytes[344..348].copy_from_slice(b"n+1\0");
    for at in 0..13 * 13 * 13 {
        let is_inside = [at % 13, at / 13 % 13, at / 169]
            .iter()
            .all(|k| (2..11).contains(k));
        bytes[352 + at] = u8::from(is_inside);
    }
    bytes
}
