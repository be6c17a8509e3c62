// Lighting of 2D and 3D surfaces. Squares and square roots approximate the sRGB curves, because pow is slow
// without a GPU.
fn to_linear(colour: vec3f) -> vec3f {
    return colour * colour;
}

// Converts linear light with an opacity to the target's encoding.
fn shown(light: vec3f, alpha: f32) -> vec4f {
    let soft = clamp(light, vec3f(0.0), vec3f(1.0));
    if globals.tune.z > 0.5 {
        return vec4f(soft * alpha, alpha);
    }
    return vec4f(sqrt(soft) * alpha, alpha);
}

// Wrapped diffuse term, from 0 (facing away from the light) to 1: light wraps around soft bodies.
fn around(normal: vec3f) -> f32 {
    return clamp(dot(normal, normalize(LIGHT)) * 0.5 + 0.5, 0.0, 1.0);
}

// Cosine of the half-vector angle between light and eye direction, clamped to 0 to 1.
fn mirrored(normal: vec3f, eye: vec3f) -> f32 {
    return max(dot(normal, normalize(normalize(LIGHT) + eye)), 0.0);
}

fn pow12(base: f32) -> f32 {
    let fourth = base * base * base * base;
    return fourth * fourth * fourth;
}

// Unlit colour of a body's flesh. `thick`, `squashed` and `torn` are 0 to 1.
fn flesh_colour(base: vec3f, thick: f32, squashed: f32, torn: f32) -> vec3f {
    // Thin parts are deep in colour, thick parts milky.
    let deep = base * mix(vec3f(1.0), base, 0.25) * vec3f(1.06, 0.86, 0.92);
    let milky = mix(base, vec3f(1.0, 0.93, 0.86), 0.22);
    var colour = mix(deep, milky, thick);
    // Squashed parts blush.
    colour = mix(colour, colour * vec3f(1.0, 0.55, 0.62), 0.75 * squashed);
    // Torn surfaces show the inside colour.
    return mix(colour, mix(to_linear(globals.fresh.rgb), base, 0.15), 0.9 * torn);
}

// Lacquered surface seen from direction `eye`: soft diffuse light, a soft and a sharp reflection, a brighter
// rim.
fn lacquered(base: vec3f, normal: vec3f, eye: vec3f, gloss: f32) -> vec3f {
    let wrapped = around(normal);
    let towards = mirrored(normal, eye);
    let away = 1.0 - clamp(dot(normal, eye), 0.0, 1.0);
    let rim = away * away * away;
    var light_out = base * mix(0.42, 1.12, wrapped * wrapped);
    light_out += vec3f(1.0, 0.98, 0.94) * gloss * (0.16 * pow12(towards) + 0.75 * smoothstep(0.965, 0.985, towards));
    light_out += base * rim * 0.5 * clamp(0.4 - normal.y, 0.0, 1.0);
    return light_out;
}

fn chance(at: vec2f) -> f32 {
    let mixed = fract(vec3f(at.xyx) * 0.1031);
    let more = mixed + dot(mixed, mixed.yzx + 33.33);
    return fract((more.x + more.y) * more.z);
}

// Smooth noise, 0 to 1.
fn noise(at: vec2f) -> f32 {
    let cell = floor(at);
    let inside = smoothstep(vec2f(0.0), vec2f(1.0), at - cell);
    let low = mix(chance(cell), chance(cell + vec2f(1.0, 0.0)), inside.x);
    let high = mix(chance(cell + vec2f(0.0, 1.0)), chance(cell + vec2f(1.0, 1.0)), inside.x);
    return mix(low, high, inside.y);
}
