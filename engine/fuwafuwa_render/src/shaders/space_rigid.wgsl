// Floor, walls, and everything drawn as a stretched ball: bars, hands, crumbs, dust, lines, the basket.
struct RoomCorner {
    @builtin(position) clip: vec4f,
    @location(0) at: vec3f,
    @location(1) normal: vec3f,
}

@vertex
fn room_corner(@location(0) at: vec3f, @location(1) normal: vec3f) -> RoomCorner {
    return RoomCorner(globals.to_clip * vec4f(at, 1.0), at, normal);
}

@fragment
fn room(in: RoomCorner) -> @location(0) vec4f {
    let normal = normalize(in.normal);
    let away = length(in.at - globals.look.xyz) / globals.look.w;
    let is_floor = normal.y > 0.7;
    let rim = smoothstep(0.05, 0.75, away);
    var light = to_linear(mix(globals.floor_middle.rgb, globals.floor_rim.rgb, rim));
    if is_floor {
        // Dots on a grid make motion visible. In worlds viewed closely (camera distance up to 1 m) they are
        // ten times denser.
        let unit = select(0.1, 1.0, globals.look.w > 1.0);
        let across = in.at.xz / unit;
        let grid = abs(fract(across / 0.125) - 0.5) * 0.125;
        let pixel = clamp(fwidth(across.x) + fwidth(across.y), 1e-5, 0.05);
        let dots = 1.0 - smoothstep(0.006 - pixel, 0.006 + pixel, length(grid));
        light *= 1.0 - 0.22 * dots * clamp(0.008 / pixel, 0.0, 1.0);
    } else {
        light = mix(light, to_linear(globals.frame.rgb), 0.10) * mix(0.92, 1.0, 0.5 + 0.5 * dot(normal, normalize(LIGHT)));
    }
    // Corners of the room are a little darker.
    for (var k = 0; k < i32(globals.tune.y); k++) {
        let wall = globals.walls[k];
        let near = max(dot(wall.xyz, in.at) - wall.w, 0.0);
        let other = 1.0 - abs(dot(wall.xyz, normal));
        light *= 1.0 - 0.20 * other * exp(-near / 0.09);
    }
    let facing = smoothstep(-0.1, 0.25, dot(normal, normalize(LIGHT)));
    let open = mix(1.0, open_to_light(in.at, normal), facing);
    light *= mix(vec3f(0.62, 0.60, 0.72), vec3f(1.0), open);
    light *= mix(vec3f(0.66, 0.60, 0.66), vec3f(1.0), open_to_sky(in.at, normal));
    light = under_hands(light, in.at, normal);
    // Distant parts and high walls fade into the background.
    let above = (in.at.y - globals.look.y) / globals.look.w;
    let gone = max(smoothstep(0.7, 1.7, away), select(smoothstep(0.04, 0.32, above), 0.0, is_floor));
    return shown(mix(light, background(in.clip.xy), gone), 1.0);
}

@vertex
fn sky_corner(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    return vec4f(covering(index), 1.0, 1.0);
}

@fragment
fn sky(@builtin(position) pixel: vec4f) -> @location(0) vec4f {
    return shown(background(pixel.xy), 1.0);
}

struct Instance {
    // Centre of the instance and radius of its edges.
    @location(2) centre: vec4f,
    @location(3) first: vec3f,
    @location(4) second: vec3f,
    @location(5) third: vec3f,
    @location(6) half_size: vec3f,
    @location(7) colour: vec4f,
    @location(8) number: f32,
}

struct RoundedCorner {
    @builtin(position) clip: vec4f,
    @location(0) at: vec3f,
    @location(1) normal: vec3f,
    // Position along the axes of the instance, and half its extent along them.
    @location(2) own: vec3f,
    @location(3) @interpolate(flat) reach: vec3f,
    @location(4) @interpolate(flat) colour: vec4f,
    @location(5) @interpolate(flat) number: f32,
    // Normal along the axes of the instance.
    @location(6) own_normal: vec3f,
}

