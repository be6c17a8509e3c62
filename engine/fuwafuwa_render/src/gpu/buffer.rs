//! Growing GPU buffers, limited by the maximum buffer size of the device.

use super::cost::Gpu;
use bytemuck::Pod;
use wgpu::{Buffer, BufferDescriptor, BufferUsages, Device};

/// GPU buffer that is rewritten every frame and grows as needed. Values beyond the maximum buffer size of the
/// device are dropped.
pub struct GrowingBuffer {
    buffer: Buffer,
    label: &'static str,
    usage: BufferUsages,
    count: u32,
}

impl GrowingBuffer {
    pub fn new(device: &Device, label: &'static str, usage: BufferUsages) -> Self {
        let usage = usage | BufferUsages::COPY_DST;
        Self {
            buffer: create(device, label, usage, 1 << 12),
            label,
            usage,
            count: 0,
        }
    }

    /// Writes values to the start of the buffer.
    pub fn write<T: Pod>(&mut self, gpu: Gpu<'_>, values: &[T]) {
        let most = gpu.device.limits().max_buffer_size;
        let fit = (most / size_of::<T>() as u64).min(values.len() as u64);
        self.count = fit as u32;
        let bytes: &[u8] = bytemuck::cast_slice(&values[..fit as usize]);
        if bytes.is_empty() {
            return;
        }
        if bytes.len() as u64 > self.buffer.size() {
            let size = (bytes.len() as u64).next_power_of_two().min(most);
            self.buffer = create(gpu.device, self.label, self.usage, size);
        }
        gpu.meter.write(gpu.queue, &self.buffer, 0, bytes);
    }

    /// Returns the number of values in the buffer.
    pub fn count(&self) -> u32 {
        self.count
    }

    pub fn all(&self) -> wgpu::BufferSlice<'_> {
        self.buffer.slice(..)
    }
}

/// Returns the leading triangles (three indices each) that use only the first `there` vertices.
pub fn drawable<'a, T>(indices: &'a [u32], vertices: &[T], there: u32) -> &'a [u32] {
    if vertices.len() == there as usize {
        return indices;
    }
    let missing = indices.iter().position(|&index| index >= there);
    let end = missing.unwrap_or(indices.len());
    &indices[..end - end % 3]
}

fn create(device: &Device, label: &'static str, usage: BufferUsages, size: u64) -> Buffer {
    device.create_buffer(&BufferDescriptor {
        label: Some(label),
        size,
        usage,
        mapped_at_creation: false,
    })
}
