//! Finds the stale pixels, tile by tile of the image.

use super::buffers::Buffers;
use crate::{
    gpu::{
        pass::Dispatch,
        program::ComputeProgram,
        scope::{LightScope, Shared},
    },
    shader::constant,
};

pub(super) fn program(device: &wgpu::Device, shared: &Shared) -> ComputeProgram {
    ComputeProgram::new(device, shared, "temporal::tiles", "tiles")
}

/// Workgroups for an image of this size \[pixels].
pub(super) fn workgroups(program: &ComputeProgram, size: [u32; 2]) -> [u32; 3] {
    let [columns, rows] = size.map(|n| n.div_ceil(constant("REUSE_TILE")));
    program.workgroups([columns, rows, 1])
}

pub(super) fn dispatch(
    program: &ComputeProgram,
    witness: Option<&wgpu::Buffer>,
    buffers: &Buffers,
    scope: &mut LightScope<'_>,
) -> Dispatch {
    let absent = scope.storage("reuse no witness", size_of::<[f32; 2]>() as u64);
    let resources = [
        &buffers.params,
        &buffers.state,
        &buffers.blocks,
        &buffers.depth_seen,
        &buffers.age,
        &buffers.witness_seen,
        witness.unwrap_or(&absent),
        &buffers.found,
    ];
    let resources = resources.map(|buffer| buffer.as_entire_binding());
    scope.dispatch(program, &resources, buffers.mask_groups(0))
}
