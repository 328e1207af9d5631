// Sets every word of a buffer.

struct Fill {
    value: u32,
}

@group(2) @binding(0) var<uniform> fill: Fill;
@group(2) @binding(1) var<storage, read_write> fill_target: array<vec4u>;

@compute @workgroup_size(64)
fn fill_words(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let stride = 64u * groups.x;
    for (var i = id.x; i < arrayLength(&fill_target); i += stride) {
        fill_target[i] = vec4u(fill.value);
    }
}
