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

mod edges;
pub(crate) mod gpu;

use wgpu::util::DeviceExt;

use edges::Edges;

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

/// Why an occluder mesh could not be made.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum OccluderError {
    /// A position is infinite or not a number.
    #[error("positions[{index}] must be finite, found {found:?}")]
    Position {
        /// Where it stands.
        index: usize,
        /// What was given.
        found: [f32; 3],
    },
    /// An index is of no position.
    #[error("indices[{index}] must be below {positions}, the number of positions, found {found}")]
    Index {
        /// Where it stands.
        index: usize,
        /// How many positions there are.
        positions: usize,
        /// What was given.
        found: u32,
    },
    /// Indices come three a triangle.
    #[error("indices must be three a triangle, found {found}")]
    Indices {
        /// How many were given.
        found: usize,
    },
    /// A buffer would be larger than the device binds.
    #[error(
        "{what} of an occluder mesh: {needed} bytes are more than the device's max_storage_buffer_binding_size, {limit}"
    )]
    Limit {
        /// What the buffer holds.
        what: &'static str,
        /// Bytes it needs.
        needed: u64,
        /// The device's limit [bytes].
        limit: u64,
    },
}

impl OccluderMesh {
    /// Welds equal positions, finds the edges and uploads. `positions` are in mesh space [m]; `indices` come three a
    /// triangle, in either orientation. Triangles without an area and repeated ones are left out.
    ///
    /// # Errors
    /// Where a position is not finite, an index out of range, or the mesh larger than what the device binds.
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
