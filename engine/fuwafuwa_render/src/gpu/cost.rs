//! Counters of GPU work. Every draw call and every buffer write goes through [`Meter`].

use std::ops::Range;
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};
use wgpu::{Buffer, Device, Queue, RenderPass};

/// Work requested from the GPU.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq)]
pub struct Cost {
    /// Draw calls, including those without vertices.
    pub draws: u64,
    /// Data written to buffers [bytes].
    pub bytes: u64,
}

impl std::iter::Sum for Cost {
    fn sum<I: Iterator<Item = Self>>(costs: I) -> Self {
        costs.fold(Self::default(), |sum, cost| Self {
            draws: sum.draws + cost.draws,
            bytes: sum.bytes + cost.bytes,
        })
    }
}

/// Counts draw calls and buffer writes.
#[derive(Default)]
pub struct Meter {
    draws: AtomicU64,
    bytes: AtomicU64,
}

impl Meter {
    /// Returns the cost since the last call and resets it.
    pub fn take(&self) -> Cost {
        let [draws, bytes] = [&self.draws, &self.bytes].map(|count| count.swap(0, Relaxed));
        Cost { draws, bytes }
    }

    pub fn write(&self, queue: &Queue, buffer: &Buffer, offset: u64, bytes: &[u8]) {
        self.bytes.fetch_add(bytes.len() as u64, Relaxed);
        queue.write_buffer(buffer, offset, bytes);
    }

    pub fn draw(&self, pass: &mut RenderPass<'_>, vertices: Range<u32>, instances: Range<u32>) {
        self.draws.fetch_add(1, Relaxed);
        pass.draw(vertices, instances);
    }

    pub fn draw_indexed(
        &self,
        pass: &mut RenderPass<'_>,
        indices: Range<u32>,
        instances: Range<u32>,
    ) {
        self.draws.fetch_add(1, Relaxed);
        pass.draw_indexed(indices, 0, instances);
    }
}

/// Device, queue and meter for creating and writing buffers.
#[derive(Copy, Clone)]
pub struct Gpu<'a> {
    pub device: &'a Device,
    pub queue: &'a Queue,
    pub meter: &'a Meter,
}
