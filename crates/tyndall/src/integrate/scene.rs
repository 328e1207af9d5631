//! A frame and its inputs in f64, ready to be integrated ray by ray.

use glam::DVec3;

use crate::{
    camera::{CameraRays, Ray},
    frame::{Frame, Light},
    inputs::CpuLightInputs,
    light::LightModel,
    physics::medium::Optics,
    shadow::{Occluders, Shadows},
};

/// Inputs of the CPU backend besides the [`Frame`]; the GPU backend is handed the same images as textures.
#[derive(Clone, Copy)]
pub struct CpuInputs<'a> {
    /// Width and height of the image \[pixels].
    pub size: [u32; 2],
    /// The depth buffer, row by row from the top left, one value a pixel, in the camera's convention.
    pub depth: &'a [f32],
    /// One entry a light of the frame, in the same order.
    pub lights: &'a [CpuLightInputs<'a>],
    /// The scene itself, for techniques whose visibility is traced.
    pub occluders: Option<&'a dyn Occluders>,
}

/// A frame and its inputs as techniques see them.
pub(crate) struct CpuScene<'a> {
    pub(crate) camera: CameraRays,
    pub(crate) size: [u32; 2],
    pub(crate) depth: &'a [f32],
    pub(crate) optics: Optics,
    pub(crate) lights: Vec<CpuLight<'a>>,
    pub(crate) occluders: Option<&'a dyn Occluders>,
}

/// A light of the frame: one model, or a rectangle's samples.
pub(crate) struct CpuLight<'a> {
    pub(crate) models: Vec<LightModel<'a>>,
    pub(crate) shadows: Option<Shadows<'a>>,
}

/// Computes the in-scattered light of single rays.
/// Techniques that work slice by slice do their work when they are made, and only hand out its results here.
pub(crate) trait RayIntegrator: Sync {
    /// `pixel` counts row by row from the top left.
    fn in_scatter(&self, pixel: usize, ray: &Ray) -> DVec3;
}

impl<'a> CpuScene<'a> {
    /// The frame with the lights of these indices.
    pub(crate) fn new(frame: &Frame, inputs: &CpuInputs<'a>, lights: &[usize]) -> Self {
        let light = |(light, inputs): (&Light, &CpuLightInputs<'a>)| CpuLight {
            models: LightModel::samples(light, &frame.camera, inputs.texture),
            shadows: Shadows::new(&light.emitter, light.shadow.as_ref(), inputs),
        };
        Self {
            camera: CameraRays::new(&frame.camera, inputs.size),
            size: inputs.size,
            depth: inputs.depth,
            optics: Optics::new(&frame.medium),
            lights: lights
                .iter()
                .map(|i| light((&frame.lights[*i], &inputs.lights[*i])))
                .collect(),
            occluders: inputs.occluders,
        }
    }
}

impl CpuScene<'_> {
    /// The view ray of a pixel.
    pub(crate) fn ray(&self, x: u32, y: u32) -> Ray {
        self.camera.ray(
            x,
            y,
            self.depth[y as usize * self.size[0] as usize + x as usize],
        )
    }
}
