//! 2D drawing on the GPU: passes into intermediate images, then the window's pass.

pub(crate) mod buffer;
pub(crate) mod cost;
pub(crate) mod image;
mod pipelines;
pub(crate) mod program;
pub(crate) mod targets;

use crate::frame::{Camera, Frame, Look};
use crate::geometry::Geometry;
use buffer::{GrowingBuffer, drawable};
use bytemuck::{Pod, Zeroable};
use cost::{Cost, Gpu, Meter};
use fuwafuwa::{Dim2, World};
use glam::Vec2;
use pipelines::Pipelines;
use std::ops::Range;
use targets::{NARROW, REACH, Targets, bind, clear, new_uniforms};
use wgpu::*;

/// Standard deviation of the wide blur, which makes a body look thick, as a multiple of the radius of the
/// largest body. Smaller values make balls look flat; larger values make all pieces look flat.
const THICKNESS: f32 = 0.30;
/// Standard deviation of the narrow blur, which rounds the edges of every piece, as a multiple of the radius
/// of the largest body.
const EDGE: f32 = 0.038;

/// Draws 2D worlds.
pub struct Renderer {
    format: TextureFormat,
    pipelines: Pipelines,
    targets: Targets,
    geometry: Geometry,
    uniforms: Buffer,
    globals: BindGroup,
    /// Region covered by bodies, blurs included: low and high corner as fractions of the picture from its
    /// upper left corner. `None` if no body is visible.
    covered: Option<[[f32; 2]; 2]>,
    skin_vertices: GrowingBuffer,
    fans: GrowingBuffer,
    bands: GrowingBuffer,
    element_vertices: GrowingBuffer,
    element_indices: GrowingBuffer,
    shapes: GrowingBuffer,
    dots: GrowingBuffer,
    meter: Meter,
}

/// Uniforms of every shader; see `globals.wgsl`.
#[repr(C)]
#[derive(Copy, Clone, Debug, Pod, Zeroable)]
struct Globals {
    axes: [f32; 4],
    view: [f32; 4],
    size: [f32; 4],
    tune: [f32; 4],
    scale: [f32; 4],
    floor_middle: [f32; 4],
    floor_rim: [f32; 4],
    frame: [f32; 4],
    fresh: [f32; 4],
    bounds: [f32; 4],
    walls: [[f32; 4]; crate::rigid::MAX_WALLS],
}

impl Renderer {
    /// Creates a renderer for passes with a single colour target, without depth and multisampling. Prefer
    /// formats without the suffix `Srgb`, as egui does.
    pub fn new(device: &Device, target_format: TextureFormat) -> Self {
        let pipelines = Pipelines::new(device, target_format);
        let uniforms = new_uniforms(device, "globals", size_of::<Globals>() as u64);
        let resource = uniforms.as_entire_binding();
        let (vertex, index) = (BufferUsages::VERTEX, BufferUsages::INDEX);
        let buffer = |label, usage| GrowingBuffer::new(device, label, usage);
        Self {
            format: target_format,
            globals: bind(device, &pipelines.globals_layout, &[resource]),
            targets: Targets::new(device, &pipelines, [1, 1]),
            geometry: Geometry::default(),
            covered: None,
            skin_vertices: buffer("skin", vertex),
            fans: buffer("fans", index),
            bands: buffer("bands", index),
            element_vertices: buffer("elements", vertex),
            element_indices: buffer("element indices", index),
            shapes: buffer("shapes", vertex),
            dots: buffer("dots", vertex),
            meter: Meter::default(),
            pipelines,
            uniforms,
        }
    }

    /// Prepares a picture of a world for a target of `target_size` pixels: computes and uploads its vertices
    /// and draws the bodies into intermediate images.
    pub fn prepare(
        &mut self,
        device: &Device,
        queue: &Queue,
        encoder: &mut CommandEncoder,
        world: &World<Dim2>,
        frame: &Frame<'_>,
        target_size: [u32; 2],
    ) {
        if self.targets.window != target_size.map(|side| side.max(1)) {
            self.targets = Targets::new(device, &self.pipelines, target_size);
        }
        self.geometry.gather(world, frame);
        self.covered = self.covered(&frame.camera, target_size);
        self.upload(device, queue, frame);
        self.draw_bodies(encoder);
        self.blur(encoder);
    }

    /// Paints the prepared picture into a pass, filling its viewport.
    pub fn paint(&self, pass: &mut RenderPass<'static>) {
        self.paint_bodies(pass);
        self.paint_rigid(pass);
    }

    /// Releases the intermediate images, which are as large as the last picture. The next picture creates new
    /// ones.
    pub fn release_images(&mut self, device: &Device) {
        self.targets = Targets::new(device, &self.pipelines, [1, 1]);
    }

