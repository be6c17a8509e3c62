// Bars, hands, the basket and particles. Each shape is drawn into a rectangle.
struct Shape {
    @location(0) from_to: vec4f,
    // Radius [m] or rotation angle of a box [rad]; form (0 capsule, 1 box, 2 ball); number.
    @location(1) form: vec3f,
    @location(2) colour: vec3f,
}

struct ShapeCorner {
    @builtin(position) clip: vec4f,
    @location(0) at: vec2f,
    @location(1) @interpolate(flat) from_to: vec4f,
    @location(2) @interpolate(flat) form: vec3f,
    @location(3) @interpolate(flat) colour: vec3f,
}

// Position of a point relative to the centre of a box, along the box axes.
fn within(at: vec2f, from_to: vec4f, angle: f32) -> vec2f {
    let place = at - from_to.xy;
    let way = vec2f(cos(angle), sin(angle));
    return vec2f(dot(place, way), dot(place, vec2f(-way.y, way.x)));
}

fn shape_corner(index: u32, shape: Shape, margin: f32) -> ShapeCorner {
    var low = min(shape.from_to.xy, shape.from_to.zw);
    var high = max(shape.from_to.xy, shape.from_to.zw);
    var radius = shape.form.x;
    if shape.form.y == 1.0 {
        let way = abs(vec2f(cos(radius), sin(radius)));
        let half = vec2f(dot(way, shape.from_to.zw), dot(way.yx, shape.from_to.zw));
        low = shape.from_to.xy - half;
        high = shape.from_to.xy + half;
        radius = 0.0;
    }
    let reach = vec2f(radius + margin);
    let at = mix(low - reach, high + reach, vec2f(f32(index & 1u), f32(index >> 1u)));
    return ShapeCorner(to_clip(at), at, shape.from_to, shape.form, shape.colour);
}

@vertex
fn close_corner(@builtin(vertex_index) index: u32, shape: Shape) -> ShapeCorner {
    return shape_corner(index, shape, 0.01);
}

@vertex
fn wide_corner(@builtin(vertex_index) index: u32, shape: Shape) -> ShapeCorner {
    return shape_corner(index, shape, 0.2);
}

fn distance_to(at: vec2f, in: ShapeCorner) -> f32 {
    if in.form.y == 1.0 {
        let beyond = abs(within(at, in.from_to, in.form.x)) - in.from_to.zw;
        return length(max(beyond, vec2f(0.0))) + min(max(beyond.x, beyond.y), 0.0);
    }
    let axis = in.from_to.zw - in.from_to.xy;
    let reach = at - in.from_to.xy;
    let along = clamp(dot(axis, reach) / max(dot(axis, axis), 1e-12), 0.0, 1.0);
    return length(reach - axis * along) - in.form.x;
}

fn outwards(at: vec2f, in: ShapeCorner) -> vec2f {
    let reach = 0.001;
    let slope = vec2f(
        distance_to(at + vec2f(reach, 0.0), in) - distance_to(at - vec2f(reach, 0.0), in),
        distance_to(at + vec2f(0.0, reach), in) - distance_to(at - vec2f(0.0, reach), in),
    );
    return slope / max(length(slope), 1e-6);
}

fn pixel() -> f32 {
    return globals.view.z / globals.size.w;
}

@fragment
fn shadow(in: ShapeCorner) -> @location(0) vec4f {
    let away = vec2f(0.022, -0.032);
    let far = 1.0 - smoothstep(-0.035, 0.055, distance_to(in.at - away, in));
    let near = 1.0 - smoothstep(-0.01, 0.022, distance_to(in.at - 0.3 * away, in));
    let alpha = 0.20 * far + 0.16 * near;
    return shown(vec3f(0.07, 0.06, 0.12), alpha);
}

@fragment
fn bar(in: ShapeCorner) -> @location(0) vec4f {
    let inside = -distance_to(in.at, in);
    // Glass has a clear inside and a visible edge.
    let glass = select(0.0, 1.0, in.form.z == 1.0);
    let clear = glass * mix(0.35, 0.78, smoothstep(0.0, 0.03, inside));
    let alpha = smoothstep(-0.5, 0.5, inside / pixel()) * (1.0 - clear);
    // A box has rounded edges; other shapes are as thick as they are wide.
    let round = select(in.form.x, min(0.03, min(in.from_to.z, in.from_to.w)), in.form.y == 1.0);
    let steep = clamp(1.0 - inside / round, 0.0, 0.98);
    let normal = normalize(vec3f(outwards(in.at, in) * steep, sqrt(1.0 - steep * steep)));
    var along = in.from_to.zw - in.from_to.xy;
    if in.form.y > 0.5 {
        along = select(vec2f(0.0, 1.0), vec2f(1.0, 0.0), in.from_to.z > in.from_to.w);
    }
    along = normalize(along + vec2f(1e-6, 0.0));
    let place = select(in.at - in.from_to.xy, within(in.at, in.from_to, in.form.x), in.form.y == 1.0);
    let wood = vec2f(dot(place, along), dot(place, vec2f(-along.y, along.x)));
    let rings = noise(vec2f(wood.x * 2.5, wood.y * 55.0 + 2.0 * noise(wood * vec2f(5.0, 9.0)))) * 0.65
        + noise(wood * vec2f(9.0, 190.0)) * 0.35;
    // A curtain hangs in folds.
    let folds = 0.5 + 0.5 * sin(90.0 * place.x + 4.0 * noise(place * vec2f(3.0, 2.0)));
    let stuff = select(mix(0.80, 1.12, rings), mix(0.62, 1.1, folds), in.form.z == 2.0);
    let shine = select(0.55, 0.1, in.form.z == 2.0);
    return shown(lacquered(to_linear(in.colour) * stuff, normal, vec3f(0.0, 0.0, 1.0), shine), alpha);
}

