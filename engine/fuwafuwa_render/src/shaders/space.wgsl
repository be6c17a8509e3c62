// What every shader of space knows. Places are in metres, colours as a screen takes them (sRGB).
struct Globals {
    to_clip: mat4x4f,
    // To the shadow map, and to the map of what is open to the sky.
    to_light: mat4x4f,
    to_sky: mat4x4f,
    // Where the camera is.
    eye: vec4f,
    // What it looks at, and how far that is.
    look: vec4f,
    // Seconds, count of walls, 0: the image is not in linear light, count of hands.
    tune: vec4f,
    // Size of the image [px].
    size: vec4f,
    // Of both maps: width of a texel [m]; how soft its shadows are, as a share of the map.
    soft: vec4f,
    floor_middle: vec4f,
    floor_rim: vec4f,
    frame: vec4f,
    fresh: vec4f,
    // Middle and radius of the hands.
    hands: array<vec4f, 4>,
    hand_colours: array<vec4f, 4>,
    // Outward normal and offset of half-spaces.
    walls: array<vec4f, 16>,
}
@group(0) @binding(0) var<uniform> globals: Globals;

// Five breaths in the sixteen seconds after which the clock begins anew [rad/s].
const BREATHS = 1.9634954;
const LIGHT = vec3f(-0.42, 0.80, 0.45);
