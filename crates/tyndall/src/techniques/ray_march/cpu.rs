//! The CPU twin of `ray_march.wesl`, in f64.

use glam::DVec3;

use super::params::{INFO, Params, Spacing};
use crate::{
    camera::Ray,
    error::PrepareError,
    integrate::{CpuLight, CpuScene, RayIntegrator, integrand},
    light::LightModel,
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

/// Places of the samples on a ray.
enum Steps {
    Equal {
        start: f64,
        step: f64,
    },
    /// Kulla & Fajardo 2012: `s = t_p + h tan(xi)`, equal steps in xi.
    Equiangular {
        projection: f64,
        height: f64,
        start: f64,
        step: f64,
    },
}

impl Steps {
    fn new(params: &Params, ray: &Ray, model: &LightModel<'_>, [a, b]: [f64; 2]) -> Self {
        let count = f64::from(params.steps);
        match (params.spacing, model.position()) {
            (Spacing::Equiangular, Some(position)) => {
                let to_light = position - ray.origin;
                let projection = to_light.dot(ray.direction);
                let height = (to_light - projection * ray.direction)
                    .length()
                    .hypot(model.radius());
                let angle = |s: f64| ((s - projection) / height).atan();
                Self::Equiangular {
                    projection,
                    height,
                    start: angle(a),
                    step: (angle(b) - angle(a)) / count,
                }
            }
            _ => Self::Equal {
                start: a,
                step: (b - a) / count,
            },
        }
    }

    /// The distance of sample `i` and the length of ray it stands for \[m].
    fn step(&self, i: u32) -> (f64, f64) {
        let i = f64::from(i) + 0.5;
        match *self {
            Self::Equal { start, step } => (start + i * step, step),
            Self::Equiangular {
                projection,
                height,
                start,
                step,
            } => {
                let tan = (start + i * step).tan();
                (projection + height * tan, height * (1.0 + tan * tan) * step)
            }
        }
    }
}
