//! The light of all samples of a batch, added up for each pixel.

use std::sync::OnceLock;

use super::buffers::Buffers;
use crate::{
    frame::Medium,
    gpu::{pass::Pass, program::ComputeProgram, scope::LightScope},
    shader::constant,
};

/// Programs by the number of the medium's components, made when they are first asked for.
#[derive(Default)]
pub(super) struct GatherLight([OnceLock<ComputeProgram>; Medium::MAX_COMPONENTS + 1]);

impl GatherLight {
    fn program(&self, scope: &LightScope<'_>) -> &ComputeProgram {
        let components = scope.frame.medium.components.len();
        let components = components.min(Medium::MAX_COMPONENTS);
        let make = || {
            let module = "techniques::imperfect_voxelized::gather";
            ComputeProgram::new(scope.device, scope.shared, module, "ivsv_gather")
                .with("MEDIUM_COMPONENTS", components as f64)
        };
        self.0[components].get_or_init(make)
    }

    pub(super) fn pass(&self, scope: &LightScope<'_>, buffers: &Buffers, index: u32) -> Pass {
        let program = self.program(scope);
        let resources = buffers.of_batch(index, [buffers.sums.as_entire_binding()]);
        let rows = constant("IVSV_GATHER_ROWS");
        let workgroups = buffers.uniform.workgroups(program, rows);
        scope.compute(program, "gather", &resources, workgroups)
    }
}
