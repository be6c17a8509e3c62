//! 3D drawing on the GPU: the shadow and sky maps, the picture, then the window's pass.

mod meshes;
mod pipelines;
mod targets;

use super::camera::{Camera, seen_from};
use super::geometry::Geometry;
use super::rounded;
use crate::frame::Frame;
use crate::gpu::buffer::GrowingBuffer;
use crate::gpu::cost::{Cost, Gpu, Meter};
use crate::gpu::image::{ImageError, ImageStage, image};
use crate::gpu::targets::{bind, clear, new_uniforms};
use crate::palette::Colour;
use crate::rigid::MAX_WALLS;
use bytemuck::{Pod, Zeroable};
use fuwafuwa::{Dim3, World};
use glam::{Mat3, Mat4, Vec3};
use meshes::{draw_mesh, mesh_buffers, write_mesh, write_skins};
use pipelines::Pipelines;
use std::ops::Range;
use targets::{SHADOW_SIDES, Shadows, Targets};
use wgpu::*;

/// Direction towards the light; equals `LIGHT` in `space.wgsl`.
const LIGHT: Vec3 = Vec3::new(-0.42, 0.80, 0.45);
/// Direction towards the sky.
const SKY: Vec3 = Vec3::Y;
/// Half extent of the region covered by the shadow maps, in multiples of the camera distance.
const LIT: f32 = 0.55;
/// Blur width of light and sky shadows, as fractions of their maps. Larger values make shadows softer, until
/// single samples show as steps.
const SOFTNESS: [f32; 2] = [0.006, 0.035];
/// Maximum number of hands that cast shadows, limited by the size of uniform buffers on small devices.
const MOST_HANDS: usize = 4;
/// Number of quads along each edge of an octant of a ball mesh that may be drawn large; `COARSE` is the
/// number for small balls.
const FINE: usize = 12;
const COARSE: usize = 3;

/// Draws 3D worlds.
pub struct Renderer {
    format: TextureFormat,
    pipelines: Pipelines,
    targets: Targets,
    shadows: Shadows,
    geometry: Geometry,
    /// Uniforms of the picture and of both shadow maps.
    uniforms: [Buffer; 3],
    globals: [BindGroup; 3],
    /// Vertices and triangles of each body.
    skins: Vec<[GrowingBuffer; 2]>,
    ghosts: Vec<[GrowingBuffer; 2]>,
    boxes: [GrowingBuffer; 2],
    stickers: [GrowingBuffer; 2],
    room: GrowingBuffer,
    rounded: GrowingBuffer,
    fine: [GrowingBuffer; 2],
    coarse: [GrowingBuffer; 2],
    meter: Meter,
}

/// Uniforms of every shader; see `space.wgsl`.
#[repr(C)]
#[derive(Copy, Clone, Debug, Pod, Zeroable)]
struct Globals {
    to_clip: Mat4,
    to_light: Mat4,
    to_sky: Mat4,
    eye: [f32; 4],
    look: [f32; 4],
    tune: [f32; 4],
    size: [f32; 4],
    soft: [f32; 4],
    floor_middle: [f32; 4],
    floor_rim: [f32; 4],
    frame: [f32; 4],
    fresh: [f32; 4],
    hands: [[f32; 4]; MOST_HANDS],
    hand_colours: [[f32; 4]; MOST_HANDS],
    walls: [[f32; 4]; MAX_WALLS],
}

