// How much of the light of all samples of a batch reaches the surface that each pixel sees: visibility at the end of its
// ray, between two slices and two columns of each sample's voxels (Wyman and Dai 2013, section 3.3).

// World space, unit; zero where it is not known.
@group(2) @binding(7) var ivsv_normals: texture_2d<f32>;
// Irradiance that arrives, and that which would if nothing blocked it.
@group(2) @binding(8) var<storage, read_write> ivsv_lit: array<vec4f>;
@group(2) @binding(9) var<storage, read_write> ivsv_all: array<vec4f>;

// Lest a surface shadows itself, its points are looked up so many rows nearer to the light (section 5), ...
const IVSV_ROWS: f32 = 1.0;
// ... and so far along their light rays, in texels of the sample's map: about a texel as far as the surface slopes in it, ...
const IVSV_TEXELS: f32 = 1.0;
// ... whose slope counts up to here; that of a surface whose normal is not known is 1.
const IVSV_STEEPEST: f32 = 2.0;

@compute @workgroup_size(8, 8)
fn ivsv_surface(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_id) local: vec3u) {
    let place = ivsv_place(group.xy, vec2u(8u), local.xy);
    if any(place >= ivsv.size) {
        return;
    }
    let ray = ivsv_ray(place);
    let known = min(ivsv_pixel(place), textureDimensions(ivsv_normals) - 1u);
    let normal = textureLoad(ivsv_normals, known, 0).xyz;
    var lit = vec3f(0.0);
    var all = vec3f(0.0);
    let turns = ivsv.turns;
    for (var i = ivsv_first(place, turns); i < imperfect_batch.count; i += turns) {
        let arriving = ivsv_arriving(ray, normal, i);
        all += arriving;
        lit += arriving * ivsv_visibility(ray, normal, i);
    }
    let index = place.y * ivsv.size.x + place.x;
    let is_first = imperfect_batch.first == 0u;
    ivsv_lit[index] = vec4f(lit, 0.0) + select(ivsv_lit[index], vec4f(0.0), is_first);
    ivsv_all[index] = vec4f(all, 0.0) + select(ivsv_all[index], vec4f(0.0), is_first);
}

// What a sample would send to the surface, on a unit of its area or, where its normal is not known, of one that faces the
// sample [W/m^2].
fn ivsv_arriving(ray: Ray, normal: vec3f, tile: u32) -> vec3f {
    let sample = imperfect_batch.first + tile;
    let offset = ray.origin + ray.length * ray.direction - grids[sample].position;
    let distance2 = max(dot(offset, offset), LIGHT_RADIUS * LIGHT_RADIUS);
    let distance = sqrt(distance2);
    let emitted = max(dot(offset, light.direction), 0.0) / distance;
    let received = select(max(-dot(offset, normal), 0.0) / distance, 1.0, all(normal == vec3f(0.0)));
    let dimmed = transmittance(frame.medium.sigma_t, distance) * (emitted * received / distance2);
    return imperfect_colors[sample].rgb * dimmed;
}

// The view ray that ends at a point.
fn ivsv_ray_to(ray: Ray, point: vec3f) -> Ray {
    let toward = select(point - ray.origin, ray.direction, camera_is_orthographic());
    let direction = toward / max(length(toward), 1e-20);
    let along = dot(point - ray.origin, direction);
    return Ray(point - along * direction, along, direction);
}

// The tangent of the angle between a normal and the way to the light, as far as it counts.
fn ivsv_slope(normal: vec3f, way: vec3f) -> f32 {
    let cosine = saturate(-dot(normal, way));
    let slope = sqrt(1.0 - cosine * cosine) / max(cosine, 1e-3);
    return select(min(slope, IVSV_STEEPEST), 1.0, all(normal == vec3f(0.0)));
}

// Whether a sample is seen from the surface, 0 to 1.
fn ivsv_visibility(ray: Ray, normal: vec3f, tile: u32) -> f32 {
    let e = grids[imperfect_batch.first + tile];
    let offset = ray.origin + ray.length * ray.direction - e.position;
    let distance = max(length(offset), LIGHT_RADIUS);
    let way = offset / distance;
    // A texel's mean solid angle is 2 pi / side^2.
    let texel = distance * sqrt(2.0 * PI) / f32(max(imperfect_batch.side, 1u));
    let depth = distance - texel * (IVSV_TEXELS + ivsv_slope(normal, way));
    let point = e.position + depth * way;
    let to_point = ivsv_ray_to(ray, point);
    let place = epipolar_ray(e, to_point);
    let slices = epipolar_neighbours(e, place.place - 0.5);
    let last = f32(e.samples - 1u);
    let row = u32(clamp(place.b - IVSV_ROWS, 0.0, last));
    let column = (epipolar_gamma(place, to_point.length) - e.gamma_start) / e.gamma_step - 0.5;
    let columns = clamp(column, 0.0, last);
    let dark = vec2f(
        ivsv_dark(e.samples, voxel_row(e.samples, tile * e.samples + slices.index.x, row), columns),
        ivsv_dark(e.samples, voxel_row(e.samples, tile * e.samples + slices.index.y, row), columns),
    );
    var seen = 1.0 - dot(slices.weight, dark);
    // Near the axis distances are compared, as for volumes.
    let by_distance = imperfect_batch.side == 0u || place.off_axis <= e.least_off_axis;
    for (var i = 0u; i < u32(by_distance); i++) {
        seen = f32(imperfect_end(tile, way) > depth);
    }
    return seen;
}

// How dark a row is at a place among its columns' middles, between two of them.
fn ivsv_dark(side: u32, row: u32, place: f32) -> f32 {
    let first = u32(place);
    let second = min(first + 1u, side - 1u);
    let bits = vec2u(voxels[row + first / 32u] >> (first & 31u), voxels[row + second / 32u] >> (second & 31u)) & vec2u(1u);
    return mix(f32(bits.x), f32(bits.y), fract(place));
}
