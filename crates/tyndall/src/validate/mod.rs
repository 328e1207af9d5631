//! Checks of a frame and its inputs. Every refusal names the field, what was expected and what was found.

mod frame;
#[cfg(feature = "gpu")]
mod gpu;
mod inputs;
mod ranges;
mod require;

pub(crate) use frame::frame;
#[cfg(feature = "gpu")]
pub(crate) use gpu::{gpu_inputs, surface_shadows};
pub(crate) use inputs::cpu_inputs;
