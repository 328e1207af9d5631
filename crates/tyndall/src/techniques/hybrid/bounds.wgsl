// The nearest and the farthest piece of the shadow volumes' boundary along a pixel's ray, blended by the larger:
// (1 - nearest / length, farthest / length, 1 where the ray may stay in a shadow for ever); zero where there is none.
// Rounded outwards, for half floats that are cut off.

const BOUNDS_ROUNDING: f32 = 1.0 + 1.0 / 512.0;

@fragment
fn bounds_of_boundary(in: OccluderVertex) -> @location(0) vec4f {
    let ray = frame_ray(in.position);
    let offset = in.anchor - ray.origin;
    let slope = dot(in.normal, ray.direction);
    let steepness = abs(slope) - in.slack;
    // Along the ray, or of no certain direction: anywhere.
    if !(steepness > 0.0) || ray.length <= 0.0 {
        return vec4f(1.0, 1.0, 0.0, 0.0) * BOUNDS_ROUNDING;
    }
    let s = dot(in.normal, offset) / slope;
    let from_anchor = length(s * ray.direction - offset);
    let off = (in.slack * from_anchor + OCCLUDER_ROUNDING * length(in.anchor)) / steepness;
    let nearest = max(1.0 - (s - off) / ray.length, 0.0);
    let farthest = saturate((s + off) / ray.length);
    // Behind the ray's start.
    if s + off < 0.0 {
        discard;
    }
    if in.side == OCCLUDER_ENTERS {
        return select(
            vec4f(0.0, farthest, 0.0, 0.0),
            vec4f(nearest, 0.0, 0.0, 0.0),
            slope > 0.0,
        ) * BOUNDS_ROUNDING;
    }
    // Not certain which; beyond the ray's end it is no matter.
    return vec4f(min(nearest, 1.0), select(farthest, 0.0, nearest == 0.0), 0.0, 0.0) * BOUNDS_ROUNDING;
}

// What ends at infinity.
@fragment
fn bounds_of_far_cap() -> @location(0) vec4f {
    return vec4f(0.0, 0.0, 1.0, 0.0);
}
