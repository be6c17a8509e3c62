//! Decoding of pictures other than PNG: photos, and what programs and web sites store.

use super::content::FileType;
use super::error::{FilePosition, PositionedProblem, unexpected};
use super::picture::{MAX_AREA, Pixels, check_size};
use image::{DynamicImage, ImageDecoder, ImageFormat, ImageReader, ImageResult, Limits, Rgb};
use std::io::Cursor;

/// Maximum memory for the pixels of a picture and the decoder's own tables [bytes]: three channels of 16 bits
/// would not fit, but no format here has them.
const DECODER_BYTES: u64 = 5 * MAX_AREA;

/// Returns the decoder's name of a format that this module decodes.
pub(super) fn format_of(file_type: FileType) -> Option<ImageFormat> {
    Some(match file_type {
        FileType::Jpeg => ImageFormat::Jpeg,
        FileType::WebP => ImageFormat::WebP,
        FileType::Gif => ImageFormat::Gif,
        FileType::Bmp => ImageFormat::Bmp,
        _ => return None,
    })
}

/// Returns width and height in the header of a file [pixels].
pub(super) fn size_of(bytes: &[u8], format: ImageFormat) -> Option<[u32; 2]> {
    let mut reader = ImageReader::with_format(Cursor::new(bytes), format);
    reader.limits(limits());
    let (width, height) = reader.into_dimensions().ok()?;
    Some([width, height])
}

/// Decodes a picture, turned as its EXIF orientation says. `file_type` names the format in errors.
pub(super) fn decode(
    bytes: &[u8],
    format: ImageFormat,
    file_type: FileType,
) -> Result<Pixels, PositionedProblem> {
    if file_type == FileType::Jpeg && !has_end(bytes) {
        let place = FilePosition::Byte(bytes.len());
        let expected = "the rest of the JPEG picture up to its end marker";
        return Err(unexpected(place, expected, "the end of the file"));
    }
    decode_as(bytes, format)
        .unwrap_or_else(|error| Err(unexpected(FilePosition::File, file_type.to_string(), error)))
}

/// Returns whether a JPEG file has its end marker. The decoder would make the missing rest of a truncated file
/// grey.
fn has_end(bytes: &[u8]) -> bool {
    const START: u8 = 0xD8;
    const END: u8 = 0xD9;
    let mut at = 0;
    while let Some(&[before, marker]) = bytes.get(at..at + 2) {
        match (before, marker) {
            (0xFF, END) => return true,
            // A segment with its length, which covers the two bytes of the length.
            (0xFF, 0xC0..=0xFE) if !matches!(marker, 0xD0..=START) => {
                let Some(&[high, low]) = bytes.get(at + 2..at + 4) else {
                    return false;
                };
                at += 2 + usize::from(u16::from_be_bytes([high, low]));
            }
            // A marker without a length, or a byte of compressed data.
            (0xFF, 0x00 | 0x01 | 0xD0..=START) => at += 2,
            _ => at += 1,
        }
    }
    false
}

fn decode_as(bytes: &[u8], format: ImageFormat) -> ImageResult<Result<Pixels, PositionedProblem>> {
    let mut reader = ImageReader::with_format(Cursor::new(bytes), format);
    reader.limits(limits());
    let mut decoder = reader.into_decoder()?;
    let (width, height) = decoder.dimensions();
    if let Err(problem) = check_size(FilePosition::File, [width, height]) {
        return Ok(Err(problem));
    }
    if let Err(problem) = check_length(format, bytes.len(), [width, height]) {
        return Ok(Err(problem));
    }
    let orientation = decoder.orientation()?;
    let mut picture = DynamicImage::from_decoder(decoder)?;
    picture.apply_orientation(orientation);
    let size = [picture.width() as usize, picture.height() as usize];
    let colours = match &picture {
        DynamicImage::ImageRgb8(picture) => {
            let pixels = picture.pixels();
            pixels
                .map(|&Rgb([red, green, blue])| [red, green, blue, u8::MAX])
                .collect()
        }
        DynamicImage::ImageRgba8(picture) => picture.pixels().map(|pixel| pixel.0).collect(),
        _ => picture.to_rgba8().pixels().map(|pixel| pixel.0).collect(),
    };
    Ok(Ok(Pixels { size, colours }))
}

/// Checks that a file is long enough for its size, before memory is allocated for the pixels. JPEG and WebP have
/// no useful limit: few bytes can stand for a large empty picture.
fn check_length(
    format: ImageFormat,
    length: usize,
    [width, height]: [u32; 2],
) -> Result<(), PositionedProblem> {
    let most_per_byte = match format {
        // A code of 12 bits stands for at most 4095 pixels.
        ImageFormat::Gif => 2730,
        // A run of two bytes stands for at most 255 pixels.
        ImageFormat::Bmp => 128,
        _ => return Ok(()),
    };
    let needed = (u64::from(width) * u64::from(height)).div_ceil(most_per_byte);
    if needed <= length as u64 {
        return Ok(());
    }
    let expected = format!("at least {needed} bytes for {width} x {height} pixels");
    Err(unexpected(FilePosition::File, expected, length))
}

/// Returns limits on memory. The size is checked here, where the error can name it.
fn limits() -> Limits {
    let mut limits = Limits::no_limits();
    limits.max_alloc = Some(DECODER_BYTES);
    limits
}
