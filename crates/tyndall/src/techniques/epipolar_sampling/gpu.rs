//! The GPU side: the article's stages, each a pass, one WGSL file a stage.

use bytemuck::{Pod, Zeroable};
use wgpu::{BindGroupLayoutEntry, BindingResource, TextureFormat};

use super::{
    params::{Criterion, Params, Show},
    sizes::{self, Sizes},
};
use crate::{
    epipolar::epipole::Epipole,
    error::PrepareError,
    gpu::{
        cache, layout,
        pass::{Dispatch, FullScreen, LightPasses, Pass, Work, Workgroups},
        program::{ComputeProgram, Raster, ScreenProgram},
        scope::{LightScope, Shared},
        shader::{AIRLIGHT, SCREEN, STRETCH, TRACE},
    },
    techniques::method::{GpuMethod, LightRequest},
};

/// Parameters that all stages read.
pub(crate) const COMMON: &str = include_str!("common.wgsl");
const COARSE: &str = include_str!("coarse.wgsl");
const MARCH: &str = include_str!("march.wgsl");
const UNSHADOWED: &str = include_str!("unshadowed.wgsl");
const FILTER: &str = include_str!("filter.wgsl");
const OUTPUT: &str = include_str!("output.wgsl");
const POINTS: &str = include_str!("points.wgsl");
const GROUP_SIZE: &str = include_str!("group.wgsl");

/// Invocations a group of the stages over samples, slices and lists.
const GROUP: u32 = 64;
/// Invocations a group of refinement.
const SECTION_GROUP: u32 = 256;
/// Pixels a group of the stages over pictures.
const TILE: [u32; 2] = [16, 8];
/// Levels of the tree that a dispatch builds.
const LEVELS_A_DISPATCH: u32 = 4;
/// Lists: samples to march, coarse pixels to correct, pixels to correct.
const LISTS: u64 = 3;
/// From the length of one list to the next: that of an indirect draw.
const COUNT_BYTES: u64 = 16;

/// `SamplingParams` of `common.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct ParamsUniform {
    pub(crate) epipole: [f32; 3],
    pub(crate) slices: u32,
    pub(crate) axis: [f32; 3],
    pub(crate) samples: u32,
    pub(crate) initial_step: u32,
    pub(crate) threshold: f32,
    pub(crate) criterion: u32,
    pub(crate) columns: u32,
    pub(crate) levels: u32,
    pub(crate) downscale: u32,
    pub(crate) show: u32,
    pad: u32,
    pub(crate) coarse_size: [u32; 2],
    pub(crate) arc: [f32; 2],
}

/// `TreeParams` of `tree.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct TreeUniform {
    pub(crate) base: u32,
    pad: [u32; 3],
}

/// `CorrectParams` of `correct.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct CorrectUniform {
    pub(crate) list: u32,
    pub(crate) downscale: u32,
    pad: [u32; 2],
}

impl ParamsUniform {
    fn new(params: &Params, sizes: &Sizes, epipole: &Epipole) -> Self {
        Self {
            epipole: epipole.place.as_vec3().to_array(),
            slices: sizes.slices,
            axis: epipole.axis.as_vec3().to_array(),
            samples: sizes.samples,
            initial_step: params.initial_step,
            threshold: params.threshold as f32,
            criterion: match params.criterion {
                Criterion::Depth => 0,
                Criterion::InScatter => 1,
            },
            columns: sizes.columns,
            levels: sizes.levels,
            downscale: params.downscale,
            show: match params.show {
                Show::Light => 0,
                Show::Samples => 1,
                Show::DepthBreaks => 2,
                Show::Corrected => 3,
                Show::InScatter => 4,
            },
            pad: 0,
            coarse_size: sizes.coarse,
            arc: epipole.arc.map(|x| x as f32),
        }
    }
}

/// The technique's programs, one a stage.
pub(crate) struct Programs {
    slice_ends: ComputeProgram,
    coordinates: ComputeProgram,
    refine: ComputeProgram,
    slice_directions: ComputeProgram,
    tree: ComputeProgram,
    march_samples: ComputeProgram,
    correct: ComputeProgram,
    interpolate: ComputeProgram,
    unwarp: ComputeProgram,
    upscale: ComputeProgram,
    finish: ScreenProgram,
    unwarp_finish: ScreenProgram,
    finish_points: ScreenProgram,
    view: ScreenProgram,
}

