//! The point of a surface that a pixel sees.

use glam::DVec3;

/// A point to be lit.
pub(super) struct SurfacePoint {
    /// World-space position \[m].
    pub(super) point: DVec3,
    /// World-space unit normal, facing the viewer.
    pub(super) normal: DVec3,
    /// Distance from the view ray's start \[m].
    pub(super) distance: f64,
}

/// A triple of the scene's or the G-buffer's f32, exactly.
pub(super) fn vector(v: [f32; 3]) -> DVec3 {
    DVec3::from(v.map(f64::from))
}
