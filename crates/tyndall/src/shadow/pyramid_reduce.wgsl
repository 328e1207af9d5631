// Builds the levels of the pyramid, six a dispatch.

@group(2) @binding(0) var<uniform> pyramid: Pyramid;
@group(2) @binding(1) var<storage, read_write> pyramid_texels: array<vec2f>;

// Of the level above by rows, then by rows of that.
var<workgroup> pyramid_tile: array<vec2f, 256>;

fn pyramid_read(at: vec2u, face: u32) -> vec2f {
    if pyramid.first == 0u {
        let size = textureDimensions(shadow_map);
        let held = textureLoad(shadow_map, min(at, size - 1u), face, 0);
        return vec2f(select(held, 1.0 - held, light.standard_depth == 1u));
    }
    let level = pyramid.levels[pyramid.first - 1u];
    let texel = min(at, level.yz - 1u);
    return pyramid_texels[level.x + face * level.w + texel.y * level.y + texel.x];
}

fn pyramid_write(k: u32, at: vec2u, face: u32, value: vec2f) {
    let level = pyramid.levels[k - 1u];
    if all(at < level.yz) {
        pyramid_texels[level.x + face * level.w + at.y * level.y + at.x] = value;
    }
}

// Six levels over a square of 64 x 64 texels of the level that is read: a thread takes 4 x 4, and the rest is done
// in common.
@compute @workgroup_size(16, 16)
fn pyramid_reduce(
    @builtin(workgroup_id) group: vec3u,
    @builtin(local_invocation_id) id: vec3u,
    @builtin(local_invocation_index) index: u32,
) {
    let face = group.z;
    let at = 16u * group.xy + id.xy;
    var whole = vec2f(1e30, -1e30);
    for (var i = 0u; i < 4u; i++) {
        let half_at = 2u * at + vec2u(i & 1u, i >> 1u);
        var half = vec2f(1e30, -1e30);
        for (var j = 0u; j < 4u; j++) {
            half = pyramid_unite(half, pyramid_read(2u * half_at + vec2u(j & 1u, j >> 1u), face));
        }
        pyramid_write(pyramid.first + 1u, half_at, face, half);
        whole = pyramid_unite(whole, half);
    }
    pyramid_write(pyramid.first + 2u, at, face, whole);
    pyramid_tile[index] = whole;
    for (var k = 1u; k <= 4u; k++) {
        workgroupBarrier();
        let stride = 1u << (k - 1u);
        let first = (id.xy & vec2u(15u >> k)) << vec2u(k);
        let is_mine = all(id.xy < vec2u(16u >> k));
        var value = vec2f(0.0);
        if is_mine {
            for (var j = 0u; j < 4u; j++) {
                let source = first + stride * vec2u(j & 1u, j >> 1u);
                let other = pyramid_tile[16u * source.y + source.x];
                value = select(pyramid_unite(value, other), other, j == 0u);
            }
        }
        workgroupBarrier();
        if is_mine {
            pyramid_tile[16u * first.y + first.x] = value;
            pyramid_write(pyramid.first + 2u + k, (group.xy << vec2u(4u - k)) + id.xy, face, value);
        }
    }
}
