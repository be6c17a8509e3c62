//! What the GPU is to do with each kind of vertex.

use crate::elements::ElementVertex;
use crate::rigid::{DotInstance, RigidInstance};
use crate::skin::SkinVertex;
use wgpu::*;

/// Colours and coverage of bodies.
pub const SKIN_FORMAT: TextureFormat = TextureFormat::Rgba8Unorm;
/// The same, blurred: eight bits would show as steps in the slope.
pub const SOFT_FORMAT: TextureFormat = TextureFormat::Rgba16Float;
/// What is wound around by a curve.
pub const STENCIL_FORMAT: TextureFormat = TextureFormat::Depth24PlusStencil8;
/// Samples of a pixel of the skin.
pub const SAMPLES: u32 = 4;

macro_rules! shader {
    ($($file:literal),*) => {
        concat!(include_str!("../shaders/globals.wgsl"), $(include_str!(concat!("../shaders/", $file))),*)
    };
}

/// All of them, and what they are bound to.
pub struct Pipelines {
    pub globals_layout: BindGroupLayout,
    pub blur_layout: BindGroupLayout,
    pub shape_layout: BindGroupLayout,
    pub body_layout: BindGroupLayout,
    /// Counts how often curves wind around a place.
    pub fan: RenderPipeline,
    /// Colours what is wound around.
    pub cover: RenderPipeline,
    /// Forgets what was wound around.
    pub wipe: RenderPipeline,
    /// Changes what is coloured along its edges.
    pub band: RenderPipeline,
    pub element: RenderPipeline,
    pub shrink: RenderPipeline,
    pub soften: RenderPipeline,
    /// Finds slopes and thickness where bodies are blurred.
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

/// Over what is there, colours being multiplied by their opacity.
const OVER: BlendState = BlendState::PREMULTIPLIED_ALPHA_BLENDING;
/// Over what is there, and only where something is.
const ONTO: BlendState = BlendState {
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
        let module = |label, text: &'static str| {
            device.create_shader_module(ShaderModuleDescriptor {
                label: Some(label),
                source: ShaderSource::Wgsl(text.into()),
            })
        };
        let skin = module("skin", shader!("skin.wgsl"));
        let blur = module("blur", shader!("blur.wgsl"));
        let shape = module("shape", shader!("shape.wgsl"));
        let body = module("body", shader!("light.wgsl", "body.wgsl"));
        let rigid = module("rigid", shader!("light.wgsl", "rigid.wgsl"));
        let stage = |extra: Option<&BindGroupLayout>, module, entries| Stage {
            layout: device.create_pipeline_layout(&PipelineLayoutDescriptor {
                label: None,
                bind_group_layouts: &[Some(&globals_layout), extra]
                    [..1 + usize::from(extra.is_some())],
                immediate_size: 0,
            }),
            device,
            module,
            entries,
        };
        let plain = |front, back| stencil(CompareFunction::Always, front, back);
        let (keep, zero) = (StencilOperation::Keep, StencilOperation::Zero);
        let (more, less) = (
            StencilOperation::IncrementWrap,
            StencilOperation::DecrementWrap,
        );
        let inside = |pass| stencil(CompareFunction::NotEqual, pass, pass);
        let skins = |entries, stencil, blend, mask| {
            stage(None, &skin, entries).build(&Target {
                buffers: &[Some(SkinVertex::layout())],
                topology: PrimitiveTopology::TriangleList,
                formats: &[SKIN_FORMAT; 2],
                stencil: Some(stencil),
                blend: Some(blend),
                mask,
            })
        };
        let (skin_entries, all, none) = (
            ("skin_corner", "skin"),
            ColorWrites::ALL,
            ColorWrites::empty(),
        );
        let blurs = |layout, module, entry| {
            stage(Some(layout), module, ("whole", entry)).build(&Target {
                buffers: &[],
                topology: PrimitiveTopology::TriangleList,
                formats: &[SOFT_FORMAT; 2],
                stencil: None,
                blend: None,
                mask: all,
            })
        };
        let shown = Target {
            buffers: &[],
            topology: PrimitiveTopology::TriangleList,
            formats: &[target],
            stencil: None,
            blend: Some(OVER),
            mask: all,
        };
        let shapes = |entries| {
            stage(None, &rigid, entries).build(&Target {
                buffers: &[Some(RigidInstance::layout())],
                topology: PrimitiveTopology::TriangleStrip,
                ..shown
            })
        };
        Self {
            fan: skins(skin_entries, plain(more, less), OVER, none),
            cover: skins(skin_entries, inside(keep), OVER, all),
            wipe: skins(skin_entries, inside(zero), OVER, none),
            band: skins(skin_entries, plain(keep, keep), ONTO, all),
            element: stage(None, &skin, ("element_corner", "element")).build(&Target {
                buffers: &[Some(ElementVertex::layout())],
                topology: PrimitiveTopology::TriangleList,
                formats: &[SKIN_FORMAT; 2],
                stencil: Some(plain(keep, keep)),
                blend: Some(OVER),
                mask: all,
            }),
            shrink: blurs(&blur_layout, &blur, "shrink"),
            soften: blurs(&blur_layout, &blur, "soften"),
            shape: blurs(&shape_layout, &shape, "shape"),
            arena: stage(Some(&body_layout), &body, ("whole", "arena")).build(&shown),
            body: stage(Some(&body_layout), &body, ("bounding", "body")).build(&Target {
                topology: PrimitiveTopology::TriangleStrip,
                ..shown
            }),
            shadow: shapes(("wide_corner", "shadow")),
            bar: shapes(("close_corner", "bar")),
            hand: shapes(("close_corner", "hand")),
            glow: shapes(("wide_corner", "glow")),
            border: shapes(("close_corner", "border")),
            particle: stage(None, &rigid, ("dot_corner", "particle")).build(&Target {
                buffers: &[Some(DotInstance::layout())],
                topology: PrimitiveTopology::TriangleStrip,
                ..shown
            }),
            globals_layout,
            blur_layout,
            shape_layout,
            body_layout,
        }
    }
}

