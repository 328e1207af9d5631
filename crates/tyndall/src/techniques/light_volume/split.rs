//! First pass of the adaptive mesh: the vertices that stand out, and the whole border.

use super::tree::Tree;
use crate::gpu::{
    pass::Dispatch,
    program::ComputeProgram,
    scope::{LightScope, Shared},
};

pub(super) fn program(device: &wgpu::Device, shared: &Shared) -> ComputeProgram {
    let module = "techniques::light_volume::split";
    ComputeProgram::new(device, shared, module, "light_volume_split")
}

pub(super) fn dispatch(
    program: &ComputeProgram,
    params: &wgpu::Buffer,
    tree: &Tree,
    faces: u32,
    scope: &LightScope<'_>,
) -> Dispatch {
    let resources = [params, &tree.splits].map(|buffer| buffer.as_entire_binding());
    let groups = program.workgroups([tree.square.pitch(), tree.square.rows(), faces]);
    scope.dispatch(program, &resources, groups)
}
