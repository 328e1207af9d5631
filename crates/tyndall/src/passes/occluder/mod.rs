//! What blocks light, as triangles: for techniques that bound the shadows on a view ray by geometry.
//!
//! The volume that a triangle shadows is the infinite prism (sun) or pyramid (local light) behind it. A mesh shadows the
//! union of its triangles' volumes, whose boundary is made of
//!
//! - **caps**: the triangles themselves, and behind a local light's triangles their images at infinity;
//! - **walls**: what an edge sweeps out away from the light. The wall of an edge that two triangles share lies inside the
//!   union where they lie on opposite sides of it, and on the boundary, the silhouette, where they don't.
//!
//! Sides are those of the plane through edge and light, so that neither the triangles' orientation nor a closed mesh is
//! needed: an edge of one triangle, or of more than two, always has its wall. No shadow is missing from the boundary of
//! any set of triangles (Wyman & Ramsey 2008 need closed meshes).
//!
//! Where there is a shadow map, pieces whose texels are all covered from nearer to the light are left out: their shadow is
//! inside that of what covers them. Of a dragon lit from the side that leaves a fraction of its silhouettes.
//!
//! Where they begin and end along the rays of each tile of 4 x 4 pixels is found by a conservative rasteriser in compute
//! (`bounds.wgsl`): silhouettes' walls are long and thin, and a fragment a pixel of each costs many times as much.
//!
//! A mesh is welded and its edges are found once, when it is uploaded; silhouettes are found on the GPU, light by light.

use std::ops::Range;

use bytemuck::{Pod, Zeroable};
use glam::{DMat4, Mat4};

use crate::mesh::{Occluder, OccluderMesh};
use crate::{
    error::PrepareError,
    gpu::{
        cache, layout, limits,
        pass::{Dispatch, Pass},
        program::ComputeProgram,
        scope::{Blocks, LightScope, Shared},
    },
};

/// What is kept of the boundaries on the screen; needs the frame.
pub(crate) const TILE: &str = include_str!("tile.wgsl");
/// The boundaries themselves; needs frame and light.
pub(crate) const VOLUME: &str = include_str!("volume.wgsl");
const LIST: &str = include_str!("list.wgsl");
const CLEAR: &str = include_str!("clear.wgsl");
const EYE: &str = include_str!("eye.wgsl");
const WRITE: &str = include_str!("write.wgsl");
const SHADED: &str = include_str!("shaded.wgsl");
const BOUNDS: &str = include_str!("bounds.wgsl");

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
    pub(crate) counts: u32,
    pub(crate) columns: u32,
    pad: [u32; 2],
}

/// Elements that a workgroup looks at, tiles that it clears.
const GROUP: u32 = 64;
/// Pieces that a workgroup takes at a time.
const PIECES: u32 = 64;
/// The most workgroups a row has.
const MAX_COLUMNS: u32 = 32_768;
/// The most workgroups that share the pieces of a run.
const MAX_SHARING: u32 = 512;
/// Pixels of a tile's side.
const SIDE: u32 = 4;
/// Triangles of a box.
const OF_BOX: u32 = 12;

/// The resources of `volume.wgsl`.
fn own() -> [wgpu::BindGroupLayoutEntry; 4] {
    let [places, corners, elements] = [0, 1, 2].map(|binding| layout::storage(binding, true));
    [
        places,
        corners,
        elements,
        layout::uniform::<ParamsUniform>(3),
    ]
}

/// The shaders that find the boundaries on the screen.
pub(crate) struct VolumePrograms {
    clear_eye: ComputeProgram,
    eye: ComputeProgram,
    list_clear: ComputeProgram,
    list_walls: ComputeProgram,
    list_caps: ComputeProgram,
    clear_bounds: ComputeProgram,
    walls: ComputeProgram,
    caps: ComputeProgram,
    far_caps: ComputeProgram,
}

