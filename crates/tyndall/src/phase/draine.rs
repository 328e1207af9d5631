//! Draine's phase function, of which Henyey & Greenstein's, Rayleigh's and Cornette & Shanks's are cases.

use super::{
    function::{PhaseFunction, PhaseInfo, PhaseParam},
    henyey_greenstein::phase_hg,
};

/// Dust, and droplets together with a [`HenyeyGreenstein`](super::henyey_greenstein::HenyeyGreenstein) peak: see
/// [`droplets`](super::droplets).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Draine {
    /// Asymmetry (-1 < g < 1), the mean cosine where alpha is 0; forward scattering where positive.
    pub g: f32,
    /// Weight of cos^2 (>= 0): 0 is Henyey & Greenstein's function, 1 Cornette & Shanks's, which is Rayleigh's for g = 0.
    pub alpha: f32,
}

/// Draine 2003 (equation 5), with asymmetry `g` in (-1, 1) and `alpha` >= 0: (1 + alpha cos^2) / (1 + alpha (1 + 2 g^2) / 3)
/// of Henyey & Greenstein's.
pub fn phase_draine(g: f64, alpha: f64, cos_theta: f64) -> f64 {
    let lobes =
        (1.0 + alpha * (cos_theta * cos_theta)) / (1.0 + alpha * ((1.0 + 2.0 * g * g) / 3.0));
    phase_hg(g, cos_theta) * lobes
}

impl PhaseFunction for Draine {
    const INFO: PhaseInfo = PhaseInfo {
        name: "draine",
        about: "a lobe and cos^2: dust; with an hg peak, droplets of fog",
        citation: "Draine, Scattering by interstellar dust grains. I. Optical and ultraviolet, Astrophysical Journal 598, 2003",
        params: &[
            PhaseParam {
                key: "g",
                about: "asymmetry, the mean cosine for alpha = 0; forward scattering where positive",
                range: "a number above -1 and below 1",
                allows: |g| g.abs() < 1.0,
            },
            PhaseParam {
                key: "alpha",
                about: "weight of cos^2: 0 is hg, 1 cornette-shanks",
                range: "a finite number >= 0",
                allows: |alpha| alpha >= 0.0 && alpha.is_finite(),
            },
        ],
    };

    fn evaluate(self, cos_theta: f64) -> f64 {
        phase_draine(f64::from(self.g), f64::from(self.alpha), cos_theta)
    }

    fn mean_cosine(self) -> f64 {
        let (g, alpha) = (f64::from(self.g), f64::from(self.alpha));
        g * (1.0 + alpha * (3.0 + 2.0 * g * g) / 5.0) / (1.0 + alpha * (1.0 + 2.0 * g * g) / 3.0)
    }
}