@fragment
fn hand(in: ShapeCorner) -> @location(0) vec4f {
    let inside = -distance_to(in.at, in);
    let alpha = smoothstep(-0.5, 0.5, inside / pixel());
    // A box is shaded like a cushion that is highest in its middle.
    let is_box = in.form.y == 1.0;
    let radius = select(in.form.x, min(in.from_to.z, in.from_to.w), is_box);
    let of_box = within(in.at, in.from_to, in.form.x) / in.from_to.zw;
    let place = select((in.at - in.from_to.xy) / radius, of_box, is_box);
    let steep = min(length(place), 0.985);
    let normal = vec3f(place * steep / max(length(place), 1e-6), sqrt(1.0 - steep * steep));
    let soft = 1.5 * pixel() / radius;
    // Patterns on the ball: a ring for the first player, stripes for the second, then dots.
    let player = i32(in.form.z) % 3;
    var pattern = 0.0;
    let polar = acos(clamp(normal.z, -1.0, 1.0));
    if player == 0 {
        pattern = 1.0 - smoothstep(0.10 - soft, 0.10 + soft, abs(polar - 0.72));
    } else if player == 1 {
        let across = asin(clamp(dot(normal.xy, vec2f(0.8, 0.6)), -1.0, 1.0));
        pattern = smoothstep(-soft * 6.0, soft * 6.0, sin(across * 9.0) - 0.25);
    } else {
        let turn = atan2(normal.y, normal.x) * 6.0 / 6.2831853;
        let petal = vec2f((fract(turn) - 0.5) * sin(polar) * 1.05, polar - 0.75);
        pattern = 1.0 - smoothstep(0.2 - soft, 0.2 + soft, length(petal));
    }
    let base = mix(to_linear(in.colour), vec3f(0.94, 0.95, 0.97), 0.9 * pattern);
    return shown(lacquered(base, normal, vec3f(0.0, 0.0, 1.0), 1.0), alpha);
}

// Dashes that march slowly around the border of the region.
fn dashes(at: vec2f, in: ShapeCorner) -> f32 {
    let place = select(at - in.from_to.xy, within(at, in.from_to, in.form.x), in.form.y == 1.0);
    var along = atan2(place.y, place.x) * in.form.x;
    if in.form.y == 1.0 {
        let beyond = abs(place) - in.from_to.zw;
        along = select(place.x * sign(place.y), -place.y * sign(place.x), beyond.x > beyond.y);
    } else if in.form.y == 0.0 {
        along = dot(place, normalize(in.from_to.zw - in.from_to.xy + vec2f(1e-6, 0.0)));
    }
    let dash = abs(fract(along / 0.07 - 0.25 * globals.tune.x) - 0.5) * 0.07;
    let line = vec2f(max(dash - 0.012, 0.0), distance_to(at, in));
    return 1.0 - smoothstep(0.006 - pixel(), 0.006 + pixel(), length(line));
}

@fragment
fn glow(in: ShapeCorner) -> @location(0) vec4f {
    let distance = distance_to(in.at, in);
    let breath = 0.5 + 0.5 * sin(BREATHS * globals.tune.x);
    let strength = 0.30 + 0.06 * breath + 0.3 * in.form.z;
    let edge = exp(-abs(distance) / 0.05);
    if distance > 0.0 {
        return shown(to_linear(in.colour), 1.6 * strength * edge * smoothstep(0.2, 0.1, distance));
    }
    let milk = mix(vec3f(1.0, 0.96, 0.85), to_linear(in.colour), 0.25 + 0.75 * edge);
    return shown(milk, strength * (1.2 + 0.4 * edge));
}

@fragment
fn border(in: ShapeCorner) -> @location(0) vec4f {
    return shown(to_linear(in.colour) * 0.72, 0.85 * dashes(in.at, in));
}

struct DotCorner {
    @builtin(position) clip: vec4f,
    @location(0) place: vec2f,
    @location(1) @interpolate(flat) colour: vec4f,
}

@vertex
fn dot_corner(
    @builtin(vertex_index) index: u32,
    @location(0) at: vec2f,
    @location(1) radius: f32,
    @location(2) colour: vec4f,
) -> DotCorner {
    let place = vec2f(f32(index & 1u), f32(index >> 1u)) * 2.0 - 1.0;
    return DotCorner(to_clip(at + place * radius), place, colour);
}

@fragment
fn particle(in: DotCorner) -> @location(0) vec4f {
    let away = length(in.place);
    let shine = 1.0 + 0.35 * (1.0 - smoothstep(0.0, 0.6, length(in.place - vec2f(-0.3, 0.35))));
    return shown(to_linear(in.colour.rgb) * shine, in.colour.a * (1.0 - smoothstep(0.6, 1.0, away)));
}
