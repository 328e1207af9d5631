// Takes over the kept picture of the frame before, which another camera took: see temporal/mod.rs. A tile of 8 x 8 pixels
// shares what is asked along its rays.

struct Reproject {
    camera: Camera, // of the frame before
    eye: vec3f, // its eye, relative to this frame's [m]
    tolerance: f32, // of errors, over the brightest value of a tile
    rounding: f32, // relative, of the kept picture's format
}

@group(2) @binding(1) var<uniform> reproject: Reproject;
@group(2) @binding(2) var<storage, read> reproject_state: ReuseSettled;
@group(2) @binding(3) var reproject_kept: texture_2d<f32>;
@group(2) @binding(4) var<storage, read> reproject_depth: array<f32>; // of the frame before
@group(2) @binding(5) var<storage, read> reproject_age: array<u32>; // see REUSE_AGE
// Radiance as bits, and what is remembered of the pixel.
@group(2) @binding(6) var<storage, read_write> reproject_found: array<vec4u>;

const REPROJECT_LANES: u32 = 64u;
// Places that a pixel compares the two rays at.
const REPROJECT_PLACES: u32 = 2u;
// The eye's way is followed for so many frames, so that it meets with shadows.
const REPROJECT_FRAMES: f32 = 16.0;
// A pixel's change over the mean of its tile.
const REPROJECT_ODDS: f32 = 3.0;
// What errors may come to, over their estimates.
const REPROJECT_MARGIN: f32 = 1.5;
// Depths that differ by more are of different surfaces.
const REPROJECT_STEP: f32 = 0.05;

// Sums of changes, and the brightest value.
var<workgroup> reproject_shared: array<vec4f, REPROJECT_LANES>;

// What the frame before has of a pixel, as far as the pixel alone can say.
struct ReprojectPixel {
    value: vec3f,
    is_there: bool,
    error: vec3f, // of this step
    error_before: f32, // of the steps before, of any channel
    age: u32,
}

@compute @workgroup_size(8, 8)
fn reproject_tile(@builtin(global_invocation_id) id: vec3u, @builtin(local_invocation_index) lane: u32) {
    let pixel = min(id.xy, reuse.pixels - 1u);
    let ray = camera_ray(vec2f(pixel) + 0.5, textureLoad(frame_depth, pixel, 0));
    let end = ray.origin + ray.length * ray.direction;
    let seen = camera_project(reproject.camera, end - reproject.eye);
    let found = reproject_pixel(ray, seen);
    let brightest = select(0.0, reproject_most(found.value), found.is_there);
    reproject_shared[lane] = vec4f(reproject_change(ray, end, seen.z, lane), brightest);
    workgroupBarrier();
    for (var half = REPROJECT_LANES / 2u; half > 0u; half /= 2u) {
        if lane < half {
            let a = reproject_shared[lane];
            let b = reproject_shared[lane + half];
            reproject_shared[lane] = vec4f(a.xyz + b.xyz, max(a.w, b.w));
        }
        workgroupBarrier();
    }
    let change = REPROJECT_ODDS / f32(REPROJECT_LANES) * reproject_shared[0].xyz;
    if all(id.xy < reuse.pixels) {
        let memory = reproject_memory(found, change, reproject_shared[0].w);
        reproject_found[reproject_index(pixel)] = vec4u(bitcast<vec3u>(found.value), memory);
    }
}

// What is remembered of a pixel, where its error is small beside the brightest value of the tile.
fn reproject_memory(found: ReprojectPixel, change: vec3f, brightest: f32) -> u32 {
    let error = found.error_before + REPROJECT_MARGIN * reproject_most(found.error + change);
    if found.is_there && error <= reproject.tolerance * brightest {
        return found.age | ((bitcast<u32>(error) + REUSE_AGE) & REUSE_ERROR);
    }
    return REUSE_LOST;
}

// The ray from another origin to the same end.
fn reproject_ray(origin: vec3f, end: vec3f) -> Ray {
    let way = end - origin;
    let length = max(length(way), 1e-20);
    return Ray(origin, length, way / length);
}

// An estimate, of few samples, of the integral of |difference| of the light that the two cameras' rays to the same end
// collect at the same shares of their ways: no less than the difference of the integrals.
fn reproject_change(ray: Ray, end: vec3f, depth_before: f32, lane: u32) -> vec3f {
    let before = select(reproject.eye, end - depth_before * reproject.camera.forward, camera_is_orthographic());
    let other = reproject_ray(ray.origin + REPROJECT_FRAMES * (before - ray.origin), end);
    let ratio = other.length / max(ray.length, 1e-20);
    let span = reproject_span(light_reach(ray), light_reach(other) / ratio);
    if span.x >= span.y {
        return vec3f(0.0);
    }
    let map_ray = shadow_ray(ray);
    let other_map_ray = shadow_ray(other);
    let light_share = light_common(ray);
    let other_share = light_common(other) * ratio;
    var sum = vec3f(0.0);
    for (var k = 0u; k < REPROJECT_PLACES; k++) {
        let at = reproject_at(ray, span, reproject_random(lane, k));
        let now = light_share * march_sample(ray, map_ray, at.x);
        let then = other_share * march_sample(other, other_map_ray, at.x * ratio);
        sum += at.y * abs(now - then);
    }
    return sum / (f32(REPROJECT_PLACES) * REPROJECT_FRAMES);
}

// What covers both spans; either may be empty.
fn reproject_span(a: vec2f, b: vec2f) -> vec2f {
    if a.x >= a.y {
        return b;
    }
    return select(vec2f(min(a.x, b.x), max(a.y, b.y)), a, b.x >= b.y);
}

