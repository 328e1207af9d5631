//! Real-time volumetric shadows in single-scattering media.

pub mod cpu;
#[cfg(feature = "gpu")]
mod effect;
mod error;
pub mod frame;
#[cfg(feature = "gpu")]
pub mod gpu;
pub mod techniques;

#[cfg(feature = "gpu")]
pub use effect::*;
pub use error::PrepareError;
