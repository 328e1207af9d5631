//! Extinction along a straight path (Beer 1852) and its integral.

/// Share of light left after `distance` \[m] at extinction `sigma_t` [1/m].
pub fn transmittance(sigma_t: f64, distance: f64) -> f64 {
    (-sigma_t * distance).exp()
}

/// Integral of the transmittance over the distances `a..b` \[m]: `(exp(-sigma_t a) - exp(-sigma_t b)) / sigma_t`,
/// and `b - a` as `sigma_t` goes to zero.
///
/// This is the whole integral of a segment lit by a directional light (Chen 2011, eq. 1), but for constants.
pub fn transmittance_integral(sigma_t: f64, a: f64, b: f64) -> f64 {
    let depth = sigma_t * (b - a);
    let mean = if depth < 1e-12 {
        1.0
    } else {
        -(-depth).exp_m1() / depth
    };
    transmittance(sigma_t, a) * (b - a) * mean
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits() {
        assert_eq!(transmittance(0.0, 1e9), 1.0);
        assert_eq!(transmittance(3.0, 0.0), 1.0);
        assert_eq!(transmittance(1.0, f64::INFINITY), 0.0);
        assert_eq!(transmittance_integral(0.0, 2.0, 5.0), 3.0);
        assert_eq!(transmittance_integral(0.7, 2.0, 2.0), 0.0);
        // An endless ray in a medium that only scatters gathers 1 / sigma_t: the furnace.
        assert!((transmittance_integral(0.7, 0.0, 1e6) - 1.0 / 0.7).abs() < 1e-12);
    }

    #[test]
    fn is_the_integral() {
        for sigma_t in [1e-9, 1e-6, 1e-3, 0.1, 3.0] {
            let (a, b, n) = (0.5, 7.5, 4000);
            let step = (b - a) / f64::from(n);
            let sum: f64 = (0..n)
                .map(|i| transmittance(sigma_t, a + (f64::from(i) + 0.5) * step) * step)
                .sum();
            let exact = transmittance_integral(sigma_t, a, b);
            // Midpoint rule: (sigma_t step)^2 / 24, 1.1e-6 at sigma_t = 3.
            assert!((sum / exact - 1.0).abs() < 2e-6, "{sigma_t}: {sum} {exact}");
        }
    }

    #[test]
    fn segments_add_up() {
        let whole = transmittance_integral(0.3, 1.0, 9.0);
        let parts = transmittance_integral(0.3, 1.0, 4.0) + transmittance_integral(0.3, 4.0, 9.0);
        assert!((whole - parts).abs() < 1e-14);
    }
}