/// What a stage binds after its parameters.
#[derive(Clone, Copy)]
enum Slot {
    Tree,
    Correct,
    Airlight,
    Read,
    Write,
    Texels,
    Picture(TextureFormat),
}

fn own(slots: &[Slot]) -> Vec<BindGroupLayoutEntry> {
    let entry = |(binding, slot): (u32, &Slot)| match *slot {
        Slot::Tree => layout::uniform::<TreeUniform>(binding),
        Slot::Correct => layout::uniform::<CorrectUniform>(binding),
        Slot::Airlight => layout::airlight(binding),
        Slot::Read => layout::storage(binding, true),
        Slot::Write => layout::storage(binding, false),
        Slot::Texels => layout::texels(binding),
        Slot::Picture(format) => layout::storage_texture(binding, format),
    };
    let mut entries = vec![layout::uniform::<ParamsUniform>(0)];
    entries.extend((1..).zip(slots).map(entry));
    entries
}

impl cache::Programs for Programs {
    fn new(device: &wgpu::Device, shared: &Shared) -> Self {
        use Slot::{Airlight, Correct, Picture, Read, Texels, Tree, Write};
        const VALUES: Slot = Picture(TextureFormat::Rgba32Float);
        const LIT: &[&str] = &[AIRLIGHT, STRETCH, UNSHADOWED];
        const MARCHING: &[&str] = &[AIRLIGHT, STRETCH, UNSHADOWED, TRACE, COARSE, MARCH];
        macro_rules! program {
            ($kind:ident, $name:literal, $modules:expr, $slots:expr) => {{
                let mut wgsl = vec![COMMON, SCREEN, GROUP_SIZE];
                wgsl.extend_from_slice($modules);
                wgsl.push(include_str!(concat!($name, ".wgsl")));
                $kind::new(device, shared, $name, &wgsl, $name, &own($slots))
            }};
        }
        Self {
            slice_ends: program!(ComputeProgram, "slice_ends", &[], &[Write; 3]).for_all_lights(),
            coordinates: program!(ComputeProgram, "coordinates", &[], &[Read, Write])
                .for_all_lights(),
            refine: program!(
                ComputeProgram,
                "refine",
                LIT,
                &[Read, Read, Write, Airlight, Write, Write, Write]
            ),
            slice_directions: program!(
                ComputeProgram,
                "slice_directions",
                &[TRACE],
                &[Read, Write]
            ),
            tree: program!(ComputeProgram, "tree", &[TRACE], &[Tree, Read, Write]),
            march_samples: program!(
                ComputeProgram,
                "march_samples",
                MARCHING,
                &[Read, Read, Airlight, Read, Read, Read, Read, Write]
            ),
            correct: program!(
                ComputeProgram,
                "correct",
                MARCHING,
                &[Read, Read, Airlight, Correct, Read, Read, VALUES]
            ),
            interpolate: program!(
                ComputeProgram,
                "interpolate",
                &[],
                &[Read, Read, Read, VALUES]
            )
            .for_all_lights(),
            unwarp: program!(
                ComputeProgram,
                "unwarp",
                &[COARSE, FILTER],
                &[VALUES, Write, Write, Read, Texels, Write]
            )
            .for_all_lights(),
            upscale: program!(
                ComputeProgram,
                "upscale",
                &[COARSE],
                &[Texels, VALUES, Write, Write, Write]
            )
            .for_all_lights(),
            finish: program!(
                ScreenProgram,
                "finish",
                &[AIRLIGHT, STRETCH, UNSHADOWED, OUTPUT],
                &[Texels, Airlight]
            ),
            unwarp_finish: program!(
                ScreenProgram,
                "unwarp_finish",
                &[AIRLIGHT, STRETCH, UNSHADOWED, OUTPUT, FILTER],
                &[Write, Write, Airlight, Read, Texels, Write]
            ),
            finish_points: program!(
                ScreenProgram,
                "finish",
                &[AIRLIGHT, STRETCH, UNSHADOWED, OUTPUT, POINTS],
                &[Texels, Airlight, Read]
            )
            .drawing(Raster {
                vertex: "finish_point",
                topology: wgpu::PrimitiveTopology::PointList,
                ..Raster::full_screen(shared.output.into())
            }),
            view: program!(ScreenProgram, "view", &[], &[Texels, Read, Read]).for_all_lights(),
        }
    }
}

