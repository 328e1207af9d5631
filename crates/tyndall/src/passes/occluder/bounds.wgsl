// Rasterises the listed pieces of the shadow volumes' boundaries, so that nothing is missed: where a piece meets a tile at
// all, the tile's bounds hold all depths at which it does.
//
// Pieces are flat and convex, with corners in homogeneous coordinates: they reach to infinity and behind the eye, and are
// never clipped (Olano and Greer, Triangle Scan Conversion using 2D Homogeneous Coordinates, 1997). What a rectangle of the
// screen holds of one is spanned by its edges within the rectangle and by those of the rectangle's corners that lie in it.

@group(2) @binding(4) var<storage, read> bounds_list: array<vec2u>; // an element's index and its place's
@group(2) @binding(5) var<storage, read> bounds_counts: array<u32>; // of walls and caps, run by run

const BOUNDS_LANES: u32 = 16u;
// Listed pieces that a workgroup takes at a time.
const BOUNDS_BATCH: u32 = 64u;
// Rows of tiles that an invocation walks alone; of larger pieces each takes some of the rows.
const BOUNDS_ALONE: u32 = 4u;
// Rounding of corners on the screen, over the largest of a piece.
const BOUNDS_ROUNDING: f32 = 1e-6;
// Room about a tile [pixels].
const BOUNDS_ROOM: f32 = 1.0 / 64.0;

const BOUNDS_WALLS: u32 = 0u;
const BOUNDS_CAPS: u32 = 1u;
const BOUNDS_FAR_CAPS: u32 = 2u;

struct BoundsPiece {
    corners: array<vec4f, 4>, // see occluder_on_screen; triangles end where they began
    edges: array<vec3f, 4>, // planes through the eye: dot(edge, (x, y, 1)) >= 0 inside; triangles have three
    key: vec3f, // q / w at (x, y) is dot(key, (x, y, 1)), unless it is off by more than
    key_off: f32,
    rounding: vec2f, // of x, y and of w
    facing: vec2<bool>, // see occluder_facing
    // What is wider than high has x and y exchanged, so that rows are short.
    size: vec2f, // of the picture [pixels]
    strides: vec2u, // between tiles of a row and between rows
    rows: vec2u, // of tiles that it meets: the first, and the one behind the last
}

// What a rectangle holds of a piece: places [pixels] and keys q / w.
struct BoundsExtent {
    least: vec3f,
    most: vec3f,
}

var<workgroup> bounds_lit: array<u32, BOUNDS_BATCH>; // pieces that are not in the shadow of others
var<workgroup> bounds_lit_count: atomic<u32>;
var<workgroup> bounds_long: array<u32, BOUNDS_BATCH>; // those of many rows
var<workgroup> bounds_long_count: atomic<u32>;

@compute @workgroup_size(16)
fn bounds_walls(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) lane: u32,
) {
    bounds_all(BOUNDS_WALLS, bounds_counts[occluder_params.counts], group.x, groups.x, lane);
}

@compute @workgroup_size(16)
fn bounds_caps(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) lane: u32,
) {
    bounds_all(BOUNDS_CAPS, bounds_counts[occluder_params.counts + 1u], group.x, groups.x, lane);
}

@compute @workgroup_size(16)
fn bounds_far_caps(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) lane: u32,
) {
    bounds_all(BOUNDS_FAR_CAPS, 12u * occluder_params.places, group.x, groups.x, lane);
}

