//! The scene on the device, its depth buffer and shadow maps: what an engine has before volumetric light comes in.

use std::cell::OnceCell;

use glam::DAffine3;
use tyndall::{LightInputs, Occluder, SurfaceShadows, frame::Light, gpu::PassTimer};
use tyndall_scene::gpu::{
    GBufferTargets, SceneOccluders, SceneRenderer, SurfaceLights,
    readback::{self, ReadbackError},
};
use wgpu::{CommandEncoder, TextureFormat, TextureView, TextureViewDescriptor};

use super::lights::{LightTargets, light_inputs};
use crate::{
    backend::Gpu,
    failure::Failure,
    load::ShotFrame,
    render::{
        buffers::{Buffers, LightMaps},
        needs::Needs,
    },
};

/// An uploaded scene, and the textures that its camera and its lights are drawn on.
pub(crate) struct World {
    renderer: SceneRenderer,
    g_buffer: GBufferTargets,
    lights: Vec<LightTargets>,
    occluders: OnceCell<SceneOccluders>,
    /// The content of the lights' maps, and a number that changes with it.
    shown: Shown,
    revision: u64,
}

/// All that the lights' maps depend on.
#[derive(PartialEq)]
struct Shown {
    nodes: Vec<DAffine3>,
    lights: Vec<Light>,
}

impl Shown {
    fn new(shot_frame: &ShotFrame) -> Self {
        let nodes = shot_frame.scene.nodes.iter();
        Self {
            nodes: nodes.map(|node| node.parent_from_local).collect(),
            lights: shot_frame.frame.lights.clone(),
        }
    }
}

impl World {
    /// Uploads and allocates; `format` is that of the target that surfaces are drawn on.
    pub(crate) fn new(
        shot_frame: &ShotFrame,
        gpu: &Gpu,
        needs: Needs,
        format: TextureFormat,
    ) -> Result<Self, Failure> {
        let Gpu { device, queue, .. } = gpu;
        let renderer = SceneRenderer::new(device, queue, &shot_frame.scene, format);
        let renderer = renderer.map_err(Failure::device)?;
        let lights = (0..shot_frame.lights.len())
            .map(|index| LightTargets::new(shot_frame, index, gpu, &renderer, needs))
            .collect::<Result<_, _>>()?;
        Ok(Self {
            g_buffer: GBufferTargets::new(device, shot_frame.size).map_err(Failure::device)?,
            renderer,
            lights,
            occluders: OnceCell::new(),
            shown: Shown::new(shot_frame),
            revision: 0,
        })
    }

    /// Moves the nodes to where they are in this frame, which differs from the one given first in the places of nodes,
    /// camera and lights, and in the lights' textures alone.
    pub(crate) fn place(
        &mut self,
        shot_frame: &ShotFrame,
        gpu: &Gpu,
        needs: Needs,
    ) -> Result<(), Failure> {
        self.renderer.place(&gpu.queue, &shot_frame.scene);
        let shown = Shown::new(shot_frame);
        if self.shown != shown {
            self.shown = shown;
            self.revision += 1;
        }
        for (index, targets) in self.lights.iter_mut().enumerate() {
            // A light that turns towards the scene or away from it gets or loses its map.
            if !targets.suits(&shot_frame.frame.lights[index], needs) {
                *targets = LightTargets::new(shot_frame, index, gpu, &self.renderer, needs)?;
            }
            targets.follow(shot_frame, index, gpu, needs)?;
        }
        Ok(())
    }

    /// Records every light's shadow map and coloured glass.
    pub(crate) fn draw_light_maps(
        &self,
        shot_frame: &ShotFrame,
        encoder: &mut CommandEncoder,
        mut timer: Option<&mut PassTimer>,
    ) {
        for (light, targets) in shot_frame.frame.lights.iter().zip(&self.lights) {
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
        shot_frame: &ShotFrame,
        encoder: &mut CommandEncoder,
        timer: Option<&mut PassTimer>,
    ) {
        let camera = &shot_frame.frame.camera;
        self.renderer
            .g_buffer(encoder, &self.g_buffer, camera, timer);
    }

    /// Records the lit surfaces on `target`; direct light is multiplied by `visibility`, light by light.
    pub(crate) fn draw_surfaces(
        &self,
        shot_frame: &ShotFrame,
        encoder: &mut CommandEncoder,
        target: &TextureView,
        visibility: &[Option<&TextureView>],
        timer: Option<&mut PassTimer>,
    ) {
        let lights = SurfaceLights {
            inputs: &self.light_inputs(None),
            visibility,
        };
        self.renderer.shade(
            encoder,
            target,
            &self.g_buffer,
            &shot_frame.frame,
            lights,
            timer,
        );
    }

    /// Depth, normals and materials that the camera sees.
    pub(crate) fn g_buffer(&self) -> &GBufferTargets {
        &self.g_buffer
    }

    /// Inputs of shadows on the surfaces that the camera sees.
    pub(crate) fn surface_shadows(&self) -> SurfaceShadows {
        let normals = self.g_buffer.normal();
        SurfaceShadows {
            normals: Some(normals.create_view(&TextureViewDescriptor::default())),
        }
    }

    /// The lights' inputs, as tyndall takes them.
    pub(crate) fn light_inputs<'a>(
        &'a self,
        occluders: Option<&'a [Occluder<'a>]>,
    ) -> Vec<LightInputs<'a>> {
        light_inputs(&self.lights, occluders, self.revision)
    }

    /// The scene's triangles, where they are in this frame. Uploaded when first asked for.
    pub(crate) fn occluders(
        &self,
        shot_frame: &ShotFrame,
        gpu: &Gpu,
    ) -> Result<Vec<Occluder<'_>>, Failure> {
        let uploaded = match self.occluders.get() {
            Some(uploaded) => uploaded,
            None => {
                let uploaded = SceneOccluders::new(&gpu.device, &shot_frame.scene);
                let uploaded = uploaded.map_err(Failure::device)?;
                self.occluders.get_or_init(|| uploaded)
            }
        };
        Ok(uploaded.places(&shot_frame.scene))
    }

    /// Reads depth buffer and light maps back, for the CPU to work on the very same. Waits for the device.
    pub(crate) fn read(&self, gpu: &Gpu) -> Result<Buffers, Failure> {
        let Gpu { device, queue, .. } = gpu;
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
            depth: self.read_depth(gpu)?,
            lights: lights.map_err(Failure::device)?,
        })
    }

    /// Reads the depth buffer back. Waits for the device.
    pub(crate) fn read_depth(&self, gpu: &Gpu) -> Result<Vec<f32>, Failure> {
        let depth = readback::texture_f32(&gpu.device, &gpu.queue, self.g_buffer.depth());
        depth.map_err(Failure::device)
    }

    /// Textures, by what they are for \[bytes].
    pub(crate) fn bytes(&self) -> [(&'static str, u64); 3] {
        let lights = self.lights.iter().map(LightTargets::bytes).sum();
        let occluders = self.occluders.get().map_or(0, SceneOccluders::bytes);
        [
            ("G-buffer", self.g_buffer.bytes()),
            ("light maps", lights),
            ("occluders", occluders),
        ]
    }
}
