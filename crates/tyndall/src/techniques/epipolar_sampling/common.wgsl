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
