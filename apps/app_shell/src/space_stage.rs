//! Drawing of any 3D world into a part of an egui window.

use crate::pass::{PaintCallback, lock, pixels};
use eframe::egui_wgpu::{Callback, RenderState};
use egui::{Rect, Ui};
use fuwafuwa::{Dim3, World};
use fuwafuwa_render::{Cost, Frame, space};
use std::sync::{Arc, Mutex};

/// Draws 3D worlds in an egui window.
pub struct SpaceStage {
    state: RenderState,
    /// Resolution of the drawn worlds, relative to the window; 1 by default.
    pub resolution: f32,
    /// `None` until the first world is drawn.
    renderer: Option<Arc<Mutex<space::Renderer>>>,
}

impl SpaceStage {
    /// Creates a stage for the window with this render state.
    pub fn new(state: &RenderState) -> Self {
        Self {
            state: state.clone(),
            resolution: 1.0,
            renderer: None,
        }
    }

    /// Draws a world into `rect`.
    pub fn draw(
        &mut self,
        ui: &Ui,
        rect: Rect,
        world: &World<Dim3>,
        frame: &Frame<'_, space::Camera>,
    ) {
        let RenderState {
            device,
            queue,
            target_format,
            ..
        } = &self.state;
        let new = || Arc::new(Mutex::new(space::Renderer::new(device, *target_format)));
        let shared = self.renderer.get_or_insert_with(new);
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let size = pixels(ui, rect).map(|side| {
            let side = (side as f32 * self.resolution).round();
            (side as u32).max(1)
        });
        lock(shared).prepare(device, queue, &mut encoder, world, frame, size);
        let paint =
            PaintCallback::new(shared, space::Renderer::paint).with_commands(encoder.finish());
        ui.painter().add(Callback::new_paint_callback(rect, paint));
    }

    /// Returns the GPU cost of drawing since the last call, and resets it.
    pub fn take_cost(&self) -> Cost {
        let cost = self
            .renderer
            .iter()
            .map(|renderer| lock(renderer).take_cost());
        cost.sum()
    }

    /// Frees the images that worlds are drawn into. The next call of [`Self::draw`] allocates them again.
    pub fn release_images(&self) {
        if let Some(renderer) = &self.renderer {
            lock(renderer).release_images(&self.state.device);
        }
    }
}
