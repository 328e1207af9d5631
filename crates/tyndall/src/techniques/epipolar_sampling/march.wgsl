// Marching a view ray column by column of its slice (Yusov 2012, algorithms 1 and 2). The ray is a straight line over the
// columns; lambda in [0, 1] runs along it from the smaller t to the larger. Where the line crosses a column's depth the
// column is lit in part. A node of the tree is lit or dark as a whole iff all of its columns are, by the same comparisons
// of the same numbers, and adjoining lit columns make one stretch: with the tree and without it the stretches are the same.

// Bindings: `march_nodes`, the trees.

// Steps over stretches outside the map where something tints the light.
const MARCH_OUTSIDE_STEPS: f32 = 64.0;

// A view ray's stretch over a chart, from lambda 0 to 1.
struct MarchLine {
    t: vec2f,
    z: vec2f,
    w: vec2f,
    s: vec2f, // distances [m]
}

// What a ray sees of the light, as a share of epipolar_whole: of the sun without, of others with the phase function.
fn march(slice: u32, trace: Trace, levels: u32, ray: Ray) -> vec3f {
    let span = light_reach(ray);
    var sum = vec3f(0.0);
    if span.x < span.y {
        sum = march_span(slice, trace, levels, ray, span);
    }
    return sum / epipolar_whole(ray);
}

fn march_span(slice: u32, trace: Trace, levels: u32, ray: Ray, span: vec2f) -> vec3f {
    if SHADOW_KIND == SHADOW_NONE {
        return march_stretch(ray, span, MARCH_OUTSIDE_STEPS);
    }
    var sum = vec3f(0.0);
    for (var chart = 0u; chart < trace_charts(); chart++) {
        let over = trace_ray(trace, chart, epipolar.axis, ray, span);
        if over.span.x >= over.span.y {
            if SHADOW_KIND == SHADOW_SINGLE {
                sum = march_stretch(ray, span, MARCH_OUTSIDE_STEPS);
            }
            continue;
        }
        if SHADOW_KIND == SHADOW_SINGLE {
            sum += march_stretch(ray, vec2f(span.x, over.span.x), MARCH_OUTSIDE_STEPS);
            sum += march_stretch(ray, vec2f(over.span.y, span.y), MARCH_OUTSIDE_STEPS);
        }
        sum += march_chart(slice * trace_charts() + chart, trace, chart, levels, ray, march_line(over));
    }
    return sum;
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

fn march_chart(row: u32, trace: Trace, chart: u32, levels: u32, ray: Ray, line: MarchLine) -> vec3f {
    let side = trace_side(trace);
    let inverse = 1.0 / max(line.t.y - line.t.x, 1e-20);
    let rise = line.z.y - line.z.x;
    let start = row * epipolar.columns;
    var column = min(u32(max(line.t.x, 0.0)), side - 1u);
    let end = clamp(u32(ceil(max(line.t.y, 0.0))), column + 1u, side);
    var level = 0u;
    var run = vec2f(-1.0);
    var sum = vec3f(0.0);
    while column < end {
        let next = column + (1u << level);
        // A ray that comes in over the map's rim begins in the first column, whatever rounding says.
        let edges = saturate((vec2f(f32(column), f32(next)) - line.t.x) * inverse);
        let depths = line.z.x + edges * rise;
        var bounds = vec2f(0.0);
        if level == 0u {
            bounds = vec2f(trace_depth(trace, chart, epipolar.axis, column));
        } else {
            bounds = march_nodes[start + (epipolar.columns >> level) + (column >> level)];
        }
        var lit = edges;
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
        if lit.x < lit.y {
            if lit.x > run.y {
                sum += march_run(ray, line, run);
                run.x = lit.x;
            }
            run.y = lit.y;
        }
        column = next;
        level = min(level + u32((next & ((2u << level) - 1u)) == 0u), levels);
    }
    return sum + march_run(ray, line, run);
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
    return march_stretch(ray, vec2f(min(a, b), max(a, b)), ceil((run.y - run.x) * (line.t.y - line.t.x)));
}

// A lit stretch [m], of so many columns: in closed form, or column by column where something tints the light.
fn march_stretch(ray: Ray, stretch: vec2f, columns: f32) -> vec3f {
    if stretch.x >= stretch.y {
        return vec3f(0.0);
    }
    if LIGHT_TEXTURE != LIGHT_TEXTURE_NONE || SHADOW_GLASS {
        return march_tinted(ray, stretch, max(columns, 1.0));
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