/// What the stages of one light hand on.
struct Resources {
    params: wgpu::Buffer,
    lines: wgpu::Buffer,
    depth: wgpu::Buffer,
    sources: wgpu::Buffer,
    /// How long the lists are, and workgroups for each.
    counts: wgpu::Buffer,
    dispatches: wgpu::Buffer,
    marched: wgpu::Buffer,
    traces: wgpu::Buffer,
    nodes: wgpu::Buffer,
    /// What marched samples see.
    values: wgpu::Buffer,
    /// What all samples see, and their depth.
    samples: wgpu::TextureView,
    airlight: wgpu::TextureView,
}

impl Resources {
    fn new(params: &Params, sizes: &Sizes, scope: &mut LightScope<'_>) -> Self {
        let epipole = Epipole::new(scope.rays, scope.size, &scope.light.emitter);
        let uniform = ParamsUniform::new(params, sizes, &epipole);
        let bytes = sizes.bytes();
        Self {
            params: scope.uniform("epipolar params", &uniform),
            lines: scope.storage("slice ends", bytes.lines),
            depth: scope.storage("sample depths", bytes.depth),
            sources: scope.storage("interpolation sources", bytes.sources),
            counts: scope.indirect_draws("list lengths", LISTS),
            dispatches: scope.indirect("list workgroups", LISTS),
            marched: scope.storage("marched samples", bytes.sources),
            traces: scope.storage("slice directions", bytes.traces),
            nodes: scope.storage("min/max trees", bytes.nodes),
            values: scope.storage("marched values", bytes.values),
            samples: scope.storage_texture(
                "sample values",
                [sizes.samples, sizes.slices],
                TextureFormat::Rgba32Float,
            ),
            airlight: scope.airlight(),
        }
    }

    /// The rectangular picture, and the list of its pixels that are corrected.
    fn rectangular(
        &self,
        sizes: &Sizes,
        scope: &mut LightScope<'_>,
    ) -> (wgpu::Buffer, wgpu::TextureView) {
        let format = TextureFormat::Rgba32Float;
        (
            scope.storage("corrected pixels", sizes.bytes().coarse_list),
            scope.storage_texture("rectangular values", sizes.coarse, format),
        )
    }

    fn indirect(&self, list: u64) -> Workgroups {
        Workgroups::Indirect(self.dispatches.clone(), 12 * list)
    }
}

fn view(texture: &wgpu::TextureView) -> BindingResource<'_> {
    BindingResource::TextureView(texture)
}

fn buffer(buffer: &wgpu::Buffer) -> BindingResource<'_> {
    buffer.as_entire_binding()
}

fn tiles([width, height]: [u32; 2]) -> [u32; 3] {
    [width.div_ceil(TILE[0]), height.div_ceil(TILE[1]), 1]
}

impl GpuMethod for Params {
    fn check_light(&self, request: &LightRequest<'_>) -> Result<(), PrepareError> {
        sizes::check(self, request)
    }

    fn passes(&self, scope: &mut LightScope<'_>) -> LightPasses {
        passes(self, scope)
    }
}

/// The passes of one light.
fn passes(params: &Params, scope: &mut LightScope<'_>) -> LightPasses {
    let programs = scope.programs::<Programs>();
    let programs = programs.as_ref();
    let sizes = Sizes::new(params, scope.size, scope.light, &scope.inputs);
    let r = Resources::new(params, &sizes, scope);
    let mut passes = locate(programs, &sizes, scope, &r);
    passes.extend(gather(programs, &sizes, scope, &r));
    // Through a stencil the last pass alone draws.
    let is_direct = scope.stencil.is_none() && params.downscale == 1 && params.show == Show::Light;
    let (more, last) = if is_direct {
        direct(programs, &sizes, scope, &r)
    } else {
        rectangular(params, programs, &sizes, scope, &r)
    };
    passes.extend(more);
    LightPasses::new(passes, last)
}

