//! The grid that a light's shadow map is rectified to: slices by light rays, over what a camera sees of them.
//!
//! ```text
//! camera        light   alpha (which slice)     gamma (which light ray)        b (which view ray)
//! perspective   sun     turn about the axis     distance from the axis [m]     angle to the axis
//! perspective   local   turn about the axis     angle at the light [rad]       angle to the axis
//! orthographic  sun     offset [m]              offset across the light [m]    offset along the light, sheared [m]
//! orthographic  local   turn about the axis     angle at the light [rad]       distance from the axis [m]
//! ```
//!
//! The axis runs through the eye, towards the sun or the local light; of an orthographic camera, whose eye is at
//! infinity, through a local light along the view. In every case `b` is the same all along a view ray, and a light ray
//! that ends has an S such that a point on it is lit iff b < S (Chen 2011, section 3.2). Angles b are measured on a
//! scale that grows with the angle and takes one division, [`angle_scale`].

use std::f64::consts::FRAC_PI_2;

use glam::DVec3;

use super::{
    resolution::{DEFAULT_SLICES, Resolution},
    slices::{SliceCount, Slices},
};
use crate::{
    camera::{CameraRays, Ray},
    light::LightSource,
    shadow::Face,
};

/// Sine of the angle to the axis below which view rays are not decomposed: nearer than a tenth of a radian few terms do
/// not hold exp(-sigma_t gamma / sin beta).
pub(crate) const SVD_LEAST_SINE: f64 = 0.1;

/// A slice's turn about the axis [rad] that the bounds of its cells still hold for.
const WIDEST_SLICE: f64 = 0.25;

/// Steps of b that nodes are stored in, and what is left at either end for "every" and "none".
const STEPS: f64 = 65533.0;

/// Farther than anything [m].
const FAR: f64 = 1e30;

/// A camera's slices of one light.
#[derive(Clone, Copy, Debug)]
pub(crate) struct EpipolarGrid {
    /// Orthographic and sun: the view's angle to the axis as a cotangent.
    pub(crate) cotangent: f64,
    pub(crate) orthographic: bool,
    /// Distance of a local light from the eye [m]; `None`: the sun.
    pub(crate) local: Option<f64>,
    /// Where view rays are measured from: the eye; orthographic and local: the light.
    pub(crate) origin: DVec3,
    #[cfg(feature = "gpu")]
    pub(crate) eye: DVec3,
    /// A local light's position; unused for the sun.
    pub(crate) light: DVec3,
    pub(crate) axis: DVec3,
    pub(crate) across: [DVec3; 2],
    pub(crate) slices: Slices,
    /// Light rays a slice, a power of two.
    pub(crate) samples: usize,
    pub(crate) gamma_start: f64,
    pub(crate) gamma_step: f64,
    pub(crate) b_start: f64,
    pub(crate) b_scale: f64,
    pub(crate) least_off_axis: f64,
    /// Range of gamma over which tints are summed.
    pub(crate) tint_range: [f64; 2],
    pub(crate) beta_range: [f64; 2],
    /// Of the view rays, from start to far plane [m].
    pub(crate) longest: f64,
}

/// What of the scene a grid covers.
pub(crate) struct GridScene<'a> {
    pub(crate) camera: &'a CameraRays,
    /// Width and height of the picture [pixels].
    pub(crate) size: [u32; 2],
    pub(crate) light: LightSource,
    /// The way a spot shines, and the angle of its cone [rad].
    pub(crate) cone: Option<(DVec3, f64)>,
    /// The light's shadow map; none: nothing casts shadows, and only tints need slices.
    pub(crate) faces: &'a [Face],
    /// Texels of the shadow map, or of one of its faces, a side.
    pub(crate) side: usize,
}

/// A view ray in its slice: what `EpipolarRay` of `epipolar.wgsl` is.
#[derive(Clone, Copy, Debug)]
pub(crate) struct GridRay {
    pub(crate) slice: usize,
    /// On the scale of the nodes.
    pub(crate) b: f64,
    /// Across the axis at distance s: `c[0] + s c[1]`.
    c: [f64; 2],
    /// From the light back along the axis at distance s: `t[0] - s t[1]`.
    t: [f64; 2],
}

