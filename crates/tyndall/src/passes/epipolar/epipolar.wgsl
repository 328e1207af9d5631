// Epipolar coordinates of one light and one camera (Chen 2011, section 3.2); see epipolar/mod.rs. Space: relative to the eye.

struct Epipolar {
    axis: vec3f, // towards the light; orthographic and local: the viewing direction
    distance: f32, // of a local light from the eye [m]
    across_x: vec3f, // alpha = 0; orthographic and sun: the direction in which gamma grows
    alpha_start: f32,
    across_y: vec3f, // alpha = pi/2; orthographic and sun: the direction in which alpha grows
    alpha_step: f32,
    gamma_start: f32,
    gamma_step: f32,
    b_start: f32, // b is stored as (b - b_start) b_scale, 0 to 65535
    b_scale: f32,
    slices: u32,
    samples: u32, // a power of two
    least_off_axis: f32, // of the rays that slices are for, see EpipolarRay
    cotangent: f32, // orthographic and sun: of the view rays' angle to the axis
    tint_start: f32, // gamma of the columns of tints
    tint_step: f32,
    tint_columns: u32, // 64 times a power of two
    turns: u32, // 1 where the slices are a whole turn
    position: vec3f, // of a local light [m]
}

// A view ray in its slice: gamma of its point at distance s is c.x + s c.y (sun), or the angle of
// (t.x - s t.y, c.x + s c.y), the point seen from the light (local).
struct EpipolarRay {
    place: f32, // among the slices; slice i from i to i + 1
    b: f32, // as stored
    off_axis: f32, // sine of the angle to the axis; orthographic and local: distance from it [m]
    c: vec2f,
    t: vec2f,
}

// Grows from 0 to 2 as the angle of (along, across) to the axis grows from 0 to pi, at the price of a division.
fn epipolar_angle(across: f32, along: f32) -> f32 {
    let share = across / max(across + abs(along), 1e-30);
    return select(2.0 - share, share, along >= 0.0);
}

fn epipolar_outward(e: Epipolar, alpha: f32) -> vec3f {
    return cos(alpha) * e.across_x + sin(alpha) * e.across_y;
}

fn epipolar_ray(e: Epipolar, ray: Ray) -> EpipolarRay {
    if !camera_is_orthographic() {
        let x = vec2f(dot(ray.direction, e.across_x), dot(ray.direction, e.across_y));
        let sine = length(x);
        let cosine = dot(ray.direction, e.axis);
        return EpipolarRay(
            epipolar_place(e, atan2(x.y, x.x)),
            (epipolar_angle(sine, cosine) - e.b_start) * e.b_scale,
            sine,
            vec2f(0.0, sine),
            vec2f(e.distance, cosine),
        );
    }
    if light_is_local() {
        let offset = ray.origin - e.position;
        let x = vec2f(dot(offset, e.across_x), dot(offset, e.across_y));
        let height = length(x);
        return EpipolarRay(
            epipolar_place(e, atan2(x.y, x.x)),
            (height - e.b_start) * e.b_scale,
            height,
            vec2f(height, 0.0),
            vec2f(-dot(offset, e.axis), 1.0),
        );
    }
    let gamma = dot(ray.origin, e.across_x);
    let b = gamma * e.cotangent - dot(ray.origin, e.axis);
    let sine = dot(ray.direction, e.across_x);
    return EpipolarRay(
        epipolar_place(e, dot(ray.origin, e.across_y)),
        (b - e.b_start) * e.b_scale,
        sine,
        vec2f(gamma, sine),
        vec2f(0.0),
    );
}

fn epipolar_place(e: Epipolar, alpha: f32) -> f32 {
    var place = (alpha - e.alpha_start) / e.alpha_step;
    if light_is_local() || !camera_is_orthographic() {
        // A turn further where alpha lies before the first slice.
        let turn = 2.0 * PI / e.alpha_step;
        place -= floor(place / turn) * turn;
        // Rounding may take the last slice's end for a turn before its start.
        place = select(place, 0.0, place > 0.5 * (f32(e.slices) + turn));
    }
    return clamp(place, 0.0, f32(e.slices));
}

fn epipolar_slice(e: Epipolar, r: EpipolarRay) -> u32 {
    return min(u32(r.place), e.slices - 1u);
}

// Two slices and their shares.
struct EpipolarNeighbours {
    index: vec2u,
    weight: vec2f,
}

