//! The contrast of light shafts in a view.

use glam::{DVec3, Vec3};
use tyndall::frame::{Camera, Emitter};

use super::defaults::MEAN_COSINE;
use crate::{
    geometry::Bounds,
    trace::Tracer,
    view::{Ray, View},
};

/// View rays across and down, and points on each.
const RAYS: [u32; 2] = [20, 15];
const POINTS: u32 = 16;

/// Factor on the contrast if the eye itself is in the light.
const LIT_EYE: f64 = 0.5;

/// The medium seen by a camera, as points on a few view rays.
pub(super) struct Probe {
    /// Row by row from the top left.
    rays: Vec<(Ray, f64)>,
    /// Distance that shadow rays keep from surfaces and lights \[m].
    margin: f64,
    /// Longer than any shadow ray \[m].
    diagonal: f64,
}

impl Probe {
    /// Rays that hit nothing end where they leave the scene's bounds for good.
    pub(super) fn new(tracer: &Tracer, camera: &Camera, bounds: &Bounds) -> Self {
        let view = View::new(camera, RAYS);
        let rays = (0..RAYS[1])
            .flat_map(|y| (0..RAYS[0]).map(move |x| (x, y)))
            .map(|(x, y)| {
                let ray = view.ray(x, y);
                let [near, far] = view.span(&ray);
                let end = tracer
                    .closest(&ray, [near, far])
                    .map_or_else(|| exit(&ray, bounds).min(far), |hit| hit.distance);
                (ray, end)
            })
            .collect();
        let diagonal = f64::from(bounds.extent().length());
        Self {
            rays,
            margin: 1e-4 * diagonal,
            diagonal,
        }
    }

    /// Mean length of the view rays that meet the scene's bounds \[m].
    pub(super) fn mean_length(&self) -> f32 {
        let lengths = self.rays.iter().map(|(_, length)| length);
        let (sum, count) = lengths
            .filter(|&&length| length > 0.0)
            .fold((0.0, 0.0), |(sum, count), length| {
                (sum + length, count + 1.0)
            });
        if count > 0.0 {
            (sum / count) as f32
        } else {
            self.diagonal as f32
        }
    }

    /// Sum of the differences in in-scattered light between neighbouring rays over the square root of all the light:
    /// between the absolute contrast, which likes to be flooded with light, and the relative one, which likes specks.
    pub(super) fn contrast(&self, tracer: &Tracer, lights: &[Emitter]) -> f32 {
        let in_scatter: Vec<f64> = self
            .rays
            .iter()
            .map(|(ray, length)| self.in_scatter(tracer, ray, *length, lights))
            .collect();
        let [columns, rows] = RAYS.map(|n| n as usize);
        let at = |x: usize, y: usize| in_scatter[y * columns + x];
        let across = (0..rows).flat_map(|y| (1..columns).map(move |x| (x, y)));
        let down = (1..rows).flat_map(|y| (0..columns).map(move |x| (x, y)));
        let differences = across
            .map(|(x, y)| (at(x, y) - at(x - 1, y)).abs())
            .sum::<f64>()
            + down
                .map(|(x, y)| (at(x, y) - at(x, y - 1)).abs())
                .sum::<f64>();
        let total: f64 = in_scatter.iter().sum();
        if total == 0.0 {
            return 0.0;
        }
        let share = if self.eye_is_lit(tracer, lights) {
            LIT_EYE
        } else {
            1.0
        };
        (share * differences / total.sqrt()) as f32
    }

    /// Shafts are best seen from the dark.
    fn eye_is_lit(&self, tracer: &Tracer, lights: &[Emitter]) -> bool {
        let eye = self.rays[self.rays.len() / 2].0.origin;
        lights
            .iter()
            .filter_map(|light| Arrival::new(light, eye, self.diagonal))
            .any(|arrival| !arrival.is_blocked(tracer, eye, self.margin))
    }

