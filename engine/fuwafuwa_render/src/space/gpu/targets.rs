//! Intermediate images that a 3D world is drawn into.

use super::pipelines::{DEPTH_FORMAT, PICTURE_FORMAT, Pipelines, SHADOW_FORMAT};
use crate::gpu::program::SAMPLES;
use crate::gpu::targets::{bind, limited_size, new_image, smooth};
use wgpu::*;

/// Side lengths of the shadow map and of the sky map [px]. The sky map is smaller because it is blurred more.
pub const SHADOW_SIDES: [u32; 2] = [1024, 128];

/// Images of a picture, and the bind group for copying it into a window.
pub struct Targets {
    /// Size of the window [px].
    pub window: [u32; 2],
    /// Size of the picture [px].
    pub size: [u32; 2],
    pub rough: TextureView,
    pub depth: TextureView,
    pub picture: TextureView,
    pub shown: BindGroup,
}

/// Shadow map and sky map, and the bind group for reading both.
pub struct Shadows {
    pub maps: [TextureView; 2],
    pub read: BindGroup,
}

impl Targets {
    pub fn new(device: &Device, pipelines: &Pipelines, window: [u32; 2]) -> Self {
        let window = window.map(|side| side.max(1));
        let size = limited_size(device, window);
        let inside = TextureUsages::RENDER_ATTACHMENT;
        let picture = new_image(
            device,
            "picture",
            size,
            1,
            PICTURE_FORMAT,
            inside | TextureUsages::TEXTURE_BINDING,
        );
        let smooth = smooth(device);
        let shown = [
            BindingResource::TextureView(&picture),
            BindingResource::Sampler(&smooth),
        ];
        Self {
            window,
            size,
            rough: new_image(
                device,
                "rough picture",
                size,
                SAMPLES,
                PICTURE_FORMAT,
                inside,
            ),
            depth: new_image(device, "depth", size, SAMPLES, DEPTH_FORMAT, inside),
            shown: bind(device, &pipelines.window_layout, &shown),
            picture,
        }
    }
}

impl Shadows {
    pub fn new(device: &Device, pipelines: &Pipelines) -> Self {
        let usage = TextureUsages::RENDER_ATTACHMENT | TextureUsages::TEXTURE_BINDING;
        let maps = SHADOW_SIDES
            .map(|side| new_image(device, "shadow", [side; 2], 1, SHADOW_FORMAT, usage));
        let compare = device.create_sampler(&SamplerDescriptor {
            label: Some("shadow"),
            mag_filter: FilterMode::Linear,
            min_filter: FilterMode::Linear,
            compare: Some(CompareFunction::LessEqual),
            ..SamplerDescriptor::default()
        });
        let read = [
            BindingResource::TextureView(&maps[0]),
            BindingResource::TextureView(&maps[1]),
            BindingResource::Sampler(&compare),
        ];
        Self {
            read: bind(device, &pipelines.shadow_layout, &read),
            maps,
        }
    }
}
