//! The GPU side: the shadow map's pyramid, the rectified trees, and the pass that traverses them.

use std::sync::Arc;

use bytemuck::{Pod, Zeroable};

use super::{
    params::{INFO, Integrator, Params, Show},
    svd,
};
use crate::{
    epipolar::grid::EpipolarGrid,
    error::PrepareError,
    frame::{Emitter, Light},
    gpu::{
        cache, layout, limits,
        pass::{LightPasses, Pass},
        program::{ComputeProgram, ScreenProgram},
        scope::{LightScope, Shared},
        shader::{AIRLIGHT, STRETCH},
    },
    inputs::LightInputs,
    passes::{
        epipolar::{EPIPOLAR, EpipolarUniform, with_scene},
        pyramid::{self, PYRAMID, Source},
    },
    physics::medium::Optics,
    techniques::Reach,
    techniques::method::{GpuMethod, LightRequest},
};

pub(crate) const TREE: &str = include_str!("tree.wgsl");
pub(crate) const RECTIFY: &str = include_str!("rectify.wgsl");
const SHOW: &str = include_str!("show.wgsl");
const TRAVERSE: &str = include_str!("traverse.wgsl");
const WALK: &str = include_str!("../../shadow/walk.wgsl");

/// Leaves that a workgroup of `rectify.wgsl` takes.
const LEAVES_A_WORKGROUP: u32 = 512;

const TINT: &str = include_str!("tint.wgsl");
const TINT_ROWS: &str = include_str!("tint_rows.wgsl");
const TINT_MEAN: &str = include_str!("tint_mean.wgsl");
const SVD: &str = include_str!("svd.wgsl");
const SVD_STRETCH: &str = include_str!("svd_stretch.wgsl");
const GLASS: &str = include_str!("glass.wgsl");

/// Columns of tints a slice: those of the svd integrator, whose rows are as many as its terms (Chen 2011, section 4.3),
/// and the least of the analytic one, for a coarse shadow map may go with a fine picture.
const TINT_COLUMNS: usize = 512;

/// `Svd` of `svd.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct SvdUniform {
    pub(crate) beta_start: f32,
    pub(crate) beta_step: f32,
    pub(crate) gamma_start: f32,
    pub(crate) gamma_step: f32,
    pub(crate) rank: u32,
    pad: [u32; 3],
}

/// The technique's shaders.
pub(crate) struct Programs {
    pyramid: Arc<pyramid::Programs>,
    rectify: ComputeProgram,
    rectify_glass: ComputeProgram,
    /// Of the analytic and of the svd integrator.
    tint_rows: [ComputeProgram; 2],
    traverse: [ScreenProgram; 2],
    show: ScreenProgram,
}

impl cache::Programs for Programs {
    fn new(device: &wgpu::Device, shared: &Shared) -> Self {
        let rectify = || {
            let own = [
                layout::uniform::<EpipolarUniform>(0),
                layout::texel_layers(1),
                layout::storage(2, false),
            ];
            let modules = [EPIPOLAR, PYRAMID, TREE, RECTIFY];
            ComputeProgram::new(device, shared, "rectify", &modules, "rectify", &own)
        };
        let tint_rows = || {
            let own = [
                layout::uniform::<EpipolarUniform>(0),
                layout::uniform::<SvdUniform>(1),
                layout::storage(2, true),
                layout::storage(3, false),
            ];
            let modules = [EPIPOLAR, SVD, TINT, TINT_ROWS];
            ComputeProgram::new(device, shared, "tint rows", &modules, "tint_rows", &own)
        };
        let own = [
            layout::uniform::<EpipolarUniform>(0),
            layout::storage(1, true),
            layout::airlight(2),
            layout::storage(3, true),
            layout::storage(4, true),
            layout::uniform::<SvdUniform>(5),
            layout::storage(6, true),
        ];
        let traversal: &[&str] = &[
            AIRLIGHT,
            STRETCH,
            EPIPOLAR,
            WALK,
            TREE,
            SVD,
            TINT,
            TINT_MEAN,
            SVD_STRETCH,
            GLASS,
        ];
        let traverse = || {
            let modules = [traversal, &[TRAVERSE]].concat();
            ScreenProgram::new(device, shared, "traverse", &modules, "traverse", &own)
        };
        let show = [traversal, &[TRAVERSE, SHOW]].concat();
        let show_own = [&own[..], &[layout::uniform::<[u32; 4]>(7)]].concat();
        Self {
            pyramid: shared.programs(device),
            rectify: rectify(),
            rectify_glass: rectify().with("RECTIFY_GLASS", 1.0),
            tint_rows: [0.0, 1.0].map(|svd| tint_rows().with("SVD", svd)),
            traverse: [0.0, 1.0].map(|svd| traverse().with("SVD", svd)),
            show: ScreenProgram::new(device, shared, "show", &show, "show", &show_own),
        }
    }
}

impl GpuMethod for Params {
    fn check_light(&self, request: &LightRequest<'_>) -> Result<(), PrepareError> {
        check(self, request)
    }

    fn reach(&self) -> Reach {
        reach(self)
    }

    fn passes(&self, scope: &mut LightScope<'_>) -> LightPasses {
        passes(self, scope)
    }
}

