//! The point where the epipolar lines of an image meet, and the part of its border where they leave it.

use glam::{DVec2, DVec3};

use crate::{camera::CameraRays, frame::Emitter, physics::reals};

/// A light nearer to the eye than this share of the near plane's distance has no place of its own on the image.
const LEAST_DISTANCE: f64 = 1e-6;

/// The point of the image that all epipolar lines pass through, and the axis that all slices contain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Epipole {
    /// Homogeneous place on the image \[pixels], z >= 0; with z = 0 the lines are parallel. An epipole behind the
    /// camera has the place opposite. Its largest component, in units of the image, is 1.
    pub(crate) place: DVec3,
    /// Unit direction of the line through eye and light (orthographic: of the view rays), towards the light.
    pub(crate) axis: DVec3,
    /// The part of the border that all lines end on: where it starts, and its length; see [`exit`] for the parameter.
    pub(crate) arc: [f64; 2],
}

impl Epipole {
    /// The epipole of a light that is not a rectangle, of lines that begin and end `margin` \[pixels] outside the image.
    /// A light without a place of its own (the eye is at the light, or the sun shines along the rays of an orthographic
    /// camera) may take any bundle of lines: they meet in the middle.
    pub(crate) fn new(camera: &CameraRays, size: [u32; 2], emitter: &Emitter, margin: f64) -> Self {
        let (to_light, w) = match *emitter {
            Emitter::Directional { direction, .. } => (-reals(direction).normalize_or_zero(), 0.0),
            Emitter::Point { position, .. } | Emitter::Spot { position, .. } => {
                (reals(position) - camera.eye, 1.0)
            }
            Emitter::Rect { center, .. } => (reals(center) - camera.eye, 1.0),
        };
        let size = DVec2::new(f64::from(size[0]), f64::from(size[1]));
        let distance = to_light.length();
        let at_eye = camera.is_perspective() && distance <= LEAST_DISTANCE * camera.planes()[0];
        let axis = if camera.is_perspective() && !at_eye {
            to_light / distance
        } else {
            camera.forward
        };
        let place = camera.homogeneous_pixel(to_light, w);
        let scale = (place.truncate() / size)
            .abs()
            .max_element()
            .max(place.z.abs());
        let place = if at_eye || scale <= 1e-6 * distance {
            (0.5 * size).extend(1.0)
        } else {
            place / scale * if place.z < 0.0 { -1.0 } else { 1.0 }
        };
        Self {
            place,
            axis,
            arc: arc(size, place, margin),
        }
    }
}

/// The point of the border at a parameter in [0, 1): counter-clockwise from the top left corner, a quarter a side
/// (Yusov 2012, section 6.1).
fn exit(size: DVec2, border: f64, margin: f64) -> DVec2 {
    let side = (4.0 * border).floor().clamp(0.0, 3.0);
    let along = 4.0 * border - side;
    let place = match side as u32 {
        0 => DVec2::new(0.0, along),
        1 => DVec2::new(along, 1.0),
        2 => DVec2::new(1.0, 1.0 - along),
        _ => DVec2::new(1.0 - along, 0.0),
    };
    place * (size + 2.0 * margin) - margin
}

