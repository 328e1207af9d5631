//! An image's view rays in the epipolar coordinates of one light.

use rayon::prelude::*;

use super::rectified::Rectified;
use crate::{
    camera::Ray,
    epipolar::{
        EpipolarFrame, Resolution,
        slices::{SliceCount, Slices},
    },
    integrate::{CpuLight, CpuScene},
    light::LightModel,
};

/// The slices of an image, and what its rays see of each.
pub(crate) struct EpipolarView {
    pub(crate) frame: EpipolarFrame,
    slices: Slices,
    pub(crate) map: Rectified,
    /// Smallest sine of beta whose ray is taken to a slice.
    least_sine: f64,
}

/// A view ray in a slice.
#[derive(Clone, Copy, Debug)]
pub(crate) struct InSlice {
    pub(crate) slice: usize,
    pub(crate) beta: f64,
    /// The part of the ray that the light reaches and the map covers \[m].
    pub(crate) span: [f64; 2],
}

impl EpipolarView {
    /// `None` where there are no slices: the eye is at the light, the camera is orthographic, or nothing casts shadows.
    pub(crate) fn new(
        scene: &CpuScene<'_>,
        light: &CpuLight<'_>,
        resolution: &Resolution,
    ) -> Option<Self> {
        let (camera, size) = (&scene.camera, scene.size);
        let (model, shadows) = (light.models.first()?, light.shadows.as_ref()?);
        if !camera.is_perspective() {
            return None;
        }
        let frame = EpipolarFrame::new(camera.eye, model.source())?;
        let side = shadows.side() as usize;
        let chosen = |n: u32| (n > 0).then_some(n as usize);
        let count =
            chosen(resolution.slices).map_or(SliceCount::AtLeast(side), SliceCount::Exactly);
        let slices = Slices::new(&frame, camera, size, count);
        let mut view = Self {
            frame,
            slices,
            map: Rectified { rows: Vec::new() },
            least_sine: (resolution.epipole_radius * camera.pixel_angle()).sin(),
        };
        let ranges = view.ranges(scene, light, model);
        let samples = chosen(resolution.samples).unwrap_or(side);
        view.map = Rectified::new(&frame, &slices, &ranges, samples, shadows);
        Some(view)
    }

    /// The range of gamma that each slice's rays see of the shadow map; empty where start > end.
    fn ranges(
        &self,
        scene: &CpuScene<'_>,
        light: &CpuLight<'_>,
        model: &LightModel<'_>,
    ) -> Vec<[f64; 2]> {
        let none = || vec![NOTHING; self.slices.count];
        let row = |y: u32| {
            let mut ranges = none();
            for x in 0..scene.size[0] {
                let ray = scene.ray(x, y);
                if let Some(place) = self.place(&ray, light, model) {
                    let ends = place.span.map(|s| self.frame.gamma(place.beta, s));
                    ranges[place.slice] = union(ranges[place.slice], ends);
                }
            }
            ranges
        };
        let unite = |mut a: Vec<[f64; 2]>, b: Vec<[f64; 2]>| {
            for (a, b) in a.iter_mut().zip(b) {
                *a = union(*a, b);
            }
            a
        };
        (0..scene.size[1])
            .into_par_iter()
            .map(row)
            .reduce(none, unite)
    }

    /// The ray's place; `None` where it is too near to the axis or sees nothing of the map.
    pub(crate) fn place(
        &self,
        ray: &Ray,
        light: &CpuLight<'_>,
        model: &LightModel<'_>,
    ) -> Option<InSlice> {
        let (alpha, beta) = self.frame.view_ray(ray.direction);
        let reach = model.reach(ray.origin, ray.direction, [0.0, ray.length]);
        let span = light
            .shadows
            .as_ref()?
            .covered(ray.origin, ray.direction, reach);
        (span[0] < span[1] && beta.sin() > self.least_sine).then(|| InSlice {
            slice: self.slices.nearest(alpha),
            beta,
            span,
        })
    }
}

const NOTHING: [f64; 2] = [f64::INFINITY, f64::NEG_INFINITY];

fn union([a, b]: [f64; 2], [c, d]: [f64; 2]) -> [f64; 2] {
    [a.min(c), b.max(d)]
}
