//! Stage 2: the lines of the slices.

use super::{
    resources::{Resources, buffer},
    sizes::Sizes,
};
use crate::gpu::{
    pass::Pass,
    program::ComputeProgram,
    scope::{LightScope, Shared},
};

pub(super) struct SliceEnds(ComputeProgram);

impl SliceEnds {
    pub(super) fn new(device: &wgpu::Device, shared: &Shared) -> Self {
        let module = "techniques::epipolar_sampling::slice_ends";
        Self(ComputeProgram::new(device, shared, module, "slice_ends").for_all_lights())
    }

    pub(super) fn pass(&self, scope: &LightScope<'_>, sizes: &Sizes, r: &Resources) -> Pass {
        let resources = [
            buffer(&r.params),
            buffer(&r.lines),
            buffer(&r.counts),
            buffer(&r.dispatches),
        ];
        scope.compute(
            &self.0,
            "slice end points",
            &resources,
            self.0.workgroups([sizes.slices, 1, 1]),
        )
    }
}
