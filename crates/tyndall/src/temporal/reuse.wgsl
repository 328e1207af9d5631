// What all passes of temporal reuse share: see temporal/mod.rs.

struct ReuseParams {
    pixels: vec2u,
    map: vec2u, // texels of a face
    faces: u32, // 0 where there is no shadow map
    generation: u32, // another one whenever more than depth and shadow map has changed
    frames: u32, // kept in a row
    mask: u32, // REUSE_CHANGE or REUSE_GEOMETRY
    margin: f32, // how far from its own ray a pixel looks [pixels]
    reach: u32, // REUSE_RAY or REUSE_PICTURE
    has_witness: u32, // 1 where the last pass reads tiles besides, see occluder/tile.wgsl
    levels: u32, // of blocks
    kin: u32, // another one whenever more than depth, shadow map and camera has changed; 0: the camera counts as well
    dispatches: array<vec4u, 16>, // workgroups of what decides the mask
}

const REUSE_CHANGE: u32 = 0u;
const REUSE_GEOMETRY: u32 = 1u;
const REUSE_RAY: u32 = 0u;
const REUSE_PICTURE: u32 = 1u;

// What a light's picture keeps from frame to frame.
struct ReuseState {
    generation: u32,
    kept: u32, // frames since the last full one
    stale: atomic<u32>, // pixels that this frame computes
    mode: u32, // REUSE_OFF and so on
    rest: u32, // frames that the mask is not asked for
    kin: u32,
    turn: u32, // frames in all
}

// The same once nothing of it is written any more.
struct ReuseSettled {
    generation: u32,
    kept: u32,
    stale: u32,
    mode: u32,
    rest: u32,
    kin: u32,
    turn: u32,
}

// This frame computes all pixels and looks at nothing, computes all and remembers what they were computed from, computes
// those that the mask covers, or besides those that are not found in the picture of another camera.
const REUSE_OFF: u32 = 0u;
const REUSE_REMEMBER: u32 = 1u;
const REUSE_MASKED: u32 = 2u;
const REUSE_REPROJECT: u32 = 3u;

// What is remembered of a pixel: frames since it was computed, and the upper half of a float, rounded upwards, that its error
// may have come to since.
const REUSE_AGE: u32 = 0xffffu;
const REUSE_ERROR: u32 = 0xffff0000u;
// In its place: not found.
const REUSE_LOST: u32 = 0xffffffffu;

@group(2) @binding(0) var<uniform> reuse: ReuseParams;
