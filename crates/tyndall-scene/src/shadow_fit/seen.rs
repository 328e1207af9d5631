//! The shadows that a camera's rays pass, and what each is worth.

use std::f64::consts::PI;

use glam::{DVec2, DVec3};
use rayon::prelude::*;
use tyndall::{
    camera::{CameraRays, Ray},
    cpu::{LightSource, Occluders, Shade},
    frame::{Camera, Medium},
    physics::{medium::Optics, transmittance::transmittance_integral},
};

use super::plane::LightPlane;
use crate::{trace::Tracer, view::View};

/// A camera in its scene and medium, as far as a light's map depends on it.
#[derive(Clone, Copy)]
pub struct Seen<'a> {
    /// The scene's surfaces, where they are now.
    pub tracer: &'a Tracer,
    /// The camera.
    pub camera: &'a Camera,
    /// The medium that its rays pass.
    pub medium: &'a Medium,
    /// Width and height of its image \[pixels].
    pub size: [u32; 2],
}

/// The most rays that are cast.
const RAYS: u32 = 4096;

/// The share of light that any surface is taken to reflect.
const ALBEDO: f64 = 0.5;

/// A stretch of shade is looked at in pieces of which each ends so many times as far away as it begins.
const PIECE: f64 = 1.5;

/// All shadows on a camera's rays.
#[derive(Default)]
pub(super) struct Shadows {
    pub(super) pieces: Vec<Piece>,
    /// What the rays see of the light, relative to the light itself [1/sr], summed over the rays.
    pub(super) lit: f64,
}

/// A piece of a ray that a surface shades.
#[derive(Clone, Copy)]
pub(super) struct Piece {
    /// The smallest coordinates along and across the axis of the light's plane of what light to it passes \[m].
    pub(super) low: DVec2,
    /// The largest ones \[m].
    pub(super) high: DVec2,
    /// What would be seen of it, were it lit; as [`Shadows::lit`].
    pub(super) worth: f64,
}

/// The shadows on the camera's rays; `axis` is one of the light's plane.
pub(super) fn shadows(seen: &Seen<'_>, plane: &LightPlane, axis: DVec2) -> Shadows {
    let [width, height] = seen.size;
    let pixels = f64::from(width) * f64::from(height);
    let stride = (pixels / f64::from(RAYS)).sqrt().ceil().max(1.0) as u32;
    let eye = Eye {
        seen,
        plane,
        axis,
        stride,
        rays: CameraRays::new(seen.camera, seen.size),
        view: View::new(seen.camera, seen.size),
        optics: Optics::new(seen.medium),
    };
    let [columns, rows] = seen.size.map(|n| n.div_ceil(stride));
    let of_row = |row: u32| {
        let place = |i: u32, n: u32| (i * stride + stride / 2).min(n - 1);
        let mut shadows = Shadows::default();
        for column in 0..columns {
            eye.look(place(column, width), place(row, height), &mut shadows);
        }
        shadows
    };
    (0..rows)
        .into_par_iter()
        .map(of_row)
        .collect::<Vec<_>>()
        .into_iter()
        .fold(Shadows::default(), |mut all, row| {
            all.pieces.extend(row.pieces);
            all.lit += row.lit;
            all
        })
}

/// A camera that looks for shadows.
struct Eye<'a> {
    seen: &'a Seen<'a>,
    plane: &'a LightPlane,
    axis: DVec2,
    /// Pixels from one ray to the next.
    stride: u32,
    rays: CameraRays,
    view: View,
    optics: Optics,
}

