//! Adaptive quadrature of smooth, vector-valued functions.

use glam::DVec3;

/// Abscissae and weights of the 7-15 Gauss-Kronrod pair (QUADPACK's qk15): abscissa, Kronrod weight, Gauss weight.
const KRONROD: [[f64; 3]; 8] = [
    [0.991_455_371_120_812_6, 0.022_935_322_010_529_224, 0.0],
    [
        0.949_107_912_342_758_5,
        0.063_092_092_629_978_55,
        0.129_484_966_168_869_7,
    ],
    [0.864_864_423_359_769_1, 0.104_790_010_322_250_18, 0.0],
    [
        0.741_531_185_599_394_4,
        0.140_653_259_715_525_92,
        0.279_705_391_489_276_64,
    ],
    [0.586_087_235_467_691_1, 0.169_004_726_639_267_9, 0.0],
    [
        0.405_845_151_377_397_2,
        0.190_350_578_064_785_4,
        0.381_830_050_505_118_9,
    ],
    [0.207_784_955_007_898_47, 0.204_432_940_075_298_9, 0.0],
    [0.0, 0.209_482_141_084_727_83, 0.417_959_183_673_469_4],
];

/// Bisections before a stretch is taken as it is: a picture's texels may kink the integrand any number of times.
const MAX_DEPTH: u32 = 14;

/// Adaptive quadrature: halves the interval until the two rules agree to `tolerance`, relative to their sum.
pub(crate) fn quadrature([a, b]: [f64; 2], tolerance: f64, f: &impl Fn(f64) -> DVec3) -> DVec3 {
    refine([a, b], tolerance, 0.0, MAX_DEPTH, f)
}

fn refine(
    [a, b]: [f64; 2],
    tolerance: f64,
    scale: f64,
    depth: u32,
    f: &impl Fn(f64) -> DVec3,
) -> DVec3 {
    let (middle, half) = (0.5 * (a + b), 0.5 * (b - a));
    let (mut kronrod, mut gauss) = (DVec3::ZERO, DVec3::ZERO);
    for [x, wk, wg] in KRONROD {
        let pair = if x == 0.0 {
            f(middle)
        } else {
            f(middle - half * x) + f(middle + half * x)
        };
        kronrod += wk * pair;
        gauss += wg * pair;
    }
    let value = half * kronrod;
    let error = (half * (kronrod - gauss)).abs().max_element();
    // Parts that hardly matter to the whole need not be known so well themselves.
    let scale = scale.max(value.abs().max_element());
    if depth == 0 || error <= tolerance * scale {
        return value;
    }
    refine([a, middle], tolerance, 0.5 * scale, depth - 1, f)
        + refine([middle, b], tolerance, 0.5 * scale, depth - 1, f)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quadrature_meets_its_tolerance() {
        let exact = [
            2.0,
            1.0 - (-3.0_f64).exp(),
            0.1 * (30.0_f64.atan() + 30.0_f64.atan()),
        ];
        let found = [
            quadrature([0.0, std::f64::consts::PI], 1e-9, &|x: f64| {
                DVec3::splat(x.sin())
            }),
            quadrature([0.0, 3.0], 1e-9, &|x: f64| DVec3::splat((-x).exp())),
            quadrature([-3.0, 3.0], 1e-9, &|x: f64| {
                DVec3::splat(1.0 / (1.0 + 100.0 * x * x))
            }),
        ];
        for (exact, found) in exact.iter().zip(found) {
            assert!((found.x / exact - 1.0).abs() < 1e-9, "{found} {exact}");
        }
        let kink = quadrature([0.0, 1.0], 1e-6, &|x: f64| DVec3::splat((x - 0.3).abs()));
        assert!((kink.x - 0.29).abs() < 1e-6, "{kink}");
    }
}
