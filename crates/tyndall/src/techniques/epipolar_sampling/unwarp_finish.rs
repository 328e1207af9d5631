//! Stage 10 and the phase function in one, at full resolution.

use super::resources::{Image, Resources, buffer, texture};
use crate::gpu::{
    pass::Pass,
    program::ScreenProgram,
    scope::{LightScope, Shared},
};

pub(super) struct UnwarpFinish(ScreenProgram);

impl UnwarpFinish {
    pub(super) fn new(device: &wgpu::Device, shared: &Shared) -> Self {
        let module = "techniques::epipolar_sampling::unwarp_finish";
        Self(ScreenProgram::new(device, shared, module, "unwarp_finish"))
    }

    pub(super) fn pass(&self, scope: &LightScope<'_>, r: &Resources, image: &Image) -> Pass {
        let resources = [
            buffer(&r.params),
            buffer(&image.list),
            buffer(&r.counts),
            buffer(&r.lines),
            texture(&r.samples),
            buffer(&r.dispatches),
        ];
        scope.full_screen(&self.0, "unwarping and phase function", &resources)
    }
}
