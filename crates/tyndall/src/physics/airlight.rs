//! Airlight: the light of an unshadowed point light that the medium scatters into a stretch of a view ray.
//!
//! Let the light project onto the ray at distance `t_p` and lie at distance `h` from it. With the scattering angle
//! `phi` in [0, pi] as variable, and `T = tan(phi / 2) = (s - t_p + d) / h`, the integral of Chen 2011, eq. 1 over a
//! stretch is
//!
//! ```text
//! integral_a^b exp(-sigma_t (s + d)) rho / d^2 ds = exp(-sigma_t t_p) / h integral rho(cos phi) exp(-u T) d phi,
//! u = sigma_t h,   d phi = 2 / (1 + T^2) dT.
//! ```
//!
//! For isotropic rho this is Sun et al. 2005's F. One table a phase function serves all colour channels, for only u
//! depends on them. Differences of one antiderivative lose f32's precision where it is large and its differences small:
//! `exp(-sigma_t t_p)` overflows where the light is behind the eye, and a wall before a lamp hides nearly all of its
//! airlight (Billeter et al. 2010 split their table in two for that reason). So there are two antiderivatives, one from
//! each end of the ray; a stretch that ends before the light takes the one that is smaller on it, any other takes `far`:
//!
//! ```text
//! near(u, T) = integral_0^T   rho 2/(1+T'^2) exp(-u T') dT'          stretch = exp(-sigma_t t_p) (near(b) - near(a)) / h
//! far(u, T)  = integral_T^inf rho 2/(1+T'^2) exp(-u (T' - T)) dT'    stretch = (A(a) - A(b)) / h,
//!                                                                    A(s) = exp(-sigma_t (s + d)) far(u, T(s))
//! ```
//!
//! The table holds both, divided by what they are for simple densities; that leaves two smooth functions of the order of
//! rho. Its axes are the optical depth `p = u (1 + T^2) atan(1 / T)` and T, each as x with `x^2 (3 - 2 x) = p / (1 + p)`:
//! densest at both ends, where forward and backward peaks are, and where `far` goes like p log p.

use glam::DVec3;
use rayon::prelude::*;

use super::{quadrature::quadrature, transmittance::transmittance_integral};
use crate::frame::Phase;

/// Columns of a table: T.
///
/// Errors of [`AirlightTable::segment`] at this size, over random stretches of random rays, against f64 quadrature:
/// see `ERRORS` in the tests below.
pub const TABLE_WIDTH: usize = 256;
/// Rows of a table: optical depth.
pub const TABLE_HEIGHT: usize = 128;

/// The tables `near` and `far` of one phase function.
#[derive(Clone, Debug)]
pub struct AirlightTable {
    /// See [`AirlightTable::texels`].
    texels: Vec<[f32; 2]>,
}

/// A point light seen from a view ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointOnRay {
    /// Distance along the ray of the point nearest to the light \[m]; negative where the light is behind the eye.
    pub projection: f64,
    /// Distance of the light from that point \[m], > 0.
    pub height: f64,
}

impl PointOnRay {
    /// For a light at `to_light` from the ray's origin; `direction` has unit length. The `radius` \[m] of the light adds to the
    /// height, so that a ray through the light stays finite: see [`light_radius`](crate::light::light_radius).
    pub fn new(to_light: DVec3, direction: DVec3, radius: f64) -> Self {
        let projection = to_light.dot(direction);
        let height = (to_light - projection * direction).length();
        Self {
            projection,
            height: height.hypot(radius),
        }
    }

    /// Distance of the light from the ray's point at distance `s` \[m].
    fn distance(&self, s: f64) -> f64 {
        (s - self.projection).hypot(self.height)
    }

    /// The angle by which the light ray turns while the view ray goes from distance `a` to `b` \[m], in [0, pi): the whole
    /// range of the substitution of Kulla & Fajardo 2012, `s = projection + height tan(xi)`.
    pub(crate) fn turn(&self, [a, b]: [f64; 2]) -> f64 {
        let [x_a, x_b] = [a, b].map(|s| s - self.projection);
        (self.height * (b - a)).atan2(self.height * self.height + x_a * x_b)
    }

    /// The distance `s` where the light ray has turned by an angle since distance `a`, and `ds` by the angle there \[m]. The
    /// sum of two tangents, without cancellation where the light is far from both.
    pub(crate) fn turned(&self, a: f64, angle: f64) -> [f64; 2] {
        let (x, t) = (a - self.projection, angle.tan());
        let s = a + t * (self.height * self.height + x * x) / (self.height - x * t);
        [s, self.distance(s).powi(2) / self.height]
    }

