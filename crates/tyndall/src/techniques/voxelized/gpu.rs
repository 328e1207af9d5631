//! The GPU side: voxels of the shadow map, their scan, and the pass that gathers.

use super::Params;
use crate::{
    epipolar::{
        Resolution,
        gpu::{EPIPOLAR, EpipolarUniform, with_scene},
        grid::EpipolarGrid,
    },
    error::PrepareError,
    gpu::{
        fill::Fill,
        layout, limits,
        pass::Pass,
        program::{ComputeProgram, ScreenProgram},
        scope::{LightScope, Shared},
        shader::{AIRLIGHT, STRETCH},
    },
    voxels::gpu::{self as voxels, RUNS, Scan, VOXELS},
};

const LIGHT_RAY: &str = include_str!("light_ray.wgsl");
const VOXELIZE: &str = include_str!("voxelize.wgsl");
const GATHER: &str = include_str!("gather.wgsl");

/// Light rays that a workgroup of `voxelize.wgsl` takes.
const RAYS_A_WORKGROUP: u32 = 64;

/// The technique's shaders.
pub(crate) struct Programs {
    fill: Fill,
    scan: Scan,
    voxelize: ComputeProgram,
    gather: ScreenProgram,
}

impl Programs {
    pub(crate) fn new(device: &wgpu::Device, shared: &Shared) -> Self {
        let own = [
            layout::uniform::<EpipolarUniform>(0),
            layout::storage(1, false),
        ];
        let modules = [EPIPOLAR, VOXELS, LIGHT_RAY, VOXELIZE];
        let voxelize = ComputeProgram::new(device, shared, "voxelize", &modules, "voxelize", &own);
        let own = [
            layout::uniform::<EpipolarUniform>(0),
            layout::storage(1, true),
            layout::airlight(2),
        ];
        let modules = [AIRLIGHT, STRETCH, EPIPOLAR, VOXELS, RUNS, LIGHT_RAY, GATHER];
        Self {
            fill: Fill::new(device, shared),
            scan: Scan::new(device, shared),
            voxelize,
            gather: ScreenProgram::new(device, shared, "gather", &modules, "gather", &own),
        }
    }
}

/// The passes of one light.
pub(crate) fn passes(
    params: &Params,
    programs: &Programs,
    scope: &mut LightScope<'_>,
) -> Vec<Pass> {
    let side = params.resolution;
    let grid = grid(params, scope);
    let none = EpipolarUniform {
        samples: side,
        ..EpipolarUniform::NONE
    };
    let epipolar = grid.map_or(none, |grid| grid.uniform(1));
    let uniform = scope.uniform("epipolar grid", &epipolar);
    let has_voxels = grid.is_some() && scope.inputs.shadow_map.is_some();
    let bytes = if has_voxels { voxels::bytes(side) } else { 16 };
    let bits = scope.storage("voxels", bytes);
    let mut passes = Vec::new();
    if has_voxels {
        let clear = programs.fill.dispatch(scope, "no voxel", &bits, 0);
        let resources = [uniform.as_entire_binding(), bits.as_entire_binding()];
        let groups = [side / RAYS_A_WORKGROUP, side, 1];
        let voxelize = scope.dispatch(&programs.voxelize, &resources, groups);
        passes.push(Pass::compute(
            scope.pass_name("voxelize"),
            vec![clear, voxelize],
        ));
        passes.push(programs.scan.pass(scope, side, &bits, 1));
    }
    let airlight = scope.airlight();
    let resources = [
        uniform.as_entire_binding(),
        bits.as_entire_binding(),
        wgpu::BindingResource::TextureView(&airlight),
    ];
    passes.push(scope.full_screen(&programs.gather, "gather", &resources));
    passes
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
pub(crate) fn check(
    params: &Params,
    limits: &wgpu::Limits,
    index: usize,
) -> Result<(), PrepareError> {
    let of = format!("technique `{}` (lights[{index}])", super::INFO.name);
    limits::check_storage(limits, &of, &[("voxels", voxels::bytes(params.resolution))])
}
