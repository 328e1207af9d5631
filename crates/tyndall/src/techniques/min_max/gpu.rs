//! The order of the passes: trees of the shadow map and the glass, sums of the light's texture, and the traversal.

use super::{
    buffers::{self, Buffers},
    params::{Params, Show},
    rectify::Rectify,
    show::ShowSearch,
    tint_rows::TintRows,
    traverse::Traverse,
};
use crate::{
    error::PrepareError,
    gpu::{
        cache,
        pass::LightPasses,
        scope::{LightScope, Shared},
    },
    techniques::{
        Reach,
        method::{GpuMethod, LightRequest},
    },
};

/// The technique's programs, by pass.
pub(crate) struct Programs {
    rectify: Rectify,
    tint_rows: TintRows,
    traverse: Traverse,
    show: ShowSearch,
}

impl cache::Programs for Programs {
    fn new(device: &wgpu::Device, shared: &Shared) -> Self {
        Self {
            rectify: Rectify::new(device, shared),
            tint_rows: TintRows::new(device, shared),
            traverse: Traverse::new(device, shared),
            show: ShowSearch::new(device, shared),
        }
    }
}

impl GpuMethod for Params {
    fn check_light(&self, request: &LightRequest<'_>) -> Result<(), PrepareError> {
        buffers::check(self, request)
    }

    fn reach(&self) -> Reach {
        reach(self)
    }

    fn passes(&self, scope: &mut LightScope<'_>) -> LightPasses {
        passes(self, scope)
    }
}

/// The passes of one light.
fn passes(params: &Params, scope: &mut LightScope<'_>) -> LightPasses {
    let programs = scope.programs::<Programs>();
    let buffers = Buffers::new(params, scope);
    let mut passes = Vec::new();
    if buffers.has_slices {
        passes.extend(programs.rectify.passes(scope, &buffers));
    }
    if let Some(rows) = buffers.tint_rows {
        let sums = &programs.tint_rows;
        passes.push(sums.pass(scope, &buffers, params.integrator, rows));
    }
    let last = match params.show {
        Show::Light => programs.traverse.pass(scope, &buffers, params.integrator),
        show => programs.show.pass(scope, &buffers, show),
    };
    LightPasses::new(passes, last)
}

/// The reach of a pixel: it looks at the slice beside it, which is half a pixel off at most, unless the slices are
/// given by hand.
fn reach(params: &Params) -> Reach {
    match params.resolution.slices {
        0 => Reach::Pixels(1.0),
        _ => Reach::Image,
    }
}