/// The part of the border that lies behind the image as seen from the epipole: from the corner on one side to that on the
/// other; all of it where the epipole is on the image.
fn arc(size: DVec2, epipole: DVec3, margin: f64) -> [f64; 2] {
    let away = |p: DVec2| p * epipole.z - epipole.truncate();
    let inside = |p: DVec2| {
        epipole.z > 0.0 && p.cmpge(DVec2::splat(-margin)).all() && p.cmple(size + margin).all()
    };
    if inside(epipole.truncate() / epipole.z) {
        return [0.0, 1.0];
    }
    let middle = away(0.5 * size);
    let corners = [0.0, 0.25, 0.5, 0.75].map(|border| {
        // The angle between the directions to the middle and to the corner; in parallel lines their order is left.
        let corner = exit(size, border, margin);
        let across = epipole.z.max(1e-9) * middle.perp_dot(corner - 0.5 * size);
        (across.atan2(middle.dot(away(corner))), border)
    });
    let first = corners
        .iter()
        .copied()
        .fold(corners[0], |a, b| if b.0 < a.0 { b } else { a });
    let last = corners
        .iter()
        .copied()
        .fold(corners[0], |a, b| if b.0 > a.0 { b } else { a });
    let between = |from: f64, to: f64| [from, (to - from).rem_euclid(1.0)];
    let [near, far] = [between(first.1, last.1), between(last.1, first.1)];
    let distance = |[start, length]: [f64; 2]| {
        let border = (start + 0.5 * length).rem_euclid(1.0);
        middle.dot(away(exit(size, border, margin)))
    };
    if distance(near) > distance(far) {
        near
    } else {
        far
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::Camera;
    use glam::DVec2;
    use tyndall_testkit::{device::device_or_skip, samples::in_box, wgsl};

    const SIZE: [u32; 2] = [320, 200];

    fn margin() -> f64 {
        crate::shader::constant("SCREEN_MARGIN_PIXELS").into()
    }

    fn camera() -> CameraRays {
        let target = [0.3, -0.2, -1.0];
        let camera = Camera::perspective([0.0; 3], target, [0.0, 1.0, 0.0], 1.1, 1.6, 0.1, 9.0);
        CameraRays::new(&camera, SIZE)
    }

    /// Places of the epipole on the image \[pixels], behind the camera where z < 0: on it, at its rim, in and beside a
    /// corner, off each side, far away, at infinity.
    fn epipoles() -> Vec<DVec3> {
        let [w, h] = SIZE.map(f64::from);
        let places = [
            [0.4 * w, 0.7 * h],
            [0.5 * w, 0.2],
            [0.0, 0.5 * h],
            [0.0, 0.0],
            [w, h],
            [w + 1.0, -1.0],
            [-1.5, 0.3 * h],
            [-w, 0.3 * h],
            [2.0 * w, 0.6 * h],
            [0.6 * w, -h],
            [0.3 * w, 3.0 * h],
            [-9e5, 4e5],
        ];
        let there = |[x, y]: [f64; 2]| DVec3::new(x, y, 1.0);
        let finite = places.iter().copied().map(there);
        let behind = places.iter().copied().map(|p| -there(p));
        let infinite = [[1.0, 0.0], [0.0, -1.0], [-3.0, 2.0]].map(|[x, y]| DVec3::new(x, y, 0.0));
        finite.chain(behind).chain(infinite).collect()
    }

    fn normalized(place: DVec3) -> DVec3 {
        let size = DVec2::new(f64::from(SIZE[0]), f64::from(SIZE[1]));
        let scale = (place.truncate() / size)
            .abs()
            .max_element()
            .max(place.z.abs());
        place / scale * if place.z < 0.0 { -1.0 } else { 1.0 }
    }

    /// The sun and a lamp towards a point of the image have their epipole there, or opposite where they are behind.
    #[test]
    fn an_epipole_is_where_the_light_is_seen() {
        let camera = camera();
        for x in in_box(3, 300, [-100.0..=420.0, -90.0..=290.0, 0.5..=20.0]) {
            let [px, py, distance] = x.map(f64::from);
            let direction = camera.direction(px, py);
            for sign in [1.0, -1.0] {
                let sun = Emitter::Directional {
                    direction: (-sign * direction).as_vec3().to_array(),
                    illuminance: [1.0; 3],
                };
                let lamp = Emitter::Point {
                    position: (sign * distance * direction).as_vec3().to_array(),
                    intensity: [1.0; 3],
                    radius: 0.0,
                };
                for emitter in [sun, lamp] {
                    let found = Epipole::new(&camera, SIZE, &emitter, margin());
                    let place = found.place.truncate() / found.place.z;
                    // f32 directions: measured 4.3e-5 pixels.
                    assert!(
                        (place - DVec2::new(px, py)).length() < 1e-4,
                        "{place} {x:?}"
                    );
                    assert!((found.axis - sign * direction).length() < 1e-6);
                }
            }
        }
    }

    #[test]
    fn where_there_is_no_epipole_lines_meet_in_the_middle() {
        let middle = DVec3::new(160.0, 100.0, 1.0);
        let lamp = Emitter::Point {
            position: [0.0; 3],
            intensity: [1.0; 3],
            radius: 0.0,
        };
        let camera = camera();
        let found = Epipole::new(&camera, SIZE, &lamp, margin());
        assert_eq!((found.place, found.axis), (middle, camera.forward));
        let mut flat = Camera::perspective(
            [0.0; 3],
            [0.0, 0.0, -1.0],
            [0.0, 1.0, 0.0],
            1.0,
            1.6,
            0.1,
            9.0,
        );
        flat.projection = crate::frame::Projection::Orthographic {
            half_extent: [4.0, 2.5],
            center: [0.5, 0.0],
            near: 0.1,
            far: 9.0,
        };
        let along = Emitter::Directional {
            direction: [0.0, 0.0, -1.0],
            illuminance: [1.0; 3],
        };
        let found = Epipole::new(&CameraRays::new(&flat, SIZE), SIZE, &along, margin());
        assert_eq!(found.place, middle);
    }

    /// For every epipole and random pixels: the line to the pixel's border parameter passes through the pixel, begins at the
    /// border or beside the epipole, and the border parameter lies on the arc between two neighbouring slices.
    #[test]
    fn every_pixel_lies_on_a_line_of_the_arc() {
        let Some(gpu) = device_or_skip("screen.wgsl") else {
            return;
        };
        let size = DVec2::new(f64::from(SIZE[0]), f64::from(SIZE[1]));
        let samples = 64;
        for epipole in epipoles().into_iter().map(normalized) {
            let [start, length] = arc(size, epipole, margin());
            let [ex, ey, ez] = epipole.as_vec3().to_array();
            let pixels = in_box(9, 500, [0.5..=319.5, 0.5..=199.5]);
            let inputs: Vec<[f32; 7]> = pixels
                .iter()
                .map(|[x, y]| [ex, ey, ez, *x, *y, start as f32, length as f32])
                .collect();
            let evaluate = |expression: &str| {
                let prelude = "
import tyndall::passes::epipolar::screen::{
    ScreenLine, screen_border, screen_line, screen_sample, screen_slice_border, screen_slices};
                    fn test_line(x: array<f32, 7>) -> ScreenLine {
                        let epipole = vec3f(x[0], x[1], x[2]);
                        let border = screen_border(vec2f(320.0, 200.0), epipole, vec2f(x[3], x[4]));
                        return screen_line(vec2f(320.0, 200.0), epipole, border, 64u);
                    }
                    fn test_slices(x: array<f32, 7>) -> vec4f {
                        let border = screen_border(vec2f(320.0, 200.0), vec3f(x[0], x[1], x[2]), vec2f(x[3], x[4]));
                        let slices = screen_slices(vec2f(x[5], x[6]), 100u, border);
                        return vec4f(border, f32(slices.first), f32(slices.second), slices.share);
                    }
                    fn test_sample(x: array<f32, 7>) -> f32 {
                        return screen_sample(test_line(x), vec2f(x[3], x[4]));
                    }
                    fn test_exit(x: array<f32, 7>, slice: f32) -> f32 {
                        return screen_slice_border(vec2f(x[5], x[6]), 100u, u32(slice));
                    }";
                let prelude = crate::shader::tests::harness(prelude, &[], &[]);
                wgsl::evaluate(gpu, &[&prelude], expression, &inputs).expect("it runs")
            };
            let lines = evaluate("test_line(x).entry, test_line(x).step");
            let sample = evaluate("test_sample(x)");
            let slices = evaluate("test_slices(x)");
            let borders = evaluate(
                "test_exit(x, test_slices(x).y), test_exit(x, test_slices(x).z), 0.0, 0.0",
            );
            for i in 0..inputs.len() {
                let pixel = DVec2::new(pixels[i][0].into(), pixels[i][1].into());
                let [x, y, dx, dy] = lines[i].map(f64::from);
                let (entry, step) = (DVec2::new(x, y), DVec2::new(dx, dy));
                let place = entry + f64::from(sample[i][0]) * step;
                // Measured 2.2e-3, of an epipole 9e5 pixels away; 1e-3 on the image.
                assert!(
                    (place - pixel).length() < 5e-3,
                    "{epipole} {pixel}: {place}"
                );
                assert!(
                    (-0.1..f64::from(samples)).contains(&f64::from(sample[i][0])),
                    "{epipole} {pixel}"
                );
                assert!(entry.cmpge(DVec2::splat(-1.001)).all() && entry.cmple(size + 1.001).all());
                assert!(
                    step.length() > 0.999,
                    "no line may be missing: {epipole} {pixel}"
                );
                // Its two slices are on either side, but at the ends of an open arc.
                let [border, first, second, share] = slices[i].map(f64::from);
                let from = |a: f64| (a - f64::from(borders[i][0]) + 0.5).rem_euclid(1.0) - 0.5;
                let gap = from(f64::from(borders[i][1]));
                let along = from(border);
                if first == second || share == 0.0 {
                    assert!(
                        along.abs() < 0.51 * length / 100.0 + 1e-5,
                        "{epipole} {pixel} {along}"
                    );
                } else {
                    assert!(
                        (gap - length / 100.0).abs() < 1e-5,
                        "{epipole} {gap} {length}"
                    );
                    // Measured 3e-4 of the gap at f32.
                    assert!(
                        (along - share * gap).abs() < 1e-3 * gap + 1e-6,
                        "{epipole} {pixel}"
                    );
                }
                assert!((0.0..=1.0).contains(&share) && first < 100.0 && second < 100.0);
            }
        }
    }
}
