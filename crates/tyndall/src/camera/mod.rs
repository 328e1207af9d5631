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
        let [x, y] = [x, y].map(|n| f64::from(n) + 0.5);
        let view_depth = self.view_depth(depth);
        match self.projection {
            Projection::Perspective { .. } => {
                let along = self.forward + self.offset(x, y);
                Ray {
                    origin: self.eye,
                    direction: along.normalize(),
                    length: view_depth * along.length(),
                }
            }
            Projection::Orthographic { .. } => Ray {
                origin: self.eye + self.offset(x, y),
                direction: self.forward,
                length: view_depth.max(0.0),
            },
        }
    }

    /// Unit direction of the perspective ray through a point of the picture [pixels].
    pub(crate) fn direction(&self, x: f64, y: f64) -> DVec3 {
        (self.forward + self.offset(x, y)).normalize()
    }

    /// The point of a perspective picture [pixels] that a direction goes through; `None` where it points backwards.
    pub(crate) fn pixel(&self, direction: DVec3) -> Option<DVec2> {
        let depth = direction.dot(self.forward);
        let (half_extent, center) = self.plane();
        let on_plane = DVec2::new(direction.dot(self.right), direction.dot(self.up)) / depth;
        let ndc = (on_plane - center) / half_extent;
        (depth > 0.0).then(|| (0.5 + 0.5 * ndc * DVec2::new(1.0, -1.0)) * self.size)
    }

    /// True where a direction goes through the perspective picture, or misses it by less than `margin` pixels.
    pub(crate) fn sees(&self, direction: DVec3, margin: f64) -> bool {
        self.pixel(direction).is_some_and(|p| {
            p.cmpge(DVec2::splat(-margin)).all() && p.cmple(self.size + margin).all()
        })
    }

    /// Angle that a pixel in the middle of a perspective picture takes up vertically [rad].
    pub(crate) fn pixel_angle(&self) -> f64 {
        (2.0 * self.plane().0.y / self.size.y).atan()
    }

    /// True for a camera whose rays all pass through the eye.
    pub(crate) fn is_perspective(&self) -> bool {
        matches!(self.projection, Projection::Perspective { .. })
    }

    /// A point of the picture [pixels] on the plane at view depth 1, relative to its middle axis.
    fn offset(&self, x: f64, y: f64) -> DVec3 {
        let ndc = DVec2::new(2.0, -2.0) * (DVec2::new(x, y) / self.size - 0.5);
        let (half_extent, center) = self.plane();
        let on_plane = center + half_extent * ndc;
        on_plane.x * self.right + on_plane.y * self.up
    }

    /// Half extent and centre of the picture.
    fn plane(&self) -> (DVec2, DVec2) {
        let (Projection::Perspective {
            half_extent,
            center,
            ..
        }
        | Projection::Orthographic {
            half_extent,
            center,
            ..
        }) = self.projection;
        let reals = |pair: [f32; 2]| DVec2::from(pair.map(f64::from));
        (reals(half_extent), reals(center))
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
