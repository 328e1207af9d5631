//! Adds a light's kept in-scatter to the lights before.

use crate::gpu::{
    pass::{Pass, Work},
    program::ScreenProgram,
    scope::{LightScope, Shared},
};

pub(super) fn program(device: &wgpu::Device, shared: &Shared) -> ScreenProgram {
    ScreenProgram::new(device, shared, "temporal::sum", "reuse_sum").for_all_lights()
}

/// Creates the pass that draws on `sum`; the scope's frame group has the lights before.
pub(super) fn pass(
    program: &ScreenProgram,
    sum: wgpu::TextureView,
    scope: &LightScope<'_>,
) -> Pass {
    let resources = [wgpu::BindingResource::TextureView(&scope.target)];
    let draw = scope.draw(program, &resources, sum);
    Pass {
        name: scope.pass_name("add light"),
        work: Work::FullScreen(vec![draw]),
    }
}
