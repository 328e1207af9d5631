//! The last pass: adds up a ray's light, given the jumps of its visibility.

use crate::gpu::{
    pass::Pass,
    program::ScreenProgram,
    scope::{LightScope, Shared},
};

pub(super) fn program(device: &wgpu::Device, shared: &Shared) -> ScreenProgram {
    let module = "techniques::light_volume::resolve";
    ScreenProgram::new(device, shared, module, "light_volume_resolve")
}

pub(super) fn pass(
    program: &ScreenProgram,
    sum: &wgpu::TextureView,
    panes: &wgpu::Buffer,
    scope: &LightScope<'_>,
) -> Pass {
    let resources = [
        wgpu::BindingResource::TextureView(sum),
        panes.as_entire_binding(),
    ];
    scope.full_screen(program, "light volume resolve", &resources)
}
