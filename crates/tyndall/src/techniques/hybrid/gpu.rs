//! The GPU side: the bounds, the light.

use bytemuck::{Pod, Zeroable};

use super::{Params, Show};
use crate::{
    effect::{CountValue, LightInputs},
    error::PrepareError,
    gpu::{
        layout,
        pass::Pass,
        program::ScreenProgram,
        scope::{LightScope, Shared},
        shader::{AIRLIGHT, MARCH, STRETCH},
    },
    occluder::{
        Occluder,
        gpu::{self as volumes, Names, TILE, VolumePrograms, check_list},
    },
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
pub(crate) fn check(
    limits: &wgpu::Limits,
    index: usize,
    inputs: &LightInputs<'_>,
) -> Result<(), PrepareError> {
    check_list(limits, index, inputs.occluders.unwrap_or_default())
}

/// The technique's shaders.
pub(crate) struct Programs {
    volumes: VolumePrograms,
    hybrid: ScreenProgram,
}

impl Programs {
    pub(crate) fn new(device: &wgpu::Device, shared: &Shared) -> Self {
        let own = [
            layout::uniform::<ParamsUniform>(0),
            layout::storage(1, true),
            layout::airlight(2),
        ];
        let modules = [AIRLIGHT, STRETCH, MARCH, TILE, HYBRID];
        Self {
            volumes: VolumePrograms::new(device, shared),
            hybrid: ScreenProgram::new(device, shared, "hybrid", &modules, "hybrid", &own),
        }
    }
}

/// The passes of one light.
pub(crate) fn passes(
    params: &Params,
    programs: &Programs,
    scope: &mut LightScope<'_>,
) -> Vec<Pass> {
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
    let bounds = match occluders.filter(|occluders| !occluders.is_empty()) {
        None => scope.storage("hybrid no bounds", 8),
        Some(occluders) => {
            count(occluders, scope);
            let (found, tiles) = volumes::passes(&NAMES, occluders, &programs.volumes, scope);
            passes.extend(found);
            scope.witness = Some(tiles.clone());
            tiles
        }
    };
    let airlight = scope.airlight();
    let resources = [
        uniform.as_entire_binding(),
        bounds.as_entire_binding(),
        wgpu::BindingResource::TextureView(&airlight),
    ];
    passes.push(scope.full_screen(&programs.hybrid, "hybrid", &resources));
    passes
}

fn count(occluders: &[Occluder<'_>], scope: &mut LightScope<'_>) {
    let edges = occluders.iter().map(|o| u64::from(o.mesh.edges())).sum();
    scope.count("edges of shadow volumes,", CountValue::Known(edges));
}
