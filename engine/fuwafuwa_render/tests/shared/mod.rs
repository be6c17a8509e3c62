//! Helpers shared by the picture tests.

use fuwafuwa_render::Colour;

/// Creates a device with exactly the limits of WebGL2.
pub fn device() -> (wgpu::Device, wgpu::Queue) {
    device_with(wgpu::Limits::downlevel_webgl2_defaults())
}

pub fn device_with(required_limits: wgpu::Limits) -> (wgpu::Device, wgpu::Queue) {
    let instance = wgpu::Instance::default();
    let adapter = pollster::block_on(instance.request_adapter(&Default::default())).expect(
        "these tests need a graphics adapter; install one, for example mesa-vulkan-drivers",
    );
    let descriptor = wgpu::DeviceDescriptor {
        required_limits,
        ..Default::default()
    };
    pollster::block_on(adapter.request_device(&descriptor)).expect("requested device")
}

pub fn is_warm([red, green, blue]: Colour) -> bool {
    red > green + 0.15 && red > blue + 0.15
}

pub fn difference(a: Colour, b: Colour) -> f32 {
    (0..3).map(|k| (a[k] - b[k]).abs()).fold(0.0, f32::max)
}
