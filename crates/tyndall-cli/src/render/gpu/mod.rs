//! Rendering on the GPU.

mod color;
mod device_shot;
mod effect;
mod lights;
mod renderer;
mod timed;
mod timestamps;
mod world;

pub(crate) use device_shot::{DeviceShot, ViewOptions};
pub(crate) use renderer::GpuRenderer;
pub(crate) use timed::{FrameTime, TimedView, timed_frame};
pub(crate) use timestamps::Timestamps;
pub(crate) use world::World;
