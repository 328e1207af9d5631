//! The slices that a camera sees: enough of them that no view ray is farther than half a pixel from one.

use std::f64::consts::{PI, TAU};

use super::coordinates::EpipolarFrame;
use crate::camera::CameraRays;

/// The most slices by the half-pixel rule: at very wide angles the rule is given up before memory is.
const MAX_SLICES: usize = 1 << 14;

/// Rules for the number of slices of an image.
#[derive(Clone, Copy, Debug)]
pub(crate) enum SliceCount {
    /// So many.
    Exactly(usize),
    /// By the half-pixel rule, but at least so many.
    AtLeast(usize),
    /// By the half-pixel rule, but at most so many.
    AtMost(usize),
}

/// Evenly spaced slices over the visible range of alpha.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Slices {
    first: f64,
    step: f64,
    /// Number of slices.
    pub(crate) count: usize,
    /// True where alpha is an angle.
    turns: bool,
}

impl Slices {
    /// For a perspective camera of this image.
    pub(crate) fn new(
        frame: &EpipolarFrame,
        camera: &CameraRays,
        size: [u32; 2],
        count: SliceCount,
    ) -> Self {
        let alpha_at = |x: f64, y: f64| frame.view_ray(camera.direction(x, y)).0;
        let axis_in_image = [frame.axis(), -frame.axis()]
            .iter()
            .any(|end| camera.sees(*end, 1.0));
        Self::over(alpha_at, true, axis_in_image, size, count)
    }

    /// For an image whose pixel (x, y) has this alpha; `turns` where alpha is an angle about an axis.
    pub(crate) fn over(
        alpha_at: impl Fn(f64, f64) -> f64,
        turns: bool,
        axis_in_image: bool,
        size: [u32; 2],
        count: SliceCount,
    ) -> Self {
        let [width, height] = size.map(f64::from);
        let difference = |a: f64, b: f64| if turns { turn(a - b) } else { a - b };
        let [first, range] = if axis_in_image {
            [0.0, TAU]
        } else {
            // The image is a convex cone that misses the axis: less than half a turn about its middle.
            let middle = alpha_at(0.5 * width, 0.5 * height);
            let corners = [[0.0, 0.0], [width, 0.0], [0.0, height], [width, height]];
            let offsets = corners.map(|[x, y]| difference(alpha_at(x, y), middle));
            let low = offsets.iter().copied().fold(f64::INFINITY, f64::min);
            let high = offsets.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            [middle + low, high - low]
        };
        let half_pixel = || (range / smallest_step(&alpha_at, difference, size)).ceil() as usize;
        let count = match count {
            SliceCount::Exactly(count) => count,
            SliceCount::AtLeast(least) => half_pixel().max(least).clamp(1, MAX_SLICES),
            SliceCount::AtMost(most) => half_pixel().clamp(1, most),
        };
        Self {
            first: first + 0.5 * range / count as f64,
            step: range / count as f64,
            count,
            turns,
        }
    }

    /// alpha where the first slice begins, and the width of a slice.
    pub(crate) fn start_and_step(&self) -> [f64; 2] {
        [self.first - 0.5 * self.step, self.step]
    }

    /// True where the last slice is a neighbour of the first.
    #[cfg(feature = "gpu")]
    pub(crate) fn is_full_turn(&self) -> bool {
        self.turns && (self.step * self.count as f64 - TAU).abs() < 1e-9
    }

    /// True where alpha is an angle about an axis.
    #[cfg(test)]
    pub(crate) fn turns(&self) -> bool {
        self.turns
    }

    /// alpha of a slice.
    pub(crate) fn alpha(&self, slice: usize) -> f64 {
        self.first + slice as f64 * self.step
    }

