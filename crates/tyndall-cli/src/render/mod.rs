//! From a setup to layers, on the GPU or on the CPU.

mod backend;
pub(crate) mod cpu;
pub(crate) mod gpu;

pub use backend::{AdapterDescription, Backend, Gpu};
pub(crate) use cpu::{Buffers, LightMaps};

use tyndall::{
    camera::CameraRays,
    frame::{Camera, Emitter, Light, Medium},
    physics::medium::Optics,
    techniques::{Technique, TechniqueChoice, reference},
    temporal::{Reuse, ReuseMask, ReuseShow},
};

use crate::{
    failure::Failure,
    layer::{Layer, Layers},
    picture::Picture,
    progress::Stages,
    setup::Setup,
    shot::{Temporal, TemporalMask, TemporalShow},
};

/// What a backend rendered, and what that took.
pub struct Rendered {
    /// The layers, in the order they were asked for.
    pub layers: Layers,
    /// GPU passes and their milliseconds, in order; empty on the CPU and without timestamps.
    pub passes: Vec<(String, f64)>,
    /// Textures and buffers, by what they are for [bytes].
    pub bytes: Vec<(&'static str, u64)>,
    /// What the technique counts; empty on the CPU.
    pub counts: Vec<(String, u64)>,
}

/// Renders the layers (at least one).
///
/// # Errors
/// [`Failure::Input`] where the technique can't do what the shot asks, [`Failure::Device`] where the GPU fails.
pub fn render(
    setup: &Setup,
    backend: &Backend,
    layers: &[Layer],
    stages: &mut Stages,
) -> Result<Rendered, Failure> {
    Session::new(setup, None, backend, layers, stages)?.render(setup, stages)
}

/// What renders frame after frame of a shot.
pub struct Session<'a> {
    layers: &'a [Layer],
    needs: Needs,
    pipeline: Option<gpu::Pipeline<'a>>,
}

impl<'a> Session<'a> {
    /// Gets ready for frames that differ from this one in nodes' places, camera, lights' places and pictures, and medium alone.
    ///
    /// # Errors
    /// As for [`render`].
    pub fn new(
        setup: &Setup,
        temporal: Option<&Temporal>,
        backend: &'a Backend,
        layers: &'a [Layer],
        stages: &mut Stages,
    ) -> Result<Self, Failure> {
        let needs = Needs::of(layers, &technique(&setup.techniques));
        let pipeline = match backend {
            Backend::Cpu => {
                if temporal.is_some() {
                    eprintln!("note: the CPU computes every frame whole, whatever [temporal] says");
                }
                None
            }
            Backend::Gpu(gpu) => {
                let is_area = |light: &Light| matches!(light.emitter, Emitter::Rect { .. });
                let has_area = setup.frame.lights.iter().any(is_area);
                if has_area && setup.tracer.has_tinted_glass() {
                    eprintln!("note: on the GPU coloured glass tints no light of rectangles");
                }
                let reuse = temporal.map(reuse);
                Some(gpu::Pipeline::new(setup, reuse, gpu, needs, stages)?)
            }
        };
        Ok(Self {
            layers,
            needs,
            pipeline,
        })
    }

    /// Renders the layers of a frame.
    ///
    /// # Errors
    /// As for [`render`].
    pub fn render(&mut self, setup: &Setup, stages: &mut Stages) -> Result<Rendered, Failure> {
        match &mut self.pipeline {
            None => cpu::render(setup, self.needs, self.layers, stages),
            Some(pipeline) => pipeline.render(setup, self.layers, stages),
        }
    }
}

/// The parts of the pipeline that the layers need.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Needs {
    in_scatter: bool,
    surface: bool,
    /// Of rectangular lights, by the technique.
    surface_shadows: bool,
    light_maps: bool,
}

impl Needs {
    /// In-scattered light by any technique, and nothing else.
    pub(crate) const IN_SCATTER: Self = Self {
        in_scatter: true,
        surface: false,
        surface_shadows: false,
        light_maps: true,
    };

