//! Several moments: one after the other in a GIF, or side by side in one image.

use crate::{PaintError, Painter};
use gif::{Encoder, Frame, Repeat};
use tiny_skia::Pixmap;

/// Gap between the moments of a strip [px].
const GAP: u32 = 12;

/// The frames as the bytes of a GIF that runs for ever, each shown for `hundredths` of a second.
///
/// # Errors
/// When there is no frame, or their sizes differ.
pub fn gif(frames: &[Pixmap], hundredths: u16) -> Result<Vec<u8>, PaintError> {
    let first = frames.first().ok_or(PaintError::NoFrame)?;
    let expected = size(first);
    let [width, height] = expected.map(u16::try_from);
    let width = width.map_err(PaintError::packing("GIF"))?;
    let height = height.map_err(PaintError::packing("GIF"))?;
    let mut bytes = Vec::new();
    let failed = PaintError::packing("GIF");
    let mut encoder = Encoder::new(&mut bytes, width, height, &[]).map_err(&failed)?;
    encoder.set_repeat(Repeat::Infinite).map_err(&failed)?;
    for (k, pixels) in frames.iter().enumerate() {
        let found = size(pixels);
        if found != expected {
            let frame = k + 1;
            return Err(PaintError::FrameSize {
                frame,
                found,
                expected,
            });
        }
        // 1 to 30, slow to fast: 10 is hardly worse than 1.
        let mut frame = Frame::from_rgba_speed(width, height, &mut pixels.data().to_vec(), 10);
        frame.delay = hundredths;
        encoder.write_frame(&frame).map_err(&failed)?;
    }
    drop(encoder);
    Ok(bytes)
}

/// The moments side by side, `columns` in a row, on paper of their own.
///
/// # Errors
/// When there is no moment.
pub fn strip(moments: &[Pixmap], columns: usize) -> Result<Painter, PaintError> {
    let first = moments.first().ok_or(PaintError::NoFrame)?;
    let rows = moments.len().div_ceil(columns) as u32;
    let pitch = [first.width() + GAP, first.height() + GAP];
    let across = columns.min(moments.len()) as u32;
    let mut painter = Painter::new(across * pitch[0] + GAP, rows * pitch[1] + GAP);
    for (k, pixels) in moments.iter().enumerate() {
        let (column, row) = ((k % columns) as u32, (k / columns) as u32);
        let at = [GAP + column * pitch[0], GAP + row * pitch[1]];
        painter.image(at.map(|k| k as f32), pixels.clone());
    }
    Ok(painter)
}

fn size(pixels: &Pixmap) -> [u32; 2] {
    [pixels.width(), pixels.height()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_film_has_its_frames_and_a_strip_its_width() {
        let frames = vec![Painter::new(20, 10).pixels().unwrap(); 3];
        let bytes = gif(&frames, 4).unwrap();
        assert!(bytes.starts_with(b"GIF89a"));
        let strip = strip(&frames, 2).unwrap().pixels().unwrap();
        assert_eq!((strip.width(), strip.height()), (2 * 32 + 12, 2 * 22 + 12));
        assert!(gif(&[], 4).is_err());
    }
}
