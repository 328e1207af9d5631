//! Draws of shadow volumes' boundaries, for any pass that wants them.

use std::ops::Range;

use bytemuck::{Pod, Zeroable};
use glam::{DMat4, Mat4};

use super::{Occluder, OccluderMesh};
use crate::{
    error::PrepareError,
    gpu::{
        layout, limits,
        pass::{Dispatch, Draw, Pass, Vertices},
        program::{ComputeProgram, Raster, ScreenProgram},
        scope::{Blocks, LightScope, Shared},
    },
};

/// Boundaries of shadow volumes; needs frame and light.
pub(crate) const VOLUME: &str = include_str!("volume.wgsl");
const LISTED: &str = include_str!("listed.wgsl");
const LIST: &str = include_str!("list.wgsl");

/// `OccluderParams` of `volume.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct ParamsUniform {
    pub(crate) first_place: u32,
    pub(crate) places: u32,
    pub(crate) edges: u32,
    pub(crate) triangles: u32,
    pub(crate) least: [f32; 3],
    pub(crate) walls: u32,
    pub(crate) most: [f32; 3],
    pub(crate) caps: u32,
    pub(crate) arguments: u32,
    pub(crate) columns: u32,
    pad: [u32; 2],
}

/// Elements that a workgroup looks at.
const GROUP: u32 = 64;
/// The most workgroups a row has.
const MAX_COLUMNS: u32 = 32_768;
/// Words of the arguments of a run's two draws.
const ARGUMENTS: u32 = 8;

/// The resources of `volume.wgsl`.
pub(crate) fn own() -> [wgpu::BindGroupLayoutEntry; 4] {
    let [places, corners, elements] = [0, 1, 2].map(|binding| layout::storage(binding, true));
    [
        places,
        corners,
        elements,
        layout::uniform::<ParamsUniform>(3),
    ]
}

/// What lists boundaries, and one program a kind of them.
pub(crate) struct VolumePrograms {
    clear: ComputeProgram,
    list_walls: ComputeProgram,
    list_caps: ComputeProgram,
    wall: ScreenProgram,
    cap: ScreenProgram,
    far_cap: ScreenProgram,
}

impl VolumePrograms {
    /// Draws as `raster` says, with the fragment stages `boundary`, of an `OccluderVertex`, and `far_cap`.
    pub(crate) fn new(
        device: &wgpu::Device,
        shared: &Shared,
        raster: &Raster,
        wgsl: &str,
        [boundary, far_cap]: [&'static str; 2],
    ) -> Self {
        let list_own = [&own()[..], &[4, 5].map(|b| layout::storage(b, false))].concat();
        let list = |entry_point| {
            let modules = [VOLUME, LIST];
            ComputeProgram::new(
                device,
                shared,
                "occluder list",
                &modules,
                entry_point,
                &list_own,
            )
        };
        let listed_own = [&own()[..], &[layout::storage(4, true)]].concat();
        let draw = |label, vertex, fragment| {
            let raster = Raster {
                vertex,
                ..raster.clone()
            };
            let modules = [VOLUME, LISTED, wgsl];
            ScreenProgram::new(device, shared, label, &modules, fragment, &listed_own)
                .drawing(raster)
        };
        Self {
            clear: list("list_clear").for_all_lights(),
            list_walls: list("list_walls"),
            list_caps: list("list_caps"),
            wall: draw("occluder walls", "occluder_wall", boundary),
            cap: draw("occluder caps", "occluder_cap", boundary),
            far_cap: draw("occluder far caps", "occluder_far_cap", far_cap),
        }
    }
}

/// Occluders on the device, in runs of one mesh each.
pub(crate) struct Volumes<'a> {
    runs: Vec<(&'a OccluderMesh, Range<u32>)>,
    places: wgpu::Buffer,
    params: Blocks<ParamsUniform>,
    list: wgpu::Buffer,
    arguments: wgpu::Buffer,
}

/// Names of a light's buffers.
pub(crate) struct Names {
    pub(crate) places: &'static str,
    pub(crate) params: &'static str,
    pub(crate) list: &'static str,
    pub(crate) arguments: &'static str,
}

/// Bytes of the list of all walls and caps.
fn list_bytes(occluders: &[Occluder<'_>]) -> u64 {
    let entries =
        |o: &Occluder<'_>| u64::from(o.mesh.edge_count) + u64::from(o.mesh.triangle_count);
    8 * occluders.iter().map(entries).sum::<u64>().max(1)
}

/// Refuses a list that the device cannot bind.
pub(crate) fn check_list(
    limits: &wgpu::Limits,
    index: usize,
    occluders: &[Occluder<'_>],
) -> Result<(), PrepareError> {
    let of = format!("occluders (lights[{index}])");
    limits::check_storage(
        limits,
        &of,
        &[("the list of silhouettes", list_bytes(occluders))],
    )
}

impl<'a> Volumes<'a> {
    /// Uploads places relative to the eye, under names of this light's.
    pub(crate) fn new(
        names: &Names,
        occluders: &'a [Occluder<'a>],
        scope: &mut LightScope<'_>,
    ) -> Self {
        let from_eye = DMat4::from_translation(-scope.rays.eye);
        let place = |occluder: &Occluder<'_>| {
            let world_from_mesh = Mat4::from_cols_array_2d(&occluder.world_from_mesh);
            (from_eye * world_from_mesh.as_dmat4())
                .as_mat4()
                .to_cols_array()
        };
        let mut places: Vec<[f32; 16]> = occluders.iter().map(place).collect();
        // An empty buffer can't be bound.
        if places.is_empty() {
            places.push([0.0; 16]);
        }
        let runs = runs(occluders);
        let uniforms = uniforms(&runs);
        let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::INDIRECT;
        let bytes = 4 * u64::from(ARGUMENTS) * (runs.len() as u64).max(1);
        let key = (Some(scope.index), names.arguments);
        Self {
            places: scope.upload(names.places, &places),
            params: scope.blocks(names.params, uniforms),
            list: scope.storage(names.list, list_bytes(occluders)),
            arguments: scope.pool.buffer(scope.device, key, bytes, usage),
            runs,
        }
    }

    /// The first four resources of a run's passes.
    pub(crate) fn resources<'b>(
        &'b self,
        run: usize,
        elements: &'b wgpu::Buffer,
    ) -> [wgpu::BindingResource<'b>; 4] {
        [
            self.places.as_entire_binding(),
            self.runs[run].0.corners.as_entire_binding(),
            elements.as_entire_binding(),
            self.params.binding(run as u32),
        ]
    }

