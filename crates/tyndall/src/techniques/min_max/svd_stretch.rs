//! Lit stretches by the svd integrator on the CPU: the twin of `svd_stretch.wesl`.

use glam::DVec3;

use crate::{
    camera::Ray,
    epipolar::{
        grid::{EpipolarGrid, GridRay, SVD_LEAST_SINE},
        low_rank::LowRank,
    },
    light::LightModel,
    physics::{medium::Optics, quadrature::quadrature},
};

/// Relative error of the quadrature of a lit stretch, where it has no closed form.
pub(super) const TOLERANCE: f64 = 1e-3;

/// A view ray whose lit stretches are integrated by the factors. A factor that dims light rays on their entire length is
/// sampled beside them as finely as it takes, instead of summed up in columns.
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
            Some(distance) => DVec3::splat(1.0 / (distance * sine)),
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

    /// The light of a stretch \[m] that nothing shades.
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
