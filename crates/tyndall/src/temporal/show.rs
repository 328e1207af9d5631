//! Shows a light's reuse in place of its in-scatter.

use super::buffers::Buffers;
use crate::gpu::{
    pass::{Pass, Work},
    program::ScreenProgram,
    scope::{LightScope, Shared},
};

pub(super) fn program(device: &wgpu::Device, shared: &Shared) -> ScreenProgram {
    ScreenProgram::new(device, shared, "temporal::show", "reuse_show").for_all_lights()
}

/// Creates the pass that draws on `sum`; the scope's frame group has the lights before. `shown`: `SHOW_MASK` or `SHOW_AGE`.
pub(super) fn pass(
    program: &ScreenProgram,
    shown: u32,
    sum: wgpu::TextureView,
    buffers: &Buffers,
    scope: &mut LightScope<'_>,
) -> Pass {
    let shown = scope.uniform("reuse show", &[shown, 0, 0, 0]);
    let resources = [
        buffers.params.as_entire_binding(),
        buffers.state.as_entire_binding(),
        buffers.age.as_entire_binding(),
        wgpu::BindingResource::TextureView(&scope.target),
        shown.as_entire_binding(),
    ];
    let draw = scope.draw(program, &resources, sum);
    Pass {
        name: scope.pass_name("show reuse"),
        work: Work::FullScreen(vec![draw]),
    }
}
