// What coloured glass takes from a ray: the ray walked through the glass map, block by block and, where a block holds
// any tint, texel by texel.

const LIGHT_VOLUME_BLOCK: u32 = 32u; // as in panes.wgsl

@group(2) @binding(2) var<storage, read> light_volume_panes: array<u32>;

// A ray's stretch in a face's clip space, c0 + s c1.
struct LightVolumeWalk {
    face: u32,
    c0: vec4f,
    c1: vec4f,
    span: vec2f,
}

// A ray's way over a grid on the face: the cell it is in, and whither it goes.
struct LightVolumeCell {
    index: vec2i,
    way: vec2i,
    count: vec2f, // cells a side
}

// In clip space: of a single map its own; of a cube's face what is linear in the point, see `light.cube_depth`.
fn light_volume_face_clip(face: u32, p: vec4f) -> vec4f {
    if SHADOW_KIND != SHADOW_CUBE {
        return p;
    }
    let axis = light_volume_cube_direction(face, vec2f(0.0));
    let right = light_volume_cube_direction(face, vec2f(1.0, 0.0)) - axis;
    let down = light_volume_cube_direction(face, vec2f(0.0, 1.0)) - axis;
    let w = dot(axis, p.xyz);
    let z = light.cube_depth.x * p.w + light.cube_depth.y * w;
    return vec4f(dot(right, p.xyz), -dot(down, p.xyz), z, w);
}

// Cuts a span to where constant + s slope >= 0.
fn light_volume_cut(span: vec2f, constant: f32, slope: f32) -> vec2f {
    if slope == 0.0 {
        return select(span.xx, span, constant >= 0.0);
    }
    let crossing = -constant / slope;
    return select(
        vec2f(span.x, min(span.y, crossing)),
        vec2f(max(span.x, crossing), span.y),
        slope > 0.0,
    );
}

fn light_volume_walk(ray: Ray, face: u32) -> LightVolumeWalk {
    let in_map = shadow_ray(ray);
    let c0 = light_volume_face_clip(face, in_map.c0);
    let c1 = light_volume_face_clip(face, in_map.c1);
    var span = light_reach(ray);
    span = light_volume_cut(span, c0.w - c0.x, c1.w - c1.x);
    span = light_volume_cut(span, c0.w + c0.x, c1.w + c1.x);
    span = light_volume_cut(span, c0.w - c0.y, c1.w - c1.y);
    span = light_volume_cut(span, c0.w + c0.y, c1.w + c1.y);
    return LightVolumeWalk(face, c0, c1, span);
}

// The place on the face, in cells.
fn light_volume_cell_place(walk: LightVolumeWalk, count: vec2f, s: f32) -> vec2f {
    let p = walk.c0 + s * walk.c1;
    return (0.5 + vec2f(0.5, -0.5) * p.xy / max(p.w, 1e-30)) * count;
}

fn light_volume_enter(walk: LightVolumeWalk, count: vec2f, s: f32) -> LightVolumeCell {
    let turn = walk.c1.xy * walk.c0.w - walk.c0.xy * walk.c1.w;
    let place = floor(light_volume_cell_place(walk, count, s));
    let index = vec2i(clamp(place, vec2f(0.0), count - 1.0));
    return LightVolumeCell(index, vec2i(sign(turn * vec2f(1.0, -1.0))), count);
}

// Where the ray leaves its cell, sideways (x) and upwards or downwards (y), not before s.
fn light_volume_leave(walk: LightVolumeWalk, cell: LightVolumeCell, s: f32) -> vec2f {
    let border = vec2f(cell.index + max(cell.way, vec2i(0)));
    let k = vec2f(2.0, -2.0) * border / cell.count - vec2f(1.0, -1.0);
    let slope = walk.c1.xy - k * walk.c1.w;
    let crossing = (k * walk.c0.w - walk.c0.xy) / slope;
    // Behind the light lie the borders that the ray only tends to.
    let is_before_light = walk.c0.w + crossing * walk.c1.w > vec2f(0.0);
    let is_crossed = cell.way != vec2i(0) & slope != vec2f(0.0) & is_before_light;
    return select(vec2f(1e30), max(crossing, vec2f(s)), is_crossed);
}

