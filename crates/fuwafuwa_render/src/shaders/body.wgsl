// Floor, frame and bodies, over the whole picture.
@group(1) @binding(0) var skin_colour: texture_2d<f32>;
@group(1) @binding(1) var skin_relief: texture_2d<f32>;
@group(1) @binding(2) var narrow_colour: texture_2d<f32>;
@group(1) @binding(3) var narrow_relief: texture_2d<f32>;
@group(1) @binding(4) var wide_colour: texture_2d<f32>;
@group(1) @binding(5) var wide_relief: texture_2d<f32>;
@group(1) @binding(6) var smooth_sampler: sampler;

struct Covering {
    @builtin(position) clip: vec4f,
    @location(0) uv: vec2f,
    @location(1) at: vec2f,
}

@vertex
fn whole(@builtin(vertex_index) index: u32) -> Covering {
    let clip = covering(index);
    return Covering(vec4f(clip, 0.0, 1.0), to_uv(clip), to_world(clip));
}

// How deep inside the arena a place is [m], its corners a little rounded.
fn depth(at: vec2f) -> f32 {
    let count = i32(globals.tune.y);
    let round = 0.02;
    var sum = 0.0;
    for (var k = 0; k < count; k++) {
        let wall = globals.walls[k];
        sum += exp(-clamp((dot(wall.xy, at) - wall.z) / round, -60.0, 60.0));
    }
    if sum < 1e-20 {
        return 1e3;
    }
    return -round * log(sum);
}

// Where shadows fall from: bodies float a little above the floor.
fn shadow(uv: vec2f) -> f32 {
    let metre = 1.0 / (globals.view.z * vec2f(globals.view.w, -1.0));
    let away = globals.scale.x * vec2f(0.16, -0.24);
    let near = textureSampleLevel(narrow_colour, smooth_sampler, uv - 0.25 * away * metre, 0.0).a;
    let far = textureSampleLevel(wide_colour, smooth_sampler, uv - away * metre, 0.0).a;
    return 0.42 * far + 0.26 * near;
}

@fragment
fn arena(in: Covering) -> @location(0) vec4f {
    let pixel = globals.view.z / globals.size.w;
    let inside = depth(in.at);
    let centred = (in.uv - 0.5) * vec2f(globals.view.w, 1.0);
    let rim = smoothstep(0.1, 0.85, length(centred) / max(1.0, 0.75 * globals.view.w));
    var floor_light = to_linear(mix(globals.floor_middle.rgb, globals.floor_rim.rgb, rim));
    // Dots on a grid show how things move.
    let grid = abs(fract(in.at / 0.125) - 0.5) * 0.125;
    let dots = 1.0 - smoothstep(0.005 - pixel, 0.005 + pixel, length(grid - 0.0));
    floor_light *= 1.0 - 0.06 * dots;
    // The frame throws a shadow, mostly from above and from the left.
    let shade = depth(in.at + normalize(LIGHT.xy) * 0.035);
    floor_light *= 1.0 - 0.30 * (1.0 - smoothstep(-0.03, 0.05, shade)) - 0.12 * exp(-max(inside, 0.0) / 0.05);
    floor_light *= mix(vec3f(1.0), vec3f(0.36, 0.34, 0.46), shadow(in.uv));

    // The frame is a rounded rail.
    let reach = 0.004;
    let slope = vec2f(
        depth(in.at + vec2f(reach, 0.0)) - depth(in.at - vec2f(reach, 0.0)),
        depth(in.at + vec2f(0.0, reach)) - depth(in.at - vec2f(0.0, reach)),
    );
    let bevel = exp(inside / 0.016);
    let facing = dot(slope / max(length(slope), 1e-6), normalize(LIGHT.xy));
    let grain = 0.97 + 0.06 * noise(in.at * vec2f(3.0, 90.0));
    var frame_light = to_linear(globals.frame.rgb) * (1.0 - 0.22 * smoothstep(0.0, 0.5, -inside)) * grain;
    frame_light *= 1.0 + 0.55 * facing * bevel;
    frame_light += 0.10 * exp(-pow((inside + 0.014) / 0.006, 2.0)) * (0.6 + 0.4 * facing);
    let is_floor = smoothstep(-pixel, pixel, inside);
    return shown(mix(frame_light, floor_light, is_floor), 1.0);
}

// Between texels by B-splines, so that slopes are smooth too.
fn smooth_relief(image: texture_2d<f32>, uv: vec2f) -> vec4f {
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
    let below = w0.y + w1.y;
    let a = textureSampleLevel(image, smooth_sampler, low, 0.0);
    let b = textureSampleLevel(image, smooth_sampler, vec2f(high.x, low.y), 0.0);
    let c = textureSampleLevel(image, smooth_sampler, vec2f(low.x, high.y), 0.0);
    let d = textureSampleLevel(image, smooth_sampler, high, 0.0);
    return mix(mix(d, c, left), mix(b, a, left), below);
}

