//! The GPU side: the shadow map's pyramid, the rectified trees, and the pass that traverses them.

use bytemuck::{Pod, Zeroable};
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
        pyramid::{self, PYRAMID},
    },
};

const TREE: &str = include_str!("tree.wgsl");
const RECTIFY: &str = include_str!("rectify.wgsl");
const TRAVERSE: &str = include_str!("traverse.wgsl");
const WALK: &str = include_str!("../../shadow/walk.wgsl");

/// Leaves that a workgroup of `rectify.wgsl` takes.
const LEAVES_A_WORKGROUP: u32 = 512;

/// `MinMax` of `tree.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct MinMaxUniform {
    epipolar: EpipolarUniform,
}

/// The technique's shaders.
pub(crate) struct Programs {
    pyramid: pyramid::Programs,
    rectify: ComputeProgram,
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
                    layout::uniform::<MinMaxUniform>(0),
                    layout::texel_layers(1),
                    layout::storage(2, false),
                ],
            ),
            traverse: ScreenProgram::new(
                device,
                shared,
                "traverse",
                &[AIRLIGHT, STRETCH, EPIPOLAR, WALK, TREE, TRAVERSE],
                "traverse",
                &[
                    layout::uniform::<MinMaxUniform>(0),
                    layout::storage(1, true),
                    layout::airlight(2),
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
    let epipolar = grid
        .as_ref()
        .map_or(EpipolarUniform::NONE, EpipolarGrid::uniform);
    let uniform = scope.uniform("min-max grid", &MinMaxUniform { epipolar });
    let nodes = scope.storage("min-max nodes", node_bytes(&epipolar));
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
    let airlight = scope.airlight();
    let resources = [
        uniform.as_entire_binding(),
        nodes.as_entire_binding(),
        wgpu::BindingResource::TextureView(&airlight),
    ];
    passes.push(scope.full_screen(&programs.traverse, "traverse", &resources));
    passes
}

/// Two 16-bit numbers a node, twice as many nodes as leaves.
fn node_bytes(grid: &EpipolarUniform) -> u64 {
    8 * u64::from(grid.slices) * u64::from(grid.samples)
}

fn grid(params: &Params, scope: &LightScope<'_>) -> Option<EpipolarGrid> {
    let map = scope.inputs.shadow_map?.texture();
    let light = scope.light;
    let faces = shadow::faces(&light.emitter, light.shadow.as_ref()?)?;
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
        side: map.width().max(map.height()) as usize,
    };
    EpipolarGrid::new(&grid, &params.resolution)
}
