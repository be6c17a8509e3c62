//! Pictures of worlds in a pass of egui's.

use eframe::egui_wgpu::{CallbackResources, CallbackTrait};
use egui::{PaintCallbackInfo, Rect, Ui, vec2};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Puts the picture that a renderer made ready into egui's pass.
pub(super) struct Paint<R>(
    pub Arc<Mutex<R>>,
    pub fn(&R, &mut wgpu::RenderPass<'static>),
);

impl<R: Send + 'static> CallbackTrait for Paint<R> {
    fn paint(
        &self,
        _: PaintCallbackInfo,
        pass: &mut wgpu::RenderPass<'static>,
        _: &CallbackResources,
    ) {
        (self.1)(&lock(&self.0), pass);
    }
}

/// A panic elsewhere left at worst an unfinished picture.
pub(super) fn lock<R>(renderer: &Mutex<R>) -> MutexGuard<'_, R> {
    renderer.lock().unwrap_or_else(PoisonError::into_inner)
}

/// How much of the screen a part of a window is [px].
pub(super) fn pixels(ui: &Ui, rect: Rect) -> [u32; 2] {
    let size = (rect.size() * ui.ctx().pixels_per_point()).max(vec2(1.0, 1.0));
    [size.x.round() as u32, size.y.round() as u32]
}
