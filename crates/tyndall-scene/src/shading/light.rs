//! The irradiance of one light on a surface.

use glam::DVec3;
use tyndall::{
    cpu::CpuLightInputs,
    frame::{Camera, Emitter, Light},
    light::{LightModel, patch_radius},
    physics::medium::Optics,
};

use super::{
    shadow_map::SurfaceShadow,
    surface::{SurfacePoint, vector},
    traced::TracedShadow,
};
use crate::trace::Tracer;

/// Irradiance from all around, relative to that of the unblocked light on a surface that faces it.
pub const AMBIENT: f64 = 0.03;
/// Share of the ambient irradiance that surfaces facing up get more, and surfaces facing down less.
pub const AMBIENT_TILT: f64 = 0.5;
/// Number of points that stand for a rectangular light.
pub const RECT_SAMPLES: u32 = 16;

/// A light as surfaces see it.
pub(super) struct SurfaceLight<'a> {
    /// The light unblocked: one point, or a rectangle's.
    samples: Vec<LightModel<'a>>,
    /// The light without cone and texture.
    bare: Vec<LightModel<'a>>,
    shadow: Option<SurfaceShadow<'a>>,
    traced: Option<TracedShadow<'a>>,
}

impl<'a> SurfaceLight<'a> {
    pub(super) fn new(
        light: &Light,
        camera: &Camera,
        inputs: &CpuLightInputs<'a>,
        tracer: Option<&'a Tracer>,
    ) -> Self {
        let mut sampled = *light;
        if let Emitter::Rect { samples, .. } = &mut sampled.emitter {
            *samples = RECT_SAMPLES;
        }
        let shadow = SurfaceShadow::new(light, inputs);
        let tracer = tracer.filter(|_| shadow.is_none());
        Self {
            samples: LightModel::samples(&sampled, camera, inputs.texture),
            bare: LightModel::samples(&bare(light), camera, None),
            traced: tracer.map(|tracer| TracedShadow::new(light, camera, inputs, tracer)),
            shadow,
        }
    }

    /// Irradiance on a surface, direct and ambient [W/m^2].
    pub(super) fn irradiance(&self, surface: &SurfacePoint, optics: &Optics) -> DVec3 {
        let ambient = self.ambient(surface, optics);
        let direct = self.direct(surface, optics);
        if direct == DVec3::ZERO {
            return ambient;
        }
        ambient + self.visibility(surface, optics) * direct
    }

    /// Irradiance of the light itself, unblocked.
    fn direct(&self, surface: &SurfacePoint, optics: &Optics) -> DVec3 {
        let received = |sample: &LightModel<'_>| {
            let incident = sample.incident(surface.point, optics);
            incident.irradiance * (-surface.normal.dot(incident.direction)).max(0.0)
        };
        self.samples.iter().map(received).sum()
    }

    /// Irradiance from all around.
    fn ambient(&self, surface: &SurfacePoint, optics: &Optics) -> DVec3 {
        let irradiance =
            |sample: &LightModel<'_>| sample.incident(surface.point, optics).irradiance;
        let bare: DVec3 = self.bare.iter().map(irradiance).sum();
        AMBIENT * (1.0 + AMBIENT_TILT * surface.normal.y) * bare
    }

    /// Share of the direct light that reaches the surface, per channel.
    fn visibility(&self, surface: &SurfacePoint, optics: &Optics) -> DVec3 {
        let mapped = self.shadow.as_ref();
        let mapped = mapped.map_or(DVec3::ONE, |shadow| {
            // Lights with maps are one point, or a direction.
            let incident = self.samples.first();
            let incident = incident.map(|sample| sample.incident(surface.point, optics));
            let direction = incident.map_or(DVec3::ZERO, |incident| incident.direction);
            shadow.visibility(surface.point, surface.normal, direction)
        });
        let traced = self.traced.as_ref();
        let traced = traced.map_or(DVec3::ONE, |shadow| shadow.visibility(surface, optics));
        mapped * traced
    }
}

/// An equally strong light that shines evenly: a spot without its cone, a rectangle as a point in its middle with
/// the intensity of its bright side.
fn bare(light: &Light) -> Light {
    let emitter = match light.emitter {
        Emitter::Spot {
            position,
            intensity,
            radius,
            ..
        } => Emitter::Point {
            position,
            intensity,
            radius,
        },
        Emitter::Rect {
            center,
            edge_x,
            edge_y,
            radiance,
            samples,
        } => {
            let area = vector(edge_x).cross(vector(edge_y)).length();
            Emitter::Point {
                position: center,
                intensity: radiance.map(|l| l * area as f32),
                radius: patch_radius(area, samples) as f32,
            }
        }
        plain => plain,
    };
    Light {
        emitter,
        shadow: None,
        texture: None,
    }
}