/// Grows from 0 to 2 as the angle of (along, across) to the axis grows from 0 to pi.
pub(crate) fn angle_scale(across: f64, along: f64) -> f64 {
    let share = across / (across + along.abs()).max(1e-300);
    if along >= 0.0 { share } else { 2.0 - share }
}

impl GridRay {
    /// A perspective camera's view ray's angle to the axis [rad].
    pub(crate) fn beta(&self) -> f64 {
        self.c[1].atan2(self.t[1])
    }
}

impl EpipolarGrid {
    /// `None` where there are no slices, and every ray is to be walked: the eye is at the light, or the view runs along
    /// the sun.
    pub(crate) fn new(scene: &GridScene<'_>, resolution: &Resolution) -> Option<Self> {
        let camera = scene.camera;
        let orthographic = !camera.is_perspective();
        let (axis, across, local) = match scene.light {
            LightSource::Direction(way) if orthographic => {
                let axis = -DVec3::from(way);
                let outward = camera.forward.reject_from_normalized(axis);
                // Nearly along the sun a ray crosses next to no light rays.
                let u = (outward.length() > 1e-3).then(|| outward.normalize())?;
                (axis, [u, axis.cross(u)], None)
            }
            LightSource::Direction(way) => {
                let axis = -DVec3::from(way);
                (axis, axis.any_orthonormal_pair().into(), None)
            }
            LightSource::Position(position) => {
                let to_light = DVec3::from(position) - camera.eye;
                let axis = if orthographic {
                    camera.forward
                } else {
                    to_light.try_normalize()?
                };
                let distance = to_light.length();
                (axis, axis.any_orthonormal_pair().into(), Some(distance))
            }
        };
        let pixel = if orthographic {
            camera.pixel_side()
        } else {
            camera.pixel_angle().sin()
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
            longest: picture_grid(scene.size)
                .map(|(x, y)| camera.ray_to_far(x, y).length)
                .fold(0.0, f64::max),
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

    /// The same with b in rows of view rays, from 0 to `rows` over what the picture sees.
    #[cfg(feature = "gpu")]
    pub(crate) fn in_rows(mut self, scene: &GridScene<'_>, rows: u32) -> Self {
        let [low, high] = self.b_seen(scene);
        // The picture's corners and borders lie a row within.
        let step = (high - low).max(1e-6) / f64::from(rows - 2);
        (self.b_start, self.b_scale) = (low - step, 1.0 / step);
        self
    }

    /// The range of b of the picture's view rays.
    #[cfg(feature = "gpu")]
    fn b_seen(&self, scene: &GridScene<'_>) -> [f64; 2] {
        if self.orthographic {
            return self.b_range(scene);
        }
        let b = |(x, y)| {
            let direction = scene.camera.ray_to_far(x, y).direction;
            let across = self.across.map(|u| u.dot(direction));
            angle_scale(across[0].hypot(across[1]), direction.dot(self.axis))
        };
        let on_grid = picture_grid(scene.size).map(b);
        let [low, high] = on_grid.fold([f64::INFINITY, f64::NEG_INFINITY], |r, b| {
            [r[0].min(b), r[1].max(b)]
        });
        let sees = |end| scene.camera.sees(end, 1.0);
        [
            if sees(self.axis) { 0.0 } else { low },
            if sees(-self.axis) { 2.0 } else { high },
        ]
    }

    /// Distance of a local light from the eye [m]; `None`: the sun.
    pub(crate) fn distance(&self) -> Option<f64> {
        self.local
    }

    /// Range of gamma over which tints are summed and the integrand is decomposed.
    pub(crate) fn tint_range(&self) -> [f64; 2] {
        self.tint_range
    }

    /// Angles to the axis of a perspective camera's rays whose integrand is decomposed.
    pub(crate) fn beta_range(&self) -> [f64; 2] {
        self.beta_range
    }

    /// The farthest that light may come from a local light to a perspective camera's eye [m]: by way of the far plane.
    pub(crate) fn longest_path(&self) -> f64 {
        2.0 * self.longest + self.local.unwrap_or(0.0)
    }

    fn betas_seen(&self, scene: &GridScene<'_>) -> [f64; 2] {
        let camera = scene.camera;
        let least = self.least_off_axis.max(SVD_LEAST_SINE).asin();
        let mut range = [f64::INFINITY, f64::NEG_INFINITY];
        for (x, y) in picture_grid(scene.size) {
            let beta = camera.ray_to_far(x, y).direction.angle_between(self.axis);
            range = [range[0].min(beta), range[1].max(beta)];
        }
        if camera.sees(self.axis, 1.0) {
            range[0] = least;
        }
        if camera.sees(-self.axis, 1.0) {
            range[1] = std::f64::consts::PI - least;
        }
        [
            range[0].max(least),
            range[1].min(std::f64::consts::PI - least),
        ]
    }

    fn choose_slices(&self, scene: &GridScene<'_>, resolution: &Resolution) -> Slices {
        let camera = scene.camera;
        let alpha_at = |x, y| self.alpha(&camera.ray_to_far(x, y));
        let axis_in_picture = match (self.orthographic, self.local) {
            (false, _) => camera.sees(self.axis, 1.0) || camera.sees(-self.axis, 1.0),
            (true, Some(_)) => camera.sees_point(self.origin, 1.0),
            (true, None) => false,
        };
        let turns = !(self.orthographic && self.local.is_none());
        let count = match resolution.slices {
            0 => SliceCount::AtMost(DEFAULT_SLICES),
            n => SliceCount::Exactly(n as usize),
        };
        let slices = |count| Slices::over(alpha_at, turns, axis_in_picture, scene.size, count);
        let chosen = slices(count);
        let [_, step] = chosen.start_and_step();
        if turns && step > WIDEST_SLICE {
            let least = (chosen.count as f64 * step / WIDEST_SLICE).ceil();
            return slices(SliceCount::Exactly(least as usize));
        }
        chosen
    }

    fn alpha(&self, ray: &Ray) -> f64 {
        let [x, y] = match (self.orthographic, self.local) {
            (false, _) => self.across.map(|u| u.dot(ray.direction)),
            (true, _) => self.across.map(|u| u.dot(ray.origin - self.origin)),
        };
        if self.orthographic && self.local.is_none() {
            y
        } else {
            y.atan2(x)
        }
    }

    /// A view ray's place; `None` where it is too near to the axis.
    pub(crate) fn ray(&self, ray: &Ray) -> Option<GridRay> {
        let slice = self.slices.nearest(self.alpha(ray));
        let (b, off_axis, c, t) = match (self.orthographic, self.local) {
            (false, _) => {
                let [x, y] = self.across.map(|u| u.dot(ray.direction));
                let (sine, cosine) = (x.hypot(y), ray.direction.dot(self.axis));
                let t = [self.local.unwrap_or(0.0), cosine];
                (angle_scale(sine, cosine), sine, [0.0, sine], t)
            }
            (true, Some(_)) => {
                let from = ray.origin - self.origin;
                let [x, y] = self.across.map(|u| u.dot(from));
                let height = x.hypot(y);
                (height, height, [height, 0.0], [-from.dot(self.axis), 1.0])
            }
            (true, None) => {
                let from = ray.origin - self.origin;
                let gamma = from.dot(self.across[0]);
                let sine = ray.direction.dot(self.across[0]);
                let b = gamma * self.cotangent - from.dot(self.axis);
                (b, sine, [gamma, sine], [0.0; 2])
            }
        };
        (off_axis > self.least_off_axis).then_some(GridRay {
            slice,
            b: (b - self.b_start) * self.b_scale,
            c,
            t,
        })
    }

    /// gamma of the view ray's point at distance `s` [m].
    pub(crate) fn gamma_at(&self, ray: &GridRay, s: f64) -> f64 {
        let across = ray.c[0] + s * ray.c[1];
        match self.local {
            None => across,
            Some(_) => across.atan2(ray.t[0] - s * ray.t[1]),
        }
    }

    /// Place among the samples of the view ray's point at distance `s` [m].
    pub(crate) fn sample_at(&self, ray: &GridRay, s: f64) -> f64 {
        (self.gamma_at(ray, s) - self.gamma_start) / self.gamma_step
    }

    /// Distance [m] along the view ray where it crosses the border before a sample; infinite where they do not meet.
    pub(crate) fn crossing(&self, ray: &GridRay, sample: usize) -> f64 {
        self.crossing_at(ray, self.gamma(sample))
    }

    /// Distance [m] along the view ray where it crosses a light ray; infinite where they do not meet.
    pub(crate) fn crossing_at(&self, ray: &GridRay, gamma: f64) -> f64 {
        if self.local.is_none() {
            return (gamma - ray.c[0]) / ray.c[1];
        }
        let (sine, cosine) = gamma.sin_cos();
        let divisor = ray.c[1] * cosine + ray.t[1] * sine;
        if divisor > 1e-12 {
            (ray.t[0] * sine - ray.c[0] * cosine) / divisor
        } else {
            f64::INFINITY
        }
    }

    /// gamma at the border before a sample.
    pub(crate) fn gamma(&self, sample: usize) -> f64 {
        self.gamma_start + sample as f64 * self.gamma_step
    }

    /// True of a light with a position.
    pub(crate) fn is_local(&self) -> bool {
        self.local.is_some()
    }

    /// A light ray of a slice: a point on it, and the way it travels. Of the sun, the point where the slice's gamma is
    /// measured.
    pub(crate) fn light_ray(&self, alpha: f64, gamma: f64) -> (DVec3, DVec3) {
        if self.orthographic && self.local.is_none() {
            let [x, y] = self.across;
            return (self.origin + gamma * x + alpha * y, -self.axis);
        }
        let outward = alpha.cos() * self.across[0] + alpha.sin() * self.across[1];
        match self.local {
            None => (self.origin + gamma * outward, -self.axis),
            Some(_) => (self.light, gamma.sin() * outward - gamma.cos() * self.axis),
        }
    }

    /// The range of S, on the scale of the nodes, of all light rays between two gammas that end `ends[0]` to `ends[1]`
    /// [m] from their points (infinite: never): a point of view ray b is lit iff b < S.
    pub(crate) fn shadow_range(&self, gammas: [f64; 2], ends: [f64; 2]) -> [f64; 2] {
        let least = |end| {
            gammas
                .map(|g| self.shadow(g, end))
                .into_iter()
                .fold(f64::INFINITY, f64::min)
        };
        let greatest = match self.local {
            // Extremes of an angle over a box of (gamma, -end), or of a linear function, are at its corners.
            None => gammas
                .map(|g| self.shadow(g, ends[1]))
                .into_iter()
                .fold(f64::NEG_INFINITY, f64::max),
            // S grows with the end. Along gamma it has one hump, where the light ray's end is seen farthest from the axis.
            Some(distance) => {
                let hump = if self.orthographic {
                    FRAC_PI_2
                } else {
                    (ends[1] / distance).min(1.0).acos()
                };
                self.shadow(hump.clamp(gammas[0], gammas[1]), ends[1])
            }
        };
        [least(ends[0]), greatest].map(|s| (s - self.b_start) * self.b_scale)
    }

    /// S of the light ray `gamma` that ends `end` [m] from its point.
    fn shadow(&self, gamma: f64, end: f64) -> f64 {
        // Of an infinite end as of a far one, so that nothing is infinite times nothing.
        let end = end.min(FAR);
        let (sine, cosine) = gamma.sin_cos();
        match (self.orthographic, self.local) {
            (true, None) => gamma * self.cotangent + end,
            (true, Some(_)) => end * sine,
            (false, None) => angle_scale(gamma, -end),
            (false, Some(distance)) => angle_scale(end * sine, distance - end * cosine),
        }
    }

    /// The range of gamma that the picture's rays and the light's map may have in common. What a ray meets beyond it
    /// is walked, so that it need not be exact.
    fn gamma_range(&self, scene: &GridScene<'_>) -> [f64; 2] {
        let seen = self.gammas_seen(scene);
        let covered = match self.local {
            Some(_) => self.gammas_in_cone(scene.cone),
            None => scene
                .faces
                .first()
                .map_or(seen, |face| self.gammas_of_map(face)),
        };
        [seen[0].max(covered[0]), seen[1].min(covered[1])]
    }

    /// Over a grid of rays from their start to the far plane.
    fn gammas_seen(&self, scene: &GridScene<'_>) -> [f64; 2] {
        let mut range = [f64::INFINITY, f64::NEG_INFINITY];
        for (x, y) in picture_grid(scene.size) {
            let ray = scene.camera.ray_to_far(x, y);
            if let Some(place) = self.ray(&ray) {
                for s in [0.0, ray.length] {
                    let gamma = self.gamma_at(&place, s);
                    range = [range[0].min(gamma), range[1].max(gamma)];
                }
            }
        }
        range
    }

    /// Angles at the light between the axis and the cone's rays.
    fn gammas_in_cone(&self, cone: Option<(DVec3, f64)>) -> [f64; 2] {
        let Some((way, outer)) = cone else {
            return [0.0, std::f64::consts::PI];
        };
        let middle = (-self.axis).angle_between(way);
        [
            (middle - outer).max(0.0),
            (middle + outer).min(std::f64::consts::PI),
        ]
    }

    /// Offsets of the sun's rays that the map covers.
    fn gammas_of_map(&self, face: &Face) -> [f64; 2] {
        let world_from_clip = face.clip_from_world.inverse();
        let corner = |x: f64, y: f64| {
            let p = world_from_clip * glam::DVec4::new(x, y, 0.5, 1.0);
            let from = p.truncate() / p.w - self.origin;
            self.across.map(|u| u.dot(from))
        };
        let corners = [
            corner(-1.0, -1.0),
            corner(1.0, -1.0),
            corner(1.0, 1.0),
            corner(-1.0, 1.0),
        ];
        let over = |values: [f64; 4]| {
            [
                values.into_iter().fold(f64::INFINITY, f64::min),
                values.into_iter().fold(f64::NEG_INFINITY, f64::max),
            ]
        };
        if self.orthographic {
            return over(corners.map(|c| c[0]));
        }
        let farthest = over(corners.map(|[x, y]| x.hypot(y)))[1];
        [distance_to_quad(corners), farthest]
    }

    fn b_range(&self, scene: &GridScene<'_>) -> [f64; 2] {
        if !self.orthographic {
            return [0.0, 2.0];
        }
        // Of a ray it is linear in the picture's place, or convex with its least value on the axis.
        let [width, height] = scene.size.map(f64::from);
        let mut range = match self.local {
            Some(_) => [0.0, 0.0],
            None => [f64::INFINITY, f64::NEG_INFINITY],
        };
        for (x, y) in [(0.0, 0.0), (width, 0.0), (0.0, height), (width, height)] {
            let from = scene.camera.ray_to_far(x, y).origin - self.origin;
            let [across, other] = self.across.map(|u| u.dot(from));
            let b = match self.local {
                Some(_) => across.hypot(other),
                None => across * self.cotangent - from.dot(self.axis),
            };
            range = [range[0].min(b), range[1].max(b)];
        }
        range
    }
}

/// Points of a picture [pixels], from border to border.
fn picture_grid([width, height]: [u32; 2]) -> impl Iterator<Item = (f64, f64)> {
    const GRID: u32 = 16;
    let place = |n: u32, size: u32| f64::from(n * size) / f64::from(GRID);
    (0..(GRID + 1).pow(2))
        .map(move |i| (place(i % (GRID + 1), width), place(i / (GRID + 1), height)))
}

/// Distance of the origin from a convex quadrilateral, zero inside.
fn distance_to_quad(corners: [[f64; 2]; 4]) -> f64 {
    use glam::DVec2;
    let corners = corners.map(DVec2::from);
    let edges = || (0..4).map(|i| (corners[i], corners[(i + 1) % 4]));
    let side = |(a, b): (DVec2, DVec2)| (b - a).perp_dot(-a);
    if edges().all(|e| side(e) >= 0.0) || edges().all(|e| side(e) <= 0.0) {
        return 0.0;
    }
    let to_edge = |(a, b): (DVec2, DVec2)| {
        let along = (-a).dot(b - a) / (b - a).length_squared().max(f64::MIN_POSITIVE);
        (a + along.clamp(0.0, 1.0) * (b - a)).length()
    };
    edges().map(to_edge).fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests;