impl cache::Programs for VolumePrograms {
    fn new(device: &wgpu::Device, shared: &Shared) -> Self {
        let written = |binding| layout::storage(binding, false);
        let read = |binding| layout::storage(binding, true);
        let program = |modules: &[&str], entry_point, own: &[wgpu::BindGroupLayoutEntry]| {
            ComputeProgram::new(device, shared, "occluders", modules, entry_point, own)
        };
        let clear = |entry_point| {
            program(&[TILE, CLEAR], entry_point, &[written(0), written(1)]).for_all_lights()
        };
        let of_mesh = |modules: &[&str], entry_point, more: &[wgpu::BindGroupLayoutEntry]| {
            let own = [&own()[..], more].concat();
            program(&[&[VOLUME], modules].concat(), entry_point, &own)
        };
        let list = |entry_point| {
            let more = [4, 5, 6].map(written);
            of_mesh(&[TILE, WRITE, LIST], entry_point, &more)
        };
        let bounds = |entry_point| {
            let more = [read(4), read(5), written(6)];
            of_mesh(&[TILE, WRITE, SHADED, BOUNDS], entry_point, &more)
        };
        Self {
            clear_eye: clear("clear_eye"),
            eye: of_mesh(&[EYE], "eye_triangle", &[written(4)]),
            list_clear: list("list_clear").for_all_lights(),
            list_walls: list("list_walls"),
            list_caps: list("list_caps"),
            clear_bounds: clear("clear_bounds"),
            walls: bounds("bounds_walls"),
            caps: bounds("bounds_caps"),
            far_caps: bounds("bounds_far_caps"),
        }
    }
}

