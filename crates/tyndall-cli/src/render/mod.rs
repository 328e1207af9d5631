//! From a frame of a shot to layers, on the GPU or on the CPU.

mod buffers;
pub(crate) mod cpu;
pub(crate) mod gpu;
mod layers;
mod needs;
mod renderer;

pub(crate) use buffers::{Buffers, depth};
pub use layers::Rendered;
pub(crate) use needs::{Needs, TechniqueInputs};
pub use renderer::{Renderer, render};
