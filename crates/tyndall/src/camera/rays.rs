//! View rays, and view depths from the depth buffer.

use glam::{DVec2, DVec3};

use crate::{
    frame::{Camera, DepthRange, Projection},
    physics::reals,
};

/// A view ray up to the first surface or the far plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Its start: the eye, or a point of the plane at view depth 0 (orthographic) [m, world space].
    pub origin: DVec3,
    /// Unit direction, world space.
    pub direction: DVec3,
    /// Distance to its end \[m].
    pub length: f64,
}

impl Ray {
    /// The point at distance `s` \[m].
    pub fn at(&self, s: f64) -> DVec3 {
        self.origin + s * self.direction
    }
}

/// A camera's orthonormal frame and its image's size, ready to make rays.
#[derive(Clone, Debug)]
pub struct CameraRays {
    /// World-space eye \[m].
    pub eye: DVec3,
    /// World-space unit vector to the image's right.
    pub right: DVec3,
    /// World-space unit vector to the image's top.
    pub up: DVec3,
    /// World-space unit viewing direction.
    pub forward: DVec3,
    size: DVec2,
    projection: Projection,
    depth_range: DepthRange,
}

impl CameraRays {
    /// For an image of `size` \[pixels]. The camera must have passed validation: directions neither zero nor parallel.
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
            depth_range: camera.depth_range,
        }
    }

    /// The ray through the centre of pixel (x, y), (0, 0) at the top left, that ends at this depth-buffer value.
    pub fn ray(&self, x: u32, y: u32, depth: f32) -> Ray {
        let [x, y] = [x, y].map(|n| f64::from(n) + 0.5);
        self.ray_through(x, y, self.view_depth(depth))
    }

    fn ray_through(&self, x: f64, y: f64, view_depth: f64) -> Ray {
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

    /// The ray through a point of the image \[pixels] up to the far plane.
    pub(crate) fn ray_to_far(&self, x: f64, y: f64) -> Ray {
        self.ray_through(x, y, self.planes()[1])
    }

    /// Unit direction of the perspective ray through a point of the image \[pixels].
    pub(crate) fn direction(&self, x: f64, y: f64) -> DVec3 {
        (self.forward + self.offset(x, y)).normalize()
    }

    /// The point of a perspective image \[pixels] that a direction goes through; `None` where it points backwards.
    pub(crate) fn pixel(&self, direction: DVec3) -> Option<DVec2> {
        let depth = direction.dot(self.forward);
        let (half_extent, center) = self.plane();
        let on_plane = DVec2::new(direction.dot(self.right), direction.dot(self.up)) / depth;
        let ndc = (on_plane - center) / half_extent;
        (depth > 0.0).then(|| (0.5 + 0.5 * ndc * DVec2::new(1.0, -1.0)) * self.size)
    }

    /// The point of the image \[pixels], homogeneous, of `(q, w)`: of the point at `q` from the eye where w = 1, of the
    /// direction `q` where w = 0. z > 0 before a perspective camera, < 0 behind it.
    #[cfg(feature = "gpu")]
    pub(crate) fn homogeneous_pixel(&self, q: DVec3, w: f64) -> DVec3 {
        let depth = if self.is_perspective() {
            q.dot(self.forward)
        } else {
            w
        };
        let (half_extent, center) = self.plane();
        let on_plane = DVec2::new(q.dot(self.right), q.dot(self.up));
        let ndc = (on_plane - center * depth) / half_extent;
        (0.5 * (DVec2::splat(depth) + ndc * DVec2::new(1.0, -1.0)) * self.size).extend(depth)
    }

    /// True where a direction goes through the perspective image, or misses it by less than `margin` pixels.
    pub(crate) fn sees(&self, direction: DVec3, margin: f64) -> bool {
        self.pixel(direction).is_some_and(|p| {
            p.cmpge(DVec2::splat(-margin)).all() && p.cmple(self.size + margin).all()
        })
    }

    /// Angle that a pixel in the middle of a perspective image takes up vertically \[rad].
    pub(crate) fn pixel_angle(&self) -> f64 {
        (2.0 * self.plane().0.y / self.size.y).atan()
    }

    /// Side of a pixel of an orthographic image \[m].
    pub(crate) fn pixel_side(&self) -> f64 {
        2.0 * self.plane().0.y / self.size.y
    }

    /// True where a point lies on a ray of an orthographic image, or misses it by less than `margin` pixels.
    pub(crate) fn sees_point(&self, point: DVec3, margin: f64) -> bool {
        let from = point - self.eye;
        let (half_extent, center) = self.plane();
        let on_plane = DVec2::new(from.dot(self.right), from.dot(self.up)) - center;
        let reach = half_extent + margin * 2.0 * half_extent / self.size;
        on_plane.abs().cmple(reach).all()
    }

    /// True for a camera whose rays all pass through the eye.
    pub(crate) fn is_perspective(&self) -> bool {
        matches!(self.projection, Projection::Perspective { .. })
    }

    /// A point of the image \[pixels] on the plane at view depth 1, relative to its middle axis.
    fn offset(&self, x: f64, y: f64) -> DVec3 {
        let ndc = DVec2::new(2.0, -2.0) * (DVec2::new(x, y) / self.size - 0.5);
        let (half_extent, center) = self.plane();
        let on_plane = center + half_extent * ndc;
        on_plane.x * self.right + on_plane.y * self.up
    }

    /// Half extent and centre of the image.
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

    /// View depth \[m] of a depth-buffer value, clamped to the near and far planes.
    pub fn view_depth(&self, depth: f32) -> f64 {
        let [near, far] = self.planes();
        let from_far = if self.depth_range.is_reversed() {
            f64::from(depth)
        } else {
            1.0 - f64::from(depth)
        }
        .clamp(0.0, 1.0);
        match (self.projection, self.depth_range) {
            (Projection::Orthographic { .. }, _) => far + from_far * (near - far),
            (_, DepthRange::ReversedInfinite) => near / from_far.max(near / far),
            _ => near * far / (near + from_far * (far - near)),
        }
    }

    /// The depth buffer's value for a view depth \[m] between the near and far planes: the inverse of
    /// [`CameraRays::view_depth`].
    pub fn depth_value(&self, view_depth: f64) -> f32 {
        let [near, far] = self.planes();
        let from_far = match (self.projection, self.depth_range) {
            (Projection::Orthographic { .. }, _) => (far - view_depth) / (far - near),
            (_, DepthRange::ReversedInfinite) => near / view_depth,
            _ => near * (far - view_depth) / (view_depth * (far - near)),
        };
        (if self.depth_range.is_reversed() {
            from_far
        } else {
            1.0 - from_far
        }) as f32
    }

    /// A distance from the eye that no point of any view ray exceeds \[m].
    #[cfg(feature = "gpu")]
    pub(crate) fn reach(&self) -> f64 {
        let [near, far] = self.planes();
        let (half_extent, center) = self.plane();
        let side = (center.abs() + half_extent).length();
        if self.is_perspective() {
            far * side.hypot(1.0)
        } else {
            side.hypot(far.abs().max(near.abs()))
        }
    }

    /// View depths of the near and the far plane \[m].
    pub fn planes(&self) -> [f64; 2] {
        let (Projection::Perspective { near, far, .. }
        | Projection::Orthographic { near, far, .. }) = self.projection;
        [near, far].map(f64::from)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn depth_values_are_view_depths_and_back() {
        let perspective = |depth_range| {
            let mut camera = Camera::perspective(
                [0.0; 3],
                [0.0, 0.0, -1.0],
                [0.0, 1.0, 0.0],
                1.0,
                1.0,
                0.5,
                8.0,
            );
            camera.depth_range = depth_range;
            camera
        };
        let flat = |depth_range| Camera {
            projection: Projection::Orthographic {
                half_extent: [1.0; 2],
                center: [0.0; 2],
                near: 0.5,
                far: 8.0,
            },
            ..perspective(depth_range)
        };
        use DepthRange::{Reversed, ReversedInfinite, Standard};
        // The buffer's values at view depths 0.5, 2 and 8.
        for (camera, values) in [
            (perspective(Standard), [0.0, 0.8, 1.0]),
            (perspective(Reversed), [1.0, 0.2, 0.0]),
            (perspective(ReversedInfinite), [1.0, 0.25, 0.0625]),
            (flat(Standard), [0.0, 0.2, 1.0]),
            (flat(Reversed), [1.0, 0.8, 0.0]),
        ] {
            let rays = CameraRays::new(&camera, [4, 4]);
            for (value, depth) in values.into_iter().zip([0.5, 2.0, 8.0]) {
                assert!((rays.depth_value(depth) - value).abs() < 1e-7, "{camera:?}");
                // f32 values near 1 tell 8 m from its neighbours to 8^2 / 0.5 * 2^-25 m.
                assert!((rays.view_depth(value) - depth).abs() < 4e-6, "{camera:?}");
            }
            let far_value = camera.depth_range.far_value();
            assert_eq!(rays.view_depth(far_value), 8.0, "{camera:?}");
        }
    }

    #[test]
    fn rays_end_at_the_far_plane_at_the_latest() {
        let mut camera = Camera::perspective(
            [0.0; 3],
            [0.0, 0.0, -1.0],
            [0.0, 1.0, 0.0],
            1.0,
            1.0,
            0.5,
            8.0,
        );
        camera.depth_range = DepthRange::ReversedInfinite;
        let rays = CameraRays::new(&camera, [1, 1]);
        assert_eq!(rays.view_depth(0.01), 8.0);
        assert!((rays.ray(0, 0, 0.01).length - 8.0).abs() < 1e-12);
    }
}
