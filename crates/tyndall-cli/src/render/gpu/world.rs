//! What an engine has before volumetric light comes in: the scene on the device, a depth buffer, shadow maps.

use std::cell::OnceCell;

use glam::Affine3A;
use tyndall::{
    LightInputs, Occluder, SurfaceShadows, frame::Light, gpu::PassTimer, temporal::Reuse,
};
use tyndall_scene::gpu::{
    GBufferTargets, SceneOccluders, SceneRenderer, SurfaceLights,
    readback::{self, ReadbackError},
};
use wgpu::{CommandEncoder, TextureFormat, TextureView, TextureViewDescriptor};

use super::lights::{LightTargets, light_inputs};
use crate::{
    failure::Failure,
    render::{Buffers, Gpu, LightMaps, Needs, reads_occluders},
    setup::Setup,
};

/// An uploaded scene, and the textures that its camera and its lights are drawn on.
pub(crate) struct World {
    renderer: SceneRenderer,
    g_buffer: GBufferTargets,
    lights: Vec<LightTargets>,
    occluders: OnceCell<SceneOccluders>,
    /// What the lights' maps show, and a number that changes with it.
    shown: Shown,
    revision: u64,
}

/// All that the lights' maps depend on.
#[derive(PartialEq)]
struct Shown {
    nodes: Vec<Affine3A>,
    lights: Vec<Light>,
}

impl Shown {
    fn new(setup: &Setup) -> Self {
        let nodes = setup.scene.nodes.iter();
        Self {
            nodes: nodes.map(|node| node.parent_from_local).collect(),
            lights: setup.frame.lights.clone(),
        }
    }
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
            occluders: OnceCell::new(),
            shown: Shown::new(setup),
            revision: 0,
        })
    }

    /// Moves the nodes to where they are in this setup, which differs from the one given first in the places of nodes,
    /// camera and lights, and in the lights' pictures alone.
    pub(crate) fn place(&mut self, setup: &Setup, gpu: &Gpu, needs: Needs) -> Result<(), Failure> {
        self.renderer.place(&gpu.queue, &setup.scene);
        let shown = Shown::new(setup);
        if self.shown != shown {
            self.shown = shown;
            self.revision += 1;
        }
        for (index, targets) in self.lights.iter_mut().enumerate() {
            // A light that turns towards the scene or away from it gets or loses its map.
            if !targets.suits(&setup.frame.lights[index], needs) {
                *targets = LightTargets::new(setup, index, gpu, &self.renderer, needs)?;
            }
            targets.follow(setup, index, gpu, needs)?;
        }
        Ok(())
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

    /// Records the lit surfaces on `target`; `visibility` is what direct light is multiplied by, light by light.
    pub(crate) fn draw_surfaces(
        &self,
        setup: &Setup,
        encoder: &mut CommandEncoder,
        target: &TextureView,
        visibility: &[Option<&TextureView>],
        timer: Option<&mut PassTimer>,
    ) {
        let lights = SurfaceLights {
            inputs: &self.light_inputs(None),
            visibility,
        };
        self.renderer
            .shade(encoder, target, &self.g_buffer, &setup.frame, lights, timer);
    }

    /// What the camera sees.
    pub(crate) fn g_buffer(&self) -> &GBufferTargets {
        &self.g_buffer
    }

    /// What shadows on the surfaces that the camera sees are made of.
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

    /// What blocks light, where it is in this setup; nothing where nobody asks. Uploaded when first asked for.
    pub(crate) fn occluders(
        &self,
        setup: &Setup,
        reuse: Option<&Reuse>,
        gpu: &Gpu,
    ) -> Result<Option<Vec<Occluder<'_>>>, Failure> {
        if !reads_occluders(&super::super::technique(&setup.techniques), reuse) {
            return Ok(None);
        }
        let uploaded = match self.occluders.get() {
            Some(uploaded) => uploaded,
            None => {
                let uploaded = SceneOccluders::new(&gpu.device, &setup.scene);
                let uploaded = uploaded.map_err(Failure::device)?;
                self.occluders.get_or_init(|| uploaded)
            }
        };
        Ok(Some(uploaded.places(&setup.scene)))
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
