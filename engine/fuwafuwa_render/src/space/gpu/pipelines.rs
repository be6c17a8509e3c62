//! Render pipelines for each kind of 3D vertex.

use crate::gpu::program::{
    OVER, Program, SAMPLES, Target, VertexLayout, entry, layout, module, sampler, texture, uniform,
    wgsl,
};
use crate::space::boxes::BoxVertex;
use crate::space::room::RoomVertex;
use crate::space::rounded::{RoundedInstance, RoundedVertex};
use crate::space::skin::SkinVertex;
use wgpu::*;

/// Format of the picture. Its values are already sRGB-encoded.
pub const PICTURE_FORMAT: TextureFormat = TextureFormat::Rgba8Unorm;
/// Format of the depth seen from the camera.
pub const DEPTH_FORMAT: TextureFormat = TextureFormat::Depth24Plus;
/// Format of the depth seen from the light.
pub const SHADOW_FORMAT: TextureFormat = TextureFormat::Depth32Float;

/// All render pipelines and their bind group layouts.
pub struct Pipelines {
    pub globals_layout: BindGroupLayout,
    pub shadow_layout: BindGroupLayout,
    pub window_layout: BindGroupLayout,
    pub sky: RenderPipeline,
    pub room: RenderPipeline,
    pub skin: RenderPipeline,
    pub sticker: RenderPipeline,
    pub ghost_depth: RenderPipeline,
    pub ghost: RenderPipeline,
    pub ghost_part: RenderPipeline,
    pub element: RenderPipeline,
    pub bar: RenderPipeline,
    pub thin_bar: RenderPipeline,
    pub glass: RenderPipeline,
    pub hand: RenderPipeline,
    pub hidden_hand: RenderPipeline,
    pub crumb: RenderPipeline,
    pub dust: RenderPipeline,
    pub line: RenderPipeline,
    pub glow: RenderPipeline,
    /// Draws the depth of skins as shadow casters, seen from the light.
    pub skin_shadow: RenderPipeline,
    pub element_shadow: RenderPipeline,
    pub bar_shadow: RenderPipeline,
    pub crumb_shadow: RenderPipeline,
    /// Copies the finished picture into a window.
    pub window: RenderPipeline,
}

