//! The GPU side: maps, voxels and their scan of a batch of samples at a time, gathered into one picture.

use bytemuck::{Pod, Zeroable};
use rayon::prelude::*;

use super::{Gather, Params};
use crate::{
    cpu::LightSource,
    effect::{CountValue, LightInputs},
    epipolar::{
        Resolution,
        gpu::{EPIPOLAR, EpipolarUniform},
        grid::{EpipolarGrid, GridScene},
    },
    error::PrepareError,
    frame::{Emitter, Light},
    gpu::{
        layout,
        pass::{Pass, Work},
        program::{ComputeProgram, ScreenProgram},
        scope::{Blocks, LightScope, Shared},
    },
    shadow::imperfect::gpu::{
        self as imperfect, AreaLight, BatchUniform, IMPERFECT, LOOKUP, Maps, NOTHING,
    },
    voxels::gpu::{self as voxels, VOXELS},
};

const VPL_COLORS: &str = include_str!("vpl_colors.wgsl");
const RECTIFY: &str = include_str!("rectify.wgsl");
const PARAMS: &str = include_str!("params.wgsl");
const GATHER: &str = include_str!("gather.wgsl");
const RESOLVE: &str = include_str!("resolve.wgsl");

/// Light rays, and samples, that a workgroup takes.
const THREADS: u32 = 64;
/// Pixels a side that a workgroup of `gather.wgsl` takes.
const TILE: u32 = 8;

/// `IvsvParams` of `params.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
struct ParamsUniform {
    size: [u32; 2],
    pitch: u32,
    turns: u32,
    weighting: u32,
    pad: [u32; 3],
}

impl ParamsUniform {
    fn new(params: &Params, size: [u32; 2]) -> Self {
        let (pitch, turns) = match params.gather {
            Gather::Full => (1, 1),
            Gather::Interleaved => (1, 9),
            Gather::Quarter => (2, 1),
        };
        Self {
            size: size.map(|n| n.div_ceil(pitch)),
            pitch,
            turns,
            weighting: params.weighting as u32,
            pad: [0; 3],
        }
    }

    fn pixels(&self) -> u64 {
        u64::from(self.size[0]) * u64::from(self.size[1])
    }
}

/// The technique's shaders.
pub(crate) struct Programs {
    maps: imperfect::Programs,
    voxels: voxels::Programs,
    colors: ComputeProgram,
    rectify: ComputeProgram,
    gather: ComputeProgram,
    resolve: ScreenProgram,
}

impl Programs {
    pub(crate) fn new(device: &wgpu::Device, shared: &Shared) -> Self {
        let batch = layout::uniform::<BatchUniform>(0);
        let read = |binding| layout::storage(binding, true);
        let compute = |label, modules: &[&str], entry_point, own: &[_]| {
            ComputeProgram::new(device, shared, label, modules, entry_point, own)
        };
        let own = [batch, read(1), layout::storage(2, false)];
        let colors = compute("sample colors", &[IMPERFECT, VPL_COLORS], "vpl_color", &own);
        let own = [batch, read(1), read(2), read(3), layout::storage(4, false)];
        let modules = [EPIPOLAR, IMPERFECT, LOOKUP, VOXELS, RECTIFY];
        let rectify = compute("rectify", &modules, "rectify", &own);
        let own = [
            batch,
            read(1),
            read(2),
            read(3),
            read(4),
            read(5),
            layout::uniform::<ParamsUniform>(6),
            layout::storage(7, false),
        ];
        let modules = [EPIPOLAR, IMPERFECT, LOOKUP, VOXELS, PARAMS, GATHER];
        let gather = compute("gather", &modules, "ivsv_gather", &own);
        let own = [batch, layout::uniform::<ParamsUniform>(1), read(2)];
        let modules = [IMPERFECT, PARAMS, RESOLVE];
        Self {
            maps: imperfect::Programs::new(device, shared),
            voxels: voxels::Programs::new(device, shared),
            colors,
            rectify,
            gather,
            resolve: ScreenProgram::new(device, shared, "resolve", &modules, "ivsv_resolve", &own),
        }
    }
}

