//! The CPU backend: every formula in f64, on all cores, with nothing installed.

pub(crate) mod stretches;

use std::sync::atomic::{AtomicU64, Ordering};

use glam::DVec3;
use rayon::prelude::*;

use crate::{
    camera::{CameraRays, Ray},
    error::PrepareError,
    frame::{Frame, Light},
    light::LightModel,
    physics::medium::Optics,
    shadow::Shadows,
    techniques::Backends,
    validate,
};

/// What the CPU backend reads besides the [`Frame`]; the same pictures the GPU backend is handed as textures.
#[derive(Clone, Copy)]
pub struct CpuInputs<'a> {
    /// Width and height of the picture [pixels].
    pub size: [u32; 2],
    /// The depth buffer, row by row from the top left, one value a pixel, in the camera's convention.
    pub depth: &'a [f32],
    /// One entry a light of the frame, in the same order.
    pub lights: &'a [CpuLightInputs<'a>],
    /// The scene itself, for techniques whose visibility is traced.
    pub occluders: Option<&'a dyn Occluders>,
}

/// The pictures that belong to one light.
#[derive(Clone, Copy, Default)]
pub struct CpuLightInputs<'a> {
    /// The shadow map; needed iff the light has a [`ShadowProjection`](crate::frame::ShadowProjection).
    pub shadow_map: Option<&'a ShadowMap>,
    /// Coloured glass between the light and what it shines on; `None`: no coloured glass.
    pub glass: Option<&'a GlassMap>,
    /// The light's texture; needed iff the light has a [`TexturePlacement`](crate::frame::TexturePlacement).
    pub texture: Option<&'a LightTexture>,
}

/// A shadow map on the CPU: depth in the convention of its [`ShadowProjection`](crate::frame::ShadowProjection).
#[derive(Clone, Debug, PartialEq)]
pub struct ShadowMap {
    /// Width and height of a face [texels].
    pub size: [u32; 2],
    /// Face by face (1, or 6 for a cube), row by row from the top left.
    pub depth: Vec<f32>,
}

/// Coloured glass seen from the light: some layers, nearest to the light first and empty ones last, on the texels of the shadow map's faces.
///
/// A point is tinted by every layer that lies between it and the light. Clear glass (tint 1) needs no layer.
#[derive(Clone, Debug, PartialEq)]
pub struct GlassMap {
    /// Width and height of a face [texels].
    pub size: [u32; 2],
    /// Number of layers a face.
    pub layers: u32,
    /// `[face][layer][row][column]`: linear RGB tint and, last, the layer's depth in the shadow map's convention.
    /// A layer with nothing in it has tint 1.
    pub texels: Vec<[f32; 4]>,
}

/// A light's texture on the CPU.
#[derive(Clone, Debug, PartialEq)]
pub struct LightTexture {
    /// Width and height [texels].
    pub size: [u32; 2],
    /// Linear RGB, row by row from the top left.
    pub texels: Vec<[f32; 3]>,
}

/// Where light comes from, seen from one view ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LightSource {
    /// Parallel light that travels this way (unit length).
    Direction([f64; 3]),
    /// A point in world space [m].
    Position([f64; 3]),
}

/// A stretch of a view ray whose light is blocked or tinted by one surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shade {
    /// Distance from the ray's origin where it begins [m].
    pub start: f64,
    /// Distance from the ray's origin where it ends [m] (>= start).
    pub end: f64,
    /// What the light is multiplied by; zero where the surface blocks.
    pub tint: [f64; 3],
}

/// A scene that can say exactly which parts of a view ray its surfaces shade.
pub trait Occluders: Sync {
    /// Appends the shades that all surfaces throw onto the points `origin + s * direction`, s in `[0, length]`;
    /// `direction` has unit length. They may overlap and come in any order.
    fn shades(
        &self,
        origin: [f64; 3],
        direction: [f64; 3],
        length: f64,
        light: LightSource,
        shades: &mut Vec<Shade>,
    );
}

/// In-scattered light of a picture.
#[derive(Clone, Debug, PartialEq)]
pub struct InScatter {
    /// Width and height [pixels].
    pub size: [u32; 2],
    /// Row by row from the top left: radiance [W/(m^2 sr)] per channel and, last, the mean transmittance to the surface.
    pub pixels: Vec<[f32; 4]>,
}

/// Called as work goes on with the number of pixels done and their total; from any thread.
pub type Progress<'a> = &'a (dyn Fn(u64, u64) + Sync);

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

/// What computes the in-scattered light of one ray.
/// Techniques that work slice by slice do their work when they are made, and only hand out its results here.
pub(crate) trait RayIntegrator: Sync {
    /// `pixel` counts row by row from the top left.
    fn in_scatter(&self, pixel: usize, ray: &Ray) -> DVec3;
}

impl<'a> CpuScene<'a> {
    fn new(frame: &Frame, inputs: &CpuInputs<'a>) -> Self {
        let light = |(light, inputs): (&Light, &CpuLightInputs<'a>)| CpuLight {
            models: LightModel::samples(light, inputs.texture),
            shadows: Shadows::new(&light.emitter, light.shadow.as_ref(), inputs),
        };
        Self {
            camera: CameraRays::new(&frame.camera, inputs.size),
            size: inputs.size,
            depth: inputs.depth,
            optics: Optics::new(&frame.medium),
            lights: frame.lights.iter().zip(inputs.lights).map(light).collect(),
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

/// Computes the in-scattered light of a frame on all cores.
///
/// # Errors
/// [`PrepareError`] where the frame or an input is out of range, missing or of the wrong size,
/// or where the technique cannot do it on the CPU.
pub fn render(
    frame: &Frame,
    inputs: &CpuInputs<'_>,
    progress: Progress<'_>,
) -> Result<InScatter, PrepareError> {
    validate::frame(frame)?;
    validate::technique(frame, Backends::Cpu)?;
    validate::cpu_inputs(frame, inputs)?;
    let scene = CpuScene::new(frame, inputs);
    let integrator = frame.technique.cpu(&scene)?;
    let width = inputs.size[0];
    let total = u64::from(width) * u64::from(inputs.size[1]);
    let done = AtomicU64::new(0);
    let mut pixels = vec![[0.0; 4]; inputs.depth.len()];
    let rows = pixels.par_chunks_mut(width as usize);
    rows.enumerate().for_each(|(y, row)| {
        for (x, pixel) in row.iter_mut().enumerate() {
            let ray = scene.ray(x as u32, y as u32);
            let light = integrator.in_scatter(y * width as usize + x, &ray);
            let transmittance = scene.optics.transmittance(ray.length).element_sum() / 3.0;
            *pixel = light.extend(transmittance).as_vec4().to_array();
        }
        let width = u64::from(width);
        progress(done.fetch_add(width, Ordering::Relaxed) + width, total);
    });
    Ok(InScatter {
        size: inputs.size,
        pixels,
    })
}
