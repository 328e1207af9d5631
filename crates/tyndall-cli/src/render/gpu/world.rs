//! What an engine has before volumetric light comes in: the scene on the device, a depth buffer, shadow maps.

use tyndall::{LightInputs, gpu::PassTimer};
use tyndall_scene::gpu::{
    GBufferTargets, SceneRenderer,
    readback::{self, ReadbackError},
};
use wgpu::{CommandEncoder, TextureFormat, TextureView};

use super::lights::{LightTargets, light_inputs};
use crate::{
    failure::Failure,
    render::{Buffers, Gpu, LightMaps, Needs},
    setup::Setup,
};

/// An uploaded scene, and the textures that its camera and its lights are drawn on.
pub(crate) struct World {
    renderer: SceneRenderer,
    g_buffer: GBufferTargets,
    lights: Vec<LightTargets>,
}

impl World {
    /// Uploads and allocates; `format` is that of the target that surfaces are drawn on.
    pub(crate) fn new(
        setup: &Setup,
        gpu: &Gpu,
        needs: Needs,
        format: TextureFormat,
    ) -> Result<Self, Failure> {
        let Gpu { device, queue, .. } = gpu;
        let renderer = SceneRenderer::new(device, queue, &setup.scene, format);
        let renderer = renderer.map_err(Failure::device)?;
        let lights = (0..setup.lights.len())
            .map(|index| LightTargets::new(setup, index, gpu, &renderer, needs))
            .collect::<Result<_, _>>()?;
        Ok(Self {
            g_buffer: GBufferTargets::new(device, setup.size).map_err(Failure::device)?,
            renderer,
            lights,
        })
    }

    /// Records every light's shadow map and coloured glass.
    pub(crate) fn draw_light_maps(
        &self,
        setup: &Setup,
        encoder: &mut CommandEncoder,
        mut timer: Option<&mut PassTimer>,
    ) {
        for (light, targets) in setup.frame.lights.iter().zip(&self.lights) {
            let (Some(projection), Some(shadow_map)) = (&light.shadow, &targets.shadow_map) else {
                continue;
            };
            let (renderer, emitter) = (&self.renderer, &light.emitter);
            renderer.shadow_map(
                encoder,
                shadow_map,
                emitter,
                projection,
                timer.as_deref_mut(),
            );
            if let Some(glass) = &targets.glass {
                let timer = timer.as_deref_mut();
                renderer.glass_map(encoder, glass, shadow_map, emitter, projection, timer);
            }
        }
    }

    /// Records what the camera sees.
    pub(crate) fn draw_g_buffer(
        &self,
        setup: &Setup,
        encoder: &mut CommandEncoder,
        timer: Option<&mut PassTimer>,
    ) {
        let camera = &setup.frame.camera;
        self.renderer
            .g_buffer(encoder, &self.g_buffer, camera, timer);
    }

    /// Records the lit surfaces on `target`.
    pub(crate) fn draw_surfaces(
        &self,
        setup: &Setup,
        encoder: &mut CommandEncoder,
        target: &TextureView,
        timer: Option<&mut PassTimer>,
    ) {
        let (lights, frame) = (self.light_inputs(), &setup.frame);
        self.renderer
            .shade(encoder, target, &self.g_buffer, frame, &lights, timer);
    }

    /// What the camera sees.
    pub(crate) fn g_buffer(&self) -> &GBufferTargets {
        &self.g_buffer
    }

    /// The lights' pictures, as tyndall takes them.
    pub(crate) fn light_inputs(&self) -> Vec<LightInputs<'_>> {
        light_inputs(&self.lights)
    }

    /// What the CPU needs to work on the very same pictures. Waits for the device.
    pub(crate) fn read(&self, gpu: &Gpu) -> Result<Buffers, Failure> {
        let Gpu { device, queue, .. } = gpu;
        let depth = readback::texture_f32(device, queue, self.g_buffer.depth());
        let light = |light: &LightTargets| {
            let shadow_map = light.shadow_map.as_ref();
            let glass = light.glass.as_ref();
            Ok(LightMaps {
                shadow_map: shadow_map.map(|map| map.read(device, queue)).transpose()?,
                glass: glass.map(|map| map.read(device, queue)).transpose()?,
            })
        };
        let lights = self
            .lights
            .iter()
            .map(light)
            .collect::<Result<_, ReadbackError>>();
        Ok(Buffers {
            depth: depth.map_err(Failure::device)?,
            lights: lights.map_err(Failure::device)?,
        })
    }

    /// Textures, by what they are for [bytes].
    pub(crate) fn bytes(&self) -> [(&'static str, u64); 2] {
        let lights = self.lights.iter().map(LightTargets::bytes).sum();
        [("G-buffer", self.g_buffer.bytes()), ("light maps", lights)]
    }
}
