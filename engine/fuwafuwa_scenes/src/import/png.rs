//! Decoding and encoding of PNG files.

use super::error::{FilePosition, PositionedProblem, unexpected};
use super::picture::{Pixels, check_size};
use ::png::{
    BitDepth, ColorType, Decoder, DecodingError, Encoder, EncodingError, Limits, Transformations,
};
use std::io::{Cursor, ErrorKind};

/// Maximum memory for the decoder's own tables and rows [bytes].
const DECODER_BYTES: usize = 1 << 24;

/// Maximum expansion of deflate, the compression of PNG: decoded bytes per compressed byte.
const MOST_INFLATED: usize = 1032;

/// Decodes a PNG file.
pub(super) fn decode(bytes: &[u8]) -> Result<Pixels, PositionedProblem> {
    let mut cursor = Cursor::new(bytes);
    decode_at(&mut cursor).unwrap_or_else(|error| {
        let place = FilePosition::Byte(cursor.position() as usize);
        let found = match error {
            DecodingError::IoError(error) if error.kind() == ErrorKind::UnexpectedEof => {
                "the end of the file".into()
            }
            error => error.to_string(),
        };
        Err(unexpected(place, "a PNG picture", found))
    })
}

/// Returns width and height in the header of a PNG file [pixels].
pub(super) fn size_of(bytes: &[u8]) -> Option<[u32; 2]> {
    let (words, _) = bytes.get(16..24)?.as_chunks::<4>();
    let &[width, height] = words else {
        return None;
    };
    Some([width, height].map(u32::from_be_bytes))
}

fn decode_at(
    cursor: &mut Cursor<&[u8]>,
) -> Result<Result<Pixels, PositionedProblem>, DecodingError> {
    let length = cursor.get_ref().len();
    let limits = Limits {
        bytes: DECODER_BYTES,
    };
    let mut decoder = Decoder::new_with_limits(cursor, limits);
    decoder.set_transformations(Transformations::normalize_to_color8() | Transformations::ALPHA);
    decoder.set_ignore_text_chunk(true);
    decoder.set_ignore_iccp_chunk(true);
    let header = decoder.read_header_info()?;
    let (width, height) = header.size();
    let place = FilePosition::Chunk(*b"IHDR", 8);
    if let Err(problem) = check_size(place, [width, height]) {
        return Ok(Err(problem));
    }
    // This check runs before memory is allocated: a file of a few bytes cannot contain a large picture.
    let needed = header.raw_bytes().div_ceil(MOST_INFLATED);
    if needed > length {
        let expected = format!("at least {needed} bytes for {width} x {height} pixels");
        return Ok(Err(unexpected(place, expected, format!("{length}"))));
    }

    let mut reader = decoder.read_info()?;
    let length = reader.output_buffer_size();
    let mut channels = vec![0; length.ok_or(DecodingError::LimitsExceeded)?];
    let frame = reader.next_frame(&mut channels)?;
    // Reads the file to its end, so that a file truncated after the last row of pixels is rejected, too.
    reader.finish()?;
    let pixels = channels[..frame.buffer_size()]
        .chunks_exact(frame.color_type.samples())
        .map(|pixel| match *pixel {
            [grey, alpha] => [grey, grey, grey, alpha],
            [red, green, blue, alpha] => [red, green, blue, alpha],
            _ => unreachable!("the decoder adds an alpha channel"),
        });
    let size = [frame.width as usize, frame.height as usize];
    Ok(Ok(Pixels {
        size,
        colours: pixels.collect(),
    }))
}

/// Encodes red, green, blue and alpha, row by row from the top, as a PNG file.
pub(super) fn encode([width, height]: [u32; 2], pixels: &[u8]) -> Result<Vec<u8>, EncodingError> {
    let mut bytes = Vec::new();
    let mut encoder = Encoder::new(&mut bytes, width, height);
    encoder.set_color(ColorType::Rgba);
    encoder.set_depth(BitDepth::Eight);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(pixels)?;
    writer.finish()?;
    Ok(bytes)
}
