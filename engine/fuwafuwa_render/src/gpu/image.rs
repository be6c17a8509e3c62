//! A picture without a window.

use super::Renderer;
use super::targets::{clear, new_texture};
use crate::frame::Frame;
use fuwafuwa::{Dim2, World};
use std::fmt;
use std::future::poll_fn;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::task::{Poll, Waker};
use wgpu::*;

/// Why there is no image.
#[derive(Debug)]
pub enum ImageError {
    /// The renderer draws in a format that is not four bytes of colour.
    Format(TextureFormat),
    /// The device takes no image that large.
    Size {
        /// Asked for [px].
        size: [u32; 2],
        /// Most pixels on a side.
        side: u32,
        /// Most bytes in all.
        bytes: u64,
    },
    /// The device did not finish.
    Poll(PollError),
    /// What it drew cannot be read.
    Map(BufferAsyncError),
    /// What it drew lies where nothing can be read.
    Range(MapRangeError),
}

impl fmt::Display for ImageError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Format(format) => write!(
                f,
                "an image needs a renderer for Rgba8 or Bgra8, this one is for {format:?}"
            ),
            Self::Size {
                size: [width, height],
                side,
                bytes,
            } => write!(
                f,
                "an image of {width} x {height} pixels is too large for the device, which takes {side} on a side and {bytes} bytes in all"
            ),
            Self::Poll(error) => write!(f, "the device did not finish drawing: {error}"),
            Self::Map(error) => write!(f, "the image cannot be read from the device: {error}"),
            Self::Range(error) => write!(f, "the image cannot be read from the device: {error}"),
        }
    }
}

impl std::error::Error for ImageError {}

impl Renderer {
    /// Draws a world into an image of `size` pixels: red, green, blue and opacity of each, row by
    /// row from the upper left corner. Waits until it is there.
    ///
    /// # Errors
    /// [`ImageError`] when the format is none for images, when the device takes none of that size, or
    /// when it fails.
    pub fn render_to_image(
        &mut self,
        device: &Device,
        queue: &Queue,
        world: &World<Dim2>,
        frame: &Frame<'_>,
        size: [u32; 2],
    ) -> Result<Vec<u8>, ImageError> {
        let target = (self.format, size);
        image(device, queue, target, |step| match step {
            Step::Before(encoder) => self.prepare(device, queue, encoder, world, frame, size),
            Step::Inside(pass) => self.paint(pass),
        })
    }
}

/// What there is to draw an image into: first what is drawn apart, then the image itself.
pub enum Step<'a> {
    /// Before the pass of the image.
    Before(&'a mut CommandEncoder),
    /// The pass of the image.
    Inside(&'a mut RenderPass<'static>),
}

