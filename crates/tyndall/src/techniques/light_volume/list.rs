//! Third pass of the adaptive mesh: lists its triangles, and says how much there is to draw.

use super::tree::Tree;
use crate::gpu::{
    pass::Dispatch,
    program::ComputeProgram,
    scope::{LightScope, Shared},
};

pub(super) struct Programs {
    list: ComputeProgram,
    choose: ComputeProgram,
}

impl Programs {
    pub(super) fn new(device: &wgpu::Device, shared: &Shared) -> Self {
        let program = |entry_point| {
            let module = "techniques::light_volume::list";
            ComputeProgram::new(device, shared, module, entry_point)
        };
        Self {
            list: program("light_volume_list"),
            choose: program("light_volume_choose"),
        }
    }

    pub(super) fn dispatches(
        &self,
        params: &wgpu::Buffer,
        tree: &Tree,
        faces: u32,
        scope: &LightScope<'_>,
    ) -> [Dispatch; 2] {
        let resources = [params, &tree.splits, &tree.triangles, &tree.counts];
        let resources = resources.map(|buffer| buffer.as_entire_binding());
        let (pitch, rows) = (tree.square.pitch(), tree.square.rows());
        let groups = self.list.workgroups([pitch, rows, faces]);
        [
            scope.dispatch(&self.list, &resources, groups),
            scope.dispatch(&self.choose, &resources, [1; 3]),
        ]
    }
}
