//! Render pipelines for each kind of 2D vertex.

use super::program::{
    OVER, Program, SAMPLES, Target, VertexLayout, layout, module, sampler, texture, uniform, wgsl,
};
use crate::elements::ElementVertex;
use crate::rigid::{DotInstance, RigidInstance};
use crate::skin::SkinVertex;
use wgpu::*;

/// Format of the two images that bodies are drawn into: colour with coverage, and relief (thickness,
/// freshness of torn surfaces, strain).
pub const SKIN_FORMAT: TextureFormat = TextureFormat::Rgba8Unorm;
/// Format of the blurred body images. With eight bits per channel, slopes would show steps.
pub const SOFT_FORMAT: TextureFormat = TextureFormat::Rgba16Float;
/// Format of the stencil that counts windings.
pub const STENCIL_FORMAT: TextureFormat = TextureFormat::Depth24PlusStencil8;

/// All render pipelines and their bind group layouts.
pub struct Pipelines {
    pub globals_layout: BindGroupLayout,
    pub blur_layout: BindGroupLayout,
    pub shape_layout: BindGroupLayout,
    pub body_layout: BindGroupLayout,
    /// Counts in the stencil how often the outlines wind around each pixel.
    pub fan: RenderPipeline,
    /// Colours pixels with a non-zero winding number.
    pub cover: RenderPipeline,
    /// Resets the stencil to 0.
    pub wipe: RenderPipeline,
    /// Blends the bands along the outlines into the body images, only where a body covers the pixel.
    pub band: RenderPipeline,
    pub element: RenderPipeline,
    pub shrink: RenderPipeline,
    pub soften: RenderPipeline,
    /// Computes slopes and thickness from the blurred bodies.
    pub shape: RenderPipeline,
    pub arena: RenderPipeline,
    pub body: RenderPipeline,
    pub shadow: RenderPipeline,
    pub bar: RenderPipeline,
    pub hand: RenderPipeline,
    pub glow: RenderPipeline,
    pub border: RenderPipeline,
    pub particle: RenderPipeline,
}

/// Blends over the target, only where the target is covered.
const BLEND_ATOP: BlendState = BlendState {
    color: BlendComponent {
        src_factor: BlendFactor::DstAlpha,
        dst_factor: BlendFactor::OneMinusSrcAlpha,
        operation: BlendOperation::Add,
    },
    alpha: BlendComponent {
        src_factor: BlendFactor::Zero,
        dst_factor: BlendFactor::One,
        operation: BlendOperation::Add,
    },
};