impl Renderer {
    /// Creates a renderer for passes with a single colour target, without depth and multisampling. Formats
    /// without `Srgb`, as egui uses them, are preferred.
    pub fn new(device: &Device, target_format: TextureFormat) -> Self {
        let pipelines = Pipelines::new(device, target_format);
        let uniforms =
            [0, 1, 2].map(|_| new_uniforms(device, "globals", size_of::<Globals>() as u64));
        let globals = uniforms.each_ref().map(|buffer| {
            let resource = buffer.as_entire_binding();
            bind(device, &pipelines.globals_layout, &[resource])
        });
        Self {
            format: target_format,
            targets: Targets::new(device, &pipelines, [1, 1]),
            shadows: Shadows::new(device, &pipelines),
            geometry: Geometry::default(),
            uniforms,
            globals,
            skins: Vec::new(),
            ghosts: Vec::new(),
            boxes: mesh_buffers(device, "boxes"),
            stickers: mesh_buffers(device, "stickers"),
            room: GrowingBuffer::new(device, "room", BufferUsages::VERTEX),
            rounded: GrowingBuffer::new(device, "rounded", BufferUsages::VERTEX),
            fine: mesh_buffers(device, "fine balls"),
            coarse: mesh_buffers(device, "coarse balls"),
            meter: Meter::default(),
            pipelines,
        }
    }

    /// Prepares a picture of a world for a target of `target_size` pixels: computes and uploads its vertices
    /// and draws it into an intermediate image.
    pub fn prepare(
        &mut self,
        device: &Device,
        queue: &Queue,
        encoder: &mut CommandEncoder,
        world: &World<Dim3>,
        frame: &Frame<'_, Camera>,
        target_size: [u32; 2],
    ) {
        if self.targets.window != target_size.map(|side| side.max(1)) {
            self.targets = Targets::new(device, &self.pipelines, target_size);
        }
        self.geometry.gather(world, frame);
        self.upload(device, queue);
        self.write_uniforms(queue, frame);
        self.draw_shadows(encoder);
        self.draw_picture(encoder);
    }

    /// Paints the prepared picture into a pass, filling its viewport.
    pub fn paint(&self, pass: &mut RenderPass<'static>) {
        pass.set_pipeline(&self.pipelines.window);
        pass.set_bind_group(0, &self.globals[0], &[]);
        pass.set_bind_group(1, &self.targets.shown, &[]);
        self.meter.draw(pass, 0..3, 0..1);
    }

    /// Releases the intermediate images, like [`crate::Renderer::release_images`].
    pub fn release_images(&mut self, device: &Device) {
        self.targets = Targets::new(device, &self.pipelines, [1, 1]);
    }

    /// Returns the GPU cost since the last call, like [`crate::Renderer::take_cost`].
    pub fn take_cost(&self) -> Cost {
        self.meter.take()
    }

