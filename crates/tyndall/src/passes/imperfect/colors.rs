//! The intensity of each sample.

use super::buffers::Buffers;
use crate::gpu::{
    pass::Pass,
    program::ComputeProgram,
    scope::{LightScope, Shared},
};

pub(super) struct Colors(ComputeProgram);

impl Colors {
    pub(super) fn new(device: &wgpu::Device, shared: &Shared) -> Self {
        let module = "passes::imperfect::colors";
        Self(ComputeProgram::new(
            device,
            shared,
            module,
            "imperfect_color",
        ))
    }

    /// Colours all `count` samples of a light.
    pub(super) fn pass(&self, scope: &LightScope<'_>, buffers: &Buffers, count: u32) -> Pass {
        let resources = [
            buffers.batches.binding(0),
            buffers.samples.as_entire_binding(),
            buffers.colors.as_entire_binding(),
        ];
        let workgroups = self.0.workgroups([count, 1, 1]);
        scope.compute(&self.0, "sample light", &resources, workgroups)
    }
}