fn light_volume_step(cell: LightVolumeCell, leave: vec2f) -> vec2i {
    return cell.index + select(vec2i(0, cell.way.y), vec2i(cell.way.x, 0), leave.x <= leave.y);
}

fn light_volume_is_on(cell: LightVolumeCell) -> bool {
    return all(cell.index >= vec2i(0)) && all(vec2f(cell.index) < cell.count);
}

// The light that glass adds to a ray: none, or less than none.
fn light_volume_glass(ray: Ray) -> vec3f {
    var sum = vec3f(0.0);
    for (var face = 0u; face < select(1u, 6u, SHADOW_KIND == SHADOW_CUBE); face++) {
        let walk = light_volume_walk(ray, face);
        if walk.span.x < walk.span.y {
            sum += light_volume_face_glass(ray, walk);
        }
    }
    return sum;
}

fn light_volume_face_glass(ray: Ray, walk: LightVolumeWalk) -> vec3f {
    let size = vec2f(textureDimensions(shadow_glass));
    let count = ceil(size / f32(LIGHT_VOLUME_BLOCK));
    // Blocks may end beyond the map.
    let scale = size / f32(LIGHT_VOLUME_BLOCK);
    var blocks = light_volume_enter(walk, scale, walk.span.x);
    var s = walk.span.x;
    var sum = vec3f(0.0);
    for (var i = 0.0; i <= count.x + count.y && s < walk.span.y && light_volume_is_on(blocks); i += 1.0) {
        let leave = light_volume_leave(walk, blocks, s);
        let end = min(min(leave.x, leave.y), walk.span.y);
        let block = vec2u(blocks.index);
        let index = (walk.face * u32(count.y) + block.y) * u32(count.x) + block.x;
        if end > s && light_volume_panes[index] != 0u {
            sum += light_volume_block_glass(ray, LightVolumeWalk(walk.face, walk.c0, walk.c1, vec2f(s, end)));
        }
        blocks.index = light_volume_step(blocks, leave);
        s = end;
    }
    return sum;
}

fn light_volume_block_glass(ray: Ray, walk: LightVolumeWalk) -> vec3f {
    let count = vec2f(textureDimensions(shadow_glass));
    var texels = light_volume_enter(walk, count, walk.span.x);
    var s = walk.span.x;
    var sum = vec3f(0.0);
    for (var i = 0u; i <= 2u * LIGHT_VOLUME_BLOCK + 2u && s < walk.span.y && light_volume_is_on(texels); i++) {
        let leave = light_volume_leave(walk, texels, s);
        let end = min(min(leave.x, leave.y), walk.span.y);
        if end > s {
            sum += light_volume_texel_glass(ray, walk, vec2u(texels.index), vec2f(s, end));
        }
        texels.index = light_volume_step(texels, leave);
        s = end;
    }
    return sum;
}

fn light_volume_texel_glass(ray: Ray, walk: LightVolumeWalk, texel: vec2u, span: vec2f) -> vec3f {
    let middle = light_volume_cell_place(walk, vec2f(1.0), 0.5 * (span.x + span.y));
    let map_size = vec2f(textureDimensions(shadow_map));
    let map_texel = vec2u(clamp(middle * map_size, vec2f(0.0), map_size - 1.0));
    let held = textureLoad(shadow_map, map_texel, walk.face, 0);
    var sum = vec3f(0.0);
    var s = span.x;
    // A stretch ends where the shadow begins or a pane is passed.
    for (var i = 0u; i <= shadow_glass_layers() + 1u && s < span.y; i++) {
        var end = min(span.y, shadow_next_depth(walk.c0.zw, walk.c1.zw, held, s));
        end = min(end, shadow_glass_next(texel, walk.face, walk.c0.zw, walk.c1.zw, s));
        let p = walk.c0 + 0.5 * (s + end) * walk.c1;
        let depth = p.z / max(p.w, 1e-30);
        if shadow_reaches(depth, held) {
            let tint = shadow_glass_texel_tint(texel, walk.face, depth);
            if any(tint != vec3f(1.0)) {
                sum += (tint - 1.0) * stretch_short(ray, s, end);
            }
        }
        s = end;
    }
    return sum;
}
