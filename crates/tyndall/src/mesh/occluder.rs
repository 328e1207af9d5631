//! Triangles on the device that cast shadow volumes.

use wgpu::util::DeviceExt;

use super::{edges::Edges, error::OccluderError};

/// Triangles on the device, ready to cast shadow volumes. Made once a mesh, placed anew in each frame; clones share them.
#[derive(Clone)]
pub struct OccluderMesh {
    pub(crate) corners: wgpu::Buffer,
    pub(crate) triangles: wgpu::Buffer,
    pub(crate) edges: wgpu::Buffer,
    pub(crate) triangle_count: u32,
    pub(crate) edge_count: u32,
    /// Smallest and largest coordinates.
    pub(crate) bounds: [[f32; 3]; 2],
}

/// A mesh somewhere in the world.
#[derive(Clone, Copy)]
pub struct Occluder<'a> {
    /// Its triangles.
    pub mesh: &'a OccluderMesh,
    /// Mesh space to world space, column-major, affine.
    pub world_from_mesh: [[f32; 4]; 4],
}

impl OccluderMesh {
    /// Welds equal positions, finds the edges and uploads. `positions` are in mesh space \[m]; `indices` come three a
    /// triangle, in either orientation. Triangles without an area and repeated ones are left out.
    ///
    /// # Errors
    /// Fails if a position is not finite, an index out of range, or the mesh larger than what the device binds.
    pub fn new(
        device: &wgpu::Device,
        positions: &[[f32; 3]],
        indices: &[u32],
    ) -> Result<Self, OccluderError> {
        let mesh = Edges::new(positions, indices)?;
        let upload = |what: &'static str, bytes: &[u8]| {
            let (needed, limit) = (
                bytes.len() as u64,
                device.limits().max_storage_buffer_binding_size,
            );
            if needed > limit {
                return Err(OccluderError::Limit {
                    what,
                    needed,
                    limit,
                });
            }
            // An empty buffer can't be bound.
            let contents = if bytes.is_empty() { &[0; 16] } else { bytes };
            Ok(
                device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
                    label: Some(what),
                    contents,
                    usage: wgpu::BufferUsages::STORAGE,
                }),
            )
        };
        Ok(Self {
            corners: upload("corners", bytemuck::cast_slice(&mesh.corners))?,
            triangles: upload("triangles", bytemuck::cast_slice(&mesh.triangles))?,
            edges: upload("edges", bytemuck::cast_slice(&mesh.edges))?,
            triangle_count: mesh.triangles.len() as u32,
            edge_count: mesh.edges.len() as u32,
            bounds: mesh.bounds(),
        })
    }

    /// Triangles that are left after welding.
    pub fn triangles(&self) -> u32 {
        self.triangle_count
    }

    /// Edges that may be silhouettes.
    pub fn edges(&self) -> u32 {
        self.edge_count
    }

    /// Bytes on the device.
    pub fn bytes(&self) -> u64 {
        self.corners.size() + self.triangles.size() + self.edges.size()
    }
}