impl Pipelines {
    pub fn new(device: &Device, target: TextureFormat) -> Self {
        let globals_layout = layout(device, "globals", &[uniform(0)]);
        let blur_layout = layout(
            device,
            "blur",
            &[texture(0), texture(1), sampler(2), uniform(3)],
        );
        let images = |count| {
            let images: Vec<BindGroupLayoutEntry> =
                (0..count).map(texture).chain([sampler(count)]).collect();
            layout(device, "images", &images)
        };
        let (shape_layout, body_layout) = (images(4), images(6));
        let skin = module(device, "skin", wgsl!("globals.wgsl", "skin.wgsl"));
        let blur = module(
            device,
            "blur",
            wgsl!("globals.wgsl", "whole.wgsl", "blur.wgsl"),
        );
        let shape = module(
            device,
            "shape",
            wgsl!("globals.wgsl", "whole.wgsl", "shape.wgsl"),
        );
        let body = module(
            device,
            "body",
            wgsl!("globals.wgsl", "whole.wgsl", "light.wgsl", "body.wgsl"),
        );
        let rigid = module(
            device,
            "rigid",
            wgsl!("globals.wgsl", "light.wgsl", "rigid.wgsl"),
        );
        let program =
            |extra, module, entries| Program::new(device, &globals_layout, extra, module, entries);
        let plain = |front, back| stencil(CompareFunction::Always, front, back);
        let (keep, zero) = (StencilOperation::Keep, StencilOperation::Zero);
        let (more, less) = (
            StencilOperation::IncrementWrap,
            StencilOperation::DecrementWrap,
        );
        let inside = |pass| stencil(CompareFunction::NotEqual, pass, pass);
        let skins = |entries, stencil, blend, mask| {
            program(None, &skin, entries).build(&Target {
                buffers: &[Some(SkinVertex::layout())],
                depth: Some(stencil),
                samples: SAMPLES,
                blend: Some(blend),
                mask,
                ..Target::of(&[SKIN_FORMAT; 2])
            })
        };
        let (skin_entries, all, none) = (
            ("skin_corner", "skin"),
            ColorWrites::ALL,
            ColorWrites::empty(),
        );
        let blurs = |layout, module, entry| {
            program(Some(layout), module, ("whole", entry)).build(&Target::of(&[SOFT_FORMAT; 2]))
        };
        let formats = [target];
        let shown = Target {
            blend: Some(OVER),
            ..Target::of(&formats)
        };
        let shapes = |entries| {
            program(None, &rigid, entries).build(&Target {
                buffers: &[Some(RigidInstance::layout())],
                topology: PrimitiveTopology::TriangleStrip,
                ..shown.clone()
            })
        };
        Self {
            fan: skins(skin_entries, plain(more, less), OVER, none),
            cover: skins(skin_entries, inside(keep), OVER, all),
            wipe: skins(skin_entries, inside(zero), OVER, none),
            band: skins(skin_entries, plain(keep, keep), BLEND_ATOP, all),
            element: program(None, &skin, ("element_corner", "element")).build(&Target {
                buffers: &[Some(ElementVertex::layout())],
                depth: Some(plain(keep, keep)),
                samples: SAMPLES,
                blend: Some(OVER),
                ..Target::of(&[SKIN_FORMAT; 2])
            }),
            shrink: blurs(&blur_layout, &blur, "shrink"),
            soften: blurs(&blur_layout, &blur, "soften"),
            shape: blurs(&shape_layout, &shape, "shape"),
            arena: program(Some(&body_layout), &body, ("placed", "arena")).build(&shown),
            body: program(Some(&body_layout), &body, ("bounding", "body")).build(&Target {
                topology: PrimitiveTopology::TriangleStrip,
                ..shown.clone()
            }),
            shadow: shapes(("wide_corner", "shadow")),
            bar: shapes(("close_corner", "bar")),
            hand: shapes(("close_corner", "hand")),
            glow: shapes(("wide_corner", "glow")),
            border: shapes(("close_corner", "border")),
            particle: program(None, &rigid, ("dot_corner", "particle")).build(&Target {
                buffers: &[Some(DotInstance::layout())],
                topology: PrimitiveTopology::TriangleStrip,
                ..shown.clone()
            }),
            globals_layout,
            blur_layout,
            shape_layout,
            body_layout,
        }
    }
}

/// Returns a stencil state that compares with 0 and applies an operation to front-facing and to back-facing
/// triangles.
fn stencil(
    compare: CompareFunction,
    front: StencilOperation,
    back: StencilOperation,
) -> DepthStencilState {
    let [front, back] = [front, back].map(|pass_op| StencilFaceState {
        compare,
        fail_op: StencilOperation::Keep,
        depth_fail_op: StencilOperation::Keep,
        pass_op,
    });
    DepthStencilState {
        format: STENCIL_FORMAT,
        depth_write_enabled: Some(false),
        depth_compare: Some(CompareFunction::Always),
        stencil: StencilState {
            front,
            back,
            read_mask: 0xff,
            write_mask: 0xff,
        },
        bias: DepthBiasState::default(),
    }
}

impl VertexLayout for SkinVertex {
    const ATTRIBUTES: &'static [VertexAttribute] =
        &vertex_attr_array![0 => Float32x2, 1 => Unorm8x4, 2 => Unorm8x4];
    const STEP: VertexStepMode = VertexStepMode::Vertex;
}

impl VertexLayout for ElementVertex {
    const ATTRIBUTES: &'static [VertexAttribute] =
        &vertex_attr_array![0 => Float32x2, 1 => Float32x2, 2 => Float32x2, 3 => Unorm8x4];
    const STEP: VertexStepMode = VertexStepMode::Vertex;
}

impl VertexLayout for RigidInstance {
    const ATTRIBUTES: &'static [VertexAttribute] =
        &vertex_attr_array![0 => Float32x4, 1 => Float32x3, 2 => Float32x3];
    const STEP: VertexStepMode = VertexStepMode::Instance;
}

impl VertexLayout for DotInstance {
    const ATTRIBUTES: &'static [VertexAttribute] =
        &vertex_attr_array![0 => Float32x2, 1 => Float32, 2 => Float32x4];
    const STEP: VertexStepMode = VertexStepMode::Instance;
}
