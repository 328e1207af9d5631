//! Epipolar coordinates (Chen 2011, section 3.2): slices, and in each slice the view ray's and the light ray's angle.
//!
//! A slice is a half-plane that starts at the axis through the eye: towards the sun, or from the eye to a local light.
//! `alpha` in [0, 2 pi) is its rotation about the axis, `beta` in [0, pi] the angle of the view ray to the axis, and
//! `gamma` the light ray: its distance from the axis \[m] (sun), or its angle at the light from the axis \[rad].
//! With half-planes neither beta nor gamma changes sign.

mod coordinates;
#[cfg(feature = "gpu")]
pub(crate) mod epipole;
pub(crate) mod grid;
pub(crate) mod low_rank;
pub(crate) mod rectify;
mod resolution;
pub(crate) mod slices;
pub(crate) mod traverse;
pub(crate) mod tree;

pub use coordinates::EpipolarFrame;
pub use resolution::Resolution;
