//! The passes that find shadow volumes on the screen.

use super::{
    bounds, clear, eye, list,
    volume::{Names, Volumes},
};
use crate::{
    gpu::{
        cache,
        pass::{Dispatch, Pass},
        program::ComputeProgram,
        scope::{LightScope, Shared},
    },
    mesh::Occluder,
};

/// The shaders that find the boundaries on the screen.
pub(crate) struct VolumePrograms {
    clear: clear::Programs,
    eye: ComputeProgram,
    list: list::Programs,
    bounds: bounds::Programs,
}

impl cache::Programs for VolumePrograms {
    fn new(device: &wgpu::Device, shared: &Shared) -> Self {
        Self {
            clear: clear::Programs::new(device, shared),
            eye: eye::program(device, shared),
            list: list::Programs::new(device, shared),
            bounds: bounds::Programs::new(device, shared),
        }
    }
}

/// Creates the passes that find where these occluders' shadow volumes begin and end on the screen, and the tiles that they
/// leave it in (see `tile.wesl`).
pub(crate) fn passes(
    names: &Names,
    occluders: &[Occluder<'_>],
    programs: &VolumePrograms,
    scope: &mut LightScope<'_>,
) -> ([Pass; 3], wgpu::Buffer) {
    let volumes = Volumes::new(names, occluders, scope);
    let scope = &*scope;
    let after = |clear: Dispatch, dispatches: Vec<Dispatch>| {
        std::iter::once(clear).chain(dispatches).collect()
    };
    let eye = eye::dispatches(&programs.eye, &volumes, scope);
    let list = programs.list.dispatches(&volumes, scope);
    let passes = [
        (
            "eye in shadow",
            after(programs.clear.eye(&volumes, scope), eye),
        ),
        (
            "list silhouettes",
            after(programs.clear.bounds(&volumes, scope), list),
        ),
        (
            "shadow volumes",
            programs.bounds.dispatches(&volumes, scope),
        ),
    ]
    .map(|(name, dispatches)| Pass::compute(scope.pass_name(name), dispatches));
    (passes, volumes.tiles)
}
