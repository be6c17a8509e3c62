//! GPU device of films in a browser. Films use the device of the page, because a page has only one.

use eframe::egui_wgpu::{RenderState, Renderer, RendererOptions};
use egui::mutex::RwLock;
use std::cell::RefCell;
use std::sync::Arc;

thread_local! {
    static LENT: RefCell<Option<RenderState>> = const { RefCell::new(None) };
}

/// Stores the device of the page for later films.
pub fn lend(page: &RenderState) {
    LENT.replace(Some(page.clone()));
}

/// Returns the device of the page with a separate egui renderer, so that images and glyphs are not shared.
/// `None` before [`lend`] was called.
pub fn open(options: RendererOptions) -> Option<RenderState> {
    let page = LENT.with_borrow(Option::clone)?;
    let renderer = Renderer::new(&page.device, page.target_format, options);
    let renderer = Arc::new(RwLock::new(renderer));
    Some(RenderState { renderer, ..page })
}
