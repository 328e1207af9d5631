//! Second pass of the adaptive mesh, step by step from fine to coarse: the vertices that those of smaller edges hang on.

use super::tree::Tree;
use crate::gpu::{
    pass::Dispatch,
    program::ComputeProgram,
    scope::{LightScope, Shared},
};

pub(super) fn program(device: &wgpu::Device, shared: &Shared) -> ComputeProgram {
    let module = "techniques::light_volume::grow";
    ComputeProgram::new(device, shared, module, "light_volume_grow")
}

/// Creates a dispatch a step.
pub(super) fn dispatches(
    program: &ComputeProgram,
    params: &wgpu::Buffer,
    tree: &Tree,
    faces: u32,
    scope: &LightScope<'_>,
) -> Vec<Dispatch> {
    let [params, splits] = [params, &tree.splits].map(|buffer| buffer.as_entire_binding());
    let of_step = |(i, (_, [columns, rows])): (u32, (_, [u32; 2]))| {
        let resources = [params.clone(), splits.clone(), tree.steps.binding(i)];
        let groups = program.workgroups([columns, rows, faces]);
        scope.dispatch(program, &resources, groups)
    };
    (0..).zip(tree.square.steps()).map(of_step).collect()
}
