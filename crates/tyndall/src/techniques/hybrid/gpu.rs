//! The GPU side: the passes of the shadows' bounds, and the one that integrates.

use std::sync::Arc;

use super::params::{Params, Show};
use crate::{
    error::PrepareError,
    gpu::{
        cache,
        pass::LightPasses,
        program::ScreenProgram,
        scope::{LightScope, Shared},
    },
    inputs::CountValue,
    mesh::Occluder,
    passes::occluder::{self as volumes, Names, VolumePrograms, check_list},
    shader::{block, constant},
    techniques::{
        info::Reach,
        method::{GpuMethod, LightRequest},
    },
};

block! {
    /// The shaders' `HybridParams`.
    struct ParamsUniform = "HybridParams" in "tyndall::techniques::hybrid::hybrid", checked by hybrid_params_is_laid_out_as_in_wgsl {
        steps: u32,
        bounds: u32,
        show: u32,
        pad: u32,
    }
}

const NAMES: Names = Names {
    places: "hybrid places",
    params: "hybrid occluders",
    list: "hybrid list",
    counts: "hybrid counts",
    eye: "hybrid eye in shadow",
    tiles: "hybrid tiles",
};

/// Refuses lists of silhouettes that the device cannot bind.
fn check(request: &LightRequest<'_>) -> Result<(), PrepareError> {
    let occluders = request.inputs.occluders.unwrap_or_default();
    check_list(request.limits, request.index, occluders)
}

/// The technique's shaders.
pub(crate) struct Programs {
    volumes: Arc<VolumePrograms>,
    hybrid: ScreenProgram,
}

impl cache::Programs for Programs {
    fn new(device: &wgpu::Device, shared: &Shared) -> Self {
        let module = "techniques::hybrid::hybrid";
        Self {
            volumes: shared.programs(device),
            hybrid: ScreenProgram::new(device, shared, module, "hybrid"),
        }
    }
}

impl GpuMethod for Params {
    fn check_light(&self, request: &LightRequest<'_>) -> Result<(), PrepareError> {
        check(request)
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
    let inputs = scope.inputs;
    // Outside the volumes light textures and glass still tint.
    let is_plain = inputs.glass.is_none() && scope.light.texture.is_none();
    let occluders = inputs.occluders.filter(|_| is_plain);
    let uniform = ParamsUniform {
        steps: params.steps,
        bounds: constant(match occluders {
            None => "HYBRID_UNKNOWN",
            Some([]) => "HYBRID_NONE",
            Some(_) => "HYBRID_BOUNDED",
        }),
        show: constant(match params.show {
            Show::Light => "HYBRID_SHOW_LIGHT",
            Show::Bounds => "HYBRID_SHOW_BOUNDS",
        }),
        pad: 0,
    };
    let uniform = scope.uniform("hybrid params", &uniform);
    let mut passes = Vec::new();
    let mut witness = None;
    let bounds = match occluders.filter(|occluders| !occluders.is_empty()) {
        None => scope.storage("hybrid no bounds", size_of::<[f32; 2]>() as u64),
        Some(occluders) => {
            count(occluders, scope);
            let (found, tiles) = volumes::passes(&NAMES, occluders, &programs.volumes, scope);
            passes.extend(found);
            witness = Some(tiles.clone());
            tiles
        }
    };
    let resources = [uniform.as_entire_binding(), bounds.as_entire_binding()];
    LightPasses {
        before: passes,
        last: scope.full_screen(&programs.hybrid, "hybrid", &resources),
        witness,
        visibility: None,
    }
}

fn count(occluders: &[Occluder<'_>], scope: &mut LightScope<'_>) {
    let edges = occluders.iter().map(|o| u64::from(o.mesh.edges())).sum();
    scope.count("edges of shadow volumes,", CountValue::Known(edges));
}
