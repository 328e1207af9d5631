//! The holes of the maps of a batch, filled.

use super::buffers::Buffers;
use crate::{
    gpu::{
        pass::Pass,
        program::ComputeProgram,
        scope::{LightScope, Shared},
    },
    shader::constant,
};

pub(super) struct PullPush(ComputeProgram);

impl PullPush {
    pub(super) fn new(device: &wgpu::Device, shared: &Shared) -> Self {
        let module = "passes::imperfect::pull_push";
        Self(ComputeProgram::new(device, shared, module, "pull_push").for_all_lights())
    }

    pub(super) fn pass(&self, scope: &LightScope<'_>, buffers: &Buffers, index: u32) -> Pass {
        let batch = buffers.batches.values[index as usize];
        let resources = [
            buffers.batches.binding(index),
            buffers.maps.as_entire_binding(),
        ];
        let blocks = batch.side.div_ceil(constant("PULL_BLOCK"));
        let workgroups = self.0.workgroups([blocks, blocks, batch.count]);
        scope.compute(&self.0, "pull-push", &resources, workgroups)
    }
}