/// Where samples lie, which of them are marched: stages 1 to 5.
fn locate(programs: &Programs, sizes: &Sizes, scope: &LightScope<'_>, r: &Resources) -> Vec<Pass> {
    let sections = [sizes.samples.div_ceil(SECTION_GROUP), sizes.slices, 1];
    let by_sample = [sizes.samples.div_ceil(GROUP), sizes.slices, 1];
    vec![
        scope.compute(
            &programs.slice_ends,
            "slice end points",
            &[
                buffer(&r.params),
                buffer(&r.lines),
                buffer(&r.counts),
                buffer(&r.dispatches),
            ],
            [sizes.slices.div_ceil(GROUP), 1, 1],
        ),
        scope.compute(
            &programs.coordinates,
            "linear depth and coordinate texture",
            &[buffer(&r.params), buffer(&r.lines), buffer(&r.depth)],
            by_sample,
        ),
        scope.compute(
            &programs.refine,
            "refinement and marking",
            &[
                buffer(&r.params),
                buffer(&r.lines),
                buffer(&r.depth),
                buffer(&r.sources),
                view(&r.airlight),
                buffer(&r.marched),
                buffer(&r.counts),
                buffer(&r.dispatches),
            ],
            sections,
        ),
    ]
}

/// What the samples see: stages 6 to 9.
fn gather(
    programs: &Programs,
    sizes: &Sizes,
    scope: &mut LightScope<'_>,
    r: &Resources,
) -> Vec<Pass> {
    let mut passes = vec![scope.compute(
        &programs.slice_directions,
        "slice directions",
        &[buffer(&r.params), buffer(&r.lines), buffer(&r.traces)],
        [sizes.slices.div_ceil(GROUP), 1, 1],
    )];
    if sizes.levels > 0 {
        passes.push(Pass {
            name: scope.pass_name("min/max tree"),
            work: Work::Compute(tree(programs, sizes, scope, r)),
        });
    }
    passes.push(scope.compute(
        &programs.march_samples,
        "ray marching",
        &[
            buffer(&r.params),
            buffer(&r.traces),
            buffer(&r.nodes),
            view(&r.airlight),
            buffer(&r.lines),
            buffer(&r.depth),
            buffer(&r.marched),
            buffer(&r.counts),
            buffer(&r.values),
        ],
        r.indirect(0),
    ));
    passes.push(scope.compute(
        &programs.interpolate,
        "interpolation",
        &[
            buffer(&r.params),
            buffer(&r.sources),
            buffer(&r.depth),
            buffer(&r.values),
            view(&r.samples),
        ],
        [sizes.samples.div_ceil(GROUP), sizes.slices, 1],
    ));
    passes
}

/// The dispatches that build all trees, from the leaves up.
fn tree(
    programs: &Programs,
    sizes: &Sizes,
    scope: &mut LightScope<'_>,
    r: &Resources,
) -> Vec<Dispatch> {
    const NAMES: [&str; 4] = ["tree 0", "tree 4", "tree 8", "tree 12"];
    let starts = (0..sizes.levels).step_by(LEVELS_A_DISPATCH as usize);
    let dispatch = |(base, name): (u32, &'static str)| {
        let invocations = (sizes.columns >> base).div_ceil(1 << LEVELS_A_DISPATCH);
        let uniform = scope.uniform(name, &TreeUniform { base, pad: [0; 3] });
        scope.dispatch(
            &programs.tree,
            &[
                buffer(&r.params),
                buffer(&uniform),
                buffer(&r.traces),
                buffer(&r.nodes),
            ],
            [invocations.div_ceil(GROUP), sizes.slices * sizes.charts, 1],
        )
    };
    starts.zip(NAMES).map(dispatch).collect()
}

/// Back to a picture at full resolution: stage 10 and the phase function in one, and again for the pixels that stage 11
/// corrects.
fn direct(
    programs: &Programs,
    sizes: &Sizes,
    scope: &mut LightScope<'_>,
    r: &Resources,
) -> (Vec<Pass>, Pass) {
    let (list, values) = r.rectangular(sizes, scope);
    let unwarp = scope.full_screen(
        &programs.unwarp_finish,
        "unwarping and phase function",
        &[
            buffer(&r.params),
            buffer(&list),
            buffer(&r.counts),
            view(&r.airlight),
            buffer(&r.lines),
            view(&r.samples),
            buffer(&r.dispatches),
        ],
    );
    let correction = correct(programs, scope, r, "correction", (1, 1), &list, &values);
    let points = scope.draw(
        &programs.finish_points,
        &[
            buffer(&r.params),
            view(&values),
            view(&r.airlight),
            buffer(&list),
        ],
        scope.target.clone(),
    );
    let points = FullScreen {
        gate: Some((r.counts.clone(), COUNT_BYTES)),
        ..points
    };
    let points = Pass {
        name: scope.pass_name("corrected pixels"),
        work: Work::FullScreen(vec![points]),
    };
    (vec![unwarp, correction], points)
}