// The slope of the thickness in an image, to the right and upwards [1/m].
fn slope_of(image: texture_2d<f32>, uv: vec2f) -> vec2f {
    let texel = 1.0 / vec2f(textureDimensions(image));
    let metres = 2.0 * texel * globals.view.z * vec2f(globals.view.w, 1.0);
    let right = smooth_relief(image, uv + vec2f(texel.x, 0.0)).r - smooth_relief(image, uv - vec2f(texel.x, 0.0)).r;
    let up = smooth_relief(image, uv - vec2f(0.0, texel.y)).r - smooth_relief(image, uv + vec2f(0.0, texel.y)).r;
    return vec2f(right, up) / metres;
}

// How steep a round edge is where its blurred coverage has a value: 0.5 at the edge, 1 far inside.
fn roundness(covered: f32) -> f32 {
    let inwards = clamp((covered - 0.42) / 0.58, 0.02, 1.0);
    return (1.0 - inwards) / sqrt(1.0 - (1.0 - inwards) * (1.0 - inwards));
}

@fragment
fn body(in: Covering) -> @location(0) vec4f {
    let pixel = 1.0 / globals.size.xy;
    var sharp = vec4f(0.0);
    for (var k = 0; k < 4; k++) {
        let by = (vec2f(f32(k & 1), f32(k >> 1)) - 0.5) * 0.8 * pixel;
        sharp += 0.25 * textureSampleLevel(skin_colour, smooth_sampler, in.uv + by, 0.0);
    }
    if sharp.a < 0.004 {
        return vec4f(0.0);
    }
    if globals.tune.w < 0.5 {
        return shown(to_linear(sharp.rgb / sharp.a), sharp.a);
    }
    let relief = textureSampleLevel(skin_relief, smooth_sampler, in.uv, 0.0);
    let narrow = smooth_relief(narrow_relief, in.uv);
    let wide = smooth_relief(wide_relief, in.uv);
    let near = smooth_relief(narrow_colour, in.uv);
    let far = smooth_relief(wide_colour, in.uv);

    // The colour of what lies around shines through.
    let soft = mix(near.rgb / max(near.a, 0.01), far.rgb / max(far.a, 0.01), 0.25);
    let base = to_linear(soft);

    let slope = 1.5 * globals.scale.z * roundness(wide.r) * slope_of(wide_relief, in.uv)
        + 1.0 * globals.scale.y * roundness(narrow.r) * slope_of(narrow_relief, in.uv);
    let normal = normalize(vec3f(-slope * 1.6, 1.0));

    let light = normalize(LIGHT);
    let half_way = normalize(light + vec3f(0.0, 0.0, 1.0));
    let thick = smoothstep(0.45, 1.0, 0.75 * wide.r + 0.25 * narrow.r);
    // Thin places are deep in colour, thick ones milky.
    let deep = pow(base, vec3f(1.25)) * vec3f(0.98, 0.86, 0.92);
    let milky = mix(base, vec3f(1.0, 0.95, 0.9), 0.26);
    var colour = mix(deep, milky, thick);
    // Where it is squashed, it blushes.
    let strained = clamp(3.0 * wide.b + 1.5 * narrow.b - 0.15, 0.0, 1.0);
    colour = mix(colour, colour * vec3f(1.0, 0.62, 0.66), 0.7 * strained);
    // Fresh inside.
    let torn = smoothstep(0.1, 0.75, relief.g / max(relief.r, relief.g + 0.001) );
    let fresh = mix(to_linear(globals.fresh.rgb), base, 0.2);
    colour = mix(colour, fresh, 0.85 * smoothstep(0.05, 0.5, relief.g));

    let wrapped = clamp(dot(normal, light) * 0.5 + 0.5, 0.0, 1.0);
    let towards = max(dot(normal, half_way), 0.0);
    let rim = pow(1.0 - normal.z, 2.0);
    colour *= mix(0.55, 1.12, wrapped);
    colour += base * vec3f(1.0, 0.6, 0.55) * rim * clamp(0.25 - normal.y, 0.0, 1.0) * 0.55;
    colour += vec3f(1.0, 0.96, 0.92) * (0.20 * pow(towards, 10.0) * (1.0 - thick * 0.6) + 0.5 * smoothstep(0.955, 0.99, towards) * smoothstep(0.1, 0.35, rim));
    // A thin line of deeper colour holds the shape together.
    colour = mix(colour * 0.72, colour, smoothstep(0.25, 0.75, narrow.r + 0.15 * torn));
    return shown(colour, sharp.a);
}
