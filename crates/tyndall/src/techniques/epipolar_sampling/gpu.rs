//! The GPU side: the article's stages, each a pass, one WGSL file a stage.

use bytemuck::{Pod, Zeroable};
use wgpu::{BindGroupLayoutEntry, BindingResource, TextureFormat};

use super::{Criterion, Params, Show, Sizes};
use crate::{
    epipolar::epipole::Epipole,
    gpu::{
        layout,
        pass::{Dispatch, Pass, Work, Workgroups},
        program::{ComputeProgram, ScreenProgram},
        scope::{LightScope, Shared},
        shader::{AIRLIGHT, SCREEN, STRETCH, TRACE},
    },
};

/// Parameters that all stages read.
pub(crate) const COMMON: &str = include_str!("common.wgsl");
const COARSE: &str = include_str!("coarse.wgsl");
const MARCH: &str = include_str!("march.wgsl");
const UNSHADOWED: &str = include_str!("unshadowed.wgsl");
const GROUP_SIZE: &str = include_str!("group.wgsl");

/// Invocations a group of the stages over samples, slices and lists.
const GROUP: u32 = 64;
/// Invocations a group of refinement and marking.
const SECTION_GROUP: u32 = 256;
/// Pixels a group of the stages over pictures.
const TILE: [u32; 2] = [16, 8];
/// Levels of the tree that a dispatch builds.
const LEVELS_A_DISPATCH: u32 = 4;
/// Lists: samples to march, coarse pixels to correct, pixels to correct.
const LISTS: u64 = 3;

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
    linear_depth: ComputeProgram,
    slice_ends: ComputeProgram,
    coordinates: ComputeProgram,
    refine: ComputeProgram,
    mark: ComputeProgram,
    slice_directions: ComputeProgram,
    tree: ComputeProgram,
    march_samples: ComputeProgram,
    correct: ComputeProgram,
    interpolate: ComputeProgram,
    unwarp: ComputeProgram,
    upscale: ComputeProgram,
    finish: ScreenProgram,
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

impl Programs {
    pub(crate) fn new(device: &wgpu::Device, shared: &Shared) -> Self {
        use Slot::{Airlight, Correct, Picture, Read, Texels, Tree, Write};
        const DEPTH: Slot = Picture(TextureFormat::R32Float);
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
            linear_depth: program!(ComputeProgram, "linear_depth", &[], &[DEPTH]).for_all_lights(),
            slice_ends: program!(ComputeProgram, "slice_ends", &[], &[Write; 3]).for_all_lights(),
            coordinates: program!(ComputeProgram, "coordinates", &[], &[Texels, Read, Write])
                .for_all_lights(),
            refine: program!(
                ComputeProgram,
                "refine",
                LIT,
                &[Read, Read, Write, Airlight]
            ),
            mark: program!(
                ComputeProgram,
                "mark",
                &[],
                &[Read, Read, Write, Write, Write]
            )
            .for_all_lights(),
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
                &[Read, Read, Read, Read, Write, Airlight, Read, Read]
            ),
            correct: program!(
                ComputeProgram,
                "correct",
                MARCHING,
                &[Correct, Texels, Read, Read, VALUES, Airlight, Read, Read]
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
                &[COARSE],
                &[Texels, Read, Texels, VALUES, Write, Write, Write]
            )
            .for_all_lights(),
            upscale: program!(
                ComputeProgram,
                "upscale",
                &[COARSE],
                &[Texels, Texels, VALUES, Write, Write, Write]
            )
            .for_all_lights(),
            finish: program!(
                ScreenProgram,
                "finish",
                LIT,
                &[Texels, Texels, Read, Read, Airlight]
            ),
        }
    }
}

/// What the stages of one light hand on.
struct Resources {
    params: wgpu::Buffer,
    linear_depth: wgpu::TextureView,
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
    coarse: wgpu::TextureView,
    coarse_list: wgpu::Buffer,
    airlight: wgpu::TextureView,
}

