//! What pictures are drawn with in a browser: what the page is drawn with, since there is no other.

use eframe::egui_wgpu::{RenderState, Renderer, RendererOptions};
use egui::mutex::RwLock;
use std::cell::RefCell;
use std::sync::Arc;

thread_local! {
    static LENT: RefCell<Option<RenderState>> = const { RefCell::new(None) };
}

/// Lends what the page is drawn with.
pub fn lend(page: &RenderState) {
    LENT.replace(Some(page.clone()));
}

/// What egui needs to draw: its images and letters are its own. None before the page has begun.
pub fn open(options: RendererOptions) -> Option<RenderState> {
    let page = LENT.with_borrow(Option::clone)?;
    let renderer = Renderer::new(&page.device, page.target_format, options);
    let renderer = Arc::new(RwLock::new(renderer));
    Some(RenderState { renderer, ..page })
}
