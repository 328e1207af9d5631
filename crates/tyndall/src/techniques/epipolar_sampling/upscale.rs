//! Stage 12: to full resolution.

use wgpu::TextureFormat;

use super::{
    resources::{Image, Resources, buffer, texture},
    sizes::Sizes,
};
use crate::gpu::{
    pass::Pass,
    program::ComputeProgram,
    scope::{LightScope, Shared},
};

pub(super) struct Upscale(ComputeProgram);

impl Upscale {
    pub(super) fn new(device: &wgpu::Device, shared: &Shared) -> Self {
        let module = "techniques::epipolar_sampling::upscale";
        Self(ComputeProgram::new(device, shared, module, "upscale").for_all_lights())
    }

    /// The image at full resolution, and the pass that fills it from the coarse one.
    pub(super) fn pass(
        &self,
        scope: &mut LightScope<'_>,
        sizes: &Sizes,
        r: &Resources,
        coarse: &Image,
    ) -> (Image, Pass) {
        let format = TextureFormat::Rgba32Float;
        let image = Image {
            list: scope.storage("upscaled, corrected pixels", sizes.bytes().list),
            values: scope.storage_texture("upscaled values", scope.size, format),
        };
        let resources = [
            buffer(&r.params),
            texture(&coarse.values),
            texture(&image.values),
            buffer(&image.list),
            buffer(&r.counts),
            buffer(&r.dispatches),
        ];
        let [width, height] = scope.size;
        let workgroups = self.0.workgroups([width, height, 1]);
        let pass = scope.compute(&self.0, "upscaling", &resources, workgroups);
        (image, pass)
    }
}
