//! Cornette & Shanks's phase function: Henyey & Greenstein's with Rayleigh's as its limit.

use super::{
    function::{PhaseFunction, PhaseInfo, PhaseParam},
    henyey_greenstein::phase_hg,
};

/// Haze, with Rayleigh's limit for small particles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CornetteShanks {
    /// Asymmetry (-1 < g < 1), not quite the mean cosine: 0 is Rayleigh's function; forward scattering where positive.
    pub g: f32,
}

/// Cornette & Shanks 1992, with asymmetry `g` in (-1, 1): 3 / 2 (1 + cos^2) / (2 + g^2) of Henyey & Greenstein's.
pub fn phase_cornette_shanks(g: f64, cos_theta: f64) -> f64 {
    let lobes = 1.5 * (1.0 + cos_theta * cos_theta) / (2.0 + g * g);
    phase_hg(g, cos_theta) * lobes
}

impl PhaseFunction for CornetteShanks {
    const INFO: PhaseInfo = PhaseInfo {
        name: "cornette-shanks",
        about: "haze whose small particles scatter as Rayleigh's",
        citation: "Cornette & Shanks, Physically reasonable analytic expression for the single-scattering phase function, Applied Optics 31, 1992",
        params: &[PhaseParam {
            key: "g",
            about: "asymmetry, 0 for Rayleigh's function; forward scattering where positive",
            range: "a number above -1 and below 1",
            allows: |g| g.abs() < 1.0,
        }],
    };

    fn evaluate(self, cos_theta: f64) -> f64 {
        phase_cornette_shanks(f64::from(self.g), cos_theta)
    }

    fn mean_cosine(self) -> f64 {
        let g = f64::from(self.g);
        3.0 * g * (4.0 + g * g) / (5.0 * (2.0 + g * g))
    }
}
