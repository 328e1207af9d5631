// Marching a view ray column by column of its slice (Yusov 2012, algorithms 1 and 2). The ray is a straight line over the
// columns; lambda in [0, 1] runs along it from the smaller t to the larger. Of a column two texels count at most, one after
// the other; where the line crosses a texel's depth that is lit in part. A node of the tree is lit or dark as a whole iff all
// of its texels are, by the same comparisons of the same numbers, and adjoining lit texels make one stretch: with the tree
// and without it the stretches are the same.

@group(2) @binding(1) var<storage, read> march_traces: array<Trace>;
@group(2) @binding(2) var<storage, read> march_nodes: array<vec2f>;
@group(2) @binding(3) var airlight_table: texture_2d_array<f32>;

// Where something tints the light, a ray is cut into this many steps at least.
const MARCH_TINTED_STEPS: f32 = 256.0;
const MARCH_NO_RUN: vec2f = vec2f(-1.0);

// A view ray's stretch over a chart, from lambda 0 to 1.
struct MarchLine {
    t: vec2f,
    z: vec2f,
    w: vec2f,
    s: vec2f, // distances [m]
}

// A part of a ray: what lies over a chart, or what lies beyond the map and is lit.
struct MarchPart {
    line: MarchLine,
    chart: u32,
    columns: vec2u, // first and end; none beyond the map
    run: vec2f, // lambda of what is known to be lit
}

// A sample of a slice.
fn march_sample(slice: u32, ray: Ray) -> vec3f {
    return march(slice, march_traces[slice], sampling.levels, ray);
}

// A pixel: in the two slices it lies between; where those are not on the picture, in a slice of its own, without a tree.
fn march_pixel(place: vec2f, ray: Ray) -> vec3f {
    let slices = sampling_slices(place);
    var sum = vec4f(0.0);
    for (var i = 0u; i < 3u && (i < 2u || sum.w < SAMPLING_LEAST_WEIGHT); i++) {
        let slice = select(slices.first, slices.second, i == 1u);
        var weight = select(1.0 - slices.share, slices.share, i == 1u);
        var levels = sampling.levels;
        var trace = march_traces[slice];
        if i == 2u {
            trace = trace_slice(place, screen_direction(sampling.epipole, place), sampling.axis);
            levels = 0u;
            weight = 1.0;
        } else if trace.columns.y == 0u {
            // A line that the picture shows nothing of.
            continue;
        }
        sum += weight * vec4f(march(slice, trace, levels, ray), 1.0);
    }
    return sum.rgb / sum.w;
}

// The mean visibility of the light along a ray: what is seen of its unshadowed light, tints included.
fn march(slice: u32, trace: Trace, levels: u32, ray: Ray) -> vec3f {
    let span = light_reach(ray);
    if span.x >= span.y {
        return vec3f(1.0);
    }
    var sum = vec3f(0.0);
    for (var i = 0u; i < march_parts(); i++) {
        let part = march_part(i, trace, ray, span);
        let row = slice * trace_charts() + part.chart;
        sum += march_columns(row * sampling.columns, trace, levels, ray, part);
    }
    return unshadowed_share(sum, unshadowed(ray));
}

// The map and what lies before and behind it; of a cube its charts, which cover everything.
fn march_parts() -> u32 {
    switch SHADOW_KIND {
        case SHADOW_SINGLE: { return 3u; }
        case SHADOW_CUBE: { return 2u; }
        default: { return 1u; }
    }
}

fn march_part(index: u32, trace: Trace, ray: Ray, span: vec2f) -> MarchPart {
    if SHADOW_KIND == SHADOW_NONE {
        return march_beyond(span);
    }
    let chart = select(0u, index, SHADOW_KIND == SHADOW_CUBE);
    let over = trace_ray(trace, chart, sampling.axis, ray, span);
    let is_empty = over.span.x >= over.span.y;
    if SHADOW_KIND == SHADOW_SINGLE && index != 1u {
        if is_empty {
            return march_beyond(select(span, span.xx, index == 2u));
        }
        return march_beyond(select(vec2f(span.x, over.span.x), vec2f(over.span.y, span.y), index == 2u));
    }
    if is_empty {
        return march_beyond(span.xx);
    }
    let line = march_line(over);
    let side = trace_side(trace);
    let first = min(u32(max(line.t.x, 0.0)), side - 1u);
    let end = clamp(u32(ceil(max(line.t.y, 0.0))), first + 1u, side);
    return MarchPart(line, chart, vec2u(first, end), MARCH_NO_RUN);
}

fn march_beyond(stretch: vec2f) -> MarchPart {
    let run = select(MARCH_NO_RUN, vec2f(0.0, 1.0), stretch.x < stretch.y);
    return MarchPart(MarchLine(vec2f(0.0), vec2f(0.0), vec2f(1.0), stretch), 0u, vec2u(0u), run);
}

