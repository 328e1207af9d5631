//! A renderer of layers, on the GPU or on the CPU.

use tyndall::{
    frame::{Emitter, Light},
    temporal::{Reuse, ReuseMask, ReuseShow},
};

use super::{cpu, gpu::GpuRenderer, layers::Rendered, needs::Needs};
use crate::{
    backend::Backend,
    failure::Failure,
    layer::Layer,
    load::ShotFrame,
    progress::Progress,
    shot::{Temporal, TemporalMask, TemporalShow},
};

/// Renders the layers (at least one).
///
/// # Errors
/// [`Failure::Input`] where the technique can't do what the shot asks, [`Failure::Device`] where the GPU fails.
pub fn render(
    shot_frame: &ShotFrame,
    backend: &Backend,
    layers: &[Layer],
    progress: &mut Progress,
) -> Result<Rendered, Failure> {
    Renderer::new(shot_frame, None, backend, layers, progress)?.render(shot_frame, progress)
}

/// A renderer of a shot's frames.
pub struct Renderer<'a> {
    layers: &'a [Layer],
    needs: Needs,
    /// `None` on the CPU.
    gpu: Option<GpuRenderer<'a>>,
}

impl<'a> Renderer<'a> {
    /// Prepares for frames that differ from this one in nodes' places, camera, medium, and lights' places and textures alone.
    ///
    /// # Errors
    /// As for [`render`].
    pub fn new(
        shot_frame: &ShotFrame,
        temporal: Option<&Temporal>,
        backend: &'a Backend,
        layers: &'a [Layer],
        progress: &mut Progress,
    ) -> Result<Self, Failure> {
        let needs = Needs::of(layers, &shot_frame.techniques_on(backend.side()));
        let gpu = match backend {
            Backend::Cpu => {
                if temporal.is_some() {
                    eprintln!("note: the CPU computes every frame whole, whatever [temporal] says");
                }
                None
            }
            Backend::Gpu(gpu) => {
                let is_area = |light: &Light| matches!(light.emitter, Emitter::Rect { .. });
                let has_area = shot_frame.frame.lights.iter().any(is_area);
                if has_area && shot_frame.tracer.has_tinted_glass() {
                    eprintln!("note: on the GPU coloured glass tints no light of rectangles");
                }
                let reuse = temporal.map(reuse);
                Some(GpuRenderer::new(shot_frame, reuse, gpu, needs, progress)?)
            }
        };
        Ok(Self { layers, needs, gpu })
    }

    /// Renders the layers of a frame.
    ///
    /// # Errors
    /// As for [`render`].
    pub fn render(
        &mut self,
        shot_frame: &ShotFrame,
        progress: &mut Progress,
    ) -> Result<Rendered, Failure> {
        match &mut self.gpu {
            None => cpu::render(shot_frame, self.needs, self.layers, progress),
            Some(gpu) => gpu.render(shot_frame, self.layers, progress),
        }
    }
}

/// `[temporal]` as the library takes it.
fn reuse(temporal: &Temporal) -> Reuse {
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
