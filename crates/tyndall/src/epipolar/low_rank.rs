//! The smooth part of the integrand as a sum of products (Chen 2011, section 3.2, eq. 5):
//! `K(beta, gamma) ~ sum_i B_i(beta) Gamma_i(gamma)`, by the singular value decomposition of K on a grid.

use glam::DVec3;
use nalgebra::DMatrix;

/// Samples a side of the grid (the paper's).
pub(crate) const GRID: usize = 64;

/// The factors of K, per colour channel.
pub(crate) struct LowRank {
    beta: Axis,
    gamma: Axis,
    /// `[i][sample]`: B_i and Gamma_i on the grid.
    beta_factors: Vec<Vec<DVec3>>,
    gamma_factors: Vec<Vec<DVec3>>,
    /// The integral of each Gamma_i from the first sample to every other.
    gamma_sums: Vec<Vec<DVec3>>,
}

#[derive(Clone, Copy)]
struct Axis {
    start: f64,
    step: f64,
}

impl Axis {
    fn new([start, end]: [f64; 2]) -> Self {
        Self {
            start,
            step: (end - start) / (GRID - 1) as f64,
        }
    }

    fn at(self, i: usize) -> f64 {
        self.start + i as f64 * self.step
    }

    /// Sample before a place, and its distance from that, in samples.
    fn cell(self, x: f64) -> (usize, f64) {
        let place = (x - self.start) / self.step.max(f64::MIN_POSITIVE);
        let place = place.clamp(0.0, (GRID - 1) as f64);
        let cell = place.floor().min((GRID - 2) as f64);
        (cell as usize, place - cell)
    }

    /// Linear between samples.
    fn interpolate(self, samples: &[DVec3], x: f64) -> DVec3 {
        let (cell, t) = self.cell(x);
        samples[cell].lerp(samples[cell + 1], t)
    }

    /// The integral, from the first sample to every other, of what is linear between them.
    fn sums(self, samples: &[DVec3]) -> Vec<DVec3> {
        let mut sums = vec![DVec3::ZERO];
        for pair in samples.windows(2) {
            sums.push(sums[sums.len() - 1] + 0.5 * self.step * (pair[0] + pair[1]));
        }
        sums
    }
}

impl LowRank {
    /// The best `rank` terms (fewer where the decomposition fails to converge) of a kernel that is finite on both ranges.
    pub(crate) fn new(
        kernel: impl Fn(f64, f64) -> DVec3,
        betas: [f64; 2],
        gammas: [f64; 2],
        rank: usize,
    ) -> Self {
        let (beta, gamma) = (Axis::new(betas), Axis::new(gammas));
        let mut factors = [(); 2].map(|()| vec![vec![DVec3::ZERO; GRID]; rank]);
        let samples: Vec<DVec3> = (0..GRID * GRID)
            .map(|i| kernel(beta.at(i % GRID), gamma.at(i / GRID)))
            .collect();
        for channel in 0..3 {
            let matrix = DMatrix::from_fn(GRID, GRID, |b, g| samples[g * GRID + b][channel]);
            let svd = matrix.svd(true, true);
            let (Some(u), Some(v)) = (svd.u, svd.v_t) else {
                continue;
            };
            for i in 0..rank.min(GRID) {
                for k in 0..GRID {
                    factors[0][i][k][channel] = u[(k, i)] * svd.singular_values[i];
                    factors[1][i][k][channel] = v[(i, k)];
                }
            }
        }
        let [beta_factors, gamma_factors] = factors;
        Self {
            gamma_sums: gamma_factors.iter().map(|g| gamma.sums(g)).collect(),
            beta,
            gamma,
            beta_factors,
            gamma_factors,
        }
    }

    /// Samples of a term as shaders read them: B, Gamma, and the integral of Gamma from the first sample.
    #[cfg(feature = "gpu")]
    pub(crate) fn samples(&self) -> Vec<[f32; 4]> {
        let mut samples = Vec::new();
        let gammas = self.gamma_factors.iter().zip(&self.gamma_sums);
        for (betas, (gammas, sums)) in self.beta_factors.iter().zip(gammas) {
            let all = betas.iter().chain(gammas).chain(sums);
            samples.extend(all.map(|v| v.extend(0.0).as_vec4().to_array()));
        }
        samples
    }

