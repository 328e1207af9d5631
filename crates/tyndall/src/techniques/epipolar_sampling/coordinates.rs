//! Stages 1 and 3: the depth of every sample.

use super::{
    resources::{Resources, buffer},
    sizes::Sizes,
};
use crate::gpu::{
    pass::Pass,
    program::ComputeProgram,
    scope::{LightScope, Shared},
};

pub(super) struct Coordinates(ComputeProgram);

impl Coordinates {
    pub(super) fn new(device: &wgpu::Device, shared: &Shared) -> Self {
        let module = "techniques::epipolar_sampling::coordinates";
        Self(ComputeProgram::new(device, shared, module, "coordinates").for_all_lights())
    }

    pub(super) fn pass(&self, scope: &LightScope<'_>, sizes: &Sizes, r: &Resources) -> Pass {
        let resources = [buffer(&r.params), buffer(&r.lines), buffer(&r.depth)];
        scope.compute(
            &self.0,
            "linear depth and coordinate texture",
            &resources,
            self.0.workgroups([sizes.samples, sizes.slices, 1]),
        )
    }
}
