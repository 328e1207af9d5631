//! Even scattering.

use std::f64::consts::PI;

use super::function::{PhaseFunction, PhaseInfo};

/// Scatters evenly.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Isotropic;

/// 1 / 4 pi, whatever the angle.
pub fn phase_isotropic(_cos_theta: f64) -> f64 {
    1.0 / (4.0 * PI)
}

impl PhaseFunction for Isotropic {
    const INFO: PhaseInfo = PhaseInfo {
        name: "isotropic",
        about: "scatters evenly: what many scatterings come to",
        citation: "none: 1 / 4 pi",
        params: &[],
    };

    fn evaluate(self, cos_theta: f64) -> f64 {
        phase_isotropic(cos_theta)
    }

    fn mean_cosine(self) -> f64 {
        0.0
    }
}
