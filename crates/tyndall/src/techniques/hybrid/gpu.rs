//! The GPU side: the bounds, the light.

use std::sync::Arc;

use bytemuck::{Pod, Zeroable};

use super::params::{Params, Show};
use crate::{
    error::PrepareError,
    gpu::{
        cache, layout,
        pass::LightPasses,
        program::ScreenProgram,
        scope::{LightScope, Shared},
        shader::{AIRLIGHT, MARCH, STRETCH},
    },
    inputs::CountValue,
    mesh::Occluder,
    passes::occluder::{self as volumes, Names, TILE, VolumePrograms, check_list},
    techniques::info::Reach,
    techniques::method::{GpuMethod, LightRequest},
};

/// The pass that writes the light.
pub(crate) const HYBRID: &str = include_str!("hybrid.wgsl");

/// `HybridParams` of `hybrid.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct ParamsUniform {
    pub(crate) steps: u32,
    pub(crate) bounds: u32,
    pub(crate) show: u32,
    pad: u32,
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
        let own = [
            layout::uniform::<ParamsUniform>(0),
            layout::storage(1, true),
            layout::airlight(2),
        ];
        let modules = [AIRLIGHT, STRETCH, MARCH, TILE, HYBRID];
        Self {
            volumes: shared.programs(device),
            hybrid: ScreenProgram::new(device, shared, "hybrid", &modules, "hybrid", &own),
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
    // Outside the volumes pictures and glass still tint.
    let is_plain = inputs.glass.is_none() && scope.light.texture.is_none();
    let occluders = inputs.occluders.filter(|_| is_plain);
    let uniform = ParamsUniform {
        steps: params.steps,
        bounds: match occluders {
            None => 0,
            Some([]) => 1,
            Some(_) => 2,
        },
        show: match params.show {
            Show::Light => 0,
            Show::Bounds => 1,
        },
        pad: 0,
    };
    let uniform = scope.uniform("hybrid params", &uniform);
    let mut passes = Vec::new();
    let mut witness = None;
    let bounds = match occluders.filter(|occluders| !occluders.is_empty()) {
        None => scope.storage("hybrid no bounds", 8),
        Some(occluders) => {
            count(occluders, scope);
            let (found, tiles) = volumes::passes(&NAMES, occluders, &programs.volumes, scope);
            passes.extend(found);
            witness = Some(tiles.clone());
            tiles
        }
    };
    let airlight = scope.airlight();
    let resources = [
        uniform.as_entire_binding(),
        bounds.as_entire_binding(),
        wgpu::BindingResource::TextureView(&airlight),
    ];
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
