//! The phase function, of mean visibilities at full resolution.

use super::resources::{Image, Resources, buffer, texture};
use crate::gpu::{
    pass::Pass,
    program::ScreenProgram,
    scope::{LightScope, Shared},
};

pub(super) struct Finish(ScreenProgram);

impl Finish {
    pub(super) fn new(device: &wgpu::Device, shared: &Shared) -> Self {
        let module = "techniques::epipolar_sampling::finish";
        Self(ScreenProgram::new(device, shared, module, "finish"))
    }

    pub(super) fn pass(&self, scope: &LightScope<'_>, r: &Resources, image: &Image) -> Pass {
        let resources = [buffer(&r.params), texture(&image.values)];
        scope.full_screen(&self.0, "phase function", &resources)
    }
}
