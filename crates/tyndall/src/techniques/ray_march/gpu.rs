//! The GPU side: one full-screen pass a light, `ray_march.wgsl`.

use bytemuck::{Pod, Zeroable};

use super::{Params, Spacing};
use crate::gpu::{
    layout,
    pass::Pass,
    program::ScreenProgram,
    scope::{LightScope, Shared},
    shader::MARCH,
};

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

/// The technique's shader.
pub(crate) fn program(device: &wgpu::Device, shared: &Shared) -> ScreenProgram {
    let own = [layout::uniform::<ParamsUniform>(0)];
    ScreenProgram::new(
        device,
        shared,
        "ray march",
        &[MARCH, RAY_MARCH],
        "ray_march",
        &own,
    )
}

/// The passes of one light.
pub(crate) fn passes(
    params: &Params,
    program: &ScreenProgram,
    scope: &mut LightScope<'_>,
) -> Vec<Pass> {
    let params = scope.uniform("ray march params", &ParamsUniform::new(params));
    vec![scope.full_screen(program, "ray march", &[params.as_entire_binding()])]
}
