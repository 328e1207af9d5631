//! From pixels to view rays, and from view depth to depth-buffer values.

use glam::DVec3;
use tyndall::{
    camera::CameraRays,
    frame::{Camera, DepthRange},
};

/// A ray in world space \[m].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Start \[m].
    pub origin: DVec3,
    /// Direction, unit length.
    pub direction: DVec3,
}

impl Ray {
    /// The point at a distance \[m].
    pub fn at(&self, distance: f64) -> DVec3 {
        self.origin + distance * self.direction
    }
}

/// A camera's image: the rays through its pixels and the depths it stores.
#[derive(Clone, Debug)]
pub struct View {
    rays: CameraRays,
    /// Distances along the viewing axis between which surfaces are seen \[m].
    planes: [f64; 2],
    depth_range: DepthRange,
}

impl View {
    /// The view of a camera with `size` pixels across and down.
    pub fn new(camera: &Camera, size: [u32; 2]) -> Self {
        let rays = CameraRays::new(camera, size);
        let [near, far] = rays.planes();
        let infinite = camera.depth_range == DepthRange::ReversedInfinite;
        Self {
            rays,
            planes: [near, if infinite { f64::INFINITY } else { far }],
            depth_range: camera.depth_range,
        }
    }

    /// The ray through the centre of pixel (x, y), (0, 0) at the top left. It starts at view depth 0.
    pub fn ray(&self, x: u32, y: u32) -> Ray {
        let ray = self.rays.ray(x, y, self.far_value());
        Ray {
            origin: ray.origin,
            direction: ray.direction,
        }
    }

    /// Distances along a ray of this view between which surfaces are seen: from the near plane to the far one, or to infinity
    /// where the depth range is infinite \[m].
    pub fn span(&self, ray: &Ray) -> [f64; 2] {
        self.planes.map(|depth| depth / self.slope(ray))
    }

    /// The depth-buffer value for a distance along a ray of this view \[m].
    pub fn stored_depth(&self, ray: &Ray, distance: f64) -> f32 {
        self.rays.depth_value(distance * self.slope(ray))
    }

    /// The depth-buffer value where nothing was drawn.
    pub fn far_value(&self) -> f32 {
        self.depth_range.far_value()
    }

    /// View depth gained per distance along a ray.
    fn slope(&self, ray: &Ray) -> f64 {
        ray.direction.dot(self.rays.forward)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tyndall::frame::Projection;

    #[test]
    fn rays_go_through_pixel_centres() {
        let camera = Camera::perspective(
            [1.0, 2.0, 3.0],
            [1.0, 2.0, -5.0],
            [0.0, 1.0, 0.0],
            std::f32::consts::FRAC_PI_2,
            2.0,
            0.5,
            20.0,
        );
        let view = View::new(&camera, [4, 2]);
        let ray = view.ray(3, 0);
        // The top right pixel's centre: 3/4 of the half width (tangent 2), half of the half height (tangent 1).
        let expected = DVec3::new(1.5, 0.5, -1.0).normalize();
        assert!((ray.direction - expected).length() < 1e-7);
        let [near, far] = view.span(&ray);
        assert!((ray.at(near).z - 2.5).abs() < 1e-6 && (ray.at(far).z + 17.0).abs() < 1e-5);
        assert!((view.stored_depth(&ray, near) - 1.0).abs() < 1e-6);
        assert!(view.stored_depth(&ray, far).abs() < 1e-6);
    }

    #[test]
    fn orthographic_rays_are_parallel() {
        let camera = Camera {
            eye: [0.0; 3],
            forward: [0.0, -2.0, 0.0],
            up: [0.0, 0.0, -1.0],
            projection: Projection::Orthographic {
                half_extent: [4.0, 2.0],
                center: [1.0, 0.0],
                near: -1.0,
                far: 9.0,
            },
            depth_range: DepthRange::Standard,
        };
        let view = View::new(&camera, [4, 4]);
        let ray = view.ray(0, 3);
        assert_eq!(ray.direction, DVec3::NEG_Y);
        assert!((ray.origin - DVec3::new(-2.0, 0.0, 1.5)).length() < 1e-12);
        assert_eq!(view.stored_depth(&ray, 4.0), 0.5);
        assert_eq!(view.far_value(), 1.0);
    }
}
