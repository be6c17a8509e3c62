//! Intermediate images that 2D bodies are drawn into.

use super::cost::Gpu;
use super::pipelines::{Pipelines, SKIN_FORMAT, SOFT_FORMAT, STENCIL_FORMAT};
use super::program::SAMPLES;
use bytemuck::{Pod, Zeroable};
use wgpu::*;

/// Maximum number of pixels of an intermediate image. In larger windows, bodies are drawn at a lower
/// resolution and enlarged.
const MOST_PIXELS: f32 = 2.6e6;
/// Divisor from the size of the skin images to that of the images with the narrow blur; `WIDE` is that of the
/// wide blur.
pub const NARROW: u32 = 4;
const WIDE: u32 = 16;
/// Reach of a blur [standard deviations].
pub const REACH: f32 = 2.6;
/// Distance between the uniforms of two blur steps [bytes], equal to the largest offset alignment that any
/// device requires.
const STRIDE: u64 = 256;

/// Image of colour and coverage, then image of the relief (thickness, freshness of torn surfaces, strain).
type Pair = [TextureView; 2];

/// Intermediate images and the bind groups for drawing from one into the next.
pub struct Targets {
    /// Size of the window [px].
    pub window: [u32; 2],
    /// Size of the skin images [px].
    pub size: [u32; 2],
    pub multisampled: Pair,
    pub stencil: TextureView,
    pub skin: Pair,
    pub narrow: [Pair; 2],
    pub wide: [Pair; 2],
    /// Bind groups of the blur steps: skin → narrow, blur along x, along y, narrow → wide, along x, along y.
    pub steps: [BindGroup; 6],
    /// Inputs of the shape step, which computes slopes and thickness from the blurred bodies.
    pub shape: BindGroup,
    /// Inputs of the window's pass.
    pub body: BindGroup,
    uniforms: Buffer,
}

/// Uniforms of a blur step; see `blur.wgsl`.
#[repr(C)]
#[derive(Copy, Clone, Debug, Default, Pod, Zeroable)]
struct Blur {
    step: [f32; 2],
    sigma: f32,
    reach: f32,
}

impl Targets {
    pub fn new(device: &Device, pipelines: &Pipelines, window: [u32; 2]) -> Self {
        let window = window.map(|side| side.max(1));
        let size = limited_size(device, window);
        let (inside, readable) = (
            TextureUsages::RENDER_ATTACHMENT,
            TextureUsages::RENDER_ATTACHMENT | TextureUsages::TEXTURE_BINDING,
        );
        let image = |label, divisor: u32, samples, format, usage| {
            let size = size.map(|side| side.div_ceil(divisor));
            new_image(device, label, size, samples, format, usage)
        };
        let pair = |label, divisor, samples, format, usage| {
            [0, 1].map(|_| image(label, divisor, samples, format, usage))
        };
        let soft = |label, divisor| [0, 1].map(|_| pair(label, divisor, 1, SOFT_FORMAT, readable));
        let skin = pair("skin", 1, 1, SKIN_FORMAT, readable);
        let (narrow, wide) = (soft("narrow", NARROW), soft("wide", WIDE));
        let uniforms = new_uniforms(device, "blurs", 6 * STRIDE);
        let smooth = smooth(device);
        let sources = [
            &skin, &narrow[0], &narrow[1], &narrow[0], &wide[0], &wide[1],
        ];
        let steps = std::array::from_fn(|k| {
            let [colour, relief] = sources[k];
            let uniform = BufferBinding {
                buffer: &uniforms,
                offset: k as u64 * STRIDE,
                size: BufferSize::new(size_of::<Blur>() as u64),
            };
            bind(
                device,
                &pipelines.blur_layout,
                &[
                    BindingResource::TextureView(colour),
                    BindingResource::TextureView(relief),
                    BindingResource::Sampler(&smooth),
                    BindingResource::Buffer(uniform),
                ],
            )
        });
        let images = |layout, images: &[&TextureView]| {
            let images = images
                .iter()
                .map(|image| BindingResource::TextureView(image));
            let resources: Vec<BindingResource<'_>> =
                images.chain([BindingResource::Sampler(&smooth)]).collect();
            bind(device, layout, &resources)
        };
        let [blurred, shaped] = &narrow;
        Self {
            shape: images(
                &pipelines.shape_layout,
                &[&blurred[0], &blurred[1], &wide[0][0], &wide[0][1]],
            ),
            body: images(
                &pipelines.body_layout,
                &[
                    &skin[0],
                    &skin[1],
                    &blurred[0],
                    &wide[0][0],
                    &shaped[0],
                    &shaped[1],
                ],
            ),
            multisampled: pair("rough skin", 1, SAMPLES, SKIN_FORMAT, inside),
            stencil: image("stencil", 1, SAMPLES, STENCIL_FORMAT, inside),
            window,
            size,
            skin,
            narrow,
            wide,
            steps,
            uniforms,
        }
    }

