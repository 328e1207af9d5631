//! The GPU side: one full-screen pass a light, `ray_march.wgsl`.

use bytemuck::{Pod, Zeroable};

use super::{Params, Spacing};
use crate::gpu::{layout, pipeline::LightPipelines};

/// The pass.
pub(crate) const RAY_MARCH: &str = include_str!("ray_march.wgsl");

/// `RayMarchParams` of `ray_march.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct ParamsUniform {
    pub(crate) steps: u32,
    pub(crate) spacing: u32,
    pad: [u32; 2],
}

impl ParamsUniform {
    pub(crate) fn new(params: &Params) -> Self {
        Self {
            steps: params.steps,
            spacing: match params.spacing {
                Spacing::Equal => 0,
                Spacing::Equiangular => 1,
            },
            pad: [0; 2],
        }
    }
}

/// The pass's pipelines.
pub(crate) fn pipelines(
    device: &wgpu::Device,
    frame: &wgpu::BindGroupLayout,
    light: &wgpu::BindGroupLayout,
    output: wgpu::TextureFormat,
) -> LightPipelines {
    let params = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("ray march params"),
        entries: &[layout::uniform::<ParamsUniform>(0)],
    });
    LightPipelines::new(
        device,
        "ray march",
        RAY_MARCH,
        "ray_march",
        [frame, light],
        params,
        output,
    )
}
