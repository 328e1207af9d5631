//! The visibility of the light from surfaces, of the sums.

use super::{buffers::Buffers, surface::Sums};
use crate::gpu::{
    pass::{Pass, Work},
    pool::Owner,
    program::ScreenProgram,
    scope::{LightScope, Shared},
};

/// Visibility is a share from 0 to 1.
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;

pub(super) struct ResolveSurfaces(ScreenProgram);

impl ResolveSurfaces {
    pub(super) fn new(device: &wgpu::Device, shared: &Shared) -> Self {
        let module = "techniques::imperfect_voxelized::surface_resolve";
        Self(ScreenProgram::new(device, shared, module, "ivsv_surface_resolve").writing(FORMAT))
    }

    /// Writes the texture that the view hands out.
    pub(super) fn pass(
        &self,
        scope: &mut LightScope<'_>,
        buffers: &Buffers,
        sums: &Sums,
    ) -> (Pass, wgpu::TextureView) {
        let resources = buffers.of_batch(0, sums.bindings());
        let key = (Owner::Light(scope.index), "visibility from surfaces");
        let target = scope.pool.attachment(scope.device, key, scope.size, FORMAT);
        let draw = scope.draw(&self.0, &resources, target.clone());
        let pass = Pass {
            name: scope.pass_name("resolve surfaces"),
            work: Work::FullScreen(vec![draw]),
        };
        (pass, target)
    }
}
