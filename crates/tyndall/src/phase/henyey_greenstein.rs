//! Henyey & Greenstein's phase function.

use std::f64::consts::PI;

use super::function::{PhaseFunction, PhaseInfo, PhaseParam};

/// One lobe, forward or backward.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HenyeyGreenstein {
    /// Mean cosine (-1 < g < 1); forward scattering where positive.
    pub g: f32,
}

/// Henyey & Greenstein 1941, with mean cosine `g` in (-1, 1).
pub fn phase_hg(g: f64, cos_theta: f64) -> f64 {
    let base = 1.0 + g * g - 2.0 * g * cos_theta;
    (1.0 - g * g) / (4.0 * PI * base * base.sqrt())
}

impl PhaseFunction for HenyeyGreenstein {
    const INFO: PhaseInfo = PhaseInfo {
        name: "hg",
        about: "one lobe, forward or backward: haze, dust, smoke",
        citation: "Henyey & Greenstein, Diffuse radiation in the Galaxy, Astrophysical Journal 93, 1941",
        params: &[PhaseParam {
            key: "g",
            about: "mean cosine; forward scattering where positive",
            range: "a number above -1 and below 1",
            allows: |g| g.abs() < 1.0,
        }],
    };

    fn evaluate(self, cos_theta: f64) -> f64 {
        phase_hg(f64::from(self.g), cos_theta)
    }

    fn mean_cosine(self) -> f64 {
        f64::from(self.g)
    }
}
