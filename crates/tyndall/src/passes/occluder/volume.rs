//! Occluders on the device, in runs of one mesh each.

use std::ops::Range;

use glam::{DMat4, Mat4};

use super::tile::tile_bytes;
use crate::{
    error::PrepareError,
    gpu::{
        limits,
        program::ComputeProgram,
        scope::{Blocks, LightScope},
    },
    mesh::{Occluder, OccluderMesh},
    shader::{block, constant},
};

block! {
    /// The shaders' `OccluderParams`.
    pub(super) struct ParamsUniform = "OccluderParams" in "tyndall::passes::occluder::volume", checked by occluder_params_is_laid_out_as_in_wgsl {
        first_place: u32,
        pub(super) places: u32,
        pub(super) edges: u32,
        pub(super) triangles: u32,
        pub(super) least: [f32; 3],
        pub(super) walls: u32,
        pub(super) most: [f32; 3],
        pub(super) caps: u32,
        pub(super) counts: u32,
        pub(super) columns: u32,
        pad: [u32; 2],
    }
}

/// The most workgroups in a row of a dispatch: WebGPU allows 65 535 in a direction.
pub(super) const MAX_COLUMNS: u32 = 32_768;

/// The most places of a run, which are layers of its dispatches.
const MAX_PLACES: usize = 32_768;

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
    let entry = size_of::<[u32; 2]>() as u64;
    entry * occluders.iter().map(entries).sum::<u64>().max(1)
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

/// A mesh and the places of the occluders that have it, side by side in the list.
type Run<'a> = (&'a OccluderMesh, Range<u32>);

/// Occluders on the device, in runs of one mesh each.
pub(super) struct Volumes<'a> {
    runs: Vec<Run<'a>>,
    places: wgpu::Buffer,
    params: Blocks<ParamsUniform>,
    /// Elements and places of the walls and caps that are rasterised.
    pub(super) list: wgpu::Buffer,
    /// The numbers of walls and caps that a run has there.
    pub(super) counts: wgpu::Buffer,
    /// One number: 1 where the eye is in a shadow.
    pub(super) eye: wgpu::Buffer,
    /// View depths between which a tile's rays meet boundaries.
    pub(super) tiles: wgpu::Buffer,
}

impl<'a> Volumes<'a> {
    /// Uploads places relative to the eye, under names of this light's.
    pub(super) fn new(
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
    pub(super) fn resources<'b>(
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
    pub(super) fn runs(&self) -> impl Iterator<Item = (usize, &'a OccluderMesh, u32)> {
        let runs = self.runs.iter().enumerate();
        runs.map(|(run, (mesh, places))| (run, *mesh, places.len() as u32))
    }

    /// Workgroups of a program that looks at so many elements of each of a run's places.
    pub(super) fn workgroups(
        &self,
        program: &ComputeProgram,
        run: usize,
        elements: u32,
    ) -> [u32; 3] {
        let ParamsUniform {
            columns, places, ..
        } = self.params.values[run];
        let [groups, _, places] = program.workgroups([elements, 1, places]);
        [columns, groups.div_ceil(columns), places]
    }
}

/// Occluders of one mesh that stand side by side, as many as a dispatch has layers at most.
fn runs<'a>(occluders: &'a [Occluder<'a>]) -> Vec<Run<'a>> {
    let mut start = 0;
    occluders
        .chunk_by(|a, b| a.mesh.corners == b.mesh.corners)
        .flat_map(|of_mesh| of_mesh.chunks(MAX_PLACES))
        .map(move |run| {
            let places = start..start + run.len() as u32;
            start = places.end;
            (run[0].mesh, places)
        })
        .collect()
}

fn uniforms(runs: &[Run<'_>]) -> Vec<ParamsUniform> {
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
                columns: most
                    .div_ceil(constant("OCCLUDER_GROUP"))
                    .clamp(1, MAX_COLUMNS),
                pad: [0; 2],
            }
        })
        .collect()
}
