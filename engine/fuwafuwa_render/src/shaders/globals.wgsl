// Uniforms of every 2D shader. Positions are in metres, colours in sRGB.
struct Globals {
    // Right and up directions of the camera in the world.
    axes: vec4f,
    // Centre of the view [m], its height [m], its aspect ratio (width / height).
    view: vec4f,
    // Sizes of the intermediate images and of the window's target [px].
    size: vec4f,
    // Clock [s]; number of walls; 1 if the target takes linear light; 1 if skins are shown.
    tune: vec4f,
    // Radius of the largest body [m]; standard deviation of the narrow and of the wide blur [m].
    scale: vec4f,
    floor_middle: vec4f,
    floor_rim: vec4f,
    frame: vec4f,
    fresh: vec4f,
    // Low and high corner of the bounding box of all bodies.
    bounds: vec4f,
    // Outward normal and offset of half-spaces.
    walls: array<vec4f, 16>,
}
@group(0) @binding(0) var<uniform> globals: Globals;

// Angular speed of the basket's pulsing glow [rad/s]: five cycles in the 16 s period of the clock.
const BREATHS = 1.9634954;
const LIGHT = vec3f(-0.47, 0.62, 0.63);

// Converts a world point to clip coordinates, -1 to 1.
fn to_clip(at: vec2f) -> vec4f {
    let by = at - globals.view.xy;
    let seen = vec2f(dot(by, globals.axes.xy), dot(by, globals.axes.zw));
    return vec4f(seen * 2.0 / (globals.view.z * vec2f(globals.view.w, 1.0)), 0.0, 1.0);
}

fn to_world(clip: vec2f) -> vec2f {
    let seen = clip * 0.5 * globals.view.z * vec2f(globals.view.w, 1.0);
    return globals.view.xy + globals.axes.xy * seen.x + globals.axes.zw * seen.y;
}
