//! Shadows on surfaces, from the same voxels: what each pixel's surface gets of each sample, batch by batch.

use super::gpu::{Buffers, FILTER, PARAMS, ParamsUniform, SAMPLES, batch_entries};
use crate::{
    gpu::{
        layout,
        pass::{Pass, Work},
        program::{ComputeProgram, ScreenProgram},
        scope::{LightScope, Shared},
    },
    inputs::SurfaceShadows,
    passes::{
        epipolar::EPIPOLAR,
        imperfect::gpu::{BatchUniform, IMPERFECT, LOOKUP},
        voxels::gpu::VOXELS,
    },
};

/// Pixels that a workgroup of `surface.wgsl` takes.
const TILE: [u32; 2] = [8; 2];
const SURFACE: &str = include_str!("surface.wgsl");
const RESOLVE: &str = include_str!("surface_resolve.wgsl");

/// Visibility is a share from 0 to 1.
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;

/// The shaders.
pub(super) struct Programs {
    add: ComputeProgram,
    resolve: ScreenProgram,
}

impl Programs {
    pub(super) fn new(device: &wgpu::Device, shared: &Shared) -> Self {
        let batch = layout::uniform::<BatchUniform>(0);
        let read = |binding| layout::storage(binding, true);
        let write = |binding| layout::storage(binding, false);
        let own = batch_entries(&[layout::texels(7), write(8), write(9)]);
        let modules = [
            EPIPOLAR, IMPERFECT, LOOKUP, VOXELS, PARAMS, SAMPLES, SURFACE,
        ];
        let add = ComputeProgram::new(
            device,
            shared,
            "light surfaces",
            &modules,
            "ivsv_surface",
            &own,
        );
        let own = [batch, layout::uniform::<ParamsUniform>(1), read(2), read(3)];
        let modules = [IMPERFECT, PARAMS, FILTER, RESOLVE];
        let entry_point = "ivsv_surface_resolve";
        let resolve = ScreenProgram::new(
            device,
            shared,
            "resolve surfaces",
            &modules,
            entry_point,
            &own,
        );
        Self {
            add,
            resolve: resolve.writing(FORMAT),
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
            normals: normals.unwrap_or(&scope.shared.absent.light).clone(),
        }
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
        let own = [
            wgpu::BindingResource::TextureView(&self.normals),
            self.lit.as_entire_binding(),
            self.all.as_entire_binding(),
        ];
        let resources = buffers.of_batch(index, own);
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
        let resources = [
            buffers.light.batches.binding(0),
            buffers.params.as_entire_binding(),
            self.lit.as_entire_binding(),
            self.all.as_entire_binding(),
        ];
        let [width, height] = scope.size;
        let size = wgpu::Extent3d {
            width,
            height,
            depth_or_array_layers: 1,
        };
        let usage = wgpu::TextureUsages::RENDER_ATTACHMENT
            | wgpu::TextureUsages::TEXTURE_BINDING
            | wgpu::TextureUsages::COPY_SRC;
        let target = scope.texture("visibility from surfaces", size, 1, FORMAT, usage);
        let target = target.create_view(&wgpu::TextureViewDescriptor::default());
        let draw = scope.draw(&programs.resolve, &resources, target.clone());
        let pass = Pass {
            name: scope.pass_name("resolve surfaces"),
            work: Work::FullScreen(vec![draw]),
        };
        (pass, target)
    }
}