/// An image of a format and a size in pixels, as `draw` draws it in two steps: red, green, blue and opacity of each pixel,
/// row by row from the upper left corner. Waits until it is there. For who draws something over a world, or beside it.
///
/// # Errors
/// As [`Renderer::render_to_image`].
pub fn image(
    device: &Device,
    queue: &Queue,
    of: (TextureFormat, [u32; 2]),
    draw: impl FnMut(Step<'_>),
) -> Result<Vec<u8>, ImageError> {
    let drawn = Drawn::of(device, queue, of, draw)?;
    device
        .poll(PollType::wait_indefinitely())
        .map_err(ImageError::Poll)?;
    let mapped = drawn.answer().result.take();
    // A finished device has called back, but for those of browsers.
    drawn.pixels(mapped.unwrap_or(Err(BufferAsyncError)))
}

/// The same where nobody may wait, as in a browser: it is there once the device was used for something else.
///
/// # Errors
/// As [`Renderer::render_to_image`].
pub async fn image_later(
    device: &Device,
    queue: &Queue,
    of: (TextureFormat, [u32; 2]),
    draw: impl FnMut(Step<'_>),
) -> Result<Vec<u8>, ImageError> {
    let drawn = Drawn::of(device, queue, of, draw)?;
    let mapped = poll_fn(|context| {
        let mut answer = drawn.answer();
        answer.waker = Some(context.waker().clone());
        answer.result.take().map_or(Poll::Pending, Poll::Ready)
    });
    let mapped = mapped.await;
    drawn.pixels(mapped)
}

/// An image on its way from the device.
struct Drawn {
    buffer: Buffer,
    size: [u32; 2],
    /// Bytes from one row to the next.
    row: usize,
    is_bgra: bool,
    answer: Arc<Mutex<Answer>>,
}

/// Whether it has arrived, and who waits for that.
#[derive(Default)]
struct Answer {
    result: Option<Result<(), BufferAsyncError>>,
    waker: Option<Waker>,
}

impl Drawn {
    fn of(
        device: &Device,
        queue: &Queue,
        (format, size): (TextureFormat, [u32; 2]),
        mut draw: impl FnMut(Step<'_>),
    ) -> Result<Self, ImageError> {
        let plain = format.remove_srgb_suffix();
        if !matches!(plain, TextureFormat::Rgba8Unorm | TextureFormat::Bgra8Unorm) {
            return Err(ImageError::Format(format));
        }
        let size = size.map(|side| side.max(1));
        let row = (4 * u64::from(size[0])).next_multiple_of(COPY_BYTES_PER_ROW_ALIGNMENT.into());
        let length = row * u64::from(size[1]);
        let limits = device.limits();
        let (side, bytes) = (limits.max_texture_dimension_2d, limits.max_buffer_size);
        if size[0].max(size[1]) > side || length > bytes {
            return Err(ImageError::Size { size, side, bytes });
        }
        let extent = Extent3d {
            width: size[0],
            height: size[1],
            depth_or_array_layers: 1,
        };
        let usage = TextureUsages::RENDER_ATTACHMENT | TextureUsages::COPY_SRC;
        let texture = new_texture(device, "image", size, 1, format, usage);
        let view = texture.create_view(&TextureViewDescriptor::default());
        let buffer = device.create_buffer(&BufferDescriptor {
            label: Some("image"),
            size: length,
            usage: BufferUsages::COPY_DST | BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        let mut encoder = device.create_command_encoder(&CommandEncoderDescriptor::default());
        draw(Step::Before(&mut encoder));
        let mut pass = pass_into(&mut encoder, &view);
        draw(Step::Inside(&mut pass));
        drop(pass);
        let into = TexelCopyBufferInfo {
            buffer: &buffer,
            layout: TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(row as u32),
                rows_per_image: None,
            },
        };
        encoder.copy_texture_to_buffer(texture.as_image_copy(), into, extent);
        queue.submit([encoder.finish()]);

        let answer = Arc::new(Mutex::new(Answer::default()));
        let there = answer.clone();
        buffer.map_async(MapMode::Read, .., move |result| {
            let mut answer = there.lock().unwrap_or_else(PoisonError::into_inner);
            answer.result = Some(result);
            if let Some(waker) = answer.waker.take() {
                waker.wake();
            }
        });
        Ok(Self {
            buffer,
            size,
            row: row as usize,
            is_bgra: plain == TextureFormat::Bgra8Unorm,
            answer,
        })
    }

    fn answer(&self) -> MutexGuard<'_, Answer> {
        self.answer.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn pixels(self, mapped: Result<(), BufferAsyncError>) -> Result<Vec<u8>, ImageError> {
        mapped.map_err(ImageError::Map)?;
        let bytes = self
            .buffer
            .get_mapped_range(..)
            .map_err(ImageError::Range)?;
        let rows = bytes.chunks(self.row);
        let mut image: Vec<u8> = rows
            .flat_map(|row| &row[..4 * self.size[0] as usize])
            .copied()
            .collect();
        if self.is_bgra {
            image.chunks_exact_mut(4).for_each(|pixel| pixel.swap(0, 2));
        }
        Ok(image)
    }
}

/// A pass that fills an image, clear at first: what renderers paint into where there is no window.
pub fn pass_into(encoder: &mut CommandEncoder, view: &TextureView) -> RenderPass<'static> {
    let pass = encoder.begin_render_pass(&RenderPassDescriptor {
        label: Some("image"),
        color_attachments: &[clear(view, None)],
        ..RenderPassDescriptor::default()
    });
    pass.forget_lifetime()
}
