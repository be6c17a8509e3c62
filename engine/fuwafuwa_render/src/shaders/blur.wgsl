// Shrinks and blurs the two images of the bodies.
struct Blur {
    // One texel of the source along the blur direction; in `shrink`, half a texel of the target per axis.
    step: vec2f,
    // Standard deviation [texels].
    sigma: f32,
    // Number of texels to each side that are summed.
    reach: f32,
}
@group(1) @binding(0) var colours: texture_2d<f32>;
@group(1) @binding(1) var reliefs: texture_2d<f32>;
@group(1) @binding(2) var smooth_sampler: sampler;
@group(1) @binding(3) var<uniform> blur: Blur;

struct Images {
    @location(0) colour: vec4f,
    @location(1) relief: vec4f,
}

// Mean of four points inside a texel of the target.
@fragment
fn shrink(in: Covering) -> Images {
    var images = Images(vec4f(0.0), vec4f(0.0));
    for (var k = 0; k < 4; k++) {
        let at = in.uv + blur.step * (vec2f(f32(k & 1), f32(k >> 1)) - 0.5);
        images.colour += 0.25 * textureSampleLevel(colours, smooth_sampler, at, 0.0);
        images.relief += 0.25 * textureSampleLevel(reliefs, smooth_sampler, at, 0.0);
    }
    return images;
}

@fragment
fn soften(in: Covering) -> Images {
    var images = Images(vec4f(0.0), vec4f(0.0));
    var sum = 0.0;
    let reach = i32(blur.reach);
    for (var k = -reach; k <= reach; k++) {
        let weight = exp(-0.5 * f32(k * k) / (blur.sigma * blur.sigma));
        let at = in.uv + blur.step * f32(k);
        images.colour += weight * textureSampleLevel(colours, smooth_sampler, at, 0.0);
        images.relief += weight * textureSampleLevel(reliefs, smooth_sampler, at, 0.0);
        sum += weight;
    }
    images.colour /= sum;
    images.relief /= sum;
    return images;
}
