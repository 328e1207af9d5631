//! Cameras at random within a scene and beside it, close to the light, and with the light on the picture, on its border, in
//! its corners, off each of its sides and behind.

use std::ops::Range;

use glam::{Mat3, Quat, Vec3, vec3};
use tyndall::frame::{Camera, Emitter, Projection};

use crate::{bench::subject::bounds, load::ShotFrame, samples::in_box};

/// The cameras of these numbers; the same ones each time.
pub(super) fn cameras(shot_frame: &ShotFrame, poses: Range<usize>) -> Vec<(usize, Camera)> {
    let numbers = in_box(1, poses.end, [const { -1.0..=1.0 }; 9]);
    let numbers = poses.clone().zip(&numbers[poses]);
    numbers
        .map(|(pose, x)| (pose, camera(shot_frame, pose, x)))
        .collect()
}

/// Camera number `pose` of random numbers within [-1, 1]: anywhere, with the light at a chosen place of the picture, at the
/// light, or from outside; every tenth orthographic, every tenth wide.
fn camera(shot_frame: &ShotFrame, pose: usize, x: &[f32; 9]) -> Camera {
    let vector = |n: usize| vec3(x[n], x[n + 1], x[n + 2]);
    let bounds = bounds(shot_frame);
    let (center, half) = (bounds.center(), 0.5 * bounds.extent());
    let [width_in_pixels, height] = shot_frame.size.map(|side| side as f32);
    let aspect = width_in_pixels / height;
    let anywhere = center + half * vector(0);
    let at_random = vector(3).normalize_or(Vec3::Z);
    let jitter = vector(6);
    let (width, radius) = (jitter.z.abs(), half.length());
    let wide = pose % 10 == 4;
    let yfov = if wide { 2.4 } else { 0.3 + 1.2 * width };
    let light = shot_frame.frame.lights[0].emitter;
    let (eye, turn) = match pose % 5 {
        1 => {
            let seen = epipole(pose / 5, [jitter.x, jitter.y], shot_frame.size, yfov);
            let shown = Quat::from_rotation_arc(seen, to_light(&light, anywhere));
            (anywhere, shown)
        }
        2 => match position(&light) {
            Some(position) => {
                // From a millimetre to a few decimetres.
                let distance = 1e-3 * 300.0_f32.powf(jitter.x.abs());
                let eye = position + distance * at_random;
                let forward = if jitter.y < 0.0 { -at_random } else { jitter };
                (eye, looking(forward))
            }
            None => {
                let forward = to_light(&light, anywhere) * jitter.x.signum() + 1e-3 * jitter;
                (anywhere, looking(forward))
            }
        },
        3 => {
            let eye = center + 2.0 * half.length() * at_random;
            (eye, looking(center + 0.5 * half * jitter - eye))
        }
        _ => (anywhere, looking(at_random)),
    };
    let [eye, target, up] = [eye, eye + turn * Vec3::NEG_Z, turn * Vec3::Y].map(|v| v.to_array());
    let mut camera =
        Camera::perspective(eye, target, up, yfov, aspect, 2e-3 * radius, 4.0 * radius);
    if pose % 10 == 9 {
        let half = radius * (0.1 + 0.5 * width);
        camera.projection = Projection::Orthographic {
            half_extent: [half * aspect, half],
            center: [0.0; 2],
            near: 2e-3 * radius,
            far: 4.0 * radius,
        };
    }
    camera
}

/// The turn of an upright camera.
fn looking(forward: Vec3) -> Quat {
    let forward = forward.normalize_or(Vec3::Z);
    let up = if forward.y.abs() < 0.9 {
        Vec3::Y
    } else {
        Vec3::X
    };
    let side = forward.cross(up).normalize();
    Quat::from_mat3(&Mat3::from_cols(side, side.cross(forward), -forward))
}

/// The unit direction in the camera's space that is seen at place number `case` of its picture, or the opposite one: on the
/// picture, beside its border, in its corners, off each side, at infinity.
fn epipole(case: usize, [x, y]: [f32; 2], size: [u32; 2], yfov: f32) -> Vec3 {
    // In half pictures from the middle.
    let pixel = 2.0 / size[0] as f32;
    let places = [
        [x, y],
        [1.0 - pixel * y.abs(), x],
        [x, -1.0 - pixel * y.abs()],
        [1.0, 1.0],
        [-1.0 - 0.1 * pixel * y, 1.0 + 0.1 * pixel * x],
        [-1.0, x],
        [-2.0 - y, 2.0 * x],
        [1.5, x],
        [x, 3.0 + x],
        [2.0 * x, -1.2],
        [x, y],
    ];
    let tangent = (0.5 * yfov).tan();
    let number = case % places.len();
    let [x, y] = places[number];
    let is_at_infinity = number + 1 == places.len();
    let depth = if is_at_infinity { 0.0 } else { -1.0 };
    let ahead = if (case / places.len()).is_multiple_of(2) {
        1.0
    } else {
        -1.0
    };
    let aspect = size[0] as f32 / size[1] as f32;
    ahead * vec3(x * tangent * aspect, y * tangent, depth).normalize_or(Vec3::NEG_Z)
}

fn to_light(light: &Emitter, from: Vec3) -> Vec3 {
    match (light, position(light)) {
        (Emitter::Directional { direction, .. }, _) => {
            -Vec3::from(*direction).normalize_or(Vec3::NEG_Y)
        }
        (_, place) => (place.unwrap_or_default() - from).normalize_or(Vec3::Y),
    }
}

/// A light's place; none of the sun.
fn position(light: &Emitter) -> Option<Vec3> {
    match *light {
        Emitter::Directional { .. } => None,
        Emitter::Point { position, .. } | Emitter::Spot { position, .. } => Some(position.into()),
        Emitter::Rect { center, .. } => Some(center.into()),
    }
}
