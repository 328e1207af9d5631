//! Where the epipolar lines of a picture meet, and where they leave it.

use glam::{DVec2, DVec3};

use crate::{camera::CameraRays, frame::Emitter, physics::medium::reals};

/// A light nearer to the eye than this [m] has no place of its own on the picture.
const LEAST_DISTANCE: f64 = 1e-6;
/// Lines begin and end this far outside the picture [pixels]; as in `screen.wgsl`.
const MARGIN: f64 = 1.0;

/// The point of the picture that all epipolar lines pass through, and the axis that all slices contain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Epipole {
    /// Homogeneous place on the picture [pixels], z >= 0; with z = 0 the lines are parallel. Of an epipole behind the
    /// camera it is the place opposite. Its largest component, in units of the picture, is 1.
    pub(crate) place: DVec3,
    /// Unit direction of the line through eye and light (orthographic: of the view rays), towards the light.
    pub(crate) axis: DVec3,
    /// The part of the border that all lines end on: where it starts, and its length; see [`exit`] for the parameter.
    pub(crate) arc: [f64; 2],
}

impl Epipole {
    /// Of a light that is not a rectangle. Where it has no place of its own (the eye is at the light, or the sun shines along
    /// the rays of an orthographic camera) every bundle of lines will do: they meet in the middle.
    pub(crate) fn new(camera: &CameraRays, size: [u32; 2], emitter: &Emitter) -> Self {
        let (to_light, w) = match *emitter {
            Emitter::Directional { direction, .. } => (-reals(direction).normalize_or_zero(), 0.0),
            Emitter::Point { position, .. } | Emitter::Spot { position, .. } => {
                (reals(position) - camera.eye, 1.0)
            }
            Emitter::Rect { center, .. } => (reals(center) - camera.eye, 1.0),
        };
        let size = DVec2::new(f64::from(size[0]), f64::from(size[1]));
        let distance = to_light.length();
        let axis = if camera.is_perspective() && distance > LEAST_DISTANCE {
            to_light / distance
        } else {
            camera.forward
        };
        let place = camera.homogeneous_pixel(to_light, w);
        let scale = (place.truncate() / size).abs().max_element().max(place.z.abs());
        let at_eye = camera.is_perspective() && distance <= LEAST_DISTANCE;
        let place = if at_eye || scale <= 1e-6 * distance {
            (0.5 * size).extend(1.0)
        } else {
            place / scale * if place.z < 0.0 { -1.0 } else { 1.0 }
        };
        Self {
            place,
            axis,
            arc: arc(size, place),
        }
    }
}

/// The point of the border at a parameter in [0, 1): counter-clockwise from the top left corner, a quarter a side
/// (Yusov 2012, section 6.1).
fn exit(size: DVec2, border: f64) -> DVec2 {
    let side = (4.0 * border).floor().clamp(0.0, 3.0);
    let along = 4.0 * border - side;
    let place = match side as u32 {
        0 => DVec2::new(0.0, along),
        1 => DVec2::new(along, 1.0),
        2 => DVec2::new(1.0, 1.0 - along),
        _ => DVec2::new(1.0 - along, 0.0),
    };
    place * (size + 2.0 * MARGIN) - MARGIN
}

/// The part of the border that lies behind the picture as seen from the epipole: from the corner on one side to that on the
/// other; all of it where the epipole is on the picture.
fn arc(size: DVec2, epipole: DVec3) -> [f64; 2] {
    let away = |p: DVec2| p * epipole.z - epipole.truncate();
    let inside = |p: DVec2| {
        epipole.z > 0.0 && p.cmpge(DVec2::splat(-MARGIN)).all() && p.cmple(size + MARGIN).all()
    };
    if inside(epipole.truncate() / epipole.z) {
        return [0.0, 1.0];
    }
    let middle = away(0.5 * size);
    let corners = [0.0, 0.25, 0.5, 0.75].map(|border| {
        let way = away(exit(size, border));
        (middle.perp_dot(way).atan2(middle.dot(way)), border)
    });
    let first = corners.iter().copied().fold(corners[0], |a, b| if b.0 < a.0 { b } else { a });
    let last = corners.iter().copied().fold(corners[0], |a, b| if b.0 > a.0 { b } else { a });
    let between = |from: f64, to: f64| [from, (to - from).rem_euclid(1.0)];
    let [near, far] = [between(first.1, last.1), between(last.1, first.1)];
    let distance = |[start, length]: [f64; 2]| {
        middle.dot(away(exit(size, (start + 0.5 * length).rem_euclid(1.0))))
    };
    if distance(near) > distance(far) { near } else { far }
}
