//! The gathered light, to the output.

use super::buffers::Buffers;
use crate::gpu::{
    pass::Pass,
    program::ScreenProgram,
    scope::{LightScope, Shared},
};

pub(super) struct Resolve(ScreenProgram);

impl Resolve {
    pub(super) fn new(device: &wgpu::Device, shared: &Shared) -> Self {
        let module = "techniques::imperfect_voxelized::resolve";
        Self(ScreenProgram::new(device, shared, module, "ivsv_resolve"))
    }

    pub(super) fn pass(&self, scope: &LightScope<'_>, buffers: &Buffers) -> Pass {
        let resources = buffers.of_batch(0, [buffers.sums.as_entire_binding()]);
        scope.full_screen(&self.0, "resolve", &resources)
    }
}
