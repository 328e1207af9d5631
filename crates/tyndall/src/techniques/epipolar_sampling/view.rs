//! The debug views, in place of the light.

use super::resources::{Image, Resources, buffer, texture};
use crate::gpu::{
    pass::Pass,
    program::ScreenProgram,
    scope::{LightScope, Shared},
};

pub(super) struct View(ScreenProgram);

impl View {
    pub(super) fn new(device: &wgpu::Device, shared: &Shared) -> Self {
        let module = "techniques::epipolar_sampling::view";
        Self(ScreenProgram::new(device, shared, module, "sampling_view").for_all_lights())
    }

    pub(super) fn pass(&self, scope: &LightScope<'_>, r: &Resources, image: &Image) -> Pass {
        let resources = [
            buffer(&r.params),
            texture(&image.values),
            buffer(&r.lines),
            buffer(&r.sources),
        ];
        scope.full_screen(&self.0, "view", &resources)
    }
}