fn corner_of(normal: vec3f, eighth: vec3f, instance: Instance, radius: f32) -> RoundedCorner {
    let axes = mat3x3f(instance.first, instance.second, instance.third);
    let own = eighth * instance.half_size + radius * normal;
    let at = instance.centre.xyz + axes * own;
    return RoundedCorner(
        globals.to_clip * vec4f(at, 1.0), at, axes * normal, own,
        instance.half_size + instance.centre.w, instance.colour, instance.number, normal,
    );
}

@vertex
fn plain_corner(@location(0) normal: vec3f, @location(1) eighth: vec3f, instance: Instance) -> RoundedCorner {
    return corner_of(normal, eighth, instance, instance.centre.w);
}

// The instance number makes every rough ball look different.
@vertex
fn rough_corner(@location(0) normal: vec3f, @location(1) eighth: vec3f, instance: Instance) -> RoundedCorner {
    let bump = noise3(1.9 * normal + 7.7 * instance.number) - 0.5;
    return corner_of(normal, eighth, instance, instance.centre.w * (1.0 + 0.45 * bump));
}

fn in_light(colour: vec3f, at: vec3f, normal: vec3f) -> vec3f {
    let facing = smoothstep(-0.1, 0.25, dot(normal, normalize(LIGHT)));
    let open = mix(1.0, open_to_light(at, normal), facing);
    return colour * mix(vec3f(0.55, 0.53, 0.62), vec3f(1.0), open) * from_around(at, normal);
}

@fragment
fn bar(in: RoundedCorner) -> @location(0) vec4f {
    let normal = normalize(in.normal);
    // Wood rings run along the longest axis.
    let longest = max(in.reach.x, max(in.reach.y, in.reach.z));
    var wood = in.own.zxy;
    if in.reach.x == longest {
        wood = in.own;
    } else if in.reach.y == longest {
        wood = in.own.yzx;
    }
    let wave = 0.03 * noise3(wood * vec3f(4.0, 7.0, 7.0));
    let rings = noise(vec2f(wood.x * 2.5, 60.0 * (length(wood.yz + 0.03) + wave))) * 0.65
        + noise3(wood * vec3f(9.0, 150.0, 150.0)) * 0.35;
    // A curtain hangs in folds.
    let across = in.own.x + in.own.z;
    let folds = 0.5 + 0.5 * sin(60.0 * across + 4.0 * noise(vec2f(3.0 * across, 2.0 * in.own.y)));
    let stuff = select(mix(0.82, 1.12, rings), mix(0.62, 1.1, folds), in.number > 0.5);
    let base = to_linear(in.colour.rgb) * stuff;
    let lit = lacquered(base, normal, towards_eye(in.at), select(0.35, 0.1, in.number > 0.5));
    return shown(under_hands(in_light(lit, in.at, normal), in.at, normal), in.colour.a);
}

// Distance of a point on the surface of a box from the nearest edge. The smallest component of its distance from the
// faces is 0; the middle one belongs to the edge, which runs along the axis of the largest one.
fn to_edge(beyond: vec3f) -> f32 {
    let least = min(beyond.x, min(beyond.y, beyond.z));
    let most = max(beyond.x, max(beyond.y, beyond.z));
    return beyond.x + beyond.y + beyond.z - least - most;
}

// A pane with bright edges.
@fragment
fn glass(in: RoundedCorner) -> @location(0) vec4f {
    let away = 1.0 - abs(dot(normalize(in.normal), towards_eye(in.at)));
    let edge = 1.0 - smoothstep(0.008, 0.02, to_edge(in.reach - abs(in.own)));
    let colour = mix(to_linear(in.colour.rgb), vec3f(1.0), 0.3 * edge);
    return shown(colour, max(0.14 + 0.4 * smoothstep(0.55, 0.95, away), 0.75 * edge));
}

