//! Rendering of worlds with egui's frame: commands that run before its render pass, and painting inside it.

use eframe::egui_wgpu::{CallbackResources, CallbackTrait, ScreenDescriptor};
use egui::{PaintCallbackInfo, Rect, Ui, vec2};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Callback that paints, in egui's render pass, the frame that a renderer has prepared.
pub struct PaintCallback<R> {
    renderer: Arc<Mutex<R>>,
    paint: fn(&R, &mut wgpu::RenderPass<'static>),
    /// Commands to run before the render pass. [`CallbackTrait::prepare`] takes them, so that they run once.
    commands: Mutex<Option<wgpu::CommandBuffer>>,
}

impl<R> PaintCallback<R> {
    /// Creates a callback which draws with `paint`.
    pub fn new(renderer: &Arc<Mutex<R>>, paint: fn(&R, &mut wgpu::RenderPass<'static>)) -> Self {
        Self {
            renderer: renderer.clone(),
            paint,
            commands: Mutex::default(),
        }
    }

    /// Adds commands that run before egui's render pass. They do not run if egui does not draw this frame.
    pub fn with_commands(self, commands: wgpu::CommandBuffer) -> Self {
        Self {
            commands: Mutex::new(Some(commands)),
            ..self
        }
    }
}

impl<R: Send + 'static> CallbackTrait for PaintCallback<R> {
    fn prepare(
        &self,
        _: &wgpu::Device,
        _: &wgpu::Queue,
        _: &ScreenDescriptor,
        _: &mut wgpu::CommandEncoder,
        _: &mut CallbackResources,
    ) -> Vec<wgpu::CommandBuffer> {
        lock(&self.commands).take().into_iter().collect()
    }

    fn paint(
        &self,
        _: PaintCallbackInfo,
        pass: &mut wgpu::RenderPass<'static>,
        _: &CallbackResources,
    ) {
        (self.paint)(&lock(&self.renderer), pass);
    }
}

/// Locks `mutex`, even if a panic poisoned it: at worst a picture is unfinished.
pub fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Size of a part of the window [px]; at least 1 × 1.
pub fn pixels(ui: &Ui, rect: Rect) -> [u32; 2] {
    let size = (rect.size() * ui.ctx().pixels_per_point()).max(vec2(1.0, 1.0));
    [size.x.round() as u32, size.y.round() as u32]
}