    /// `tan(phi / 2)` at distance `s`, without cancellation before the light.
    fn tangent(&self, s: f64) -> f64 {
        let (x, d) = (s - self.projection, self.distance(s));
        if x > 0.0 {
            (x + d) / self.height
        } else {
            self.height / (d - x)
        }
    }
}

impl AirlightTable {
    /// Computes a table; some hundredths of a second.
    pub fn new(phase: Phase) -> Self {
        let texel = |i: usize| {
            let t = from_axis((i % TABLE_WIDTH) as f64 / (TABLE_WIDTH - 1) as f64);
            let p = from_axis((i / TABLE_WIDTH) as f64 / (TABLE_HEIGHT - 1) as f64);
            let u = p / far_length(t);
            [
                near_ratio(phase, u, t) as f32,
                far_ratio(phase, u, t) as f32,
            ]
        };
        Self {
            texels: (0..TABLE_WIDTH * TABLE_HEIGHT)
                .into_par_iter()
                .map(texel)
                .collect(),
        }
    }

    /// `[near, far]` divided by their scales, [`TABLE_HEIGHT`] rows of p by [`TABLE_WIDTH`] columns of T;
    /// what `airlight.wgsl` reads as a texture.
    pub fn texels(&self) -> &[[f32; 2]] {
        &self.texels
    }

    /// Airlight of the stretch `[a, b]` of a ray \[m], for one channel: the integral of
    /// `exp(-sigma_t (s + d)) rho / d^2`. Times sigma_s and the light's intensity it is a radiance.
    pub fn segment(&self, sigma_t: f64, light: PointOnRay, [a, b]: [f64; 2]) -> f64 {
        let u = sigma_t * light.height;
        let ends = [a, b].map(|s| {
            let t = light.tangent(s);
            let [near, far] = self.near_and_far(u, t);
            [near, (-sigma_t * (s + light.distance(s))).exp() * far]
        });
        let up_to_light = (-sigma_t * light.projection).exp();
        let before_light = b <= light.projection;
        let sum = if before_light && up_to_light * ends[1][0] < ends[0][1] {
            up_to_light * (ends[1][0] - ends[0][0])
        } else {
            ends[0][1] - ends[1][1]
        };
        sum / light.height
    }

    fn near_and_far(&self, u: f64, t: f64) -> [f64; 2] {
        let place = |x: f64, count: usize| {
            let x = x.clamp(0.0, 1.0) * (count - 1) as f64;
            let cell = x.floor().min((count - 2) as f64);
            (cell as usize, x - cell)
        };
        let (row, fy) = place(to_axis(u * far_length(t)), TABLE_HEIGHT);
        let (column, fx) = place(to_axis(t), TABLE_WIDTH);
        let ratio = |k: usize| {
            let at = |r: usize, c: usize| f64::from(self.texels[r * TABLE_WIDTH + c][k]);
            let mix = |r| at(r, column) * (1.0 - fx) + at(r, column + 1) * fx;
            mix(row) * (1.0 - fy) + mix(row + 1) * fy
        };
        [near_scale(u, t) * ratio(0), far_scale(u, t) * ratio(1)]
    }
}

/// x with `x^2 (3 - 2 x) = v / (1 + v)`, for v >= 0.
fn to_axis(v: f64) -> f64 {
    0.5 - (((1.0 - v) / (1.0 + v)).asin() / 3.0).sin()
}

/// v of a place x on an axis; the ends stand for limits that numbers close to them reach as well.
fn from_axis(x: f64) -> f64 {
    let share = (x * x * (3.0 - 2.0 * x)).clamp(1e-8, 1.0 - 1e-8);
    share / (1.0 - share)
}

/// `near` for rho 2/(1+T^2) = 1.
fn near_scale(u: f64, t: f64) -> f64 {
    transmittance_integral(u, 0.0, t)
}

/// The length in T over which `far`'s density falls off where u is 0.
fn far_length(t: f64) -> f64 {
    (1.0 + t * t) * (1.0 / t).atan()
}

/// `far` for rho = 1, exact where u is 0 or large.
fn far_scale(u: f64, t: f64) -> f64 {
    let length = far_length(t);
    2.0 * length / ((1.0 + t * t) * (1.0 + u * length))
}

/// rho(cos phi) 2/(1+T^2), with cos phi = (1 - T^2) / (1 + T^2).
fn density(phase: Phase, t: f64) -> f64 {
    let t2 = t * t;
    phase.evaluate((1.0 - t2) / (1.0 + t2)) * 2.0 / (1.0 + t2)
}

const TABLE_TOLERANCE: f64 = 1e-8;