// A number in [0, 1), in one of the tile's strata each, which turn from frame to frame.
fn reproject_random(lane: u32, k: u32) -> f32 {
    let turn = reproject_state.turn;
    let stratum = (29u * lane + 7u * turn) % REPROJECT_LANES + k * REPROJECT_LANES;
    // O'Neill 2014, PCG.
    var x = ((turn * REPROJECT_LANES + lane) * REPROJECT_PLACES + k) * 747796405u + 2891336453u;
    x = ((x >> ((x >> 28u) + 4u)) ^ x) * 277803737u;
    let jitter = f32(((x >> 22u) ^ x) >> 8u) / 16777216.0;
    return (f32(stratum) + jitter) / f32(REPROJECT_LANES * REPROJECT_PLACES);
}

// A distance on the ray [m] and the length it stands for: by equal angles at a local light (Kulla & Fajardo 2012), by
// equal transmittance under the sun.
fn reproject_at(ray: Ray, span: vec2f, u: f32) -> vec2f {
    if light_is_local() {
        let to_light = light.position - ray.origin;
        let nearest = dot(to_light, ray.direction);
        let height = max(length(to_light - nearest * ray.direction), LIGHT_RADIUS);
        let angles = atan((span - nearest) / height);
        let slope = tan(mix(angles.x, angles.y, u));
        return vec2f(nearest + height * slope, (angles.y - angles.x) * height * (1.0 + slope * slope));
    }
    let sigma = max(dot(frame.medium.sigma_t, vec3f(1.0 / 3.0)), 1e-2 / (span.y - span.x));
    let whole = 1.0 - exp(-sigma * (span.y - span.x));
    let left = 1.0 - u * whole;
    return vec2f(span.x - log(left) / sigma, whole / (sigma * left));
}

// What the frame before has of the pixel whose ray's end it saw at `seen` (place [pixels], view depth).
fn reproject_pixel(ray: Ray, seen: vec3f) -> ReprojectPixel {
    let corner = floor(seen.xy - 0.5);
    let is_inside = all(corner >= vec2f(0.0)) && all(corner + 2.0 <= reproject.camera.size);
    let base = vec2i(clamp(corner, vec2f(0.0), reproject.camera.size));
    let fraction = clamp(seen.xy - 0.5 - corner, vec2f(0.0), vec2f(1.0));
    var value = vec3f(0.0);
    var error_before = 0.0;
    var depth = 0.0;
    var is_one_surface = true;
    for (var k = 0u; k < 4u; k++) {
        let offset = vec2u(k & 1u, k >> 1u);
        let sides = select(1.0 - fraction, fraction, offset == vec2u(1u));
        let weight = sides.x * sides.y;
        let tap = reproject_tap(base + vec2i(offset));
        let index = reproject_index(tap);
        value += weight * reproject_color(tap);
        error_before += weight * bitcast<f32>(reproject_age[index] & REUSE_ERROR);
        let tap_depth = camera_view_depth_of(reproject.camera, reproject_depth[index]);
        is_one_surface = is_one_surface && abs(tap_depth - seen.z) <= REPROJECT_STEP * abs(seen.z);
        // A plane's depth is linear in an orthographic picture, its inverse in a perspective one.
        depth += weight * select(1.0 / tap_depth, tap_depth, camera_is_orthographic());
    }
    depth = select(1.0 / depth, depth, camera_is_orthographic());
    let slack = min(8.0 * fraction * (1.0 - fraction), vec2f(1.0));
    let bent = slack.x * reproject_bend(base, vec2i(1, 0)) + slack.y * reproject_bend(base, vec2i(0, 1));
    let moved = abs(depth - seen.z) / max(abs(seen.z), 1e-20) * ray.length * reproject_unshaded(ray);
    let error = bent + moved + reproject.rounding * value;
    let nearest = reproject_index(reproject_tap(base + vec2i(round(fraction))));
    return ReprojectPixel(value, is_inside && is_one_surface, error, error_before, reproject_age[nearest] & REUSE_AGE);
}

fn reproject_most(color: vec3f) -> f32 {
    return max(color.x, max(color.y, color.z));
}

// The pixel, or the nearest one in the picture.
fn reproject_tap(pixel: vec2i) -> vec2u {
    return vec2u(clamp(pixel, vec2i(0), vec2i(reuse.pixels) - 1));
}

fn reproject_index(pixel: vec2u) -> u32 {
    return pixel.y * reuse.pixels.x + pixel.x;
}

fn reproject_color(pixel: vec2u) -> vec3f {
    return textureLoad(reproject_kept, pixel, 0).rgb;
}

// The largest change of slope at the four pixels from `base` on, along one of the picture's axes.
fn reproject_bend(base: vec2i, along: vec2i) -> vec3f {
    var most = vec3f(0.0);
    for (var k = 0; k < 2; k++) {
        let at = base + k * along.yx;
        let a = reproject_color(reproject_tap(at - along));
        let b = reproject_color(reproject_tap(at));
        let c = reproject_color(reproject_tap(at + along));
        let d = reproject_color(reproject_tap(at + 2 * along));
        most = max(most, max(abs(a - 2.0 * b + c), abs(b - 2.0 * c + d)));
    }
    return most;
}

// The light that a metre at the ray's end scatters towards the eye at most.
fn reproject_unshaded(ray: Ray) -> vec3f {
    let incident = light_incident(ray.origin + ray.length * ray.direction);
    let scattering = medium_scattering(-dot(incident.direction, ray.direction));
    return transmittance(frame.medium.sigma_t, ray.length) * scattering * incident.irradiance;
}
