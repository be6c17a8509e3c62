//! Whether the GPU is still there: a driver that starts anew, a laptop that wakes or a card that is pulled takes all
//! that was on it along.

use eframe::egui_wgpu::{RenderState, WgpuSetup};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// The same, but for memory that is asked for as it is needed: in blocks of 64 MB and more, of which each is kept once it was
/// touched, what a stand needs would go up and down by as much all day, where the GPU is in software or shares its memory.
pub fn in_small_blocks(mut setup: WgpuSetup) -> WgpuSetup {
    if let WgpuSetup::CreateNew(new) = &mut setup {
        let described = new.device_descriptor.clone();
        new.device_descriptor = Arc::new(move |adapter| wgpu::DeviceDescriptor {
            memory_hints: wgpu::MemoryHints::MemoryUsage,
            ..described(adapter)
        });
    }
    setup
}

/// An eye on a GPU.
#[derive(Clone)]
pub struct GpuWatch {
    queue: wgpu::Queue,
    /// Four bytes that tell whether anything can still be written.
    probe: wgpu::Buffer,
    is_lost: Arc<AtomicBool>,
}

impl GpuWatch {
    /// On that of a window. What fails on it is told once, and does not end the game where it happens: to begin anew in
    /// another window is all that helps.
    pub fn of(state: &RenderState) -> Self {
        let is_lost = Arc::new(AtomicBool::new(false));
        let lost = is_lost.clone();
        let device = &state.device;
        device.set_device_lost_callback(move |_, _| lost.store(true, Ordering::Relaxed));
        let failed = is_lost.clone();
        device.on_uncaptured_error(Arc::new(move |error| {
            if !failed.swap(true, Ordering::Relaxed) {
                eprintln!("tamaire: the GPU failed: {error}");
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

    /// Whether it is gone, as far as was told.
    pub fn is_lost(&self) -> bool {
        self.is_lost.load(Ordering::Relaxed)
    }

    /// Whether it is gone, by trying.
    pub fn tried_is_lost(&self) -> bool {
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
    fn a_gpu_that_goes_is_noticed() {
        let state = create_render_state(default_wgpu_setup(), Default::default());
        let watch = GpuWatch::of(&state);
        assert!(!watch.is_lost() && !watch.tried_is_lost());
        state.device.destroy();
        let _polled = state.device.poll(wgpu::PollType::Poll);
        assert!(watch.is_lost() && watch.tried_is_lost());
    }
}
