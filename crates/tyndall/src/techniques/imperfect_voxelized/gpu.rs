//! The GPU side: maps, voxels and their scan of a batch of samples at a time, gathered into one picture.

use std::sync::{Arc, OnceLock};

use bytemuck::{Pod, Zeroable};
use rayon::prelude::*;

use super::{
    params::{Gather, INFO, Params},
    surface,
};
use crate::{
    epipolar::{
        Resolution,
        grid::{EpipolarGrid, GridScene},
    },
    error::PrepareError,
    frame::Medium,
    gpu::{
        cache, layout,
        pass::{LightPasses, Pass},
        program::{ComputeProgram, ScreenProgram},
        scope::{LightScope, Shared},
    },
    inputs::{CountValue, LightInputs},
    light::LightSource,
    passes::{
        epipolar::{EPIPOLAR, EpipolarUniform},
        fill::Fill,
        imperfect::gpu::{self as imperfect, AreaLight, BatchUniform, IMPERFECT, LOOKUP, Maps},
        voxels::gpu::{self as voxels, Scan, VOXELS},
    },
    techniques::method::{GpuMethod, LightRequest},
};

const RECTIFY: &str = include_str!("rectify.wgsl");
pub(super) const PARAMS: &str = include_str!("params.wgsl");
pub(super) const SAMPLES: &str = include_str!("samples.wgsl");
const GATHER: &str = include_str!("gather.wgsl");
pub(super) const FILTER: &str = include_str!("filter.wgsl");
const RESOLVE: &str = include_str!("resolve.wgsl");

/// Light rays that a workgroup of `rectify.wgsl` takes.
const RAYS_A_WORKGROUP: u32 = 64 * 32;
/// Pixels that a workgroup of `gather.wgsl` takes.
const TILE: [u32; 2] = [8, 16];

/// `IvsvParams` of `params.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(super) struct ParamsUniform {
    pub(super) size: [u32; 2],
    pitch: u32,
    turns: u32,
    weighting: u32,
    taps: u32,
    spread: u32,
    pad: u32,
}

impl ParamsUniform {
    fn new(params: &Params, size: [u32; 2]) -> Self {
        let (pitch, turns, taps, spread) = match params.gather {
            Gather::Full => (1, 1, 1, 1),
            Gather::Interleaved => (1, 9, 9, 3),
            Gather::Quarter => (2, 1, 4, 1),
        };
        Self {
            size: size.map(|n| n.div_ceil(pitch)),
            pitch,
            turns,
            weighting: params.weighting as u32,
            taps,
            spread,
            pad: 0,
        }
    }

    /// Workgroups that take so many pixels each, see `ivsv_place` of `params.wgsl`.
    pub(super) fn groups(&self, tile: [u32; 2]) -> [u32; 3] {
        let along = |axis: usize| {
            let tiles = self.size[axis].div_ceil(self.spread * tile[axis]);
            self.spread * tiles
        };
        [along(0), along(1), 1]
    }

    pub(super) fn pixels(&self) -> u64 {
        u64::from(self.size[0]) * u64::from(self.size[1])
    }
}

/// The technique's shaders.
pub(crate) struct Programs {
    maps: Arc<imperfect::Programs>,
    fill: Arc<Fill>,
    scan: Arc<Scan>,
    rectify: ComputeProgram,
    /// By the number of the medium's components, made when they are first asked for.
    gather: [OnceLock<ComputeProgram>; Medium::MAX_COMPONENTS + 1],
    resolve: ScreenProgram,
    /// Made when they are first asked for.
    surface: OnceLock<surface::Programs>,
}