// All pieces of a kind, in batches: first those are left that are not in the shadow of others; then each invocation takes
// some of few rows, and all together those of many.
fn bounds_all(kind: u32, count: u32, group: u32, groups: u32, lane: u32) {
    for (var first = group * BOUNDS_BATCH; first < count; first += groups * BOUNDS_BATCH) {
        if lane == 0u {
            atomicStore(&bounds_lit_count, 0u);
            atomicStore(&bounds_long_count, 0u);
        }
        workgroupBarrier();
        for (var index = first + lane; index < min(first + BOUNDS_BATCH, count); index += BOUNDS_LANES) {
            if !bounds_is_shaded(kind, index) {
                bounds_lit[atomicAdd(&bounds_lit_count, 1u)] = index;
            }
        }
        workgroupBarrier();
        let lit = atomicLoad(&bounds_lit_count);
        for (var i = lane; i < lit; i += BOUNDS_LANES) {
            let piece = bounds_piece(kind, bounds_lit[i]);
            let is_long = piece.rows.y > piece.rows.x + BOUNDS_ALONE;
            for (var row = piece.rows.x; row < select(piece.rows.y, 0u, is_long); row++) {
                bounds_row(piece, row);
            }
            if is_long {
                bounds_long[atomicAdd(&bounds_long_count, 1u)] = bounds_lit[i];
            }
        }
        workgroupBarrier();
        let long = atomicLoad(&bounds_long_count);
        for (var i = 0u; i < long; i++) {
            let piece = bounds_piece(kind, bounds_long[i]);
            for (var row = piece.rows.x + lane; row < piece.rows.y; row += BOUNDS_LANES) {
                bounds_row(piece, row);
            }
        }
        workgroupBarrier();
    }
}

// Caps are small: to ask would cost more than to rasterise them.
fn bounds_is_shaded(kind: u32, index: u32) -> bool {
    if kind != BOUNDS_WALLS {
        return false;
    }
    let listed = bounds_list[occluder_params.walls + index];
    let edge = occluder_edge(listed.x, listed.y);
    return shaded_surely(edge[0], edge[1]);
}

fn bounds_piece(kind: u32, index: u32) -> BoundsPiece {
    switch kind {
        case BOUNDS_WALLS: {
            let listed = bounds_list[occluder_params.walls + index];
            let wall = occluder_wall_of(listed.x, listed.y);
            return bounds_piece_of(array<vec4f, 4>(
                occluder_on_screen(vec4f(wall.a, 1.0)),
                occluder_on_screen(vec4f(wall.b, 1.0)),
                occluder_on_screen(vec4f(occluder_way(wall.b), 0.0)),
                occluder_on_screen(vec4f(occluder_way(wall.a), 0.0)),
            ), occluder_facing(wall.plane));
        }
        case BOUNDS_CAPS: {
            let listed = bounds_list[occluder_params.caps + index];
            let p = occluder_triangle(listed.x, listed.y);
            let a = occluder_on_screen(vec4f(p[0], 1.0));
            let b = occluder_on_screen(vec4f(p[1], 1.0));
            let c = occluder_on_screen(vec4f(p[2], 1.0));
            return bounds_piece_of(array<vec4f, 4>(a, b, c, a), occluder_facing(occluder_cap_of(p)));
        }
        default: {
            let place = occluder_params.first_place + index / 12u;
            let a = bounds_at_infinity(index % 12u, 0u, place);
            let b = bounds_at_infinity(index % 12u, 1u, place);
            let c = bounds_at_infinity(index % 12u, 2u, place);
            return bounds_piece_of(array<vec4f, 4>(a, b, c, a), vec2<bool>(false, true));
        }
    }
}

// A corner of a triangle of the mesh's box at infinity, towards which all rays run that stay in the mesh's shadow.
fn bounds_at_infinity(triangle: u32, corner: u32, place: u32) -> vec4f {
    let axis = triangle / 4u;
    // Corners of a face's two triangles: 0 1 3, 0 3 2.
    let second = (triangle & 1u) != 0u;
    let at = select(select(corner, 3u, corner == 2u), select(corner, select(3u, 2u, corner == 2u), corner > 0u), second);
    var share = vec3f(0.0);
    share[axis] = f32((triangle >> 1u) & 1u);
    share[(axis + 1u) % 3u] = f32(at & 1u);
    share[(axis + 2u) % 3u] = f32(at >> 1u);
    let p = mix(occluder_params.least, occluder_params.most, share);
    let point = (occluder_places[place] * vec4f(p, 1.0)).xyz;
    return occluder_on_screen(vec4f(occluder_way(point), 0.0));
}

