//! Looks each pixel up in the image of the frame before, which another camera took.

use std::mem::offset_of;

use super::{
    buffers::{Buffers, Sizes},
    history::Viewpoint,
};
use crate::{
    gpu::{
        pass::{Dispatch, Workgroups},
        program::ComputeProgram,
        scope::{LightScope, Shared},
        uniforms::CameraUniform,
    },
    shader::block,
};

block! {
    /// The shaders' `Reproject`.
    struct ReprojectUniform = "Reproject" in "tyndall::temporal::reproject", checked by reproject_is_laid_out_as_in_wgsl {
        camera: CameraUniform,
        eye: [f32; 3],
        tolerance: f32,
        rounding: f32,
        pad: [f32; 3],
    }
}

pub(super) fn program(device: &wgpu::Device, shared: &Shared) -> ComputeProgram {
    ComputeProgram::new(device, shared, "temporal::reproject", "reproject_tile")
}

/// Creates the dispatch, given where the frame before was seen from and how much may be wrong with a pixel.
pub(super) fn dispatch(
    program: &ComputeProgram,
    (before, tolerance): (Viewpoint, f32),
    buffers: &Buffers,
    scope: &mut LightScope<'_>,
) -> Dispatch {
    let uniform = ReprojectUniform {
        camera: before.camera,
        eye: (before.eye - scope.rays.eye).as_vec3().to_array(),
        tolerance,
        rounding: match scope.shared.output {
            wgpu::TextureFormat::Rgba16Float => 0.5_f32.powi(11),
            _ => 0.5_f32.powi(24),
        },
        pad: [0.0; 3],
    };
    let uniform = scope.uniform("reuse reproject", &uniform);
    let kept = scope.target.clone();
    let resources = [
        buffers.params.as_entire_binding(),
        uniform.as_entire_binding(),
        buffers.state.as_entire_binding(),
        wgpu::BindingResource::TextureView(&kept),
        buffers.depth_seen.as_entire_binding(),
        buffers.age.as_entire_binding(),
        buffers.found.as_entire_binding(),
    ];
    let offset = offset_of!(Sizes, reproject) as u64;
    let groups = Workgroups::Indirect(buffers.sizes.clone(), offset);
    scope.dispatch(program, &resources, groups)
}
