//! The debug views, in place of the light.

use super::{buffers::Buffers, params::Show};
use crate::{
    gpu::{
        pass::Pass,
        program::ScreenProgram,
        scope::{LightScope, Shared},
    },
    shader::constant,
};

pub(super) struct ShowSearch(ScreenProgram);

impl ShowSearch {
    pub(super) fn new(device: &wgpu::Device, shared: &Shared) -> Self {
        let module = "techniques::min_max::show";
        Self(ScreenProgram::new(device, shared, module, "min_max_show"))
    }

    pub(super) fn pass(&self, scope: &mut LightScope<'_>, buffers: &Buffers, show: Show) -> Pass {
        let view = constant(match show {
            Show::Light => "MIN_MAX_SHOW_LIGHT",
            Show::Slices => "MIN_MAX_SHOW_SLICES",
            Show::Segments => "MIN_MAX_SHOW_SEGMENTS",
            Show::Nodes => "MIN_MAX_SHOW_NODES",
            Show::Map => "MIN_MAX_SHOW_MAP",
        });
        let view = scope.uniform("show", &[view, 0, 0, 0]);
        let resources = [&buffers.traversed()[..], &[view.as_entire_binding()]].concat();
        scope.full_screen(&self.0, "show", &resources)
    }
}
