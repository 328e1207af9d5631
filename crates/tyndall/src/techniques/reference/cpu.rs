//! Lit stretches of a ray, and the integral over each.

use glam::DVec3;

use super::{Params, Visibility};
use crate::{
    camera::Ray,
    cpu::{CpuLight, CpuScene, Occluders, RayIntegrator, Shade},
    error::PrepareError,
    light::{LIGHT_RADIUS, LightModel},
    physics::transmittance::transmittance_integral,
    techniques::ray_march::cpu::integrand,
};

pub(crate) fn integrator<'a>(
    params: &'a Params,
    scene: &'a CpuScene<'a>,
) -> Result<Box<dyn RayIntegrator + 'a>, PrepareError> {
    let occluders = match params.visibility {
        Visibility::Traced => Some(scene.occluders.ok_or(PrepareError::Missing {
            field: "occluders".into(),
            reason: "the reference traces visibility",
        })?),
        Visibility::ShadowMap => None,
    };
    Ok(Box::new(Reference {
        tolerance: params.tolerance,
        scene,
        occluders,
    }))
}

struct Reference<'a> {
    tolerance: f64,
    scene: &'a CpuScene<'a>,
    /// `None`: visibility comes from the shadow maps.
    occluders: Option<&'a dyn Occluders>,
}

impl RayIntegrator for Reference<'_> {
    fn in_scatter(&self, ray: &Ray) -> DVec3 {
        let mut shades = Vec::new();
        let mut sum = DVec3::ZERO;
        for light in &self.scene.lights {
            for model in &light.models {
                sum += self.of_model(ray, light, model, &mut shades);
            }
        }
        sum
    }
}

impl Reference<'_> {
    fn of_model(
        &self,
        ray: &Ray,
        light: &CpuLight<'_>,
        model: &LightModel<'_>,
        shades: &mut Vec<Shade>,
    ) -> DVec3 {
        let span = model.reach(ray.origin, ray.direction, [0.0, ray.length]);
        if span[0] >= span[1] {
            return DVec3::ZERO;
        }
        shades.clear();
        match (self.occluders, &light.shadows) {
            (Some(occluders), _) => occluders.shades(
                ray.origin.to_array(),
                ray.direction.to_array(),
                ray.length,
                model.source(),
                shades,
            ),
            (None, Some(shadows)) => shadows.walk(ray.origin, ray.direction, span, shades),
            (None, None) => {}
        }
        let integral = Integral::new(ray, model, self.scene, self.tolerance);
        let kinks = model.kinks(ray.origin, ray.direction, span);
        let mut sum = DVec3::ZERO;
        lit_stretches(shades, span, |[from, to], tint| {
            let cuts = kinks.map(|k| k.clamp(from, to));
            for [a, b] in [[from, cuts[0]], cuts, [cuts[1], to]] {
                if a < b {
                    sum += tint * integral.over([a, b]);
                }
            }
        });
        sum
    }
}

/// Calls `visit` with every stretch of `span` that is not blocked and the product of the tints that lie on it.
/// Sorts and empties `shades`.
fn lit_stretches(shades: &mut Vec<Shade>, span: [f64; 2], mut visit: impl FnMut([f64; 2], DVec3)) {
    shades.retain(|s| s.end > span[0] && s.start < span[1] && s.end > s.start);
    shades.sort_unstable_by(|x, y| x.start.total_cmp(&y.start));
    let tints: Vec<Shade> = shades
        .iter()
        .filter(|s| s.tint != [0.0; 3])
        .copied()
        .collect();
    let mut from = span[0];
    for block in shades.drain(..).filter(|s| s.tint == [0.0; 3]) {
        if block.start > from {
            tinted_stretches(&tints, [from, block.start], &mut visit);
        }
        from = from.max(block.end);
    }
    if from < span[1] {
        tinted_stretches(&tints, [from, span[1]], &mut visit);
    }
}

