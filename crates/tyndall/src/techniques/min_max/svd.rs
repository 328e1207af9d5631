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

use glam::DVec3;

use super::params::{INFO, Integrator, Params};
use crate::{
    camera::Ray,
    epipolar::{
        grid::{EpipolarGrid, GridRay, SVD_LEAST_SINE},
        low_rank::LowRank,
    },
    error::PrepareError,
    frame::{Camera, Projection},
    light::LightModel,
    physics::{LIGHT_RADIUS, medium::Optics, quadrature::quadrature},
};

/// Relative error of the quadrature of a lit stretch, where it has no closed form.
pub(super) const TOLERANCE: f64 = 1e-3;

/// K is a function of the angle to an axis through the eye, and an orthographic camera has no eye.
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
pub(super) fn factors(grid: &EpipolarGrid, optics: &Optics, rank: usize) -> LowRank {
    let (local, longest) = (grid.distance(), grid.longest_path());
    let kernel = |beta: f64, gamma: f64| match local {
        None => optics.transmittance(gamma / beta.sin()),
        Some(distance) => {
            // Where they meet beyond the far plane, or not at all, any value does that leaves K smooth.
            let path = if beta + gamma < PI {
                distance * (gamma.sin() + beta.sin()) / (beta + gamma).sin().max(1e-9)
            } else {
                f64::INFINITY
            };
            let path = path.min(longest);
            // Light travels at gamma to the axis backwards, the view ray at beta to the axis.
            optics.transmittance(path) * optics.scattering((beta + gamma).cos())
        }
    };
    LowRank::new(kernel, grid.beta_range(), grid.tint_range(), rank)
}

/// A view ray's lit stretches on the CPU: the twin of `svd_stretch.wgsl`. Where light rays are dimmed on their whole
/// length, that is sampled beside the factors as finely as it takes, instead of summed up in columns.
pub(super) struct SvdRay<'a> {
    ray: &'a Ray,
    model: &'a LightModel<'a>,
    grid: &'a EpipolarGrid,
    place: GridRay,
    factors: &'a LowRank,
    /// The light's strength times F.
    common: DVec3,
}

impl<'a> SvdRay<'a> {
    /// `None` where the ray is too near to the axis.
    pub(super) fn new(
        ray: &'a Ray,
        model: &'a LightModel<'a>,
        optics: &Optics,
        grid: &'a EpipolarGrid,
        place: GridRay,
        factors: &'a LowRank,
    ) -> Option<Self> {
        let (sine, cosine) = place.beta().sin_cos();
        let common = match grid.distance() {
            None => optics.scattering(cosine) / sine,
            Some(distance) => DVec3::splat(1.0 / (distance * sine).max(LIGHT_RADIUS)),
        };
        (sine > SVD_LEAST_SINE).then_some(Self {
            ray,
            model,
            grid,
            place,
            factors,
            common: common * model.strength(),
        })
    }

    /// The light of a stretch [m] that nothing shades.
    pub(super) fn over(&self, stretch: [f64; 2]) -> DVec3 {
        let [a, b] = stretch.map(|s| self.grid.gamma_at(&self.place, s));
        if self.model.is_plain() {
            let sums = self.factors.sums_at(b).zip(self.factors.sums_at(a));
            return self.common * self.products(sums.map(|(b, a)| b - a));
        }
        let kernel = |gamma| {
            let s = self.grid.crossing_at(&self.place, gamma);
            let tint = self
                .model
                .ray_tint(self.ray.at(s.clamp(stretch[0], stretch[1])));
            tint * self.products(self.factors.at_gamma(gamma))
        };
        self.common * quadrature([a, b], TOLERANCE, &kernel)
    }

    /// The sum of B_i times a value each.
    fn products(&self, values: impl Iterator<Item = DVec3>) -> DVec3 {
        let betas = self.factors.at_beta(self.place.beta());
        betas.zip(values).map(|(b, value)| b * value).sum()
    }
}