    /// The runs' meshes and how many places each has.
    pub(crate) fn runs(&self) -> impl Iterator<Item = (usize, &'a OccluderMesh, u32)> {
        let runs = self.runs.iter().enumerate();
        runs.map(|(run, (mesh, places))| (run, *mesh, places.len() as u32))
    }

    /// Workgroups that look at so many elements of each of a run's places.
    pub(crate) fn workgroups(&self, run: usize, elements: u32) -> [u32; 3] {
        let ParamsUniform {
            columns, places, ..
        } = self.params.values[run];
        [columns, elements.div_ceil(GROUP).div_ceil(columns), places]
    }

    /// The pass that lists what is to be drawn.
    pub(crate) fn list(
        &self,
        name: &str,
        programs: &VolumePrograms,
        scope: &LightScope<'_>,
    ) -> Pass {
        let dispatch = |program: &ComputeProgram, run, elements, groups: [u32; 3]| -> Dispatch {
            let lists = [&self.list, &self.arguments].map(|b| b.as_entire_binding());
            let resources = [&self.resources(run, elements)[..], &lists].concat();
            scope.dispatch(program, &resources, groups)
        };
        let mut dispatches = Vec::new();
        for (run, mesh, _) in self.runs() {
            let (walls, caps) = (
                self.workgroups(run, mesh.edge_count),
                self.workgroups(run, mesh.triangle_count),
            );
            dispatches.push(dispatch(&programs.clear, run, &mesh.edges, [1; 3]));
            dispatches.push(dispatch(&programs.list_walls, run, &mesh.edges, walls));
            dispatches.push(dispatch(&programs.list_caps, run, &mesh.triangles, caps));
        }
        Pass::compute(scope.pass_name(name), dispatches)
    }

    /// The draws of all boundaries that were listed.
    pub(crate) fn draws(&self, programs: &VolumePrograms, scope: &LightScope<'_>) -> Vec<Draw> {
        let is_local = scope.variant.kind != 0;
        let mut draws = Vec::new();
        for (run, mesh, places) in self.runs() {
            let mut push = |program: &ScreenProgram, elements: &wgpu::Buffer, vertices| {
                let list = [self.list.as_entire_binding()];
                let resources = [&self.resources(run, elements)[..], &list].concat();
                draws.push(scope.draw_mesh(program, &resources, vertices));
            };
            let first = 4 * u64::from(self.params.values[run].arguments);
            let listed = |offset| Vertices::Indirect(self.arguments.clone(), offset);
            push(&programs.wall, &mesh.edges, listed(first));
            push(&programs.cap, &mesh.triangles, listed(first + 16));
            if is_local {
                let boxes = Vertices::Direct {
                    vertices: 36,
                    instances: places,
                };
                push(&programs.far_cap, &mesh.triangles, boxes);
            }
        }
        draws
    }
}

/// Occluders of one mesh that stand side by side.
fn runs<'a>(occluders: &'a [Occluder<'a>]) -> Vec<(&'a OccluderMesh, Range<u32>)> {
    let mut start = 0;
    occluders
        .chunk_by(|a, b| a.mesh.corners == b.mesh.corners)
        .map(move |run| {
            let places = start..start + run.len() as u32;
            start = places.end;
            (run[0].mesh, places)
        })
        .collect()
}

fn uniforms(runs: &[(&OccluderMesh, Range<u32>)]) -> Vec<ParamsUniform> {
    let mut listed = 0;
    let mut next = |count: u32| {
        let start = listed;
        listed += count;
        start
    };
    (0..)
        .zip(runs)
        .map(|(run, (mesh, places))| {
            let count = places.len() as u32;
            let most = mesh.edge_count.max(mesh.triangle_count);
            ParamsUniform {
                first_place: places.start,
                places: count,
                edges: mesh.edge_count,
                triangles: mesh.triangle_count,
                least: mesh.bounds[0],
                walls: next(count * mesh.edge_count),
                most: mesh.bounds[1],
                caps: next(count * mesh.triangle_count),
                arguments: run * ARGUMENTS,
                columns: most.div_ceil(GROUP).clamp(1, MAX_COLUMNS),
                pad: [0; 2],
            }
        })
        .collect()
}