/// Splits a stretch where tints (sorted by start) begin and end.
fn tinted_stretches(
    tints: &[Shade],
    [from, to]: [f64; 2],
    visit: &mut impl FnMut([f64; 2], DVec3),
) {
    let over: Vec<&Shade> = tints
        .iter()
        .take_while(|t| t.start < to)
        .filter(|t| t.end > from)
        .collect();
    let mut cuts: Vec<f64> = over
        .iter()
        .flat_map(|t| [t.start, t.end])
        .filter(|s| *s > from && *s < to)
        .chain([from, to])
        .collect();
    cuts.sort_unstable_by(f64::total_cmp);
    cuts.dedup();
    let mut active: Vec<&Shade> = Vec::new();
    let mut next = 0;
    for pair in cuts.windows(2) {
        let middle = 0.5 * (pair[0] + pair[1]);
        while next < over.len() && over[next].start <= middle {
            active.push(over[next]);
            next += 1;
        }
        active.retain(|t| t.end > middle);
        visit(
            [pair[0], pair[1]],
            active.iter().map(|t| DVec3::from(t.tint)).product(),
        );
    }
}

/// The integral over a lit stretch of a ray.
struct Integral<'a> {
    ray: &'a Ray,
    model: &'a LightModel<'a>,
    scene: &'a CpuScene<'a>,
    tolerance: f64,
    /// Where the light is nearest to the ray: distance along the ray, and from it [m].
    nearest: Option<[f64; 2]>,
}

impl<'a> Integral<'a> {
    fn new(
        ray: &'a Ray,
        model: &'a LightModel<'a>,
        scene: &'a CpuScene<'a>,
        tolerance: f64,
    ) -> Self {
        let nearest = model.position().map(|position| {
            let to_light = position - ray.origin;
            let projection = to_light.dot(ray.direction);
            let height = (to_light - projection * ray.direction).length();
            [projection, height.max(LIGHT_RADIUS)]
        });
        Self {
            ray,
            model,
            scene,
            tolerance,
            nearest,
        }
    }

    fn over(&self, [a, b]: [f64; 2]) -> DVec3 {
        let optics = &self.scene.optics;
        let f = |s| integrand(self.ray, s, self.model, optics);
        match self.nearest {
            None if self.model.is_plain() => {
                // Constant along the ray but for extinction.
                let path = optics
                    .sigma_t
                    .to_array()
                    .map(|k| transmittance_integral(k, a, b));
                f(0.0) * DVec3::from(path)
            }
            None => quadrature([a, b], self.tolerance, &f),
            Some([projection, height]) => {
                let angle = |s: f64| ((s - projection) / height).atan();
                quadrature([angle(a), angle(b)], self.tolerance, &|xi: f64| {
                    let tan = xi.tan();
                    f(projection + height * tan) * (height * (1.0 + tan * tan))
                })
            }
        }
    }
}

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
fn quadrature([a, b]: [f64; 2], tolerance: f64, f: &impl Fn(f64) -> DVec3) -> DVec3 {
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

    fn shade(start: f64, end: f64, tint: f64) -> Shade {
        Shade {
            start,
            end,
            tint: [tint; 3],
        }
    }

    #[test]
    fn stretches_are_what_is_left() {
        let mut shades = vec![
            shade(6.0, 9.0, 0.5),
            shade(1.0, 2.0, 0.0),
            shade(1.5, 3.0, 0.0),
            shade(7.0, 7.5, 0.5),
            shade(-1.0, 0.5, 0.0),
            shade(8.5, 20.0, 0.0),
        ];
        let mut found = Vec::new();
        lit_stretches(&mut shades, [0.0, 10.0], |s, tint| found.push((s, tint.x)));
        assert_eq!(
            found,
            vec![
                ([0.5, 1.0], 1.0),
                ([3.0, 6.0], 1.0),
                ([6.0, 7.0], 0.5),
                ([7.0, 7.5], 0.25),
                ([7.5, 8.5], 0.5),
            ]
        );
    }

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
