//! The `svd` integrator: the integrand without visibility as a sum of products (Chen 2011, section 3.2, eq. 5 and 6).
//!
//! With gamma as variable of integration a lit stretch is `F(beta) integral K(beta, gamma) T(gamma) d gamma`, where T is
//! what the light ray is dimmed by on its whole length, and
//!
//! ```text
//!         F             K
//! sun     1 / sin beta  exp(-sigma_t s), s = gamma / sin beta
//! local   1 / h         exp(-sigma_t (s + d)) sum sigma_s rho, h = L sin beta   (ds / d^2 = d gamma / h)
//! ```
//!
//! F is left out of the decomposition: it grows without bound towards the axis, and four terms would be spent on it.

use std::f64::consts::PI;

use crate::{
    epipolar::{grid::EpipolarGrid, low_rank::LowRank},
    physics::medium::Optics,
};

/// The factors of K over what a grid covers.
pub(super) fn factors(grid: &EpipolarGrid, optics: &Optics, rank: usize) -> LowRank {
    let local = grid.distance();
    let kernel = |beta: f64, gamma: f64| match local {
        None => optics.transmittance(gamma / beta.sin()),
        Some(distance) => {
            // Where they do not meet the path is as good as endless.
            let sine = (beta + gamma).sin();
            let meets = beta + gamma < PI && sine > 1e-6;
            let path = if meets {
                distance * (gamma.sin() + beta.sin()) / sine
            } else {
                1e9
            };
            // Light travels at gamma to the axis backwards, the view ray at beta to the axis.
            optics.transmittance(path) * optics.scattering((beta + gamma).cos())
        }
    };
    LowRank::new(kernel, grid.beta_range(), grid.tint_range(), rank)
}
