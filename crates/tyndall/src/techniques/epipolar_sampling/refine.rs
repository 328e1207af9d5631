//! Stages 4 and 5: the sources of every sample, and the list of samples to march.

use super::{
    resources::{Resources, buffer},
    sizes::Sizes,
};
use crate::gpu::{
    pass::Pass,
    program::ComputeProgram,
    scope::{LightScope, Shared},
};

pub(super) struct Refine(ComputeProgram);

impl Refine {
    pub(super) fn new(device: &wgpu::Device, shared: &Shared) -> Self {
        let module = "techniques::epipolar_sampling::refine";
        Self(ComputeProgram::new(device, shared, module, "refine"))
    }

    pub(super) fn pass(&self, scope: &LightScope<'_>, sizes: &Sizes, r: &Resources) -> Pass {
        let resources = [
            buffer(&r.params),
            buffer(&r.lines),
            buffer(&r.depth),
            buffer(&r.sources),
            buffer(&r.marched),
            buffer(&r.counts),
            buffer(&r.dispatches),
        ];
        scope.compute(
            &self.0,
            "refinement and marking",
            &resources,
            self.0.workgroups([sizes.samples, sizes.slices, 1]),
        )
    }
}
