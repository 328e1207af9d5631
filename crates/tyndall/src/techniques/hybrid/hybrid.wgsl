// Closed forms before and behind the shadow volumes, steps between them.

struct HybridParams {
    steps: u32, // over the whole of a ray
    bounds: u32, // HYBRID_UNKNOWN and so on
    show: u32,
}

// What is known of where shadows are: nothing, that there are none, that the bounds hold every one.
const HYBRID_UNKNOWN: u32 = 0u;
const HYBRID_NONE: u32 = 1u;

const HYBRID_SHOW_LIGHT: u32 = 0u;
// Nearer to the light's own direction than this no wall may be met [cosine].
const HYBRID_PARALLEL: f32 = 0.999999;

@group(2) @binding(0) var<uniform> hybrid_params: HybridParams;
@group(2) @binding(1) var hybrid_bounds: texture_2d<f32>;
@group(2) @binding(2) var airlight_table: texture_2d_array<f32>;

@fragment
fn hybrid(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let ray = frame_ray(position);
    let shaded = hybrid_shaded(ray, textureLoad(hybrid_bounds, vec2u(position.xy), 0).xyz);
    if hybrid_params.show != HYBRID_SHOW_LIGHT {
        return vec4f(shaded.x, shaded.y, shaded.y - shaded.x, 1.0);
    }
    return frame_output(position, ray, hybrid_light(ray, shaded));
}

// The stretch [m] that holds every shadow on the ray; empty where x >= y.
fn hybrid_shaded(ray: Ray, bounds: vec3f) -> vec2f {
    let whole = vec2f(0.0, ray.length);
    let is_flat = camera_is_orthographic();
    let runs_along = !light_is_local() && abs(dot(ray.direction, light.direction)) > HYBRID_PARALLEL;
    if hybrid_params.bounds == HYBRID_NONE {
        return vec2f(ray.length);
    }
    if hybrid_params.bounds == HYBRID_UNKNOWN || (is_flat && runs_along) {
        return whole;
    }
    let may_start_shaded = is_flat && bounds.z > 0.0;
    if all(bounds.xy == vec2f(0.0)) && !may_start_shaded {
        return vec2f(ray.length);
    }
    // A ray that leaves a shadow entered it, and one that enters and does not leave ends there. Rays that do not start in
    // the eye may start in a shadow.
    let front = select(saturate(1.0 - bounds.x), 0.0, is_flat || bounds.x == 0.0);
    let back = select(min(bounds.y, 1.0), 1.0, bounds.y == 0.0 || bounds.z > 0.0);
    return vec2f(front, back) * ray.length;
}

fn hybrid_light(ray: Ray, shaded: vec2f) -> vec3f {
    let reach = light_reach(ray);
    if reach.x >= reach.y {
        return vec3f(0.0);
    }
    let middle = clamp(shaded, vec2f(reach.x), vec2f(reach.y));
    if middle.x >= middle.y {
        return stretch_plain(ray, reach.x, reach.y);
    }
    let share = (middle.y - middle.x) / (reach.y - reach.x);
    let steps = u32(ceil(share * f32(hybrid_params.steps)));
    var sum = march_equal(ray, middle, max(steps, 1u));
    // Of lights through pictures all is in the middle.
    if LIGHT_TEXTURE == LIGHT_TEXTURE_NONE {
        sum += stretch_plain(ray, reach.x, middle.x) + stretch_plain(ray, middle.y, reach.y);
    }
    return sum;
}
