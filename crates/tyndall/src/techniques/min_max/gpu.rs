//! The GPU side: the shadow map's pyramid, the rectified trees, and the pass that traverses them.

use glam::DVec3;

use super::Params;
use crate::{
    epipolar::{
        gpu::{EPIPOLAR, EpipolarUniform},
        grid::{EpipolarGrid, GridScene, TINT_COLUMNS},
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
        pyramid::{self, PYRAMID},
    },
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

/// The technique's shaders.
pub(crate) struct Programs {
    pyramid: pyramid::Programs,
    rectify: ComputeProgram,
    tint_rows: ComputeProgram,
    traverse: ScreenProgram,
}

impl Programs {
    pub(crate) fn new(device: &wgpu::Device, shared: &Shared) -> Self {
        Self {
            pyramid: pyramid::Programs::new(device, shared),
            rectify: ComputeProgram::new(
                device,
                shared,
                "rectify",
                &[EPIPOLAR, PYRAMID, TREE, RECTIFY],
                "rectify",
                &[
                    layout::uniform::<EpipolarUniform>(0),
                    layout::texel_layers(1),
                    layout::storage(2, false),
                ],
            ),
            tint_rows: ComputeProgram::new(
                device,
                shared,
                "tint rows",
                &[EPIPOLAR, TREE, TINT, TINT_ROWS],
                "tint_rows",
                &[
                    layout::uniform::<EpipolarUniform>(0),
                    layout::storage(1, false),
                    layout::storage(2, false),
                ],
            ),
            traverse: ScreenProgram::new(
                device,
                shared,
                "traverse",
                &[
                    AIRLIGHT, STRETCH, EPIPOLAR, WALK, TREE, TINT, TINT_MEAN, TRAVERSE,
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
    let needs = Needs::new(&epipolar, scope);
    let nodes = scope.storage("min-max nodes", needs.nodes);
    let tint_sums = scope.storage("tint sums", needs.tint_sums);
    let tint_nodes = scope.storage("tint nodes", needs.tint_nodes);
    let mut passes = Vec::new();
    if let (Some(_), Some(map)) = (grid, scope.inputs.shadow_map) {
        let (pyramid, pass) = pyramid::build(&programs.pyramid, scope, map.texture());
        passes.push(pass);
        let resources = [
            uniform.as_entire_binding(),
            wgpu::BindingResource::TextureView(&pyramid),
            nodes.as_entire_binding(),
        ];
        let groups = [
            epipolar.samples.div_ceil(LEAVES_A_WORKGROUP),
            epipolar.slices,
            1,
        ];
        passes.push(scope.compute(
            &programs.rectify,
            "rectify and build trees",
            &resources,
            groups,
        ));
    }
    if grid.is_some() && needs.has_tints {
        let resources = [&uniform, &tint_sums, &tint_nodes].map(|b| b.as_entire_binding());
        let groups = [epipolar.slices, 1, 1];
        passes.push(scope.compute(&programs.tint_rows, "sum up tints", &resources, groups));
    }
    let airlight = scope.airlight();
    let resources = [
        uniform.as_entire_binding(),
        nodes.as_entire_binding(),
        wgpu::BindingResource::TextureView(&airlight),
        tint_sums.as_entire_binding(),
        tint_nodes.as_entire_binding(),
    ];
    passes.push(scope.full_screen(&programs.traverse, "traverse", &resources));
    passes
}

/// Bytes of the buffers; those that nothing reads are as small as a buffer may be.
struct Needs {
    nodes: u64,
    tint_sums: u64,
    tint_nodes: u64,
    has_tints: bool,
}

impl Needs {
    const NOTHING: u64 = 16;

    fn new(grid: &EpipolarUniform, scope: &LightScope<'_>) -> Self {
        let slices = u64::from(grid.slices);
        let columns = TINT_COLUMNS as u64;
        let has_glass = scope.inputs.glass.is_some();
        let has_tints = has_glass || scope.inputs.texture.is_some();
        let rows = slices * if has_glass { 2 } else { 1 };
        let if_used = |used: bool, bytes: u64| if used { bytes } else { Self::NOTHING };
        Self {
            nodes: if_used(
                scope.inputs.shadow_map.is_some(),
                8 * slices * u64::from(grid.samples),
            ),
            tint_sums: if_used(has_tints, 16 * rows * (columns + 1)),
            tint_nodes: if_used(has_glass, 8 * slices * columns),
            has_tints,
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
