//! Buffers that grow.

use bytemuck::Pod;
use wgpu::{Buffer, BufferDescriptor, BufferUsages, Device, Queue};

/// A buffer on the GPU that is written anew every frame and grows when it must.
pub struct GrowingBuffer {
    buffer: Buffer,
    label: &'static str,
    usage: BufferUsages,
}

impl GrowingBuffer {
    pub fn new(device: &Device, label: &'static str, usage: BufferUsages) -> Self {
        let usage = usage | BufferUsages::COPY_DST;
        Self {
            buffer: create(device, label, usage, 1 << 12),
            label,
            usage,
        }
    }

    /// Writes values to its beginning.
    pub fn write<T: Pod>(&mut self, device: &Device, queue: &Queue, values: &[T]) {
        let bytes: &[u8] = bytemuck::cast_slice(values);
        if bytes.is_empty() {
            return;
        }
        if bytes.len() as u64 > self.buffer.size() {
            let size = (bytes.len() as u64).next_power_of_two();
            self.buffer = create(device, self.label, self.usage, size);
        }
        queue.write_buffer(&self.buffer, 0, bytes);
    }

    pub fn all(&self) -> wgpu::BufferSlice<'_> {
        self.buffer.slice(..)
    }
}

fn create(device: &Device, label: &'static str, usage: BufferUsages, size: u64) -> Buffer {
    device.create_buffer(&BufferDescriptor {
        label: Some(label),
        size,
        usage,
        mapped_at_creation: false,
    })
}