impl Pipelines {
    pub fn new(device: &Device, target: TextureFormat) -> Self {
        let globals_layout = layout(device, "globals", &[uniform(0)]);
        let depth = BindingType::Texture {
            sample_type: TextureSampleType::Depth,
            view_dimension: TextureViewDimension::D2,
            multisampled: false,
        };
        let compare = BindingType::Sampler(SamplerBindingType::Comparison);
        let shadow_layout = layout(
            device,
            "shadow",
            &[entry(0, depth), entry(1, depth), entry(2, compare)],
        );
        let window_layout = layout(device, "window", &[texture(0), sampler(1)]);
        let skin = wgsl!(
            "space.wgsl",
            "whole.wgsl",
            "light.wgsl",
            "space_light.wgsl",
            "space_skin.wgsl"
        );
        let skin = module(device, "skin", skin);
        let rigid = wgsl!(
            "space.wgsl",
            "whole.wgsl",
            "light.wgsl",
            "space_light.wgsl",
            "space_rigid.wgsl"
        );
        let rigid = module(device, "rigid", rigid);
        let window = module(device, "window", wgsl!("whole.wgsl", "space_window.wgsl"));
        let program =
            |extra, module, entries| Program::new(device, &globals_layout, extra, module, entries);
        let solid = Target {
            depth: Some(depth_state(DEPTH_FORMAT, true)),
            cull: Some(Face::Back),
            samples: SAMPLES,
            ..Target::of(&[PICTURE_FORMAT])
        };
        let clear = Target {
            depth: Some(depth_state(DEPTH_FORMAT, false)),
            blend: Some(OVER),
            ..solid.clone()
        };
        let dark = Target {
            depth: Some(DepthStencilState {
                bias: DepthBiasState {
                    constant: 2,
                    slope_scale: 2.0,
                    clamp: 0.0,
                },
                ..depth_state(SHADOW_FORMAT, true)
            }),
            ..Target::of(&[])
        };
        let drawn =
            |module, entries, buffers: &[Option<VertexBufferLayout<'_>>], target: &Target<'_>| {
                let shadow = (!target.formats.is_empty()).then_some(&shadow_layout);
                program(shadow, module, entries).build(&Target {
                    buffers,
                    ..target.clone()
                })
            };
        let skins = [Some(SkinVertex::layout())];
        let boxes = [Some(BoxVertex::layout())];
        let rounded = [
            Some(RoundedVertex::layout()),
            Some(RoundedInstance::layout()),
        ];
        let balls = |entries, target| drawn(&rigid, entries, &rounded, target);
        let behind = Target {
            depth: Some(DepthStencilState {
                depth_compare: Some(CompareFunction::Greater),
                ..depth_state(DEPTH_FORMAT, false)
            }),
            ..clear.clone()
        };
        // Returns a depth state with a bias in depth steps; positive steps put a surface behind another one
        // at the same depth.
        let moved = |steps: i32, is_written| {
            Some(DepthStencilState {
                bias: DepthBiasState {
                    constant: steps,
                    slope_scale: 0.25 * steps as f32,
                    clamp: 0.0,
                },
                ..depth_state(DEPTH_FORMAT, is_written)
            })
        };
        // A ghost is drawn slightly farther away, so that a body in the same position hides it. A basket is
        // drawn closer, so that the floor does not hide its bottom.
        let farther = |is_written| moved(16, is_written);
        let both_sides = Target {
            depth: moved(-16, false),
            cull: None,
            ..clear.clone()
        };
        let ghost_depth = Target {
            depth: farther(true),
            mask: ColorWrites::empty(),
            ..solid.clone()
        };
        let ghost = Target {
            depth: farther(false),
            ..clear.clone()
        };
        let window_entry = match target.is_srgb() {
            true => "linear_window",
            false => "window",
        };
        Self {
            sky: drawn(&rigid, ("sky_corner", "sky"), &[], &clear),
            room: drawn(
                &rigid,
                ("room_corner", "room"),
                &[Some(RoomVertex::layout())],
                &solid,
            ),
            skin: drawn(&skin, ("skin_corner", "skin"), &skins, &solid),
            // The coloured patches of a sticker lie at almost the same depth and are painted over each other,
            // so they do not write depth.
            sticker: drawn(&skin, ("skin_corner", "sticker"), &skins, &clear),
            ghost_depth: drawn(&skin, ("skin_corner", "ghost"), &skins, &ghost_depth),
            ghost: drawn(&skin, ("skin_corner", "ghost"), &skins, &ghost),
            ghost_part: balls(("plain_corner", "hidden_hand"), &clear),
            element: drawn(&skin, ("box_corner", "box_side"), &boxes, &solid),
            bar: balls(("plain_corner", "bar"), &solid),
            thin_bar: balls(("plain_corner", "bar"), &clear),
            glass: balls(("plain_corner", "glass"), &clear),
            hand: balls(("plain_corner", "hand"), &solid),
            hidden_hand: balls(("plain_corner", "hidden_hand"), &behind),
            crumb: balls(("rough_corner", "crumb"), &solid),
            dust: balls(("rough_corner", "dust"), &clear),
            line: balls(("plain_corner", "line"), &clear),
            glow: balls(("plain_corner", "glow"), &both_sides),
            skin_shadow: drawn(&skin, ("skin_corner", ""), &skins, &dark),
            element_shadow: drawn(&skin, ("box_corner", ""), &boxes, &dark),
            bar_shadow: balls(("plain_corner", ""), &dark),
            crumb_shadow: balls(("rough_corner", ""), &dark),
            window: program(Some(&window_layout), &window, ("whole", window_entry))
                .build(&Target::of(&[target])),
            globals_layout,
            shadow_layout,
            window_layout,
        }
    }
}

fn depth_state(format: TextureFormat, is_written: bool) -> DepthStencilState {
    DepthStencilState {
        format,
        depth_write_enabled: Some(is_written),
        depth_compare: Some(CompareFunction::LessEqual),
        stencil: StencilState::default(),
        bias: DepthBiasState::default(),
    }
}

impl VertexLayout for SkinVertex {
    const ATTRIBUTES: &'static [VertexAttribute] = &vertex_attr_array![
        0 => Float32x3, 1 => Float32x3, 2 => Snorm16x4, 3 => Unorm8x4, 4 => Unorm8x4
    ];
    const STEP: VertexStepMode = VertexStepMode::Vertex;
}

impl VertexLayout for BoxVertex {
    const ATTRIBUTES: &'static [VertexAttribute] =
        &vertex_attr_array![0 => Float32x3, 1 => Unorm8x4, 2 => Unorm8x4];
    const STEP: VertexStepMode = VertexStepMode::Vertex;
}

impl VertexLayout for RoomVertex {
    const ATTRIBUTES: &'static [VertexAttribute] =
        &vertex_attr_array![0 => Float32x3, 1 => Float32x3];
    const STEP: VertexStepMode = VertexStepMode::Vertex;
}

impl VertexLayout for RoundedVertex {
    const ATTRIBUTES: &'static [VertexAttribute] =
        &vertex_attr_array![0 => Float32x3, 1 => Float32x3];
    const STEP: VertexStepMode = VertexStepMode::Vertex;
}

impl VertexLayout for RoundedInstance {
    const ATTRIBUTES: &'static [VertexAttribute] = &vertex_attr_array![
        2 => Float32x4, 3 => Float32x3, 4 => Float32x3, 5 => Float32x3,
        6 => Float32x3, 7 => Float32x4, 8 => Float32
    ];
    const STEP: VertexStepMode = VertexStepMode::Instance;
}
