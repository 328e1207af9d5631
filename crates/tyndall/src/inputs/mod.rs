//! Textures of a frame, besides its plain data, on the CPU and on the GPU.

mod cpu;
#[cfg(feature = "gpu")]
mod gpu;

pub use cpu::{CpuLightInputs, GlassMap, LightTexture, ShadowMap};
#[cfg(feature = "gpu")]
pub use gpu::{Count, CountValue, FrameInputs, LightInputs, PointCloud, SurfaceShadows};
