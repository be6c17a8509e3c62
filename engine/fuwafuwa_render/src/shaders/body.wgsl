// Floor, frame and bodies, over the whole picture.
@group(1) @binding(0) var skin_colour: texture_2d<f32>;
@group(1) @binding(1) var skin_relief: texture_2d<f32>;
@group(1) @binding(2) var narrow_colour: texture_2d<f32>;
@group(1) @binding(3) var wide_colour: texture_2d<f32>;
@group(1) @binding(4) var soft_colour: texture_2d<f32>;
@group(1) @binding(5) var shapes: texture_2d<f32>;
@group(1) @binding(6) var smooth_sampler: sampler;

// Vertex of the picture or a part of it, with the world point [m] seen there. The point is interpolated,
// though it follows from `uv`: computing it per pixel made Mesa's llvmpipe 22.3 leak memory with each frame.
struct Placed {
    @builtin(position) clip: vec4f,
    @location(0) uv: vec2f,
    @location(1) at: vec2f,
}

@vertex
fn placed(@builtin(vertex_index) index: u32) -> Placed {
    let clip = covering(index);
    return Placed(vec4f(clip, 0.0, 1.0), to_uv(clip), to_world(clip));
}

// Bounding rectangle of all bodies.
@vertex
fn bounding(@builtin(vertex_index) index: u32) -> Placed {
    let at = mix(globals.bounds.xy, globals.bounds.zw, vec2f(f32(index & 1u), f32(index >> 1u)));
    let clip = to_clip(at);
    return Placed(clip, to_uv(clip.xy), at);
}

// Inward direction (xy) and depth inside the arena [m] (z) of a point. Corners are slightly rounded.
fn depth(at: vec2f) -> vec3f {
    let count = i32(globals.tune.y);
    let round = 0.02;
    var sum = vec3f(0.0, 0.0, 1e-20);
    for (var k = 0; k < count; k++) {
        let wall = globals.walls[k];
        let weight = exp(clamp((wall.z - dot(wall.xy, at)) / round, -46.0, 46.0));
        sum += weight * vec3f(wall.xy, 1.0);
    }
    return vec3f(sum.xy / sum.z, -round * log(sum.z));
}

// Shadow strength of the bodies at a pixel, 0 to 1. Bodies float a little above the floor.
fn shadow(uv: vec2f) -> f32 {
    let metre = 1.0 / (globals.view.z * vec2f(globals.view.w, -1.0));
    let away = globals.scale.x * vec2f(0.13, -0.19);
    let near = textureSampleLevel(narrow_colour, smooth_sampler, uv - 0.3 * away * metre, 0.0).a;
    let far = textureSampleLevel(wide_colour, smooth_sampler, uv - away * metre, 0.0).a;
    return min(0.55 * far + 0.35 * near, 1.0);
}

@fragment
fn arena(in: Placed) -> @location(0) vec4f {
    let pixel = globals.view.z / globals.size.w;
    let at = in.at;
    let inside = depth(at);
    let centred = (in.uv - 0.5) * vec2f(globals.view.w, 1.0);
    let rim = smoothstep(0.1, 0.85, length(centred) / max(1.0, 0.75 * globals.view.w));
    var floor_light = to_linear(mix(globals.floor_middle.rgb, globals.floor_rim.rgb, rim));
    // Dots on a grid make motion visible.
    let grid = abs(fract(at / 0.125) - 0.5) * 0.125;
    floor_light *= 0.93 + 0.07 * smoothstep(0.006 - pixel, 0.006 + pixel, length(grid));
    // The frame casts a shadow from above and from the left.
    let facing = dot(inside.xy, normalize(LIGHT.xy));
    let shade = inside.z + 0.04 * facing;
    floor_light *= 1.0 - 0.22 * (1.0 - smoothstep(-0.04, 0.05, shade)) - 0.10 * exp(-max(inside.z, 0.0) / 0.06);
    floor_light *= mix(vec3f(1.0), vec3f(0.40, 0.38, 0.52), shadow(in.uv));

    // The frame is a rounded rail.
    let outside = max(-inside.z, 0.0);
    var frame_light = to_linear(globals.frame.rgb) * (1.0 - 0.25 * smoothstep(0.0, 0.5, outside));
    frame_light *= 1.0 + 0.5 * facing * exp(-outside / 0.014);
    frame_light *= 1.0 + 0.25 * exp(-(outside - 0.016) * (outside - 0.016) / 5e-5);
    let is_floor = smoothstep(-pixel, pixel, inside.z);
    return shown(mix(frame_light, floor_light, is_floor), 1.0);
}

@fragment
fn body(in: Placed) -> @location(0) vec4f {
    let pixel = 1.0 / globals.size.xy;
    var sharp = vec4f(0.0);
    for (var k = 0; k < 4; k++) {
        let by = (vec2f(f32(k & 1), f32(k >> 1)) - 0.5) * pixel;
        sharp += 0.25 * textureSampleLevel(skin_colour, smooth_sampler, in.uv + by, 0.0);
    }
    if sharp.a < 0.004 {
        return vec4f(0.0);
    }
    let metres = globals.view.z / globals.size.w;
    let alpha = sharp.a * smoothstep(-metres, metres, depth(in.at).z);
    if globals.tune.w < 0.5 {
        return shown(to_linear(sharp.rgb / sharp.a), alpha);
    }
    let relief = textureSampleLevel(skin_relief, smooth_sampler, in.uv, 0.0);
    let soft = textureSampleLevel(soft_colour, smooth_sampler, in.uv, 0.0);
    let shape = textureSampleLevel(shapes, smooth_sampler, in.uv, 0.0);
    let normal = normalize(vec3f(-shape.xy, 1.0));
    // The blurred colour looks like the inside of a soft body; some of the sharp one keeps drawn lines visible.
    let base = to_linear(mix(soft.rgb, sharp.rgb / sharp.a, 0.65));

    let torn = smoothstep(0.0, 0.6, relief.g);
    var colour = flesh_colour(base, shape.z, shape.w, torn);

    let wrapped = around(normal);
    let towards = mirrored(normal, vec3f(0.0, 0.0, 1.0));
    let rim = (1.0 - normal.z) * sqrt(1.0 - normal.z);
    let low = clamp(dot(normal.xy, -normalize(LIGHT.xy)), 0.0, 1.0);
    // Torn surfaces are rough and scatter light in all directions.
    colour *= mix(mix(0.50, 1.13, smoothstep(0.1, 1.0, wrapped)), 1.0, 0.7 * torn);
    // Light transmitted through the body leaves on the far side.
    colour += base * vec3f(1.0, 0.62, 0.5) * rim * low * 0.9 * (1.0 - torn);
    // Reflections: a soft one, and a sharp one where the surface is round enough.
    let wet = 1.0 - 0.7 * torn;
    colour += vec3f(1.0, 0.97, 0.94) * wet * (0.24 * pow12(towards) * smoothstep(0.0, 0.25, 1.0 - normal.z)
        + 0.6 * smoothstep(0.974, 0.994, towards) * smoothstep(0.75, 0.95, soft.a));
    // A thin line of deeper colour along the edge makes the shape clearer.
    colour *= mix(0.74, 1.0, smoothstep(0.2, 0.7, soft.a + 0.3 * torn));
    return shown(colour, alpha);
}
