//! Stage 8: ray marching of the listed samples.

use super::resources::{List, Resources, buffer};
use crate::gpu::{
    pass::Pass,
    program::ComputeProgram,
    scope::{LightScope, Shared},
};

pub(super) struct MarchSamples(ComputeProgram);

impl MarchSamples {
    pub(super) fn new(device: &wgpu::Device, shared: &Shared) -> Self {
        let module = "techniques::epipolar_sampling::march_samples";
        Self(ComputeProgram::new(device, shared, module, "march_samples"))
    }

    pub(super) fn pass(&self, scope: &LightScope<'_>, r: &Resources) -> Pass {
        let resources = [
            buffer(&r.params),
            buffer(&r.traces),
            buffer(&r.nodes),
            buffer(&r.lines),
            buffer(&r.depth),
            buffer(&r.marched),
            buffer(&r.counts),
            buffer(&r.values),
        ];
        scope.compute(
            &self.0,
            "ray marching",
            &resources,
            r.workgroups(List::Samples),
        )
    }
}
