// Stage 1: view depth of every pixel [m].

@group(2) @binding(1) var linear_depth_out: texture_storage_2d<r32float, write>;

@compute @workgroup_size(16, 8)
fn linear_depth(@builtin(global_invocation_id) id: vec3u) {
    if any(id.xy >= textureDimensions(linear_depth_out)) {
        return;
    }
    let depth = camera_view_depth(textureLoad(frame_depth, id.xy, 0));
    textureStore(linear_depth_out, id.xy, vec4f(depth, 0.0, 0.0, 0.0));
}