/// near / near_scale: the mean of the density under exp(-u T'), taken over q, the share of that weight below T'.
fn near_ratio(phase: Phase, u: f64, t: f64) -> f64 {
    let weight = -(-u * t).exp_m1();
    let mean = quadrature([0.0, 1.0], TABLE_TOLERANCE, &|q: f64| {
        let at = if u * t < 1e-9 {
            q * t
        } else {
            (-(-q * weight).ln_1p() / u).min(t)
        };
        DVec3::splat(density(phase, at))
    });
    mean.x
}

/// far / far_scale. T' = T + l z / (1 - z), with the length l over which the integrand falls off, brings infinity to z = 1.
fn far_ratio(phase: Phase, u: f64, t: f64) -> f64 {
    let length = far_length(t) / (1.0 + u * far_length(t));
    let sum = quadrature([0.0, 1.0], TABLE_TOLERANCE, &|z: f64| {
        let rest = 1.0 - z;
        let x = length * z / rest;
        DVec3::splat(density(phase, t + x) * (-u * x).exp() * length / (rest * rest))
    });
    sum.x / far_scale(u, t)
}

#[cfg(test)]
mod tests {
    use std::ops::RangeInclusive;

    use super::*;

    /// A whole stretch is as long as it is, wherever the light: beside it, far before it, far behind it.
    #[test]
    fn light_rays_turn_over_the_whole_stretch() {
        for (projection, height, stretch) in [
            (3.0, 2.0, [0.0, 10.0]),
            (3.0, 1e-6, [0.0, 10.0]),
            (-4.0, 0.1, [1.0, 1e6]),
            (5e8, 3e4, [0.0, 2e-6]),
            (-5e8, 3e4, [1.0, 1.0 + 1e-6]),
            (5e8, 1e-3, [0.0, 1.0]),
        ] {
            let light = PointOnRay { projection, height };
            let turn = light.turn(stretch);
            let [from, to] = stretch;
            let error = |s: f64, expected: f64| (s - expected).abs() / (to - from);
            let [start, end] = [0.0, turn].map(|angle| light.turned(from, angle)[0]);
            assert!(
                error(start, from) < 1e-9 && error(end, to) < 1e-9,
                "{start} {end}"
            );
            let middle = 0.5 * turn;
            let [s, ds] = light.turned(from, middle);
            let step = 1e-4 * turn;
            let [before, after] = [-step, step].map(|d| light.turned(from, middle + d)[0]);
            assert!((from..=to).contains(&s), "{s}");
            let slope = (after - before) / (2.0 * step);
            assert!((slope - ds).abs() < 1e-4 * ds, "{slope} {ds}");
        }
    }

    /// Phase functions and the largest error of their tables, relative to the airlight of the whole ray.
    /// Measured over 20,000 stretches: 1.6e-4, 2.2e-4, 1.5e-4, 3.9e-4, 2.8e-3, 1.3e-3; here over 4,000.
    /// Those from 0.988 on, over these 4,000: 4.6e-3, 2.1e-4, 1.2e-3, 1.7e-4, 1.0e-3.
    const ERRORS: [(Phase, f64); 11] = [
        (Phase::Isotropic, 2e-4),
        (Phase::Rayleigh, 3e-4),
        (Phase::HenyeyGreenstein { g: 0.3 }, 2e-4),
        (Phase::HenyeyGreenstein { g: 0.76 }, 5e-4),
        (Phase::HenyeyGreenstein { g: -0.6 }, 4e-3),
        (Phase::HenyeyGreenstein { g: 0.95 }, 2e-3),
        (Phase::HenyeyGreenstein { g: 0.988 }, 7e-3),
        (Phase::CornetteShanks { g: 0.6 }, 3e-4),
        (Phase::CornetteShanks { g: -0.4 }, 2e-3),
        (Phase::Draine { g: 0.6, alpha: 0.5 }, 3e-4),
        (
            Phase::Draine {
                g: 0.556,
                alpha: 22.0,
            },
            2e-3,
        ),
    ];

    #[test]
    fn every_phase_function_states_its_error() {
        for info in crate::phase::TABLE {
            let mut stated = ERRORS.iter().map(|(phase, _)| phase.info().name);
            assert!(stated.any(|name| name == info.name), "{}", info.name);
        }
    }

    /// The integral as it stands, in the angle at the light.
    fn quadrature_of(phase: Phase, sigma_t: f64, light: PointOnRay, [a, b]: [f64; 2]) -> f64 {
        let angle = |s: f64| ((s - light.projection) / light.height).atan();
        let sum = quadrature([angle(a), angle(b)], 1e-9, &|xi: f64| {
            let s = light.projection + light.height * xi.tan();
            let extinction = (-sigma_t * (s + light.distance(s))).exp();
            DVec3::splat(extinction * phase.evaluate(-xi.sin()) / light.height)
        });
        sum.x
    }

