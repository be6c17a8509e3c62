//! Errors of pictures and films.

use std::error::Error;

/// Reason why a picture or a film could not be made.
#[derive(Debug, thiserror::Error)]
pub enum PaintError {
    /// Paper or image without area, or shape without a finite size.
    #[error("{what} has no finite size above zero")]
    NoSize {
        /// Kind of the object without a size.
        what: &'static str,
    },
    /// A film or a strip without frames.
    #[error("a film or a strip needs at least one frame")]
    NoFrame,
    /// Frame of another size than the first frame.
    #[error("frame {frame} has {found:?} pixels, expected {expected:?} as in the first frame")]
    FrameSize {
        /// Number of the frame, from 1.
        frame: usize,
        /// Width and height of the frame [px].
        found: [u32; 2],
        /// Width and height of the first frame [px].
        expected: [u32; 2],
    },
    /// Failure of an encoder.
    #[error("{format}: {reason}")]
    Packing {
        /// Name of the file format: GIF or PNG.
        format: &'static str,
        /// Error of the encoder.
        reason: Box<dyn Error + Send + Sync>,
    },
}

impl PaintError {
    /// Returns a function that converts an error of an encoder.
    pub(crate) fn packing<E: Error + Send + Sync + 'static>(
        format: &'static str,
    ) -> impl Fn(E) -> Self {
        move |reason| Self::Packing {
            format,
            reason: Box::new(reason),
        }
    }
}
