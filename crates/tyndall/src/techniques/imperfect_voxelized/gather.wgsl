// The light of all samples of a batch, added up for each pixel (Wyman and Dai 2013, section 3.1.5).

// Radiance, and of how many samples it is.
@group(2) @binding(7) var<storage, read_write> ivsv_sums: array<vec4f>;

const IVSV_UNIFORM: u32 = 1u;
// A grid's columns are integrated over in so many panels.
const IVSV_PANELS: u32 = 8u;

// A thread takes two pixels with the same samples, so that what it reads of each serves both.
@compute @workgroup_size(8, 8)
fn ivsv_gather(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_id) local: vec3u) {
    let place = ivsv_place(group.xy, vec2u(8u, 16u), local.xy * vec2u(1u, 2u));
    let below = place + vec2u(0u, ivsv.spread);
    if any(place >= ivsv.size) {
        return;
    }
    let rays = array(ivsv_ray(place), ivsv_ray(min(below, ivsv.size - 1u)));
    let spans = array(light_reach(rays[0]), light_reach(rays[1]));
    var sums = array(vec3f(0.0), vec3f(0.0));
    var count = 0.0;
    let turns = ivsv.turns;
    for (var i = ivsv_first(place, turns); i < imperfect_batch.count; i += turns) {
        let e = grids[imperfect_batch.first + i];
        let color = imperfect_colors[imperfect_batch.first + i].rgb;
        sums[0] += color * ivsv_sample(e, rays[0], spans[0], i);
        sums[1] += color * ivsv_sample(e, rays[1], spans[1], i);
        count += 1.0;
    }
    ivsv_add(place, vec4f(sums[0], count));
    if below.y < ivsv.size.y {
        ivsv_add(below, vec4f(sums[1], count));
    }
}

// To what batches before this one left in a pixel.
fn ivsv_add(place: vec2u, light: vec4f) {
    let index = place.y * ivsv.size.x + place.x;
    let before = select(vec4f(0.0), ivsv_sums[index], imperfect_batch.first > 0u);
    ivsv_sums[index] = before + light;
}

// A sample seen from a view ray.
struct IvsvView {
    nearest: f32, // distance along the ray [m]
    height: f32, // of the sample over the ray [m]
    emitted: vec2f, // the emitter's cosine at xi is emitted . (cos xi, sin xi)
}

fn ivsv_view(ray: Ray, position: vec3f) -> IvsvView {
    let to_sample = position - ray.origin;
    let nearest = dot(to_sample, ray.direction);
    let across = nearest * ray.direction - to_sample;
    let height = max(length(across), LIGHT_RADIUS);
    return IvsvView(nearest, height, vec2f(dot(across, light.direction) / height, dot(ray.direction, light.direction)));
}

// exp(-sigma_t (s + d)) sigma_s rho cos(emitter) at xi, where s = nearest + height tan(xi) and ds / d^2 = d xi / height
// (Kulla and Fajardo 2012).
fn ivsv_density(view: IvsvView, xi: f32) -> vec3f {
    let direction = vec2f(cos(xi), sin(xi));
    let path = view.nearest + view.height * direction.x / max(1.0 - direction.y, 1e-7);
    let emitted = max(dot(view.emitted, direction), 0.0);
    return emitted * medium_scattering_unrolled(-direction.y) * transmittance(frame.medium.sigma_t, path);
}

// The light of one sample of the batch, over its intensity.
fn ivsv_sample(e: Epipolar, ray: Ray, span: vec2f, tile: u32) -> vec3f {
    let view = ivsv_view(ray, e.position);
    let place = epipolar_ray(e, ray);
    // Near the axis distances are compared, see below.
    let by_distance = imperfect_batch.side == 0u || place.off_axis <= e.least_off_axis;
    var lit = span;
    for (var i = 0u; i < u32(by_distance); i++) {
        lit = ivsv_by_distance(ray, e.position, view.nearest, span, tile);
    }
    let gammas = vec2f(epipolar_gamma(place, lit.x), epipolar_gamma(place, lit.y));
    let columns = f32(e.samples);
    let start = select(e.gamma_start, gammas.x, by_distance);
    let step = select(e.gamma_step, max(gammas.y - gammas.x, 0.0) / columns, by_distance);
    let ends = select((gammas - start) / step, vec2f(0.0, columns), by_distance);
    let from_nearest = start - epipolar_gamma(place, view.nearest);
    let slices = epipolar_neighbours(e, place.place - 0.5);
    let row = u32(clamp(place.b, 0.0, columns - 1.0));
    let rows = vec2u(
        voxel_row(e.samples, tile * e.samples + slices.index.x, row),
        voxel_row(e.samples, tile * e.samples + slices.index.y, row),
    );
    let shadowed = select(slices.weight, vec2f(0.0), by_distance);
    let panel = e.samples / IVSV_PANELS;
    var bright = vec3f(0.0);
    var all = vec3f(0.0);
    var dark = vec2f(0.0);
    let last = u32(clamp(ceil(ends.y / f32(panel)), 0.0, f32(IVSV_PANELS)));
    for (var i = u32(clamp(ends.x / f32(panel), 0.0, f32(IVSV_PANELS))); i < last; i++) {
        let first = i * panel;
        let part = clamp(ends - f32(first), vec2f(0.0), vec2f(f32(panel)));
        let words = vec2u(voxels[rows.x + first / 32u], voxels[rows.y + first / 32u]) >> vec2u(first & 31u);
        let blocked = vec2f(
            voxel_dark(words.x, part.y) - voxel_dark(words.x, part.x),
            voxel_dark(words.y, part.y) - voxel_dark(words.y, part.x),
        );
        let width = part.y - part.x;
        let of_panel = dot(shadowed, blocked);
        let density = ivsv_density(view, from_nearest + step * (f32(first) + 0.5 * (part.x + part.y)));
        bright += density * (width - of_panel);
        all += density * width;
        dark += vec2f(of_panel, width);
    }
    let evenly = all * (1.0 - dark.x / max(dark.y, 1e-20));
    let seen = select(bright, evenly, ivsv.weighting == IVSV_UNIFORM);
    let reached = select(0.0, step / view.height, span.x < span.y && lit.x < lit.y);
    return seen * reached;
}

// Along the axis all light rays are one to either side of the sample: what lies between it and the ray's ends, as
// distances (section 5).
fn ivsv_by_distance(ray: Ray, position: vec3f, nearest: f32, span: vec2f, tile: u32) -> vec2f {
    let to_start = ray.origin + span.x * ray.direction - position;
    let to_end = ray.origin + span.y * ray.direction - position;
    let before = imperfect_end(tile, to_start / max(length(to_start), 1e-20));
    let behind = imperfect_end(tile, to_end / max(length(to_end), 1e-20));
    return vec2f(max(span.x, nearest - before), min(span.y, nearest + behind));
}
