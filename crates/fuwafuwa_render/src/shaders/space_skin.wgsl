// Skins and elements of bodies in space.
struct SkinCorner {
    @builtin(position) clip: vec4f,
    @location(0) at: vec3f,
    @location(1) rest: vec3f,
    @location(2) normal: vec4f,
    @location(3) colour: vec4f,
}

@vertex
fn skin_corner(
    @location(0) at: vec3f,
    @location(1) rest: vec3f,
    @location(2) normal: vec4f,
    @location(3) colour: vec4f,
) -> SkinCorner {
    return SkinCorner(globals.to_clip * vec4f(at, 1.0), at, rest, normal, colour);
}

// Flesh that light goes into: `fresh` 1 where it is torn, 0 on the skin.
fn flesh(base: vec3f, fresh: f32, strain: f32, at: vec3f, normal: vec3f, facing: vec3f) -> vec3f {
    let light = normalize(LIGHT);
    let eye = normalize(globals.eye.xyz - at);
    let open = open_to_light(at, facing);
    // Thin places are deep in colour, thick ones milky.
    let thick = smoothstep(0.0, 0.9, dot(normal, eye));
    let deep = base * mix(vec3f(1.0), base, 0.25) * vec3f(1.06, 0.86, 0.92);
    let milky = mix(base, vec3f(1.0, 0.93, 0.86), 0.22);
    var colour = mix(deep, milky, thick);
    // Where it is squashed, it blushes.
    colour = mix(colour, colour * vec3f(1.0, 0.55, 0.62), 0.75 * smoothstep(0.05, 0.6, strain));
    colour = mix(colour, mix(to_linear(globals.fresh.rgb), base, 0.15), 0.9 * fresh);

    let wrapped = clamp(dot(normal, light) * 0.5 + 0.5, 0.0, 1.0);
    // Red goes around the edge of the shadow farther than blue.
    let share = min(wrapped, mix(0.30, 1.0, open));
    let lit = smoothstep(vec3f(0.02, 0.1, 0.12), vec3f(0.95, 1.0, 1.0), vec3f(share));
    colour *= mix(vec3f(0.52, 0.46, 0.50), vec3f(1.16, 1.14, 1.12), lit) * from_around(normal);
    // Light that went through comes out on the far side.
    let away = 1.0 - clamp(dot(normal, eye), 0.0, 1.0);
    let rim = away * away * away;
    colour += base * vec3f(1.0, 0.62, 0.5) * rim * (1.0 - wrapped) * 0.55 * (1.0 - fresh);
    // Reflections: a soft one, and a sharp one, on what is lit.
    let towards = max(dot(normal, normalize(light + eye)), 0.0);
    let fourth = towards * towards * towards * towards;
    let wet = (1.0 - fresh) * open;
    colour += vec3f(1.0, 0.97, 0.94) * wet * (0.16 * fourth * fourth * fourth + 0.38 * smoothstep(0.978, 0.995, towards));
    return under_hands(colour, at);
}

@fragment
fn skin(in: SkinCorner) -> @location(0) vec4f {
    let facing = normalize(in.normal.xyz);
    let fresh = in.colour.a;
    var normal = facing;
    var base = to_linear(in.colour.rgb);
    if fresh > 0.01 {
        // Crumbly: bumps in two sizes that stay in their place.
        let bumps = rough3(1.1 * in.rest) + 0.8 * rough3(2.7 * in.rest);
        normal = normalize(facing + 0.42 * fresh * bumps);
    }
    return shown(flesh(base, fresh, in.normal.w, in.at, normal, facing), 1.0);
}

struct BoxCorner {
    @builtin(position) clip: vec4f,
    @location(0) at: vec3f,
    @location(1) sides: vec4f,
    @location(2) colour: vec4f,
}

@vertex
fn box_corner(@location(0) at: vec3f, @location(1) sides: vec4f, @location(2) colour: vec4f) -> BoxCorner {
    return BoxCorner(globals.to_clip * vec4f(at, 1.0), at, sides, colour);
}

@fragment
fn box_side(in: BoxCorner) -> @location(0) vec4f {
    let across = cross(dpdx(in.at), dpdy(in.at));
    let eye = normalize(globals.eye.xyz - in.at);
    let flat = normalize(across);
    let normal = select(-flat, flat, dot(flat, eye) > 0.0);
    let wrapped = clamp(dot(normal, normalize(LIGHT)) * 0.5 + 0.5, 0.0, 1.0);
    let open = open_to_light(in.at, normal);
    var colour = to_linear(in.colour.rgb);
    colour *= mix(0.55, 1.1, min(wrapped, mix(0.4, 1.0, open))) * from_around(normal);
    // Lines along the edges, a pixel and a half wide.
    let lines = smoothstep(vec4f(0.0), 1.7 * fwidth(in.sides) + 0.015, in.sides);
    colour *= mix(0.55, 1.0, min(min(lines.x, lines.y), min(lines.z, lines.w)));
    return shown(under_hands(colour, in.at), 1.0);
}