    /// First half of [`Renderer::paint`]: floor, basket and bodies. Callers may paint on the bodies
    /// afterwards.
    pub fn paint_bodies(&self, pass: &mut RenderPass<'static>) {
        let (pipelines, [_, _, basket]) = (&self.pipelines, self.kinds());
        pass.set_bind_group(0, &self.globals, &[]);
        pass.set_bind_group(1, &self.targets.body, &[]);
        pass.set_vertex_buffer(0, self.shapes.all());
        pass.set_pipeline(&pipelines.arena);
        self.meter.draw(pass, 0..3, 0..1);
        pass.set_pipeline(&pipelines.glow);
        self.meter.draw(pass, 0..4, basket.clone());
        if self.covered.is_some() {
            pass.set_pipeline(&pipelines.body);
            self.meter.draw(pass, 0..4, 0..1);
        }
        pass.set_pipeline(&pipelines.border);
        self.meter.draw(pass, 0..4, basket);
    }

    /// Second half of [`Renderer::paint`]: bars, hands and particles, which are in front of the bodies.
    pub fn paint_rigid(&self, pass: &mut RenderPass<'static>) {
        let (pipelines, [bars, hands, _]) = (&self.pipelines, self.kinds());
        pass.set_bind_group(0, &self.globals, &[]);
        pass.set_vertex_buffer(0, self.shapes.all());
        for (pipeline, shapes) in [
            (&pipelines.shadow, 0..hands.end),
            (&pipelines.bar, bars),
            (&pipelines.hand, hands),
        ] {
            pass.set_pipeline(pipeline);
            self.meter.draw(pass, 0..4, shapes);
        }
        pass.set_vertex_buffer(0, self.dots.all());
        pass.set_pipeline(&pipelines.particle);
        self.meter.draw(pass, 0..4, 0..self.dots.count());
    }

    /// Returns the GPU cost of all pictures since the last call.
    pub fn take_cost(&self) -> Cost {
        self.meter.take()
    }

    /// Returns the instance ranges of bars, hands and basket, limited to the instances in the buffer.
    fn kinds(&self) -> [Range<u32>; 3] {
        let (rigid, there) = (&self.geometry.rigid, self.shapes.count());
        let bars = 0..rigid.bar_count.min(there);
        let hands = bars.end..(bars.end + rigid.hand_count).min(there);
        let basket = hands.end..there;
        [bars, hands, basket]
    }

    fn covered(&self, camera: &Camera, target_size: [u32; 2]) -> Option<[[f32; 2]; 2]> {
        let [low, high] = self.geometry.bounds;
        if low.x > high.x {
            return None;
        }
        let corners = [
            low,
            Vec2::new(high.x, low.y),
            high,
            Vec2::new(low.x, high.y),
        ];
        let pixels = corners.map(|at| camera.to_pixel(at, target_size));
        let reach = REACH * THICKNESS * self.geometry.radius / camera.height;
        let share = |axis: usize| {
            let side = target_size[axis].max(1) as f32;
            let reach = reach * target_size[1] as f32 / side + 2.0 / side;
            let shares = pixels.map(|pixel| pixel[axis] / side);
            let least = shares.into_iter().fold(f32::MAX, f32::min) - reach;
            let most = shares.into_iter().fold(f32::MIN, f32::max) + reach;
            [least.clamp(0.0, 1.0), most.clamp(0.0, 1.0)]
        };
        let ([left, right], [top, bottom]) = (share(0), share(1));
        (left < right && top < bottom).then_some([[left, top], [right, bottom]])
    }

    fn upload(&mut self, device: &Device, queue: &Queue, frame: &Frame<'_>) {
        let Geometry {
            skin,
            elements,
            rigid,
            radius,
            bounds,
            ..
        } = &self.geometry;
        let gpu = Gpu {
            device,
            queue,
            meter: &self.meter,
        };
        self.skin_vertices.write(gpu, &skin.vertices);
        let there = self.skin_vertices.count();
        let fans = drawable(&skin.fans, &skin.vertices, there);
        let bands = drawable(&skin.bands, &skin.vertices, there);
        self.fans.write(gpu, fans);
        self.bands.write(gpu, bands);
        self.element_vertices.write(gpu, &elements.vertices);
        let there = self.element_vertices.count();
        let indices = drawable(&elements.indices, &elements.vertices, there);
        self.element_indices.write(gpu, indices);
        self.shapes.write(gpu, &rigid.shapes);
        self.dots.write(gpu, &rigid.dots);

        let camera = &frame.camera;
        let [right, up] = camera.axes();
        let middle = camera.middle();
        let [window, size] =
            [self.targets.window, self.targets.size].map(|size| size.map(|side| side as f32));
        let (edge, thickness) = (EDGE * radius, THICKNESS * radius);
        let pixels = size[1] / camera.height;
        self.targets
            .set_blur(gpu, edge * pixels, thickness * pixels);
        let mut walls = [[0.0; 4]; crate::rigid::MAX_WALLS];
        walls[..rigid.walls.len()].copy_from_slice(&rigid.walls);
        let flag = |is: bool| f32::from(u8::from(is));
        let colour = |[red, green, blue]: crate::palette::Colour| [red, green, blue, 1.0];
        let palette = frame.palette;
        let globals = Globals {
            axes: [right.x, right.y, up.x, up.y],
            view: [middle.x, middle.y, camera.height, window[0] / window[1]],
            size: [size[0], size[1], window[0], window[1]],
            tune: [
                frame.phase(),
                rigid.walls.len() as f32,
                flag(self.format.is_srgb()),
                flag(frame.look == Look::Skin),
            ],
            scale: [*radius, edge, thickness, 0.0],
            floor_middle: colour(palette.floor[0]),
            floor_rim: colour(palette.floor[1]),
            frame: colour(palette.frame),
            fresh: colour(palette.fresh),
            bounds: {
                // Antialiased edges extend half a pixel beyond the vertices.
                let margin = 2.0 * camera.height / size[1];
                let [low, high] = [bounds[0] - margin, bounds[1] + margin];
                [low.x, low.y, high.x, high.y]
            },
            walls,
        };
        gpu.meter
            .write(queue, &self.uniforms, 0, bytemuck::bytes_of(&globals));
    }

