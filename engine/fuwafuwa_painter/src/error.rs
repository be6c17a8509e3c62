//! Why a picture or a film could not be made.

use std::error::Error;

/// Why a picture or a film could not be made.
#[derive(Debug, thiserror::Error)]
pub enum PaintError {
    /// Paper or an image without area, or a shape without a finite size.
    #[error("{what} has no finite size above zero")]
    NoSize {
        /// What it is.
        what: &'static str,
    },
    /// A film or a strip of nothing.
    #[error("a film or a strip needs at least one frame")]
    NoFrame,
    /// A frame that differs in size from the first.
    #[error("frame {frame} is {found:?} pixels, the first is {expected:?}: all must be alike")]
    FrameSize {
        /// Its number, from 1.
        frame: usize,
        /// Its width and height [px].
        found: [u32; 2],
        /// Those of the first frame [px].
        expected: [u32; 2],
    },
    /// The pixels could not be packed as a file.
    #[error("{format}: {reason}")]
    Packing {
        /// GIF or PNG.
        format: &'static str,
        /// Why.
        reason: Box<dyn Error + Send + Sync>,
    },
}

impl PaintError {
    /// What to make of a failure to pack pixels.
    pub(crate) fn packing<E: Error + Send + Sync + 'static>(
        format: &'static str,
    ) -> impl Fn(E) -> Self {
        move |reason| Self::Packing {
            format,
            reason: Box::new(reason),
        }
    }
}
