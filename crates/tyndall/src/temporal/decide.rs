//! Decides whether this frame keeps any pixels, and how much the passes after it do.

use super::buffers::Buffers;
use crate::gpu::{
    pass::Dispatch,
    program::ComputeProgram,
    scope::{LightScope, Shared},
};

pub(super) fn program(device: &wgpu::Device, shared: &Shared) -> ComputeProgram {
    ComputeProgram::new(device, shared, "temporal::decide", "decide").for_all_lights()
}

pub(super) fn dispatch(
    program: &ComputeProgram,
    buffers: &Buffers,
    scope: &LightScope<'_>,
) -> Dispatch {
    let resources =
        [&buffers.params, &buffers.state, &buffers.sizes].map(|b| b.as_entire_binding());
    scope.dispatch(program, &resources, [1; 3])
}
