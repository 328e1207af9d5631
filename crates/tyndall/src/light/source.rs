//! The place that light comes from.

/// The place that light comes from, for the rays through one view ray's points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LightSource {
    /// Parallel light that travels in this direction (unit length).
    Direction([f64; 3]),
    /// A point in world space \[m].
    Position([f64; 3]),
}
