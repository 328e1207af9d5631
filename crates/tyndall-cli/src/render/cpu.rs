//! Rendering on the CPU: what the GPU rasterises is traced, with nothing installed.

use tyndall::{
    cpu::{CpuInputs, CpuLightInputs},
    techniques::{Backends, TechniqueChoice},
};
use tyndall_scene::shading::shade;

use super::{
    buffers::LightMaps,
    layers::{Rendered, depth_layer, distances, rgb, transmittances},
    needs::{Needs, is_traced},
};
use crate::{
    failure::Failure, layer::Layer, load::ShotFrame, picture::Picture, progress::Progress,
};

pub(super) fn render(
    shot_frame: &ShotFrame,
    needs: Needs,
    layers: &[Layer],
    progress: &mut Progress,
) -> Result<Rendered, Failure> {
    let (camera, size) = (&shot_frame.frame.camera, shot_frame.size);
    let g_buffer = progress.run("trace G-buffer", |report| {
        shot_frame.tracer.g_buffer(camera, size, report)
    });
    let techniques = shot_frame.techniques_on(Backends::Cpu);
    let is_read = |light: usize| !is_traced(&techniques[light]);
    let maps = LightMaps::trace_all(shot_frame, needs, is_read, progress);
    let lights = light_inputs(shot_frame, &maps);
    let in_scatter = if needs.in_scatter {
        let name = format!("in-scatter by {}", names(shot_frame));
        progress.run(&name, |report| {
            let techniques = &shot_frame.techniques;
            in_scatter(shot_frame, techniques, &g_buffer.depth, &lights, report)
        })?
    } else {
        Vec::new()
    };
    let surface = if needs.surface {
        progress.run("shade surfaces", |_| {
            shade(
                &g_buffer,
                &shot_frame.frame,
                &lights,
                Some(&**shot_frame.tracer),
            )
        })
    } else {
        Vec::new()
    };
    let picture = |layer| {
        let pixels = match layer {
            Layer::Inscatter => in_scatter.clone(),
            Layer::Surface => surface.clone(),
            Layer::Final => composite(shot_frame, &g_buffer.depth, &surface, &in_scatter),
            Layer::Depth | Layer::Transmittance => {
                return depth_layer(layer, shot_frame, &g_buffer.depth);
            }
        };
        Picture { size, pixels }
    };
    Ok(Rendered {
        layers: layers
            .iter()
            .map(|&layer| (layer, picture(layer)))
            .collect(),
        techniques: shot_frame.techniques_on(Backends::Cpu),
        passes: Vec::new(),
        bytes: vec![("light maps", maps.iter().map(LightMaps::bytes).sum())],
        counts: Vec::new(),
    })
}

/// The lights' inputs, as the library takes them.
pub(crate) fn light_inputs<'a>(
    shot_frame: &'a ShotFrame,
    maps: &'a [LightMaps],
) -> Vec<CpuLightInputs<'a>> {
    maps.iter()
        .zip(&shot_frame.lights)
        .map(|(maps, light)| CpuLightInputs {
            shadow_map: maps.shadow_map.as_ref(),
            glass: maps.glass.as_ref(),
            texture: light.texture.as_deref(),
        })
        .collect()
}

/// In-scattered light [W/(m^2 sr)]. A light whose map isn't among `lights` promises none.
pub(crate) fn in_scatter(
    shot_frame: &ShotFrame,
    techniques: &TechniqueChoice,
    depth: &[f32],
    lights: &[CpuLightInputs<'_>],
    report: tyndall::cpu::Progress<'_>,
) -> Result<Vec<[f32; 3]>, Failure> {
    let mut frame = shot_frame.frame.clone();
    for (light, inputs) in frame.lights.iter_mut().zip(lights) {
        light.shadow = light.shadow.filter(|_| inputs.shadow_map.is_some());
    }
    let inputs = CpuInputs {
        size: shot_frame.size,
        depth,
        lights,
        occluders: Some(&**shot_frame.tracer),
    };
    let result = tyndall::cpu::render(&frame, &inputs, techniques, report);
    Ok(rgb(&result.map_err(Failure::input)?.pixels))
}

/// Names of the lights' techniques, each once.
fn names(shot_frame: &ShotFrame) -> String {
    let mut names: Vec<&str> = Vec::new();
    for technique in shot_frame.techniques_on(Backends::Cpu) {
        if !names.contains(&technique.info().name) {
            names.push(technique.info().name);
        }
    }
    names.join(" and ")
}

/// surface * transmittance + in-scatter, in double precision.
fn composite(
    shot_frame: &ShotFrame,
    depth: &[f32],
    surface: &[[f32; 3]],
    in_scatter: &[[f32; 3]],
) -> Vec<[f32; 3]> {
    let distances = distances(&shot_frame.frame.camera, shot_frame.size, depth);
    let transmittance = transmittances(&shot_frame.frame.medium, &distances);
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
