//! The CPU side: rectify, build trees and decompose once a light, then traverse ray by ray.

use glam::DVec3;

use super::{
    params::{INFO, Integrator, Params, Show},
    svd,
    svd_stretch::{SvdRay, TOLERANCE},
};
use crate::{
    camera::Ray,
    epipolar::{
        grid::{EpipolarGrid, GridRay, GridScene},
        low_rank::LowRank,
        rectify,
        traverse::Run,
        tree::MinMaxTree,
    },
    error::PrepareError,
    integrate::{
        CpuLight, CpuScene, RayIntegrator,
        stretches::{Integral, sum_lit},
    },
    light::LightModel,
    shadow::{Shade, walk::RayOnMap},
    techniques::method::CpuMethod,
};

impl CpuMethod for Params {
    fn integrator<'a>(
        &'a self,
        scene: &'a CpuScene<'a>,
    ) -> Result<Box<dyn RayIntegrator + 'a>, PrepareError> {
        if self.show != Show::Light {
            return Err(PrepareError::Unsupported {
                technique: INFO.name,
                what: "show, a view of how the light was computed, on the CPU".into(),
            });
        }
        Ok(integrator(self, scene))
    }
}

fn integrator<'a>(params: &'a Params, scene: &'a CpuScene<'a>) -> Box<dyn RayIntegrator + 'a> {
    let of_light = |light| Forest::new(params, scene, light);
    Box::new(MinMax {
        scene,
        forests: scene.lights.iter().map(of_light).collect(),
    })
}

struct MinMax<'a> {
    scene: &'a CpuScene<'a>,
    /// A light's trees; `None` where its rays are walked.
    forests: Vec<Option<Forest>>,
}

/// A light's slices.
struct Forest {
    grid: EpipolarGrid,
    /// One a slice; none where nothing casts shadows.
    trees: Vec<MinMaxTree>,
    /// The svd integrator's, if it integrates.
    factors: Option<LowRank>,
}

impl RayIntegrator for MinMax<'_> {
    fn in_scatter(&self, _pixel: usize, ray: &Ray) -> DVec3 {
        let mut shades = Vec::new();
        let mut sum = DVec3::ZERO;
        for (light, forest) in self.scene.lights.iter().zip(&self.forests) {
            for model in &light.models {
                let span = model.reach(ray.origin, ray.direction, [0.0, ray.length]);
                if span[0] < span[1] {
                    let place = forest.as_ref().and_then(|f| Some((f, f.grid.ray(ray)?)));
                    shades.clear();
                    find_shades(ray, light, place, span, &mut shades);
                    sum += self.integrate(ray, model, place, span, &mut shades);
                }
            }
        }
        sum
    }
}

impl MinMax<'_> {
    fn integrate(
        &self,
        ray: &Ray,
        model: &LightModel<'_>,
        place: Option<(&Forest, GridRay)>,
        span: [f64; 2],
        shades: &mut Vec<Shade>,
    ) -> DVec3 {
        let analytic = Integral::new(ray, model, self.scene, TOLERANCE);
        let svd = place.and_then(|(forest, place)| {
            let factors = forest.factors.as_ref()?;
            SvdRay::new(ray, model, &self.scene.optics, &forest.grid, place, factors)
        });
        sum_lit(ray, model, span, shades, |stretch, tint| match &svd {
            // Behind coloured glass a stretch is a texel long.
            Some(svd) if tint == DVec3::ONE => svd.over(stretch),
            _ => tint * analytic.over(stretch),
        })
    }
}

fn find_shades(
    ray: &Ray,
    light: &CpuLight<'_>,
    place: Option<(&Forest, GridRay)>,
    span: [f64; 2],
    shades: &mut Vec<Shade>,
) {
    let Some(shadows) = &light.shadows else {
        return;
    };
    let on_map = shadows.on_map(ray.origin, ray.direction, span);
    match place {
        Some((forest, place)) => forest.traverse(&place, span, &on_map, shades),
        None => on_map.walk_depth(span, shades),
    }
    on_map.walk_tints(span, shades);
}

impl Forest {
    /// `None` where there are no slices.
    fn new(params: &Params, scene: &CpuScene<'_>, light: &CpuLight<'_>) -> Option<Self> {
        let is_svd = params.integrator == Integrator::Svd;
        let (model, shadows) = (light.models.first()?, light.shadows.as_ref());
        if shadows.is_none() && !is_svd {
            return None;
        }
        let grid = GridScene {
            camera: &scene.camera,
            size: scene.size,
            light: model.source(),
            cone: model.cone(),
            faces: shadows.map_or(&[], |s| s.faces()),
            side: shadows.map_or(1, |s| s.side() as usize),
        };
        let grid = EpipolarGrid::new(&grid, &params.resolution)?;
        let factors = is_svd
            .then(|| svd::factors(&grid, &scene.optics, model.radius(), params.rank as usize));
        Some(Self {
            grid,
            trees: shadows.map_or_else(Vec::new, |s| rectify::trees(&grid, s)),
            factors,
        })
    }

    /// Appends the stretches of a view ray that are in shadow. Leaves that cannot tell are walked, and so are the
    /// parts before the first leaf that lies entirely within the span, and after the last.
    fn traverse(
        &self,
        ray: &GridRay,
        span: [f64; 2],
        on_map: &RayOnMap<'_>,
        shades: &mut Vec<Shade>,
    ) {
        let [from, to] = span.map(|s| self.grid.sample_at(ray, s));
        let last = self.grid.samples as f64;
        let first = from.ceil().clamp(0.0, last) as usize;
        let end = (to.floor().clamp(0.0, last) as usize).max(first);
        let border = |leaf| self.grid.crossing(ray, leaf).clamp(span[0], span[1]);
        on_map.walk_depth([span[0], border(first)], shades);
        self.trees[ray.slice].traverse_nodes(ray.b, [first, end], |run, leaves| {
            let part = leaves.map(border);
            match run {
                Run::Dark => shades.push(Shade {
                    start: part[0],
                    end: part[1],
                    tint: [0.0; 3],
                }),
                Run::Mixed => on_map.walk_depth(part, shades),
            }
        });
        on_map.walk_depth([border(end), span[1]], shades);
    }
}
