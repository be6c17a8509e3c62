//! Sequences of pictures: an animated GIF, or a strip side by side in one image.

use crate::{PaintError, Painter};
use gif::{Encoder, Frame, Repeat};
use tiny_skia::Pixmap;

/// Gap between the pictures of a strip [px].
const GAP: u32 = 12;

/// Animated GIF that repeats forever. Frames are encoded as they are added, so that a long film needs no more
/// memory than its file.
#[derive(Default)]
pub struct Gif {
    /// Encoder for the size of the first frame; `None` before that frame.
    encoder: Option<Encoder<Vec<u8>>>,
    size: [u32; 2],
    count: usize,
}

impl Gif {
    /// Adds a frame, shown for `hundredths` of a second.
    ///
    /// # Errors
    /// [`PaintError::FrameSize`] if its size differs from that of the first frame.
    pub fn add(&mut self, pixels: &Pixmap, hundredths: u16) -> Result<(), PaintError> {
        let found = [pixels.width(), pixels.height()];
        let failed = PaintError::packing("GIF");
        let [width, height] = found.map(u16::try_from);
        let width = width.map_err(PaintError::packing("GIF"))?;
        let height = height.map_err(PaintError::packing("GIF"))?;
        self.count += 1;
        let encoder = match &mut self.encoder {
            Some(_) if found != self.size => {
                let (frame, expected) = (self.count, self.size);
                return Err(PaintError::FrameSize {
                    frame,
                    found,
                    expected,
                });
            }
            Some(encoder) => encoder,
            none => {
                self.size = found;
                let mut new = Encoder::new(Vec::new(), width, height, &[]).map_err(&failed)?;
                new.set_repeat(Repeat::Infinite).map_err(&failed)?;
                none.insert(new)
            }
        };
        // Speed of colour reduction, from 1 (slow) to 30 (fast). At 10, the result is hardly worse than at 1.
        let mut frame = Frame::from_rgba_speed(width, height, &mut pixels.data().to_vec(), 10);
        frame.delay = hundredths;
        encoder.write_frame(&frame).map_err(&failed)
    }

    /// Returns the bytes of the file.
    ///
    /// # Errors
    /// [`PaintError::NoFrame`] if there is no frame.
    pub fn finish(self) -> Result<Vec<u8>, PaintError> {
        let encoder = self.encoder.ok_or(PaintError::NoFrame)?;
        encoder.into_inner().map_err(PaintError::packing("GIF"))
    }
}

/// Encodes frames as an endless GIF, each shown for `hundredths` of a second.
///
/// # Errors
/// If there is no frame, or the sizes differ.
pub fn gif(frames: &[Pixmap], hundredths: u16) -> Result<Vec<u8>, PaintError> {
    let mut film = Gif::default();
    for pixels in frames {
        film.add(pixels, hundredths)?;
    }
    film.finish()
}

/// Arranges pictures side by side, `columns` in a row, on new paper.
///
/// # Errors
/// [`PaintError::NoFrame`] if there is no picture.
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gif_needs_frames_and_strip_arranges_them_in_rows() {
        let frames = vec![Painter::new(20, 10).pixels().unwrap(); 3];
        let bytes = gif(&frames, 4).unwrap();
        assert!(bytes.starts_with(b"GIF89a"));
        let strip = strip(&frames, 2).unwrap().pixels().unwrap();
        assert_eq!((strip.width(), strip.height()), (2 * 32 + 12, 2 * 22 + 12));
        assert!(gif(&[], 4).is_err());
    }
}
