//! Meshes that block light.

mod edges;
mod error;
mod occluder;

pub use error::OccluderError;
pub use occluder::{Occluder, OccluderMesh};
