//! The order of the passes: a single one, `ray_march.wesl`; for a rectangular light maps of its samples, a pass that marches
//! all of a batch, and one that writes the output.

use std::sync::Arc;

use super::{
    area::{self, MarchArea},
    area_resolve::ResolveArea,
    params::{Params, Spacing},
};
use crate::{
    error::PrepareError,
    gpu::{
        cache,
        pass::LightPasses,
        program::ScreenProgram,
        scope::{LightScope, Shared},
    },
    passes::imperfect::{area::AreaLight, gpu as imperfect},
    shader::block,
    techniques::{
        info::Reach,
        method::{GpuMethod, LightRequest},
    },
};

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

/// The technique's programs, by pass.
pub(crate) struct Programs {
    march: ScreenProgram,
    maps: Arc<imperfect::Programs>,
    area: MarchArea,
    resolve: ResolveArea,
}

impl cache::Programs for Programs {
    fn new(device: &wgpu::Device, shared: &Shared) -> Self {
        let module = "techniques::ray_march::ray_march";
        Self {
            march: ScreenProgram::new(device, shared, module, "ray_march"),
            maps: shared.programs(device),
            area: MarchArea::new(device, shared),
            resolve: ResolveArea::new(device, shared),
        }
    }
}

impl GpuMethod for Params {
    fn check_light(&self, request: &LightRequest<'_>) -> Result<(), PrepareError> {
        area::check(self, request)
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
    light: &AreaLight,
    uniform: &wgpu::Buffer,
) -> LightPasses {
    let maps = area::maps(params, scope, light);
    let sums = area::sums(scope);
    let (buffers, sample) = programs.maps.sample(scope, light, &maps);
    let mut passes = vec![sample];
    for index in 0..buffers.batches.values.len() as u32 {
        if let Some(cloud) = scope.inputs.points {
            passes.extend(programs.maps.draw(scope, &buffers, index, cloud.points));
        }
        let area = &programs.area;
        passes.push(area.pass(scope, &buffers, index, uniform, &sums));
    }
    LightPasses::new(passes, programs.resolve.pass(scope, &sums))
}
