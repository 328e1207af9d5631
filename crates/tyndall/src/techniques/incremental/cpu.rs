//! Slice by slice, all at once when the integrator is made.

use glam::DVec3;
use rayon::prelude::*;

use super::{
    params::{INFO, Params},
    rectified::Row,
    view::{EpipolarView, InSlice},
};
use crate::{
    camera::Ray,
    epipolar::{EpipolarFrame, low_rank::LowRank},
    error::PrepareError,
    integrate::{CpuLight, CpuScene, RayIntegrator, stretches::integrate_lit},
    light::{LightModel, softened_kernel},
    physics::medium::Optics,
    techniques::method::CpuMethod,
};

/// Relative error of the quadrature of rays that are walked.
const TOLERANCE: f64 = 1e-3;

impl CpuMethod for Params {
    fn integrator<'a>(
        &'a self,
        scene: &'a CpuScene<'a>,
    ) -> Result<Box<dyn RayIntegrator + 'a>, PrepareError> {
        integrator(self, scene)
    }
}

fn integrator<'a>(
    params: &Params,
    scene: &'a CpuScene<'a>,
) -> Result<Box<dyn RayIntegrator + 'a>, PrepareError> {
    let mut pixels = vec![DVec3::ZERO; scene.depth.len()];
    for light in &scene.lights {
        if light.models.iter().any(|m| !m.is_plain()) {
            return Err(PrepareError::Unsupported {
                technique: INFO.name,
                what: "light textures".into(),
            });
        }
        add_light(params, scene, light, &mut pixels);
    }
    Ok(Box::new(Finished(pixels)))
}

/// The finished image.
struct Finished(Vec<DVec3>);

impl RayIntegrator for Finished {
    fn in_scatter(&self, pixel: usize, _ray: &Ray) -> DVec3 {
        self.0[pixel]
    }
}

fn add_light(params: &Params, scene: &CpuScene<'_>, light: &CpuLight<'_>, pixels: &mut [DVec3]) {
    let view = EpipolarView::new(scene, light, &params.resolution);
    for model in &light.models {
        match &view {
            Some(view) => add_slices(params.rank as usize, scene, light, model, view, pixels),
            None => {
                let all = pixels.par_iter_mut().enumerate();
                all.for_each(|(i, pixel)| {
                    let ray = pixel_ray(scene, i);
                    *pixel += walked(&ray, scene, light, model, [0.0, ray.length]);
                });
            }
        }
    }
}

fn pixel_ray(scene: &CpuScene<'_>, pixel: usize) -> Ray {
    let width = scene.size[0] as usize;
    scene.ray((pixel % width) as u32, (pixel / width) as u32)
}

/// A stretch of a ray, walked through the shadow map texel by texel.
fn walked(
    ray: &Ray,
    scene: &CpuScene<'_>,
    light: &CpuLight<'_>,
    model: &LightModel<'_>,
    span: [f64; 2],
) -> DVec3 {
    let mut shades = Vec::new();
    if let Some(shadows) = &light.shadows {
        shadows.walk(ray.origin, ray.direction, span, &mut shades);
    }
    integrate_lit(ray, model, scene, TOLERANCE, span, &mut shades)
}

/// True where coloured glass tints a part of the ray.
fn is_tinted(ray: &Ray, light: &CpuLight<'_>, place: &InSlice) -> bool {
    let mut shades = Vec::new();
    if let Some(shadows) = &light.shadows {
        let on_map = shadows.on_map(ray.origin, ray.direction, place.span);
        on_map.walk_tints(place.span, &mut shades);
    }
    shades.iter().any(|s| s.tint != [1.0; 3])
}

fn add_slices(
    rank: usize,
    scene: &CpuScene<'_>,
    light: &CpuLight<'_>,
    model: &LightModel<'_>,
    view: &EpipolarView,
    pixels: &mut [DVec3],
) {
    // Light beyond the map is not blocked; rays near the axis, or behind coloured glass, are walked.
    let places: Vec<Option<InSlice>> = pixels
        .par_iter_mut()
        .enumerate()
        .map(|(i, pixel)| {
            let ray = pixel_ray(scene, i);
            let place = view
                .place(&ray, light, model)
                .filter(|place| !is_tinted(&ray, light, place));
            let rest = match &place {
                Some(place) => vec![[0.0, place.span[0]], [place.span[1], ray.length]],
                None => vec![[0.0, ray.length]],
            };
            for span in rest.into_iter().filter(|[a, b]| a < b) {
                *pixel += walked(&ray, scene, light, model, span);
            }
            place
        })
        .collect();
    let mut in_slices = vec![Vec::new(); view.map.rows.len()];
    for (pixel, place) in places.iter().enumerate() {
        if let Some(place) = place {
            in_slices[place.slice].push((pixel, *place));
        }
    }
    let kernel = Kernel {
        frame: view.frame,
        model,
        optics: &scene.optics,
    };
    let factors = kernel.factors(view, places.iter().flatten(), rank);
    let sums: Vec<(usize, DVec3)> = in_slices
        .par_iter_mut()
        .zip(&view.map.rows)
        .flat_map_iter(|(rays, row)| slice(rays, row, &kernel, &factors))
        .collect();
    for (pixel, sum) in sums {
        pixels[pixel] += sum;
    }
}

