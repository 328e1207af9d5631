//! Ranges of the coordinates that an image sees and a light covers.

use glam::DVec3;

use super::coordinates::EpipolarGrid;
#[cfg(feature = "gpu")]
use super::coordinates::angle_scale;
use crate::{camera::CameraRays, light::LightSource, shadow::Face};

/// Sine of the angle to the axis below which view rays are not decomposed: nearer than a tenth of a radian few terms do
/// not hold exp(-sigma_t gamma / sin beta).
pub(crate) const SVD_LEAST_SINE: f64 = 0.1;

/// The part of a scene that a grid covers.
pub(crate) struct GridScene<'a> {
    pub(crate) camera: &'a CameraRays,
    /// Width and height of the image \[pixels].
    pub(crate) size: [u32; 2],
    pub(crate) light: LightSource,
    /// The direction in which a spot shines, and the angle of its cone \[rad].
    pub(crate) cone: Option<(DVec3, f64)>,
    /// The light's shadow map; none: nothing casts shadows, and only tints need slices.
    pub(crate) faces: &'a [Face],
    /// Texels of the shadow map, or of one of its faces, a side.
    pub(crate) side: usize,
}

impl EpipolarGrid {
    /// The range of b of the image's view rays.
    #[cfg(feature = "gpu")]
    pub(super) fn b_seen(&self, scene: &GridScene<'_>) -> [f64; 2] {
        if self.orthographic {
            return self.b_range(scene);
        }
        let b = |(x, y)| {
            let direction = scene.camera.ray_to_far(x, y).direction;
            let across = self.across.map(|u| u.dot(direction));
            angle_scale(across[0].hypot(across[1]), direction.dot(self.axis))
        };
        let on_grid = image_grid(scene.size).map(b);
        let [low, high] = on_grid.fold([f64::INFINITY, f64::NEG_INFINITY], |r, b| {
            [r[0].min(b), r[1].max(b)]
        });
        let sees = |end| scene.camera.sees(end, 1.0);
        [
            if sees(self.axis) { 0.0 } else { low },
            if sees(-self.axis) { 2.0 } else { high },
        ]
    }

    pub(super) fn betas_seen(&self, scene: &GridScene<'_>) -> [f64; 2] {
        let camera = scene.camera;
        let least = self.least_off_axis.max(SVD_LEAST_SINE).asin();
        let mut range = [f64::INFINITY, f64::NEG_INFINITY];
        for (x, y) in image_grid(scene.size) {
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

    /// The range of gamma that the image's rays and the light's map may have in common. Parts of rays beyond it
    /// are walked, so that it need not be exact.
    pub(super) fn gamma_range(&self, scene: &GridScene<'_>) -> [f64; 2] {
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
    pub(super) fn gammas_seen(&self, scene: &GridScene<'_>) -> [f64; 2] {
        let mut range = [f64::INFINITY, f64::NEG_INFINITY];
        for (x, y) in image_grid(scene.size) {
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
    pub(super) fn gammas_in_cone(&self, cone: Option<(DVec3, f64)>) -> [f64; 2] {
        let Some((direction, outer)) = cone else {
            return [0.0, std::f64::consts::PI];
        };
        let middle = (-self.axis).angle_between(direction);
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

    pub(super) fn b_range(&self, scene: &GridScene<'_>) -> [f64; 2] {
        if !self.orthographic {
            return [0.0, 2.0];
        }
        // A ray's b is linear in its place on the image, or convex with its least value on the axis.
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

/// Points of an image \[pixels], from border to border.
pub(super) fn image_grid([width, height]: [u32; 2]) -> impl Iterator<Item = (f64, f64)> {
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
