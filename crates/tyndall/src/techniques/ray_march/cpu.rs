//! The CPU twin of `ray_march.wesl`, in f64.

use std::ops::Range;

use glam::DVec3;

use super::params::{INFO, Params, Spacing};
use crate::{
    camera::Ray,
    error::PrepareError,
    integrate::{CpuLight, CpuScene, RayIntegrator, integrand},
    light::LightModel,
    physics::{airlight::PointOnRay, medium::Optics},
    techniques::method::CpuMethod,
};

impl CpuMethod for Params {
    fn integrator<'a>(
        &'a self,
        scene: &'a CpuScene<'a>,
    ) -> Result<Box<dyn RayIntegrator + 'a>, PrepareError> {
        integrator(self, scene)
    }
}

fn integrator<'a>(
    params: &'a Params,
    scene: &'a CpuScene<'a>,
) -> Result<Box<dyn RayIntegrator + 'a>, PrepareError> {
    let is_area = |light: &CpuLight<'_>| light.models.iter().any(LightModel::is_of_area);
    if let Some(index) = scene.lights.iter().position(is_area) {
        return Err(PrepareError::Unsupported {
            technique: INFO.name,
            what: format!("rect lights on the CPU (lights[{index}])"),
        });
    }
    Ok(Box::new(RayMarch { params, scene }))
}

struct RayMarch<'a> {
    params: &'a Params,
    scene: &'a CpuScene<'a>,
}

impl RayIntegrator for RayMarch<'_> {
    fn in_scatter(&self, _pixel: usize, ray: &Ray) -> DVec3 {
        let of_light = |light: &CpuLight<'_>| -> DVec3 {
            light
                .models
                .iter()
                .map(|model| self.march(ray, light, model))
                .sum()
        };
        self.scene.lights.iter().map(of_light).sum()
    }
}

impl RayMarch<'_> {
    fn march(&self, ray: &Ray, light: &CpuLight<'_>, model: &LightModel<'_>) -> DVec3 {
        let span = model.reach(ray.origin, ray.direction, [0.0, ray.length]);
        let span = seen(&self.scene.optics, span);
        if span[0] >= span[1] {
            return DVec3::ZERO;
        }
        let steps = Steps::new(self.params, ray, model, span);
        let mut sum = DVec3::ZERO;
        for i in 0..self.params.steps {
            let (s, ds) = steps.step(i);
            let point = ray.at(s);
            let tint = light.shadows.as_ref().map_or(DVec3::ONE, |m| m.tint(point));
            if tint != DVec3::ZERO {
                sum += tint * integrand(ray, s, model, &self.scene.optics) * ds;
            }
        }
        sum
    }
}

/// Optical depth behind which nothing is seen: exp(-32) = 1e-14.
const MOST_DEPTH: f64 = 32.0;
/// Steps of equal length on either side of a lamp that are too long where the ray passes it within them.
const PEAK: f64 = 8.0;

/// The part of the span that light may come from: behind so much of the medium that no channel sees it there is none. In what
/// is left steps are as short as a dense medium asks for.
fn seen(optics: &Optics, [a, b]: [f64; 2]) -> [f64; 2] {
    [a, b.min(MOST_DEPTH / optics.sigma_t.min_element())]
}

/// Places of the samples on a ray: equal steps, and some of equal angle at a local light.
struct Steps {
    start: f64,
    length: f64,
    by_angle: Option<ByAngle>,
}

/// Kulla & Fajardo 2012: `s = t_p + h tan(xi)`, equal steps in xi.
struct ByAngle {
    light: PointOnRay,
    /// The steps that are taken like this.
    range: Range<u32>,
    /// The distance at which they begin \[m].
    start: f64,
    /// The angle of each.
    turn: f64,
}

impl Steps {
    fn new(params: &Params, ray: &Ray, model: &LightModel<'_>, [a, b]: [f64; 2]) -> Self {
        let length = (b - a) / f64::from(params.steps);
        let by_angle = model.position().map(|position| {
            let light = PointOnRay::new(position - ray.origin, ray.direction, model.radius());
            let range = match params.spacing {
                Spacing::Equal => peak([a, length], params.steps, light),
                Spacing::Equiangular => 0..params.steps,
            };
            let [start, end] = [range.start, range.end].map(|step| a + f64::from(step) * length);
            let turn = light.turn([start, end]) / f64::from(range.len().max(1) as u32);
            ByAngle {
                light,
                range,
                start,
                turn,
            }
        });
        Self {
            start: a,
            length,
            by_angle,
        }
    }

    /// The distance of sample `i` and the length of ray it stands for \[m].
    fn step(&self, i: u32) -> (f64, f64) {
        match &self.by_angle {
            Some(by) if by.range.contains(&i) => {
                let angle = (f64::from(i - by.range.start) + 0.5) * by.turn;
                let [s, ds] = by.light.turned(by.start, angle);
                (s, ds * by.turn)
            }
            _ => (self.start + (f64::from(i) + 0.5) * self.length, self.length),
        }
    }
}

/// The steps whose light equal lengths do not resolve: about a light that the ray passes more closely.
fn peak([start, length]: [f64; 2], steps: u32, light: PointOnRay) -> Range<u32> {
    let room = PEAK * length;
    if light.height >= room {
        return 0..0;
    }
    let place = |s: f64| ((s - start) / length).clamp(0.0, f64::from(steps));
    let from = place(light.projection - room).floor() as u32;
    from..place(light.projection + room).ceil() as u32
}
