//! GPU device of films on a desktop, separate from that of the window.

use app_shell::with_small_memory_blocks;
use eframe::egui_wgpu::{
    RenderState, RendererOptions, WgpuConfiguration, WgpuSetup, WgpuSetupCreateNew,
};
use pollster::block_on;
use wgpu::Backends;

/// Opens a GPU device for egui. `None` if there is no graphics adapter, not even in software.
pub fn open(options: RendererOptions) -> Option<RenderState> {
    // OpenGL comes last because its driver prints warnings to the terminal if there is no display.
    [Backends::PRIMARY, Backends::GL]
        .into_iter()
        .find_map(|backends| state_of(backends, options))
}

/// Opens a GPU device for egui with one of `backends`. `None` if they have no adapter.
fn state_of(backends: Backends, options: RendererOptions) -> Option<RenderState> {
    let mut setup = WgpuSetupCreateNew::without_display_handle();
    // The user may have restricted the backends by `WGPU_BACKEND`.
    setup.instance_descriptor.backends &= backends;
    if setup.instance_descriptor.backends.is_empty() {
        return None;
    }
    let wgpu_setup = with_small_memory_blocks(WgpuSetup::CreateNew(setup));
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
