//! The CPU backend: every formula in f64, on all cores, with nothing installed.

mod render;

pub use render::{InScatter, Progress, render};

pub use crate::{
    inputs::{CpuLightInputs, GlassMap, LightTexture, ShadowMap},
    integrate::CpuInputs,
    light::LightSource,
    shadow::{Occluders, Shade},
};
