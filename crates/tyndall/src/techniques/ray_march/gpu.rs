//! The GPU side: one full-screen pass a light, `ray_march.wgsl`; of a rectangular light maps of its samples, a pass that
//! marches all of a batch, and one that writes the output.

use std::sync::Arc;

use super::params::{INFO, Params, Spacing};
use crate::{
    error::PrepareError,
    frame::Emitter,
    gpu::{
        cache,
        pass::LightPasses,
        program::{ComputeProgram, ScreenProgram},
        scope::{LightScope, Shared},
    },
    passes::imperfect::{
        area::{AreaLight, Maps},
        gpu as imperfect,
    },
    shader::block,
    techniques::{
        info::Reach,
        method::{GpuMethod, LightRequest},
    },
};

/// Steps of all samples together that an invocation takes in one dispatch: drivers end what runs for too long, Mesa's
/// lavapipe without a word after 65535 turns of all loops, of which a step takes some.
const MOST_STEPS: u32 = 16_384;

block! {
    /// The shaders' `RayMarchParams`.
    pub(crate) struct ParamsUniform = "RayMarchParams" in "tyndall::techniques::ray_march::params", checked by ray_march_params_is_laid_out_as_in_wgsl {
        pub(crate) steps: u32,
        pub(crate) is_equiangular: u32,
        pad: [u32; 2],
    }
}

impl ParamsUniform {
    pub(crate) fn new(params: &Params) -> Self {
        Self {
            steps: params.steps,
            is_equiangular: u32::from(params.spacing == Spacing::Equiangular),
            pad: [0; 2],
        }
    }
}

/// The technique's shaders.
pub(crate) struct Programs {
    march: ScreenProgram,
    maps: Arc<imperfect::Programs>,
    march_area: ComputeProgram,
    resolve: ScreenProgram,
}

impl cache::Programs for Programs {
    fn new(device: &wgpu::Device, shared: &Shared) -> Self {
        Self {
            march: ScreenProgram::new(
                device,
                shared,
                "techniques::ray_march::ray_march",
                "ray_march",
            ),
            maps: shared.programs(device),
            march_area: ComputeProgram::new(
                device,
                shared,
                "techniques::ray_march::area",
                "ray_march_area",
            ),
            resolve: ScreenProgram::new(
                device,
                shared,
                "techniques::ray_march::area_resolve",
                "ray_march_resolve",
            ),
        }
    }
}

impl GpuMethod for Params {
    fn check_light(&self, request: &LightRequest<'_>) -> Result<(), PrepareError> {
        check(self, request)
    }

    fn reach(&self) -> Reach {
        Reach::Pixels(0.0)
    }

    fn passes(&self, scope: &mut LightScope<'_>) -> LightPasses {
        passes(self, scope)
    }
}

/// The passes of one light.
fn passes(params: &Params, scope: &mut LightScope<'_>) -> LightPasses {
    let programs = scope.programs::<Programs>();
    let programs = programs.as_ref();
    let uniform = scope.uniform("ray march params", &ParamsUniform::new(params));
    match AreaLight::new(&scope.light.emitter) {
        Some(area) => march_area(params, programs, scope, &area, &uniform),
        None => {
            let resources = [uniform.as_entire_binding()];
            LightPasses::new(
                Vec::new(),
                scope.full_screen(&programs.march, "ray march", &resources),
            )
        }
    }
}

fn march_area(
    params: &Params,
    programs: &Programs,
    scope: &mut LightScope<'_>,
    area: &AreaLight,
    uniform: &wgpu::Buffer,
) -> LightPasses {
    let (count, limits) = (area.positions.len() as u32, scope.device.limits());
    let at_once = count.min((MOST_STEPS / params.steps).max(1));
    let maps = Maps::new(&scope.inputs, params.points, at_once, 0, &limits);
    let sums = scope.storage("marched light", sums_bytes(scope.size));
    let (buffers, sample) = programs.maps.sample(scope, area, &maps);
    let mut passes = vec![sample];
    for index in 0..buffers.batches.values.len() as u32 {
        if let Some(cloud) = scope.inputs.points {
            passes.extend(programs.maps.draw(scope, &buffers, index, cloud.points));
        }
        let resources = [
            buffers.batches.binding(index),
            buffers.samples.as_entire_binding(),
            buffers.maps.as_entire_binding(),
            buffers.colors.as_entire_binding(),
            uniform.as_entire_binding(),
            sums.as_entire_binding(),
        ];
        let [width, height] = scope.size;
        let workgroups = programs.march_area.workgroups([width, height, 1]);
        passes.push(scope.compute(&programs.march_area, "ray march", &resources, workgroups));
    }
    let resources = [sums.as_entire_binding()];
    LightPasses::new(
        passes,
        scope.full_screen(&programs.resolve, "resolve", &resources),
    )
}

fn sums_bytes(size: [u32; 2]) -> u64 {
    16 * u64::from(size[0]) * u64::from(size[1])
}

/// Refuses a rectangular light whose buffers the device cannot bind.
fn check(params: &Params, request: &LightRequest<'_>) -> Result<(), PrepareError> {
    let LightRequest {
        limits,
        size,
        index,
        light,
        inputs,
    } = *request;
    if !matches!(light.emitter, Emitter::Rect { .. }) {
        return Ok(());
    }
    Maps::new(inputs, params.points, 1, 0, limits).check(
        INFO.name,
        index,
        limits,
        &[("marched light", sums_bytes(size))],
    )
}