    fn draw_bodies(&self, encoder: &mut CommandEncoder) {
        let (pipelines, targets) = (&self.pipelines, &self.targets);
        let attachments = [0, 1].map(|k| clear(&targets.multisampled[k], Some(&targets.skin[k])));
        let mut pass = encoder.begin_render_pass(&RenderPassDescriptor {
            label: Some("bodies"),
            color_attachments: &attachments,
            depth_stencil_attachment: Some(RenderPassDepthStencilAttachment {
                view: &targets.stencil,
                depth_ops: Some(Operations {
                    load: LoadOp::Clear(1.0),
                    store: StoreOp::Discard,
                }),
                stencil_ops: Some(Operations {
                    load: LoadOp::Clear(0),
                    store: StoreOp::Discard,
                }),
            }),
            ..RenderPassDescriptor::default()
        });
        pass.set_bind_group(0, &self.globals, &[]);
        pass.set_vertex_buffer(0, self.skin_vertices.all());
        pass.set_index_buffer(self.fans.all(), IndexFormat::Uint32);
        for body in &self.geometry.bodies {
            let whole = body.cover.start..body.cover.start + 6;
            let steps = [
                (&pipelines.fan, body.fan.clone()),
                (&pipelines.cover, body.cover.clone()),
                (&pipelines.wipe, whole),
            ];
            for (pipeline, Range { start, end }) in steps {
                let there = self.fans.count();
                pass.set_pipeline(pipeline);
                self.meter
                    .draw_indexed(&mut pass, start.min(there)..end.min(there), 0..1);
            }
        }
        pass.set_pipeline(&pipelines.band);
        pass.set_index_buffer(self.bands.all(), IndexFormat::Uint32);
        self.meter
            .draw_indexed(&mut pass, 0..self.bands.count(), 0..1);
        pass.set_pipeline(&pipelines.element);
        pass.set_vertex_buffer(0, self.element_vertices.all());
        pass.set_index_buffer(self.element_indices.all(), IndexFormat::Uint32);
        self.meter
            .draw_indexed(&mut pass, 0..self.element_indices.count(), 0..1);
    }

    fn blur(&self, encoder: &mut CommandEncoder) {
        let (pipelines, targets) = (&self.pipelines, &self.targets);
        let mut step = |pipeline, from, into: &[TextureView; 2], divisor| {
            let attachments = into.each_ref().map(|view| clear(view, None));
            let mut pass = encoder.begin_render_pass(&RenderPassDescriptor {
                label: Some("blur"),
                color_attachments: &attachments,
                ..RenderPassDescriptor::default()
            });
            let Some([low, high]) = self.covered else {
                return;
            };
            let side = |axis: usize| {
                let side = targets.size[axis].div_ceil(divisor);
                let first = (low[axis] * side as f32) as u32;
                let end = ((high[axis] * side as f32).ceil() as u32).min(side);
                (first, end.saturating_sub(first))
            };
            let ((x, width), (y, height)) = (side(0), side(1));
            pass.set_scissor_rect(x, y, width, height);
            pass.set_pipeline(pipeline);
            pass.set_bind_group(0, &self.globals, &[]);
            pass.set_bind_group(1, from, &[]);
            self.meter.draw(&mut pass, 0..3, 0..1);
        };
        let (shrink, soften) = (&pipelines.shrink, &pipelines.soften);
        let doing = [shrink, soften, soften, shrink, soften, soften];
        for (k, (into, divisor)) in targets.drawn_into().into_iter().enumerate() {
            step(doing[k], &targets.steps[k], into, divisor);
        }
        step(&pipelines.shape, &targets.shape, &targets.narrow[1], NARROW);
    }
}
