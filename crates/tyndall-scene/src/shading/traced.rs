//! Visibility of a light without a map by rays to it, or to a rectangle's samples.

use glam::DVec3;
use tyndall::{
    cpu::{CpuLightInputs, LightSource},
    frame::{Camera, Light},
    light::LightModel,
    physics::medium::Optics,
};

use super::surface::SurfacePoint;
use crate::{trace::Tracer, view::Ray};

/// Distance from their surface at which rays to a light begin, relative to the distance to the eye: more than
/// the depth buffer's error.
const OFF_SURFACE: f64 = 1e-4;

/// A light, or a rectangle's samples, and the scene that blocks it.
pub(super) struct TracedShadow<'a> {
    samples: Vec<LightModel<'a>>,
    tracer: &'a Tracer,
}

impl<'a> TracedShadow<'a> {
    pub(super) fn new(
        light: &Light,
        camera: &Camera,
        inputs: &CpuLightInputs<'a>,
        tracer: &'a Tracer,
    ) -> Self {
        Self {
            samples: LightModel::samples(light, camera, inputs.texture),
            tracer,
        }
    }

    /// The share of the light that arrives; all of it where there is none.
    pub(super) fn visibility(&self, surface: &SurfacePoint, optics: &Optics) -> DVec3 {
        let (mut arriving, mut all) = (DVec3::ZERO, DVec3::ZERO);
        let point = surface.point + OFF_SURFACE * surface.distance * surface.normal;
        for sample in &self.samples {
            let incident = sample.incident(surface.point, optics);
            let received = (-surface.normal.dot(incident.direction)).max(0.0);
            let light = received * incident.irradiance;
            if light != DVec3::ZERO {
                all += light;
                arriving += light * self.tint(point, sample);
            }
        }
        DVec3::select(all.cmpgt(DVec3::ZERO), arriving / all, DVec3::ONE)
    }

    /// Factor on light up to a point: zero where a surface blocks it, else the tints of the glass.
    fn tint(&self, point: DVec3, sample: &LightModel<'_>) -> DVec3 {
        let (direction, distance) = match sample.source() {
            LightSource::Direction(direction) => (-DVec3::from(direction), f64::INFINITY),
            LightSource::Position(position) => {
                let to_light = DVec3::from(position) - point;
                (to_light.normalize_or_zero(), to_light.length())
            }
        };
        let ray = Ray {
            origin: point,
            direction,
        };
        if self.tracer.blocked(&ray, [0.0, distance]) {
            return DVec3::ZERO;
        }
        let mut glass = Vec::new();
        self.tracer.glass(&ray, [0.0, distance], &mut glass);
        glass.iter().map(|hit| hit.tint).product()
    }
}
