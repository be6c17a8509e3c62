//! Number of frames of animated pictures, counted without decoding them.

use super::content::FileType;

/// Returns the number of frames of a picture that are not imported; 0 if the picture is not animated. Frames
/// after a damaged part of the file are not counted.
pub(super) fn left_out(bytes: &[u8]) -> usize {
    match FileType::of(bytes) {
        FileType::Png => frames_after_image(bytes),
        FileType::WebP => webp_frames(bytes).saturating_sub(1),
        FileType::Gif => gif_frames(bytes).saturating_sub(1),
        _ => 0,
    }
}

/// Returns the number of frames after the image that viewers without animation show. A PNG file consists of
/// chunks: length, name, contents and a checksum.
fn frames_after_image(bytes: &[u8]) -> usize {
    let mut rest = bytes.get(8..).unwrap_or_default();
    let (mut is_after_image, mut count) = (false, 0);
    while let Some((head, contents)) = rest.split_first_chunk::<8>() {
        let [a, b, c, d, name @ ..] = *head;
        match &name {
            b"IDAT" => is_after_image = true,
            b"fcTL" if is_after_image => count += 1,
            _ => {}
        }
        let length = u32::from_be_bytes([a, b, c, d]) as usize;
        rest = contents.get(length.saturating_add(4)..).unwrap_or_default();
    }
    count
}

/// Returns the number of frames of an animated WebP file. It consists of chunks: name, length and contents,
/// padded to an even length.
fn webp_frames(bytes: &[u8]) -> usize {
    let mut rest = bytes.get(12..).unwrap_or_default();
    let mut count = 0;
    while let Some((head, contents)) = rest.split_first_chunk::<8>() {
        let [name @ .., a, b, c, d] = *head;
        count += usize::from(name == *b"ANMF");
        let length = u32::from_le_bytes([a, b, c, d]) as usize;
        let padded = length.saturating_add(length % 2);
        rest = contents.get(padded..).unwrap_or_default();
    }
    count
}

/// Returns the number of images of a GIF file.
fn gif_frames(bytes: &[u8]) -> usize {
    const IMAGE: u8 = 0x2c;
    const EXTENSION: u8 = 0x21;
    let Some((header, contents)) = bytes.split_first_chunk::<13>() else {
        return 0;
    };
    let mut rest = after_colours(contents, header[10]);
    let mut count = 0;
    while let Some((&kind, contents)) = rest.split_first() {
        rest = match (kind, contents.split_first_chunk::<9>()) {
            (IMAGE, Some((descriptor, contents))) => {
                count += 1;
                let contents = after_colours(contents, descriptor[8]);
                // The byte before the blocks is the length of codes.
                after_blocks(contents.get(1..).unwrap_or_default())
            }
            // The byte before the blocks is the kind of the extension.
            (EXTENSION, _) => after_blocks(contents.get(1..).unwrap_or_default()),
            _ => break,
        };
    }
    count
}

/// Returns the bytes after a table of colours, which exists if the highest bit of `flags` is set.
fn after_colours(bytes: &[u8], flags: u8) -> &[u8] {
    let colours = match flags & 0x80 {
        0 => 0,
        _ => 2_usize << (flags & 7),
    };
    bytes.get(3 * colours..).unwrap_or_default()
}

/// Returns the bytes after a list of blocks. Each begins with its length; an empty one is the last.
fn after_blocks(mut bytes: &[u8]) -> &[u8] {
    while let Some((&length, contents)) = bytes.split_first() {
        bytes = contents.get(usize::from(length)..).unwrap_or_default();
        if length == 0 {
            break;
        }
    }
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_are_counted_in_chunks() {
        let png = |names: &[&[u8; 4]]| {
            let chunks = names
                .iter()
                .map(|name| [&[0, 0, 0, 3][..], &name[..], &[7; 3 + 4]].concat());
            [
                &b"\x89PNG\r\n\x1a\n"[..],
                &chunks.collect::<Vec<_>>().concat(),
            ]
            .concat()
        };
        assert_eq!(left_out(&png(&[b"IHDR", b"IDAT", b"IEND"])), 0);
        let all = png(&[
            b"acTL", b"fcTL", b"IDAT", b"IDAT", b"fcTL", b"fdAT", b"fcTL",
        ]);
        assert_eq!(left_out(&all), 2);
        assert_eq!(left_out(&all[..all.len() - 15]), 1);

        let webp = |frames: usize| {
            let frame = [&b"ANMF\x05\0\0\0"[..], &[7; 6]].concat();
            let head = b"RIFF\xff\0\0\0WEBPVP8X\x0a\0\0\0\0\0\0\0\0\0\0\0\0\0";
            [&head[..], &frame.repeat(frames)].concat()
        };
        assert_eq!([0, 1, 3].map(|frames| left_out(&webp(frames))), [0, 0, 2]);
    }
}
