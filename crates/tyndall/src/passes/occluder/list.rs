//! Lists the boundaries that are rasterised one by one, and rasterises the smallest.

use super::volume::Volumes;
use crate::{
    gpu::{
        pass::Dispatch,
        program::ComputeProgram,
        scope::{LightScope, Shared},
    },
    mesh::OccluderMesh,
};

pub(super) struct Programs {
    clear: ComputeProgram,
    walls: ComputeProgram,
    caps: ComputeProgram,
}

impl Programs {
    pub(super) fn new(device: &wgpu::Device, shared: &Shared) -> Self {
        let program = |entry_point| {
            ComputeProgram::new(device, shared, "passes::occluder::list", entry_point)
        };
        Self {
            clear: program("list_clear").for_all_lights(),
            walls: program("list_walls"),
            caps: program("list_caps"),
        }
    }

    /// Creates three dispatches a run.
    pub(super) fn dispatches(
        &self,
        volumes: &Volumes<'_>,
        scope: &LightScope<'_>,
    ) -> Vec<Dispatch> {
        let dispatch = |program, run, elements: &wgpu::Buffer, groups: [u32; 3]| {
            let own =
                [&volumes.list, &volumes.counts, &volumes.tiles].map(|b| b.as_entire_binding());
            let resources = [&volumes.resources(run, elements)[..], &own].concat();
            scope.dispatch(program, &resources, groups)
        };
        let of_run = |(run, mesh, _): (usize, &OccluderMesh, u32)| {
            let walls = volumes.workgroups(&self.walls, run, mesh.edge_count);
            let caps = volumes.workgroups(&self.caps, run, mesh.triangle_count);
            [
                dispatch(&self.clear, run, &mesh.edges, [1; 3]),
                dispatch(&self.walls, run, &mesh.edges, walls),
                dispatch(&self.caps, run, &mesh.triangles, caps),
            ]
        };
        volumes.runs().flat_map(of_run).collect()
    }
}