@fragment
fn hand(in: RoundedCorner) -> @location(0) vec4f {
    let normal = normalize(in.normal);
    // Patterns as in 2D: a ring for the first player, stripes for the second, then dots.
    let up = in.own_normal.y;
    let soft = 1.5 * fwidth(up) + 0.002;
    let player = i32(in.number) % 3;
    var pattern = 1.0 - smoothstep(0.075 - soft, 0.075 + soft, abs(up - 0.62));
    if player == 1 {
        pattern = smoothstep(-soft * 9.0, soft * 9.0, sin(up * 11.0) - 0.25);
    } else if player == 2 {
        let turn = atan2(in.own_normal.z, in.own_normal.x) * 6.0 / 6.2831853;
        let petal = vec2f((fract(turn) - 0.5) * 1.05, up - 0.6);
        pattern = 1.0 - smoothstep(0.2 - soft, 0.2 + soft, length(petal));
    }
    let base = mix(to_linear(in.colour.rgb), vec3f(0.94, 0.95, 0.97), 0.9 * pattern);
    let lit = lacquered(base, normal, towards_eye(in.at), 0.9);
    return shown(lit * mix(0.80, 1.0, 0.5 + 0.5 * normal.y), 1.0);
}

// Silhouette of a hand behind other objects, so that its position stays visible.
@fragment
fn hidden_hand(in: RoundedCorner) -> @location(0) vec4f {
    let away = 1.0 - abs(dot(normalize(in.normal), towards_eye(in.at)));
    return shown(to_linear(in.colour.rgb), 0.10 + 0.55 * smoothstep(0.55, 0.95, away));
}

fn rough_normal(in: RoundedCorner) -> vec3f {
    return normalize(normalize(in.normal) + 0.35 * rough3(2.6 * in.own_normal + 5.3 * in.number));
}

@fragment
fn crumb(in: RoundedCorner) -> @location(0) vec4f {
    let colour = flesh(to_linear(in.colour.rgb), 0.6, 0.0, in.at, rough_normal(in), normalize(in.normal));
    return shown(colour, 1.0);
}

@fragment
fn dust(in: RoundedCorner) -> @location(0) vec4f {
    let normal = rough_normal(in);
    let colour = to_linear(in.colour.rgb) * mix(0.75, 1.1, around(normal));
    return shown(colour, in.colour.a);
}

@fragment
fn line(in: RoundedCorner) -> @location(0) vec4f {
    // Dashed line from the hand to the ground.
    let dash = abs(fract(in.at.y / 0.06) - 0.5);
    let alpha = 1.0 - smoothstep(0.26, 0.30, dash);
    return shown(to_linear(in.colour.rgb), 0.7 * alpha);
}

@fragment
fn glow(in: RoundedCorner, @builtin(front_facing) is_front: bool) -> @location(0) vec4f {
    let beyond = in.reach - abs(in.own);
    let most = max(beyond.x, max(beyond.y, beyond.z));
    let edge = to_edge(beyond);
    let breath = 0.5 + 0.5 * sin(BREATHS * globals.tune.x);
    let strength = 0.10 + 0.03 * breath + 0.22 * in.number;
    var along = in.own.x;
    if beyond.y == most {
        along = in.own.y;
    } else if beyond.z == most {
        along = in.own.z;
    }
    let dash = abs(fract(along / 0.07 - 0.25 * globals.tune.x) - 0.5);
    let border = (1.0 - smoothstep(0.008, 0.012, edge)) * (1.0 - smoothstep(0.28, 0.32, dash));
    // Front faces are transparent, so that the inside is visible.
    let alpha = strength * (select(0.6, 0.0, is_front) + 1.5 * exp(-edge / 0.05));
    let colour = to_linear(in.colour.rgb);
    return shown(mix(mix(vec3f(1.0, 0.96, 0.85), colour, 0.7), 0.72 * colour, border), max(alpha, 0.85 * border));
}