    /// First sample and distance of samples of beta and gamma.
    #[cfg(feature = "gpu")]
    pub(crate) fn axes(&self) -> [f64; 4] {
        let (beta, gamma) = (self.beta, self.gamma);
        [beta.start, beta.step, gamma.start, gamma.step]
    }

    /// B_i(beta), for each i.
    pub(crate) fn at_beta(&self, beta: f64) -> impl Iterator<Item = DVec3> {
        self.beta_factors
            .iter()
            .map(move |b| self.beta.interpolate(b, beta))
    }

    /// Gamma_i(gamma), for each i.
    pub(crate) fn at_gamma(&self, gamma: f64) -> impl Iterator<Item = DVec3> {
        self.gamma_factors
            .iter()
            .map(move |g| self.gamma.interpolate(g, gamma))
    }

    /// The integral of Gamma_i from the first sample to gamma, for each i.
    pub(crate) fn sums_at(&self, gamma: f64) -> impl Iterator<Item = DVec3> {
        let (cell, t) = self.gamma.cell(gamma);
        let factors = self.gamma_factors.iter().zip(&self.gamma_sums);
        factors.map(move |(g, sums)| {
            sums[cell] + self.gamma.step * t * g[cell].lerp(g[cell + 1], 0.5 * t)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_are_integrals() {
        let kernel = |beta: f64, gamma: f64| DVec3::new(1.0, beta, gamma) * (beta * gamma).cos();
        let factors = LowRank::new(kernel, [0.2, 0.9], [0.5, 2.5], 3);
        let sums = |gamma| factors.sums_at(gamma).collect::<Vec<_>>();
        let (a, b) = (0.77, 1.93);
        let mut found = [DVec3::ZERO; 3];
        let steps = 1000;
        for k in 0..steps {
            let gamma = a + (b - a) * (f64::from(k) + 0.5) / f64::from(steps);
            for (sum, gamma) in found.iter_mut().zip(factors.at_gamma(gamma)) {
                *sum += gamma * (b - a) / f64::from(steps);
            }
        }
        for ((found, to), from) in found.iter().zip(sums(b)).zip(sums(a)) {
            // Measured: 2.3e-7.
            let error = (*found - (to - from)).abs().max_element();
            assert!(error < 1e-6, "{error}");
        }
        // Beyond the samples there is nothing.
        assert_eq!(sums(0.1), vec![DVec3::ZERO; 3]);
        assert_eq!(sums(9.0), sums(2.5));
    }

    #[test]
    fn four_terms_hold_an_attenuation() {
        // Extinction towards the sun's axis, three optical depths per channel.
        let kernel =
            |beta: f64, gamma: f64| (-DVec3::new(0.02, 0.05, 0.1) * gamma / beta.sin()).exp();
        let (betas, gammas) = ([0.4, 2.0], [0.0, 30.0]);
        let error = |rank| {
            let factors = LowRank::new(kernel, betas, gammas, rank);
            let mut worst = 0.0_f64;
            for (i, j) in (0..100).flat_map(|i| (0..100).map(move |j| (i, j))) {
                let beta = betas[0] + (betas[1] - betas[0]) * f64::from(i) / 99.0;
                let gamma = gammas[1] * f64::from(j) / 99.0;
                let terms = factors.at_beta(beta).zip(factors.at_gamma(gamma));
                let sum: DVec3 = terms.map(|(b, g)| b * g).sum();
                worst = worst.max((sum - kernel(beta, gamma)).abs().max_element());
            }
            worst
        };
        // Measured: 3e-3 (linear interpolation between 64 samples) and 0.2.
        assert!(error(4) < 5e-3, "{}", error(4));
        assert!(error(1) > 0.05, "{}", error(1));
    }
}
