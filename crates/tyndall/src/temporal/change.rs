//! Compares the shadow map with the one that the frame before saw, level by level of its blocks.

use super::buffers::Buffers;
use crate::gpu::{
    pass::Dispatch,
    program::ComputeProgram,
    scope::{Blocks, LightScope, Shared},
};

/// The shaders of the finest level and of all others.
pub(super) struct Programs {
    finest: ComputeProgram,
    coarser: ComputeProgram,
}

impl Programs {
    pub(super) fn new(device: &wgpu::Device, shared: &Shared) -> Self {
        let program =
            |entry_point| ComputeProgram::new(device, shared, "temporal::change", entry_point);
        Self {
            finest: program("change_finest"),
            coarser: program("change_coarser"),
        }
    }

    fn of(&self, level: usize) -> &ComputeProgram {
        if level == 0 {
            &self.finest
        } else {
            &self.coarser
        }
    }

    /// Workgroups for so many blocks a side and faces.
    pub(super) fn workgroups(&self, level: usize, [x, y]: [u32; 2], faces: u32) -> [u32; 3] {
        self.of(level).workgroups([x, y, faces])
    }
}

/// Creates the dispatches of so many levels; `numbers` holds a block for each.
pub(super) fn dispatches(
    levels: usize,
    numbers: &Blocks<[u32; 4]>,
    programs: &Programs,
    buffers: &Buffers,
    scope: &LightScope<'_>,
) -> Vec<Dispatch> {
    let [params, blocks, seen] =
        [&buffers.params, &buffers.blocks, &buffers.map_seen].map(|b| b.as_entire_binding());
    let dispatch = |level: usize| {
        let number = numbers.binding(level as u32);
        let resources = [params.clone(), blocks.clone(), seen.clone(), number];
        let groups = buffers.mask_groups(1 + level);
        scope.dispatch(programs.of(level), &resources, groups)
    };
    (0..levels).map(dispatch).collect()
}
