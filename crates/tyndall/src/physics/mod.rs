//! The physics, as pure functions by topic; each WGSL file holds the twins of its Rust neighbour.

pub mod airlight;
#[cfg(all(test, feature = "gpu"))]
mod angle;
pub mod medium;
pub(crate) mod quadrature;
pub mod transmittance;
mod vector;

pub(crate) use vector::reals;
