// Stage 6: each slice's trace in the shadow map.

@group(2) @binding(1) var<storage, read> directions_lines: array<ScreenLine>;
@group(2) @binding(2) var<storage, read_write> directions_traces: array<Trace>;

@compute @workgroup_size(64)
fn slice_directions(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= sampling.slices {
        return;
    }
    let border = screen_slice_border(sampling.arc, sampling.slices, id.x);
    let exit = screen_exit(frame.camera.size, border);
    var trace = trace_slice(exit, screen_direction(sampling.epipole, exit), sampling.axis);
    if all(directions_lines[id.x].step == vec2f(0.0)) {
        trace.columns = vec2u(0u);
    }
    directions_traces[id.x] = trace;
}
