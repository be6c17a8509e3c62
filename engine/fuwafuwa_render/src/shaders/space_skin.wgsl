// Skins and elements of 3D bodies.
struct SkinCorner {
    @builtin(position) clip: vec4f,
    @location(0) at: vec3f,
    @location(1) rest: vec3f,
    @location(2) normal: vec4f,
    @location(3) colour: vec4f,
    @location(4) other: vec4f,
}

@vertex
fn skin_corner(
    @location(0) at: vec3f,
    @location(1) rest: vec3f,
    @location(2) normal: vec4f,
    @location(3) colour: vec4f,
    @location(4) other: vec4f,
) -> SkinCorner {
    return SkinCorner(globals.to_clip * vec4f(at, 1.0), at, rest, normal, colour, other);
}

// Colour of the material. The border between two materials is sharp at any viewing distance.
fn material(in: SkinCorner) -> vec3f {
    let beyond = (in.other.a - 0.5) / max(fwidth(in.other.a), 1e-4);
    return mix(to_linear(in.colour.rgb), to_linear(in.other.rgb), clamp(beyond + 0.5, 0.0, 1.0));
}

@fragment
fn skin(in: SkinCorner) -> @location(0) vec4f {
    let facing = normalize(in.normal.xyz);
    let fresh = in.colour.a;
    var normal = facing;
    let base = material(in);
    if fresh > 0.01 {
        // Crumbly: bumps of two sizes, fixed to the material.
        let bumps = rough3(0.9 * in.rest) + 0.7 * rough3(2.3 * in.rest);
        normal = normalize(facing + 0.30 * fresh * bumps);
    }
    return shown(flesh(base, fresh, in.normal.w, in.at, normal, facing), 1.0);
}

// Slightly glossy paint.
@fragment
fn sticker(in: SkinCorner) -> @location(0) vec4f {
    let normal = normalize(in.normal.xyz);
    let open = open_to_light(in.at, normal);
    let share = around(normal) * mix(0.6, 1.0, open);
    var colour = to_linear(in.colour.rgb) * mix(vec3f(0.66, 0.62, 0.68), vec3f(1.08), share);
    colour *= from_around(in.at, normal);
    let towards = mirrored(normal, towards_eye(in.at));
    colour += vec3f(0.35 * open * smoothstep(0.975, 0.999, towards));
    return shown(under_hands(colour, in.at, normal), in.colour.a);
}

// Transparent body, more transparent where it faces the eye.
@fragment
fn ghost(in: SkinCorner) -> @location(0) vec4f {
    let away = 1.0 - abs(dot(normalize(in.normal.xyz), towards_eye(in.at)));
    let colour = mix(vec3f(0.2, 0.18, 0.38), material(in), 0.25);
    return shown(colour, 0.16 + 0.6 * smoothstep(0.35, 1.0, away));
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
    let eye = towards_eye(in.at);
    let flat = normalize(across);
    let normal = select(-flat, flat, dot(flat, eye) > 0.0);
    let open = open_to_light(in.at, normal);
    var colour = to_linear(in.colour.rgb);
    colour *= mix(0.55, 1.1, min(around(normal), mix(0.4, 1.0, open))) * from_around(in.at, normal);
    // Lines along the edges, 1.7 pixels wide.
    let lines = smoothstep(vec4f(0.0), 1.7 * fwidth(in.sides) + 0.015, in.sides);
    colour *= mix(0.55, 1.0, min(min(lines.x, lines.y), min(lines.z, lines.w)));
    return shown(under_hands(colour, in.at, normal), 1.0);
}
