//! Draws of shadow volumes' boundaries, for any pass that wants them.

use std::ops::Range;

use glam::{DMat4, Mat4};

use super::Occluder;
use crate::gpu::{
    layout,
    pass::{Draw, Vertices},
    program::ScreenProgram,
    scope::LightScope,
};

/// Boundaries of shadow volumes; needs frame and light.
pub(crate) const VOLUME: &str = include_str!("volume.wgsl");

/// Bind group 2 of what draws them.
pub(crate) fn own() -> [wgpu::BindGroupLayoutEntry; 3] {
    [0, 1, 2].map(|binding| layout::storage(binding, true))
}

/// One program a kind of boundary: vertex stages `occluder_wall`, `occluder_cap` and `occluder_far_cap`.
pub(crate) struct VolumePrograms {
    pub(crate) wall: ScreenProgram,
    pub(crate) cap: ScreenProgram,
    pub(crate) far_cap: ScreenProgram,
}

/// Places of occluders on the device.
pub(crate) struct Places(wgpu::Buffer);

impl Places {
    /// Uploads them, relative to the eye, under a name of this light's.
    pub(crate) fn new(
        name: &'static str,
        occluders: &[Occluder<'_>],
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
        Self(scope.upload(name, &places))
    }

    pub(crate) fn as_entire_binding(&self) -> wgpu::BindingResource<'_> {
        self.0.as_entire_binding()
    }
}

/// The draws of all boundaries.
pub(crate) fn draws(
    occluders: &[Occluder<'_>],
    places: &Places,
    programs: &VolumePrograms,
    scope: &LightScope<'_>,
) -> Vec<Draw> {
    let is_local = scope.variant.kind != 0;
    let mut draws = Vec::new();
    for (mesh, instances) in runs(occluders) {
        let mut push = |program: &ScreenProgram, elements: &wgpu::Buffer, vertices: u32| {
            let resources = [
                places.as_entire_binding(),
                mesh.corners.as_entire_binding(),
                elements.as_entire_binding(),
            ];
            let vertices = Vertices::Direct {
                vertices,
                instances: instances.clone(),
            };
            draws.push(scope.draw_mesh(program, &resources, vertices));
        };
        push(&programs.wall, &mesh.edges, 6 * mesh.edge_count);
        push(&programs.cap, &mesh.triangles, 3 * mesh.triangle_count);
        if is_local {
            push(&programs.far_cap, &mesh.triangles, 3 * mesh.triangle_count);
        }
    }
    draws
}

/// Occluders of one mesh that stand side by side, as one draw's instances.
fn runs<'a>(
    occluders: &'a [Occluder<'a>],
) -> impl Iterator<Item = (&'a super::OccluderMesh, Range<u32>)> {
    let mut start = 0;
    occluders
        .chunk_by(|a, b| std::ptr::eq(a.mesh, b.mesh))
        .map(move |run| {
            let instances = start..start + run.len() as u32;
            start = instances.end;
            (run[0].mesh, instances)
        })
}
