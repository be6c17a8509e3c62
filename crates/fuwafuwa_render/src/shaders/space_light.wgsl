// How light falls on things in space.
@group(1) @binding(0) var shadow_map: texture_depth_2d;
@group(1) @binding(1) var shadow_sampler: sampler_comparison;

// How much of the light's disc is seen from a place, 0 to 1.
fn open_to_light(at: vec3f, normal: vec3f) -> f32 {
    let seen = globals.to_light * vec4f(at + normal * 2.5 * globals.size.z, 1.0);
    if max(max(abs(seen.x), abs(seen.y)), seen.z) >= 1.0 {
        return 1.0;
    }
    let uv = to_uv(seen.xy);
    var sum = 0.0;
    for (var k = 0; k < 20; k++) {
        // Points of a disc, evenly spread.
        let reach = sqrt((f32(k) + 0.5) / 20.0) * globals.size.w;
        let turn = 2.399963 * f32(k);
        let by = reach * vec2f(cos(turn), sin(turn));
        sum += textureSampleCompareLevel(shadow_map, shadow_sampler, uv + by, seen.z);
    }
    return sum / 20.0;
}

// Light that is left under hands: each throws a round shadow straight down, with a ring around it in
// its colour.
fn under_hands(colour: vec3f, at: vec3f) -> vec3f {
    var light = colour;
    for (var k = 0; k < i32(globals.tune.w); k++) {
        let hand = globals.hands[k];
        let away = length(at.xz - hand.xz);
        let is_below = smoothstep(0.0, 0.3 * hand.w, hand.y - at.y);
        let shade = 1.0 - smoothstep(0.35 * hand.w, 1.1 * hand.w, away);
        light *= 1.0 - 0.38 * shade * is_below;
        let ring = 1.0 - smoothstep(0.0, 0.09, abs(away / hand.w - 0.94));
        light = mix(light, to_linear(globals.hand_colours[k].rgb), 0.55 * ring * is_below);
    }
    return light;
}

// Light from all around: more from above, some from the floor.
fn from_around(normal: vec3f) -> f32 {
    return mix(0.74, 1.0, 0.5 + 0.5 * normal.y);
}

fn background(pixel: vec2f) -> vec3f {
    let height = pixel.y / globals.size.y;
    let rim = to_linear(globals.floor_rim.rgb);
    return mix(mix(rim, vec3f(1.0), 0.55), rim * 0.94, smoothstep(0.0, 0.75, height));
}

fn chance3(at: vec3f) -> f32 {
    return chance(at.xy + 17.31 * at.z);
}

// Smooth noise in space, 0 to 1.
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

// A direction that differs from place to place, each coordinate −1 to 1.
fn rough3(at: vec3f) -> vec3f {
    return 2.0 * vec3f(noise3(at), noise3(at + 31.7), noise3(at + 73.1)) - 1.0;
}
