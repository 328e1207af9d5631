//! The plane across a sun's light.

use glam::{DVec2, DVec3};

/// The plane that a sun's light crosses at a right angle, with coordinates along `x` and `y`.
pub(super) struct LightPlane {
    /// Unit direction of the light.
    pub(super) forward: DVec3,
    pub(super) x: DVec3,
    pub(super) y: DVec3,
}

impl LightPlane {
    pub(super) fn new(direction: DVec3) -> Option<Self> {
        let forward = direction.try_normalize()?;
        let (x, y) = forward.any_orthonormal_pair();
        Some(Self { forward, x, y })
    }

    /// The place at which light that passes a point crosses the plane.
    pub(super) fn place(&self, point: DVec3) -> DVec2 {
        DVec2::new(point.dot(self.x), point.dot(self.y))
    }

    /// Coordinates along and across an axis of the plane.
    pub(super) fn along_axis(&self, axis: DVec2, point: DVec3) -> DVec2 {
        let place = self.place(point);
        DVec2::new(place.dot(axis), place.dot(axis.perp()))
    }
}
