//! `reference`: the oracle, in f64 on the CPU.
//!
//! Visibility is not sampled. Either the scene itself says which stretches of the ray each of its triangles shades
//! (`traced`: the plane through the ray and the light, cut with every triangle; Max 1986 finds lit segments so), or the
//! ray is walked texel by texel through the shadow map (`shadow-map`: the limit of marching with ever more steps).
//! Between the ends of these stretches the integrand is smooth, and is integrated there: in closed form for untextured
//! directional light, else by adaptive Gauss-Kronrod quadrature (Piessens et al. 1983, QUADPACK's 7-15 pair), in the
//! angle at the light where there is one, so that the peak beside it is flat.
//!
//! - `tolerance`: largest relative error of a stretch's quadrature.
//!
//! Cost: seconds an image. Rectangular lights are sums over their samples. Lights are traced whether or not they
//! have a shadow map.

mod cpu;
mod params;

pub use params::*;

use crate::techniques::method::{CpuMethod, Method};

impl Method for Params {
    fn cpu(&self) -> Option<&dyn CpuMethod> {
        Some(self)
    }
}