    /// Draws a world into an image, like the 2D renderer's [`crate::Renderer::render_to_image`].
    ///
    /// # Errors
    /// Same errors as [`crate::Renderer::render_to_image`].
    pub fn render_to_image(
        &mut self,
        device: &Device,
        queue: &Queue,
        world: &World<Dim3>,
        frame: &Frame<'_, Camera>,
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

    fn upload(&mut self, device: &Device, queue: &Queue) {
        let Geometry {
            boxes,
            stickers,
            room,
            rounded,
            ..
        } = &self.geometry;
        let gpu = Gpu {
            device,
            queue,
            meter: &self.meter,
        };
        let (skins, renewed) = (&self.geometry.skins, &self.geometry.renewed);
        write_skins(gpu, &mut self.skins, skins, renewed);
        let (skins, renewed) = (&self.geometry.ghosts, &self.geometry.renewed_ghosts);
        write_skins(gpu, &mut self.ghosts, skins, renewed);
        let (vertices, indices) = (&boxes.vertices, &boxes.indices);
        write_mesh(gpu, &mut self.boxes, vertices, indices);
        let (vertices, indices) = (&stickers.vertices, &stickers.indices);
        write_mesh(gpu, &mut self.stickers, vertices, indices);
        self.room.write(gpu, room);
        self.rounded.write(gpu, rounded);
        for (buffers, fineness) in [(&mut self.fine, FINE), (&mut self.coarse, COARSE)] {
            if buffers[0].count() == 0 {
                let (vertices, indices) = rounded::mesh(fineness);
                write_mesh(gpu, buffers, &vertices, &indices);
            }
        }
    }

    fn write_uniforms(&self, queue: &Queue, frame: &Frame<'_, Camera>) {
        let (camera, palette, size) = (&frame.camera, frame.palette, self.targets.size);
        let half = LIT * camera.distance;
        let [to_light, to_sky] = [LIGHT, SKY].map(|light| seen_by(light, camera.target, half));
        let texels = SHADOW_SIDES.map(|side| 2.0 * half / side as f32);
        let four = |[red, green, blue]: Colour, last: f32| [red, green, blue, last];
        let mut walls = [[0.0; 4]; MAX_WALLS];
        walls[..self.geometry.walls.len()].copy_from_slice(&self.geometry.walls);
        let (mut hands, mut hand_colours) = ([[0.0; 4]; MOST_HANDS], [[0.0; 4]; MOST_HANDS]);
        let range = |range: &Range<u32>| range.start as usize..range.end as usize;
        let balls = &self.geometry.rounded[range(&self.geometry.hands)];
        for (place, ball) in balls.iter().take(MOST_HANDS).enumerate() {
            hands[place] = ball.centre.extend(ball.radius).into();
            hand_colours[place] = ball.colour;
        }
        let hand_count = balls.len().min(MOST_HANDS) as f32;
        let mut globals = Globals {
            to_clip: camera.to_clip(size),
            to_light,
            to_sky,
            eye: camera.eye().extend(0.0).into(),
            look: camera.target.extend(camera.distance).into(),
            tune: [
                frame.phase(),
                self.geometry.walls.len() as f32,
                0.0,
                hand_count,
            ],
            size: [size[0] as f32, size[1] as f32, 0.0, 0.0],
            soft: [texels[0], SOFTNESS[0], texels[1], SOFTNESS[1]],
            floor_middle: four(palette.floor[0], 1.0),
            floor_rim: four(palette.floor[1], 1.0),
            frame: four(palette.frame, 1.0),
            fresh: four(palette.fresh, 1.0),
            hands,
            hand_colours,
            walls,
        };
        for (to_clip, buffer) in [globals.to_clip, to_light, to_sky]
            .iter()
            .zip(&self.uniforms)
        {
            globals.to_clip = *to_clip;
            self.meter
                .write(queue, buffer, 0, bytemuck::bytes_of(&globals));
        }
    }

    fn draw_shadows(&self, encoder: &mut CommandEncoder) {
        for (map, globals) in self.shadows.maps.iter().zip(&self.globals[1..]) {
            let mut pass = encoder.begin_render_pass(&RenderPassDescriptor {
                label: Some("shadows"),
                depth_stencil_attachment: Some(depth_attachment(map, StoreOp::Store)),
                ..RenderPassDescriptor::default()
            });
            let (pipelines, geometry) = (&self.pipelines, &self.geometry);
            pass.set_bind_group(0, globals, &[]);
            pass.set_pipeline(&pipelines.skin_shadow);
            self.draw_skins(&mut pass);
            pass.set_pipeline(&pipelines.element_shadow);
            draw_mesh(&self.meter, &mut pass, &self.boxes, 0..1);
            self.draw_rounded(
                &mut pass,
                [
                    (&pipelines.bar_shadow, &self.fine, &geometry.bars),
                    (&pipelines.bar_shadow, &self.fine, &geometry.thin_bars),
                    (&pipelines.bar_shadow, &self.fine, &geometry.props),
                    (&pipelines.crumb_shadow, &self.coarse, &geometry.crumbs),
                ],
            );
        }
    }

    fn draw_picture(&self, encoder: &mut CommandEncoder) {
        let mut pass = encoder.begin_render_pass(&RenderPassDescriptor {
            label: Some("space"),
            color_attachments: &[clear(&self.targets.rough, Some(&self.targets.picture))],
            depth_stencil_attachment: Some(depth_attachment(&self.targets.depth, StoreOp::Discard)),
            ..RenderPassDescriptor::default()
        });
        let (pipelines, geometry) = (&self.pipelines, &self.geometry);
        pass.set_bind_group(0, &self.globals[0], &[]);
        pass.set_bind_group(1, &self.shadows.read, &[]);
        pass.set_pipeline(&pipelines.sky);
        self.meter.draw(&mut pass, 0..3, 0..1);
        pass.set_pipeline(&pipelines.room);
        pass.set_vertex_buffer(0, self.room.all());
        self.meter.draw(&mut pass, 0..self.room.count(), 0..1);
        pass.set_pipeline(&pipelines.skin);
        self.draw_skins(&mut pass);
        pass.set_pipeline(&pipelines.element);
        draw_mesh(&self.meter, &mut pass, &self.boxes, 0..1);
        self.draw_rounded(
            &mut pass,
            [
                (&pipelines.bar, &self.fine, &geometry.bars),
                (&pipelines.crumb, &self.coarse, &geometry.crumbs),
                (&pipelines.hidden_hand, &self.fine, &geometry.hands),
                (&pipelines.hand, &self.fine, &geometry.hands),
                (&pipelines.hidden_hand, &self.fine, &geometry.props),
                (&pipelines.hand, &self.fine, &geometry.props),
            ],
        );
        pass.set_pipeline(&pipelines.sticker);
        draw_mesh(&self.meter, &mut pass, &self.stickers, 0..1);
        self.draw_rounded(
            &mut pass,
            [
                (&pipelines.glow, &self.fine, &geometry.basket),
                (&pipelines.line, &self.coarse, &geometry.lines),
                (&pipelines.dust, &self.coarse, &geometry.dust),
                (&pipelines.thin_bar, &self.fine, &geometry.thin_bars),
                (&pipelines.glass, &self.fine, &geometry.glass),
            ],
        );
        // Only the front surface of a ghost is visible, so its depth is drawn first.
        for pipeline in [&pipelines.ghost_depth, &pipelines.ghost] {
            pass.set_pipeline(pipeline);
            for buffers in &self.ghosts {
                draw_mesh(&self.meter, &mut pass, buffers, 0..1);
            }
        }
        let parts = (&pipelines.ghost_part, &self.fine, &geometry.ghost_parts);
        self.draw_rounded(&mut pass, [parts]);
    }

    fn draw_rounded<const K: usize>(
        &self,
        pass: &mut RenderPass<'_>,
        kinds: [(&RenderPipeline, &[GrowingBuffer; 2], &Range<u32>); K],
    ) {
        pass.set_vertex_buffer(1, self.rounded.all());
        for (pipeline, mesh, instances) in kinds {
            pass.set_pipeline(pipeline);
            draw_mesh(&self.meter, pass, mesh, self.clamped_to_buffer(instances));
        }
    }

    fn draw_skins(&self, pass: &mut RenderPass<'_>) {
        // In the element view `renewed` is empty and no skins are drawn.
        for buffers in &self.skins[..self.geometry.renewed.len()] {
            draw_mesh(&self.meter, pass, buffers, 0..1);
        }
    }

    /// Limits an instance range to the instances in the buffer.
    fn clamped_to_buffer(&self, instances: &Range<u32>) -> Range<u32> {
        let count = self.rounded.count();
        instances.start.min(count)..instances.end.min(count)
    }
}

/// Returns the matrix to the coordinates of a shadow map that covers `half` [m] around a centre, seen from a
/// light direction.
fn seen_by(light: Vec3, middle: Vec3, half: f32) -> Mat4 {
    let back = light.normalize();
    let right = Vec3::NEG_Z.cross(back).normalize();
    let seen = seen_from(middle, Mat3::from_cols(right, back.cross(right), back));
    // The depth range is three times the width of the map, so that objects between the light and the lit
    // region cast shadows too.
    let scale = Vec3::new(1.0, 1.0, -1.0 / 6.0) / half;
    Mat4::from_translation(0.5 * Vec3::Z) * Mat4::from_scale(scale) * seen
}

fn depth_attachment(view: &TextureView, store: StoreOp) -> RenderPassDepthStencilAttachment<'_> {
    RenderPassDepthStencilAttachment {
        view,
        depth_ops: Some(Operations {
            load: LoadOp::Clear(1.0),
            store,
        }),
        stencil_ops: None,
    }
}