fn bounds_piece_of(corners: array<vec4f, 4>, facing: vec2<bool>) -> BoundsPiece {
    let a = corners[0];
    let u = corners[1] - a;
    let v = corners[2] - a;
    let across = cross(u.xyz, v.xyz);
    let volume = dot(a.xyz, across);
    let turn = sign(volume);
    let lengths = vec3f(length(a.xyz), length(u.xyz), length(v.xyz));
    let products = abs(a.w) * lengths.y * lengths.z + (abs(u.w) * lengths.z + abs(v.w) * lengths.y) * lengths.x;
    let key = (a.w * across + u.w * cross(v.xyz, a.xyz) + v.w * cross(a.xyz, u.xyz)) / volume;
    let size = frame.camera.size;
    let key_off = BOUNDS_ROUNDING * (size.x + size.y) * products / abs(volume);
    // Seen edge on it has no plane.
    let has_key = volume != 0.0 && key_off < OCCLUDER_BEYOND;
    let most = max(max(abs(a), abs(corners[1])), max(abs(corners[2]), abs(corners[3])));
    let rounding = BOUNDS_ROUNDING * vec2f(max(max(most.x, most.y), most.z * max(size.x, size.y)), most.z);
    let edges = array<vec3f, 4>(
        turn * cross(a.xyz, u.xyz),
        turn * cross(corners[1].xyz, corners[2].xyz - corners[1].xyz),
        turn * cross(corners[2].xyz, corners[3].xyz - corners[2].xyz),
        turn * cross(corners[3].xyz, a.xyz - corners[3].xyz),
    );
    let piece = BoundsPiece(
        corners,
        edges,
        select(vec3f(0.0), key, has_key),
        select(OCCLUDER_BEYOND, key_off, has_key),
        rounding,
        facing,
        size,
        vec2u(1u, occluder_tiles().x),
        vec2u(0u),
    );
    let extent = bounds_extent(piece, vec4f(vec2f(-BOUNDS_ROOM), size + BOUNDS_ROOM));
    return bounds_upright(piece, extent);
}

// The same with x and y exchanged where it is wider than high, and with its rows.
fn bounds_upright(piece: BoundsPiece, extent: BoundsExtent) -> BoundsPiece {
    var upright = piece;
    var least = extent.least.xy;
    var most = extent.most.xy;
    if most.x - least.x > most.y - least.y {
        least = least.yx;
        most = most.yx;
        for (var i = 0u; i < 4u; i++) {
            upright.corners[i] = piece.corners[i].yxzw;
            upright.edges[i] = piece.edges[i].yxz;
        }
        upright.key = piece.key.yxz;
        upright.size = piece.size.yx;
        upright.strides = piece.strides.yx;
    }
    upright.rows = bounds_of_tiles(least.y, most.y, upright.size.y);
    return upright;
}

// The tiles that a stretch of a side of the picture touches: the first, and the one behind the last.
fn bounds_of_tiles(least: f32, most: f32, side: f32) -> vec2u {
    let ends = clamp(vec2f(least - BOUNDS_ROOM, most + BOUNDS_ROOM), vec2f(0.0), vec2f(side - 0.5));
    let is_empty = least > most || most < -BOUNDS_ROOM || least > side + BOUNDS_ROOM;
    return select(vec2u(ends) / OCCLUDER_TILE + vec2u(0u, 1u), vec2u(0u), is_empty);
}

// What a rectangle (from xy to zw) holds of a piece; nothing where least > most.
fn bounds_extent(piece: BoundsPiece, rectangle: vec4f) -> BoundsExtent {
    var extent = BoundsExtent(vec3f(1e30), vec3f(-1e30));
    bounds_edge(&extent, piece.corners[0], piece.corners[1], piece.rounding, rectangle);
    bounds_edge(&extent, piece.corners[1], piece.corners[2], piece.rounding, rectangle);
    bounds_edge(&extent, piece.corners[2], piece.corners[3], piece.rounding, rectangle);
    bounds_edge(&extent, piece.corners[3], piece.corners[0], piece.rounding, rectangle);
    for (var i = 0u; i < 4u; i++) {
        let corner = select(rectangle.xy, rectangle.zw, vec2<bool>((i & 1u) != 0u, (i & 2u) != 0u));
        let sides = vec4f(
            dot(piece.edges[0], vec3f(corner, 1.0)),
            dot(piece.edges[1], vec3f(corner, 1.0)),
            dot(piece.edges[2], vec3f(corner, 1.0)),
            dot(piece.edges[3], vec3f(corner, 1.0)),
        );
        if all(sides >= vec4f(0.0)) && any(sides > vec4f(0.0)) {
            let key = dot(piece.key, vec3f(corner, 1.0));
            extent.least = min(extent.least, vec3f(corner, key - piece.key_off));
            extent.most = max(extent.most, vec3f(corner, key + piece.key_off));
        }
    }
    return extent;
}

