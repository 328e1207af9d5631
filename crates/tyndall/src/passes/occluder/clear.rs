//! Clears what is known of shadows on the screen.

use super::{
    tile::tiles,
    volume::{MAX_COLUMNS, Volumes},
};
use crate::gpu::{
    pass::Dispatch,
    program::ComputeProgram,
    scope::{LightScope, Shared},
};

pub(super) struct Programs {
    eye: ComputeProgram,
    bounds: ComputeProgram,
}

impl Programs {
    pub(super) fn new(device: &wgpu::Device, shared: &Shared) -> Self {
        let program = |entry_point| {
            ComputeProgram::new(device, shared, "passes::occluder::clear", entry_point)
                .for_all_lights()
        };
        Self {
            eye: program("clear_eye"),
            bounds: program("clear_bounds"),
        }
    }

    /// Puts the eye in no shadow.
    pub(super) fn eye(&self, volumes: &Volumes<'_>, scope: &LightScope<'_>) -> Dispatch {
        clear(&self.eye, [1; 3], volumes, scope)
    }

    /// Has no ray meet a boundary; all begin in a shadow where the eye is in one.
    pub(super) fn bounds(&self, volumes: &Volumes<'_>, scope: &LightScope<'_>) -> Dispatch {
        let tiles = tiles(scope.size) as u32;
        let [groups, ..] = self.bounds.workgroups([tiles, 1, 1]);
        let columns = groups.min(MAX_COLUMNS);
        let groups = [columns, groups.div_ceil(columns), 1];
        clear(&self.bounds, groups, volumes, scope)
    }
}

fn clear(
    program: &ComputeProgram,
    groups: [u32; 3],
    volumes: &Volumes<'_>,
    scope: &LightScope<'_>,
) -> Dispatch {
    let own = [&volumes.eye, &volumes.tiles].map(|buffer| buffer.as_entire_binding());
    scope.dispatch(program, &own, groups)
}
