//! The order of the passes: the article's stages, each a Rust and a WESL file.

use super::{
    coordinates::Coordinates,
    correct::Correct,
    finish::Finish,
    finish_points::FinishPoints,
    interpolate::Interpolate,
    march_samples::MarchSamples,
    params::{Params, Show},
    refine::Refine,
    resources::{Image, Resources},
    sizes::{self, Sizes},
    slice_directions::SliceDirections,
    slice_ends::SliceEnds,
    tree::Tree,
    unwarp::Unwarp,
    unwarp_finish::UnwarpFinish,
    upscale::Upscale,
    view::View,
};
use crate::{
    error::PrepareError,
    gpu::{
        cache,
        pass::{LightPasses, Pass},
        scope::{LightScope, Shared},
    },
    techniques::method::{GpuMethod, LightRequest},
};

/// The technique's programs, one a pass.
pub(crate) struct Programs {
    slice_ends: SliceEnds,
    coordinates: Coordinates,
    refine: Refine,
    slice_directions: SliceDirections,
    tree: Tree,
    march_samples: MarchSamples,
    interpolate: Interpolate,
    unwarp: Unwarp,
    unwarp_finish: UnwarpFinish,
    correct: Correct,
    upscale: Upscale,
    finish: Finish,
    finish_points: FinishPoints,
    view: View,
}

impl cache::Programs for Programs {
    fn new(device: &wgpu::Device, shared: &Shared) -> Self {
        Self {
            slice_ends: SliceEnds::new(device, shared),
            coordinates: Coordinates::new(device, shared),
            refine: Refine::new(device, shared),
            slice_directions: SliceDirections::new(device, shared),
            tree: Tree::new(device, shared),
            march_samples: MarchSamples::new(device, shared),
            interpolate: Interpolate::new(device, shared),
            unwarp: Unwarp::new(device, shared),
            unwarp_finish: UnwarpFinish::new(device, shared),
            correct: Correct::new(device, shared),
            upscale: Upscale::new(device, shared),
            finish: Finish::new(device, shared),
            finish_points: FinishPoints::new(device, shared),
            view: View::new(device, shared),
        }
    }
}

impl GpuMethod for Params {
    fn check_light(&self, request: &LightRequest<'_>) -> Result<(), PrepareError> {
        sizes::check(self, request)
    }

    fn passes(&self, scope: &mut LightScope<'_>) -> LightPasses {
        passes(self, scope)
    }
}

/// The passes of one light.
fn passes(params: &Params, scope: &mut LightScope<'_>) -> LightPasses {
    let programs = scope.programs::<Programs>();
    let programs = programs.as_ref();
    let sizes = Sizes::new(params, scope.size, scope.light, &scope.inputs);
    let r = Resources::new(params, &sizes, scope);
    let mut passes = programs.sample(scope, &sizes, &r);
    let image = r.rectangular(&sizes, scope);
    // Through a stencil the last pass alone draws.
    let is_direct = scope.stencil.is_none() && params.downscale == 1 && params.show == Show::Light;
    let (more, last) = if is_direct {
        programs.unwarp_directly(scope, &r, &image)
    } else {
        programs.unwarp_rectangular(params, scope, &sizes, &r, image)
    };
    passes.extend(more);
    LightPasses::new(passes, last)
}

impl Programs {
    /// Stages 1 to 9: the samples and their mean visibilities.
    fn sample(&self, scope: &mut LightScope<'_>, sizes: &Sizes, r: &Resources) -> Vec<Pass> {
        let mut passes = vec![
            self.slice_ends.pass(scope, sizes, r),
            self.coordinates.pass(scope, sizes, r),
            self.refine.pass(scope, sizes, r),
            self.slice_directions.pass(scope, sizes, r),
        ];
        if sizes.levels > 0 {
            passes.push(self.tree.pass(scope, sizes, r));
        }
        passes.push(self.march_samples.pass(scope, r));
        passes.push(self.interpolate.pass(scope, sizes, r));
        passes
    }

    /// Stage 10 and the phase function in one, and again for the pixels that stage 11 corrects.
    fn unwarp_directly(
        &self,
        scope: &mut LightScope<'_>,
        r: &Resources,
        image: &Image,
    ) -> (Vec<Pass>, Pass) {
        let passes = vec![
            self.unwarp_finish.pass(scope, r, image),
            self.correct.coarse(scope, r, image, 1),
        ];
        (passes, self.finish_points.pass(scope, r, image))
    }

    /// Stages 10 to 13 by way of a rectangular texture, then the phase function or a debug view.
    fn unwarp_rectangular(
        &self,
        params: &Params,
        scope: &mut LightScope<'_>,
        sizes: &Sizes,
        r: &Resources,
        mut image: Image,
    ) -> (Vec<Pass>, Pass) {
        let mut passes = vec![
            self.unwarp.pass(scope, sizes, r, &image),
            self.correct.coarse(scope, r, &image, params.downscale),
        ];
        if params.downscale > 1 {
            let (upscaled, pass) = self.upscale.pass(scope, sizes, r, &image);
            passes.push(pass);
            passes.push(self.correct.upscaled(scope, r, &upscaled));
            image = upscaled;
        }
        let last = match params.show {
            Show::Light => self.finish.pass(scope, r, &image),
            _ => self.view.pass(scope, r, &image),
        };
        (passes, last)
    }
}