/// Shaders of a pipeline and what they are bound to.
struct Stage<'a> {
    device: &'a Device,
    layout: PipelineLayout,
    module: &'a ShaderModule,
    entries: (&'a str, &'a str),
}

/// What a pipeline reads and writes.
#[derive(Copy, Clone)]
struct Target<'a> {
    buffers: &'a [Option<VertexBufferLayout<'a>>],
    topology: PrimitiveTopology,
    formats: &'a [TextureFormat],
    stencil: Option<Faces>,
    blend: Option<BlendState>,
    mask: ColorWrites,
}

/// For triangles that face us and for those that face away.
type Faces = [StencilFaceState; 2];

impl Stage<'_> {
    fn build(&self, target: &Target<'_>) -> RenderPipeline {
        let (vertex, fragment) = self.entries;
        let targets = target.formats.iter().map(|&format| {
            Some(ColorTargetState {
                format,
                blend: target.blend,
                write_mask: target.mask,
            })
        });
        let targets: Vec<Option<ColorTargetState>> = targets.collect();
        let depth_stencil = target.stencil.map(|[front, back]| DepthStencilState {
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
        });
        self.device
            .create_render_pipeline(&RenderPipelineDescriptor {
                label: Some(fragment),
                layout: Some(&self.layout),
                vertex: VertexState {
                    module: self.module,
                    entry_point: Some(vertex),
                    compilation_options: PipelineCompilationOptions::default(),
                    buffers: target.buffers,
                },
                primitive: PrimitiveState {
                    topology: target.topology,
                    ..PrimitiveState::default()
                },
                multisample: MultisampleState {
                    count: if target.stencil.is_some() { SAMPLES } else { 1 },
                    ..MultisampleState::default()
                },
                depth_stencil,
                fragment: Some(FragmentState {
                    module: self.module,
                    entry_point: Some(fragment),
                    compilation_options: PipelineCompilationOptions::default(),
                    targets: &targets,
                }),
                multiview_mask: None,
                cache: None,
            })
    }
}

/// Passes where the stencil compares to 0; what happens to it where triangles face us, or away.
fn stencil(compare: CompareFunction, front: StencilOperation, back: StencilOperation) -> Faces {
    [front, back].map(|pass_op| StencilFaceState {
        compare,
        fail_op: StencilOperation::Keep,
        depth_fail_op: StencilOperation::Keep,
        pass_op,
    })
}

fn layout(device: &Device, label: &str, entries: &[BindGroupLayoutEntry]) -> BindGroupLayout {
    device.create_bind_group_layout(&BindGroupLayoutDescriptor {
        label: Some(label),
        entries,
    })
}

fn entry(binding: u32, ty: BindingType) -> BindGroupLayoutEntry {
    BindGroupLayoutEntry {
        binding,
        visibility: ShaderStages::VERTEX_FRAGMENT,
        ty,
        count: None,
    }
}

fn uniform(binding: u32) -> BindGroupLayoutEntry {
    let ty = BindingType::Buffer {
        ty: BufferBindingType::Uniform,
        has_dynamic_offset: false,
        min_binding_size: None,
    };
    entry(binding, ty)
}

fn texture(binding: u32) -> BindGroupLayoutEntry {
    let ty = BindingType::Texture {
        sample_type: TextureSampleType::Float { filterable: true },
        view_dimension: TextureViewDimension::D2,
        multisampled: false,
    };
    entry(binding, ty)
}

fn sampler(binding: u32) -> BindGroupLayoutEntry {
    entry(binding, BindingType::Sampler(SamplerBindingType::Filtering))
}

/// How vertices lie in memory.
trait InMemory: Sized {
    const ATTRIBUTES: &'static [VertexAttribute];
    const STEP: VertexStepMode;

    fn layout() -> VertexBufferLayout<'static> {
        VertexBufferLayout {
            array_stride: size_of::<Self>() as u64,
            step_mode: Self::STEP,
            attributes: Self::ATTRIBUTES,
        }
    }
}

impl InMemory for SkinVertex {
    const ATTRIBUTES: &'static [VertexAttribute] =
        &vertex_attr_array![0 => Float32x2, 1 => Unorm8x4, 2 => Unorm8x4];
    const STEP: VertexStepMode = VertexStepMode::Vertex;
}

impl InMemory for ElementVertex {
    const ATTRIBUTES: &'static [VertexAttribute] =
        &vertex_attr_array![0 => Float32x2, 1 => Float32x2, 2 => Float32x2, 3 => Unorm8x4];
    const STEP: VertexStepMode = VertexStepMode::Vertex;
}

impl InMemory for RigidInstance {
    const ATTRIBUTES: &'static [VertexAttribute] =
        &vertex_attr_array![0 => Float32x4, 1 => Float32x3, 2 => Float32x3];
    const STEP: VertexStepMode = VertexStepMode::Instance;
}

impl InMemory for DotInstance {
    const ATTRIBUTES: &'static [VertexAttribute] =
        &vertex_attr_array![0 => Float32x2, 1 => Float32, 2 => Float32x4];
    const STEP: VertexStepMode = VertexStepMode::Instance;
}
