//! Lights: how much of one reaches a point, and from where, if nothing blocks it.

pub mod cone;
#[cfg(feature = "gpu")]
pub(crate) mod halton;
mod model;
mod source;
pub mod texture;

pub use crate::physics::LIGHT_RADIUS;
pub use model::{Incident, LightModel, spot_falloff};
pub use source::LightSource;
