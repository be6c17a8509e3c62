//! Rendering into an image without a window.

use super::Renderer;
use super::targets::{clear, new_texture};
use crate::frame::Frame;
use fuwafuwa::{Dim2, World};
use std::future::poll_fn;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::task::{Poll, Waker};
use wgpu::*;

/// Reason why an image could not be rendered.
#[derive(Debug, thiserror::Error)]
pub enum ImageError {
    /// The renderer's target format is neither Rgba8 nor Bgra8.
    #[error("unsupported image format: expected Rgba8 or Bgra8, the renderer draws in {0:?}")]
    Format(TextureFormat),
    /// The image is larger than the device allows.
    #[error(
        "image too large: {} x {} pixels requested, the device allows {side} pixels per side and {bytes} bytes in total",
        size[0], size[1]
    )]
    Size {
        /// Requested size [px].
        size: [u32; 2],
        /// Maximum side length [px].
        side: u32,
        /// Maximum buffer size [bytes].
        bytes: u64,
    },
    /// Waiting for the device failed.
    #[error("waiting for the GPU failed: {0}")]
    Poll(PollError),
    /// Mapping the image buffer failed.
    #[error("mapping the image buffer failed: {0}")]
    Map(BufferAsyncError),
    /// Reading the mapped image buffer failed.
    #[error("reading the image buffer failed: {0}")]
    Range(MapRangeError),
}

impl Renderer {
    /// Draws a world into an image of `size` pixels and waits for the result. Returns red, green, blue and
    /// opacity of each pixel, row by row from the upper left corner.
    ///
    /// # Errors
    /// [`ImageError`] if the renderer's format is not an image format, if the device does not support the
    /// size, or if the device fails.
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
            ImageStage::Prepare(encoder) => {
                self.prepare(device, queue, encoder, world, frame, size)
            }
            ImageStage::Paint(pass) => self.paint(pass),
        })
    }
}

/// Stage of drawing an image: first the intermediate images, then the image itself.
pub enum ImageStage<'a> {
    /// Before the render pass of the image.
    Prepare(&'a mut CommandEncoder),
    /// Inside the render pass of the image.
    Paint(&'a mut RenderPass<'static>),
}

/// Draws an image of a format and a size [px] with `draw`, which is called once per stage, and waits for the
/// result. Returns red, green, blue and opacity of each pixel, row by row from the upper left corner. `draw`
/// may paint more than a world, such as an overlay.
///
/// # Errors
/// Same errors as [`Renderer::render_to_image`].
pub fn image(
    device: &Device,
    queue: &Queue,
    of: (TextureFormat, [u32; 2]),
    draw: impl FnMut(ImageStage<'_>),
) -> Result<Vec<u8>, ImageError> {
    let drawn = Drawn::of(device, queue, of, draw)?;
    device
        .poll(PollType::wait_indefinitely())
        .map_err(ImageError::Poll)?;
    let mapped = drawn.answer().result.take();
    // The result is present after polling, except in browsers, which cannot wait.
    drawn.pixels(mapped.unwrap_or(Err(BufferAsyncError)))
}

/// Draws like [`image`] without blocking, as browsers require. The future completes once the caller polls or
/// uses the device again.
///
/// # Errors
/// Same errors as [`Renderer::render_to_image`].
pub async fn image_async(
    device: &Device,
    queue: &Queue,
    of: (TextureFormat, [u32; 2]),
    draw: impl FnMut(ImageStage<'_>),
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

/// Image that is being copied from the device.
struct Drawn {
    buffer: Buffer,
    size: [u32; 2],
    /// Bytes per row, padding included.
    row: usize,
    is_bgra: bool,
    answer: Arc<Mutex<Answer>>,
}

/// Result of mapping the buffer, and the waker of the task that waits for it.
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
        mut draw: impl FnMut(ImageStage<'_>),
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
        let mut encoder = device.create_command_encoder(&CommandEncoderDescriptor::default());
        draw(ImageStage::Prepare(&mut encoder));
        let mut pass = pass_into(&mut encoder, &view);
        draw(ImageStage::Paint(&mut pass));
        drop(pass);
        // Created after `draw`, which may submit: WebGL counts the creation as a write, and Chromium warns of
        // buffers that are written before and after a submission.
        let buffer = device.create_buffer(&BufferDescriptor {
            label: Some("image"),
            size: length,
            usage: BufferUsages::COPY_DST | BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
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

/// Begins a render pass that clears and fills an image. Renderers paint into it when there is no window.
pub fn pass_into(encoder: &mut CommandEncoder, view: &TextureView) -> RenderPass<'static> {
    let pass = encoder.begin_render_pass(&RenderPassDescriptor {
        label: Some("image"),
        color_attachments: &[clear(view, None)],
        ..RenderPassDescriptor::default()
    });
    pass.forget_lifetime()
}