    fn of(layers: &[Layer], technique: &Technique) -> Self {
        let any = |wanted: [Layer; 2]| layers.iter().any(|layer| wanted.contains(layer));
        let surface = any([Layer::Final, Layer::Surface]);
        let surface_shadows = surface && technique.info().shadows_surfaces;
        let in_scatter = surface_shadows || any([Layer::Final, Layer::Inscatter]);
        Self {
            in_scatter,
            surface,
            surface_shadows,
            light_maps: surface || (in_scatter && reads_shadow_maps(technique)),
        }
    }
}

pub(crate) fn reads_shadow_maps(technique: &Technique) -> bool {
    !matches!(
        technique,
        Technique::Reference(reference::Params {
            visibility: reference::Visibility::Traced,
            ..
        })
    )
}

/// Reuse as tyndall takes it.
pub(crate) fn reuse(temporal: &Temporal) -> Reuse {
    Reuse {
        frames: temporal.reuse,
        mask: match temporal.mask {
            TemporalMask::Change => ReuseMask::Change,
            TemporalMask::Geometry => ReuseMask::Geometry,
        },
        reproject: temporal.reproject,
        show: match temporal.show {
            TemporalShow::Light => ReuseShow::Light,
            TemporalShow::Mask => ReuseShow::Mask,
            TemporalShow::Age => ReuseShow::Age,
        },
    }
}

/// The technique of the shot.
pub(crate) fn technique(techniques: &TechniqueChoice) -> Technique {
    techniques.all.clone().unwrap_or_default()
}

fn reads_occluders(technique: &Technique, reuse: Option<&Reuse>) -> bool {
    let mask = reuse.map(|reuse| reuse.mask);
    technique.info().reads.occluders || mask == Some(ReuseMask::Geometry)
}

/// Length of each pixel's view ray [m].
fn distances(camera: &Camera, size: [u32; 2], depth: &[f32]) -> Vec<f64> {
    let rays = CameraRays::new(camera, size);
    let pixels = (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| (x, y)));
    pixels
        .zip(depth)
        .map(|((x, y), depth)| rays.ray(x, y, *depth).length)
        .collect()
}

/// Transmittance along each pixel's view ray.
fn transmittances(medium: &Medium, distances: &[f64]) -> Vec<[f32; 3]> {
    let optics = Optics::new(medium);
    distances
        .iter()
        .map(|distance| optics.transmittance(*distance).as_vec3().to_array())
        .collect()
}

/// The layers that both backends make the same way, from the depth buffer: distance and transmittance.
fn depth_layer(layer: Layer, setup: &Setup, depth: &[f32]) -> Picture {
    let distances = distances(&setup.frame.camera, setup.size, depth);
    let pixels = match layer {
        Layer::Transmittance => transmittances(&setup.frame.medium, &distances),
        _ => distances.iter().map(|d| [*d as f32; 3]).collect(),
    };
    Picture {
        size: setup.size,
        pixels,
    }
}

/// Drops the fourth channel.
fn rgb(pixels: &[[f32; 4]]) -> Vec<[f32; 3]> {
    pixels.iter().map(|[r, g, b, _]| [*r, *g, *b]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_layers_need_is_computed() {
        let march = Technique::default();
        let voxels = Technique::from_name("ivsv").unwrap();
        let traced = Technique::Reference(reference::Params::default());
        for (layers, technique, [in_scatter, surface, surface_shadows, light_maps]) in [
            (&[Layer::Depth][..], &march, [false; 4]),
            (&[Layer::Inscatter], &march, [true, false, false, true]),
            (&[Layer::Inscatter], &traced, [true, false, false, false]),
            (&[Layer::Final], &traced, [true, true, false, true]),
            (
                &[Layer::Surface, Layer::Depth],
                &march,
                [false, true, false, true],
            ),
            (&[Layer::Inscatter], &voxels, [true, false, false, true]),
            (&[Layer::Surface], &voxels, [true; 4]),
        ] {
            let expected = Needs {
                in_scatter,
                surface,
                surface_shadows,
                light_maps,
            };
            assert_eq!(Needs::of(layers, technique), expected, "{layers:?}");
        }
    }
}
