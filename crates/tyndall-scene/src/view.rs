//! From pixels to view rays, and from view depth to what a depth buffer holds.

use glam::{DVec2, DVec3};
use tyndall::frame::{Camera, Projection};

/// A ray in world space [m].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Where it starts.
    pub origin: DVec3,
    /// The way it goes, unit length.
    pub direction: DVec3,
}

impl Ray {
    /// The point at a distance [m].
    pub fn at(&self, distance: f64) -> DVec3 {
        self.origin + distance * self.direction
    }
}

/// How a depth buffer stores distance along an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DepthRange {
    /// Depth of the near plane [m].
    pub near: f64,
    /// Depth of the far plane [m].
    pub far: f64,
    /// True where the buffer holds 1 at `near` and 0 at `far`.
    pub reversed: bool,
}

impl DepthRange {
    /// What a perspective projection stores for a depth [m].
    pub fn perspective(&self, depth: f64) -> f64 {
        let Self { near, far, .. } = *self;
        self.stored(near * (far - depth) / (depth * (far - near)))
    }

    /// What an orthographic projection stores for a depth [m].
    pub fn orthographic(&self, depth: f64) -> f64 {
        self.stored((self.far - depth) / (self.far - self.near))
    }

    /// What is stored at the far plane.
    pub fn far_value(&self) -> f32 {
        if self.reversed { 0.0 } else { 1.0 }
    }

    fn stored(&self, from_far: f64) -> f64 {
        if self.reversed {
            from_far
        } else {
            1.0 - from_far
        }
    }
}

/// A camera's picture: the rays through its pixels and the depths it stores.
#[derive(Clone, Copy, Debug)]
pub struct View {
    eye: DVec3,
    right: DVec3,
    up: DVec3,
    forward: DVec3,
    size: DVec2,
    projection: Projection,
    range: DepthRange,
}

impl View {
    /// A camera that takes a picture of `size` [pixels].
    pub fn new(camera: &Camera, size: [u32; 2]) -> Self {
        let vector = |v: [f32; 3]| DVec3::from(v.map(f64::from));
        let forward = vector(camera.forward).normalize_or(DVec3::NEG_Z);
        let right = forward
            .cross(vector(camera.up))
            .normalize_or(forward.any_orthonormal_vector());
        let (Projection::Perspective { near, far, .. }
        | Projection::Orthographic { near, far, .. }) = camera.projection;
        Self {
            eye: vector(camera.eye),
            right,
            up: right.cross(forward),
            forward,
            size: DVec2::from(size.map(f64::from)),
            projection: camera.projection,
            range: DepthRange {
                near: f64::from(near),
                far: f64::from(far),
                reversed: camera.reversed_depth,
            },
        }
    }

    /// The ray through the centre of pixel (x, y), (0, 0) at the top left. It starts at view depth 0.
    pub fn ray(&self, x: u32, y: u32) -> Ray {
        let pixel = DVec2::new(f64::from(x), f64::from(y)) + 0.5;
        let ndc = DVec2::new(2.0, -2.0) * (pixel / self.size - 0.5);
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
        let [half_extent, center] = [half_extent, center].map(|v| DVec2::from(v.map(f64::from)));
        let lateral = center + half_extent * ndc;
        let offset = lateral.x * self.right + lateral.y * self.up;
        match self.projection {
            Projection::Perspective { .. } => Ray {
                origin: self.eye,
                direction: (self.forward + offset).normalize(),
            },
            Projection::Orthographic { .. } => Ray {
                origin: self.eye + offset,
                direction: self.forward,
            },
        }
    }

    /// Distances along a ray of this view at which it crosses the near and the far plane [m].
    pub fn span(&self, ray: &Ray) -> [f64; 2] {
        [self.range.near, self.range.far].map(|depth| depth / ray.direction.dot(self.forward))
    }

    /// What the depth buffer holds for a distance along a ray of this view [m].
    pub fn stored_depth(&self, ray: &Ray, distance: f64) -> f32 {
        let depth = distance * ray.direction.dot(self.forward);
        (match self.projection {
            Projection::Perspective { .. } => self.range.perspective(depth),
            Projection::Orthographic { .. } => self.range.orthographic(depth),
        }) as f32
    }

    /// What the depth buffer holds where nothing was drawn.
    pub fn far_value(&self) -> f32 {
        self.range.far_value()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn range(reversed: bool) -> DepthRange {
        DepthRange {
            near: 0.5,
            far: 20.0,
            reversed,
        }
    }

    #[test]
    fn planes_store_zero_and_one() {
        for reversed in [false, true] {
            let range = range(reversed);
            let (near, far) = if reversed { (1.0, 0.0) } else { (0.0, 1.0) };
            for of in [DepthRange::perspective, DepthRange::orthographic] {
                assert!((of(&range, 0.5) - near).abs() < 1e-15);
                assert!((of(&range, 20.0) - far).abs() < 1e-15);
            }
            assert_eq!(f64::from(range.far_value()), far);
        }
    }

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
            reversed_depth: false,
        };
        let view = View::new(&camera, [4, 4]);
        let ray = view.ray(0, 3);
        assert_eq!(ray.direction, DVec3::NEG_Y);
        assert!((ray.origin - DVec3::new(-2.0, 0.0, 1.5)).length() < 1e-12);
        assert_eq!(view.stored_depth(&ray, 4.0), 0.5);
        assert_eq!(view.far_value(), 1.0);
    }
}
