//! Points of the cloud onto the maps of a batch.

use std::sync::Arc;

use super::buffers::Buffers;
use crate::{
    gpu::{
        pass::Pass,
        program::ComputeProgram,
        scope::{LightScope, Shared},
    },
    passes::fill::Fill,
    shader::constant,
};

/// Points that a thread takes.
const POINTS_A_THREAD: u32 = 8;

pub(super) struct Splat {
    fill: Arc<Fill>,
    splat: ComputeProgram,
}

impl Splat {
    pub(super) fn new(device: &wgpu::Device, shared: &Shared) -> Self {
        let module = "passes::imperfect::splat";
        Self {
            fill: shared.programs(device),
            splat: ComputeProgram::new(device, shared, module, "imperfect_splat").for_all_lights(),
        }
    }

    /// Empties the maps and draws the batch's points on them.
    pub(super) fn pass(
        &self,
        scope: &mut LightScope<'_>,
        buffers: &Buffers,
        index: u32,
        cloud: &wgpu::Buffer,
    ) -> Pass {
        let batch = buffers.batches.values[index as usize];
        let nothing = constant("IMPERFECT_NOTHING");
        let empty = self
            .fill
            .dispatch(scope, "no surface", &buffers.maps, nothing);
        let resources = [
            buffers.batches.binding(index),
            buffers.samples.as_entire_binding(),
            cloud.as_entire_binding(),
            buffers.maps.as_entire_binding(),
        ];
        let threads = batch.points.div_ceil(POINTS_A_THREAD);
        let workgroups = self.splat.workgroups([threads, batch.count, 1]);
        let splat = scope.dispatch(&self.splat, &resources, workgroups);
        Pass::compute(scope.pass_name("splat points"), vec![empty, splat])
    }
}
