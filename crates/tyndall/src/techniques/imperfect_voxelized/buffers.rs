//! Buffers that all batches of a light share.

use rayon::prelude::*;

use super::params::{Gather, INFO, Params, Weighting};
use crate::{
    epipolar::{
        Resolution,
        grid::{EpipolarGrid, GridScene},
    },
    error::PrepareError,
    gpu::{program::ComputeProgram, scope::LightScope},
    inputs::LightInputs,
    light::LightSource,
    passes::{
        epipolar::EpipolarUniform,
        imperfect::{
            area::{AreaLight, Maps},
            buffers as imperfect,
        },
        voxels::grid as voxels,
    },
    shader::{block, constant},
    techniques::method::LightRequest,
};

block! {
    /// The shaders' `IvsvParams`.
    pub(super) struct ParamsUniform = "IvsvParams" in "tyndall::techniques::imperfect_voxelized::params", checked by ivsv_params_is_laid_out_as_in_wgsl {
        pub(super) size: [u32; 2],
        pitch: u32,
        turns: u32,
        is_uniform: u32,
        taps: u32,
        spread: u32,
        pad: u32,
    }
}

impl ParamsUniform {
    fn new(params: &Params, size: [u32; 2]) -> Self {
        let window = constant("IVSV_WINDOW");
        let (pitch, turns, taps, spread) = match params.gather {
            Gather::Full => (1, 1, 1, 1),
            Gather::Interleaved => (1, window * window, window * window, window),
            Gather::Quarter => (2, 1, 4, 1),
        };
        Self {
            size: size.map(|n| n.div_ceil(pitch)),
            pitch,
            turns,
            is_uniform: u32::from(params.weighting == Weighting::Uniform),
            taps,
            spread,
            pad: 0,
        }
    }

    /// Workgroups of a program whose threads take `rows` pixels each; `ivsv_place` finds them.
    pub(super) fn workgroups(&self, program: &ComputeProgram, rows: u32) -> [u32; 3] {
        let [width, height] = self.size.map(|n| n.div_ceil(self.spread));
        let [x, y, _] = program.workgroups([width, height.div_ceil(rows), 1]);
        [self.spread * x, self.spread * y, 1]
    }

    pub(super) fn pixels(&self) -> u64 {
        u64::from(self.size[0]) * u64::from(self.size[1])
    }
}

/// Buffers that all batches of a light share.
pub(super) struct Buffers {
    /// Slices, view rays and light rays of a grid, each.
    pub(super) side: u32,
    pub(super) light: imperfect::Buffers,
    grids: wgpu::Buffer,
    pub(super) voxels: wgpu::Buffer,
    /// Content of `params`.
    pub(super) uniform: ParamsUniform,
    params: wgpu::Buffer,
    pub(super) sums: wgpu::Buffer,
}

impl Buffers {
    pub(super) fn new(
        params: &Params,
        scope: &mut LightScope<'_>,
        area: &AreaLight,
        light: imperfect::Buffers,
        batch: u32,
    ) -> Self {
        let uniform = ParamsUniform::new(params, scope.size);
        let bytes = voxels::bytes(params.resolution) * u64::from(batch);
        Self {
            side: params.resolution,
            light,
            grids: scope.upload("grids of the samples", &grids(params, area, scope)),
            voxels: scope.storage("voxels of the samples", bytes),
            uniform,
            params: scope.uniform("ivsv params", &uniform),
            sums: scope.storage("gathered light", 16 * uniform.pixels()),
        }
    }

    /// The resources of a pass over the samples of a batch, by their bindings in `bindings.wesl` and `samples.wesl`, and
    /// the pass's own from 7 on.
    pub(super) fn of_batch<'a, const N: usize>(
        &'a self,
        index: u32,
        own: [wgpu::BindingResource<'a>; N],
    ) -> Vec<wgpu::BindingResource<'a>> {
        let shared = [
            self.light.batches.binding(index),
            self.light.samples.as_entire_binding(),
            self.light.maps.as_entire_binding(),
            self.light.colors.as_entire_binding(),
            self.grids.as_entire_binding(),
            self.voxels.as_entire_binding(),
            self.params.as_entire_binding(),
        ];
        shared.into_iter().chain(own).collect()
    }
}

/// The maps of all samples, and as many at once as the device binds maps and voxels.
pub(super) fn maps(
    params: &Params,
    area: &AreaLight,
    inputs: &LightInputs<'_>,
    limits: &wgpu::Limits,
) -> Maps {
    maps_of(params, area.positions.len() as u32, inputs, limits)
}

fn maps_of(params: &Params, samples: u32, inputs: &LightInputs<'_>, limits: &wgpu::Limits) -> Maps {
    let at_once = if params.batched { samples } else { 1 };
    let bytes = voxels::bytes(params.resolution);
    Maps::new(inputs, params.points, at_once, bytes, limits)
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

/// Refuses what the device cannot bind.
pub(super) fn check(params: &Params, request: &LightRequest<'_>) -> Result<(), PrepareError> {
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
    maps_of(params, 1, inputs, limits).check(INFO.name, index, limits, &others)
}