/// What all batches of a light share.
struct Buffers {
    batches: Blocks<BatchUniform>,
    samples: wgpu::Buffer,
    grids: wgpu::Buffer,
    maps: wgpu::Buffer,
    voxels: wgpu::Buffer,
    colors: wgpu::Buffer,
    params: wgpu::Buffer,
    sums: wgpu::Buffer,
}

/// The passes of one light: five a batch, and two.
pub(crate) fn passes(
    params: &Params,
    programs: &Programs,
    scope: &mut LightScope<'_>,
) -> Vec<Pass> {
    let Some(area) = AreaLight::new(&scope.light.emitter) else {
        // Refused by the table: it is no rectangle.
        return Vec::new();
    };
    let samples = area.positions.len() as u32;
    let maps = maps(params, samples, &scope.inputs, &scope.device.limits());
    let picture = ParamsUniform::new(params, scope.size);
    let buffers = Buffers {
        batches: scope.blocks("batches", area.batches(&maps)),
        samples: scope.upload("samples", &area.samples(scope.rays.eye, &maps)),
        grids: scope.upload("grids of the samples", &grids(params, &area, scope)),
        maps: scope.storage("imperfect maps", maps.bytes()),
        voxels: scope.storage(
            "voxels of the samples",
            voxels::bytes(params.resolution) * u64::from(maps.batch),
        ),
        colors: scope.storage("colors of the samples", 16 * u64::from(samples)),
        params: scope.uniform("ivsv params", &picture),
        sums: scope.storage("gathered light", 16 * picture.pixels()),
    };
    let resources = [
        buffers.batches.binding(0),
        buffers.samples.as_entire_binding(),
        buffers.colors.as_entire_binding(),
    ];
    let groups = [samples.div_ceil(THREADS), 1, 1];
    let mut passes = vec![scope.compute(&programs.colors, "sample light", &resources, groups)];
    for batch in 0..buffers.batches.values.len() as u32 {
        if let Some(cloud) = scope.inputs.points {
            passes.extend(draw(
                programs,
                scope,
                &buffers,
                batch,
                cloud.points,
                params.resolution,
            ));
        }
        passes.push(gather(programs, scope, &buffers, batch, &picture));
    }
    let resources = [
        buffers.batches.binding(0),
        buffers.params.as_entire_binding(),
        buffers.sums.as_entire_binding(),
    ];
    passes.push(scope.full_screen(&programs.resolve, "resolve", &resources));
    count(scope, &passes, u64::from(samples));
    passes
}

/// The maps and the voxels of a batch.
fn draw(
    programs: &Programs,
    scope: &mut LightScope<'_>,
    buffers: &Buffers,
    index: u32,
    cloud: &wgpu::Buffer,
    side: u32,
) -> [Pass; 4] {
    let batch = (&buffers.batches, index);
    let count = buffers.batches.values[index as usize].count;
    let empty = programs
        .voxels
        .clear(scope, "no surface", &buffers.maps, NOTHING);
    let splat = programs
        .maps
        .splat(scope, batch, &buffers.samples, cloud, &buffers.maps);
    let fill = programs.maps.pull_push(scope, batch, &buffers.maps);
    let clear = programs.voxels.clear(scope, "no voxel", &buffers.voxels, 0);
    let resources = [
        buffers.batches.binding(index),
        buffers.samples.as_entire_binding(),
        buffers.grids.as_entire_binding(),
        buffers.maps.as_entire_binding(),
        buffers.voxels.as_entire_binding(),
    ];
    let groups = [side / THREADS, side, count];
    let rectify = scope.dispatch(&programs.rectify, &resources, groups);
    [
        Pass::compute(scope.pass_name("splat points"), vec![empty, splat]),
        Pass::compute(scope.pass_name("pull-push"), vec![fill]),
        Pass::compute(scope.pass_name("voxelize"), vec![clear, rectify]),
        programs.voxels.scan(scope, side, &buffers.voxels, count),
    ]
}