impl cache::Programs for Programs {
    fn new(device: &wgpu::Device, shared: &Shared) -> Self {
        let batch = layout::uniform::<BatchUniform>(0);
        let read = |binding| layout::storage(binding, true);
        let compute = |label, modules: &[&str], entry_point, own: &[_]| {
            ComputeProgram::new(device, shared, label, modules, entry_point, own)
        };
        let own = [batch, read(1), read(2), read(3), layout::storage(4, false)];
        let modules = [EPIPOLAR, IMPERFECT, LOOKUP, VOXELS, RECTIFY];
        let rectify = compute("rectify", &modules, "rectify", &own);
        let own = [batch, layout::uniform::<ParamsUniform>(1), read(2)];
        let modules = [IMPERFECT, PARAMS, FILTER, RESOLVE];
        Self {
            maps: shared.programs(device),
            fill: shared.programs(device),
            scan: shared.programs(device),
            rectify,
            gather: Default::default(),
            resolve: ScreenProgram::new(device, shared, "resolve", &modules, "ivsv_resolve", &own),
            surface: OnceLock::new(),
        }
    }
}

impl Programs {
    fn gather(&self, device: &wgpu::Device, shared: &Shared, components: usize) -> &ComputeProgram {
        let components = components.min(Medium::MAX_COMPONENTS);
        let make = || {
            let own = batch_entries(&[layout::storage(7, false)]);
            let modules = [EPIPOLAR, IMPERFECT, LOOKUP, VOXELS, PARAMS, SAMPLES, GATHER];
            ComputeProgram::new(device, shared, "gather", &modules, "ivsv_gather", &own)
                .with("MEDIUM_COMPONENTS", components as f64)
        };
        self.gather[components].get_or_init(make)
    }
}

/// What all batches of a light share.
pub(super) struct Buffers {
    pub(super) light: imperfect::Buffers,
    grids: wgpu::Buffer,
    voxels: wgpu::Buffer,
    pub(super) params: wgpu::Buffer,
    sums: wgpu::Buffer,
}

/// The bindings of a pass over the samples of a batch: those of `samples.wgsl`, and the pass's own.
pub(super) fn batch_entries(own: &[wgpu::BindGroupLayoutEntry]) -> Vec<wgpu::BindGroupLayoutEntry> {
    let batch = layout::uniform::<BatchUniform>(0);
    let params = layout::uniform::<ParamsUniform>(6);
    let read = (1..6).map(|binding| layout::storage(binding, true));
    let shared = std::iter::once(batch).chain(read).chain([params]);
    shared.chain(own.iter().copied()).collect()
}