    /// The slice nearest to a view ray's alpha.
    pub(crate) fn nearest(&self, alpha: f64) -> usize {
        let from_middle = alpha - self.first - 0.5 * self.step * (self.count - 1) as f64;
        let from_first = if self.turns {
            turn(from_middle)
        } else {
            from_middle
        };
        let index = from_first / self.step + 0.5 * (self.count - 1) as f64;
        index.round().clamp(0.0, (self.count - 1) as f64) as usize
    }
}

/// An angle brought into [-pi, pi].
fn turn(angle: f64) -> f64 {
    (angle + PI).rem_euclid(TAU) - PI
}

/// The smallest change of alpha over one pixel across the slices, over a grid of the image's points.
fn smallest_step(
    alpha_at: impl Fn(f64, f64) -> f64,
    difference: impl Fn(f64, f64) -> f64,
    size: [u32; 2],
) -> f64 {
    const GRID: u32 = 16;
    let [width, height] = size.map(f64::from);
    let mut smallest = f64::INFINITY;
    for i in 0..=GRID {
        for j in 0..=GRID {
            let x = width * f64::from(i) / f64::from(GRID);
            let y = height * f64::from(j) / f64::from(GRID);
            let here = alpha_at(x, y);
            let dx = difference(alpha_at(x + 0.5, y), here) * 2.0;
            let dy = difference(alpha_at(x, y + 0.5), here) * 2.0;
            let step = dx.hypot(dy);
            if step > 1e-9 {
                smallest = smallest.min(step);
            }
        }
    }
    if smallest.is_finite() { smallest } else { TAU }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{frame::Camera, light::LightSource};
    use glam::{DVec2, DVec3};
    use tyndall_testkit::samples::in_box;

    /// Over random cameras and lights: every pixel's ray, turned into its nearest slice, moves by half a pixel at most.
    #[test]
    fn every_pixel_lies_within_half_a_pixel_of_a_slice() {
        let size = [64, 48];
        let mut worst = 0.0_f64;
        for (i, x) in in_box(5, 2500, [const { -1.0..=1.0 }; 9])
            .iter()
            .enumerate()
        {
            let [_, _, _, tx, ty, tz, lx, ly, lz] = *x;
            if tx.abs() + tz.abs() < 1e-3 || lx.abs() + ly.abs() + lz.abs() < 1e-3 {
                continue;
            }
            let yfov = 0.3 + 0.6 * (x[0] + 1.0);
            let camera = Camera::perspective(
                [0.0; 3],
                [tx, ty, tz],
                [0.0, 1.0, 0.0],
                yfov,
                4.0 / 3.0,
                0.1,
                9.0,
            );
            let rays = CameraRays::new(&camera, size);
            let light = DVec3::new(lx.into(), ly.into(), lz.into());
            let source = if i % 2 == 0 {
                LightSource::Position((5.0 * light).to_array())
            } else {
                LightSource::Direction(light.normalize().to_array())
            };
            let frame =
                EpipolarFrame::new(DVec3::ZERO, source).expect("the eye is not at the light");
            let slices = Slices::new(&frame, &rays, size, SliceCount::AtLeast(1));
            for (px, py) in (0..size[0]).flat_map(|px| (0..size[1]).map(move |py| (px, py))) {
                let here = DVec2::new(f64::from(px) + 0.5, f64::from(py) + 0.5);
                let (alpha, beta) = frame.view_ray(rays.direction(here.x, here.y));
                let alpha = slices.alpha(slices.nearest(alpha));
                let on_slice = |beta| rays.pixel(frame.view_direction(alpha, beta));
                let (Some(p), Some(q)) = (on_slice(beta), on_slice(beta + 1e-4)) else {
                    continue;
                };
                let distance = (q - p).normalize().perp_dot(here - p).abs();
                worst = worst.max(distance);
                // The rule looks at a grid of points: measured 0.5003.
                assert!(
                    distance < 0.51,
                    "{x:?} pixel {here}: {distance} with {} slices",
                    slices.count
                );
            }
        }
        assert!(worst > 0.45, "half a pixel is needed: {worst}");
    }
}
