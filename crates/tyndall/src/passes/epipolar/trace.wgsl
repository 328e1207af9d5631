// A slice in its shadow map. In the plane of a slice a shadow map is a row of columns, and every view ray of
// the slice is a straight line over it, in the column coordinate t and a depth z that grows towards the light. One chart
// serves a single map (t is the texel coordinate along which the slice's trace is longer, z the map's own depth), two serve
// a cube (90 degrees each from the axis, t is projective, z is 1 / depth).

// Nothing blocks a column of this depth.
const TRACE_OPEN: f32 = -1e30;

struct Trace {
    outward: vec3f, // cube: unit, in the plane, normal to the axis, on the side of the view rays
    major: u32, // single: 0 where t runs along u, 1 along v
    line: vec2f, // single: the other texel coordinate is x + y t
    columns: vec2u, // those that view rays of the slice may cross
}

// A view ray over one chart: (t, z, w) = c0 + s c1, homogeneous, within a span of distances [m].
struct TraceRay {
    c0: vec3f,
    c1: vec3f,
    span: vec2f,
}

fn trace_charts() -> u32 {
    return select(1u, 2u, SHADOW_KIND == SHADOW_CUBE);
}

// Texel coordinates of clip space, homogeneous.
fn trace_texels(clip: vec4f) -> vec3f {
    let size = vec2f(textureDimensions(shadow_map));
    return vec3f(0.5 * size * vec2f(clip.w + clip.x, clip.w - clip.y), clip.w);
}

// The trace of the slice through a point of the picture along a direction on it [pixels]. `axis` goes through the eye and
// the light.
fn trace_slice(point: vec2f, direction: vec2f, axis: vec3f) -> Trace {
    let flat = camera_is_orthographic();
    let here = camera_ray(point, 0.0);
    let there = camera_ray(point - 0.5 * max(frame.camera.size.x, frame.camera.size.y) * direction, 0.0);
    let normal = normalize(cross(here.direction, there.origin + there.direction - here.origin - here.direction));
    if SHADOW_KIND == SHADOW_CUBE {
        let outward = normalize(cross(normal, axis));
        let side = dot(outward, select(here.direction, here.origin - light.position, flat));
        let columns = vec2u(0u, textureDimensions(shadow_map).x);
        return Trace(select(-outward, outward, side >= 0.0), 0u, vec2f(0.0), columns);
    }
    return trace_single(here, normal, flat);
}

fn trace_single(ray: Ray, normal: vec3f, flat: bool) -> Trace {
    // Two points of the trace, homogeneous; a plane through the light is a line on its map.
    var first = light.clip_from_world * vec4f(ray.direction, 0.0);
    var second = light.clip_from_world * vec4f(cross(normal, ray.direction), 0.0);
    if !light_is_local() {
        first = light.clip_from_world * vec4f(ray.origin, 1.0);
        second = light.clip_from_world * vec4f(normalize(cross(normal, light.direction)), 0.0);
    }
    let line = cross(trace_texels(first), trace_texels(second));
    let major = u32(abs(line.x) > abs(line.y));
    let across = select(line.y, line.x, major == 1u);
    let along = select(line.x, line.y, major == 1u);
    let divisor = select(across, 1e-30, abs(across) < 1e-30);
    let minor = -vec2f(line.z, along) / divisor;
    return Trace(vec3f(0.0), major, minor, trace_columns(ray, major, minor, flat));
}

// The columns between the eye's and the map's rim. A perspective camera's rays all go the same way from the eye's column.
fn trace_columns(ray: Ray, major: u32, line: vec2f, flat: bool) -> vec2u {
    let size = vec2f(textureDimensions(shadow_map));
    let sides = select(size, size.yx, major == 1u);
    let slope = select(line.y, 1e-20, abs(line.y) < 1e-20);
    let rims = (vec2f(0.0, sides.y) - line.x) / slope;
    var range = vec2f(max(min(rims.x, rims.y), 0.0), min(max(rims.x, rims.y), sides.x));
    let eye = trace_texels(light.clip_from_world * vec4f(ray.origin, 1.0));
    if !flat && eye.z > 1e-6 {
        let way = trace_texels(light.clip_from_world * vec4f(ray.direction, 0.0));
        let forward = way[major] * eye.z - eye[major] * way.z;
        let start = eye[major] / eye.z;
        range = select(vec2f(range.x, min(range.y, start)), vec2f(max(range.x, start), range.y), forward >= 0.0);
    }
    // Two columns to spare, for rays beside the slice.
    let columns = clamp(vec2f(floor(range.x) - 2.0, ceil(range.y) + 2.0), vec2f(0.0), vec2f(sides.x));
    return vec2u(columns);
}

// Columns of a chart.
fn trace_side(trace: Trace) -> u32 {
    let size = textureDimensions(shadow_map);
    return select(size.x, size.y, trace.major == 1u);
}

