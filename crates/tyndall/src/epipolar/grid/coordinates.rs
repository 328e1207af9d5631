//! The grid of one camera and one light, and the coordinates of rays on it.

use std::f64::consts::FRAC_PI_2;

use glam::DVec3;

use crate::{camera::Ray, epipolar::slices::Slices};

/// Farther than anything \[m].
const FAR: f64 = 1e30;

/// A camera's slices of one light.
#[derive(Clone, Copy, Debug)]
pub(crate) struct EpipolarGrid {
    /// Orthographic and sun: the view's angle to the axis as a cotangent.
    pub(crate) cotangent: f64,
    pub(crate) orthographic: bool,
    /// Distance of a local light from the eye \[m]; `None`: the sun.
    pub(crate) local: Option<f64>,
    /// Point that view rays are measured from: the eye; orthographic and local: the light.
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
    /// Length of the longest view ray, from start to far plane \[m].
    pub(crate) longest: f64,
}

/// A view ray in its slice: the twin of `EpipolarRay` in `epipolar.wesl`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct GridRay {
    pub(crate) slice: usize,
    /// On the scale of the nodes.
    pub(crate) b: f64,
    /// Across the axis at distance s: `c[0] + s c[1]`.
    pub(super) c: [f64; 2],
    /// From the light back along the axis at distance s: `t[0] - s t[1]`.
    pub(super) t: [f64; 2],
}

/// Grows from 0 to 2 as the angle of (along, across) to the axis grows from 0 to pi.
pub(crate) fn angle_scale(across: f64, along: f64) -> f64 {
    let share = across / (across + along.abs()).max(1e-300);
    if along >= 0.0 { share } else { 2.0 - share }
}

impl GridRay {
    /// A perspective camera's view ray's angle to the axis \[rad].
    pub(crate) fn beta(&self) -> f64 {
        self.c[1].atan2(self.t[1])
    }
}

impl EpipolarGrid {
    /// Distance of a local light from the eye \[m]; `None`: the sun.
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

    /// The farthest that light may come from a local light to a perspective camera's eye \[m]: over the far plane.
    pub(crate) fn longest_path(&self) -> f64 {
        2.0 * self.longest + self.local.unwrap_or(0.0)
    }

    pub(super) fn alpha(&self, ray: &Ray) -> f64 {
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

    /// A view ray's place; `None` if it is too near to the axis.
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

    /// gamma of the view ray's point at distance `s` \[m].
    pub(crate) fn gamma_at(&self, ray: &GridRay, s: f64) -> f64 {
        let across = ray.c[0] + s * ray.c[1];
        match self.local {
            None => across,
            Some(_) => across.atan2(ray.t[0] - s * ray.t[1]),
        }
    }

    /// Place among the samples of the view ray's point at distance `s` \[m].
    pub(crate) fn sample_at(&self, ray: &GridRay, s: f64) -> f64 {
        (self.gamma_at(ray, s) - self.gamma_start) / self.gamma_step
    }

    /// Distance \[m] along the view ray where it crosses the border before a sample; infinite where they do not meet.
    pub(crate) fn crossing(&self, ray: &GridRay, sample: usize) -> f64 {
        self.crossing_at(ray, self.gamma(sample))
    }

    /// Distance \[m] along the view ray where it crosses a light ray; infinite where they do not meet.
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

    /// A light ray of a slice: a point on it, and the direction in which it travels. For the sun, the point where the slice's gamma is
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
    /// \[m] from their points (infinite: never): a point of view ray b is lit iff b < S.
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

    /// S of the light ray `gamma` that ends `end` \[m] from its point.
    fn shadow(&self, gamma: f64, end: f64) -> f64 {
        // An infinite end counts as a far one, so that nothing is infinite times nothing.
        let end = end.min(FAR);
        let (sine, cosine) = gamma.sin_cos();
        match (self.orthographic, self.local) {
            (true, None) => gamma * self.cotangent + end,
            (true, Some(_)) => end * sine,
            (false, None) => angle_scale(gamma, -end),
            (false, Some(distance)) => angle_scale(end * sine, distance - end * cosine),
        }
    }
}
