//! A world in space, in a part of a window of egui's: whatever world it is.

use super::pass::{Paint, lock, pixels};
use eframe::egui_wgpu::{Callback, RenderState};
use egui::{Rect, Ui};
use fuwafuwa::{Dim3, World};
use fuwafuwa_render::{Cost, Frame, space};
use std::sync::{Arc, Mutex};

/// Where worlds in space are drawn.
pub struct SpaceStage {
    state: RenderState,
    /// None until the first world.
    renderer: Option<Arc<Mutex<space::Renderer>>>,
}

impl SpaceStage {
    /// A stage in the window whose GPU this is.
    pub fn new(state: &RenderState) -> Self {
        Self {
            state: state.clone(),
            renderer: None,
        }
    }

    /// Draws a world into a part of a window.
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
        lock(shared).prepare(device, queue, &mut encoder, world, frame, pixels(ui, rect));
        queue.submit([encoder.finish()]);
        let paint = Paint(shared.clone(), space::Renderer::paint);
        ui.painter().add(Callback::new_paint_callback(rect, paint));
    }

    /// What was drawn since this was asked last cost the GPU.
    pub fn take_cost(&self) -> Cost {
        let cost = self
            .renderer
            .iter()
            .map(|renderer| lock(renderer).take_cost());
        cost.sum()
    }

    /// Gives back the images that worlds are drawn into: for who draws nothing for a while.
    pub fn forget_images(&self) {
        if let Some(renderer) = &self.renderer {
            lock(renderer).forget_images(&self.state.device);
        }
    }
}
