//! Stage 10: from epipolar coordinates to a rectangular texture.

use super::{
    resources::{Image, Resources, buffer, texture},
    sizes::Sizes,
};
use crate::gpu::{
    pass::Pass,
    program::ComputeProgram,
    scope::{LightScope, Shared},
};

pub(super) struct Unwarp(ComputeProgram);

impl Unwarp {
    pub(super) fn new(device: &wgpu::Device, shared: &Shared) -> Self {
        let module = "techniques::epipolar_sampling::unwarp";
        Self(ComputeProgram::new(device, shared, module, "unwarp").for_all_lights())
    }

    pub(super) fn pass(
        &self,
        scope: &LightScope<'_>,
        sizes: &Sizes,
        r: &Resources,
        coarse: &Image,
    ) -> Pass {
        let resources = [
            buffer(&r.params),
            buffer(&coarse.list),
            buffer(&r.counts),
            buffer(&r.lines),
            texture(&r.samples),
            buffer(&r.dispatches),
            texture(&coarse.values),
        ];
        let [width, height] = sizes.coarse;
        scope.compute(
            &self.0,
            "unwarping",
            &resources,
            self.0.workgroups([width, height, 1]),
        )
    }
}
