//! The CPU side: rectify and build trees once a light, then traverse ray by ray.

use glam::DVec3;
use rayon::prelude::*;

use super::Params;
use crate::{
    camera::Ray,
    cpu::{CpuLight, CpuScene, RayIntegrator, Shade, stretches::integrate_lit},
    epipolar::{
        tree::MinMaxTree,
        view::{EpipolarView, InSlice},
    },
    light::LightModel,
};

/// Relative error of the quadrature of a lit stretch, where it has no closed form.
const TOLERANCE: f64 = 1e-3;

pub(crate) fn integrator<'a>(
    params: &'a Params,
    scene: &'a CpuScene<'a>,
) -> Box<dyn RayIntegrator + 'a> {
    let of_light = |light| EpipolarView::new(scene, light, &params.resolution).map(Forest::new);
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
    view: EpipolarView,
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
                    find_shades(ray, light, model, forest.as_ref(), span, &mut shades);
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
    forest: Option<&Forest>,
    span: [f64; 2],
    shades: &mut Vec<Shade>,
) {
    let Some(shadows) = &light.shadows else {
        return;
    };
    let place = forest.and_then(|f| Some((f, f.view.place(ray, light, model)?)));
    match place {
        Some((forest, place)) => {
            forest.shades(&place, shades);
            shadows.walk_tints(ray.origin, ray.direction, place.span, shades);
        }
        None => shadows.walk(ray.origin, ray.direction, span, shades),
    }
}

impl Forest {
    fn new(view: EpipolarView) -> Self {
        let rows = view.map.rows.par_iter();
        let trees = rows.map(|row| MinMaxTree::new(&row.angles)).collect();
        Self { view, trees }
    }

    /// Appends the stretches of a view ray that are in shadow.
    fn shades(&self, place: &InSlice, shades: &mut Vec<Shade>) {
        let row = &self.view.map.rows[place.slice];
        let frame = &self.view.frame;
        let [from, to] = place.span.map(|s| row.place(frame.gamma(place.beta, s)));
        let distance = |leaf: usize| {
            let s = frame.crossing(place.beta, row.gamma(leaf as f64));
            s.clamp(place.span[0], place.span[1])
        };
        let leaves = [from.floor() as usize, to.ceil() as usize];
        self.trees[place.slice].dark_runs(place.beta as f32, leaves, |[a, b]| {
            shades.push(Shade {
                start: distance(a),
                end: distance(b),
                tint: [0.0; 3],
            });
        });
    }
}
