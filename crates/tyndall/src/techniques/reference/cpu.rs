//! Exact visibility: from the scene's triangles, or from the shadow map texel by texel.

use glam::DVec3;

use super::params::{Params, Visibility};
use crate::{
    camera::Ray,
    error::PrepareError,
    integrate::{CpuLight, CpuScene, RayIntegrator, stretches::integrate_lit},
    light::LightModel,
    shadow::{Occluders, Shade},
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
    fn in_scatter(&self, _pixel: usize, ray: &Ray) -> DVec3 {
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
        integrate_lit(ray, model, self.scene, self.tolerance, span, shades)
    }
}
