//! Shadows on surfaces, from the same voxels: the light of each sample on the surface that each pixel sees, batch by batch.

use super::buffers::{Buffers, ParamsUniform};
use crate::{
    gpu::{
        pass::Pass,
        program::ComputeProgram,
        scope::{LightScope, Shared},
    },
    inputs::SurfaceShadows,
};

/// Light on the surfaces that pixels see, added up.
pub(super) struct Sums {
    lit: wgpu::Buffer,
    all: wgpu::Buffer,
    normals: wgpu::TextureView,
}

impl Sums {
    pub(super) fn new(
        scope: &mut LightScope<'_>,
        shadows: &SurfaceShadows,
        uniform: &ParamsUniform,
    ) -> Self {
        let bytes = 16 * uniform.pixels();
        let normals = shadows.normals.as_ref();
        Self {
            lit: scope.storage("light on surfaces", bytes),
            all: scope.storage("unblocked light on surfaces", bytes),
            normals: normals.unwrap_or(scope.shared.bindings.no_light()).clone(),
        }
    }

    /// Its own bindings, from 7 on.
    pub(super) fn bindings(&self) -> [wgpu::BindingResource<'_>; 3] {
        [
            wgpu::BindingResource::TextureView(&self.normals),
            self.lit.as_entire_binding(),
            self.all.as_entire_binding(),
        ]
    }
}

pub(super) struct LightSurfaces(ComputeProgram);

impl LightSurfaces {
    pub(super) fn new(device: &wgpu::Device, shared: &Shared) -> Self {
        let module = "techniques::imperfect_voxelized::surface";
        Self(ComputeProgram::new(device, shared, module, "ivsv_surface"))
    }

    /// Adds the samples of a batch.
    pub(super) fn pass(
        &self,
        scope: &LightScope<'_>,
        buffers: &Buffers,
        sums: &Sums,
        index: u32,
    ) -> Pass {
        let resources = buffers.of_batch(index, sums.bindings());
        let workgroups = buffers.uniform.workgroups(&self.0, 1);
        scope.compute(&self.0, "light surfaces", &resources, workgroups)
    }
}
