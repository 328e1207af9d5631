// Which blocks of the glass map hold any tint: most of a map holds none, and a walk passes over it block by block.

const LIGHT_VOLUME_BLOCK: u32 = 32u; // texels a side

@group(2) @binding(0) var<storage, read_write> light_volume_panes: array<u32>; // a face's blocks row by row

var<workgroup> light_volume_is_tinted: atomic<u32>;

@compute @workgroup_size(8, 8)
fn light_volume_find_panes(
    @builtin(workgroup_id) block: vec3u,
    @builtin(num_workgroups) blocks: vec3u,
    @builtin(local_invocation_id) place: vec3u,
) {
    let size = textureDimensions(shadow_glass);
    let first = LIGHT_VOLUME_BLOCK * block.xy + place.xy;
    var is_tinted = false;
    for (var y = first.y; y < min(LIGHT_VOLUME_BLOCK * (block.y + 1u), size.y); y += 8u) {
        for (var x = first.x; x < min(LIGHT_VOLUME_BLOCK * (block.x + 1u), size.x); x += 8u) {
            for (var layer = 0u; layer < shadow_glass_layers(); layer++) {
                let glass = textureLoad(shadow_glass, vec2u(x, y), block.z * shadow_glass_layers() + layer, 0);
                is_tinted |= (glass.y & 0x3fffffffu) != 0x3fffffffu;
            }
        }
    }
    atomicOr(&light_volume_is_tinted, u32(is_tinted));
    workgroupBarrier();
    if all(place.xy == vec2u(0u)) {
        light_volume_panes[(block.z * blocks.y + block.y) * blocks.x + block.x] = atomicLoad(&light_volume_is_tinted);
    }
}
