//! The order of the passes: maps, voxels and their scan of a batch of samples at a time, gathered into one texture.

use std::sync::{Arc, OnceLock};

use super::{
    buffers::{self, Buffers},
    gather::GatherLight,
    params::Params,
    rectify::Rectify,
    resolve::Resolve,
    surface::{self, LightSurfaces},
    surface_resolve::ResolveSurfaces,
};
use crate::{
    error::PrepareError,
    gpu::{
        cache,
        pass::{LightPasses, Pass},
        scope::{LightScope, Shared},
    },
    inputs::CountValue,
    passes::{
        imperfect::{area::AreaLight, gpu as imperfect},
        voxels::scan::Scan,
    },
    techniques::method::{GpuMethod, LightRequest},
};

/// The technique's programs, by pass.
pub(crate) struct Programs {
    maps: Arc<imperfect::Programs>,
    rectify: Rectify,
    scan: Arc<Scan>,
    gather: GatherLight,
    resolve: Resolve,
    /// Made when they are first asked for.
    surfaces: OnceLock<(LightSurfaces, ResolveSurfaces)>,
}

impl cache::Programs for Programs {
    fn new(device: &wgpu::Device, shared: &Shared) -> Self {
        Self {
            maps: shared.programs(device),
            rectify: Rectify::new(device, shared),
            scan: shared.programs(device),
            gather: GatherLight::default(),
            resolve: Resolve::new(device, shared),
            surfaces: OnceLock::new(),
        }
    }
}

impl Programs {
    /// The passes over surfaces.
    fn surfaces(&self, scope: &LightScope<'_>) -> &(LightSurfaces, ResolveSurfaces) {
        let (device, shared) = (scope.device, scope.shared);
        let make = || {
            let light = LightSurfaces::new(device, shared);
            (light, ResolveSurfaces::new(device, shared))
        };
        self.surfaces.get_or_init(make)
    }
}

impl GpuMethod for Params {
    fn check_light(&self, request: &LightRequest<'_>) -> Result<(), PrepareError> {
        buffers::check(self, request)
    }

    fn passes(&self, scope: &mut LightScope<'_>) -> LightPasses {
        passes(self, scope)
    }
}

/// The passes of one light: five a batch, and two; one more of each where shadows on surfaces are asked for.
fn passes(params: &Params, scope: &mut LightScope<'_>) -> LightPasses {
    let programs = scope.programs::<Programs>();
    let programs = programs.as_ref();
    // Others than rectangles are refused by the table.
    let area = AreaLight::new(&scope.light.emitter).unwrap_or_default();
    let maps = buffers::maps(params, &area, &scope.inputs, &scope.device.limits());
    let (light, sample) = programs.maps.sample(scope, &area, &maps);
    let buffers = Buffers::new(params, scope, &area, light, maps.batch);
    let surfaces = scope.surface_shadows.map(|shadows| {
        let sums = surface::Sums::new(scope, shadows, &buffers.uniform);
        (programs.surfaces(scope), sums)
    });
    let mut passes = vec![sample];
    for batch in 0..buffers.light.batches.values.len() as u32 {
        if let Some(cloud) = scope.inputs.points {
            let maps = &programs.maps;
            passes.extend(maps.draw(scope, &buffers.light, batch, cloud.points));
            passes.push(programs.rectify.pass(scope, &buffers, batch));
            let count = buffers.light.batches.values[batch as usize].count;
            let (side, voxels) = (params.resolution, &buffers.voxels);
            passes.push(programs.scan.pass(scope, side, voxels, count));
        }
        passes.push(programs.gather.pass(scope, &buffers, batch));
        if let Some(((light, _), sums)) = &surfaces {
            passes.push(light.pass(scope, &buffers, sums, batch));
        }
    }
    let visibility = surfaces.map(|((_, resolve), sums)| {
        let (pass, visibility) = resolve.pass(scope, &buffers, &sums);
        passes.push(pass);
        visibility
    });
    let last = programs.resolve.pass(scope, &buffers);
    count(scope, &passes, &last, area.positions.len() as u64);
    LightPasses {
        before: passes,
        last,
        witness: None,
        visibility,
    }
}

/// Passes, dispatches and samples of the light.
fn count(scope: &mut LightScope<'_>, before: &[Pass], last: &Pass, samples: u64) {
    let passes = || before.iter().chain([last]);
    let dispatches: usize = passes().map(Pass::parts).sum();
    for (name, value) in [
        ("samples", samples),
        ("passes", passes().count() as u64),
        ("dispatches and draws", dispatches as u64),
    ] {
        scope.count(name, CountValue::Known(value));
    }
}
