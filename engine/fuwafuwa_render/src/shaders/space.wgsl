// Uniforms of every 3D shader. Positions are in metres, colours in sRGB.
struct Globals {
    to_clip: mat4x4f,
    // To the shadow map, and to the sky map.
    to_light: mat4x4f,
    to_sky: mat4x4f,
    // Position of the camera.
    eye: vec4f,
    // Target point of the camera, and its distance.
    look: vec4f,
    // Clock [s]; number of walls; 0, because the image is not in linear light; number of hands.
    tune: vec4f,
    // Size of the image [px].
    size: vec4f,
    // For the shadow and the sky map: texel width [m]; shadow softness as a fraction of the map.
    soft: vec4f,
    floor_middle: vec4f,
    floor_rim: vec4f,
    frame: vec4f,
    fresh: vec4f,
    // Centres and radii of the hands.
    hands: array<vec4f, 4>,
    hand_colours: array<vec4f, 4>,
    // Outward normal and offset of half-spaces.
    walls: array<vec4f, 16>,
}
@group(0) @binding(0) var<uniform> globals: Globals;

// Angular speed of the basket's pulsing glow [rad/s]: five cycles in the 16 s period of the clock.
const BREATHS = 1.9634954;
const LIGHT = vec3f(-0.42, 0.80, 0.45);
