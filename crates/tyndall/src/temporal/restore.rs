//! Draws the pixels that were found in the image of another camera.

use std::mem::offset_of;

use super::buffers::{Buffers, Sizes};
use crate::gpu::{
    pass::{FullScreen, Pass, Work},
    program::ScreenProgram,
    scope::{LightScope, Shared},
};

pub(super) fn program(device: &wgpu::Device, shared: &Shared) -> ScreenProgram {
    ScreenProgram::new(device, shared, "temporal::restore", "restore").for_all_lights()
}

pub(super) fn pass(program: &ScreenProgram, buffers: &Buffers, scope: &LightScope<'_>) -> Pass {
    let resources = [&buffers.params, &buffers.found].map(|b| b.as_entire_binding());
    let draw = scope.draw(program, &resources, scope.target.clone());
    let gate = Some((buffers.sizes.clone(), offset_of!(Sizes, restore) as u64));
    Pass {
        name: scope.pass_name("reproject"),
        work: Work::FullScreen(vec![FullScreen { gate, ..draw }]),
    }
}
