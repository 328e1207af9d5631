//! `ray-march`: brute force, the baseline of every paper.
//!
//! The ray is cut into N steps; the middle of each is looked up in the shadow map, and the lit ones add
//! `exp(-sigma_t s) sigma_s rho(theta) L_in(s) ds` (Chen 2011, eq. 1, as a Riemann sum).
//!
//! - **equal** steps: the error falls like 1/N, for it sits in the steps that a shadow border cuts through.
//! - **equiangular** (Kulla & Fajardo 2012): steps of equal angle at a local light, `s = t_p + h tan(xi)`, so that
//!   `ds / d^2 = d xi / h` and the peak beside the light is sampled as finely as it is high. For directional light,
//!   which has no peak, it is the same as equal.
//!
//! Steps run over the part of the ray that the light can reach at all: a spot's cone is clipped first.
//!
//! A rectangular light is taken as samples (Halton's points), each with N steps and a map of its own: a hemispherical
//! one that is made of the light's point cloud, see `passes/imperfect/`. On the GPU only.
//!
//! Cost: N shadow-map texels a ray, fetched in the order of the ray, no memory besides the output. It does every
//! light and medium, textures and coloured glass (which rectangular lights do not see). A rectangular light takes N texels
//! a sample and ray: 256 samples of 64 steps are as much work as 16384 steps of a lamp.
//!
//! Limits: shadows thinner than a step are hit or missed by chance, which shows as bands. Doubling N halves them.
//! Mesa's lavapipe ends a shader's loops after 65535 turns of all of them together and says nothing: there a local light
//! is too dark with more than some 20,000 steps. Samples of a rectangular light are spread over dispatches before that.

#[cfg(feature = "gpu")]
mod area;
#[cfg(feature = "gpu")]
mod area_resolve;
mod cpu;
#[cfg(feature = "gpu")]
mod gpu;
mod params;

pub use params::*;

#[cfg(feature = "gpu")]
use crate::techniques::method::GpuMethod;
use crate::techniques::method::{CpuMethod, Method};

impl Method for Params {
    fn cpu(&self) -> Option<&dyn CpuMethod> {
        Some(self)
    }

    #[cfg(feature = "gpu")]
    fn gpu(&self) -> Option<&dyn GpuMethod> {
        Some(self)
    }
}