    #[test]
    fn tables_are_as_good_as_stated() {
        for (phase, stated) in ERRORS {
            let worst = worst_of(phase, [-5.0..=1.0, -3.0..=1.5]);
            assert!(
                worst < stated,
                "{phase:?}: {worst:.2e}, stated {stated:.0e}"
            );
        }
    }

    /// However thin the medium is, and however near to the light the ray passes: up to a ten millionth of its length. More of
    /// the stretches are of rays that end next to the light, where errors are largest: 2.5e-4 of isotropic.
    #[test]
    fn tables_hold_for_thin_media_and_rays_through_the_light() {
        for (phase, stated) in ERRORS {
            let worst = worst_of(phase, [-9.0..=1.0, -7.0..=1.5]);
            let stated = 2.0 * stated;
            assert!(worst < stated, "{phase:?}: {worst:.2e}, {stated:.0e}");
        }
    }

    /// The largest error of a table over ranges of log10 of sigma_t and of the height.
    fn worst_of(phase: Phase, [sigmas, heights]: [RangeInclusive<f32>; 2]) -> f64 {
        let table = AirlightTable::new(phase);
        let mut worst = 0.0_f64;
        // Then projection, start, length.
        let ranges = [sigmas, heights, -20.0..=40.0, 0.0..=30.0, 0.0..=30.0];
        for x in tyndall_testkit::samples::in_box(7, 4_000, ranges) {
            let [sigma_t, height, projection, a, length] = x.map(f64::from);
            let sigma_t = 10.0_f64.powf(sigma_t);
            let light = PointOnRay {
                projection,
                height: 10.0_f64.powf(height),
            };
            let stretch = [a, a + length];
            let exact = quadrature_of(phase, sigma_t, light, stretch);
            let whole = quadrature_of(phase, sigma_t, light, [0.0, 60.0]);
            // The light's optical depth from the ray at its nearest; beyond it nothing is to be seen.
            let depth = sigma_t * (projection.max(0.0) + light.height);
            if depth < 10.0 {
                let found = table.segment(sigma_t, light, stretch);
                worst = worst.max((found - exact).abs() / whole);
            }
        }
        worst
    }

    /// f32 against f64 over the same texels: rounding of the differences, relative to the whole ray. Measured 1.7e-5 on lavapipe.
    #[cfg(feature = "gpu")]
    #[test]
    fn wgsl_twin_agrees() {
        use tyndall_testkit::{device::device_or_skip, wgsl};
        let Some(gpu) = device_or_skip("airlight.wgsl") else {
            return;
        };
        let phase = Phase::HenyeyGreenstein { g: 0.5 };
        let table = AirlightTable::new(phase);
        let picture = crate::gpu::airlight::upload(&gpu.device, &gpu.queue, &[&table]);
        let ranges = [-8.0..=0.0, -7.0..=1.5, -20.0..=40.0, 0.0..=30.0, 0.0..=30.0];
        let inputs = tyndall_testkit::samples::in_box(11, 20_000, ranges);
        let modules = "import tyndall::physics::airlight::{AirlightLight, airlight_segment};";
        let modules = crate::shader::tests::harness(modules, &[], &[]);
        let found = wgsl::evaluate_with(
            gpu,
            &[&modules],
            &[wgpu::BindGroupEntry { binding: 3, resource: wgpu::BindingResource::TextureView(&picture) }],
            "airlight_segment(0u, vec3f(pow(10.0, x[0])), AirlightLight(x[2], pow(10.0, x[1])), vec2f(x[3], x[3] + x[4])), 0.0",
            &inputs,
        )
        .expect("the shader runs");
        let mut worst = 0.0_f64;
        for (x, found) in inputs.iter().zip(found) {
            let [sigma_t, height, projection, a, length] = x.map(f64::from);
            let sigma_t = 10.0_f64.powf(sigma_t);
            let light = PointOnRay {
                projection,
                height: 10.0_f64.powf(height),
            };
            if sigma_t * (projection.max(0.0) + light.height) > 10.0 {
                continue;
            }
            let exact = table.segment(sigma_t, light, [a, a + length]);
            let whole = table.segment(sigma_t, light, [0.0, 60.0]);
            let error = (f64::from(found[0]) - exact).abs() / whole;
            worst = worst.max(error);
        }
        assert!(worst < 5e-5, "{worst:.1e}");
    }
}
