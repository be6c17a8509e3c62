//! Detection of a lost GPU. A driver restart, a laptop that wakes up or a removed card destroys all GPU
//! resources.

use eframe::egui_wgpu::{RenderState, WgpuSetup};
use std::io::Write;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Error: the window has no GPU, not even a software adapter.
#[derive(Copy, Clone, Debug, thiserror::Error)]
#[error("no graphics adapter: neither Vulkan nor OpenGL is available, not even in software")]
pub struct NoGpu;

/// Makes wgpu allocate GPU memory in small blocks. Its default blocks have 64 MB and more, and stay allocated
/// once used. If the GPU uses main memory, such blocks would change the memory use of the program by large
/// steps.
pub fn with_small_memory_blocks(mut setup: WgpuSetup) -> WgpuSetup {
    if let WgpuSetup::CreateNew(new) = &mut setup {
        let described = new.device_descriptor.clone();
        new.device_descriptor = Arc::new(move |adapter| wgpu::DeviceDescriptor {
            memory_hints: wgpu::MemoryHints::MemoryUsage,
            ..described(adapter)
        });
    }
    setup
}

/// Monitor that notices the loss of a GPU.
#[derive(Clone)]
pub struct GpuWatch {
    queue: wgpu::Queue,
    /// Buffer of four bytes. A write to it tests whether the GPU still works.
    probe: wgpu::Buffer,
    is_lost: Arc<AtomicBool>,
}

impl GpuWatch {
    /// Creates the monitor of a window's GPU. The first GPU error is printed, together with `program`, the
    /// program's name. The program is not stopped here; the caller restarts it if the GPU is lost.
    pub fn of(state: &RenderState, program: &'static str) -> Self {
        let is_lost = Arc::new(AtomicBool::new(false));
        let lost = is_lost.clone();
        let device = &state.device;
        device.set_device_lost_callback(move |_, _| lost.store(true, Ordering::Relaxed));
        let failed = is_lost.clone();
        device.on_uncaptured_error(Arc::new(move |error| {
            if !failed.swap(true, Ordering::Relaxed) {
                // Standard error may be closed.
                let _ = writeln!(std::io::stderr(), "{program}: the GPU failed: {error}");
            }
        }));
        let probe = wgpu::BufferDescriptor {
            label: Some("probe"),
            size: wgpu::COPY_BUFFER_ALIGNMENT,
            usage: wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        };
        Self {
            queue: state.queue.clone(),
            probe: device.create_buffer(&probe),
            is_lost,
        }
    }

    /// Returns whether wgpu has reported the loss of the GPU.
    pub fn is_lost(&self) -> bool {
        self.is_lost.load(Ordering::Relaxed)
    }

    /// Writes to the GPU and returns whether it is lost.
    pub fn probe_is_lost(&self) -> bool {
        let size = wgpu::BufferSize::new(wgpu::COPY_BUFFER_ALIGNMENT);
        let written = size.and_then(|size| self.queue.write_buffer_with(&self.probe, 0, size));
        written.is_none() || self.is_lost()
    }
}

#[cfg(all(test, not(target_family = "wasm")))]
mod tests {
    use super::*;
    use egui_kittest::wgpu::{create_render_state, default_wgpu_setup};

    #[test]
    fn loss_of_gpu_is_noticed() {
        let state = create_render_state(default_wgpu_setup(), Default::default());
        let watch = GpuWatch::of(&state, "test");
        assert!(!watch.is_lost() && !watch.probe_is_lost());
        state.device.destroy();
        let _polled = state.device.poll(wgpu::PollType::Poll);
        assert!(watch.is_lost() && watch.probe_is_lost());
    }
}
