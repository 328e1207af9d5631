//! The radius by which a light with a position is softened, so that it stays finite at the light's own place.
//!
//! At a point `x` from a light of radius r, light arrives as if from the distance `hypot(|x|, r)` (Plummer 1911): as
//! `1 / (|x|^2 + r^2)`, dimmed over that distance, and in the mean direction `x / hypot(|x|, r)`, which is shorter than 1, for from
//! within a ball of light it comes from all sides. Along a view ray that passes at `h` this is a point light that is
//! passed at `hypot(h, r)`, so that all closed forms, tables and spacings of points hold as they are.

use glam::DVec3;

use crate::{
    frame::{Camera, Emitter, Projection},
    physics::{medium::Optics, reals},
};

/// The least radius of a point or a spot, relative to the distance of the near plane (orthographic: to half the image's height).
const LEAST_OF_NEAR: f64 = 1e-3;
/// The same, relative to its distance from the eye: f32 does not place rays and lamps better.
const LEAST_OF_DISTANCE: f64 = 1e-6;

/// The radius that a camera sees a light with \[m]: a lamp's own, but no less than what f32 can tell from zero; of a rectangle
/// that of the patch that a sample stands for; 0 of the sun.
pub fn light_radius(emitter: &Emitter, camera: &Camera) -> f64 {
    match *emitter {
        Emitter::Directional { .. } => 0.0,
        Emitter::Point {
            position, radius, ..
        }
        | Emitter::Spot {
            position, radius, ..
        } => f64::from(radius).max(least_radius(camera, reals(position))),
        Emitter::Rect {
            edge_x,
            edge_y,
            samples,
            ..
        } => patch_radius(reals(edge_x).cross(reals(edge_y)).length(), samples),
    }
}

fn least_radius(camera: &Camera, position: DVec3) -> f64 {
    let nearest = match camera.projection {
        Projection::Perspective { near, .. } => near,
        Projection::Orthographic { half_extent, .. } => half_extent[1],
    };
    let distance = position.distance(reals(camera.eye));
    (LEAST_OF_NEAR * f64::from(nearest)).max(LEAST_OF_DISTANCE * distance)
}

/// `exp(-sigma_t (s + d)) sigma_s rho` times how much the radius takes from `1 / d^2`: with `ds / d^2 = d gamma / h` and h the distance
/// from the ray, what is integrated over the light ray's angle. For the point of a view ray at distance `s` \[m] that lies `away` \[m]
/// from the light; `cos_theta` is that of the scattering angle.
pub(crate) fn softened_kernel(
    optics: &Optics,
    [s, away]: [f64; 2],
    radius: f64,
    cos_theta: f64,
) -> DVec3 {
    let distance = away.hypot(radius);
    let share = away / distance;
    optics.transmittance(s + distance) * optics.scattering(cos_theta * share) * (share * share)
}

/// The radius of each of so many samples of a rectangle of this area [m^2] \[m]: the side of the patch that a sample stands for.
///
/// A sample's solid angle is that of its patch times `z / D^3 + 3 k^2 (k - z) / D^5`, with z the point's height over the
/// rectangle, `D = hypot(d, r)` and `k = hypot(z, r)` ([`patch_cosine`](super::patch_cosine) over `D^2`). Over a whole plane that is 2 pi at
/// any height, as it should be, so that samples add up to a plane right at it; it falls off beside a patch like `d^-5`, and far
/// away it is `z / d^3` up to the fourth order in r / d. Measured on the glow at a panel against its solid angle, relative MAE
/// at 256 samples: 0.007 to 0.017, of bare samples 0.02 to 0.06; with radii of 0.7 or 1.4 sides up to 0.023 and 0.025.
pub fn patch_radius(area: f64, samples: u32) -> f64 {
    (area / f64::from(samples)).sqrt()
}
