//! The GPU side: the shadow map's pyramid, the rectified trees, and the pass that traverses them.

use glam::DVec3;

use super::Params;
use crate::{
    epipolar::{
        gpu::{EPIPOLAR, EpipolarUniform},
        grid::{EpipolarGrid, GridScene},
    },
    frame::Emitter,
    gpu::{
        layout,
        pass::Pass,
        program::{ComputeProgram, ScreenProgram},
        scope::{LightScope, Shared},
        shader::{AIRLIGHT, STRETCH},
    },
    light::LightModel,
    physics::medium::reals,
    shadow::{
        self,
        pyramid::{self, PYRAMID, Source},
    },
    validate,
};

const TREE: &str = include_str!("tree.wgsl");
const RECTIFY: &str = include_str!("rectify.wgsl");
const TRAVERSE: &str = include_str!("traverse.wgsl");
const WALK: &str = include_str!("../../shadow/walk.wgsl");

/// Leaves that a workgroup of `rectify.wgsl` takes.
const LEAVES_A_WORKGROUP: u32 = 512;

const TINT: &str = include_str!("tint.wgsl");
const TINT_ROWS: &str = include_str!("tint_rows.wgsl");
const TINT_MEAN: &str = include_str!("tint_mean.wgsl");
const GLASS: &str = include_str!("glass.wgsl");

/// The technique's shaders.
pub(crate) struct Programs {
    pyramid: pyramid::Programs,
    rectify: ComputeProgram,
    rectify_glass: ComputeProgram,
    tint_rows: ComputeProgram,
    traverse: ScreenProgram,
}

impl Programs {
    pub(crate) fn new(device: &wgpu::Device, shared: &Shared) -> Self {
        let rectify = || {
            let own = [
                layout::uniform::<EpipolarUniform>(0),
                layout::texel_layers(1),
                layout::storage(2, false),
            ];
            let modules = [EPIPOLAR, PYRAMID, TREE, RECTIFY];
            ComputeProgram::new(device, shared, "rectify", &modules, "rectify", &own)
        };
        Self {
            pyramid: pyramid::Programs::new(device, shared),
            rectify: rectify(),
            rectify_glass: rectify().with("RECTIFY_GLASS", 1.0),
            tint_rows: ComputeProgram::new(
                device,
                shared,
                "tint rows",
                &[EPIPOLAR, TREE, TINT, TINT_ROWS],
                "tint_rows",
                &[
                    layout::uniform::<EpipolarUniform>(0),
                    layout::storage(1, false),
                ],
            ),
            traverse: ScreenProgram::new(
                device,
                shared,
                "traverse",
                &[
                    AIRLIGHT, STRETCH, EPIPOLAR, WALK, TREE, TINT, TINT_MEAN, GLASS, TRAVERSE,
                ],
                "traverse",
                &[
                    layout::uniform::<EpipolarUniform>(0),
                    layout::storage(1, true),
                    layout::airlight(2),
                    layout::storage(3, true),
                    layout::storage(4, true),
                ],
            ),
        }
    }
}

/// The passes of one light.
pub(crate) fn passes(
    params: &Params,
    programs: &Programs,
    scope: &mut LightScope<'_>,
) -> Vec<Pass> {
    let grid = grid(params, scope);
    let epipolar = grid.map_or(EpipolarUniform::NONE, |grid| grid.uniform());
    let uniform = scope.uniform("epipolar grid", &epipolar);
    let bytes = Bytes::new(&epipolar, scope);
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
        if inputs.texture.is_some() {
            let resources = [&uniform, &tint_sums].map(|b| b.as_entire_binding());
            let groups = [epipolar.slices, 1, 1];
            passes.push(scope.compute(&programs.tint_rows, "sum up picture", &resources, groups));
        }
    }
    let airlight = scope.airlight();
    let resources = [
        uniform.as_entire_binding(),
        nodes.as_entire_binding(),
        wgpu::BindingResource::TextureView(&airlight),
        tint_sums.as_entire_binding(),
        glass_nodes.as_entire_binding(),
    ];
    passes.push(scope.full_screen(&programs.traverse, "traverse", &resources));
    passes
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
    let faces = validate::faces(scope.light);
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
    fn new(grid: &EpipolarUniform, scope: &LightScope<'_>) -> Self {
        let slices = u64::from(grid.slices);
        let if_used = |used: bool, bytes: u64| if used { bytes } else { 16 };
        // Two 16-bit numbers a node, twice as many nodes as leaves.
        let nodes = 8 * slices * u64::from(grid.samples);
        let inputs = &scope.inputs;
        Self {
            nodes: if_used(inputs.shadow_map.is_some(), nodes),
            tint_sums: if_used(
                inputs.texture.is_some(),
                16 * slices * (u64::from(grid.tint_columns) + 1),
            ),
            glass_nodes: if_used(inputs.glass.is_some(), nodes),
        }
    }
}

fn grid(params: &Params, scope: &LightScope<'_>) -> Option<EpipolarGrid> {
    let light = scope.light;
    let map = scope.inputs.shadow_map.map(|view| view.texture());
    let faces = light
        .shadow
        .and_then(|projection| shadow::faces(&light.emitter, &projection))
        .unwrap_or_default();
    let cone = match light.emitter {
        Emitter::Spot {
            direction, outer, ..
        } => Some((
            reals(direction).normalize_or(DVec3::NEG_Y),
            f64::from(outer),
        )),
        _ => None,
    };
    let grid = GridScene {
        camera: scope.rays,
        size: scope.size,
        light: LightModel::samples(light, None).first()?.source(),
        cone,
        faces: &faces,
        side: map.map_or(1, |map| map.width().max(map.height())) as usize,
    };
    EpipolarGrid::new(&grid, &params.resolution)
}
