//! The light of a rectangle, to the output.

use crate::gpu::{
    pass::Pass,
    program::ScreenProgram,
    scope::{LightScope, Shared},
};

pub(super) struct ResolveArea(ScreenProgram);

impl ResolveArea {
    pub(super) fn new(device: &wgpu::Device, shared: &Shared) -> Self {
        let module = "techniques::ray_march::area_resolve";
        Self(ScreenProgram::new(
            device,
            shared,
            module,
            "ray_march_resolve",
        ))
    }

    pub(super) fn pass(&self, scope: &LightScope<'_>, sums: &wgpu::Buffer) -> Pass {
        scope.full_screen(&self.0, "resolve", &[sums.as_entire_binding()])
    }
}
