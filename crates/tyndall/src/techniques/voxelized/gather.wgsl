// The light of each pixel's ray: of the rows of its two nearest slices, or, near the axis, by distances.

@group(2) @binding(0) var<uniform> epipolar: Epipolar;
@group(2) @binding(1) var<storage, read> voxels: array<u32>;
@group(2) @binding(2) var airlight_table: texture_2d_array<f32>;

@fragment
fn gather(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let ray = frame_ray(position);
    return frame_output(position, ray, gather_light(ray));
}

fn gather_light(ray: Ray) -> vec3f {
    let span = light_reach(ray);
    if span.x >= span.y {
        return vec3f(0.0);
    }
    let place = epipolar_ray(epipolar, ray);
    if SHADOW_KIND == SHADOW_NONE || place.off_axis <= epipolar.least_off_axis {
        return gather_by_distance(ray, span);
    }
    let slices = epipolar_neighbours(epipolar, place.place - 0.5);
    let row = u32(clamp(place.b, 0.0, f32(epipolar.samples) - 1.0));
    var sum = vec3f(0.0);
    for (var i = 0u; i < 2u; i++) {
        let words = voxel_row(epipolar.samples, slices.index[i], row);
        sum += slices.weight[i] * gather_row(ray, place, words, span);
    }
    return sum;
}

// The lit runs of a row of voxels; beyond the columns all is lit.
fn gather_row(ray: Ray, place: EpipolarRay, row: u32, span: vec2f) -> vec3f {
    let side = epipolar.samples;
    let first = (epipolar_gamma(place, span.x) - epipolar.gamma_start) / epipolar.gamma_step;
    var column = u32(clamp(first, 0.0, f32(side)));
    var start = span.x;
    // The voxel that the ray starts in may be dark.
    let begins_lit = first < 0.0 || voxel_next(side, row, column, 0xffffffffu) == column;
    if !begins_lit {
        column = voxel_next(side, row, column, 0xffffffffu);
        start = gather_border(place, column, span);
    }
    var sum = vec3f(0.0);
    while start < span.y {
        let dark = voxel_next(side, row, column, 0u);
        let end = select(gather_border(place, dark, span), span.y, dark == side);
        sum += gather_stretch(ray, start, end, dark - column);
        column = voxel_next(side, row, dark, 0xffffffffu);
        start = select(gather_border(place, column, span), span.y, dark == side);
    }
    return sum;
}

// Distance [m] along the ray where a column begins.
fn gather_border(place: EpipolarRay, column: u32, span: vec2f) -> f32 {
    let gamma = epipolar.gamma_start + f32(column) * epipolar.gamma_step;
    return clamp(epipolar_crossing(place, gamma), span.x, span.y);
}

// The rays of the axis are light rays: from the sun one, from a lamp one to either side of it. Those through the ends of
// the view ray stand for them (Wyman and Dai 2013, section 5).
fn gather_by_distance(ray: Ray, span: vec2f) -> vec3f {
    let most = frame_choice(epipolar.samples);
    if !light_is_local() {
        let end = light_ray_end(shadow_line(ray.origin, light.direction));
        let is_along = dot(ray.direction, light.direction) > 0.0;
        let lit = select(vec2f(max(span.x, -end), span.y), vec2f(span.x, min(span.y, end)), is_along);
        return gather_stretch(ray, lit.x, lit.y, most);
    }
    let nearest = dot(light.position - ray.origin, ray.direction);
    let ends = vec2f(gather_end_towards(ray, span.x), gather_end_towards(ray, span.y));
    let before = vec2f(max(span.x, nearest - ends.x), min(span.y, nearest));
    let behind = vec2f(max(span.x, nearest), min(span.y, nearest + ends.y));
    return gather_stretch(ray, before.x, before.y, most)
        + gather_stretch(ray, behind.x, behind.y, most);
}

// Distance [m] to the end of the lamp's ray through a point of the view ray.
fn gather_end_towards(ray: Ray, s: f32) -> f32 {
    let offset = ray.origin + s * ray.direction - light.position;
    return light_ray_end(shadow_line(light.position, offset / max(length(offset), 1e-20)));
}

// The light of a lit stretch, of so many voxels at most.
fn gather_stretch(ray: Ray, a: f32, b: f32, count: u32) -> vec3f {
    if a >= b {
        return vec3f(0.0);
    }
    if LIGHT_TEXTURE == LIGHT_TEXTURE_NONE && !SHADOW_GLASS {
        return stretch_plain(ray, a, b);
    }
    return gather_tinted(ray, a, b, max(count, 1u));
}

// In steps of equal angle at a lamp, of equal length of the sun, tinted as the middle of each.
fn gather_tinted(ray: Ray, a: f32, b: f32, count: u32) -> vec3f {
    let map_ray = shadow_ray(ray);
    let lamp = stretch_light(ray);
    let is_local = light_is_local();
    let ends = select(vec2f(a, b), atan((vec2f(a, b) - lamp.projection) / lamp.height), is_local);
    let step = (ends.y - ends.x) / f32(count);
    var sum = vec3f(0.0);
    var from_s = a;
    for (var i = 0u; i < count; i++) {
        let at = ends.x + f32(i + 1u) * step;
        let to_s = select(min(at, b), clamp(lamp.projection + lamp.height * tan(at), from_s, b), is_local);
        let s = 0.5 * (from_s + to_s);
        let tint = light_tint(ray.origin + s * ray.direction) * shadow_glass_at(map_ray.c0 + s * map_ray.c1);
        sum += tint * stretch_short(ray, from_s, to_s);
        from_s = to_s;
    }
    return sum;
}
