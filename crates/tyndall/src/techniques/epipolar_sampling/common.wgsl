// What every pass of epipolar sampling reads; `SamplingParams` of gpu.rs.

const SAMPLING_CRITERION_DEPTH: u32 = 0u;
const SAMPLING_CRITERION_IN_SCATTER: u32 = 1u;

struct SamplingParams {
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

@group(2) @binding(0) var<uniform> sampling: SamplingParams;

// View depth of a pixel [m] (the article's stage 1).
fn sampling_view_depth(pixel: vec2u) -> f32 {
    return camera_view_depth(textureLoad(frame_depth, pixel, 0));
}

// The two slices that a place on the picture [pixels] lies between.
fn sampling_slices(place: vec2f) -> ScreenSlices {
    let border = screen_border(frame.camera.size, sampling.epipole, place);
    return screen_slices(sampling.arc, sampling.slices, border);
}

// How much a source at one depth may stand for a point at another (Yusov 2012, section 6.6).
fn sampling_similarity(depth: f32, source: f32) -> f32 {
    let difference = abs(source - depth) / max(min(source, depth), 1e-20);
    let ratio = sampling.threshold / max(difference, sampling.threshold);
    let square = ratio * ratio;
    return select(0.0, square * square, source >= 0.0);
}

// Sources of less weight than this together cannot stand for a point.
const SAMPLING_LEAST_WEIGHT: f32 = 0.01;

// Lengths of lists are this many words apart: each is the vertices of an indirect draw of as many points.
const SAMPLING_COUNT: u32 = 4u;
