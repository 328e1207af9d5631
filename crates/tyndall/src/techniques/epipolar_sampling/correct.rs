//! Stages 11 and 13: the pixels of a list, marched.

use super::resources::{Image, List, Resources, buffer, texture};
use crate::{
    gpu::{
        pass::Pass,
        program::ComputeProgram,
        scope::{LightScope, Shared},
    },
    shader::block,
};

block! {
    /// The shaders' `CorrectParams`.
    pub(crate) struct CorrectUniform = "CorrectParams" in "tyndall::techniques::epipolar_sampling::correct", checked by correct_params_is_laid_out_as_in_wgsl {
        pub(crate) list: u32,
        pub(crate) downscale: u32,
        pad: [u32; 2],
    }
}

pub(super) struct Correct(ComputeProgram);

impl Correct {
    pub(super) fn new(device: &wgpu::Device, shared: &Shared) -> Self {
        let module = "techniques::epipolar_sampling::correct";
        Self(ComputeProgram::new(device, shared, module, "correct"))
    }

    /// Stage 11: marches pixels of an image that is `downscale` times smaller than the full one.
    pub(super) fn coarse(
        &self,
        scope: &mut LightScope<'_>,
        r: &Resources,
        image: &Image,
        downscale: u32,
    ) -> Pass {
        self.pass(scope, r, image, "correction", (List::Coarse, downscale))
    }

    /// Stage 13: marches pixels of the upscaled image.
    pub(super) fn upscaled(
        &self,
        scope: &mut LightScope<'_>,
        r: &Resources,
        image: &Image,
    ) -> Pass {
        self.pass(scope, r, image, "second correction", (List::Upscaled, 1))
    }

    fn pass(
        &self,
        scope: &mut LightScope<'_>,
        r: &Resources,
        image: &Image,
        name: &'static str,
        (list, downscale): (List, u32),
    ) -> Pass {
        let uniform = CorrectUniform {
            list: list.index(),
            downscale,
            pad: [0; 2],
        };
        let uniform = scope.uniform(name, &uniform);
        let resources = [
            buffer(&r.params),
            buffer(&r.traces),
            buffer(&r.nodes),
            buffer(&uniform),
            buffer(&image.list),
            buffer(&r.counts),
            texture(&image.values),
        ];
        scope.compute(&self.0, name, &resources, r.workgroups(list))
    }
}
