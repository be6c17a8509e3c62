//! Rendering of worlds inside egui's render pass.

use eframe::egui_wgpu::{CallbackResources, CallbackTrait};
use egui::{PaintCallbackInfo, Rect, Ui, vec2};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Callback that paints, in egui's render pass, the frame that a renderer has prepared.
pub struct PaintCallback<R>(
    pub Arc<Mutex<R>>,
    pub fn(&R, &mut wgpu::RenderPass<'static>),
);

impl<R: Send + 'static> CallbackTrait for PaintCallback<R> {
    fn paint(
        &self,
        _: PaintCallbackInfo,
        pass: &mut wgpu::RenderPass<'static>,
        _: &CallbackResources,
    ) {
        (self.1)(&lock(&self.0), pass);
    }
}

/// Locks `renderer`, even if a panic poisoned the lock: at worst a picture is unfinished.
pub fn lock<R>(renderer: &Mutex<R>) -> MutexGuard<'_, R> {
    renderer.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Size of a part of the window [px]; at least 1 × 1.
pub fn pixels(ui: &Ui, rect: Rect) -> [u32; 2] {
    let size = (rect.size() * ui.ctx().pixels_per_point()).max(vec2(1.0, 1.0));
    [size.x.round() as u32, size.y.round() as u32]
}