// A column as the trace crosses it: through two texels at most, that meet at t = `split`; where there is but one, at the
// column's end. Points are lit iff their depth is not less than that of their texel's occluder.
struct TraceColumn {
    split: f32,
    depths: vec2f,
}

fn trace_column(trace: Trace, chart: u32, axis: vec3f, column: u32) -> TraceColumn {
    let start = f32(column);
    if SHADOW_KIND == SHADOW_CUBE {
        // A chart's columns are not those of the map: each half is of the texel at its middle.
        let first = trace_cube_depth(trace, chart, axis, start + 0.25);
        return TraceColumn(start + 0.5, vec2f(first, trace_cube_depth(trace, chart, axis, start + 0.75)));
    }
    let minor = trace.line.x + trace.line.y * vec2f(start, start + 1.0);
    let rows = floor(minor);
    let edge = max(rows.x, rows.y);
    let slope = select(trace.line.y, 1e-20, abs(trace.line.y) < 1e-20);
    let crossing = clamp((edge - trace.line.x) / slope, start, start + 1.0);
    let split = select(start + 1.0, crossing, rows.x != rows.y);
    return TraceColumn(split, vec2f(trace_single_depth(trace, start, rows.x), trace_single_depth(trace, start, rows.y)));
}

fn trace_single_depth(trace: Trace, column: f32, row: f32) -> f32 {
    let texel = select(vec2f(column, row), vec2f(row, column), trace.major == 1u);
    if any(texel < vec2f(0.0)) || any(texel >= vec2f(textureDimensions(shadow_map))) {
        return TRACE_OPEN;
    }
    let stored = trace_stored(vec2u(texel), 0u);
    return select(stored, TRACE_OPEN, stored <= 0.0);
}

// At t of a cube's chart.
fn trace_cube_depth(trace: Trace, chart: u32, axis: vec3f, t: f32) -> f32 {
    let size = vec2f(textureDimensions(shadow_map));
    let sector = trace_sector(trace, chart, axis);
    let direction = sector[1] + (2.0 * t / size.x - 1.0) * sector[0];
    let place = shadow_cube_point(direction);
    let texel = vec2u(clamp(place.uv * size, vec2f(0.0), size - 1.0));
    let stored = trace_stored(texel, place.face);
    let along = max(abs(direction.x), max(abs(direction.y), abs(direction.z)));
    return select(along * (stored - light.cube_depth.y) / light.cube_depth.x, TRACE_OPEN, stored <= 0.0);
}

// A texel's depth, 1 at the near plane, 0 where nothing was drawn.
fn trace_stored(texel: vec2u, face: u32) -> f32 {
    let held = textureLoad(shadow_map, texel, face, 0);
    return select(held, 1.0 - held, light.standard_depth == 1u);
}

// A cube's chart: the directions of its t and of its depth. The first begins at the light's way back along the axis, the
// second ends at its way on.
fn trace_sector(trace: Trace, chart: u32, axis: vec3f) -> mat2x3f {
    let out = 0.70710678 * trace.outward;
    let on = 0.70710678 * axis;
    if chart == 0u {
        return mat2x3f(out + on, out - on);
    }
    return mat2x3f(on - out, out + on);
}

// A view ray over a chart, and the part of the span that the chart covers; empty where x >= y.
fn trace_ray(trace: Trace, chart: u32, axis: vec3f, ray: Ray, span: vec2f) -> TraceRay {
    if SHADOW_KIND == SHADOW_CUBE {
        return trace_cube_ray(trace, chart, axis, ray, span);
    }
    let map_ray = shadow_ray(ray);
    let t0 = trace_texels(map_ray.c0);
    let t1 = trace_texels(map_ray.c1);
    return TraceRay(
        vec3f(t0[trace.major], map_ray.c0.z, map_ray.c0.w),
        vec3f(t1[trace.major], map_ray.c1.z, map_ray.c1.w),
        shadow_covered(map_ray, span),
    );
}

fn trace_cube_ray(trace: Trace, chart: u32, axis: vec3f, ray: Ray, span: vec2f) -> TraceRay {
    let side = f32(textureDimensions(shadow_map).x);
    let q0 = ray.origin - light.position;
    // Rays beside the slice are turned into its half-plane.
    let out = max(vec2f(dot(q0, trace.outward), dot(ray.direction, trace.outward)), vec2f(0.0));
    let on = vec2f(dot(q0, axis), dot(ray.direction, axis));
    let w = 0.70710678 * select(out + on, out - on, chart == 0u);
    let x = 0.70710678 * select(on - out, out + on, chart == 0u);
    // The charts meet beside the light.
    let slope = select(on.y, 1e-20, abs(on.y) < 1e-20);
    let split = -on.x / slope;
    let before = (chart == 0u) == (slope > 0.0);
    return TraceRay(
        vec3f(0.5 * side * (w.x + x.x), 1.0, w.x),
        vec3f(0.5 * side * (w.y + x.y), 0.0, w.y),
        select(vec2f(max(span.x, split), span.y), vec2f(span.x, min(span.y, split)), before),
    );
}
