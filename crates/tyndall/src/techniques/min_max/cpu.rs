//! The CPU side: rectify and build trees once a light, then traverse ray by ray.

use glam::DVec3;

use super::Params;
use crate::{
    camera::Ray,
    cpu::{CpuLight, CpuScene, RayIntegrator, Shade, stretches::integrate_lit},
    epipolar::{
        cells,
        grid::{EpipolarGrid, GridRay, GridScene},
        tree::{MinMaxTree, Run},
    },
    shadow::walk::RayOnMap,
};

/// Relative error of the quadrature of a lit stretch, where it has no closed form.
const TOLERANCE: f64 = 1e-3;

pub(crate) fn integrator<'a>(
    params: &'a Params,
    scene: &'a CpuScene<'a>,
) -> Box<dyn RayIntegrator + 'a> {
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

/// A light's slices, and a tree over each.
struct Forest {
    grid: EpipolarGrid,
    trees: Vec<MinMaxTree>,
}

impl RayIntegrator for MinMax<'_> {
    fn in_scatter(&self, _pixel: usize, ray: &Ray) -> DVec3 {
        let mut shades = Vec::new();
        let mut sum = DVec3::ZERO;
        for (light, forest) in self.scene.lights.iter().zip(&self.forests) {
            for model in &light.models {
                let span = model.reach(ray.origin, ray.direction, [0.0, ray.length]);
                if span[0] < span[1] {
                    shades.clear();
                    find_shades(ray, light, forest.as_ref(), span, &mut shades);
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
    forest: Option<&Forest>,
    span: [f64; 2],
    shades: &mut Vec<Shade>,
) {
    let Some(shadows) = &light.shadows else {
        return;
    };
    let on_map = shadows.on_map(ray.origin, ray.direction, span);
    match forest.and_then(|f| Some((f, f.grid.ray(ray)?))) {
        Some((forest, place)) => forest.traverse(&place, span, &on_map, shades),
        None => on_map.walk_depth(span, shades),
    }
    on_map.walk_tints(span, shades);
}

impl Forest {
    /// `None` where there are no slices.
    fn new(params: &Params, scene: &CpuScene<'_>, light: &CpuLight<'_>) -> Option<Self> {
        let (model, shadows) = (light.models.first()?, light.shadows.as_ref()?);
        let grid = GridScene {
            camera: &scene.camera,
            size: scene.size,
            light: model.source(),
            cone: model.cone(),
            faces: shadows.faces(),
            side: shadows.side() as usize,
        };
        let grid = EpipolarGrid::new(&grid, &params.resolution)?;
        let trees = cells::trees(&grid, shadows);
        Some(Self { grid, trees })
    }

    /// Appends the stretches of a view ray that are in shadow. What leaves cannot tell is walked, and so is what comes
    /// before the first leaf that lies wholly within the span, and after the last.
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
        self.trees[ray.slice].unlit_runs(ray.b, [first, end], |run, leaves| {
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
