//! The physics, as pure functions by topic; each WGSL file holds the twins of its Rust neighbour.

pub mod airlight;
pub mod medium;
pub(crate) mod quadrature;
pub mod transmittance;
mod vector;

pub(crate) use vector::reals;
