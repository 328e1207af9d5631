//! A medium as the techniques see it: extinction, and scattering by angle, summed over its components.

use glam::DVec3;

use super::vector::reals;
use crate::frame::{Medium, MediumComponent};

/// An f64 view of a [`Medium`].
#[derive(Clone, Debug)]
pub struct Optics {
    /// Extinction coefficient, sigma_s + sigma_a summed over the components [1/m].
    pub sigma_t: DVec3,
    components: Vec<MediumComponent>,
}

impl Optics {
    /// Sums up the components.
    pub fn new(medium: &Medium) -> Self {
        let sigma_t = medium
            .components
            .iter()
            .map(|c| reals(c.sigma_s) + reals(c.sigma_a))
            .sum();
        Self {
            sigma_t,
            components: medium.components.clone(),
        }
    }

    /// sigma_s rho(theta), summed over the components [1/(m sr)].
    pub fn scattering(&self, cos_theta: f64) -> DVec3 {
        self.components
            .iter()
            .map(|c| reals(c.sigma_s) * c.phase.evaluate(cos_theta))
            .sum()
    }

    /// Transmittance per channel over a distance \[m].
    pub fn transmittance(&self, distance: f64) -> DVec3 {
        (-self.sigma_t * distance).exp()
    }
}
