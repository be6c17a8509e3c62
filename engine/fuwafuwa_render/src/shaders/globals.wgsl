// What every shader knows. Places are in metres, colours as a screen takes them (sRGB).
struct Globals {
    // What is to the right and what is up in the world.
    axes: vec4f,
    // The middle of the view, its height [m], its width over its height.
    view: vec4f,
    // The targets off the screen and the target of the window [px].
    size: vec4f,
    // Seconds, count of walls, 1 if the target wants linear light, 1 if skins are to be seen.
    tune: vec4f,
    // Radius of the largest body [m]; standard deviation of the narrow and of the wide blur [m].
    scale: vec4f,
    floor_middle: vec4f,
    floor_rim: vec4f,
    frame: vec4f,
    fresh: vec4f,
    // Low and high corner of all bodies.
    bounds: vec4f,
    // Outward normal and offset of half-spaces.
    walls: array<vec4f, 16>,
}
@group(0) @binding(0) var<uniform> globals: Globals;

// Five breaths in the sixteen seconds after which the clock begins anew [rad/s].
const BREATHS = 1.9634954;
const LIGHT = vec3f(-0.47, 0.62, 0.63);

// To the coordinates of the picture, -1 to 1.
fn to_clip(at: vec2f) -> vec4f {
    let by = at - globals.view.xy;
    let seen = vec2f(dot(by, globals.axes.xy), dot(by, globals.axes.zw));
    return vec4f(seen * 2.0 / (globals.view.z * vec2f(globals.view.w, 1.0)), 0.0, 1.0);
}

fn to_world(clip: vec2f) -> vec2f {
    let seen = clip * 0.5 * globals.view.z * vec2f(globals.view.w, 1.0);
    return globals.view.xy + globals.axes.xy * seen.x + globals.axes.zw * seen.y;
}
