//! The image's radiance: the sky, emission and every light.

use std::f64::consts::PI;

use glam::DVec3;
use rayon::prelude::*;
use tyndall::{camera::CameraRays, cpu::CpuLightInputs, frame::Frame, physics::medium::Optics};

use super::{
    light::SurfaceLight,
    sky::{sky, sun_illuminance},
    surface::{SurfacePoint, vector},
};
use crate::trace::{GBuffer, Tracer};

/// Radiance of the camera's image [W/(m^2 sr)], linear RGB, row by row from the top left; without the medium between
/// surfaces and the eye. `lights` has one entry a light of the frame, in the same order. Rays through `tracer` find the
/// surfaces that block rectangular lights, and others that are given no shadow map; without it none do.
pub fn shade(
    g_buffer: &GBuffer,
    frame: &Frame,
    lights: &[CpuLightInputs<'_>],
    tracer: Option<&Tracer>,
) -> Vec<[f32; 3]> {
    let scene_lights: Vec<SurfaceLight<'_>> = frame
        .lights
        .iter()
        .zip(lights)
        .map(|(light, inputs)| SurfaceLight::new(light, &frame.camera, inputs, tracer))
        .collect();
    let shading = Shading {
        g_buffer,
        rays: CameraRays::new(&frame.camera, g_buffer.size),
        far_value: frame.camera.depth_range.far_value(),
        optics: Optics::new(&frame.medium),
        lights: scene_lights,
        sun: frame.lights.iter().map(sun_illuminance).sum(),
    };
    (0..g_buffer.depth.len())
        .into_par_iter()
        .map(|pixel| shading.radiance(pixel).as_vec3().to_array())
        .collect()
}

/// All that the pixels' radiances are computed from.
struct Shading<'a> {
    g_buffer: &'a GBuffer,
    rays: CameraRays,
    far_value: f32,
    optics: Optics,
    lights: Vec<SurfaceLight<'a>>,
    /// Illuminance of the directional lights together [W/m^2].
    sun: DVec3,
}

impl Shading<'_> {
    fn radiance(&self, pixel: usize) -> DVec3 {
        let [width, _] = self.g_buffer.size;
        let (x, y) = (pixel as u32 % width, pixel as u32 / width);
        let depth = self.g_buffer.depth[pixel];
        let ray = self.rays.ray(x, y, depth);
        let tint = vector(self.g_buffer.view_tint[pixel]);
        if depth == self.far_value {
            return tint * sky(ray.direction, self.sun);
        }
        let surface = SurfacePoint {
            point: ray.at(ray.length),
            normal: vector(self.g_buffer.normal[pixel]),
            distance: ray.length,
        };
        let irradiance: DVec3 = self
            .lights
            .iter()
            .map(|light| light.irradiance(&surface, &self.optics))
            .sum();
        let reflected = vector(self.g_buffer.base_color[pixel]) / PI * irradiance;
        tint * (reflected + vector(self.g_buffer.emissive[pixel]))
    }
}
