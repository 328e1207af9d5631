//! Shades: stretches of a view ray that surfaces keep light from, and who can name them.

use crate::light::LightSource;

/// A stretch of a view ray whose light is blocked or tinted by one surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shade {
    /// Distance from the ray's origin where it begins \[m].
    pub start: f64,
    /// Distance from the ray's origin where it ends \[m] (>= start).
    pub end: f64,
    /// The factor of the light; zero where the surface blocks.
    pub tint: [f64; 3],
}

/// A scene that can say exactly which parts of a view ray its surfaces shade.
pub trait Occluders: Sync {
    /// Appends the shades that all surfaces throw onto the points `origin + s * direction`, s in `[0, length]`;
    /// `direction` has unit length. They may overlap and come in any order.
    fn shades(
        &self,
        origin: [f64; 3],
        direction: [f64; 3],
        length: f64,
        light: LightSource,
        shades: &mut Vec<Shade>,
    );
}
