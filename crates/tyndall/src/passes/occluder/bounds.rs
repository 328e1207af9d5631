//! Rasterises the boundaries that were listed.

use super::volume::Volumes;
use crate::{
    gpu::{
        pass::Dispatch,
        program::ComputeProgram,
        scope::{LightScope, Shared},
    },
    shader::constant,
};

/// The most workgroups that share the pieces of a run.
const MAX_SHARING: u32 = 512;

pub(super) struct Programs {
    walls: ComputeProgram,
    caps: ComputeProgram,
    far_caps: ComputeProgram,
}

impl Programs {
    pub(super) fn new(device: &wgpu::Device, shared: &Shared) -> Self {
        let program = |entry_point| {
            ComputeProgram::new(device, shared, "passes::occluder::bounds", entry_point)
        };
        Self {
            walls: program("bounds_walls"),
            caps: program("bounds_caps"),
            far_caps: program("bounds_far_caps"),
        }
    }

    /// Creates two dispatches a run, and a local light one more for the far caps.
    pub(super) fn dispatches(
        &self,
        volumes: &Volumes<'_>,
        scope: &LightScope<'_>,
    ) -> Vec<Dispatch> {
        let of_pieces = |program, run, elements: &wgpu::Buffer, most: u64| {
            let own =
                [&volumes.list, &volumes.counts, &volumes.tiles].map(|b| b.as_entire_binding());
            let resources = [&volumes.resources(run, elements)[..], &own].concat();
            let groups = most.div_ceil(constant("BOUNDS_BATCH").into());
            let groups = groups.clamp(1, MAX_SHARING.into()) as u32;
            scope.dispatch(program, &resources, [groups, 1, 1])
        };
        let mut dispatches = Vec::new();
        let is_local = scope.variant.kind != constant("LIGHT_DIRECTIONAL");
        for (run, mesh, places) in volumes.runs() {
            let far_caps = constant("BOUNDS_OF_BOX");
            let [walls, caps, far_caps] = [mesh.edge_count, mesh.triangle_count, far_caps]
                .map(|pieces| u64::from(places) * u64::from(pieces));
            dispatches.push(of_pieces(&self.walls, run, &mesh.edges, walls));
            dispatches.push(of_pieces(&self.caps, run, &mesh.triangles, caps));
            if is_local {
                let triangles = &mesh.triangles;
                dispatches.push(of_pieces(&self.far_caps, run, triangles, far_caps));
            }
        }
        dispatches
    }
}
