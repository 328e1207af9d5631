//! The sums of the light's texture over every slice.

use super::{buffers::Buffers, params::Integrator};
use crate::gpu::{
    pass::Pass,
    program::ComputeProgram,
    scope::{LightScope, Shared},
};

pub(super) struct TintRows {
    analytic: ComputeProgram,
    svd: ComputeProgram,
}

impl TintRows {
    pub(super) fn new(device: &wgpu::Device, shared: &Shared) -> Self {
        let program = |svd| {
            let module = "techniques::min_max::tint_rows";
            ComputeProgram::new(device, shared, module, "tint_rows").with("SVD", svd)
        };
        Self {
            analytic: program(0.0),
            svd: program(1.0),
        }
    }

    /// Sums up `rows` rows a slice, a workgroup each.
    pub(super) fn pass(
        &self,
        scope: &LightScope<'_>,
        buffers: &Buffers,
        integrator: Integrator,
        rows: u32,
    ) -> Pass {
        let program = match integrator {
            Integrator::Analytic => &self.analytic,
            Integrator::Svd => &self.svd,
        };
        let resources = [
            &buffers.grid,
            &buffers.svd,
            &buffers.svd_factors,
            &buffers.tint_sums,
        ]
        .map(wgpu::Buffer::as_entire_binding);
        let workgroups = [buffers.epipolar.slices, rows, 1];
        scope.compute(program, "sum up picture", &resources, workgroups)
    }
}
