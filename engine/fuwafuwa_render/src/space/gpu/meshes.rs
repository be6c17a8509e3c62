//! Vertex and index buffer of a mesh on the GPU.

use crate::gpu::buffer::{GrowingBuffer, drawable};
use crate::gpu::cost::{Gpu, Meter};
use crate::space::skin::Skin;
use bytemuck::Pod;
use std::ops::Range;
use wgpu::{BufferUsages, Device, IndexFormat, RenderPass};

/// Creates empty vertex and index buffers.
pub(super) fn mesh_buffers(device: &Device, label: &'static str) -> [GrowingBuffer; 2] {
    [BufferUsages::VERTEX, BufferUsages::INDEX]
        .map(|usage| GrowingBuffer::new(device, label, usage))
}

/// Writes the buffers of each skin. `renewed` has a flag per skin; without it, the index buffer stays as it
/// is.
pub(super) fn write_skins(
    gpu: Gpu<'_>,
    buffers: &mut Vec<[GrowingBuffer; 2]>,
    skins: &[Skin],
    renewed: &[bool],
) {
    buffers.truncate(skins.len());
    while buffers.len() < skins.len() {
        buffers.push(mesh_buffers(gpu.device, "skin"));
    }
    for (place, is_new) in renewed.iter().enumerate() {
        let (skin, [vertices, indices]) = (&skins[place], &mut buffers[place]);
        vertices.write(gpu, skin.vertices());
        // After a body was removed, the next body uses the buffers of the removed one, but has other
        // triangles.
        if *is_new || indices.count() as usize != skin.indices().len() {
            let there = drawable(skin.indices(), skin.vertices(), vertices.count());
            indices.write(gpu, there);
        }
    }
}

/// Writes vertices, and the triangles whose vertices all fit into the buffer.
pub(super) fn write_mesh<T: Pod>(
    gpu: Gpu<'_>,
    [vertices, indices]: &mut [GrowingBuffer; 2],
    corners: &[T],
    triangles: &[u32],
) {
    vertices.write(gpu, corners);
    let there = drawable(triangles, corners, vertices.count());
    indices.write(gpu, there);
}

/// Draws a mesh for a range of instances. Draws nothing if the mesh or the range is empty.
pub(super) fn draw_mesh(
    meter: &Meter,
    pass: &mut RenderPass<'_>,
    [vertices, indices]: &[GrowingBuffer; 2],
    instances: Range<u32>,
) {
    if indices.count() == 0 || instances.is_empty() {
        return;
    }
    pass.set_vertex_buffer(0, vertices.all());
    pass.set_index_buffer(indices.all(), IndexFormat::Uint32);
    meter.draw_indexed(pass, 0..indices.count(), instances);
}