fn gather(
    programs: &Programs,
    scope: &LightScope<'_>,
    buffers: &Buffers,
    index: u32,
    picture: &ParamsUniform,
) -> Pass {
    let resources = [
        buffers.batches.binding(index),
        buffers.samples.as_entire_binding(),
        buffers.grids.as_entire_binding(),
        buffers.maps.as_entire_binding(),
        buffers.voxels.as_entire_binding(),
        buffers.colors.as_entire_binding(),
        buffers.params.as_entire_binding(),
        buffers.sums.as_entire_binding(),
    ];
    let [x, y] = picture.size.map(|n| n.div_ceil(TILE));
    scope.compute(&programs.gather, "gather", &resources, [x, y, 1])
}

/// The samples' epipolar grids.
fn grids(params: &Params, area: &AreaLight, scope: &LightScope<'_>) -> Vec<EpipolarUniform> {
    let resolution = Resolution {
        slices: params.resolution,
        samples: params.resolution,
        epipole_radius: params.epipole_radius,
    };
    let (camera, size) = (scope.rays, scope.size);
    let grid = |position: &glam::DVec3| {
        let scene = GridScene {
            camera,
            size,
            light: LightSource::Position(position.to_array()),
            cone: Some((area.normal, std::f64::consts::FRAC_PI_2)),
            faces: &[],
            side: params.resolution as usize,
        };
        let none = EpipolarUniform {
            samples: params.resolution,
            slices: params.resolution,
            position: (*position - camera.eye).as_vec3().to_array(),
            ..EpipolarUniform::NONE
        };
        EpipolarGrid::new(&scene, &resolution).map_or(none, |grid| {
            grid.in_rows(&scene, params.resolution).uniform(1)
        })
    };
    area.positions.par_iter().map(grid).collect()
}

/// How the maps are made, and how many samples' maps and voxels the device binds at once.
fn maps(params: &Params, samples: u32, inputs: &LightInputs<'_>, limits: &wgpu::Limits) -> Maps {
    let cloud = inputs
        .points
        .map_or(0, |cloud| (cloud.points.size() / 16) as u32);
    let side = inputs.points.map_or(0, |cloud| cloud.map_side);
    let maps = Maps {
        side,
        points: params.points.min(cloud),
        cloud,
        batch: 1,
    };
    let most =
        limits.max_storage_buffer_binding_size / maps.bytes().max(voxels::bytes(params.resolution));
    let batch = if params.batched { samples } else { 1 };
    Maps {
        batch: u64::from(batch).min(most).max(1) as u32,
        ..maps
    }
}

/// Passes, dispatches and samples of the light.
fn count(scope: &mut LightScope<'_>, passes: &[Pass], samples: u64) {
    let dispatches = |pass: &Pass| match &pass.work {
        Work::Compute(dispatches) => dispatches.len(),
        Work::FullScreen(draws) => draws.len(),
        Work::Draw { draws, .. } => draws.len(),
    };
    let dispatches: usize = passes.iter().map(dispatches).sum();
    for (name, value) in [
        ("samples", samples),
        ("passes", passes.len() as u64),
        ("dispatches and draws", dispatches as u64),
    ] {
        scope.count(name, CountValue::Known(value));
    }
}

/// Refuses what the device cannot bind.
pub(crate) fn check(
    params: &Params,
    limits: &wgpu::Limits,
    size: [u32; 2],
    index: usize,
    light: &Light,
    inputs: &LightInputs<'_>,
) -> Result<(), PrepareError> {
    let Emitter::Rect { .. } = light.emitter else {
        return Ok(());
    };
    let one = maps(params, 1, inputs, limits);
    let limit = limits.max_storage_buffer_binding_size;
    for (what, needed) in [
        ("voxels of a sample", voxels::bytes(params.resolution)),
        ("map of a sample", one.bytes()),
        ("points", 16 * u64::from(one.cloud)),
        (
            "gathered light",
            16 * ParamsUniform::new(params, size).pixels(),
        ),
    ] {
        if needed > limit {
            return Err(PrepareError::Limit {
                what: format!(
                    "{what} of technique `{}` (lights[{index}])",
                    super::INFO.name
                ),
                needed,
                limit,
                name: "max_storage_buffer_binding_size",
            });
        }
    }
    Ok(())
}
