//! From public arrays to f64 vectors.

use glam::DVec3;

/// A public array as the vector the f64 side works with.
pub(crate) fn reals(array: [f32; 3]) -> DVec3 {
    DVec3::from(array.map(f64::from))
}
