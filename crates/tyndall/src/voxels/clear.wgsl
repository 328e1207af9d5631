// Sets every word of a buffer.

struct VoxelClear {
    value: u32,
}

@group(2) @binding(0) var<uniform> voxel_clear: VoxelClear;
@group(2) @binding(1) var<storage, read_write> voxel_words: array<vec4u>;

@compute @workgroup_size(64)
fn voxel_clear_words(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let stride = 64u * groups.x;
    for (var i = id.x; i < arrayLength(&voxel_words); i += stride) {
        voxel_words[i] = vec4u(voxel_clear.value);
    }
}
