// How light falls on things.
// Squares and roots stand for the curves of sRGB: they are close, and pow is slow without a GPU.
fn to_linear(colour: vec3f) -> vec3f {
    return colour * colour;
}

// A colour in linear light with an opacity, as the target takes it.
fn shown(light: vec3f, alpha: f32) -> vec4f {
    let soft = clamp(light, vec3f(0.0), vec3f(1.0));
    if globals.tune.z > 0.5 {
        return vec4f(soft * alpha, alpha);
    }
    return vec4f(sqrt(soft) * alpha, alpha);
}

// A lacquered surface, as the eye sees it from a direction: soft light, a soft and a sharp reflection,
// a brighter rim.
fn lacquered(base: vec3f, normal: vec3f, eye: vec3f, gloss: f32) -> vec3f {
    let light = normalize(LIGHT);
    let half_way = normalize(light + eye);
    let wrapped = clamp(dot(normal, light) * 0.5 + 0.5, 0.0, 1.0);
    let towards = max(dot(normal, half_way), 0.0);
    let fourth = towards * towards * towards * towards;
    let away = 1.0 - clamp(dot(normal, eye), 0.0, 1.0);
    let rim = away * away * away;
    var light_out = base * mix(0.42, 1.12, wrapped * wrapped);
    light_out += vec3f(1.0, 0.98, 0.94) * gloss * (0.16 * fourth * fourth * fourth + 0.75 * smoothstep(0.965, 0.985, towards));
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
