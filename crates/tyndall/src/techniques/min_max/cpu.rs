//! The CPU side: rectify once a light, then traverse ray by ray.

use glam::DVec3;

use super::Params;
use crate::{
    camera::Ray,
    cpu::{CpuLight, CpuScene, RayIntegrator, Shade, stretches::integrate_lit},
    epipolar::{rectified::Rectified, slices::SliceCount, view::EpipolarView},
    light::LightModel,
};

/// Relative error of the quadrature of a lit stretch, where it has no closed form.
const TOLERANCE: f64 = 1e-3;

pub(crate) fn integrator<'a>(
    params: &Params,
    scene: &'a CpuScene<'a>,
) -> Box<dyn RayIntegrator + 'a> {
    let automatic = |n: u32| (n > 0).then_some(n as usize);
    let rectified = scene.lights.iter().map(|light| {
        let (model, shadows) = (light.models.first()?, light.shadows.as_ref()?);
        let side = shadows.side() as usize;
        let slices =
            automatic(params.slices).map_or(SliceCount::AtLeast(side), SliceCount::Exactly);
        let view = EpipolarView::new(scene, light, model, slices, params.epipole_radius)?;
        let samples = automatic(params.samples).unwrap_or(side);
        let map = Rectified::new(view.frame, &view.slices, &view.ranges, samples, shadows);
        Some((view, map))
    });
    Box::new(MinMax {
        scene,
        rectified: rectified.collect(),
    })
}

struct MinMax<'a> {
    scene: &'a CpuScene<'a>,
    /// A light's slices; `None` where its rays are walked.
    rectified: Vec<Option<(EpipolarView, Rectified)>>,
}

impl RayIntegrator for MinMax<'_> {
    fn in_scatter(&self, _pixel: usize, ray: &Ray) -> DVec3 {
        let mut shades = Vec::new();
        let mut sum = DVec3::ZERO;
        for (light, rectified) in self.scene.lights.iter().zip(&self.rectified) {
            for model in &light.models {
                let span = model.reach(ray.origin, ray.direction, [0.0, ray.length]);
                if span[0] < span[1] {
                    shades.clear();
                    find_shades(ray, light, model, rectified.as_ref(), span, &mut shades);
                    sum += integrate_lit(ray, model, self.scene, TOLERANCE, span, &mut shades);
                }
            }
        }
        sum
    }
}

fn find_shades(
    ray: &Ray,
    light: &CpuLight<'_>,
    model: &LightModel<'_>,
    rectified: Option<&(EpipolarView, Rectified)>,
    span: [f64; 2],
    shades: &mut Vec<Shade>,
) {
    let Some(shadows) = &light.shadows else {
        return;
    };
    let place = rectified.and_then(|(view, map)| Some((map, view.place(ray, light, model)?)));
    match place {
        Some((map, place)) => {
            map.shades(place.slice, place.beta, place.span, shades);
            shadows.walk_tints(ray.origin, ray.direction, place.span, shades);
        }
        None => shadows.walk(ray.origin, ray.direction, span, shades),
    }
}
