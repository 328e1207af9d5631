//! Buffers that the passes of one light hand on.

use bytemuck::Zeroable;

use super::{
    params::{INFO, Integrator, Params},
    svd::{self, SvdUniform},
};
use crate::{
    epipolar::grid::EpipolarGrid,
    error::PrepareError,
    frame::{Emitter, Light},
    gpu::{limits, scope::LightScope},
    inputs::LightInputs,
    light::light_radius,
    passes::epipolar::{EpipolarUniform, with_scene},
    physics::medium::Optics,
    techniques::method::LightRequest,
};

/// Columns of tints a slice: those of the svd integrator, whose rows are as many as its terms, and the least of the
/// analytic one, for a coarse shadow map may go with a fine texture (Chen 2011, section 3.5, takes 512 as well).
const TINT_COLUMNS: usize = 512;

/// Buffers that the passes of one light hand on.
pub(super) struct Buffers {
    /// Content of `grid`.
    pub(super) epipolar: EpipolarUniform,
    /// False where every ray is walked.
    pub(super) has_slices: bool,
    /// Rows of tints a slice, where there are any.
    pub(super) tint_rows: Option<u32>,
    pub(super) grid: wgpu::Buffer,
    pub(super) svd: wgpu::Buffer,
    pub(super) svd_factors: wgpu::Buffer,
    pub(super) nodes: wgpu::Buffer,
    pub(super) tint_sums: wgpu::Buffer,
    pub(super) glass_nodes: wgpu::Buffer,
}

impl Buffers {
    pub(super) fn new(params: &Params, scope: &mut LightScope<'_>) -> Self {
        let grid = grid(params, scope);
        let is_svd = params.integrator == Integrator::Svd;
        let epipolar = grid.map_or(EpipolarUniform::NONE, |grid| {
            EpipolarUniform::new(&grid, tint_columns(params, grid.samples))
        });
        let tint_rows = tint_rows(params, scope.light, &scope.inputs);
        let bytes = Bytes::new(&epipolar, &scope.inputs, tint_rows);
        let (svd, svd_factors) = svd(scope, grid.as_ref().filter(|_| is_svd), params.rank);
        Self {
            epipolar,
            has_slices: grid.is_some(),
            tint_rows: tint_rows.filter(|_| grid.is_some()),
            grid: scope.uniform("epipolar grid", &epipolar),
            svd,
            svd_factors,
            nodes: scope.storage("min-max nodes", bytes.nodes),
            tint_sums: scope.storage("tint sums", bytes.tint_sums),
            glass_nodes: scope.storage("glass nodes", bytes.glass_nodes),
        }
    }

    /// Bindings of a pass that traverses, by number.
    pub(super) fn traversed(&self) -> [wgpu::BindingResource<'_>; 6] {
        [
            &self.grid,
            &self.svd,
            &self.svd_factors,
            &self.nodes,
            &self.tint_sums,
            &self.glass_nodes,
        ]
        .map(wgpu::Buffer::as_entire_binding)
    }
}

/// Refuses a light whose buffers would be larger than the device binds.
pub(super) fn check(params: &Params, request: &LightRequest<'_>) -> Result<(), PrepareError> {
    let LightRequest {
        limits,
        index,
        light,
        inputs,
        ..
    } = *request;
    let side = inputs
        .shadow_map
        .map_or(1, |map| map.texture().width().max(map.texture().height()));
    let samples = params.resolution.samples_of(side as usize);
    let grid = EpipolarUniform {
        slices: params.resolution.most_slices() as u32,
        samples: samples as u32,
        tint_columns: tint_columns(params, samples) as u32,
        ..EpipolarUniform::NONE
    };
    let bytes = Bytes::new(&grid, inputs, tint_rows(params, light, inputs));
    limits::check_storage(
        limits,
        &format!("technique `{}` (lights[{index}])", INFO.name),
        &[
            ("slices x samples", bytes.nodes),
            ("slices x samples of its glass", bytes.glass_nodes),
            ("slices x samples of its picture", bytes.tint_sums),
        ],
    )
}

/// Columns of tints a slice of so many samples.
fn tint_columns(params: &Params, samples: usize) -> usize {
    match params.integrator {
        Integrator::Svd => TINT_COLUMNS,
        Integrator::Analytic => samples.max(TINT_COLUMNS),
    }
}

/// Rows of tints a slice: one, or one a term of the svd integrator, which sums up cones, too. `None`: nothing tints.
fn tint_rows(params: &Params, light: &Light, inputs: &LightInputs<'_>) -> Option<u32> {
    let has_texture = inputs.texture.is_some();
    match params.integrator {
        Integrator::Analytic => has_texture.then_some(1),
        Integrator::Svd => {
            let has_cone = matches!(light.emitter, Emitter::Spot { .. });
            (has_texture || has_cone).then_some(params.rank)
        }
    }
}

/// Uniform and samples of the svd integrator; nothing for the analytic one.
fn svd(
    scope: &mut LightScope<'_>,
    grid: Option<&EpipolarGrid>,
    rank: u32,
) -> (wgpu::Buffer, wgpu::Buffer) {
    let Some(grid) = grid else {
        let none = scope.uniform("svd", &SvdUniform::zeroed());
        return (none, scope.storage("svd factors", 16));
    };
    let optics = Optics::new(&scope.frame.medium);
    let radius = light_radius(&scope.light.emitter, &scope.frame.camera);
    let factors = svd::factors(grid, &optics, radius, rank as usize);
    let uniform = scope.uniform("svd", &SvdUniform::new(&factors, rank));
    (uniform, scope.upload("svd factors", &factors.samples()))
}

/// Bytes of the buffers; those that nothing reads are as small as a buffer may be.
struct Bytes {
    nodes: u64,
    tint_sums: u64,
    glass_nodes: u64,
}

impl Bytes {
    /// `rows` is the number of rows of tints a slice.
    fn new(grid: &EpipolarUniform, inputs: &LightInputs<'_>, rows: Option<u32>) -> Self {
        let slices = u64::from(grid.slices);
        let if_used = |used: bool, bytes: u64| if used { bytes } else { 16 };
        // Two 16-bit numbers a node, twice as many nodes as leaves.
        let nodes = 8 * slices * u64::from(grid.samples);
        let columns = u64::from(grid.tint_columns) + 1;
        Self {
            nodes: if_used(inputs.shadow_map.is_some(), nodes),
            tint_sums: rows.map_or(16, |rows| 16 * slices * columns * u64::from(rows)),
            // With a tint each.
            glass_nodes: if_used(inputs.glass.is_some(), 2 * nodes),
        }
    }
}

fn grid(params: &Params, scope: &LightScope<'_>) -> Option<EpipolarGrid> {
    let map = scope.inputs.shadow_map.map(|view| view.texture());
    let side = map.map_or(1, |map| map.width().max(map.height())) as usize;
    with_scene(scope, side, |scene| {
        EpipolarGrid::new(scene, &params.resolution)
    })
}
