//! Phase functions: the density of scattering by cos(theta), the cosine between the way light travels
//! and the way it is scattered [1/sr]. All integrate to 1 over the sphere.

use std::f64::consts::PI;

use crate::frame::Phase;

/// Scatters evenly: 1 / 4 pi.
pub fn phase_isotropic() -> f64 {
    1.0 / (4.0 * PI)
}

/// Rayleigh 1871, for particles much smaller than the wavelength: 3 / 16 pi (1 + cos^2).
pub fn phase_rayleigh(cos_theta: f64) -> f64 {
    3.0 / (16.0 * PI) * (1.0 + cos_theta * cos_theta)
}

/// Henyey & Greenstein 1941, with mean cosine `g` in (-1, 1).
pub fn phase_hg(g: f64, cos_theta: f64) -> f64 {
    let base = 1.0 + g * g - 2.0 * g * cos_theta;
    (1.0 - g * g) / (4.0 * PI * base * base.sqrt())
}

impl Phase {
    /// The phase function's value at `cos_theta` [1/sr].
    pub fn evaluate(self, cos_theta: f64) -> f64 {
        match self {
            Self::Isotropic => phase_isotropic(),
            Self::Rayleigh => phase_rayleigh(cos_theta),
            Self::HenyeyGreenstein { g } => phase_hg(f64::from(g), cos_theta),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: [Phase; 7] = [
        Phase::Isotropic,
        Phase::Rayleigh,
        Phase::HenyeyGreenstein { g: -0.8 },
        Phase::HenyeyGreenstein { g: 0.0 },
        Phase::HenyeyGreenstein { g: 0.3 },
        Phase::HenyeyGreenstein { g: 0.76 },
        Phase::HenyeyGreenstein { g: 0.95 },
    ];

    /// Integral over the sphere of `phase * weight(cos_theta)`, midpoint rule in theta (error 1e-7 at g = 0.95).
    fn over_sphere(phase: Phase, weight: impl Fn(f64) -> f64) -> f64 {
        let n = 20_000;
        let step = PI / f64::from(n);
        let ring = |i| {
            let theta = (f64::from(i) + 0.5) * step;
            2.0 * PI * theta.sin() * phase.evaluate(theta.cos()) * weight(theta.cos())
        };
        (0..n).map(ring).sum::<f64>() * step
    }

    #[test]
    fn integrates_to_one() {
        for phase in ALL {
            let total = over_sphere(phase, |_| 1.0);
            assert!((total - 1.0).abs() < 1e-6, "{phase:?}: {total}");
        }
    }

    #[test]
    fn mean_cosine_is_g() {
        for phase in ALL {
            let g = match phase {
                Phase::HenyeyGreenstein { g } => f64::from(g),
                _ => 0.0,
            };
            let mean = over_sphere(phase, |c| c);
            assert!((mean - g).abs() < 1e-6, "{phase:?}: {mean}");
        }
    }

    #[test]
    fn positive_g_scatters_forward() {
        assert!(phase_hg(0.5, 1.0) > phase_hg(0.5, -1.0));
    }
}