// Adds what the rectangle holds of an edge (Liang and Barsky 1984, in homogeneous coordinates). In it w > 0.
fn bounds_edge(extent: ptr<function, BoundsExtent>, p: vec4f, q: vec4f, rounding: vec2f, rectangle: vec4f) {
    let at_p = vec4f(p.xy - rectangle.xy * p.z, rectangle.zw * p.z - p.xy);
    let at_q = vec4f(q.xy - rectangle.xy * q.z, rectangle.zw * q.z - q.xy);
    let crossing = at_p / (at_p - at_q);
    let p_is_out = at_p < vec4f(0.0);
    let q_is_out = at_q < vec4f(0.0);
    let begin = select(vec4f(0.0), crossing, p_is_out);
    let end = select(vec4f(1.0), crossing, q_is_out);
    let ends = vec2f(max(max(begin.x, begin.y), max(begin.z, begin.w)), min(min(end.x, end.y), min(end.z, end.w)));
    if any(p_is_out & q_is_out) || ends.x > ends.y {
        return;
    }
    bounds_point(extent, mix(p, q, ends.x), rounding);
    bounds_point(extent, mix(p, q, ends.y), rounding);
}

fn bounds_point(extent: ptr<function, BoundsExtent>, p: vec4f, rounding: vec2f) {
    var least = vec3f(-1e30);
    var most = vec3f(1e30);
    // Through the eye: anywhere.
    if p.z > rounding.y {
        let keys = p.w / (p.z + vec2f(-rounding.y, rounding.y));
        least = vec3f((p.xy - rounding.x) / p.z, min(keys.x, keys.y));
        most = vec3f((p.xy + rounding.x) / p.z, max(keys.x, keys.y));
    }
    (*extent).least = min((*extent).least, least);
    (*extent).most = max((*extent).most, most);
}

// Writes the tiles that a piece meets in a row.
fn bounds_row(piece: BoundsPiece, row: u32) {
    let side = f32(OCCLUDER_TILE);
    let rows = vec2f(-BOUNDS_ROOM, side + BOUNDS_ROOM) + side * f32(row);
    let extent = bounds_extent(piece, vec4f(-BOUNDS_ROOM, rows.x, piece.size.x + BOUNDS_ROOM, rows.y));
    let columns = bounds_of_tiles(extent.least.x, extent.most.x, piece.size.x);
    // The plane's keys over the row, and over a tile's width from its left side on.
    let over_rows = piece.key.y * rows;
    let over_columns = piece.key.x * (side + 2.0 * BOUNDS_ROOM);
    let least = piece.key.z + min(over_rows.x, over_rows.y) + min(over_columns, 0.0) - piece.key_off;
    let most = piece.key.z + max(over_rows.x, over_rows.y) + max(over_columns, 0.0) + piece.key_off;
    for (var column = columns.x; column < columns.y; column++) {
        let left = piece.key.x * (side * f32(column) - BOUNDS_ROOM);
        let keys = vec2f(max(extent.least.z, least + left), min(extent.most.z, most + left));
        // In whatever order.
        var depths = vec2f(min(keys.x, keys.y), max(keys.x, keys.y));
        if !camera_is_orthographic() {
            depths = 1.0 / max(depths.yx, vec2f(1.0 / OCCLUDER_BEYOND));
        }
        write_depths(row * piece.strides.y + column * piece.strides.x, depths, piece.facing);
    }
}