// The slices on either side of a place, where slice i stands for the place i.
fn epipolar_neighbours(e: Epipolar, place: f32) -> EpipolarNeighbours {
    let last = i32(e.slices) - 1;
    let first = i32(floor(place));
    let share = place - floor(place);
    let open = clamp(vec2i(first, first + 1), vec2i(0), vec2i(last));
    let closed = vec2i(select(first, last, first < 0), select(first + 1, 0, first >= last));
    return EpipolarNeighbours(vec2u(select(open, closed, e.turns == 1u)), vec2f(1.0 - share, share));
}

// gamma of the view ray's point at distance s.
fn epipolar_gamma(r: EpipolarRay, s: f32) -> f32 {
    let across = r.c.x + s * r.c.y;
    if light_is_local() {
        return atan2(across, r.t.x - s * r.t.y);
    }
    return across;
}

// Distance along the view ray where the light ray gamma crosses it; beyond all distances where they do not meet.
fn epipolar_crossing(r: EpipolarRay, gamma: f32) -> f32 {
    if !light_is_local() {
        return (gamma - r.c.x) / r.c.y;
    }
    let sine = sin(gamma);
    let cosine = cos(gamma);
    let divisor = r.c.y * cosine + r.t.y * sine;
    return select(1e30, (r.t.x * sine - r.c.x * cosine) / divisor, divisor > 1e-12);
}

// A point of a light ray, and the way it travels.
struct EpipolarLightRay {
    origin: vec3f,
    way: vec3f,
}

// The light ray gamma of slice alpha, whose outward direction is epipolar_outward.
fn epipolar_light_ray(e: Epipolar, alpha: f32, outward: vec3f, gamma: f32) -> EpipolarLightRay {
    if light_is_local() {
        return EpipolarLightRay(e.position, sin(gamma) * outward - cos(gamma) * e.axis);
    }
    if camera_is_orthographic() {
        return EpipolarLightRay(gamma * e.across_x + alpha * e.across_y, light.direction);
    }
    return EpipolarLightRay(gamma * outward, light.direction);
}

// The range of S, as stored, of all light rays gamma.x..gamma.y that end ends.x..ends.y [m] from their points:
// a point of view ray b is lit iff b < S. The medium beside the map's border has no end: 1e30.
fn epipolar_shadow_range(e: Epipolar, gamma: vec2f, ends: vec2f) -> vec2f {
    var s = vec2f(0.0);
    if !light_is_local() {
        // Extremes of an angle over a box of (gamma, -end), or of a linear function, are at its corners.
        let near = vec2f(epipolar_sun(e, gamma.x, ends.x), epipolar_sun(e, gamma.y, ends.x));
        let far = vec2f(epipolar_sun(e, gamma.x, ends.y), epipolar_sun(e, gamma.y, ends.y));
        s = vec2f(min(near.x, near.y), max(far.x, far.y));
    } else {
        // S grows with the end. Along gamma it has one hump, where the light ray's end is seen farthest from the axis.
        let low = vec2f(epipolar_local(e, gamma.x, ends.x), epipolar_local(e, gamma.y, ends.x));
        let hump = select(acos(min(ends.y / max(e.distance, 1e-20), 1.0)), 0.5 * PI, camera_is_orthographic());
        s = vec2f(min(low.x, low.y), epipolar_local(e, clamp(hump, gamma.x, gamma.y), ends.y));
    }
    return (s - e.b_start) * e.b_scale;
}

// S, as stored, of the light ray gamma that ends `end` [m] from its point.
fn epipolar_shadow(e: Epipolar, gamma: f32, end: f32) -> f32 {
    if light_is_local() {
        return (epipolar_local(e, gamma, end) - e.b_start) * e.b_scale;
    }
    return (epipolar_sun(e, gamma, end) - e.b_start) * e.b_scale;
}

fn epipolar_sun(e: Epipolar, gamma: f32, end: f32) -> f32 {
    if camera_is_orthographic() {
        return gamma * e.cotangent + end;
    }
    return epipolar_angle(gamma, -end);
}

fn epipolar_local(e: Epipolar, gamma: f32, end: f32) -> f32 {
    let across = end * sin(gamma);
    if camera_is_orthographic() {
        return across;
    }
    return epipolar_angle(across, e.distance - end * cos(gamma));
}
