// Brute force of a rectangular light: N steps for each of its samples, each looked up in the sample's own map.

@group(2) @binding(0) var<uniform> imperfect_batch: ImperfectBatch;
@group(2) @binding(1) var<storage, read> imperfect_samples: array<ImperfectSample>;
@group(2) @binding(2) var<storage, read> imperfect_maps: array<u32>;
@group(2) @binding(3) var<storage, read> imperfect_colors: array<vec4f>;
@group(2) @binding(4) var<uniform> ray_march_params: RayMarchParams;
@group(2) @binding(5) var<storage, read_write> ray_march_sums: array<vec4f>;

@compute @workgroup_size(8, 8)
fn ray_march_area(@builtin(global_invocation_id) id: vec3u) {
    let size = vec2u(frame.camera.size);
    if any(id.xy >= size) {
        return;
    }
    let ray = frame_ray(vec4f(vec2f(id.xy) + 0.5, 0.0, 1.0));
    let span = light_reach(ray);
    var sum = vec3f(0.0);
    for (var i = 0u; i < select(0u, imperfect_batch.count, span.x < span.y); i++) {
        let first = imperfect_batch.first;
        sum += imperfect_colors[first + i].rgb * ray_march_area_sample(ray, span, imperfect_samples[first + i].position, i);
    }
    let index = id.y * size.x + id.x;
    let before = select(vec4f(0.0), ray_march_sums[index], imperfect_batch.first > 0u);
    ray_march_sums[index] = before + vec4f(sum, 0.0);
}

// Steps of equal length, or of equal angle at the sample (Kulla & Fajardo 2012).
fn ray_march_area_sample(ray: Ray, span: vec2f, position: vec3f, tile: u32) -> vec3f {
    let to_sample = position - ray.origin;
    let nearest = dot(to_sample, ray.direction);
    let height = max(length(to_sample - nearest * ray.direction), LIGHT_RADIUS);
    let is_equiangular = ray_march_params.spacing == RAY_MARCH_EQUIANGULAR;
    let ends = select(span, atan((span - nearest) / height), is_equiangular);
    let step = (ends.y - ends.x) / f32(ray_march_params.steps);
    var sum = vec3f(0.0);
    for (var i = 0u; i < ray_march_params.steps; i++) {
        let at = ends.x + (f32(i) + 0.5) * step;
        let slope = tan(at);
        let s = select(at, nearest + height * slope, is_equiangular);
        let stretch = select(step, step * height * (1.0 + slope * slope), is_equiangular);
        sum += stretch * ray_march_area_point(ray, s, position, tile);
    }
    return sum;
}

fn ray_march_area_point(ray: Ray, s: f32, position: vec3f, tile: u32) -> vec3f {
    let offset = ray.origin + s * ray.direction - position;
    let distance2 = max(dot(offset, offset), LIGHT_RADIUS * LIGHT_RADIUS);
    let distance = sqrt(distance2);
    let way = offset / distance;
    let lit = f32(distance <= imperfect_end(tile, way)) * max(dot(way, light.direction), 0.0) / distance2;
    return lit * medium_scattering(-dot(way, ray.direction)) * transmittance(frame.medium.sigma_t, s + distance);
}
