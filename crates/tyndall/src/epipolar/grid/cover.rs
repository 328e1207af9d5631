//! A grid over what a camera sees of a light.

use glam::DVec3;

use super::{
    coordinates::EpipolarGrid,
    ranges::{GridScene, image_grid},
};
use crate::{
    epipolar::{
        resolution::{DEFAULT_SLICES, Resolution},
        slices::{SliceCount, Slices},
    },
    light::LightSource,
};

/// A slice's turn about the axis \[rad] that the bounds of its cells still hold for.
const WIDEST_SLICE: f64 = 0.25;

/// Distance of a local light from a perspective camera's eye, relative to its longest ray, below which view rays run so nearly along
/// light rays that f32 does not tell where they cross them.
const LEAST_DISTANCE: f64 = 1e-4;

/// Steps of b that nodes are stored in, and what is left at either end for "every" and "none".
const STEPS: f64 = 65533.0;

impl EpipolarGrid {
    /// `None` where there are no slices, and every ray is to be walked: the eye is next to the light, or the view
    /// runs along the sun.
    pub(crate) fn new(scene: &GridScene<'_>, resolution: &Resolution) -> Option<Self> {
        let camera = scene.camera;
        let orthographic = !camera.is_perspective();
        let longest = image_grid(scene.size)
            .map(|(x, y)| camera.ray_to_far(x, y).length)
            .fold(0.0, f64::max);
        let (axis, across, local) = match scene.light {
            LightSource::Direction(direction) if orthographic => {
                let axis = -DVec3::from(direction);
                let outward = camera.forward.reject_from_normalized(axis);
                // Nearly along the sun a ray crosses next to no light rays.
                let u = (outward.length() > 1e-3).then(|| outward.normalize())?;
                (axis, [u, axis.cross(u)], None)
            }
            LightSource::Direction(direction) => {
                let axis = -DVec3::from(direction);
                (axis, axis.any_orthonormal_pair().into(), None)
            }
            LightSource::Position(position) => {
                let to_light = DVec3::from(position) - camera.eye;
                let distance = to_light.length();
                let axis = if orthographic {
                    camera.forward
                } else if distance > LEAST_DISTANCE * longest {
                    to_light / distance
                } else {
                    return None;
                };
                (axis, axis.any_orthonormal_pair().into(), Some(distance))
            }
        };
        // In the unit of `off_axis`. To the sun all orthographic rays have one angle, wide enough where there is a grid.
        let pixel = match local {
            _ if !orthographic => camera.pixel_angle().sin(),
            Some(_) => camera.pixel_side(),
            None => 0.0,
        };
        let light = match scene.light {
            LightSource::Position(position) => position.into(),
            LightSource::Direction(_) => DVec3::ZERO,
        };
        let mut grid = Self {
            cotangent: camera.forward.dot(axis) / camera.forward.dot(across[0]),
            orthographic,
            local,
            origin: if orthographic && local.is_some() {
                light
            } else {
                camera.eye
            },
            #[cfg(feature = "gpu")]
            eye: camera.eye,
            light,
            axis,
            across,
            slices: Slices::over(|x, _| x, false, false, scene.size, SliceCount::Exactly(1)),
            samples: resolution.samples_of(scene.side),
            gamma_start: 0.0,
            gamma_step: 0.0,
            b_start: 0.0,
            b_scale: 1.0,
            least_off_axis: resolution.epipole_radius * pixel,
            tint_range: [0.0, 1.0],
            beta_range: [0.0, 1.0],
            longest,
        };
        grid.slices = grid.choose_slices(scene, resolution);
        let seen = match local {
            Some(_) => grid.gammas_in_cone(scene.cone),
            None => grid.gammas_seen(scene),
        };
        grid.tint_range = seen;
        if !orthographic {
            grid.beta_range = grid.betas_seen(scene);
        }
        let [start, end] = grid.gamma_range(scene);
        grid.gamma_start = start;
        grid.gamma_step = (end - start) / grid.samples as f64;
        let [low, high] = grid.b_range(scene);
        grid.b_scale = STEPS / (high - low);
        grid.b_start = low - 1.0 / grid.b_scale;
        (end > start && high > low).then_some(grid)
    }

    /// The grid with b in rows of view rays, from 0 to `rows` over what the image sees.
    #[cfg(feature = "gpu")]
    pub(crate) fn in_rows(mut self, scene: &GridScene<'_>, rows: u32) -> Self {
        let [low, high] = self.b_seen(scene);
        // The image's corners and borders lie a row within.
        let step = (high - low).max(1e-6 * high.abs().max(low.abs())) / f64::from(rows - 2);
        (self.b_start, self.b_scale) = (low - step, 1.0 / step);
        self
    }

    fn choose_slices(&self, scene: &GridScene<'_>, resolution: &Resolution) -> Slices {
        let camera = scene.camera;
        let alpha_at = |x, y| self.alpha(&camera.ray_to_far(x, y));
        let axis_in_image = match (self.orthographic, self.local) {
            (false, _) => camera.sees(self.axis, 1.0) || camera.sees(-self.axis, 1.0),
            (true, Some(_)) => camera.sees_point(self.origin, 1.0),
            (true, None) => false,
        };
        let turns = !(self.orthographic && self.local.is_none());
        let count = match resolution.slices {
            0 => SliceCount::AtMost(DEFAULT_SLICES),
            n => SliceCount::Exactly(n as usize),
        };
        let slices = |count| Slices::over(alpha_at, turns, axis_in_image, scene.size, count);
        let chosen = slices(count);
        let [_, step] = chosen.start_and_step();
        if turns && step > WIDEST_SLICE {
            let least = (chosen.count as f64 * step / WIDEST_SLICE).ceil();
            return slices(SliceCount::Exactly(least as usize));
        }
        chosen
    }
}
