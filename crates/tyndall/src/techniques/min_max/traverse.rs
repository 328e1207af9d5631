//! The light of every pixel: its ray through its slice's tree.

use super::{buffers::Buffers, params::Integrator};
use crate::gpu::{
    pass::Pass,
    program::ScreenProgram,
    scope::{LightScope, Shared},
};

pub(super) struct Traverse {
    analytic: ScreenProgram,
    svd: ScreenProgram,
}

impl Traverse {
    pub(super) fn new(device: &wgpu::Device, shared: &Shared) -> Self {
        let program = |svd| {
            let module = "techniques::min_max::traverse";
            ScreenProgram::new(device, shared, module, "traverse").with("SVD", svd)
        };
        Self {
            analytic: program(0.0),
            svd: program(1.0),
        }
    }

    pub(super) fn pass(
        &self,
        scope: &LightScope<'_>,
        buffers: &Buffers,
        integrator: Integrator,
    ) -> Pass {
        let program = match integrator {
            Integrator::Analytic => &self.analytic,
            Integrator::Svd => &self.svd,
        };
        scope.full_screen(program, "traverse", &buffers.traversed())
    }
}
