// Stages 1 and 3: linear depth and the coordinate texture. A sample's place follows from its slice's line; what is kept is
// the view depth there [m], -1 where it lies outside the picture.

@group(2) @binding(1) var<storage, read> coordinates_lines: array<ScreenLine>;
@group(2) @binding(2) var<storage, read_write> coordinates_depth: array<f32>;

@compute @workgroup_size(64)
fn coordinates(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= sampling.samples {
        return;
    }
    let line = coordinates_lines[id.y];
    let place = line.entry + f32(id.x) * line.step;
    let size = frame.camera.size;
    // A thousandth of a pixel for rounding.
    let margin = SCREEN_MARGIN + 1e-3;
    var depth = -1.0;
    if any(line.step != vec2f(0.0)) && all(place >= vec2f(-margin)) && all(place <= size + margin) {
        let pixel = vec2u(clamp(place, vec2f(0.0), size - 1.0));
        depth = sampling_view_depth(pixel);
    }
    coordinates_depth[id.y * sampling.samples + id.x] = depth;
}
