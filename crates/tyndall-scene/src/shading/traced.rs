//! Visibility of a rectangular light by rays to its samples.

use glam::DVec3;
use tyndall::{
    cpu::CpuLightInputs,
    frame::{Camera, Emitter, Light},
    light::LightModel,
    physics::medium::Optics,
};

use super::surface::SurfacePoint;
use crate::{trace::Tracer, view::Ray};

/// Distance from their surface at which rays to a rectangular light begin, relative to the distance to the eye: more than
/// the depth buffer's error.
const OFF_SURFACE: f64 = 1e-4;

/// A rectangle's samples, and the scene that blocks them.
pub(super) struct TracedShadow<'a> {
    samples: Vec<LightModel<'a>>,
    tracer: &'a Tracer,
}

impl<'a> TracedShadow<'a> {
    /// `None` for lights other than rectangles.
    pub(super) fn new(
        light: &Light,
        camera: &Camera,
        inputs: &CpuLightInputs<'a>,
        tracer: &'a Tracer,
    ) -> Option<Self> {
        matches!(light.emitter, Emitter::Rect { .. }).then(|| Self {
            samples: LightModel::samples(light, camera, inputs.texture),
            tracer,
        })
    }

    /// The share of the light that arrives; all of it where there is none.
    pub(super) fn visibility(&self, surface: &SurfacePoint, optics: &Optics) -> DVec3 {
        let (mut arriving, mut all) = (DVec3::ZERO, DVec3::ZERO);
        let point = surface.point + OFF_SURFACE * surface.distance * surface.normal;
        for sample in &self.samples {
            let incident = sample.incident(surface.point, optics);
            let received = (-surface.normal.dot(incident.direction)).max(0.0);
            let light = received * incident.irradiance;
            if let (Some(position), true) = (sample.position(), light != DVec3::ZERO) {
                all += light;
                arriving += light * self.tint(point, position);
            }
        }
        DVec3::select(all.cmpgt(DVec3::ZERO), arriving / all, DVec3::ONE)
    }

    /// Factor on light between two points: zero where a surface blocks it, else the tints of the glass.
    fn tint(&self, point: DVec3, light: DVec3) -> DVec3 {
        let distance = (light - point).length();
        let ray = Ray {
            origin: point,
            direction: (light - point) / distance,
        };
        if self.tracer.blocked(&ray, [0.0, distance]) {
            return DVec3::ZERO;
        }
        let mut glass = Vec::new();
        self.tracer.glass(&ray, [0.0, distance], &mut glass);
        glass.iter().map(|hit| hit.tint).product()
    }
}
