// Samples of a rectangular light and their hemispherical maps; see shadow/imperfect/mod.rs. Needs frame and light.

// The samples of one batch, and what their maps are made of.
struct ImperfectBatch {
    first: u32, // sample
    count: u32, // of samples
    total: u32, // of samples in all batches
    side: u32, // texels of a map; 0: nothing blocks the light
    points: u32, // a map's
    cloud: u32, // points there are
    spread: f32, // radius of a point over that which the cloud gives it
    share: f32, // of the light's area, a sample's [m^2]
}

struct ImperfectSample {
    position: vec3f, // relative to the eye [m]
    first_point: u32,
    world: vec3f, // the same in world space
    tangent: vec3f, // unit, in the light's plane
}

// What a texel holds that nothing was drawn on.
const IMPERFECT_NOTHING: u32 = 0xffffffffu;

// A way that a sample's light goes, in its own frame; z along the light's normal.
fn imperfect_local(sample: ImperfectSample, way: vec3f) -> vec3f {
    let bitangent = cross(light.direction, sample.tangent);
    return vec3f(dot(way, sample.tangent), dot(way, bitangent), dot(way, light.direction));
}

// The place on the map, (0, 0) to (1, 1), of a way with z >= 0, of any length: half an octahedron, turned by 45 degrees
// (after Cigolle et al. 2014, "hemi-oct").
fn imperfect_place(local: vec3f) -> vec2f {
    let p = local.xy / max(abs(local.x) + abs(local.y) + local.z, 1e-30);
    return 0.5 + 0.5 * vec2f(p.x + p.y, p.x - p.y);
}

// The index of the texel of a map at this place.
fn imperfect_texel(side: u32, place: vec2f) -> u32 {
    let texel = min(vec2u(place * f32(side)), vec2u(side - 1u));
    return texel.y * side + texel.x;
}

// How many texels a point of this radius covers beyond the one it falls on.
fn imperfect_reach(side: u32, radius: f32, distance: f32) -> i32 {
    // A texel's mean solid angle is 2 pi / side^2.
    let texels = 0.5 * radius / max(distance, 1e-20) * f32(side) / sqrt(2.0 * PI);
    return i32(min(texels, 3.0));
}