    /// Returns the target of each blur step and its size divisor relative to the skin.
    pub fn drawn_into(&self) -> [(&Pair, u32); 6] {
        let narrow = [0, 1, 0].map(|k| (&self.narrow[k], NARROW));
        let wide = [0, 1, 0].map(|k| (&self.wide[k], WIDE));
        [narrow[0], narrow[1], narrow[2], wide[0], wide[1], wide[2]]
    }

    /// Sets the standard deviations of both blurs, in pixels of the skin.
    pub fn set_blur(&self, gpu: Gpu<'_>, narrow: f32, wide: f32) {
        let texel = |divisor: u32| self.size.map(|side| 1.0 / side.div_ceil(divisor) as f32);
        let shrink = |divisor: u32| Blur {
            step: texel(divisor).map(|side| 0.5 * side),
            ..Blur::default()
        };
        let soften = |divisor: u32, sigma: f32, axis: usize| {
            let mut step = [0.0; 2];
            step[axis] = texel(divisor)[axis];
            let sigma = (sigma / divisor as f32).clamp(0.5, 16.0);
            Blur {
                step,
                sigma,
                reach: (REACH * sigma).ceil(),
            }
        };
        let steps = [
            shrink(NARROW),
            soften(NARROW, narrow, 0),
            soften(NARROW, narrow, 1),
            shrink(WIDE),
            soften(WIDE, wide, 0),
            soften(WIDE, wide, 1),
        ];
        for (k, step) in steps.iter().enumerate() {
            let at = k as u64 * STRIDE;
            gpu.meter
                .write(gpu.queue, &self.uniforms, at, bytemuck::bytes_of(step));
        }
    }
}

/// Returns the size [px] of intermediate images for a window, limited by the device's maximum texture size
/// and by [`MOST_PIXELS`].
pub fn limited_size(device: &Device, window: [u32; 2]) -> [u32; 2] {
    let [width, height] = window.map(|side| side as f32);
    let longest = device.limits().max_texture_dimension_2d as f32 / width.max(height);
    let shrunk = (MOST_PIXELS / (width * height)).sqrt().min(longest);
    window.map(|side| ((side as f32 * shrunk.min(1.0)) as u32).max(1))
}

/// Creates a texture to draw into and returns a view of all of it.
pub fn new_image(
    device: &Device,
    label: &str,
    size: [u32; 2],
    samples: u32,
    format: TextureFormat,
    usage: TextureUsages,
) -> TextureView {
    let texture = new_texture(device, label, size, samples, format, usage);
    texture.create_view(&TextureViewDescriptor::default())
}

/// Creates a texture to draw into.
pub fn new_texture(
    device: &Device,
    label: &str,
    [width, height]: [u32; 2],
    samples: u32,
    format: TextureFormat,
    usage: TextureUsages,
) -> Texture {
    device.create_texture(&TextureDescriptor {
        label: Some(label),
        size: Extent3d {
            width,
            height,
            depth_or_array_layers: 1,
        },
        mip_level_count: 1,
        sample_count: samples,
        dimension: TextureDimension::D2,
        format,
        usage,
        view_formats: &[],
    })
}

/// Returns a cleared colour attachment. `smoothed` is the resolve target of a multisampled view.
pub fn clear<'a>(
    view: &'a TextureView,
    smoothed: Option<&'a TextureView>,
) -> Option<RenderPassColorAttachment<'a>> {
    Some(RenderPassColorAttachment {
        view,
        depth_slice: None,
        resolve_target: smoothed,
        ops: Operations {
            load: LoadOp::Clear(Color::TRANSPARENT),
            store: match smoothed {
                Some(_) => StoreOp::Discard,
                None => StoreOp::Store,
            },
        },
    })
}

/// Creates a uniform buffer of `size` bytes.
pub fn new_uniforms(device: &Device, label: &str, size: u64) -> Buffer {
    device.create_buffer(&BufferDescriptor {
        label: Some(label),
        size,
        usage: BufferUsages::UNIFORM | BufferUsages::COPY_DST,
        mapped_at_creation: false,
    })
}

/// Creates a sampler with linear filtering.
pub fn smooth(device: &Device) -> Sampler {
    device.create_sampler(&SamplerDescriptor {
        label: Some("smooth"),
        mag_filter: FilterMode::Linear,
        min_filter: FilterMode::Linear,
        ..SamplerDescriptor::default()
    })
}

pub fn bind(
    device: &Device,
    layout: &BindGroupLayout,
    resources: &[BindingResource<'_>],
) -> BindGroup {
    let entries = resources
        .iter()
        .enumerate()
        .map(|(binding, resource)| BindGroupEntry {
            binding: binding as u32,
            resource: resource.clone(),
        });
    let entries: Vec<BindGroupEntry<'_>> = entries.collect();
    device.create_bind_group(&BindGroupDescriptor {
        label: None,
        layout,
        entries: &entries,
    })
}
