//! Shadows on surfaces, from the same voxels: what each pixel's surface gets of each sample, batch by batch.

use super::gpu::{Buffers, ParamsUniform};
use crate::{
    gpu::{
        pass::{Pass, Work},
        program::{ComputeProgram, ScreenProgram},
        scope::{LightScope, Shared},
    },
    inputs::SurfaceShadows,
};

/// Pixels that a workgroup of `surface.wgsl` takes.
const TILE: [u32; 2] = [8; 2];

/// Visibility is a share from 0 to 1.
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;

/// The shaders.
pub(super) struct Programs {
    add: ComputeProgram,
    resolve: ScreenProgram,
}

impl Programs {
    pub(super) fn new(device: &wgpu::Device, shared: &Shared) -> Self {
        let add = "techniques::imperfect_voxelized::surface";
        let resolve = "techniques::imperfect_voxelized::surface_resolve";
        Self {
            add: ComputeProgram::new(device, shared, add, "ivsv_surface"),
            resolve: ScreenProgram::new(device, shared, resolve, "ivsv_surface_resolve")
                .writing(FORMAT),
        }
    }
}

/// What is added up for the surfaces of a picture.
pub(super) struct Sums {
    lit: wgpu::Buffer,
    all: wgpu::Buffer,
    normals: wgpu::TextureView,
}

impl Sums {
    pub(super) fn new(
        scope: &mut LightScope<'_>,
        shadows: &SurfaceShadows,
        picture: &ParamsUniform,
    ) -> Self {
        let bytes = 16 * picture.pixels();
        let normals = shadows.normals.as_ref();
        Self {
            lit: scope.storage("light on surfaces", bytes),
            all: scope.storage("unblocked light on surfaces", bytes),
            normals: normals.unwrap_or(scope.shared.bindings.no_light()).clone(),
        }
    }

    /// Its own bindings, from 7 on.
    fn bindings(&self) -> [wgpu::BindingResource<'_>; 3] {
        [
            wgpu::BindingResource::TextureView(&self.normals),
            self.lit.as_entire_binding(),
            self.all.as_entire_binding(),
        ]
    }

    /// Adds the samples of a batch.
    pub(super) fn add(
        &self,
        programs: &Programs,
        scope: &LightScope<'_>,
        buffers: &Buffers,
        index: u32,
        picture: &ParamsUniform,
    ) -> Pass {
        let resources = buffers.of_batch(index, self.bindings());
        let groups = picture.groups(TILE);
        scope.compute(&programs.add, "light surfaces", &resources, groups)
    }

    /// Writes the picture that the view hands out.
    pub(super) fn resolve(
        &self,
        programs: &Programs,
        scope: &mut LightScope<'_>,
        buffers: &Buffers,
    ) -> (Pass, wgpu::TextureView) {
        let resources = buffers.of_batch(0, self.bindings());
        let key = (Some(scope.index), "visibility from surfaces");
        let target = scope.pool.attachment(scope.device, key, scope.size, FORMAT);
        let draw = scope.draw(&programs.resolve, &resources, target.clone());
        let pass = Pass {
            name: scope.pass_name("resolve surfaces"),
            work: Work::FullScreen(vec![draw]),
        };
        (pass, target)
    }
}
