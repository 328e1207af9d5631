//! The buffers of the adaptive mesh.

use std::mem::offset_of;

use super::{
    extent::Extent,
    tessellation::{Square, Step},
};
use crate::{
    gpu::{
        pass::Vertices,
        pool::Owner,
        scope::{Blocks, LightScope},
    },
    inputs::CountValue,
    shader::block,
};

block! {
    /// The shaders' `LightVolumeCounts`.
    struct Counts = "LightVolumeCounts" in "tyndall::techniques::light_volume::list", checked by light_volume_counts_is_laid_out_as_in_wgsl {
        adaptive_vertices: u32,
        adaptive_instances: u32,
        adaptive_first: [u32; 2],
        full_vertices: u32,
        full_instances: u32,
        full_first: [u32; 2],
        listing: u32,
        triangles: u32,
    }
}

/// The adaptive mesh.
pub(super) struct Tree {
    pub(super) square: Square,
    /// The vertices that the mesh needs, a bit each.
    pub(super) splits: wgpu::Buffer,
    /// One for each of the square's steps.
    pub(super) steps: Blocks<Step>,
    /// The list of triangles.
    pub(super) triangles: wgpu::Buffer,
    /// [`Counts`].
    pub(super) counts: wgpu::Buffer,
}

impl Tree {
    /// `capacity`: triangles that the list has room for.
    pub(super) fn new(scope: &mut LightScope<'_>, extent: &Extent, capacity: u32) -> Self {
        let square = Square::new(extent.cells);
        let steps = square.steps().into_iter().map(|(step, _)| step).collect();
        let steps = scope.blocks("light volume steps", steps);
        let storage = wgpu::BufferUsages::STORAGE;
        let arguments = storage | wgpu::BufferUsages::INDIRECT | wgpu::BufferUsages::COPY_SRC;
        let mut buffer = |name, size, usage| {
            let key = (Owner::Light(scope.index), name);
            scope.pool.buffer(scope.device, key, size, usage)
        };
        let splits = square.splits_bytes(extent.faces);
        let triangles = size_of::<u32>() as u64 * u64::from(capacity);
        let counts = size_of::<Counts>() as u64;
        Self {
            square,
            splits: buffer("light volume splits", splits, storage),
            steps,
            triangles: buffer("light volume triangles", triangles, storage),
            counts: buffer("light volume counts", counts, arguments),
        }
    }

    /// The draw of the list: nothing where it has no room for the adaptive mesh.
    pub(super) fn listed(&self) -> Vertices {
        self.arguments(offset_of!(Counts, adaptive_vertices))
    }

    /// The draw of the full mesh: nothing where the list has room for the adaptive one.
    pub(super) fn full(&self) -> Vertices {
        self.arguments(offset_of!(Counts, full_vertices))
    }

    fn arguments(&self, offset: usize) -> Vertices {
        Vertices::Indirect(self.counts.clone(), offset as u64)
    }

    /// The number of triangles of the adaptive mesh, listed or not.
    pub(super) fn count(&self) -> CountValue {
        CountValue::Written {
            buffer: self.counts.clone(),
            offset: offset_of!(Counts, triangles) as u64,
        }
    }
}
