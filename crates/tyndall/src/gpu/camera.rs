//! The camera as the shaders read it.

use super::floats::floats;
use crate::{
    camera::CameraRays,
    frame::{self, DepthRange, Projection},
    shader::{block, constant},
};

block! {
    /// The shaders' `Camera`.
    pub(crate) struct CameraUniform = "Camera" in "tyndall::camera::camera", checked by camera_is_laid_out_as_in_wgsl {
        pub(crate) right: [f32; 3],
        pub(crate) near: f32,
        pub(crate) up: [f32; 3],
        pub(crate) far: f32,
        pub(crate) forward: [f32; 3],
        pub(crate) flags: u32,
        pub(crate) half_extent: [f32; 2],
        pub(crate) center: [f32; 2],
        pub(crate) size: [f32; 2],
        pad: [f32; 2],
    }
}

impl CameraUniform {
    pub(super) fn new(camera: &frame::Camera, rays: &CameraRays, size: [u32; 2]) -> Self {
        let (projection_flag, half_extent, center, near, far) = match camera.projection {
            Projection::Perspective {
                half_extent,
                center,
                near,
                far,
            } => (0, half_extent, center, near, far),
            Projection::Orthographic {
                half_extent,
                center,
                near,
                far,
            } => (
                constant("CAMERA_ORTHOGRAPHIC"),
                half_extent,
                center,
                near,
                far,
            ),
        };
        let reversed = constant("CAMERA_REVERSED_DEPTH");
        let depth_flags = match camera.depth_range {
            DepthRange::Standard => 0,
            DepthRange::Reversed => reversed,
            DepthRange::ReversedInfinite => reversed | constant("CAMERA_INFINITE_DEPTH"),
        };
        Self {
            right: floats(rays.right),
            near,
            up: floats(rays.up),
            far,
            forward: floats(rays.forward),
            flags: projection_flag | depth_flags,
            half_extent,
            center,
            size: size.map(|n| n as f32),
            pad: [0.0; 2],
        }
    }
}
