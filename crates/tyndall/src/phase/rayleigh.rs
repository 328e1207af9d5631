//! Rayleigh's phase function.

use std::f64::consts::PI;

use super::function::{PhaseFunction, PhaseInfo};

/// Particles much smaller than the wavelength.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rayleigh;

/// Rayleigh 1871, for particles much smaller than the wavelength: 3 / 16 pi (1 + cos^2).
pub fn phase_rayleigh(cos_theta: f64) -> f64 {
    3.0 / (16.0 * PI) * (1.0 + cos_theta * cos_theta)
}

impl PhaseFunction for Rayleigh {
    const INFO: PhaseInfo = PhaseInfo {
        name: "rayleigh",
        about: "particles much smaller than the wavelength: air",
        citation: "Rayleigh, On the light from the sky, Philosophical Magazine 41, 1871",
        params: &[],
    };

    fn evaluate(self, cos_theta: f64) -> f64 {
        phase_rayleigh(cos_theta)
    }

    fn mean_cosine(self) -> f64 {
        0.0
    }
}
