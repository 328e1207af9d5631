//! View rays and the depth buffer: which points of the world a pixel sees.

use glam::{DVec2, DVec3};

use crate::{
    frame::{Camera, Projection},
    physics::medium::reals,
};

/// A view ray up to the first surface or the far plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Where it starts: the eye, or a point of the plane at view depth 0 (orthographic) [m, world space].
    pub origin: DVec3,
    /// Unit direction, world space.
    pub direction: DVec3,
    /// Distance to its end [m].
    pub length: f64,
}

impl Ray {
    /// The point at distance `s` [m].
    pub fn at(&self, s: f64) -> DVec3 {
        self.origin + s * self.direction
    }
}

/// A camera's orthonormal frame and its picture's size, ready to make rays.
#[derive(Clone, Debug)]
pub struct CameraRays {
    /// World-space eye [m].
    pub eye: DVec3,
    /// World-space unit vector to the picture's right.
    pub right: DVec3,
    /// World-space unit vector to the picture's top.
    pub up: DVec3,
    /// World-space unit viewing direction.
    pub forward: DVec3,
    size: DVec2,
    projection: Projection,
    reversed_depth: bool,
}

impl CameraRays {
    /// For a picture of `size` [pixels]. The camera must have passed validation: directions neither zero nor parallel.
    pub fn new(camera: &Camera, size: [u32; 2]) -> Self {
        let forward = reals(camera.forward).normalize_or(DVec3::NEG_Z);
        let right = forward
            .cross(reals(camera.up))
            .normalize_or(forward.any_orthonormal_vector());
        Self {
            eye: reals(camera.eye),
            right,
            up: right.cross(forward),
            forward,
            size: DVec2::new(f64::from(size[0]), f64::from(size[1])),
            projection: camera.projection,
            reversed_depth: camera.reversed_depth,
        }
    }

    /// The ray through the centre of pixel (x, y), (0, 0) at the top left, that ends at this depth-buffer value.
    pub fn ray(&self, x: u32, y: u32, depth: f32) -> Ray {
        let pixel = DVec2::new(f64::from(x), f64::from(y)) + 0.5;
        let ndc = DVec2::new(2.0, -2.0) * (pixel / self.size - 0.5);
        let view_depth = self.view_depth(depth);
        match self.projection {
            Projection::Perspective {
                half_extent,
                center,
                ..
            } => {
                let slope = plane_point(half_extent, center, ndc);
                let along = self.forward + slope.x * self.right + slope.y * self.up;
                Ray {
                    origin: self.eye,
                    direction: along.normalize(),
                    length: view_depth * along.length(),
                }
            }
            Projection::Orthographic {
                half_extent,
                center,
                ..
            } => {
                let offset = plane_point(half_extent, center, ndc);
                Ray {
                    origin: self.eye + offset.x * self.right + offset.y * self.up,
                    direction: self.forward,
                    length: view_depth.max(0.0),
                }
            }
        }
    }

    /// View depth [m] of a depth-buffer value, clamped to the near and far planes.
    pub fn view_depth(&self, depth: f32) -> f64 {
        let from_far = if self.reversed_depth {
            f64::from(depth)
        } else {
            1.0 - f64::from(depth)
        }
        .clamp(0.0, 1.0);
        match self.projection {
            Projection::Perspective { near, far, .. } => {
                let (near, far) = (f64::from(near), f64::from(far));
                near * far / (near + from_far * (far - near))
            }
            Projection::Orthographic { near, far, .. } => {
                let (near, far) = (f64::from(near), f64::from(far));
                far + from_far * (near - far)
            }
        }
    }
}

fn plane_point(half_extent: [f32; 2], center: [f32; 2], ndc: DVec2) -> DVec2 {
    let half_extent = DVec2::from(half_extent.map(f64::from));
    DVec2::from(center.map(f64::from)) + half_extent * ndc
}