impl Eye<'_> {
    /// Adds what the ray of a pixel sees.
    fn look(&self, x: u32, y: u32, shadows: &mut Shadows) {
        let (ray, surface) = self.ray(x, y);
        let beside = self.rays.ray(x + self.stride, y, self.view.far_value());
        let shaded = self.shaded(&ray);
        let scattering = self
            .optics
            .scattering(-ray.direction.dot(self.plane.forward));
        let glow = |[a, b]: [f64; 2]| {
            let path = self.optics.sigma_t.to_array();
            let path = DVec3::from(path.map(|sigma_t| transmittance_integral(sigma_t, a, b)));
            (scattering * path).element_sum() / 3.0
        };
        shadows.lit += glow([0.0, ray.length]);
        for &[from, to] in &shaded {
            shadows.lit -= glow([from, to]);
            pieces([from, to], |piece| {
                shadows
                    .pieces
                    .push(self.piece(&ray, &beside, piece, glow(piece)));
            });
        }
        let end = [ray.length; 2];
        // What touches the ray's end may be the surface itself.
        let is_shaded = |[from, to]: &[f64; 2]| *to >= ray.length && to - from > 1e-6 * to;
        if shaded.last().is_some_and(is_shaded) {
            shadows.pieces.push(self.piece(&ray, &beside, end, surface));
        } else {
            shadows.lit += surface;
        }
    }

    /// A pixel's ray up to its end, and what is seen there of the light, were it not blocked.
    fn ray(&self, x: u32, y: u32) -> (Ray, f64) {
        let ray = self.rays.ray(x, y, self.view.far_value());
        let sight = self.view.ray(x, y);
        let Some(hit) = self.seen.tracer.closest(&sight, self.view.span(&sight)) else {
            return (ray, 0.0);
        };
        let [a, b, c] = self.seen.tracer.geometry().positions[hit.triangle].map(|p| p.as_dvec3());
        let normal = (b - a).cross(c - a).normalize_or_zero();
        // Light and eye on the same side of the surface.
        let [light, eye] = [self.plane.forward, ray.direction].map(|way| way.dot(normal));
        let received = if light * eye > 0.0 { light.abs() } else { 0.0 };
        let transmittance = self.optics.transmittance(hit.distance).element_sum() / 3.0;
        let length = hit.distance;
        (
            Ray { length, ..ray },
            ALBEDO / PI * received * transmittance,
        )
    }

    /// The stretches of a ray that any surface shades or tints, from its start to its end, apart from each other.
    fn shaded(&self, ray: &Ray) -> Vec<[f64; 2]> {
        let mut shades: Vec<Shade> = Vec::new();
        let light = LightSource::Direction(self.plane.forward.to_array());
        let (origin, direction) = (ray.origin.to_array(), ray.direction.to_array());
        let tracer = self.seen.tracer;
        tracer.shades(origin, direction, ray.length, light, &mut shades);
        shades.sort_unstable_by(|a, b| a.start.total_cmp(&b.start));
        let mut apart: Vec<[f64; 2]> = Vec::new();
        for Shade { start, end, .. } in shades {
            match apart.last_mut() {
                Some([_, last]) if start <= *last => *last = last.max(end),
                _ => apart.push([start, end]),
            }
        }
        apart
    }

    /// A piece of a ray, as wide as it is to the ray `beside` it.
    fn piece(&self, ray: &Ray, beside: &Ray, piece: [f64; 2], worth: f64) -> Piece {
        let spread = |s| (ray.at(s) - beside.at(s)).length();
        let [a, b] = piece.map(|s| (self.plane.along_axis(self.axis, ray.at(s)), spread(s)));
        Piece {
            low: (a.0 - a.1).min(b.0 - b.1),
            high: (a.0 + a.1).max(b.0 + b.1),
            worth,
        }
    }
}

/// Visits pieces of a stretch from its end to its start; the last one takes all that is nearer than a thousandth.
fn pieces([from, to]: [f64; 2], mut visit: impl FnMut([f64; 2])) {
    let mut end = to;
    while end > from {
        let next = end / PIECE;
        let start = if next > from && next > 1e-3 * to {
            next
        } else {
            from
        };
        visit([start, end]);
        end = start;
    }
}
