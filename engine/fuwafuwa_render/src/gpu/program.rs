//! Building blocks of render pipelines.

use wgpu::*;

/// Concatenates shader sources from `src/shaders`.
macro_rules! wgsl {
    ($($file:literal),*) => {
        concat!($(include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/src/shaders/", $file))),*)
    };
}
pub(crate) use wgsl;

/// Multisampling of the images that bodies are drawn into [samples per pixel].
pub const SAMPLES: u32 = 4;
/// Blends premultiplied colours over the target.
pub const OVER: BlendState = BlendState::PREMULTIPLIED_ALPHA_BLENDING;

/// Shader entry points and layout of a pipeline. Without colour targets the fragment entry point is ignored.
pub struct Program<'a> {
    device: &'a Device,
    layout: PipelineLayout,
    module: &'a ShaderModule,
    entries: (&'a str, &'a str),
}

/// Inputs and outputs of a pipeline.
#[derive(Clone)]
pub struct Target<'a> {
    pub buffers: &'a [Option<VertexBufferLayout<'a>>],
    pub topology: PrimitiveTopology,
    pub formats: &'a [TextureFormat],
    pub depth: Option<DepthStencilState>,
    pub cull: Option<Face>,
    pub samples: u32,
    pub blend: Option<BlendState>,
    pub mask: ColorWrites,
}

impl<'a> Target<'a> {
    /// Returns pipeline settings for plain triangles drawn into textures of these formats: no vertex buffers,
    /// no depth, no blending, one sample per pixel.
    pub fn of(formats: &'a [TextureFormat]) -> Self {
        Self {
            buffers: &[],
            topology: PrimitiveTopology::TriangleList,
            formats,
            depth: None,
            cull: None,
            samples: 1,
            blend: None,
            mask: ColorWrites::ALL,
        }
    }
}

impl<'a> Program<'a> {
    /// Creates a program that binds the globals and optionally one more bind group.
    pub fn new(
        device: &'a Device,
        globals: &BindGroupLayout,
        extra: Option<&BindGroupLayout>,
        module: &'a ShaderModule,
        entries: (&'a str, &'a str),
    ) -> Self {
        let layout = device.create_pipeline_layout(&PipelineLayoutDescriptor {
            label: None,
            bind_group_layouts: &[Some(globals), extra][..1 + usize::from(extra.is_some())],
            immediate_size: 0,
        });
        Self {
            device,
            layout,
            module,
            entries,
        }
    }

    pub fn build(&self, target: &Target<'_>) -> RenderPipeline {
        let (vertex, fragment) = self.entries;
        let targets = target.formats.iter().map(|&format| {
            Some(ColorTargetState {
                format,
                blend: target.blend,
                write_mask: target.mask,
            })
        });
        let targets: Vec<Option<ColorTargetState>> = targets.collect();
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
                    cull_mode: target.cull,
                    ..PrimitiveState::default()
                },
                multisample: MultisampleState {
                    count: target.samples,
                    ..MultisampleState::default()
                },
                depth_stencil: target.depth.clone(),
                fragment: (!targets.is_empty()).then(|| FragmentState {
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

pub fn layout(device: &Device, label: &str, entries: &[BindGroupLayoutEntry]) -> BindGroupLayout {
    device.create_bind_group_layout(&BindGroupLayoutDescriptor {
        label: Some(label),
        entries,
    })
}

pub fn entry(binding: u32, ty: BindingType) -> BindGroupLayoutEntry {
    BindGroupLayoutEntry {
        binding,
        visibility: ShaderStages::VERTEX_FRAGMENT,
        ty,
        count: None,
    }
}

pub fn uniform(binding: u32) -> BindGroupLayoutEntry {
    let ty = BindingType::Buffer {
        ty: BufferBindingType::Uniform,
        has_dynamic_offset: false,
        min_binding_size: None,
    };
    entry(binding, ty)
}

pub fn texture(binding: u32) -> BindGroupLayoutEntry {
    let ty = BindingType::Texture {
        sample_type: TextureSampleType::Float { filterable: true },
        view_dimension: TextureViewDimension::D2,
        multisampled: false,
    };
    entry(binding, ty)
}

pub fn sampler(binding: u32) -> BindGroupLayoutEntry {
    entry(binding, BindingType::Sampler(SamplerBindingType::Filtering))
}

pub fn module(device: &Device, label: &str, text: &'static str) -> ShaderModule {
    device.create_shader_module(ShaderModuleDescriptor {
        label: Some(label),
        source: ShaderSource::Wgsl(text.into()),
    })
}

/// Memory layout of vertices and instances.
pub trait VertexLayout: Sized {
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
