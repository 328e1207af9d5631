//! Real-time volumetric shadows in single-scattering media.

pub mod camera;
#[cfg(feature = "gpu")]
mod composite;
pub mod cpu;
#[cfg(feature = "gpu")]
mod effect;
pub mod epipolar;
mod error;
pub mod frame;
#[cfg(feature = "gpu")]
pub mod gpu;
pub mod light;
pub mod physics;
pub mod shadow;
pub mod techniques;
mod validate;

#[cfg(feature = "gpu")]
pub use effect::{
    CreateError, Effect, EffectOptions, EffectView, FrameInputs, LightInputs, OutputPrecision,
};
pub use error::PrepareError;