fn march_line(over: TraceRay) -> MarchLine {
    let a = over.c0 + over.span.x * over.c1;
    let b = over.c0 + over.span.y * over.c1;
    let w = max(vec2f(a.z, b.z), vec2f(1e-12));
    let line = MarchLine(vec2f(a.x, b.x) / w, vec2f(a.y, b.y) / w, w, over.span);
    if line.t.x <= line.t.y {
        return line;
    }
    return MarchLine(line.t.yx, line.z.yx, line.w.yx, line.s.yx);
}

// Distance at lambda: perspective's division undone.
fn march_distance(line: MarchLine, lambda: f32) -> f32 {
    let share = lambda * line.w.x / mix(line.w.y, line.w.x, lambda);
    return mix(line.s.x, line.s.y, share);
}

// Up at most one level a step (Chen et al. 2011, section 3.3); with no levels, column by column.
fn march_columns(tree: u32, trace: Trace, levels: u32, ray: Ray, part: MarchPart) -> vec3f {
    let line = part.line;
    let inverse = 1.0 / max(line.t.y - line.t.x, 1e-20);
    let rise = line.z.y - line.z.x;
    var column = part.columns.x;
    var level = 0u;
    // Whether the column's first texel is behind.
    var is_second = false;
    var run = part.run;
    var sum = vec3f(0.0);
    loop {
        let is_done = column >= part.columns.y;
        var lit = vec2f(0.0);
        if !is_done {
            var next = column + (1u << level);
            var ends = vec2f(f32(column), f32(next));
            var bounds = vec2f(0.0);
            if level == 0u {
                let texels = trace_column(trace, part.chart, sampling.axis, column);
                bounds = vec2f(select(texels.depths.x, texels.depths.y, is_second));
                ends = select(vec2f(ends.x, texels.split), vec2f(texels.split, ends.y), is_second);
                is_second = !is_second && texels.split < f32(next);
                next = select(next, column, is_second);
            } else {
                bounds = march_nodes[tree + (sampling.columns >> level) + (column >> level)];
            }
            // A ray that comes in over the map's rim begins in the first column, whatever rounding says.
            let edges = saturate((ends - line.t.x) * inverse);
            let depths = line.z.x + edges * rise;
            lit = edges;
            if min(depths.x, depths.y) < bounds.y {
                if max(depths.x, depths.y) < bounds.x {
                    lit.y = lit.x;
                } else if level > 0u {
                    level--;
                    continue;
                } else {
                    lit = march_lit_part(edges, depths, bounds.x);
                }
            }
            column = next;
            let climbs = !is_second && (next & ((2u << level) - 1u)) == 0u;
            level = min(level + u32(climbs), levels);
        }
        let is_lit = lit.x < lit.y;
        if is_done || (is_lit && lit.x > run.y) {
            sum += march_run(ray, line, run);
            if is_done {
                break;
            }
            run.x = lit.x;
        }
        run.y = select(run.y, lit.y, is_lit);
    }
    return sum;
}

// The part of a column on the lit side of where the ray crosses its depth.
fn march_lit_part(edges: vec2f, depths: vec2f, depth: f32) -> vec2f {
    let crossing = mix(edges.x, edges.y, saturate((depth - depths.x) / (depths.y - depths.x)));
    return select(vec2f(edges.x, crossing), vec2f(crossing, edges.y), depths.y > depths.x);
}

fn march_run(ray: Ray, line: MarchLine, run: vec2f) -> vec3f {
    if run.x >= run.y {
        return vec3f(0.0);
    }
    let a = march_distance(line, run.x);
    let b = march_distance(line, run.y);
    let stretch = vec2f(min(a, b), max(a, b));
    if LIGHT_TEXTURE != LIGHT_TEXTURE_NONE || SHADOW_GLASS {
        let columns = (run.y - run.x) * (line.t.y - line.t.x);
        let share = (stretch.y - stretch.x) / max(ray.length, 1e-20);
        return march_tinted(ray, stretch, ceil(max(columns, max(share * MARCH_TINTED_STEPS, 1.0))));
    }
    if light_is_local() {
        return stretch_plain(ray, stretch.x, stretch.y);
    }
    return transmittance_integral(frame.medium.sigma_t, stretch.x, stretch.y);
}

// Chen 2011, eq. 1 as a Riemann sum, each step tinted by what lies between its middle and the light.
fn march_tinted(ray: Ray, stretch: vec2f, steps: f32) -> vec3f {
    let map_ray = shadow_ray(ray);
    let step = (stretch.y - stretch.x) / steps;
    var sum = vec3f(0.0);
    for (var i = 0.0; i < steps; i += 1.0) {
        let s = stretch.x + (i + 0.5) * step;
        let point = ray.origin + s * ray.direction;
        let reached = shadow_glass_at(map_ray.c0 + s * map_ray.c1) * transmittance(frame.medium.sigma_t, s);
        if light_is_local() {
            let incident = light_incident(point);
            sum += reached * medium_scattering(-dot(incident.direction, ray.direction)) * incident.irradiance;
        } else {
            sum += reached * light_tint(point);
        }
    }
    return sum * step;
}