impl Buffers {
    /// The resources of a pass over the samples of a batch, as in [`batch_entries`].
    pub(super) fn of_batch<'a, const N: usize>(
        &'a self,
        index: u32,
        own: [wgpu::BindingResource<'a>; N],
    ) -> Vec<wgpu::BindingResource<'a>> {
        let shared = [
            self.light.batches.binding(index),
            self.light.samples.as_entire_binding(),
            self.grids.as_entire_binding(),
            self.light.maps.as_entire_binding(),
            self.voxels.as_entire_binding(),
            self.light.colors.as_entire_binding(),
            self.params.as_entire_binding(),
        ];
        shared.into_iter().chain(own).collect()
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

/// The passes of one light: five a batch, and two; one more of each where shadows on surfaces are asked for.
fn passes(params: &Params, scope: &mut LightScope<'_>) -> LightPasses {
    let programs = scope.programs::<Programs>();
    let programs = programs.as_ref();
    // Others than rectangles are refused by the table.
    let area = AreaLight::new(&scope.light.emitter).unwrap_or_default();
    let samples = area.positions.len() as u32;
    let maps = maps(params, samples, &scope.inputs, &scope.device.limits());
    let picture = ParamsUniform::new(params, scope.size);
    let (light, sample) = programs.maps.sample(scope, &area, &maps);
    let bytes = voxels::bytes(params.resolution) * u64::from(maps.batch);
    let buffers = Buffers {
        light,
        grids: scope.upload("grids of the samples", &grids(params, &area, scope)),
        voxels: scope.storage("voxels of the samples", bytes),
        params: scope.uniform("ivsv params", &picture),
        sums: scope.storage("gathered light", 16 * picture.pixels()),
    };
    let surface = scope.surface_shadows.map(|shadows| {
        let sums = surface::Sums::new(scope, shadows, &picture);
        let make = || surface::Programs::new(scope.device, scope.shared);
        (programs.surface.get_or_init(make), sums)
    });
    let mut passes = vec![sample];
    for batch in 0..buffers.light.batches.values.len() as u32 {
        if let Some(cloud) = scope.inputs.points {
            passes.extend(
                programs
                    .maps
                    .draw(scope, &buffers.light, batch, cloud.points),
            );
            passes.extend(voxelize(
                programs,
                scope,
                &buffers,
                batch,
                params.resolution,
            ));
        }
        passes.push(gather(programs, scope, &buffers, batch, &picture));
        if let Some((programs, sums)) = &surface {
            passes.push(sums.add(programs, scope, &buffers, batch, &picture));
        }
    }
    let visibility = surface.map(|(programs, sums)| {
        let (pass, visibility) = sums.resolve(programs, scope, &buffers);
        passes.push(pass);
        visibility
    });
    let resources = [
        buffers.light.batches.binding(0),
        buffers.params.as_entire_binding(),
        buffers.sums.as_entire_binding(),
    ];
    let last = scope.full_screen(&programs.resolve, "resolve", &resources);
    count(scope, &passes, &last, u64::from(samples));
    LightPasses {
        before: passes,
        last,
        witness: None,
        visibility,
    }
}

/// The voxels of a batch.
fn voxelize(
    programs: &Programs,
    scope: &mut LightScope<'_>,
    buffers: &Buffers,
    index: u32,
    side: u32,
) -> [Pass; 2] {
    let count = buffers.light.batches.values[index as usize].count;
    let clear = programs
        .fill
        .dispatch(scope, "no voxel", &buffers.voxels, 0);
    let resources = [
        buffers.light.batches.binding(index),
        buffers.light.samples.as_entire_binding(),
        buffers.grids.as_entire_binding(),
        buffers.light.maps.as_entire_binding(),
        buffers.voxels.as_entire_binding(),
    ];
    let groups = [side * side / RAYS_A_WORKGROUP, 1, count];
    let rectify = scope.dispatch(&programs.rectify, &resources, groups);
    [
        Pass::compute(scope.pass_name("voxelize"), vec![clear, rectify]),
        programs.scan.pass(scope, side, &buffers.voxels, count),
    ]
}

fn gather(
    programs: &Programs,
    scope: &LightScope<'_>,
    buffers: &Buffers,
    index: u32,
    picture: &ParamsUniform,
) -> Pass {
    let resources = buffers.of_batch(index, [buffers.sums.as_entire_binding()]);
    let components = scope.frame.medium.components.len();
    let program = programs.gather(scope.device, scope.shared, components);
    scope.compute(program, "gather", &resources, picture.groups(TILE))
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
            EpipolarUniform::new(&grid.in_rows(&scene, params.resolution), 1)
        })
    };
    area.positions.par_iter().map(grid).collect()
}

/// How the maps are made, and how many samples' maps and voxels the device binds at once.
fn maps(params: &Params, samples: u32, inputs: &LightInputs<'_>, limits: &wgpu::Limits) -> Maps {
    let at_once = if params.batched { samples } else { 1 };
    let bytes = voxels::bytes(params.resolution);
    Maps::new(inputs, params.points, at_once, bytes, limits)
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

/// Refuses what the device cannot bind.
fn check(params: &Params, request: &LightRequest<'_>) -> Result<(), PrepareError> {
    let LightRequest {
        limits,
        size,
        index,
        inputs,
        ..
    } = *request;
    let pixels = ParamsUniform::new(params, size).pixels();
    let others = [
        ("voxels of a sample", voxels::bytes(params.resolution)),
        ("gathered light", 16 * pixels),
    ];
    maps(params, 1, inputs, limits).check(INFO.name, index, limits, &others)
}
