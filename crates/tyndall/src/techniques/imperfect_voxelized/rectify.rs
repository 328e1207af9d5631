//! The voxels of a batch, set by the ends of light rays.

use std::sync::Arc;

use super::buffers::Buffers;
use crate::{
    gpu::{
        pass::Pass,
        program::ComputeProgram,
        scope::{LightScope, Shared},
    },
    passes::fill::Fill,
};

pub(super) struct Rectify {
    fill: Arc<Fill>,
    rectify: ComputeProgram,
}

impl Rectify {
    pub(super) fn new(device: &wgpu::Device, shared: &Shared) -> Self {
        let module = "techniques::imperfect_voxelized::rectify";
        Self {
            fill: shared.programs(device),
            rectify: ComputeProgram::new(device, shared, module, "ivsv_rectify"),
        }
    }

    /// Empties the voxels and sets one a light ray.
    pub(super) fn pass(&self, scope: &mut LightScope<'_>, buffers: &Buffers, index: u32) -> Pass {
        let batch = buffers.light.batches.values[index as usize];
        let clear = self.fill.dispatch(scope, "no voxel", &buffers.voxels, 0);
        let resources = buffers.of_batch(index, []);
        // A thread takes the light rays of a slice that share their words.
        let words = buffers.side / u32::BITS;
        let workgroups = self
            .rectify
            .workgroups([words * buffers.side, 1, batch.count]);
        let rectify = scope.dispatch(&self.rectify, &resources, workgroups);
        Pass::compute(scope.pass_name("voxelize"), vec![clear, rectify])
    }
}