/// The rays of a slice, in growing beta; the samples they pass go dark one by one.
fn slice(
    rays: &mut [(usize, InSlice)],
    row: &Row,
    kernel: &Kernel<'_>,
    factors: &LowRank,
) -> Vec<(usize, DVec3)> {
    rays.sort_unstable_by(|a, b| a.1.beta.total_cmp(&b.1.beta));
    let mut order: Vec<usize> = (0..row.angles.len()).collect();
    order.sort_unstable_by(|a, b| row.angles[*a].total_cmp(&row.angles[*b]));
    let mut darkening = order.into_iter().peekable();
    let mut lit = PartialSums::new(row, factors);
    let one = |(pixel, place): &(usize, InSlice)| {
        while let Some(sample) = darkening.next_if(|i| row.angles[*i] <= place.beta as f32) {
            lit.remove(sample);
        }
        let [from, to] = place
            .span
            .map(|s| lit.up_to(row.place(kernel.frame.gamma(place.beta, s))));
        let products = factors
            .at_beta(spread(place.beta))
            .zip(from.iter().zip(&to));
        let sum: DVec3 = products.map(|(b, (from, to))| b * (*to - *from)).sum();
        (*pixel, sum.max(DVec3::ZERO) * kernel.common(place.beta))
    };
    rays.iter().map(one).collect()
}

/// The integrand of eq. 3 over gamma, without visibility, split into a factor of beta alone and a smooth rest.
///
/// Sun: `ds / d gamma = 1 / sin(beta)`. Point: `ds / d gamma = d^2 / (L sin(beta))` with d the distance from the light,
/// which cancels 1 / d^2, and the scattering angle is beta + gamma; see [`softened_kernel`].
struct Kernel<'a> {
    frame: EpipolarFrame,
    model: &'a LightModel<'a>,
    optics: &'a Optics,
}

impl Kernel<'_> {
    /// The factor of beta alone.
    fn common(&self, beta: f64) -> DVec3 {
        let strength = self.model.strength();
        match self.frame.distance() {
            None => strength * self.optics.scattering(beta.cos()) / beta.sin(),
            Some(distance) => strength / (distance * beta.sin()),
        }
    }

    fn smooth(&self, beta: f64, gamma: f64) -> DVec3 {
        match self.frame.distance() {
            None => self.optics.transmittance(self.frame.crossing(beta, gamma)),
            Some(distance) => {
                let turn = beta + gamma;
                if turn >= std::f64::consts::PI {
                    return DVec3::ZERO;
                }
                let place = [gamma, beta].map(|angle| distance * angle.sin() / turn.sin());
                softened_kernel(self.optics, place, self.model.radius(), turn.cos())
            }
        }
    }

    fn factors<'p>(
        &self,
        view: &EpipolarView,
        places: impl Iterator<Item = &'p InSlice>,
        rank: usize,
    ) -> LowRank {
        let around = |[a, b]: [f64; 2], x: f64| [a.min(x), b.max(x)];
        let nothing = [f64::INFINITY, f64::NEG_INFINITY];
        let betas = places.map(|p| spread(p.beta)).fold(nothing, around);
        let rows = view.map.rows.iter().filter(|r| !r.angles.is_empty());
        let ends = rows.flat_map(|r| [r.gamma(0.0), r.gamma(r.angles.len() as f64)]);
        let gammas = ends.fold(nothing, around);
        if betas[0] > betas[1] || gammas[0] > gammas[1] {
            return LowRank::new(|_, _| DVec3::ZERO, [0.0, 1.0], [0.0, 1.0], rank);
        }
        LowRank::new(
            |b, g| self.smooth(2.0 * b.exp().atan(), g),
            betas,
            gammas,
            rank,
        )
    }
}

/// beta on an axis where the kernel is smooth up to the epipole, `1 / sin(beta) = cosh` of it: log(tan(beta / 2)).
fn spread(beta: f64) -> f64 {
    (0.5 * beta).tan().ln()
}

/// Sums of `Gamma_i d gamma` over the samples that are still lit, from the first sample to any (Fenwick 1994).
struct PartialSums {
    rank: usize,
    /// `[sample][i]`; zero once the sample is dark.
    terms: Vec<DVec3>,
    /// The tree, from index 1.
    tree: Vec<DVec3>,
}

impl PartialSums {
    fn new(row: &Row, factors: &LowRank) -> Self {
        let step = row.gamma(1.0) - row.gamma(0.0);
        let count = row.angles.len();
        let terms: Vec<DVec3> = (0..count)
            .flat_map(|i| factors.at_gamma(row.gamma(i as f64 + 0.5)))
            .map(|gamma| gamma * step)
            .collect();
        let rank = terms.len().checked_div(count).unwrap_or(0);
        let mut tree = vec![DVec3::ZERO; rank];
        tree.extend_from_slice(&terms);
        for i in 1..=count {
            let parent = i + (i & i.wrapping_neg());
            if parent <= count {
                for k in 0..rank {
                    let child = tree[i * rank + k];
                    tree[parent * rank + k] += child;
                }
            }
        }
        Self { rank, terms, tree }
    }

    fn remove(&mut self, sample: usize) {
        let count = self.terms.len() / self.rank;
        let mut i = sample + 1;
        while i <= count {
            for k in 0..self.rank {
                self.tree[i * self.rank + k] -= self.terms[sample * self.rank + k];
            }
            i += i & i.wrapping_neg();
        }
        self.terms[sample * self.rank..(sample + 1) * self.rank].fill(DVec3::ZERO);
    }

    /// The sums up to a place among the samples, the last of them in part.
    fn up_to(&self, place: f64) -> Vec<DVec3> {
        let entire = place.floor() as usize;
        let part = place - place.floor();
        let mut sums = vec![DVec3::ZERO; self.rank];
        let mut i = entire;
        while i > 0 {
            for (k, sum) in sums.iter_mut().enumerate() {
                *sum += self.tree[i * self.rank + k];
            }
            i -= i & i.wrapping_neg();
        }
        if let Some(term) = self.terms.get(entire * self.rank..(entire + 1) * self.rank) {
            for (sum, term) in sums.iter_mut().zip(term) {
                *sum += part * *term;
            }
        }
        sums
    }
}
