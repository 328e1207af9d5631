//! Asks whether the eye is in a shadow.

use super::volume::Volumes;
use crate::{
    gpu::{
        pass::Dispatch,
        program::ComputeProgram,
        scope::{LightScope, Shared},
    },
    mesh::OccluderMesh,
};

pub(super) fn program(device: &wgpu::Device, shared: &Shared) -> ComputeProgram {
    ComputeProgram::new(device, shared, "passes::occluder::eye", "eye_triangle")
}

/// Creates a dispatch a run.
pub(super) fn dispatches(
    program: &ComputeProgram,
    volumes: &Volumes<'_>,
    scope: &LightScope<'_>,
) -> Vec<Dispatch> {
    let of_run = |(run, mesh, _): (usize, &OccluderMesh, u32)| {
        let own = [volumes.eye.as_entire_binding()];
        let resources = [&volumes.resources(run, &mesh.triangles)[..], &own].concat();
        let groups = volumes.workgroups(program, run, mesh.triangles());
        scope.dispatch(program, &resources, groups)
    };
    volumes.runs().map(of_run).collect()
}