/// Back to a picture by way of a rectangular one: stages 10 to 13, and the phase function or a debug view.
fn rectangular(
    params: &Params,
    programs: &Programs,
    sizes: &Sizes,
    scope: &mut LightScope<'_>,
    r: &Resources,
) -> (Vec<Pass>, Pass) {
    let (list, coarse) = r.rectangular(sizes, scope);
    let unwarp = scope.compute(
        &programs.unwarp,
        "unwarping",
        &[
            buffer(&r.params),
            view(&coarse),
            buffer(&list),
            buffer(&r.counts),
            buffer(&r.lines),
            view(&r.samples),
            buffer(&r.dispatches),
        ],
        tiles(sizes.coarse),
    );
    let pixels = (1, params.downscale);
    let mut passes = vec![
        unwarp,
        correct(programs, scope, r, "correction", pixels, &list, &coarse),
    ];
    let mut values = coarse;
    if params.downscale > 1 {
        let (upscaled, passes_there) = upscale(programs, sizes, scope, r, &values);
        passes.extend(passes_there);
        values = upscaled;
    }
    let last = match params.show {
        Show::Light => scope.full_screen(
            &programs.finish,
            "phase function",
            &[buffer(&r.params), view(&values), view(&r.airlight)],
        ),
        _ => scope.full_screen(
            &programs.view,
            "view",
            &[
                buffer(&r.params),
                view(&values),
                buffer(&r.lines),
                buffer(&r.sources),
            ],
        ),
    };
    (passes, last)
}

/// To full resolution: stages 12 and 13.
fn upscale(
    programs: &Programs,
    sizes: &Sizes,
    scope: &mut LightScope<'_>,
    r: &Resources,
    coarse: &wgpu::TextureView,
) -> (wgpu::TextureView, [Pass; 2]) {
    let list = scope.storage("upscaled, corrected pixels", sizes.bytes().list);
    let values = scope.storage_texture("upscaled values", scope.size, TextureFormat::Rgba32Float);
    let pass = scope.compute(
        &programs.upscale,
        "upscaling",
        &[
            buffer(&r.params),
            view(coarse),
            view(&values),
            buffer(&list),
            buffer(&r.counts),
            buffer(&r.dispatches),
        ],
        tiles(scope.size),
    );
    let correction = correct(
        programs,
        scope,
        r,
        "second correction",
        (2, 1),
        &list,
        &values,
    );
    (values, [pass, correction])
}

/// Marches the pixels of a list, of a picture that is `downscale` times smaller than the full one.
fn correct(
    programs: &Programs,
    scope: &mut LightScope<'_>,
    r: &Resources,
    name: &'static str,
    (list, downscale): (u32, u32),
    pixels: &wgpu::Buffer,
    out: &wgpu::TextureView,
) -> Pass {
    let uniform = CorrectUniform {
        list,
        downscale,
        pad: [0; 2],
    };
    let uniform = scope.uniform(name, &uniform);
    let own = [
        buffer(&r.params),
        buffer(&r.traces),
        buffer(&r.nodes),
        view(&r.airlight),
        buffer(&uniform),
        buffer(pixels),
        buffer(&r.counts),
        view(out),
    ];
    scope.compute(&programs.correct, name, &own, r.indirect(list.into()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::shader::FRAME_MODULES;
    use tyndall_testkit::{rust_layout, shader::Shader};

    #[test]
    fn parameters_are_laid_out_as_in_wgsl() {
        let modules = [FRAME_MODULES, &[SCREEN, COMMON]].concat();
        let shader = Shader::new(&modules).expect("it is valid");
        let found = shader.struct_layout("SamplingParams").expect("it is there");
        let ours = rust_layout!(ParamsUniform {
            epipole,
            slices,
            axis,
            samples,
            initial_step,
            threshold,
            criterion,
            columns,
            levels,
            downscale,
            show,
            coarse_size,
            arc,
        });
        assert_eq!(found, ours);
    }
}