    /// Mean radiance scattered towards the eye by points along a ray, up to a factor.
    fn in_scatter(&self, tracer: &Tracer, ray: &Ray, length: f64, lights: &[Emitter]) -> f64 {
        // At the same shares of every ray: noise between neighbours would pass for shafts.
        let points = (0..POINTS).map(|i| length * (f64::from(i) + 0.5) / f64::from(POINTS));
        let sum: f64 = points
            .flat_map(|distance| lights.iter().map(move |light| (ray.at(distance), light)))
            .map(|(point, light)| {
                let Some(arrival) = Arrival::new(light, point, self.diagonal) else {
                    return 0.0;
                };
                if arrival.is_blocked(tracer, point, self.margin) {
                    return 0.0;
                }
                arrival.irradiance * phase(-arrival.to_light.dot(-ray.direction))
            })
            .sum();
        sum / f64::from(POINTS) * length
    }

    /// A lamp half way along the middle view ray, with this illuminance at the ray's end [W/m^2].
    pub(super) fn lamp(&self, illuminance: [f32; 3]) -> Emitter {
        let (ray, length) = &self.rays[self.rays.len() / 2];
        let reach = 0.5 * length;
        Emitter::Point {
            position: ray.at(reach).as_vec3().to_array(),
            intensity: illuminance.map(|e| e * (reach * reach) as f32),
            radius: 0.0,
        }
    }
}

/// Light that arrives at a point.
struct Arrival {
    to_light: DVec3,
    distance: f64,
    irradiance: f64,
}

impl Arrival {
    /// `None` if no light shines on the point. Directional light comes from `far` away.
    fn new(light: &Emitter, point: DVec3, far: f64) -> Option<Self> {
        let vector = |v: [f32; 3]| Vec3::from(v).as_dvec3();
        let strength = |rgb: [f32; 3]| f64::from(rgb.iter().sum::<f32>()) / 3.0;
        let (to_light, strength) = match *light {
            Emitter::Directional {
                direction,
                illuminance,
            } => {
                return Some(Self {
                    to_light: -vector(direction).try_normalize()?,
                    distance: far,
                    irradiance: strength(illuminance),
                });
            }
            Emitter::Point {
                position,
                intensity,
                ..
            } => (vector(position) - point, strength(intensity)),
            Emitter::Spot {
                position,
                direction,
                intensity,
                outer,
                ..
            } => {
                let to_light = vector(position) - point;
                let axis = vector(direction).try_normalize()?;
                let inside = -to_light.dot(axis) > f64::from(outer.cos()) * to_light.length();
                (to_light, if inside { strength(intensity) } else { 0.0 })
            }
            Emitter::Rect {
                center,
                edge_x,
                edge_y,
                radiance,
                ..
            } => {
                let to_light = vector(center) - point;
                let area = vector(edge_x).cross(vector(edge_y));
                let cosine = -to_light.dot(area) / to_light.length();
                (to_light, cosine.max(0.0) * strength(radiance))
            }
        };
        let distance = to_light.length();
        (distance > 0.0 && strength > 0.0).then(|| Self {
            to_light: to_light / distance,
            distance,
            irradiance: strength / (distance * distance),
        })
    }

    fn is_blocked(&self, tracer: &Tracer, point: DVec3, margin: f64) -> bool {
        let ray = Ray {
            origin: point,
            direction: self.to_light,
        };
        tracer.blocked(&ray, [margin, self.distance - margin])
    }
}

/// The square root of Henyey & Greenstein's phase function, up to a factor: light towards the eye counts for more,
/// but not for so much that only the sun behind the scene remains.
fn phase(cosine: f64) -> f64 {
    let g = f64::from(MEAN_COSINE);
    (1.0 + g * g - 2.0 * g * cosine).powf(-0.75)
}

/// Distance at which a ray leaves the bounds for the last time; 0 if it never meets them.
fn exit(ray: &Ray, bounds: &Bounds) -> f64 {
    let [low, high] =
        [bounds.min, bounds.max].map(|corner| (corner.as_dvec3() - ray.origin) / ray.direction);
    let (enter, exit) = (low.min(high).max_element(), low.max(high).min_element());
    if exit >= enter { exit.max(0.0) } else { 0.0 }
}
