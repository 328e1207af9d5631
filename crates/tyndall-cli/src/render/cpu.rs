//! The pipeline on the CPU: what the GPU rasterises is traced, with nothing installed.

use tyndall::{
    cpu::{CpuInputs, CpuLightInputs, GlassMap, Progress, ShadowMap},
    frame::{Frame, Light},
    techniques::TechniqueChoice,
};
use tyndall_scene::{shading::shade, trace::GLASS_LAYERS};

use super::{Needs, Rendered, depth_layer, distances, rgb, transmittances};
use crate::{failure::Failure, layer::Layer, picture::Picture, progress::Stages, setup::Setup};

pub(super) fn render(
    setup: &Setup,
    needs: Needs,
    layers: &[Layer],
    stages: &mut Stages,
) -> Result<Rendered, Failure> {
    let (camera, size) = (&setup.frame.camera, setup.size);
    let g_buffer = stages.run("trace G-buffer", |progress| {
        setup.tracer.g_buffer(camera, size, progress)
    });
    let maps = LightMaps::trace_all(setup, needs, stages);
    let lights = light_inputs(setup, &maps);
    let in_scatter = if needs.in_scatter {
        let name = format!(
            "in-scatter by {}",
            super::technique(&setup.techniques).info().name
        );
        stages.run(&name, |progress| {
            in_scatter(
                setup,
                setup.frame.clone(),
                &g_buffer.depth,
                &lights,
                &setup.techniques,
                progress,
            )
        })?
    } else {
        Vec::new()
    };
    let surface = if needs.surface {
        stages.run("shade surfaces", |_| {
            shade(&g_buffer, &setup.frame, &lights, Some(&**setup.tracer))
        })
    } else {
        Vec::new()
    };
    let pixels = |layer| match layer {
        Layer::Inscatter => in_scatter.clone(),
        Layer::Surface => surface.clone(),
        Layer::Final => composite(setup, &g_buffer.depth, &surface, &in_scatter),
        Layer::Depth | Layer::Transmittance => depth_layer(layer, setup, &g_buffer.depth).pixels,
    };
    let picture = |layer| Picture {
        size,
        pixels: pixels(layer),
    };
    Ok(Rendered {
        layers: layers
            .iter()
            .map(|&layer| (layer, picture(layer)))
            .collect(),
        passes: Vec::new(),
        bytes: vec![("light maps", maps.iter().map(LightMaps::bytes).sum())],
        counts: Vec::new(),
    })
}

/// The pictures that in-scattered light is computed from.
pub(crate) struct Buffers {
    /// What a depth buffer holds, in the camera's convention.
    pub(crate) depth: Vec<f32>,
    /// One a light.
    pub(crate) lights: Vec<LightMaps>,
}

impl Buffers {
    /// Casts the rays of the camera and of every light.
    pub(crate) fn trace(setup: &Setup, stages: &mut Stages) -> Self {
        Self {
            depth: stages.run("trace depth", |progress| depth(setup, progress)),
            lights: LightMaps::trace_all(setup, Needs::IN_SCATTER, stages),
        }
    }
}

/// What a depth buffer holds, by the rays of the camera.
pub(crate) fn depth(setup: &Setup, progress: Progress<'_>) -> Vec<f32> {
    let g_buffer = setup
        .tracer
        .g_buffer(&setup.frame.camera, setup.size, progress);
    g_buffer.depth
}

/// What a light sees; nothing where nobody asks.
#[derive(Default)]
pub(crate) struct LightMaps {
    pub(crate) shadow_map: Option<ShadowMap>,
    pub(crate) glass: Option<GlassMap>,
}

impl LightMaps {
    fn trace_all(setup: &Setup, needs: Needs, stages: &mut Stages) -> Vec<Self> {
        let lights = setup.frame.lights.iter().zip(&setup.lights).enumerate();
        lights
            .map(|(index, (light, extra))| {
                if needs.light_maps {
                    Self::trace(setup, index, light, extra.map_size, stages)
                } else {
                    Self::default()
                }
            })
            .collect()
    }

    fn trace(
        setup: &Setup,
        index: usize,
        light: &Light,
        size: [u32; 2],
        stages: &mut Stages,
    ) -> Self {
        let Some(projection) = &light.shadow else {
            return Self::default();
        };
        let (tracer, emitter) = (&setup.tracer, &light.emitter);
        let shadow_map = stages.run(&format!("trace shadow map {index}"), |progress| {
            tracer.shadow_map(emitter, projection, size, progress)
        });
        let glass = tracer.has_tinted_glass().then(|| {
            stages.run(&format!("trace glass map {index}"), |progress| {
                tracer.glass_map(emitter, projection, size, GLASS_LAYERS, progress)
            })
        });
        Self {
            shadow_map: Some(shadow_map),
            glass: glass.flatten(),
        }
    }

    fn bytes(&self) -> u64 {
        let depth = self.shadow_map.as_ref().map(|map| map.depth.as_slice());
        let glass = self.glass.as_ref().map(|map| map.texels.as_slice());
        (depth.map_or(0, size_of_val) + glass.map_or(0, size_of_val)) as u64
    }
}

/// The lights' pictures, as tyndall takes them.
pub(crate) fn light_inputs<'a>(setup: &'a Setup, maps: &'a [LightMaps]) -> Vec<CpuLightInputs<'a>> {
    maps.iter()
        .zip(&setup.lights)
        .map(|(maps, light)| CpuLightInputs {
            shadow_map: maps.shadow_map.as_ref(),
            glass: maps.glass.as_ref(),
            texture: light.texture.as_deref(),
        })
        .collect()
}

/// In-scattered light of a frame of the setup [W/(m^2 sr)]. A light whose map isn't among `lights` promises none.
pub(crate) fn in_scatter(
    setup: &Setup,
    mut frame: Frame,
    depth: &[f32],
    lights: &[CpuLightInputs<'_>],
    techniques: &TechniqueChoice,
    progress: Progress<'_>,
) -> Result<Vec<[f32; 3]>, Failure> {
    for (light, inputs) in frame.lights.iter_mut().zip(lights) {
        light.shadow = light.shadow.filter(|_| inputs.shadow_map.is_some());
    }
    let inputs = CpuInputs {
        size: setup.size,
        depth,
        lights,
        occluders: Some(&**setup.tracer),
    };
    let result = tyndall::cpu::render(&frame, &inputs, techniques, progress);
    Ok(rgb(&result.map_err(Failure::input)?.pixels))
}

/// surface * transmittance + in-scatter, in double precision.
fn composite(
    setup: &Setup,
    depth: &[f32],
    surface: &[[f32; 3]],
    in_scatter: &[[f32; 3]],
) -> Vec<[f32; 3]> {
    let distances = distances(&setup.frame.camera, setup.size, depth);
    let transmittance = transmittances(&setup.frame.medium, &distances);
    let pixels = surface.iter().zip(&transmittance).zip(in_scatter);
    pixels
        .map(|((surface, transmittance), in_scatter)| {
            std::array::from_fn(|i| {
                let attenuated = f64::from(surface[i]) * f64::from(transmittance[i]);
                (attenuated + f64::from(in_scatter[i])) as f32
            })
        })
        .collect()
}
