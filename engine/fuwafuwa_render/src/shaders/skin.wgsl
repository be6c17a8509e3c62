// Draws bodies into two images: colour with coverage; thickness, freshness and strain.
struct Images {
    @location(0) colour: vec4f,
    @location(1) relief: vec4f,
}

struct SkinCorner {
    @builtin(position) clip: vec4f,
    @location(0) colour: vec4f,
    @location(1) relief: vec4f,
}

@vertex
fn skin_corner(@location(0) at: vec2f, @location(1) colour: vec4f, @location(2) relief: vec4f) -> SkinCorner {
    return SkinCorner(to_clip(at), colour, relief);
}

@fragment
fn skin(in: SkinCorner) -> Images {
    return Images(
        vec4f(in.colour.rgb * in.colour.a, in.colour.a),
        vec4f(in.relief.rgb * in.relief.a, in.relief.a),
    );
}

struct ElementCorner {
    @builtin(position) clip: vec4f,
    @location(0) line: vec2f,
    @location(1) colour: vec4f,
}

@vertex
fn element_corner(
    @location(0) at: vec2f,
    @location(1) across: vec2f,
    @location(2) line: vec2f,
    @location(3) colour: vec4f,
) -> ElementCorner {
    let pixel = globals.view.z / globals.size.y;
    return ElementCorner(to_clip(at + across * pixel), line, colour);
}

@fragment
fn element(in: ElementCorner) -> Images {
    let alpha = in.colour.a * clamp(in.line.y + 0.5 - abs(in.line.x), 0.0, 1.0);
    return Images(vec4f(in.colour.rgb * alpha, alpha), vec4f(alpha, 0.0, 0.0, alpha));
}
