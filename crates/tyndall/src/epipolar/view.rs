//! A picture's view rays in the epipolar coordinates of one light.

use rayon::prelude::*;

use super::{
    EpipolarFrame,
    slices::{SliceCount, Slices},
};
use crate::{
    camera::Ray,
    cpu::{CpuLight, CpuScene},
    light::LightModel,
};

/// The slices of a picture, and what its rays see of each.
pub(crate) struct EpipolarView {
    pub(crate) frame: EpipolarFrame,
    pub(crate) slices: Slices,
    /// The range of gamma that each slice's rays see of the shadow map; empty where start > end.
    pub(crate) ranges: Vec<[f64; 2]>,
    /// Smallest sine of beta whose ray is taken to a slice.
    least_sine: f64,
}

/// A view ray in a slice.
#[derive(Clone, Copy, Debug)]
pub(crate) struct InSlice {
    pub(crate) slice: usize,
    pub(crate) beta: f64,
    /// The part of the ray that the light reaches and the map covers [m].
    pub(crate) span: [f64; 2],
}

impl EpipolarView {
    /// `None` where there are no slices: the eye is at the light, the camera is orthographic, or nothing casts shadows.
    /// `epipole_radius` is in pixels.
    pub(crate) fn new(
        scene: &CpuScene<'_>,
        light: &CpuLight<'_>,
        model: &LightModel<'_>,
        count: SliceCount,
        epipole_radius: f64,
    ) -> Option<Self> {
        let (camera, size) = (&scene.camera, scene.size);
        if !camera.is_perspective() || light.shadows.is_none() {
            return None;
        }
        let frame = EpipolarFrame::new(camera.eye, model.source())?;
        let slices = Slices::new(&frame, camera, size, count);
        let mut view = Self {
            frame,
            ranges: vec![NOTHING; slices.count],
            slices,
            least_sine: (epipole_radius * camera.pixel_angle()).sin(),
        };
        let row = |y: u32| {
            let mut ranges = vec![NOTHING; slices.count];
            for x in 0..size[0] {
                let ray = camera.ray(x, y, scene.depth[(y * size[0] + x) as usize]);
                if let Some(ray) = view.place(&ray, light, model) {
                    let range = &mut ranges[ray.slice];
                    let ends = ray.span.map(|s| view.frame.gamma(ray.beta, s));
                    *range = union(*range, ends);
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
        let none = || vec![NOTHING; slices.count];
        view.ranges = (0..size[1]).into_par_iter().map(row).reduce(none, unite);
        Some(view)
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
