// What every pass of epipolar sampling reads; `EpipolarParams` of gpu.rs.

const EPIPOLAR_CRITERION_DEPTH: u32 = 0u;
const EPIPOLAR_CRITERION_IN_SCATTER: u32 = 1u;

struct EpipolarParams {
    epipole: vec3f, // on the picture [pixels], homogeneous
    slices: u32,
    axis: vec3f, // unit, through the eye and the light
    samples: u32, // a slice
    initial_step: u32, // samples
    threshold: f32, // relative
    criterion: u32,
    columns: u32, // leaves of a tree, a power of two
    levels: u32, // of the tree above its leaves; 0: march without
    downscale: u32,
    show: u32,
    coarse_size: vec2u, // [pixels]
    arc: vec2f, // of the border, that slices end on
}

@group(2) @binding(0) var<uniform> epipolar: EpipolarParams;

// The two slices that a place on the picture [pixels] lies between.
fn epipolar_slices(place: vec2f) -> ScreenSlices {
    let border = screen_border(frame.camera.size, epipolar.epipole, place);
    return screen_slices(epipolar.arc, epipolar.slices, border);
}

// How much a source at one depth may stand for a point at another (Yusov 2012, section 6.6).
fn epipolar_similarity(depth: f32, source: f32) -> f32 {
    let difference = abs(source - depth) / max(min(source, depth), 1e-20);
    let ratio = epipolar.threshold / max(difference, epipolar.threshold);
    let square = ratio * ratio;
    return select(0.0, square * square, source >= 0.0);
}

// Sources of less weight than this together cannot stand for a point.
const EPIPOLAR_LEAST_WEIGHT: f32 = 0.01;

// What interpolated values are shares of: a simple function of the ray that has the light's peak in it. Of the sun the
// integral of the transmittance, so that a share is a mean visibility; of a local light that of 1 / d^2.
fn epipolar_whole(ray: Ray) -> vec3f {
    return epipolar_whole_from(ray, transmittance(frame.medium.sigma_t, ray.length));
}

// The same, where the transmittance of the ray is known.
fn epipolar_whole_from(ray: Ray, left: vec3f) -> vec3f {
    if !light_is_local() {
        return max(transmittance_integral_from_eye(frame.medium.sigma_t, ray.length, left), vec3f(1e-30));
    }
    let to_light = light.position - ray.origin;
    let projection = dot(to_light, ray.direction);
    let height = max(length(to_light - projection * ray.direction), LIGHT_RADIUS);
    return vec3f(max(atan((ray.length - projection) / height) + atan(projection / height), 1e-6) / height);
}