/// The passes of one light.
fn passes(params: &Params, scope: &mut LightScope<'_>) -> LightPasses {
    let programs = scope.programs::<Programs>();
    let programs = programs.as_ref();
    let grid = grid(params, scope);
    let is_svd = params.integrator == Integrator::Svd;
    let epipolar = grid.map_or(EpipolarUniform::NONE, |grid| {
        EpipolarUniform::new(&grid, tint_columns(params, grid.samples))
    });
    let uniform = scope.uniform("epipolar grid", &epipolar);
    let rows = tint_rows(params, scope.light, &scope.inputs);
    let bytes = Bytes::new(&epipolar, &scope.inputs, rows);
    let (svd, svd_factors) = svd(scope, grid.as_ref().filter(|_| is_svd), params.rank);
    let nodes = scope.storage("min-max nodes", bytes.nodes);
    let tint_sums = scope.storage("tint sums", bytes.tint_sums);
    let glass_nodes = scope.storage("glass nodes", bytes.glass_nodes);
    let mut passes = Vec::new();
    if grid.is_some() {
        let inputs = scope.inputs;
        let sources = [
            (Source::ShadowMap, inputs.shadow_map, &nodes),
            (Source::Glass, inputs.glass, &glass_nodes),
        ];
        for (source, picture, nodes) in sources {
            if let Some(picture) = picture {
                let size = [picture.texture().width(), picture.texture().height()];
                passes.extend(rectify(
                    programs, scope, source, size, &uniform, &epipolar, nodes,
                ));
            }
        }
        if let Some(rows) = rows {
            let resources =
                [&uniform, &svd, &svd_factors, &tint_sums].map(|b| b.as_entire_binding());
            let program = &programs.tint_rows[usize::from(is_svd)];
            let groups = [epipolar.slices, rows, 1];
            passes.push(scope.compute(program, "sum up picture", &resources, groups));
        }
    }
    let airlight = scope.airlight();
    let resources = [
        uniform.as_entire_binding(),
        nodes.as_entire_binding(),
        wgpu::BindingResource::TextureView(&airlight),
        tint_sums.as_entire_binding(),
        glass_nodes.as_entire_binding(),
        svd.as_entire_binding(),
        svd_factors.as_entire_binding(),
    ];
    let last = if params.show == Show::Light {
        let program = &programs.traverse[usize::from(is_svd)];
        scope.full_screen(program, "traverse", &resources)
    } else {
        let what = scope.uniform("show", &[params.show as u32, 0, 0, 0]);
        let resources = [&resources[..], &[what.as_entire_binding()]].concat();
        scope.full_screen(&programs.show, "show", &resources)
    };
    LightPasses::new(passes, last)
}

/// How far from its ray a pixel looks: at the slice beside it, which is half a pixel off at most, unless the slices are
/// given by hand.
fn reach(params: &Params) -> Reach {
    match params.resolution.slices {
        0 => Reach::Pixels(1.0),
        _ => Reach::Image,
    }
}

/// Columns of tints a slice of so many samples.
fn tint_columns(params: &Params, samples: usize) -> usize {
    match params.integrator {
        Integrator::Svd => TINT_COLUMNS,
        Integrator::Analytic => samples.max(TINT_COLUMNS),
    }
}

/// Rows of tints a slice, where there are any: one, or one a term of the svd integrator, which sums up cones, too.
fn tint_rows(params: &Params, light: &Light, inputs: &LightInputs<'_>) -> Option<u32> {
    let has_picture = inputs.texture.is_some();
    match params.integrator {
        Integrator::Analytic => has_picture.then_some(1),
        Integrator::Svd => {
            let has_cone = matches!(light.emitter, Emitter::Spot { .. });
            (has_picture || has_cone).then_some(params.rank)
        }
    }
}

/// Refuses a light whose buffers would be larger than the device binds.
fn check(params: &Params, request: &LightRequest<'_>) -> Result<(), PrepareError> {
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
            ("slices x samples of its picture", bytes.tint_sums),
        ],
    )
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
    let factors = svd::factors(grid, &optics, rank as usize);
    let [beta_start, beta_step, gamma_start, gamma_step] = factors.axes().map(|x| x as f32);
    let uniform = SvdUniform {
        beta_start,
        beta_step,
        gamma_start,
        gamma_step,
        rank,
        pad: [0; 3],
    };
    let samples = factors.samples();
    let uniform = scope.uniform("svd", &uniform);
    (uniform, scope.upload("svd factors", &samples))
}

/// The passes that make trees of a picture the light sees, of `size` texels a face.
fn rectify(
    programs: &Programs,
    scope: &mut LightScope<'_>,
    source: Source,
    size: [u32; 2],
    uniform: &wgpu::Buffer,
    grid: &EpipolarUniform,
    nodes: &wgpu::Buffer,
) -> [Pass; 2] {
    let faces = scope.light.faces();
    let (pyramid, build) = pyramid::build(&programs.pyramid, scope, source, size, faces);
    let (program, name) = match source {
        Source::ShadowMap => (&programs.rectify, "shadow trees"),
        Source::Glass => (&programs.rectify_glass, "glass trees"),
    };
    let resources = [
        uniform.as_entire_binding(),
        wgpu::BindingResource::TextureView(&pyramid),
        nodes.as_entire_binding(),
    ];
    let groups = [grid.samples.div_ceil(LEAVES_A_WORKGROUP), grid.slices, 1];
    [build, scope.compute(program, name, &resources, groups)]
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
            glass_nodes: if_used(inputs.glass.is_some(), nodes),
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
