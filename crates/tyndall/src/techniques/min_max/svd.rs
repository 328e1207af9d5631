//! The `svd` integrator: the integrand without visibility as a sum of products (Chen 2011, section 3.2, eq. 5 and 6).
//!
//! With gamma as variable of integration a lit stretch is `F(beta) integral K(beta, gamma) T(gamma) d gamma`, where T is
//! the factor that dims the light ray on its entire length, and
//!
//! ```text
//!         F             K
//! sun     1 / sin beta  exp(-sigma_t s), s = gamma / sin beta
//! local   1 / h         exp(-sigma_t (s + d)) sum sigma_s rho, h = L sin beta   (ds / d^2 = d gamma / h); see `softened_kernel`
//! ```
//!
//! F is left out of the decomposition: it grows without bound towards the axis, and four terms would be spent on it.

use std::f64::consts::PI;

use super::params::{INFO, Integrator, Params};
use crate::{
    epipolar::{grid::EpipolarGrid, low_rank::LowRank},
    error::PrepareError,
    frame::{Camera, Projection},
    light::softened_kernel,
    physics::medium::Optics,
};
#[cfg(feature = "gpu")]
use crate::{
    epipolar::{grid::SVD_LEAST_SINE, low_rank::GRID},
    shader::block,
};

#[cfg(feature = "gpu")]
block! {
    /// The shaders' `Svd`.
    pub(crate) struct SvdUniform = "Svd" in "tyndall::techniques::min_max::svd", checked by svd_is_laid_out_as_in_wgsl {
        pub(crate) beta_start: f32,
        pub(crate) beta_step: f32,
        pub(crate) gamma_start: f32,
        pub(crate) gamma_step: f32,
        pub(crate) rank: u32,
        pad: [u32; 3],
    }
}

/// The overrides of `svd.wesl`.
#[cfg(feature = "gpu")]
pub(super) const OVERRIDES: [(&str, f64); 2] = [
    ("SVD_SAMPLES", GRID as f64),
    ("SVD_LEAST_SINE", SVD_LEAST_SINE),
];

#[cfg(feature = "gpu")]
impl SvdUniform {
    pub(super) fn new(factors: &LowRank, rank: u32) -> Self {
        let [beta_start, beta_step, gamma_start, gamma_step] = factors.axes().map(|x| x as f32);
        Self {
            beta_start,
            beta_step,
            gamma_start,
            gamma_step,
            rank,
            pad: [0; 3],
        }
    }
}

/// Refuses orthographic cameras: K is a function of the angle to an axis through the eye, and they have no eye.
pub(crate) fn check(params: &Params, camera: &Camera) -> Result<(), PrepareError> {
    let is_flat = matches!(camera.projection, Projection::Orthographic { .. });
    if params.integrator == Integrator::Svd && is_flat {
        return Err(PrepareError::Unsupported {
            technique: INFO.name,
            what: "the svd integrator with an orthographic camera".into(),
        });
    }
    Ok(())
}

/// The factors of K over what a grid covers.
pub(super) fn factors(grid: &EpipolarGrid, optics: &Optics, radius: f64, rank: usize) -> LowRank {
    let (local, longest) = (grid.distance(), grid.longest_path());
    let kernel = |beta: f64, gamma: f64| match local {
        None => optics.transmittance(gamma / beta.sin()),
        Some(distance) => {
            // Beyond the far plane, and of rays that do not meet at all, any value does that leaves K smooth.
            let meets = beta + gamma < PI;
            let along = distance
                / if meets {
                    (beta + gamma).sin().max(1e-9)
                } else {
                    1e-9
                };
            let path = along * (gamma.sin() + beta.sin());
            let along = along * (longest / path).min(1.0);
            // Light travels at gamma to the axis backwards, the view ray at beta to the axis.
            let place = [along * gamma.sin(), along * beta.sin()];
            softened_kernel(optics, place, radius, (beta + gamma).cos())
        }
    };
    LowRank::new(kernel, grid.beta_range(), grid.tint_range(), rank)
}
