// Apparent relief of the blurred bodies: slope and thickness.
@group(1) @binding(0) var narrow_colour: texture_2d<f32>;
@group(1) @binding(1) var narrow_relief: texture_2d<f32>;
@group(1) @binding(2) var wide_colour: texture_2d<f32>;
@group(1) @binding(3) var wide_relief: texture_2d<f32>;
@group(1) @binding(4) var smooth_sampler: sampler;

struct Images {
    // Colour that shines through, and distance from the edge of the piece.
    @location(0) colour: vec4f,
    // Slope to the right and upwards, thickness, strain.
    @location(1) shape: vec4f,
}

// Samples with cubic B-splines, so that slopes are smooth too.
fn smooth_texel(image: texture_2d<f32>, uv: vec2f) -> vec4f {
    let size = vec2f(textureDimensions(image));
    let at = uv * size - 0.5;
    let f = fract(at);
    let base = floor(at);
    let w0 = (1.0 - f) * (1.0 - f) * (1.0 - f) / 6.0;
    let w1 = (4.0 - 6.0 * f * f + 3.0 * f * f * f) / 6.0;
    let w3 = f * f * f / 6.0;
    let w2 = 1.0 - w0 - w1 - w3;
    let low = (base - 0.5 + w1 / (w0 + w1)) / size;
    let high = (base + 1.5 + w3 / (w2 + w3)) / size;
    let left = w0.x + w1.x;
    let above = w0.y + w1.y;
    let a = textureSampleLevel(image, smooth_sampler, low, 0.0);
    let b = textureSampleLevel(image, smooth_sampler, vec2f(high.x, low.y), 0.0);
    let c = textureSampleLevel(image, smooth_sampler, vec2f(low.x, high.y), 0.0);
    let d = textureSampleLevel(image, smooth_sampler, high, 0.0);
    return mix(mix(d, c, left), mix(b, a, left), above);
}

// Gradient of the red channel to the right and upwards [1/m].
fn slope_of(image: texture_2d<f32>, uv: vec2f) -> vec2f {
    let texel = 0.5 / vec2f(textureDimensions(image));
    let metres = 2.0 * texel * globals.view.z * vec2f(globals.view.w, 1.0);
    let x = vec2f(texel.x, 0.0);
    let y = vec2f(0.0, texel.y);
    let right = smooth_texel(image, uv + x).r - smooth_texel(image, uv - x).r;
    let up = smooth_texel(image, uv - y).r - smooth_texel(image, uv + y).r;
    return vec2f(right, up) / metres;
}

// Slope factor of a round edge: steep at blurred coverage 0.5, flat at 1.
fn roundness(covered: f32) -> f32 {
    let beyond = 1.0 - clamp((covered - 0.42) / 0.58, 0.03, 1.0);
    return beyond / sqrt(1.0 - beyond * beyond);
}

@fragment
fn shape(in: Covering) -> Images {
    let near = textureSampleLevel(narrow_colour, smooth_sampler, in.uv, 0.0);
    let narrow = textureSampleLevel(narrow_relief, smooth_sampler, in.uv, 0.0);
    let far = smooth_texel(wide_colour, in.uv);
    let wide = smooth_texel(wide_relief, in.uv);
    // The colour of the surroundings shines through.
    let colour = mix(near.rgb / max(near.a, 0.01), far.rgb / max(far.a, 0.01), 0.25);
    let slope = globals.scale.z * (1.3 + 0.9 * roundness(wide.r)) * slope_of(wide_relief, in.uv)
        + globals.scale.y * 1.2 * roundness(narrow.r) * slope_of(narrow_relief, in.uv);
    let thick = smoothstep(0.4, 1.0, 0.75 * wide.r + 0.25 * narrow.r);
    let strain = clamp(2.2 * mix(wide.b / max(wide.r, 0.1), narrow.b / max(narrow.r, 0.1), 0.5) - 0.25, 0.0, 1.0);
    return Images(vec4f(colour, narrow.r), vec4f(slope, thick, strain));
}
