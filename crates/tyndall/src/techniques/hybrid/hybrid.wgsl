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
@group(2) @binding(1) var<storage, read> hybrid_tiles: array<vec2f>; // see tile.wgsl
@group(2) @binding(2) var airlight_table: texture_2d_array<f32>;

@fragment
fn hybrid(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let ray = frame_ray(position);
    let shaded = hybrid_shaded(ray, vec2u(position.xy));
    if hybrid_params.show != HYBRID_SHOW_LIGHT {
        return vec4f(shaded.x, shaded.y, shaded.y - shaded.x, 1.0);
    }
    return frame_output(position, ray, hybrid_light(ray, shaded));
}

// The stretch [m] that holds every shadow on the ray; empty where x >= y.
fn hybrid_shaded(ray: Ray, pixel: vec2u) -> vec2f {
    let lit = vec2f(ray.length);
    let whole = vec2f(0.0, ray.length);
    let is_flat = camera_is_orthographic();
    // Along the light no wall may be met, and of a flat camera's rays some may be in a lamp's shadow from end to end.
    let runs_along = abs(dot(ray.direction, light.direction)) > HYBRID_PARALLEL;
    if hybrid_params.bounds == HYBRID_NONE {
        return lit;
    }
    if hybrid_params.bounds == HYBRID_UNKNOWN || (is_flat && (light_is_local() || runs_along)) {
        return whole;
    }
    let bounds = hybrid_tiles[occluder_tile_of(pixel)];
    if !occluder_is_met(bounds) {
        return lit;
    }
    // A ray that leaves a shadow entered it, and one that enters and does not leave ends there. Rays that do not start in
    // the eye may start in a shadow.
    let depths = vec2f(
        select(bounds.x, 0.0, is_flat || bounds.x == OCCLUDER_BEYOND),
        select(bounds.y, OCCLUDER_BEYOND, bounds.y == 0.0),
    );
    return min(depths / dot(ray.direction, frame.camera.forward), vec2f(ray.length));
}

fn hybrid_light(ray: Ray, shaded: vec2f) -> vec3f {
    let reach = light_reach(ray);
    if reach.x >= reach.y {
        return vec3f(0.0);
    }
    let within = clamp(shaded, vec2f(reach.x), vec2f(reach.y));
    let middle = select(within, vec2f(reach.y), within.x >= within.y);
    let share = (middle.y - middle.x) / (reach.y - reach.x);
    let steps = u32(ceil(share * f32(hybrid_params.steps)));
    var sum = march_equal(ray, middle, steps);
    // Of lights through pictures all is in the middle. Turns of a loop cost nothing where there is nothing behind it.
    let stretches = select(2u, 1u, middle.y >= reach.y);
    for (var i = 0u; i < select(0u, stretches, LIGHT_TEXTURE == LIGHT_TEXTURE_NONE); i++) {
        let stretch = select(vec2f(reach.x, middle.x), vec2f(middle.y, reach.y), i == 1u);
        sum += stretch_plain(ray, stretch.x, stretch.y);
    }
    return sum;
}
