//! Lights: how much of one reaches a point, and from where, if nothing blocks it.

pub mod cone;
pub(crate) mod hammersley;
mod model;
mod radius;
mod source;
pub mod texture;

#[cfg(feature = "gpu")]
pub(crate) use model::fade;
pub use model::{Incident, LightModel, patch_cosine, spot_falloff};
pub(crate) use radius::softened_kernel;
pub use radius::{light_radius, patch_radius};
pub use source::LightSource;
