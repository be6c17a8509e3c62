// Copies the finished picture into the window's pass.
@group(1) @binding(0) var picture: texture_2d<f32>;
@group(1) @binding(1) var smooth_sampler: sampler;

@fragment
fn window(in: Covering) -> @location(0) vec4f {
    return textureSampleLevel(picture, smooth_sampler, in.uv, 0.0);
}

// For targets that take linear light.
@fragment
fn linear_window(in: Covering) -> @location(0) vec4f {
    let colour = textureSampleLevel(picture, smooth_sampler, in.uv, 0.0);
    return vec4f(colour.rgb * colour.rgb, 1.0);
}
