//! Where the epipolar lines of a picture meet.

use glam::{DVec2, DVec3};

use crate::{camera::CameraRays, frame::Emitter, physics::medium::reals};

/// A light nearer to the eye than this [m] has no place of its own on the picture.
const LEAST_DISTANCE: f64 = 1e-6;

/// The point of the picture that all epipolar lines pass through, and the axis that all slices contain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Epipole {
    /// Homogeneous place on the picture [pixels], z >= 0; with z = 0 the lines are parallel. Of an epipole behind the
    /// camera it is the place opposite. Its largest component, in units of the picture, is 1.
    pub(crate) place: DVec3,
    /// Unit direction of the line through eye and light (orthographic: of the view rays), towards the light.
    pub(crate) axis: DVec3,
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
        let degenerate = at_eye || scale <= 1e-6 * distance;
        let place = if degenerate {
            (0.5 * size).extend(1.0)
        } else {
            place / scale * if place.z < 0.0 { -1.0 } else { 1.0 }
        };
        Self { place, axis }
    }
}
