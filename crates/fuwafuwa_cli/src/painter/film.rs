//! Several moments: one after the other in a GIF, or side by side in one image.

use super::Painter;
use anyhow::{Context, Result};
use gif::{Encoder, Frame, Repeat};
use tiny_skia::Pixmap;

/// Gap between the moments of a strip [px].
const GAP: u32 = 12;

/// The frames as the bytes of a GIF that runs for ever, each shown for `hundredths` of a second.
///
/// # Errors
/// When there is no frame, or their sizes differ.
pub fn gif(frames: &[Pixmap], hundredths: u16) -> Result<Vec<u8>> {
    let first = frames.first().context("a film needs a frame")?;
    let [width, height] = [first.width(), first.height()].map(u16::try_from);
    let (width, height) = (width?, height?);
    let mut bytes = Vec::new();
    let mut encoder = Encoder::new(&mut bytes, width, height, &[])?;
    encoder.set_repeat(Repeat::Infinite)?;
    for pixels in frames {
        anyhow::ensure!(
            (pixels.width(), pixels.height()) == (first.width(), first.height()),
            "the frames of a film differ in size"
        );
        // 1 to 30, slow to fast: 10 is hardly worse than 1.
        let mut frame = Frame::from_rgba_speed(width, height, &mut pixels.data().to_vec(), 10);
        frame.delay = hundredths;
        encoder.write_frame(&frame)?;
    }
    drop(encoder);
    Ok(bytes)
}

/// The moments side by side, `columns` in a row, on paper of their own.
///
/// # Errors
/// When there is no moment.
pub fn strip(moments: &[Pixmap], columns: usize) -> Result<Painter> {
    let first = moments.first().context("a strip needs a moment")?;
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
