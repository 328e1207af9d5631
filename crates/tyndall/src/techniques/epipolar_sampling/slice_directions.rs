//! Stage 6: the trace of every slice in the shadow map.

use super::{
    resources::{Resources, buffer},
    sizes::Sizes,
};
use crate::gpu::{
    pass::Pass,
    program::ComputeProgram,
    scope::{LightScope, Shared},
};

pub(super) struct SliceDirections(ComputeProgram);

impl SliceDirections {
    pub(super) fn new(device: &wgpu::Device, shared: &Shared) -> Self {
        let module = "techniques::epipolar_sampling::slice_directions";
        Self(ComputeProgram::new(
            device,
            shared,
            module,
            "slice_directions",
        ))
    }

    pub(super) fn pass(&self, scope: &LightScope<'_>, sizes: &Sizes, r: &Resources) -> Pass {
        let resources = [buffer(&r.params), buffer(&r.lines), buffer(&r.traces)];
        scope.compute(
            &self.0,
            "slice directions",
            &resources,
            self.0.workgroups([sizes.slices, 1, 1]),
        )
    }
}
