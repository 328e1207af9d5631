// Epipolar lines on the picture [pixels], (0, 0) at its top left corner; see epipole.rs. The epipole is homogeneous, z >= 0:
// with z = 0 the lines are parallel.

// Lines begin and end this far outside the picture [pixels]: pixels of its rim have samples on both sides, and no line
// that begins at an epipole on the picture is shorter.
const SCREEN_MARGIN: f32 = 1.0;

// How far from an epipole on the picture lines begin [pixels]: there the light depends on the slice, at the epipole on none.
const SCREEN_EPIPOLE_RADIUS: f32 = 0.05;

// Where sample 0 of a line lies, and the way from each sample to the next; no way where the picture shows nothing of it.
struct ScreenLine {
    entry: vec2f,
    step: vec2f,
}

// The point of the border at a parameter in [0, 1): counter-clockwise from the top left corner, a quarter a side
// (Yusov 2012, section 6.1).
fn screen_exit(size: vec2f, border: f32) -> vec2f {
    let side = min(u32(border * 4.0), 3u);
    let along = border * 4.0 - f32(side);
    var place = vec2f(1.0 - along, 0.0);
    switch side {
        case 0u: { place = vec2f(0.0, along); }
        case 1u: { place = vec2f(along, 1.0); }
        case 2u: { place = vec2f(1.0, 1.0 - along); }
        default: {}
    }
    return place * (size + 2.0 * SCREEN_MARGIN) - SCREEN_MARGIN;
}

// The unit direction away from the epipole.
fn screen_direction(epipole: vec3f, point: vec2f) -> vec2f {
    let way = point * epipole.z - epipole.xy;
    let length2 = dot(way, way);
    return select(vec2f(1.0, 0.0), way * inverseSqrt(max(length2, 1e-30)), length2 > 1e-20);
}

// How far one can go from a point inside the border, axis by axis, until the border is met.
fn screen_reach(size: vec2f, point: vec2f, direction: vec2f) -> vec2f {
    let border = select(vec2f(-SCREEN_MARGIN), size + SCREEN_MARGIN, direction > vec2f(0.0));
    let along = abs(direction) < vec2f(1e-20);
    let way = select(direction, vec2f(1.0), along);
    return select(max((border - point) / way, vec2f(0.0)), vec2f(1e20), along);
}

fn screen_epipole_is_inside(size: vec2f, epipole: vec3f) -> bool {
    let low = vec2f(-SCREEN_MARGIN) * epipole.z;
    let high = (size + SCREEN_MARGIN) * epipole.z;
    return epipole.z > 0.0 && all(epipole.xy >= low) && all(epipole.xy <= high);
}

// Where the line to an exit begins: at an epipole on the picture, else where it comes in over the border.
fn screen_entry(size: vec2f, epipole: vec3f, exit: vec2f) -> vec2f {
    let direction = screen_direction(epipole, exit);
    let starts_inside = frame_choice(u32(screen_epipole_is_inside(size, epipole))) == 1u;
    if starts_inside {
        return epipole.xy / epipole.z + SCREEN_EPIPOLE_RADIUS * direction;
    }
    let back = screen_reach(size, exit, -direction);
    return exit - direction * min(back.x, back.y);
}

// The line to the border's parameter. Samples are no denser than pixels: a short line goes on past its exit.
fn screen_line(size: vec2f, epipole: vec3f, border: f32, samples: u32) -> ScreenLine {
    let exit = screen_exit(size, border);
    let entry = screen_entry(size, epipole, exit);
    let way = exit - entry;
    let length = length(way);
    if length <= 0.5 * SCREEN_EPIPOLE_RADIUS {
        return ScreenLine(entry, vec2f(0.0));
    }
    return ScreenLine(entry, way / length * max(length / f32(samples - 1u), 1.0));
}

// The two slices that a place lies between, and how near it is to the second.
struct ScreenSlices {
    first: u32,
    second: u32,
    share: f32,
}

// The border's parameter of a slice: slices are spread over an arc of the border, (start, length), that all lines of the
// picture end on; of length 1 it is closed.
fn screen_slice_border(arc: vec2f, slices: u32, slice: u32) -> f32 {
    return fract(arc.x + arc.y * (f32(slice) + 0.5) / f32(slices));
}

fn screen_slices(arc: vec2f, slices: u32, border: f32) -> ScreenSlices {
    let along = fract(border - arc.x);
    let count = f32(slices);
    let is_closed = frame_choice(u32(arc.y >= 1.0)) == 1u;
    if is_closed {
        let place = along * count - 0.5;
        let first = u32(floor(place) + count) % slices;
        return ScreenSlices(first, (first + 1u) % slices, place - floor(place));
    }
    // Past the arc's ends by rounding alone.
    let inside = select(along, 0.0, along > 0.5 + 0.5 * arc.y);
    let place = clamp(inside / arc.y * count - 0.5, 0.0, count - 1.0);
    let first = u32(place);
    return ScreenSlices(first, min(first + 1u, slices - 1u), place - f32(first));
}

// The border's parameter of the line through a pixel: from the pixel on, away from the epipole, to the border.
fn screen_border(size: vec2f, epipole: vec3f, pixel: vec2f) -> f32 {
    let direction = screen_direction(epipole, pixel);
    let reach = screen_reach(size, pixel, direction);
    let exit = pixel + direction * min(reach.x, reach.y);
    let place = saturate((exit + SCREEN_MARGIN) / (size + 2.0 * SCREEN_MARGIN));
    var border = 0.0;
    if reach.x < reach.y {
        border = select(place.y, 3.0 - place.y, direction.x > 0.0);
    } else {
        border = select(4.0 - place.x, 1.0 + place.x, direction.y > 0.0);
    }
    return fract(0.25 * border);
}

// The sample of a line nearest to a pixel, as a real number.
fn screen_sample(line: ScreenLine, pixel: vec2f) -> f32 {
    return dot(pixel - line.entry, line.step) / max(dot(line.step, line.step), 1e-20);
}
