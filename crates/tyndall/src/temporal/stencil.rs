//! Marks the stale pixels in a stencil, which the technique's last pass draws through.

use super::buffers::Buffers;
use crate::gpu::{
    pass::{Draw, Pass, Vertices, Work},
    program::{ScreenProgram, Stencil},
    scope::{LightScope, Shared},
};

pub(super) fn program(device: &wgpu::Device, shared: &Shared) -> ScreenProgram {
    ScreenProgram::new(device, shared, "temporal::stencil", "stencil").for_all_lights()
}

pub(super) fn pass(
    program: &ScreenProgram,
    stencil: wgpu::TextureView,
    buffers: &Buffers,
    scope: &LightScope<'_>,
) -> Pass {
    let resources = [&buffers.params, &buffers.state, &buffers.age].map(|b| b.as_entire_binding());
    let draw = Draw {
        pipeline: program.with_stencil(scope.device, scope.variant, Stencil::Written),
        groups: scope.groups(program.bind(scope.device, &resources)),
        vertices: Vertices::Direct {
            vertices: 3,
            instances: 1,
        },
    };
    Pass {
        name: scope.pass_name("mark stale pixels"),
        work: Work::Stencil { stencil, draw },
    }
}