impl Resources {
    fn new(params: &Params, sizes: &Sizes, scope: &mut LightScope<'_>) -> Self {
        let epipole = Epipole::new(scope.rays, scope.size, &scope.light.emitter);
        let uniform = ParamsUniform::new(params, sizes, &epipole);
        let bytes = sizes.bytes();
        Self {
            params: scope.uniform("epipolar params", &uniform),
            linear_depth: scope.storage_texture(
                "linear depth",
                scope.size,
                TextureFormat::R32Float,
            ),
            lines: scope.storage("slice ends", bytes.lines),
            depth: scope.storage("sample depths", bytes.depth),
            sources: scope.storage("interpolation sources", bytes.sources),
            counts: scope.storage("list lengths", 4 * LISTS),
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
            coarse: scope.storage_texture(
                "rectangular values",
                sizes.coarse,
                TextureFormat::Rgba32Float,
            ),
            coarse_list: scope.storage("corrected pixels", bytes.coarse_list),
            airlight: scope.airlight(),
        }
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

/// The passes of one light.
pub(crate) fn passes(
    params: &Params,
    programs: &Programs,
    scope: &mut LightScope<'_>,
) -> Vec<Pass> {
    let sizes = Sizes::new(params, scope.size, scope.light, &scope.inputs);
    let r = Resources::new(params, &sizes, scope);
    let mut passes = locate(programs, &sizes, scope, &r);
    passes.extend(gather(programs, &sizes, scope, &r));
    passes.extend(rectangular(params, programs, &sizes, scope, &r));
    passes
}

/// Where samples lie, which of them are marched: stages 1 to 5.
fn locate(programs: &Programs, sizes: &Sizes, scope: &LightScope<'_>, r: &Resources) -> Vec<Pass> {
    let sections = [sizes.samples.div_ceil(SECTION_GROUP), sizes.slices, 1];
    let by_sample = [sizes.samples.div_ceil(GROUP), sizes.slices, 1];
    vec![
        scope.compute(
            &programs.linear_depth,
            "linear depth",
            &[buffer(&r.params), view(&r.linear_depth)],
            tiles(scope.size),
        ),
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
            "coordinate texture",
            &[
                buffer(&r.params),
                view(&r.linear_depth),
                buffer(&r.lines),
                buffer(&r.depth),
            ],
            by_sample,
        ),
        scope.compute(
            &programs.refine,
            "refinement",
            &[
                buffer(&r.params),
                buffer(&r.lines),
                buffer(&r.depth),
                buffer(&r.sources),
                view(&r.airlight),
            ],
            sections,
        ),
        scope.compute(
            &programs.mark,
            "marking",
            &[
                buffer(&r.params),
                buffer(&r.depth),
                buffer(&r.sources),
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
            buffer(&r.lines),
            buffer(&r.depth),
            buffer(&r.marched),
            buffer(&r.counts),
            buffer(&r.values),
            view(&r.airlight),
            buffer(&r.traces),
            buffer(&r.nodes),
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

/// Back to a picture: stages 10 to 13, and the phase function.
fn rectangular(
    params: &Params,
    programs: &Programs,
    sizes: &Sizes,
    scope: &mut LightScope<'_>,
    r: &Resources,
) -> Vec<Pass> {
    let mut passes = vec![scope.compute(
        &programs.unwarp,
        "unwarping",
        &[
            buffer(&r.params),
            view(&r.linear_depth),
            buffer(&r.lines),
            view(&r.samples),
            view(&r.coarse),
            buffer(&r.coarse_list),
            buffer(&r.counts),
            buffer(&r.dispatches),
        ],
        tiles(sizes.coarse),
    )];
    passes.push(correct(
        programs,
        scope,
        r,
        "correction",
        (1, params.downscale),
        &r.coarse_list,
        &r.coarse,
    ));
    let mut values = r.coarse.clone();
    if params.downscale > 1 {
        let list = scope.storage("upscaled, corrected pixels", sizes.bytes().list);
        values = scope.storage_texture("upscaled values", scope.size, TextureFormat::Rgba32Float);
        passes.push(scope.compute(
            &programs.upscale,
            "upscaling",
            &[
                buffer(&r.params),
                view(&r.linear_depth),
                view(&r.coarse),
                view(&values),
                buffer(&list),
                buffer(&r.counts),
                buffer(&r.dispatches),
            ],
            tiles(scope.size),
        ));
        passes.push(correct(
            programs,
            scope,
            r,
            "second correction",
            (2, 1),
            &list,
            &values,
        ));
    }
    passes.push(scope.full_screen(
        &programs.finish,
        "phase function",
        &[
            buffer(&r.params),
            view(&values),
            view(&r.linear_depth),
            buffer(&r.lines),
            buffer(&r.sources),
            view(&r.airlight),
        ],
    ));
    passes
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
        buffer(&uniform),
        view(&r.linear_depth),
        buffer(pixels),
        buffer(&r.counts),
        view(out),
        view(&r.airlight),
        buffer(&r.traces),
        buffer(&r.nodes),
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
