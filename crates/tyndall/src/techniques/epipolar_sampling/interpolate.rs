//! Stage 9: the samples that were not marched, from their sources.

use super::{
    resources::{Resources, buffer, texture},
    sizes::Sizes,
};
use crate::gpu::{
    pass::Pass,
    program::ComputeProgram,
    scope::{LightScope, Shared},
};

pub(super) struct Interpolate(ComputeProgram);

impl Interpolate {
    pub(super) fn new(device: &wgpu::Device, shared: &Shared) -> Self {
        let module = "techniques::epipolar_sampling::interpolate";
        Self(ComputeProgram::new(device, shared, module, "interpolate").for_all_lights())
    }

    pub(super) fn pass(&self, scope: &LightScope<'_>, sizes: &Sizes, r: &Resources) -> Pass {
        let resources = [
            buffer(&r.params),
            buffer(&r.sources),
            buffer(&r.depth),
            buffer(&r.values),
            texture(&r.samples),
        ];
        scope.compute(
            &self.0,
            "interpolation",
            &resources,
            self.0.workgroups([sizes.samples, sizes.slices, 1]),
        )
    }
}
