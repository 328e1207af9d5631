//! Power laws through measurements: least squares of logarithms.

/// y is proportional to x to this power.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct PowerLaw {
    /// The exponent.
    pub(super) exponent: f64,
    /// Its standard error.
    pub(super) error: f64,
}

impl PowerLaw {
    /// Through at least three points with positive coordinates at more than one x; `None` where there are no such.
    pub(super) fn fit(points: &[(f64, f64)]) -> Option<Self> {
        if points.len() < 3 || !points.iter().all(|(x, y)| *x > 0.0 && *y > 0.0) {
            return None;
        }
        let count = points.len() as f64;
        let logs: Vec<(f64, f64)> = points.iter().map(|(x, y)| (x.ln(), y.ln())).collect();
        let mean_x = logs.iter().map(|p| p.0).sum::<f64>() / count;
        let mean_y = logs.iter().map(|p| p.1).sum::<f64>() / count;
        let sum_xx = logs.iter().map(|p| (p.0 - mean_x).powi(2)).sum::<f64>();
        let sum_xy = logs
            .iter()
            .map(|p| (p.0 - mean_x) * (p.1 - mean_y))
            .sum::<f64>();
        let exponent = sum_xy / sum_xx;
        let residual = |p: &(f64, f64)| (p.1 - mean_y - exponent * (p.0 - mean_x)).powi(2);
        let variance = logs.iter().map(residual).sum::<f64>() / (count - 2.0);
        (sum_xx > 0.0).then(|| Self {
            exponent,
            error: (variance / sum_xx).sqrt(),
        })
    }
}

impl std::fmt::Display for PowerLaw {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{:.2} +- {:.2}", self.exponent, self.error)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_power_law_is_found_exactly() {
        for exponent in [-1.0, 0.0, 0.5, 2.0] {
            let points: Vec<_> = [1.0, 2.0, 4.0, 8.0]
                .map(|x: f64| (x, 3.0 * x.powf(exponent)))
                .into();
            let fit = PowerLaw::fit(&points).unwrap();
            assert!((fit.exponent - exponent).abs() < 1e-14, "{fit:?}");
            assert!(fit.error < 1e-14, "{fit:?}");
        }
    }

    #[test]
    fn the_error_is_the_one_of_the_textbook() {
        // ln x = -1, 0, 1 and ln y = 0, 1, 0: slope 0, residuals -1/3, 2/3, -1/3, so variance 2/3 over sum 2.
        let points =
            [(-1.0, 0.0), (0.0, 1.0), (1.0, 0.0)].map(|(x, y): (f64, f64)| (x.exp(), y.exp()));
        let fit = PowerLaw::fit(&points).unwrap();
        assert!(fit.exponent.abs() < 1e-15, "{fit:?}");
        assert!(
            (fit.error - (1.0_f64 / 3.0).sqrt()).abs() < 1e-15,
            "{fit:?}"
        );
    }

    #[test]
    fn what_is_no_law_is_none() {
        for points in [
            &[(1.0, 1.0), (2.0, 2.0)][..],
            &[(2.0, 1.0); 3],
            &[(1.0, 0.0), (2.0, 1.0), (3.0, 1.0)],
        ] {
            assert_eq!(PowerLaw::fit(points), None);
        }
    }
}
