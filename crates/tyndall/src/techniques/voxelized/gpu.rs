//! The GPU side: voxels of the shadow map, their scan, and the pass that gathers.

use std::sync::Arc;

use super::params::{INFO, Params};
use crate::{
    epipolar::{Resolution, grid::EpipolarGrid},
    error::PrepareError,
    gpu::{
        cache, limits,
        pass::{LightPasses, Pass},
        program::{ComputeProgram, ScreenProgram},
        scope::{LightScope, Shared},
    },
    passes::{
        epipolar::{EpipolarUniform, with_scene},
        fill::Fill,
        voxels::{grid as voxels, scan::Scan},
    },
    techniques::method::{GpuMethod, LightRequest},
};

/// The technique's shaders.
pub(crate) struct Programs {
    fill: Arc<Fill>,
    scan: Arc<Scan>,
    voxelize: ComputeProgram,
    gather: ScreenProgram,
}

impl cache::Programs for Programs {
    fn new(device: &wgpu::Device, shared: &Shared) -> Self {
        Self {
            fill: shared.programs(device),
            scan: shared.programs(device),
            voxelize: ComputeProgram::new(
                device,
                shared,
                "techniques::voxelized::voxelize",
                "voxelize",
            ),
            gather: ScreenProgram::new(device, shared, "techniques::voxelized::gather", "gather"),
        }
    }
}

impl GpuMethod for Params {
    fn check_light(&self, request: &LightRequest<'_>) -> Result<(), PrepareError> {
        check(self, request)
    }

    fn passes(&self, scope: &mut LightScope<'_>) -> LightPasses {
        passes(self, scope)
    }
}

/// The passes of one light.
fn passes(params: &Params, scope: &mut LightScope<'_>) -> LightPasses {
    let programs = scope.programs::<Programs>();
    let programs = programs.as_ref();
    let side = params.resolution;
    let grid = grid(params, scope);
    let none = EpipolarUniform {
        samples: side,
        ..EpipolarUniform::NONE
    };
    let epipolar = grid.map_or(none, |grid| EpipolarUniform::new(&grid, 1));
    let uniform = scope.uniform("epipolar grid", &epipolar);
    let has_voxels = grid.is_some() && scope.inputs.shadow_map.is_some();
    let bytes = if has_voxels { voxels::bytes(side) } else { 16 };
    let bits = scope.storage("voxels", bytes);
    let mut passes = Vec::new();
    if has_voxels {
        let clear = programs.fill.dispatch(scope, "no voxel", &bits, 0);
        let resources = [uniform.as_entire_binding(), bits.as_entire_binding()];
        let groups = programs.voxelize.workgroups([side, side, 1]);
        let voxelize = scope.dispatch(&programs.voxelize, &resources, groups);
        passes.push(Pass::compute(
            scope.pass_name("voxelize"),
            vec![clear, voxelize],
        ));
        passes.push(programs.scan.pass(scope, side, &bits, 1));
    }
    let resources = [uniform.as_entire_binding(), bits.as_entire_binding()];
    LightPasses::new(
        passes,
        scope.full_screen(&programs.gather, "gather", &resources),
    )
}

fn grid(params: &Params, scope: &LightScope<'_>) -> Option<EpipolarGrid> {
    let resolution = Resolution {
        slices: params.resolution,
        samples: params.resolution,
        epipole_radius: params.epipole_radius,
    };
    with_scene(scope, params.resolution as usize, |scene| {
        Some(EpipolarGrid::new(scene, &resolution)?.in_rows(scene, params.resolution))
    })
}

/// Refuses voxels that the device cannot bind.
fn check(params: &Params, request: &LightRequest<'_>) -> Result<(), PrepareError> {
    let of = format!("technique `{}` (lights[{}])", INFO.name, request.index);
    limits::check_storage(
        request.limits,
        &of,
        &[("voxels", voxels::bytes(params.resolution))],
    )
}
