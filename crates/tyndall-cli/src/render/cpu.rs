//! The pipeline on the CPU: what the GPU rasterises is traced, with nothing installed.

use tyndall::{
    cpu::{CpuInputs, CpuLightInputs, GlassMap, ShadowMap},
    frame::{Frame, Light},
};
use tyndall_scene::{
    shading::shade,
    trace::{GBuffer, GLASS_LAYERS},
};

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
        in_scatter(setup, needs, &g_buffer, &lights, stages)?
    } else {
        Vec::new()
    };
    let surface = if needs.surface {
        stages.run("shade surfaces", |_| {
            shade(&g_buffer, &setup.frame, &lights)
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
    })
}

/// What a light sees; nothing where nobody asks.
#[derive(Default)]
struct LightMaps {
    shadow_map: Option<ShadowMap>,
    glass: Option<GlassMap>,
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

fn light_inputs<'a>(setup: &'a Setup, maps: &'a [LightMaps]) -> Vec<CpuLightInputs<'a>> {
    maps.iter()
        .zip(&setup.lights)
        .map(|(maps, light)| CpuLightInputs {
            shadow_map: maps.shadow_map.as_ref(),
            glass: maps.glass.as_ref(),
            texture: light.texture.as_ref(),
        })
        .collect()
}

fn in_scatter(
    setup: &Setup,
    needs: Needs,
    g_buffer: &GBuffer,
    lights: &[CpuLightInputs<'_>],
    stages: &mut Stages,
) -> Result<Vec<[f32; 3]>, Failure> {
    let mut frame = setup.frame.clone();
    if !needs.light_maps {
        forget_shadow_maps(&mut frame);
    }
    let inputs = CpuInputs {
        size: setup.size,
        depth: &g_buffer.depth,
        lights,
        occluders: Some(&setup.tracer),
    };
    let name = format!("in-scatter by {}", frame.technique.info().name);
    let result = stages.run(&name, |progress| {
        tyndall::cpu::render(&frame, &inputs, progress)
    });
    Ok(rgb(&result.map_err(Failure::input)?.pixels))
}

/// For techniques that trace shadows: a frame whose lights promise no maps needs none.
fn forget_shadow_maps(frame: &mut Frame) {
    for light in &mut frame.lights {
        light.shadow = None;
    }
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
