//! What pictures are drawn with: a device of their own.

use crate::platform::in_small_blocks;
use eframe::egui_wgpu::{
    RenderState, RendererOptions, WgpuConfiguration, WgpuSetup, WgpuSetupCreateNew,
};
use pollster::block_on;
use wgpu::Backends;

/// What egui needs to draw; none where there is nothing to draw with, not even software.
pub fn open(options: RendererOptions) -> Option<RenderState> {
    // OpenGL comes last: where there is no display its driver complains to the terminal.
    [Backends::PRIMARY, Backends::GL]
        .into_iter()
        .find_map(|backends| state_of(backends, options))
}

/// What egui needs to draw with one of some interfaces; none where there is no adapter for any.
fn state_of(backends: Backends, options: RendererOptions) -> Option<RenderState> {
    let mut setup = WgpuSetupCreateNew::without_display_handle();
    // Somebody may have chosen by `WGPU_BACKEND`.
    setup.instance_descriptor.backends &= backends;
    if setup.instance_descriptor.backends.is_empty() {
        return None;
    }
    let wgpu_setup = in_small_blocks(WgpuSetup::CreateNew(setup));
    let instance = block_on(wgpu_setup.new_instance());
    let configuration = WgpuConfiguration {
        wgpu_setup,
        ..WgpuConfiguration::default()
    };
    block_on(RenderState::create(
        &configuration,
        &instance,
        None,
        options,
    ))
    .ok()
}
