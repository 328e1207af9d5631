//! The uniform blocks of bind groups 0 and 1, laid out as the shaders' structs; positions are relative to the eye.

use bytemuck::Zeroable;

use super::floats::floats;
pub(crate) use super::{
    camera::CameraUniform,
    light::{LightUniform, LightVariant},
};
use crate::{camera::CameraRays, frame, phase::MAX_PARAMS, physics::medium::Optics, shader::block};

block! {
    /// The shaders' `Frame`.
    pub(crate) struct FrameUniform = "Frame" in "tyndall::gpu::frame", checked by frame_is_laid_out_as_in_wgsl {
        pub(crate) camera: CameraUniform,
        pub(crate) medium: MediumUniform,
    }
}

block! {
    /// The shaders' `Medium`.
    pub(crate) struct MediumUniform = "Medium" in "tyndall::physics::medium", checked by medium_is_laid_out_as_in_wgsl {
        pub(crate) sigma_t: [f32; 3],
        pub(crate) count: u32,
        pub(crate) components: [MediumComponentUniform; frame::Medium::MAX_COMPONENTS],
    }
}

block! {
    /// The shaders' `MediumComponent`.
    pub(crate) struct MediumComponentUniform = "MediumComponent" in "tyndall::physics::medium", checked by medium_component_is_laid_out_as_in_wgsl {
        pub(crate) sigma_s: [f32; 3],
        pub(crate) phase: u32,
        pub(crate) parameters: [f32; MAX_PARAMS],
        pad: [f32; 2],
    }
}

impl FrameUniform {
    pub(crate) fn new(frame: &frame::Frame, rays: &CameraRays, size: [u32; 2]) -> Self {
        Self {
            camera: CameraUniform::new(&frame.camera, rays, size),
            medium: MediumUniform::new(&frame.medium),
        }
    }
}

impl MediumUniform {
    fn new(medium: &frame::Medium) -> Self {
        let mut components = [MediumComponentUniform::zeroed(); frame::Medium::MAX_COMPONENTS];
        for (slot, component) in components.iter_mut().zip(&medium.components) {
            *slot = MediumComponentUniform {
                sigma_s: component.sigma_s,
                phase: component.phase.number(),
                parameters: component.phase.values(),
                pad: [0.0; 2],
            };
        }
        Self {
            sigma_t: floats(Optics::new(medium).sigma_t),
            count: medium.components.len() as u32,
            components,
        }
    }
}