/// Names of a light's buffers.
pub(crate) struct Names {
    pub(crate) places: &'static str,
    pub(crate) params: &'static str,
    pub(crate) list: &'static str,
    pub(crate) counts: &'static str,
    pub(crate) eye: &'static str,
    pub(crate) tiles: &'static str,
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

/// Tiles of a picture.
fn tiles(size: [u32; 2]) -> u64 {
    let [columns, rows] = size.map(|side| u64::from(side.div_ceil(SIDE)));
    columns * rows
}

/// Bytes of what is kept a picture.
pub(crate) fn tile_bytes(size: [u32; 2]) -> u64 {
    8 * tiles(size)
}

/// The passes that find where these occluders' shadow volumes begin and end on the screen, and the tiles that they leave
/// it in (see `tile.wgsl`).
pub(crate) fn passes(
    names: &Names,
    occluders: &[Occluder<'_>],
    programs: &VolumePrograms,
    scope: &mut LightScope<'_>,
) -> ([Pass; 3], wgpu::Buffer) {
    let volumes = Volumes::new(names, occluders, scope);
    let passes = [
        ("eye in shadow", volumes.eye(programs, scope)),
        ("list silhouettes", volumes.list(programs, scope)),
        ("shadow volumes", volumes.bounds(programs, scope)),
    ]
    .map(|(name, dispatches)| Pass::compute(scope.pass_name(name), dispatches));
    (passes, volumes.tiles)
}

/// Occluders on the device, in runs of one mesh each.
struct Volumes<'a> {
    runs: Vec<(&'a OccluderMesh, Range<u32>)>,
    places: wgpu::Buffer,
    params: Blocks<ParamsUniform>,
    list: wgpu::Buffer,
    counts: wgpu::Buffer,
    eye: wgpu::Buffer,
    tiles: wgpu::Buffer,
}

impl<'a> Volumes<'a> {
    /// Uploads places relative to the eye, under names of this light's.
    fn new(names: &Names, occluders: &'a [Occluder<'a>], scope: &mut LightScope<'_>) -> Self {
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
        Self {
            places: scope.upload(names.places, &places),
            params: scope.blocks(names.params, uniforms),
            list: scope.storage(names.list, list_bytes(occluders)),
            counts: scope.storage(names.counts, 8 * (runs.len() as u64).max(1)),
            eye: scope.storage(names.eye, 4),
            tiles: scope.storage(names.tiles, tile_bytes(scope.size)),
            runs,
        }
    }

    /// The first four resources of a run's passes.
    fn resources<'b>(
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
    fn runs(&self) -> impl Iterator<Item = (usize, &'a OccluderMesh, u32)> {
        let runs = self.runs.iter().enumerate();
        runs.map(|(run, (mesh, places))| (run, *mesh, places.len() as u32))
    }

    /// Workgroups that look at so many elements of each of a run's places.
    fn workgroups(&self, run: usize, elements: u32) -> [u32; 3] {
        let ParamsUniform {
            columns, places, ..
        } = self.params.values[run];
        [columns, elements.div_ceil(GROUP).div_ceil(columns), places]
    }

    /// Asks whether the eye is in a shadow.
    fn eye(&self, programs: &VolumePrograms, scope: &LightScope<'_>) -> Vec<Dispatch> {
        let clear = self.clear(&programs.clear_eye, [1; 3], scope);
        let asked = self.runs().map(|(run, mesh, _)| {
            let own = [self.eye.as_entire_binding()];
            let resources = [&self.resources(run, &mesh.triangles)[..], &own].concat();
            let groups = self.workgroups(run, mesh.triangles());
            scope.dispatch(&programs.eye, &resources, groups)
        });
        std::iter::once(clear).chain(asked).collect()
    }

    fn clear(
        &self,
        program: &ComputeProgram,
        groups: [u32; 3],
        scope: &LightScope<'_>,
    ) -> Dispatch {
        let own = [&self.eye, &self.tiles].map(|buffer| buffer.as_entire_binding());
        scope.dispatch(program, &own, groups)
    }

    /// Lists the boundaries, and rasterises the smallest.
    fn list(&self, programs: &VolumePrograms, scope: &LightScope<'_>) -> Vec<Dispatch> {
        let dispatch = |program, run, elements: &wgpu::Buffer, groups: [u32; 3]| {
            let own = [&self.list, &self.counts, &self.tiles].map(|b| b.as_entire_binding());
            let resources = [&self.resources(run, elements)[..], &own].concat();
            scope.dispatch(program, &resources, groups)
        };
        let of_run = |(run, mesh, _): (usize, &OccluderMesh, u32)| {
            let walls = self.workgroups(run, mesh.edge_count);
            let caps = self.workgroups(run, mesh.triangle_count);
            [
                dispatch(&programs.list_clear, run, &mesh.edges, [1; 3]),
                dispatch(&programs.list_walls, run, &mesh.edges, walls),
                dispatch(&programs.list_caps, run, &mesh.triangles, caps),
            ]
        };
        let groups = tiles(scope.size).div_ceil(GROUP.into());
        let columns = groups.min(MAX_COLUMNS.into());
        let groups = [columns as u32, groups.div_ceil(columns) as u32, 1];
        let clear = self.clear(&programs.clear_bounds, groups, scope);
        let listed = self.runs().flat_map(of_run);
        std::iter::once(clear).chain(listed).collect()
    }

    /// Rasterises those that were listed.
    fn bounds(&self, programs: &VolumePrograms, scope: &LightScope<'_>) -> Vec<Dispatch> {
        let of_pieces = |program, run, elements: &wgpu::Buffer, most: u64| {
            let own = [&self.list, &self.counts, &self.tiles].map(|b| b.as_entire_binding());
            let resources = [&self.resources(run, elements)[..], &own].concat();
            let groups = most.div_ceil(PIECES.into()).clamp(1, MAX_SHARING.into()) as u32;
            scope.dispatch(program, &resources, [groups, 1, 1])
        };
        let mut dispatches = Vec::new();
        let is_local = scope.variant.kind != 0;
        for (run, mesh, places) in self.runs() {
            let [walls, caps, far_caps] = [mesh.edge_count, mesh.triangle_count, OF_BOX]
                .map(|pieces| u64::from(places) * u64::from(pieces));
            dispatches.push(of_pieces(&programs.walls, run, &mesh.edges, walls));
            dispatches.push(of_pieces(&programs.caps, run, &mesh.triangles, caps));
            if is_local {
                dispatches.push(of_pieces(
                    &programs.far_caps,
                    run,
                    &mesh.triangles,
                    far_caps,
                ));
            }
        }
        dispatches
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
                counts: 2 * run,
                columns: most.div_ceil(GROUP).clamp(1, MAX_COLUMNS),
                pad: [0; 2],
            }
        })
        .collect()
}
