//! The integral of single scattering in f64: the scene as an integrator sees it, and its value over lit stretches.

mod integrand;
mod scene;
pub(crate) mod stretches;

pub(crate) use integrand::integrand;
pub use scene::CpuInputs;
pub(crate) use scene::{CpuLight, CpuScene, RayIntegrator};
