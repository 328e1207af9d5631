//! Lit stretches of a ray, and the integral over each: the smooth part of every technique that finds visibility first.

use glam::DVec3;

use super::{CpuScene, Shade};
use crate::{
    camera::Ray,
    light::{LIGHT_RADIUS, LightModel},
    physics::{quadrature::quadrature, transmittance::transmittance_integral},
    techniques::ray_march::cpu::integrand,
};

/// The integral over the part of `span` that `shades` leave lit, to a relative `tolerance` where it has no closed form.
/// Sorts and empties `shades`.
pub(crate) fn integrate_lit(
    ray: &Ray,
    model: &LightModel<'_>,
    scene: &CpuScene<'_>,
    tolerance: f64,
    span: [f64; 2],
    shades: &mut Vec<Shade>,
) -> DVec3 {
    let integral = Integral::new(ray, model, scene, tolerance);
    let mut breaks = Vec::new();
    model.breaks(ray.origin, ray.direction, span, &mut breaks);
    breaks.sort_unstable_by(f64::total_cmp);
    let mut sum = DVec3::ZERO;
    lit_stretches(shades, span, |[from, to], tint| {
        let first = breaks.partition_point(|s| *s <= from);
        let within = breaks[first..].iter().copied().take_while(|s| *s < to);
        let mut a = from;
        for b in within.chain([to]) {
            sum += tint * integral.over([a, b]);
            a = b;
        }
    });
    sum
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
}
