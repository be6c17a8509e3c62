// Vertex of a triangle over the whole picture.
struct Covering {
    @builtin(position) clip: vec4f,
    @location(0) uv: vec2f,
}

// Corner of a triangle that covers the picture.
fn covering(index: u32) -> vec2f {
    return vec2f(f32(index & 1u) * 4.0 - 1.0, f32(index >> 1u) * 4.0 - 1.0);
}

fn to_uv(clip: vec2f) -> vec2f {
    return vec2f(0.5, 0.5) + vec2f(0.5, -0.5) * clip;
}

@vertex
fn whole(@builtin(vertex_index) index: u32) -> Covering {
    let clip = covering(index);
    return Covering(vec4f(clip, 0.0, 1.0), to_uv(clip));
}
