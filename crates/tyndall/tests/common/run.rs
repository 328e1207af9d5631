//! Stages as frames of one view.

use tyndall::{
    CountValue, Effect, EffectView, FrameInputs, LightInputs, Occluder, PrepareError,
    techniques::{Technique, TechniqueChoice},
    temporal::Reuse,
};
use tyndall_testkit::device::TestDevice;

use super::{SIZE, Stage, gpu as on};

/// A view that is rendered frame after frame.
pub(crate) struct Run<'a> {
    gpu: &'a TestDevice,
    effect: &'a Effect,
    view: EffectView,
    size: [u32; 2],
    /// The revision of all shadow maps.
    pub(crate) revision: Option<u64>,
}

impl<'a> Run<'a> {
    pub(crate) fn new(gpu: &'a TestDevice, effect: &'a Effect, reuse: Option<Reuse>) -> Self {
        Self::sized(SIZE, gpu, effect, reuse)
    }

    /// A run of another size than the stages of this folder.
    pub(crate) fn sized(
        size: [u32; 2],
        gpu: &'a TestDevice,
        effect: &'a Effect,
        reuse: Option<Reuse>,
    ) -> Self {
        let mut view = effect.create_view(&gpu.device, size).expect("a good size");
        view.set_reuse(reuse);
        Self {
            gpu,
            effect,
            view,
            size,
            revision: None,
        }
    }

    pub(crate) fn prepare(&mut self, stage: &Stage, technique: &Technique) {
        self.prepare_with(stage, technique, None)
            .expect("a good stage");
    }

    pub(crate) fn prepare_with(
        &mut self,
        stage: &Stage,
        technique: &Technique,
        occluders: Option<&[Occluder<'_>]>,
    ) -> Result<(), PrepareError> {
        let frame = stage.frame.clone();
        let frame_by = TechniqueChoice::from(technique.clone());
        let uploaded = on::Uploaded::sized(self.size, self.gpu, stage);
        let lights = uploaded.light_inputs();
        let shadow_revision = self.revision;
        let with_occluders = |light| LightInputs {
            occluders,
            shadow_revision,
            ..light
        };
        let lights: Vec<LightInputs<'_>> = lights.into_iter().map(with_occluders).collect();
        let inputs = FrameInputs {
            depth: &uploaded.depth,
            lights: &lights,
        };
        let TestDevice { device, queue, .. } = self.gpu;
        self.effect
            .prepare(device, queue, &mut self.view, &inputs, &frame, &frame_by)
    }

    pub(crate) fn view(&mut self) -> &mut EffectView {
        &mut self.view
    }

    /// The output, as bits.
    pub(crate) fn frame(&mut self, stage: &Stage, technique: &Technique) -> Vec<[u32; 4]> {
        self.prepare(stage, technique);
        self.record()
    }

    pub(crate) fn record(&mut self) -> Vec<[u32; 4]> {
        let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
        self.effect.record(&mut encoder, &mut self.view, None);
        self.gpu.queue.submit([encoder.finish()]);
        let output = self.view.output().texture();
        self.gpu.read_texture(output).expect("readable")
    }

    /// Stale pixels of each light.
    pub(crate) fn stale(&self) -> Vec<u32> {
        let stale = self
            .view
            .counts()
            .iter()
            .filter(|c| c.name.starts_with("stale"));
        stale
            .map(|count| {
                let CountValue::Written { buffer, offset } = &count.value else {
                    unreachable!("it is counted on the device");
                };
                let words: Vec<u32> = self.gpu.read_buffer(buffer).expect("readable");
                words[*offset as usize / 4]
            })
            .collect()
    }
}
