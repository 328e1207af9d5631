//! Where light comes from.

/// Where light comes from, seen from one view ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LightSource {
    /// Parallel light that travels this way (unit length).
    Direction([f64; 3]),
    /// A point in world space [m].
    Position([f64; 3]),
}
