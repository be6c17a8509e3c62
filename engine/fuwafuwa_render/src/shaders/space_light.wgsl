// Lighting of 3D surfaces.
@group(1) @binding(0) var shadow_map: texture_depth_2d;
@group(1) @binding(1) var sky_map: texture_depth_2d;
@group(1) @binding(2) var shadow_sampler: sampler_comparison;

// Evenly distributed points of a disc.
fn spread(k: i32, count: i32) -> vec2f {
    let turn = 2.399963 * f32(k);
    return sqrt((f32(k) + 0.5) / f32(count)) * vec2f(cos(turn), sin(turn));
}

// Scale of the depth axis of the shadow map relative to the other axes; see `seen_by`.
const SQUEEZED = 1.0 / 6.0;

// Depth gradient of the shadow map along a surface, to the right and down in the map. With it, a flat surface
// does not shadow itself, however wide the sampled neighbourhood is.
fn leaning(normal: vec3f) -> vec2f {
    let turned = (globals.to_light * vec4f(normal, 0.0)).xyz;
    let slope = SQUEEZED * SQUEEZED * turned.xy / max(-turned.z, 1e-9);
    return vec2f(2.0, -2.0) * clamp(slope, vec2f(-3.0 * SQUEEZED), vec2f(3.0 * SQUEEZED));
}

// Visible fraction of the light's disc at a point, 0 to 1.
fn open_to_light(at: vec3f, normal: vec3f) -> f32 {
    let seen = globals.to_light * vec4f(at + normal * 1.5 * globals.soft.x, 1.0);
    if max(max(abs(seen.x), abs(seen.y)), seen.z) >= 1.0 {
        return 1.0;
    }
    let lean = leaning(normal);
    var sum = 0.0;
    for (var k = 0; k < 16; k++) {
        let by = globals.soft.y * spread(k, 16);
        sum += textureSampleCompareLevel(shadow_map, shadow_sampler, to_uv(seen.xy) + by, seen.z + dot(lean, by));
    }
    return sum / 16.0;
}

// Visible fraction of the sky at a point, 0 to 1, estimated from objects straight above.
fn open_to_sky(at: vec3f, normal: vec3f) -> f32 {
    let seen = globals.to_sky * vec4f(at + normal * 2.0 * globals.soft.z, 1.0);
    if max(max(abs(seen.x), abs(seen.y)), seen.z) >= 1.0 {
        return 1.0;
    }
    var sum = 0.0;
    for (var k = 0; k < 16; k++) {
        let uv = to_uv(seen.xy) + globals.soft.w * spread(k, 16);
        sum += textureSampleCompareLevel(sky_map, shadow_sampler, uv, seen.z);
    }
    return sum / 16.0;
}

// Adds the shadows of hands. Each hand casts a round shadow straight down onto surfaces that face up, with a
// ring in its colour.
fn under_hands(colour: vec3f, at: vec3f, normal: vec3f) -> vec3f {
    var light = colour;
    let up = smoothstep(0.4, 0.75, normal.y);
    for (var k = 0; k < i32(globals.tune.w); k++) {
        let hand = globals.hands[k];
        let away = length(at.xz - hand.xz);
        let is_below = up * smoothstep(0.0, 0.3 * hand.w, hand.y - at.y);
        let shade = 1.0 - smoothstep(0.35 * hand.w, 1.1 * hand.w, away);
        light *= 1.0 - 0.38 * shade * is_below;
        let ring = 1.0 - smoothstep(0.02, 0.10, abs(away / hand.w - 0.92));
        light = mix(light, to_linear(globals.hand_colours[k].rgb), 0.55 * ring * is_below);
    }
    return light;
}

// Ambient light: more from above, some from the floor.
fn from_around(at: vec3f, normal: vec3f) -> f32 {
    return mix(0.80, 1.0, 0.5 + 0.5 * normal.y) * mix(0.72, 1.0, open_to_sky(at, normal));
}

fn background(pixel: vec2f) -> vec3f {
    let height = pixel.y / globals.size.y;
    let rim = to_linear(globals.floor_rim.rgb);
    return mix(mix(rim, vec3f(1.0), 0.55), rim * 0.94, smoothstep(0.0, 0.75, height));
}

fn chance3(at: vec3f) -> f32 {
    return chance(at.xy + 17.31 * at.z);
}

// Smooth 3D noise, 0 to 1.
fn noise3(at: vec3f) -> f32 {
    let cell = floor(at);
    let inside = smoothstep(vec3f(0.0), vec3f(1.0), at - cell);
    var rows = vec4f(0.0);
    for (var k = 0; k < 4; k++) {
        let row = cell + vec3f(0.0, f32(k & 1), f32(k >> 1));
        rows[k] = mix(chance3(row), chance3(row + vec3f(1.0, 0.0, 0.0)), inside.x);
    }
    return mix(mix(rows[0], rows[1], inside.y), mix(rows[2], rows[3], inside.y), inside.z);
}

// Smooth noise vector, each coordinate −1 to 1.
fn rough3(at: vec3f) -> vec3f {
    return 2.0 * vec3f(noise3(at), noise3(at + 31.7), noise3(at + 73.1)) - 1.0;
}

fn towards_eye(at: vec3f) -> vec3f {
    return normalize(globals.eye.xyz - at);
}

// Translucent flesh. `fresh` is 1 on torn surfaces and 0 on the skin.
fn flesh(base: vec3f, fresh: f32, strain: f32, at: vec3f, normal: vec3f, facing: vec3f) -> vec3f {
    let eye = towards_eye(at);
    let open = open_to_light(at, facing);
    let thick = smoothstep(0.0, 0.9, dot(normal, eye));
    var colour = flesh_colour(base, thick, smoothstep(0.05, 0.6, strain), fresh);

    let wrapped = around(normal);
    // Red light reaches farther into the edge of a shadow than blue.
    let share = wrapped * mix(0.5, 1.0, open);
    let lit = smoothstep(vec3f(0.02, 0.1, 0.12), vec3f(0.95, 1.0, 1.0), vec3f(share));
    // Torn surfaces are rough and scatter light in all directions.
    let shade = mix(vec3f(0.76, 0.50, 0.52), vec3f(1.16, 1.14, 1.12), lit);
    colour *= mix(shade, vec3f(1.0), 0.3 * fresh) * from_around(at, facing);
    // Light transmitted through the body leaves on the far side.
    let away = 1.0 - clamp(dot(normal, eye), 0.0, 1.0);
    let rim = away * away * away;
    colour += base * vec3f(1.0, 0.62, 0.5) * rim * (1.0 - wrapped) * 0.55 * (1.0 - fresh);
    // Reflections on lit surfaces: a soft one and a sharp one.
    let towards = mirrored(normal, eye);
    let wet = (1.0 - fresh) * open;
    colour += vec3f(1.0, 0.97, 0.94) * wet * (0.16 * pow12(towards) + 0.24 * smoothstep(0.970, 0.999, towards));
    return under_hands(colour, at, facing);
}
