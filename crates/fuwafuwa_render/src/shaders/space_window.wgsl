// The finished picture into the pass of a window.
@group(1) @binding(0) var picture: texture_2d<f32>;
@group(1) @binding(1) var smooth_sampler: sampler;

struct Window {
    @builtin(position) clip: vec4f,
    @location(0) uv: vec2f,
}

@vertex
fn whole(@builtin(vertex_index) index: u32) -> Window {
    let clip = covering(index);
    return Window(vec4f(clip, 0.0, 1.0), to_uv(clip));
}

@fragment
fn window(in: Window) -> @location(0) vec4f {
    return textureSampleLevel(picture, smooth_sampler, in.uv, 0.0);
}

// For targets that want linear light.
@fragment
fn linear_window(in: Window) -> @location(0) vec4f {
    let colour = textureSampleLevel(picture, smooth_sampler, in.uv, 0.0);
    return vec4f(colour.rgb * colour.rgb, 1.0);
}
